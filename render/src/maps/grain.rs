//! The skin's fine structure: HEADSHOP 4.4's first bump map, "computed from a synthetic skin model" after
//! Ishii et al. Furrows part the skin into polygonal cells, finer and shallower furrows part those again; each
//! cell is a low dome; pores sit where the deep furrows meet. Under it all lies a slow unevenness of some
//! millimetres, which is what breaks up a highlight when the cells are too small to be seen.
//!
//! It is painted once as a tile that repeats; [`place`] lays it on a face so that the cells' size and direction
//! vary from region to region. How deep it is where, the mask says (see `mask`).

use glam::{Vec2, vec2};

use super::image::Image;
use super::landmarks::Landmarks;
use super::noise::{Tiled, TiledCells, value};
use super::{CHART_HEIGHT, CHART_MM, parallel_rows, ramp};

/// Side of the tile on the skin, mm.
pub(crate) const TILE_MM: f32 = 40.0;
/// Cells between deep furrows along the tile's side (0.85 mm each) and between shallow ones.
const CELLS: i32 = 47;
const FINE_CELLS: i32 = 103;
/// Depth of furrows and pores, and height of the slow unevenness, mm. Furrows of a young face are 0.03 to
/// 0.08 mm deep.
const FURROW_MM: f32 = 0.034;
const FINE_FURROW_MM: f32 = 0.014;
const PORE_MM: f32 = 0.070;
const UNEVEN_MM: f32 = 0.16;

/// What is known of a place of the tile.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    height_mm: f32,
    furrow: f32,
    pore: f32,
}

/// Slopes across and up (128 is flat, 255 is 45 degrees), how deep in a furrow, how deep in a pore.
pub(crate) fn paint(side: usize) -> Image {
    let skin = Skin::new();
    let mut places = vec![Place::default(); side * side];
    let mm = TILE_MM / side as f32;
    parallel_rows(&mut places, side, |y, row| {
        for (x, place) in row.iter_mut().enumerate() {
            *place = skin.at(vec2(x as f32, y as f32) / side as f32);
        }
    });
    let mut image = Image::new(side, side);
    parallel_rows(&mut image.texels, side, |y, row| {
        let height = |x: usize, y: usize| places[(y % side) * side + x % side].height_mm;
        for (x, texel) in row.iter_mut().enumerate() {
            let across = (height(x + 1, y) - height(x + side - 1, y)) / (2.0 * mm);
            // Rows run down, slopes up.
            let up = (height(x, y + side - 1) - height(x, y + 1)) / (2.0 * mm);
            let Place { furrow, pore, .. } = places[y * side + x];
            let share = |share: f32| (share.clamp(0.0, 1.0) * 255.0) as u8;
            *texel = [slope(across), slope(up), share(furrow), share(pore)];
        }
    });
    image
}

/// A slope as a byte.
pub(super) fn slope(slope: f32) -> u8 {
    (slope.clamp(-1.0, 1.0) * 127.0 + 128.0) as u8
}

/// The synthetic skin: its patterns over the tile.
#[derive(Clone, Debug)]
struct Skin {
    cells: TiledCells,
    fine: TiledCells,
    /// Furrows are not straight.
    bends: [Tiled; 4],
    /// Where cells meet there is a pore or there is none.
    chosen: Tiled,
    uneven: [Tiled; 3],
}

impl Skin {
    fn new() -> Self {
        Self {
            cells: TiledCells::new(CELLS, 0.42, 11),
            fine: TiledCells::new(FINE_CELLS, 0.45, 12),
            bends: [3, 4, 5, 6].map(|seed| Tiled::new(60, seed)),
            chosen: Tiled::new(46, 17),
            uneven: [(7, 21), (15, 22), (31, 23)].map(|(cells, seed)| Tiled::new(cells, seed)),
        }
    }

