//! The layout of expressive wrinkles on a face (HEADSHOP 4.4: the wrinkles' bump map is made from it): forehead,
//! frown, crow's feet, bunny lines, the fold from nose to mouth, lips' rays, chin. They are found from the head's
//! landmarks and feature lines, so that any head has its own, and run square to the muscles that make them.
//!
//! Two layers, since lines that cross (of a raised brow and of a frown) come and go apart: see `zones` for which
//! muscle drives what. A head without the landmarks has no wrinkles there.

use glam::{Vec2, vec2};
use mouthpiece_rig::Head;

use super::creases::{Crease, Relief};
use super::expression_lines::Face;
use super::noise::{cells, unit, value};
use super::{CHART_MM, WINDOW_MAX, WINDOW_MIN, ramp};

/// The two layers of heights.
#[derive(Clone, Debug)]
pub(super) struct Wrinkles {
    /// Forehead, smile, chin; the lips' own creases, which are always there.
    pub(super) raised: Relief,
    /// Frown, crow's feet, nose, rays round the lips.
    pub(super) drawn: Relief,
}

impl Wrinkles {
    /// Those of `head`, `side` texels across and down the window.
    pub(super) fn of(head: &Head, side: usize, red: &(dyn Fn(Vec2) -> f32 + Sync)) -> Self {
        let span = (WINDOW_MAX - WINDOW_MIN) * CHART_MM;
        let blank = || Relief::new((side, side), WINDOW_MIN * CHART_MM, span / side as f32);
        let face = Face { head };
        let raised = || {
            let mut relief = blank();
            fold_all(
                &mut relief,
                &[face.forehead(), face.smile(), face.chin()].concat(),
                100,
            );
            dimples(&face, &mut relief);
            lips(&face, &mut relief, red);
            relief
        };
        let drawn = || {
            let mut relief = blank();
            fold_all(
                &mut relief,
                &[face.frown(), face.crow(), face.nose(), face.rays()].concat(),
                200,
            );
            relief
        };
        std::thread::scope(|scope| {
            let beside = std::thread::Builder::new()
                .name("fold wrinkles".into())
                .spawn_scoped(scope, drawn);
            let raised = raised();
            let drawn = beside
                .ok()
                .and_then(|thread| thread.join().ok())
                .unwrap_or_else(drawn);
            Self { raised, drawn }
        })
    }
}

fn fold_all(relief: &mut Relief, creases: &[Crease], seed: u32) {
    for (number, crease) in (seed..).zip(creases) {
        relief.fold(crease, number);
    }
}

/// The chin's pits, as an orange's: where the mentalis is fixed to the skin.
fn dimples(face: &Face<'_>, relief: &mut Relief) {
    let Some(pg) = face.mark("pg") else { return };
    let radius = vec2(15.0, 12.0);
    let (first, last) = relief.texels(pg - radius, pg + radius);
    for y in first[1]..last[1] {
        for x in first[0]..last[0] {
            let place = relief.place(x, y);
            let off = (place - pg) / radius;
            let share = ramp(1.0, 0.25, off.length());
            if share > 0.0 {
                let near = cells(place.x * 0.24, place.y * 0.27, 0.42, 77);
                let pit = ramp(0.62, 0.0, near.distance[0]);
                let some = 0.35 + 0.65 * unit(near.hash);
                relief.heights[y * relief.width + x] -= 0.50 * share * pit * some;
            }
        }
    }
}

/// The creases of the lips run across the red, here up and down, and waver.
fn lips(face: &Face<'_>, relief: &mut Relief, red: &dyn Fn(Vec2) -> f32) {
    let (Some(left), Some(right)) = (face.mark("ch_l"), face.mark("ch_r")) else {
        return;
    };
    let reach = vec2(3.0, 16.0);
    let (first, last) = relief.texels(left.min(right) - reach, left.max(right) + reach);
    for y in first[1]..last[1] {
        for x in first[0]..last[0] {
            let at = relief.place(x, y);
            let share = ramp(0.2, 0.6, red(at / CHART_MM));
            if share > 0.0 {
                let bend = 2.6 * value(at.x * 0.16, at.y * 0.30, 53);
                let crease = value(at.x * 0.80 + bend, at.y * 0.21, 61) - 0.5;
                let fine = value(at.x * 2.3 + bend, at.y * 0.45, 67) - 0.5;
                relief.heights[y * relief.width + x] += share * (0.30 * crease + 0.15 * fine);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_head_without_landmarks_has_no_wrinkles_and_does_no_harm() {
        let mut head = Head::reference().unwrap();
        let folded = |head: &Head| {
            let wrinkles = Wrinkles::of(head, 256, &|_| 0.0);
            let deep = |relief: &Relief| relief.heights.iter().filter(|h| **h < -0.2).count();
            [deep(&wrinkles.raised), deep(&wrinkles.drawn)]
        };
        assert!(
            folded(&head).iter().all(|texels| *texels > 150),
            "{:?}",
            folded(&head)
        );
        head.landmarks.clear();
        head.features.clear();
        assert_eq!(folded(&head), [0, 0]);
    }
}
