//! Colour, bump and gloss of the skin. The fine structure follows the idea of Ishii et al. as
//! HEADSHOP 4.4 takes it: polygonal cells parted by furrows, with pores where the skin is oily.
//!
//! Broad tones are laid on a coarse grid by place on the face; grain is added texel by texel.

use glam::{Vec2, Vec3, vec2, vec3};
use mouthpiece_rig::{Feature, Head};

use super::image::{Image, root_table};
use super::landmarks::{Ground, Landmarks};
use super::noise::{cells, fractal, hash, unit, value};
use super::{CHART_HEIGHT, RADIUS, WINDOW_MAX, WINDOW_MIN, brows, hairline, parallel_rows, ramp};

/// The two maps of the skin.
#[derive(Clone, Debug)]
pub(crate) struct SkinMaps {
    /// Square root of linear colour; a: how much light shines through.
    pub(crate) colour: Image,
    /// Slopes across and up (128 is flat, 255 is 45 degrees), gloss, 255.
    pub(crate) detail: Image,
}

/// Broad properties of a place: red, green, blue (sRGB-like, 0..1), gloss, depth of the skin's cells, depth
/// of pores, translucence, lip, strength of all mottling.
type Tone = [f32; 9];

/// Skin where nothing colours it.
const BASE: Vec3 = vec3(0.800, 0.598, 0.512);
/// Hair of the brows.
const BROW: Vec3 = vec3(0.205, 0.145, 0.110);
/// Tone cells across and down.
const GRID: (usize, usize) = (320, 160);
/// Share of the width at each side over which paint fades to plain skin.
const FADE: f32 = 0.06;

