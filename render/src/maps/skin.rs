//! Colour, bump and gloss of the skin. The fine structure follows the idea of Ishii et al. as
//! HEADSHOP 4.4 takes it: polygonal cells parted by furrows, with pores where the skin is oily.
//!
//! Broad tones are laid on a coarse grid by place on the face; grain is added texel by texel.

use glam::{Vec2, Vec3, vec2, vec3};
use mouthpiece_rig::Head;

use super::image::{Image, root_table};
use super::landmarks::Ground;
use super::noise::{cells, fractal, hash, unit, value};
use super::tone::{Face, HAIR, Tone, tone_at};
use super::{CHART_HEIGHT, RADIUS, WINDOW_MAX, WINDOW_MIN, brows, hairline, parallel_rows, ramp};

/// The two maps of the skin.
#[derive(Clone, Debug)]
pub(crate) struct SkinMaps {
    /// Square root of linear colour; a: how much light shines through.
    pub(crate) colour: Image,
    /// Slopes across and up (128 is flat, 255 is 45 degrees), gloss, 255.
    pub(crate) detail: Image,
}

/// Tone cells across and down.
const GRID: (usize, usize) = (320, 160);
/// Paints the maps of `head`, `width` texels wide and half as high.
pub(crate) fn paint(head: &Head, width: usize) -> SkinMaps {
    let height = (width / 2).max(1);
    let ground = Ground::of(head, GRID.0, GRID.1);
    let face = Face::of(head);
    let mut tones: Vec<Tone> = vec![[0.0; 9]; GRID.0 * GRID.1];
    parallel_rows(&mut tones, GRID.0, |y, row| {
        for (x, tone) in row.iter_mut().enumerate() {
            let (place, red) = ground.cells[y * GRID.0 + x];
            *tone = tone_at(place, red, ground.uv(x, y), &face);
        }
    });

    let mut hairs = brows::paint(head, &ground, width, height);
    if let Some(line) = face.hairline() {
        hairline::paint(&mut hairs, line);
    }
    let mut bump = vec![0.0_f32; width * height];
    let mut colour = Image::new(width, height);
    let table = root_table();
    let mm = texel_mm(width, height);
    // One pass writes colour, another height: two slices cannot share a row closure.
    parallel_rows(&mut bump, width, |y, row| {
        for (x, depth) in row.iter_mut().enumerate() {
            let tone = sample(&tones, x, y, width, height);
            let at = vec2(x as f32, y as f32) * mm;
            *depth = relief(at, &tone) + 0.16 * hairs.values[y * width + x][0];
        }
    });
    parallel_rows(&mut colour.texels, width, |y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            let tone = sample(&tones, x, y, width, height);
            let at = vec2(x as f32, y as f32) * mm;
            let hair = hairs.values[y * width + x][0];
            let skin = coloured(at, &tone, bump[y * width + x] - 0.16 * hair);
            let shade = 0.75 + 0.5 * unit(hash(x as i32 / 2, y as i32 / 5, 77));
            let rgb = skin.lerp(HAIR * shade, hair);
            let byte = |v: f32| table[(v.clamp(0.0, 1.0) * 1023.0) as usize];
            *texel = [
                byte(rgb.x),
                byte(rgb.y),
                byte(rgb.z),
                (tone[6] * 255.0) as u8,
            ];
        }
    });
    let detail = slopes(&bump, &tones, width, height, mm);
    SkinMaps { colour, detail }
}

/// Size of a texel on the face, mm.
pub(crate) fn texel_mm(width: usize, height: usize) -> Vec2 {
    let span = WINDOW_MAX - WINDOW_MIN;
    vec2(
        span.x * std::f32::consts::TAU * RADIUS / width as f32,
        span.y * CHART_HEIGHT / height as f32,
    )
}

/// The tone grid at a texel, bilinear.
fn sample(tones: &[Tone], x: usize, y: usize, width: usize, height: usize) -> Tone {
    let gx =
        ((x as f32 + 0.5) * GRID.0 as f32 / width as f32 - 0.5).clamp(0.0, GRID.0 as f32 - 1.001);
    let gy =
        ((y as f32 + 0.5) * GRID.1 as f32 / height as f32 - 0.5).clamp(0.0, GRID.1 as f32 - 1.001);
    let (ix, iy) = (gx as usize, gy as usize);
    let (fx, fy) = (gx - ix as f32, gy - iy as f32);
    let at = iy * GRID.0 + ix;
    let (a, b) = (&tones[at], &tones[at + 1]);
    let (c, d) = (&tones[at + GRID.0], &tones[at + GRID.0 + 1]);
    std::array::from_fn(|i| {
        let upper = a[i] + (b[i] - a[i]) * fx;
        let lower = c[i] + (d[i] - c[i]) * fx;
        upper + (lower - upper) * fy
    })
}

