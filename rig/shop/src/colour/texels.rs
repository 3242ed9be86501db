//! Which part of the skin each texel of its map shows: the skin's triangles drawn into the map by their texture
//! coordinates.

use glam::{Vec2, vec2};
use mouthpiece_rig::Skin;

/// A texel on the skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texel {
    /// Number of the triangle.
    pub triangle: u32,
    /// Shares of its corners; outside 0..1 by a little at edges.
    pub shares: [f32; 3],
}

/// How far outside a triangle its texels may lie, texels: no cracks between triangles.
const GROWN: f32 = 0.75;

/// What lies under the middle of each texel of a map `width` texels across and half as many down, row by row from
/// the upper left; none where no skin is mapped. Where parts of the skin share texels (the inner side of lips,
/// lids and nostrils), the dry and outer one wins; ears lie over scalp that hair hides.
#[must_use]
pub fn texels(skin: &Skin, width: usize) -> Vec<Option<Texel>> {
    let height = (width / 2).max(1);
    let mut map = vec![None; width * height];
    // Higher wins; what lies within beats what lies in the grown rim.
    let mut rank = vec![f32::NEG_INFINITY; width * height];
    let size = vec2(width as f32, height as f32);
    for (number, corners) in skin.mesh.triangles.iter().enumerate() {
        let uvs = wedge(skin, number, corners);
        let island = is_island(skin, &uvs, corners);
        let wet: f32 = corners.iter().map(|i| skin.wet[*i as usize]).sum();
        let out: f32 = corners
            .iter()
            .map(|i| {
                let p = skin.mesh.positions[*i as usize];
                vec2(p.x, p.z).length()
            })
            .sum();
        // Past the map's side it goes on at the other.
        let high = uvs[0].x.max(uvs[1].x).max(uvs[2].x);
        let low = uvs[0].x.min(uvs[1].x).min(uvs[2].x);
        for turn in [0.0, -1.0, 1.0] {
            if high + turn < 0.0 || low + turn > 1.0 {
                continue;
            }
            let corners = uvs.map(|uv| (uv + vec2(turn, 0.0)) * size);
            draw(corners, (width, height), |at, shares, inside| {
                let score = out - 1e4 * wet
                    + if inside { 1e6 } else { 0.0 }
                    + if island { 1e7 } else { 0.0 };
                if score > rank[at] {
                    rank[at] = score;
                    map[at] = Some(Texel {
                        triangle: number as u32,
                        shares,
                    });
                }
            });
        }
    }
    map
}

/// Whether a triangle is mapped elsewhere than its place in the chart: an ear. What it covers there is hidden skin.
fn is_island(skin: &Skin, uvs: &[Vec2; 3], corners: &[u32; 3]) -> bool {
    const APART: f32 = 0.02;
    uvs.iter().zip(corners).any(|(uv, i)| {
        let off = *uv - skin.mesh.uvs[*i as usize];
        vec2(off.x - off.x.round(), off.y).length() > APART
    })
}

/// Texture coordinates of a triangle's corners, unrolled past the seam.
fn wedge(skin: &Skin, number: usize, corners: &[u32; 3]) -> [Vec2; 3] {
    if let Some(wedge) = skin.wedges.get(number) {
        return *wedge;
    }
    let uvs = corners.map(|i| skin.mesh.uvs[i as usize]);
    let high = uvs[0].x.max(uvs[1].x).max(uvs[2].x);
    uvs.map(|uv| if high - uv.x > 0.5 { uv + Vec2::X } else { uv })
}

/// Calls `paint(index, shares, inside)` for each texel whose middle lies on or just beside the triangle.
fn draw(
    [a, b, c]: [Vec2; 3],
    (width, height): (usize, usize),
    mut paint: impl FnMut(usize, [f32; 3], bool),
) {
    let area = (b - a).perp_dot(c - a);
    if area.abs() < 1e-6 {
        return;
    }
    let low = (a.min(b).min(c) - GROWN - 0.5).ceil().max(Vec2::ZERO);
    let high = a.max(b).max(c) + GROWN - 0.5;
    // Distance from a side is its share times the height over it.
    let heights = [(c - b).length(), (a - c).length(), (b - a).length()].map(|s| area.abs() / s);
    let mut y = low.y;
    while y <= high.y && y < height as f32 {
        let mut x = low.x;
        while x <= high.x && x < width as f32 {
            let p = vec2(x + 0.5, y + 0.5);
            let second = (p - a).perp_dot(c - a) / area;
            let third = (b - a).perp_dot(p - a) / area;
            let shares = [1.0 - second - third, second, third];
            let off = shares
                .iter()
                .zip(heights)
                .map(|(share, height)| share * height)
                .fold(f32::INFINITY, f32::min);
            if off >= -GROWN {
                paint(y as usize * width + x as usize, shares, off >= 0.0);
            }
            x += 1.0;
        }
        y += 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    /// Two triangles that make a square of the map, the right one past its side.
    fn square(left: f32) -> Skin {
        let mut skin = Skin::default();
        skin.mesh.positions = vec![vec3(0.0, 0.0, 90.0); 4];
        skin.mesh.uvs = vec![Vec2::ZERO; 4];
        skin.wet = vec![0.0; 4];
        skin.mesh.triangles = vec![[0, 1, 2], [0, 2, 3]];
        let (low, high) = (vec2(left, 0.25), vec2(left + 0.25, 0.75));
        let [a, b, c, d] = [low, vec2(low.x, high.y), high, vec2(high.x, low.y)];
        skin.wedges = vec![[a, b, c], [a, c, d]];
        skin
    }

    #[test]
    fn every_texel_of_an_island_is_found_and_its_shares_give_its_place() {
        let skin = square(0.5);
        let map = texels(&skin, 64);
        for (at, texel) in map.iter().enumerate() {
            let middle = vec2((at % 64) as f32 + 0.5, (at / 64) as f32 + 0.5) / vec2(64.0, 32.0);
            let inside = (0.5..0.75).contains(&middle.x) && (0.25..0.75).contains(&middle.y);
            let Some(texel) = texel else {
                assert!(!inside, "a hole at {middle}");
                continue;
            };
            let wedge = skin.wedges[texel.triangle as usize];
            let found: Vec2 = wedge.iter().zip(texel.shares).map(|(uv, s)| *uv * s).sum();
            assert!(found.distance(middle) < 1e-4, "{found} instead of {middle}");
        }
    }

    #[test]
    fn an_island_past_the_seam_goes_on_at_the_other_side() {
        let map = texels(&square(0.9), 64);
        let row = &map[16 * 64..17 * 64];
        assert!(row[60].is_some() && row[3].is_some() && row[30].is_none());
    }
}