/// Paints the maps of `head`, `width` texels wide and half as high.
pub(crate) fn paint(head: &Head, width: usize) -> SkinMaps {
    let height = (width / 2).max(1);
    let ground = Ground::of(head, GRID.0, GRID.1);
    let marks = Landmarks::of(head);
    let mut tones: Vec<Tone> = vec![[0.0; 9]; GRID.0 * GRID.1];
    parallel_rows(&mut tones, GRID.0, |y, row| {
        for (x, tone) in row.iter_mut().enumerate() {
            let (place, red) = ground.cells[y * GRID.0 + x];
            *tone = tone_at(place, red, ground.uv(x, y), &marks, head);
        }
    });

    let mut hairs = brows::paint(head, &ground, width, height);
    hairline::paint(&mut hairs, head);
    let mut bump = vec![0.0_f32; width * height];
    let mut colour = Image::new(width, height);
    let table = root_table();
    let mm = texel_mm(width, height);
    // One pass writes colour, another height: two slices cannot share a row closure.
    parallel_rows(&mut bump, width, |y, row| {
        for (x, depth) in row.iter_mut().enumerate() {
            let tone = sample(&tones, x, y, width, height);
            let at = vec2(x as f32, y as f32) * mm;
            *depth = relief(at, &tone, mm) + 0.16 * hairs.values[y * width + x];
        }
    });
    parallel_rows(&mut colour.texels, width, |y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            let tone = sample(&tones, x, y, width, height);
            let at = vec2(x as f32, y as f32) * mm;
            let hair = hairs.values[y * width + x];
            let skin = coloured(at, &tone, bump[y * width + x] - 0.16 * hair);
            let shade = 0.75 + 0.5 * unit(hash(x as i32 / 2, y as i32 / 5, 77));
            let rgb = skin.lerp(BROW * shade, hair);
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

/// Broad colour of a place on the face.
fn tone_at(p: Vec3, red: f32, uv: Vec2, m: &Landmarks, head: &Head) -> Tone {
    let s = m.scale;
    let side = vec3(p.x.abs(), p.y, p.z);
    // Ellipsoid blots, 1 in the middle.
    let blot =
        |centre: Vec3, radius: Vec3| (-((side - centre) / (radius * s)).length_squared()).exp();
    let drop = |below: f32| m.eye.y - below * (m.eye.y - m.mouth.y);
    let on = |x: f32, y: f32, z: f32| vec3(x, y, z);
    let cheek = blot(
        on(m.eye.x * 1.22, drop(0.55), m.eye.z),
        vec3(19.0, 18.0, 40.0),
    );
    let tip = blot(m.nose, vec3(15.0, 13.0, 22.0));
    let wing = blot(
        on(15.0 * s, m.nose.y - 2.0 * s, m.nose.z - 20.0 * s),
        vec3(7.0, 8.0, 14.0),
    );
    let bridge = blot(
        on(0.0, drop(0.15), m.nose.z - 18.0 * s),
        vec3(8.0, 18.0, 22.0),
    );
    let forehead = ramp(m.eye.y + 22.0 * s, m.eye.y + 48.0 * s, p.y)
        * ramp(m.ear_x * 0.95, m.ear_x * 0.5, side.x);
    let bag = blot(
        on(m.eye.x - 2.0, m.eye.y - 15.0 * s, m.eye.z + 8.0),
        vec3(15.0, 5.0, 25.0),
    );
    let lid = blot(
        on(m.eye.x, m.eye.y + 9.0 * s, m.eye.z + 10.0),
        vec3(17.0, 6.5, 25.0),
    );
    let socket = blot(
        on(m.eye.x - 14.0 * s, m.eye.y + 4.0 * s, m.eye.z + 8.0),
        vec3(7.0, 11.0, 25.0),
    );
    let chin = blot(
        on(0.0, m.mouth.y - 30.0 * s, m.mouth.z - 6.0),
        vec3(14.0, 10.0, 20.0),
    );
    let muzzle = blot(
        on(0.0, m.mouth.y - 2.0 * s, m.mouth.z - 6.0),
        vec3(32.0, 21.0, 30.0),
    );
    let ear = ramp(m.ear_x * 0.80, m.ear_x * 0.93, side.x)
        * ramp(m.eye.z - 25.0, m.eye.z - 55.0, p.z)
        * ramp(m.nose.y - 34.0 * s, m.nose.y - 18.0 * s, p.y)
        * ramp(m.eye.y + 22.0 * s, m.eye.y + 4.0 * s, p.y);
    let neck = ramp(m.mouth.y - 40.0 * s, m.mouth.y - 68.0 * s, p.y);

    let mut c = BASE;
    let mut blend = |target: Vec3, share: f32| c = c.lerp(target, share.clamp(0.0, 1.0));
    blend(vec3(0.81, 0.620, 0.530), forehead * 0.7);
    blend(vec3(0.775, 0.515, 0.445), cheek * 0.75);
    blend(vec3(0.765, 0.490, 0.415), tip * 0.72);
    blend(vec3(0.735, 0.455, 0.385), wing * 0.65);
    blend(vec3(0.81, 0.64, 0.54), bridge * 0.4);
    blend(vec3(0.80, 0.590, 0.505), muzzle * 0.45);
    blend(vec3(0.67, 0.475, 0.425), bag * 0.55);
    blend(vec3(0.69, 0.470, 0.410), lid * 0.60);
    blend(vec3(0.66, 0.455, 0.395), socket * 0.45);
    blend(vec3(0.765, 0.525, 0.445), chin * 0.5);
    blend(vec3(0.785, 0.490, 0.430), ear * 0.5);
    blend(vec3(0.765, 0.575, 0.475), neck * 0.6);
    // Lines: the crease beside the nose, the rims of the lids.
    for (name, half_width, colour, share) in [
        ("alar_crease", 2.2, vec3(0.62, 0.36, 0.30), 0.55),
        ("lid_crease", 1.4, vec3(0.55, 0.34, 0.28), 0.6),
        ("lid_margin", 2.0, vec3(0.50, 0.30, 0.26), 0.75),
    ] {
        let near = [format!("{name}_l"), format!("{name}_r")]
            .iter()
            .filter_map(|n| head.feature(n))
            .map(|f| distance_mm(f, uv))
            .fold(f32::INFINITY, f32::min);
        blend(colour, share * (-(near / half_width).powi(2)).exp());
        if name == "lid_margin" {
            // The roots of the upper lashes, as a thin dark line.
            let upper = ramp(m.eye.y - 5.0 * s, m.eye.y - 1.0 * s, p.y);
            blend(
                vec3(0.17, 0.115, 0.095),
                0.85 * upper * (-(near / 0.95).powi(2)).exp(),
            );
        }
    }
    // Under the hair the scalp is dark, so that nothing shines through between strands.
    let covered = hairline::depth_mm(head, uv).map_or(0.0, |depth| ramp(-0.3, 3.5, depth));
    blend(BROW, 0.92 * covered);

    let oil = 0.32 + 0.16 * forehead + 0.40 * tip + 0.20 * bridge + 0.14 * chin + 0.08 * lid
        - 0.16 * bag
        - 0.14 * neck;
    let depth = 0.85 - 0.45 * lid - 0.25 * bag - 0.1 * ear;
    let pores = 0.16 + 0.85 * tip + 0.55 * wing + 0.45 * cheek + 0.18 * forehead + 0.2 * chin;
    let thin = (0.95 * ear + 0.5 * wing + 0.3 * tip + 0.25 * lid).min(1.0);
    // Plain towards the window's sides, which the sampler goes on with.
    let x = (uv.x - WINDOW_MIN.x) / (WINDOW_MAX.x - WINDOW_MIN.x);
    let inner = ramp(0.0, FADE, x.min(1.0 - x));
    let c = vec3(0.765, 0.575, 0.475).lerp(c, inner);
    [
        c.x,
        c.y,
        c.z,
        oil,
        depth * inner,
        pores * inner,
        thin * inner,
        red,
        inner,
    ]
}

/// Distance in mm on the chart from `uv` to a line.
fn distance_mm(line: &Feature, uv: Vec2) -> f32 {
    let mm = vec2(std::f32::consts::TAU * RADIUS, CHART_HEIGHT);
    let p = uv * mm;
    line.points
        .windows(2)
        .map(|w| {
            let (a, b) = (w[0] * mm, w[1] * mm);
            let along = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-9)).clamp(0.0, 1.0);
            p.distance(a.lerp(b, along))
        })
        .fold(f32::INFINITY, f32::min)
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
fn relief(at: Vec2, tone: &Tone, mm: Vec2) -> f32 {
    let lip = ramp(0.2, 0.6, tone[7]);
    let mut height = 0.0;
    if lip < 1.0 {
        // Cells stretched this way and that, as the furrows of skin run.
        let lean = 0.5 * (value(at.x * 0.07, at.y * 0.07, 3) - 0.5);
        let size = 0.78 / mm.x.max(mm.y).max(0.35).min(1.2) * 0.35;
        let (near, second) = cells((at.x + lean * at.y) * size, at.y * size * 0.9, 11);
        height -= 0.045 * tone[4] * (1.0 - ((second - near) * 3.2).min(1.0));
        // Pores: pits in the larger cells.
        let (pit, _) = cells(at.x * 0.72 + 31.0, at.y * 0.72, 23);
        height -= 0.10 * tone[5] * (1.0 - (pit * 3.6).min(1.0));
        height += 0.10 * tone[4] * (fractal(at.x * 0.33, at.y * 0.33, 41) - 0.5);
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
    let broad = tone[8] * (fractal(at.x * 0.055, at.y * 0.055, 5) - 0.5);
    let mottle = tone[8] * (fractal(at.x * 0.21, at.y * 0.21, 7) - 0.5);
    let grain = tone[8] * (value(at.x * 1.3, at.y * 1.3, 9) - 0.5);
    let mut c = vec3(tone[0], tone[1], tone[2]);
    // Blood shows as less green and blue, pigment as less of all.
    c *= vec3(
        1.0,
        1.0 - 0.075 * mottle - 0.05 * broad,
        1.0 - 0.07 * mottle - 0.045 * broad,
    );
    c *= 1.0 + 0.045 * broad + 0.020 * grain + 1.1 * height.min(0.0);
    c * (1.0 - vec3(0.16, 0.24, 0.28) * (tone[8] * freckle(at, tone[5])))
}

/// How dark a freckle or mole makes a place, 0..1.
fn freckle(at: Vec2, likely: f32) -> f32 {
    let side = 4.2;
    let (cx, cy) = ((at.x / side).floor() as i32, (at.y / side).floor() as i32);
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