    /// At a place of the tile, 0..1 both ways.
    fn at(&self, t: Vec2) -> Place {
        let [a, b, c, d] = self.bends.each_ref().map(|bend| bend.at(t.x, t.y));
        let p = t * CELLS as f32 + vec2(a, b) * 0.45;
        let near = self.cells.at(p.x, p.y);
        let [d1, d2, d3] = near.distance;
        let furrow = 1.0 - ramp(0.02, 0.27, d2 - d1);
        let q = t * FINE_CELLS as f32 + vec2(c, d) * 0.6;
        let fine = self.fine.at(q.x, q.y).distance;
        let fine_furrow = 1.0 - ramp(0.02, 0.30, fine[1] - fine[0]);
        let meet = 1.0 - ramp(0.04, 0.28, d3 - d1);
        let pore = meet * ramp(-0.10, 0.25, self.chosen.at(t.x, t.y));
        let [broad, middle, small] = self.uneven.each_ref().map(|slow| slow.at(t.x, t.y));
        let uneven = broad * 0.9 + middle * 0.55 + small * 0.22;
        let dome = 0.012 * (1.0 - (d1 * 1.6).min(1.0));
        Place {
            height_mm: UNEVEN_MM * uneven + dome
                - FURROW_MM * furrow
                - FINE_FURROW_MM * fine_furrow
                - PORE_MM * pore,
            furrow: 0.75 * furrow + 0.25 * fine_furrow,
            pore,
        }
    }
}

/// Where a place of the chart lies on the tile, in tiles. Furrows run across forehead and neck (cells are wider
/// than high there), obliquely down the cheeks, and waver everywhere.
pub(crate) fn place(uv: Vec2, marks: &Landmarks) -> Vec2 {
    let at = (uv - vec2(0.5, 0.0)) * CHART_MM;
    let height = CHART_HEIGHT_TOP - at.y;
    let above = ramp(marks.eye.y + 10.0, marks.eye.y + 45.0, height);
    let neck = ramp(marks.mouth.y - 35.0, marks.mouth.y - 75.0, height);
    let waver = |scale: f32, seed| value(at.x * scale + 50.0, at.y * scale + 50.0, seed) - 0.5;
    let warp = vec2(
        13.0 * waver(0.021, 71) + 4.0 * waver(0.06, 73),
        13.0 * waver(0.021, 72) + 4.0 * waver(0.06, 74),
    );
    let aside = (at.x * at.x + 100.0).sqrt() - 10.0;
    let oblique = (1.0 - above) * (1.0 - neck);
    let wide = vec2(
        at.x * (1.0 - 0.24 * above - 0.30 * neck),
        at.y * (1.0 + 0.10 * above) + 0.32 * aside * oblique,
    );
    (wide + warp) / TILE_MM
}

/// Height of the chart's upper edge in the head's frame, mm.
const CHART_HEIGHT_TOP: f32 = 150.0;
const _: () = assert!(CHART_HEIGHT > CHART_HEIGHT_TOP);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tile_joins_itself_at_its_sides() {
        let side = 128;
        let tile = paint(side);
        let texel = |x: usize, y: usize| tile.texels[y * side + x];
        let apart = |a: [u8; 4], b: [u8; 4]| i32::from(a[2].abs_diff(b[2]));
        let row =
            |y: usize| -> i32 { (1..side).map(|x| apart(texel(x, y), texel(x - 1, y))).sum() };
        let inside: i32 = (0..side).map(row).sum::<i32>() / (side as i32 - 1);
        let across: i32 = (0..side)
            .map(|y| apart(texel(0, y), texel(side - 1, y)))
            .sum();
        let down: i32 = (0..side)
            .map(|x| apart(texel(x, 0), texel(x, side - 1)))
            .sum();
        assert!(
            across < 2 * inside && down < 2 * inside,
            "{across}, {down} against {inside}"
        );
    }

    #[test]
    fn cells_change_size_and_direction_over_a_face() {
        let marks = Landmarks {
            eye: glam::vec3(31.0, 36.0, 79.0),
            mouth: glam::vec3(0.0, -34.0, 113.0),
            nose: glam::vec3(0.0, 1.0, 130.0),
            ear_x: 88.0,
            scale: 1.0,
        };
        let step = 0.001;
        let width = |u: f32, v: f32| {
            (place(vec2(u + step, v), &marks) - place(vec2(u, v), &marks)).length()
        };
        let forehead = width(0.52, 0.25);
        let nose = width(0.5, 0.55);
        assert!((forehead / nose - 1.0).abs() > 0.1, "{forehead} and {nose}");
    }
}
