//! What a head's colour says of its brows: how much of one shows at a place, and of what colour it is. Hairs grow
//! there and in that colour only, so that they agree with a painted brow and with a photographed one.

use glam::{Vec2, Vec3, vec3};
use mouthpiece_rig::ColourMap;

use super::growth::Bed;
use crate::maps::{CHART_MM, ramp};

/// Hair of a head whose colour is not known, linear.
const UNKNOWN: Vec3 = vec3(0.034, 0.019, 0.012);
/// A place this dark against the bare skin beside the brow has none, and one this dark is full of hair.
const BARE: f32 = 0.93;
const FULL: f32 = 0.62;
/// Places along a brow at which its skin and hair are looked at.
const LOOKS: usize = 24;
/// Rows across it, and those of the skin below and above.
const ROWS: [f32; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
const BESIDE: [f32; 2] = [-0.65, 1.75];
/// Share of the looks that are taken for hair alone: the darkest.
const DARKEST: usize = 6;

/// What is seen of one brow.
#[derive(Clone, Debug)]
pub(super) struct Shown<'a> {
    map: Option<&'a ColourMap>,
    /// Brightness of the bare skin along the brow.
    bare: [f32; LOOKS],
    /// The hair's colour, linear.
    pub(super) colour: Vec3,
}

impl<'a> Shown<'a> {
    pub(super) fn of(map: Option<&'a ColourMap>, bed: &Bed) -> Self {
        let map = map.filter(|m| m.width > 0 && m.rgb.len() >= 3 * m.width * m.height);
        let Some(known) = map else {
            return Self {
                map: None,
                bare: [1.0; LOOKS],
                colour: UNKNOWN,
            };
        };
        let along = |i: usize| (i as f32 + 0.5) / LOOKS as f32;
        let bare = std::array::from_fn(|i| {
            let sum: f32 = BESIDE
                .iter()
                .map(|row| brightness(around(known, bed.at(along(i), *row))))
                .sum();
            sum / BESIDE.len() as f32
        });
        let mut seen: Vec<Vec3> = (0..LOOKS)
            .flat_map(|i| ROWS.map(|row| texel(known, bed.at(along(i), row))))
            .collect();
        seen.sort_by(|a, b| brightness(*a).total_cmp(&brightness(*b)));
        let hair = &seen[..seen.len() / DARKEST];
        let mean = hair.iter().sum::<Vec3>() / hair.len() as f32;
        Self {
            map,
            bare,
            colour: mean.map(linear),
        }
    }

    /// How much of a brow shows at a place, 0..1.
    pub(super) fn at(&self, along: f32, place: Vec2) -> f32 {
        let Some(map) = self.map else { return 1.0 };
        let bare = self.bare[((along * LOOKS as f32) as usize).min(LOOKS - 1)];
        ramp(BARE, FULL, brightness(around(map, place)) / bare.max(1e-3))
    }
}

/// The mean over a mm or so: hairs are not to be told from what lies between them.
fn around(map: &ColourMap, place: Vec2) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for dy in [-0.8, 0.0, 0.8] {
        for dx in [-0.8, 0.0, 0.8] {
            sum += texel(map, place + Vec2::new(dx, dy));
        }
    }
    sum / 9.0
}

/// The colour at a place of the chart, mm; sRGB 0..1.
fn texel(map: &ColourMap, place: Vec2) -> Vec3 {
    let uv = place / CHART_MM;
    let x = (uv.x * map.width as f32) as usize;
    let y = (uv.y * map.height as f32) as usize;
    let at = 3 * (y.min(map.height - 1) * map.width + x.min(map.width - 1));
    Vec3::from_array(std::array::from_fn(|c| f32::from(map.rgb[at + c]) / 255.0))
}

fn brightness(srgb: Vec3) -> f32 {
    srgb.dot(vec3(0.3, 0.6, 0.1))
}

fn linear(srgb: f32) -> f32 {
    srgb.powf(2.2)
}
