//! Two colour maps made one without a seam: where the scan has colour it stays, where it has none the base goes on in
//! the scan's tone. The difference between the two is known where there is data, averaged over cells, and continued
//! smoothly over all the rest by a pyramid (push and pull: a membrane over the holes); the base plus this difference
//! meets the data at its borders, and a ramp of a few millimetres hides what is left.

use glam::{Vec2, Vec3, vec2};
use mouthpiece_rig::ColourMap;

/// Texels in a cell's side: about a millimetre on a face.
const CELL: usize = 4;
/// Over how many cells data fades in from its border.
const FADE: f32 = 7.0;
/// A cell with less than this share of texels has no data.
const FILLED: f32 = 0.6;
/// The finest steps of the pyramid are features of a face, not its tone.
const DETAIL: usize = 3;

/// Colour with holes.
pub(super) struct Layer {
    width: usize,
    height: usize,
    rgb: Vec<[u8; 3]>,
    there: Vec<bool>,
}

impl Layer {
    pub(super) fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            rgb: vec![[0; 3]; width * height],
            there: vec![false; width * height],
        }
    }

    /// Fills a triangle given in texels, which may lie over the map's left or right side.
    pub(super) fn draw(&mut self, [a, b, c]: [Vec2; 3], colour: impl Fn([f32; 3]) -> Vec3) {
        /// Texels on an edge belong to both triangles.
        const ON_EDGE: f32 = -1e-3;
        let area = (b - a).perp_dot(c - a);
        if area.abs() < 1e-9 {
            return;
        }
        let low = (a.min(b).min(c) - 0.5).ceil();
        let high = (a.max(b).max(c) - 0.5).floor();
        let (top, bottom) = (
            low.y.max(0.0) as usize,
            high.y.min(self.height as f32 - 1.0),
        );
        for y in top..=bottom.max(-1.0) as usize {
            if bottom < 0.0 {
                return;
            }
            for x in low.x as i64..=high.x as i64 {
                let p = vec2(x as f32 + 0.5, y as f32 + 0.5);
                let second = (p - a).perp_dot(c - a) / area;
                let third = (b - a).perp_dot(p - a) / area;
                let first = 1.0 - second - third;
                if first.min(second).min(third) < ON_EDGE {
                    continue;
                }
                let at = y * self.width + x.rem_euclid(self.width as i64) as usize;
                let colour = colour([first, second, third]);
                self.rgb[at] = (colour + 0.5).to_array().map(|v| v as u8);
                self.there[at] = true;
            }
        }
    }

    /// Drops the cells whose middle `wanted` does not want; it is given places of the map, 0..1.
    pub(super) fn keep(&mut self, wanted: impl Fn(Vec2) -> bool) {
        let step = 2 * CELL;
        let size = vec2(self.width as f32, self.height as f32);
        for top in (0..self.height).step_by(step) {
            for left in (0..self.width).step_by(step) {
                let middle = vec2(left as f32, top as f32) + step as f32 / 2.0;
                let rows = top..(top + step).min(self.height);
                let columns = left..(left + step).min(self.width);
                let row = |y: usize| y * self.width + columns.start..y * self.width + columns.end;
                if rows.clone().any(|y| self.there[row(y)].contains(&true))
                    && !wanted(middle / size)
                {
                    for y in rows {
                        self.there[row(y)].fill(false);
                    }
                }
            }
        }
    }

    /// Share of the map that is there.
    pub(super) fn share(&self) -> f64 {
        self.there.iter().filter(|t| **t).count() as f64 / self.there.len().max(1) as f64
    }
}

/// A coarse map: differences and how much they are known.
#[derive(Clone)]
struct Grid {
    width: usize,
    height: usize,
    value: Vec<Vec3>,
    weight: Vec<f32>,
}

