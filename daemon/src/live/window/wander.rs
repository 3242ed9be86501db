//! Where the picture has wandered to, so that no edge of it burns into the screen.
//!
//! A curve that fills its square in the course of hours and never goes faster than a few hundredths of a
//! pixel a second: nobody sees it move.

use glam::{Vec2, vec2};

/// How long it takes across and back, and up and back, seconds: no small multiple of each is one of
/// the other's.
const ACROSS_S: f64 = 347.0;
const UP_S: f64 = 521.0;

/// The place at `now_ns`, at most `reach_px` to each side; in the middle at 0.
pub(super) fn at(now_ns: i64, reach_px: f32) -> Vec2 {
    let share = |period_s: f64| {
        let turns = now_ns as f64 * 1e-9 / period_s;
        (turns.fract() * std::f64::consts::TAU).sin() as f32
    };
    vec2(share(ACROSS_S), share(UP_S)) * reach_px
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_goes_everywhere_and_is_never_seen_to_move() {
        let reach = 8.0;
        let (mut seen, mut last) = ([[false; 4]; 4], Vec2::ZERO);
        for s in 0..4 * 3600 {
            let place = at(s * 1_000_000_000, reach);
            assert!(place.abs().max_element() <= reach);
            assert!(place.distance(last) < 0.2, "{}", place.distance(last));
            last = place;
            let cell = ((place / reach + 1.0) * 2.0)
                .min(Vec2::splat(3.0))
                .as_usizevec2();
            seen[cell.y][cell.x] = true;
        }
        assert!(seen.iter().flatten().all(|s| *s));
    }
}