/// Height of the skin's fine structure at a place of the window (mm), in mm.
fn relief(at: Vec2, tone: &Tone) -> f32 {
    let lip = ramp(0.2, 0.6, tone[7]);
    let mut height = 0.0;
    if lip < 1.0 && tone[8] > 0.01 {
        // Cells stretched this way and that, as the furrows of skin run.
        let lean = 0.5 * (value(at.x * 0.07, at.y * 0.07, 3) - 0.5);
        let size = 0.78;
        let (near, second) = cells((at.x + lean * at.y) * size, at.y * size * 0.9, 11);
        height -= 0.045 * tone[4] * (1.0 - ((second - near) * 3.2).min(1.0));
        // Pores: pits in the larger cells.
        if tone[5] > 0.1 {
            let (pit, _) = cells(at.x * 0.72 + 31.0, at.y * 0.72, 23);
            height -= 0.10 * (tone[5] - 0.1) * (1.0 - (pit * 3.6).min(1.0));
        }
        height += 0.09 * tone[4] * (value(at.x * 0.45, at.y * 0.45, 41) - 0.5);
        height *= 1.0 - lip;
    }
    if lip > 0.0 {
        // Creases of the lips run across the red, here up and down, and waver.
        let bend = 2.6 * value(at.x * 0.16, at.y * 0.30, 53);
        let crease = value(at.x * 0.80 + bend, at.y * 0.21, 61);
        let fine = value(at.x * 2.3 + bend, at.y * 0.45, 67);
        height += lip * (0.20 * (crease - 0.5) + 0.10 * (fine - 0.5));
    }
    height
}

/// Colour of a place: the tone, mottled, with freckles, darker in its furrows.
fn coloured(at: Vec2, tone: &Tone, height: f32) -> Vec3 {
    if tone[8] < 0.01 {
        return vec3(tone[0], tone[1], tone[2]);
    }
    let mottle = tone[8] * (fractal(at.x * 0.21, at.y * 0.21, 7) - 0.5);
    let grain = tone[8] * (value(at.x * 1.3, at.y * 1.3, 9) - 0.5);
    let mut c = vec3(tone[0], tone[1], tone[2]);
    // Blood shows as less green and blue, pigment as less of all.
    c *= vec3(1.0, 1.0 - 0.055 * mottle, 1.0 - 0.05 * mottle);
    c *= 1.0 + 0.020 * grain + 1.1 * height.min(0.0);
    c * (1.0 - vec3(0.16, 0.24, 0.28) * (tone[8] * freckle(at, tone[5])))
}

/// How dark a freckle or mole makes a place, 0..1.
fn freckle(at: Vec2, likely: f32) -> f32 {
    let side = 4.2;
    let (cx, cy) = ((at.x / side) as i32, (at.y / side) as i32);
    let h = hash(cx, cy, 91);
    if unit(h) > 0.05 + 0.20 * likely {
        return 0.0;
    }
    let centre = vec2(
        (cx as f32 + 0.25 + 0.5 * unit(hash(cx, cy, 92))) * side,
        (cy as f32 + 0.25 + 0.5 * unit(hash(cx, cy, 93))) * side,
    );
    let radius = 0.35 + 0.45 * unit(hash(cx, cy, 94));
    0.55 * unit(hash(cx, cy, 95)) * ramp(radius, radius * 0.4, at.distance(centre))
}

/// Heights to slopes, with gloss beside them.
fn slopes(bump: &[f32], tones: &[Tone], width: usize, height: usize, mm: Vec2) -> Image {
    let mut image = Image::new(width, height);
    parallel_rows(&mut image.texels, width, |y, row| {
        let above = y.saturating_sub(1) * width;
        let below = (y + 1).min(height - 1) * width;
        for (x, texel) in row.iter_mut().enumerate() {
            let (left, right) = (x.saturating_sub(1), (x + 1).min(width - 1));
            let dx = (bump[y * width + right] - bump[y * width + left]) / (2.0 * mm.x);
            // Rows run down, slopes up.
            let dy = (bump[above + x] - bump[below + x]) / (2.0 * mm.y);
            let tone = sample(tones, x, y, width, height);
            let patch = 0.8 + 0.4 * value(x as f32 * mm.x * 0.4, y as f32 * mm.y * 0.4, 31);
            let byte = |slope: f32| (slope.clamp(-1.0, 1.0) * 127.0 + 127.5) as u8;
            let gloss = (tone[3] * patch).clamp(0.0, 1.0);
            *texel = [byte(dx), byte(dy), (gloss * 255.0) as u8, 255];
        }
    });
    image
}