/// `layer` over `base`, of the same size.
pub(super) fn blend(base: &ColourMap, layer: &Layer) -> ColourMap {
    let grid = differences(base, layer);
    let inside = depths(&grid);
    let tone = continued(&grid);
    let mut map = base.clone();
    // One row of cells between two, so that each texel is between two of its cells only.
    let mut line = vec![(Vec3::ZERO, 0.0); grid.width];
    for y in 0..base.height {
        let (upper, lower, down) = between((y as f32 + 0.5) / CELL as f32 - 0.5);
        let row = |y: i64| y.clamp(0, grid.height as i64 - 1) as usize * grid.width;
        let (upper, lower) = (row(upper), row(lower));
        for (x, cell) in line.iter_mut().enumerate() {
            let (a, b) = (upper + x, lower + x);
            *cell = (
                tone[a].lerp(tone[b], down),
                inside[a] + (inside[b] - inside[a]) * down,
            );
        }
        for x in 0..base.width {
            let at = y * base.width + x;
            let (left, right, over) = between((x as f32 + 0.5) / CELL as f32 - 0.5);
            let cell = |x: i64| line[x.rem_euclid(grid.width as i64) as usize];
            let ((tone_a, depth_a), (tone_b, depth_b)) = (cell(left), cell(right));
            let off = tone_a.lerp(tone_b, over);
            let depth = depth_a + (depth_b - depth_a) * over;
            let pixel = &mut map.rgb[3 * at..3 * at + 3];
            let under = Vec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into()) + off;
            let mixed = if layer.there[at] {
                let share = (depth / FADE).clamp(0.0, 1.0);
                let own = Vec3::from(layer.rgb[at].map(f32::from));
                under.lerp(own, share * share * (3.0 - 2.0 * share))
            } else {
                under
            };
            for (byte, value) in pixel.iter_mut().zip(mixed.to_array()) {
                *byte = (value + 0.5).clamp(0.0, 255.0) as u8;
            }
        }
    }
    map
}

/// The two cells on both sides of a place, and the share of the second.
fn between(place: f32) -> (i64, i64, f32) {
    let first = place.floor();
    (first as i64, first as i64 + 1, place - first)
}

/// The four cells round a place, and their shares.
fn corners(grid: &Grid, column: f32, row: f32) -> [(usize, f32); 4] {
    let (x, right, fx) = between(column);
    let (y, low, fy) = between(row);
    let wrap = |x: i64| x.rem_euclid(grid.width as i64) as usize;
    let clamp = |y: i64| y.clamp(0, grid.height as i64 - 1) as usize;
    let at = |x: i64, y: i64| clamp(y) * grid.width + wrap(x);
    [
        (at(x, y), (1.0 - fx) * (1.0 - fy)),
        (at(right, y), fx * (1.0 - fy)),
        (at(x, low), (1.0 - fx) * fy),
        (at(right, low), fx * fy),
    ]
}

/// Mean difference in each cell that has data.
fn differences(base: &ColourMap, layer: &Layer) -> Grid {
    let (width, height) = (base.width.div_ceil(CELL), base.height.div_ceil(CELL));
    let mut grid = Grid {
        width,
        height,
        value: vec![Vec3::ZERO; width * height],
        weight: vec![0.0; width * height],
    };
    for y in 0..base.height {
        for x in 0..base.width {
            let at = y * base.width + x;
            if layer.there[at] {
                let pixel = &base.rgb[3 * at..3 * at + 3];
                let under = Vec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into());
                let cell = y / CELL * width + x / CELL;
                grid.value[cell] += Vec3::from(layer.rgb[at].map(f32::from)) - under;
                grid.weight[cell] += 1.0;
            }
        }
    }
    for (value, weight) in grid.value.iter_mut().zip(&mut grid.weight) {
        let full = *weight / (CELL * CELL) as f32;
        if full >= FILLED {
            *value /= *weight;
            *weight = 1.0;
        } else {
            (*value, *weight) = (Vec3::ZERO, 0.0);
        }
    }
    grid
}

/// How many cells each lies within the data, up to where it has faded in: by two sweeps.
fn depths(grid: &Grid) -> Vec<f32> {
    let (width, height) = (grid.width, grid.height);
    let mut depth: Vec<f32> = grid.weight.iter().map(|w| w * 2.0 * FADE).collect();
    let mut relax = |at: usize, near: [Option<usize>; 3]| {
        for near in near.into_iter().flatten() {
            depth[at] = depth[at].min(depth[near] + 1.0);
        }
    };
    // Twice, since the map's sides meet.
    for _ in 0..2 {
        for y in 0..height {
            for x in 0..width {
                let (left, up) = ((x + width - 1) % width, y.checked_sub(1));
                let at = y * width;
                relax(at + x, [Some(at + left), up.map(|y| y * width + x), None]);
            }
        }
        for y in (0..height).rev() {
            for x in (0..width).rev() {
                let (right, down) = ((x + 1) % width, (y + 1 < height).then_some(y + 1));
                let at = y * width;
                relax(
                    at + x,
                    [Some(at + right), down.map(|y| y * width + x), None],
                );
            }
        }
    }
    depth
}

