//! Where things are on a face, read off the head: enough to place gloss and grain.

use glam::{Vec2, Vec3, vec2, vec3};
use mouthpiece_rig::Head;

/// Places on the face at rest, mm; sided ones are the subject's left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Landmarks {
    /// Centre of the left eyeball.
    pub(crate) eye: Vec3,
    /// Middle of the mouth.
    pub(crate) mouth: Vec3,
    /// Tip of the nose.
    pub(crate) nose: Vec3,
    /// Half the distance between the outermost skin vertices: the ears.
    pub(crate) ear_x: f32,
    /// Size of the face against the mean one (eyes to mouth 70 mm).
    pub(crate) scale: f32,
}

impl Landmarks {
    pub(crate) fn of(head: &Head) -> Self {
        let skin = &head.skin;
        let positions = &skin.mesh.positions;
        let eye = head.eyes[0].centre;
        let (mut sum, mut share) = (Vec3::ZERO, 0.0_f32);
        for ((p, red), wet) in positions.iter().zip(&skin.vermilion).zip(&skin.wet) {
            let weight = red * (1.0 - wet);
            sum += *p * weight;
            share += weight;
        }
        let mouth = if share > 0.5 {
            let mean = sum / share;
            vec3(0.0, mean.y, mean.z)
        } else {
            vec3(0.0, eye.y - 70.0, eye.z + 28.0)
        };
        let nose = positions
            .iter()
            .filter(|p| p.x.abs() < 8.0 && p.y > mouth.y + 12.0 && p.y < eye.y)
            .copied()
            .reduce(|a, b| if b.z > a.z { b } else { a })
            .unwrap_or(vec3(0.0, mouth.y + 35.0, mouth.z + 16.0));
        let ear_x = positions
            .iter()
            .filter(|p| p.y > mouth.y)
            .map(|p| p.x.abs())
            .fold(0.0, f32::max);
        let scale = ((eye.y - mouth.y) / 70.0).clamp(0.3, 3.0);
        Self {
            eye,
            mouth,
            nose,
            ear_x,
            scale,
        }
    }
}

/// What lies under each place of the skin's map, on a coarse grid.
#[derive(Clone, Debug)]
pub(crate) struct Ground {
    /// Position, mm, and vermilion; none where no skin is mapped.
    pub(crate) cells: Vec<Option<(Vec3, f32)>>,
}

impl Ground {
    /// Draws the skin's triangles into the map. Folds (inside of lips, nostrils, behind the ears)
    /// lie over each other: the outermost wins.
    pub(crate) fn of(head: &Head, width: usize, height: usize) -> Self {
        let skin = &head.skin;
        let mut cells = vec![None; width * height];
        let mut depth = vec![-1.0_f32; width * height];
        let size = vec2(width as f32, height as f32);
        for (number, t) in skin.mesh.triangles.iter().enumerate() {
            let uvs = wedge(head, number);
            let island = (0..3).any(|k| {
                let off = uvs[k] - skin.mesh.uvs[t[k] as usize];
                vec2(off.x - off.x.round(), off.y).length() > 0.02
            });
            // Past the map's side a triangle goes on at the other.
            for turn in [0.0, 1.0] {
                let corner: [(Vec2, Vec3, f32); 3] = std::array::from_fn(|k| {
                    let i = t[k] as usize;
                    let at = (uvs[k] - vec2(turn, 0.0)) * size;
                    (at, skin.mesh.positions[i], skin.vermilion[i])
                });
                draw(&corner, (width, height), |at, place, red| {
                    // Ears lie over scalp that hair hides.
                    let outward = vec2(place.x, place.z).length() + if island { 1e4 } else { 0.0 };
                    if outward > depth[at] {
                        depth[at] = outward;
                        cells[at] = Some((place, red));
                    }
                });
            }
        }
        Self { cells }
    }
}

/// Texture coordinates of a triangle's corners; past 1 where it crosses the seam.
fn wedge(head: &Head, number: usize) -> [Vec2; 3] {
    if let Some(wedge) = head.skin.wedges.get(number) {
        return *wedge;
    }
    let mesh = &head.skin.mesh;
    let uvs = mesh.triangles[number].map(|i| mesh.uvs[i as usize]);
    let high = uvs[0].x.max(uvs[1].x).max(uvs[2].x);
    uvs.map(|uv| if high - uv.x > 0.5 { uv + Vec2::X } else { uv })
}

/// Calls `paint(index, position, vermilion)` for each cell under a triangle, grown a little: no cracks.
fn draw(
    corner: &[(Vec2, Vec3, f32); 3],
    (width, height): (usize, usize),
    mut paint: impl FnMut(usize, Vec3, f32),
) {
    let [a, b, c] = corner;
    let low = a.0.min(b.0).min(c.0);
    let high = a.0.max(b.0).max(c.0);
    let area = (b.0 - a.0).perp_dot(c.0 - a.0);
    if area.abs() < 1e-6 || high.x < 0.0 {
        return;
    }
    let x0 = (low.x - 1.0).ceil().max(0.0) as usize;
    let y0 = (low.y - 1.0).ceil().max(0.0) as usize;
    let x1 = (high.x + 1.0).floor().clamp(0.0, width as f32) as usize;
    let y1 = (high.y + 1.0).floor().clamp(0.0, height as f32) as usize;
    for y in y0..y1 {
        for x in x0..x1 {
            let p = vec2(x as f32 + 0.5, y as f32 + 0.5);
            let wb = (p - a.0).perp_dot(c.0 - a.0) / area;
            let wc = (b.0 - a.0).perp_dot(p - a.0) / area;
            let wa = 1.0 - wb - wc;
            if wa < -0.3 || wb < -0.3 || wc < -0.3 {
                continue;
            }
            let place = a.1 * wa + b.1 * wb + c.1 * wc;
            paint(y * width + x, place, a.2 * wa + b.2 * wb + c.2 * wc);
        }
    }
}