/// The tone everywhere: pushed up the pyramid where it is known, pulled down to where it is not.
fn continued(grid: &Grid) -> Vec<Vec3> {
    let mut levels = vec![grid.clone()];
    while let Some(last) = levels.last()
        && last.width.min(last.height) > 1
    {
        levels.push(pushed(last));
    }
    let mut tone: Option<(Grid, Vec<Vec3>)> = None;
    for (number, level) in levels.into_iter().enumerate().rev() {
        let values = match &tone {
            None => mean_where_known(&level),
            Some((coarse, values)) => pulled(&level, coarse, values, number >= DETAIL),
        };
        tone = Some((level, values));
    }
    tone.map_or_else(Vec::new, |(_, values)| values)
}

fn mean_where_known(level: &Grid) -> Vec<Vec3> {
    let weight: f32 = level.weight.iter().sum();
    let sum: Vec3 = level
        .value
        .iter()
        .zip(&level.weight)
        .map(|(v, w)| *v * *w)
        .sum();
    vec![
        if weight > 0.0 {
            sum / weight
        } else {
            Vec3::ZERO
        };
        level.value.len()
    ]
}

/// Half the size; a cell is as sure as the surest two of its four.
fn pushed(fine: &Grid) -> Grid {
    let (width, height) = (fine.width.div_ceil(2), fine.height.div_ceil(2));
    let mut coarse = Grid {
        width,
        height,
        value: vec![Vec3::ZERO; width * height],
        weight: vec![0.0; width * height],
    };
    for y in 0..fine.height {
        for x in 0..fine.width {
            let (from, to) = (y * fine.width + x, y / 2 * width + x / 2);
            coarse.value[to] += fine.value[from] * fine.weight[from];
            coarse.weight[to] += fine.weight[from];
        }
    }
    for (value, weight) in coarse.value.iter_mut().zip(&mut coarse.weight) {
        if *weight > 0.0 {
            *value /= *weight;
            *weight = (*weight / 2.0).min(1.0);
        }
    }
    coarse
}

/// The coarser level's values between its cells, and this one's own where `own` and known.
fn pulled(level: &Grid, coarse: &Grid, values: &[Vec3], own: bool) -> Vec<Vec3> {
    (0..level.value.len())
        .map(|i| {
            let (x, y) = ((i % level.width) as f32, (i / level.width) as f32);
            let from = corners(coarse, (x + 0.5) / 2.0 - 0.5, (y + 0.5) / 2.0 - 0.5);
            let smooth: Vec3 = from.into_iter().map(|(i, share)| values[i] * share).sum();
            if own {
                smooth.lerp(level.value[i], level.weight[i])
            } else {
                smooth
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn maps(scan: [u8; 3]) -> (ColourMap, Layer) {
        let (width, height) = (256, 128);
        let base = ColourMap {
            width,
            height,
            rgb: [190, 140, 120].repeat(width * height),
        };
        let mut layer = Layer::new(width, height);
        let colour = Vec3::from(scan.map(f32::from));
        let corners = [(60.0, 20.0), (200.0, 20.0), (200.0, 110.0), (60.0, 110.0)];
        let [a, b, c, d] = corners.map(|(x, y)| vec2(x, y));
        layer.draw([a, b, c], |_| colour);
        layer.draw([a, c, d], |_| colour);
        (base, layer)
    }

    #[test]
    fn what_has_no_data_goes_on_in_its_tone_without_a_step() {
        let (base, layer) = maps([120, 80, 60]);
        let map = blend(&base, &layer);
        let at = |x: usize, y: usize| &map.rgb[3 * (y * 256 + x)..3 * (y * 256 + x) + 3];
        assert_eq!(at(130, 64), [120, 80, 60]);
        for x in 0..256 {
            let (a, b) = (at(x, 64), at((x + 1) % 256, 64));
            for (a, b) in a.iter().zip(b) {
                assert!(a.abs_diff(*b) <= 6, "a step at {x}");
            }
        }
    }

    #[test]
    fn a_layer_without_anything_changes_nothing() {
        let (base, _) = maps([0; 3]);
        let empty = Layer::new(256, 128);
        assert_eq!(empty.share(), 0.0);
        assert_eq!(blend(&base, &empty), base);
    }
}
