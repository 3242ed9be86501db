//! How strongly LEE's springs pull, four at a time.
//!
//! LEE 4: a spring of stiffness `K` and rest length `l` pulls by `K` times its strain; beyond a strain `B`
//! the dermal-fatty ones go on with a second stiffness; pressed ones push by `K Φ` times their strain,
//! `Φ = tan(σπ/2 · strain)`, bounded since σ < 1. Where LEE's biphasic formula would jump at `B` (its
//! stiffness is of the whole strain), the second stiffness here is of what lies beyond: pulls are
//! continuous. `tan` is its pole and two terms of what is left, to 2e-4 of itself.

use std::f32::consts::PI;

use glam::Vec4;

/// LEE's default.
pub(super) const SIGMA: f32 = 0.98;
/// Where the second phase begins; LEE gives no figure. Skin stiffens between a fifth and a half.
pub(super) const BIPHASIC: f32 = 0.25;

/// Beyond this strain a pressed spring pushes no harder: at the pole that σ keeps away from, seven times
/// harder, no step is short enough.
const SHORTEST: f32 = 0.9;

/// Four springs' stiffnesses.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stiffness {
    pub first: Vec4,
    pub second: Vec4,
}

/// The pull per mm of length of four springs, and their stiffness, per mass.
pub(super) struct Pull {
    pub per_mm: Vec4,
    pub stiffness: Vec4,
}

/// LEE's compression penalty for strains from 0 (at rest) to 1 (no length).
fn penalty(strain: Vec4) -> Vec4 {
    let y = strain * SIGMA;
    let square = y * y;
    y * ((Vec4::ONE - square).recip() * (4.0 / PI) + square * 0.018_69 + 0.297_56)
}

/// The pull between the ends of four springs that are `length` mm long.
#[inline]
pub(super) fn pull(length: Vec4, per_rest_mm: Vec4, k: &Stiffness) -> Pull {
    let strain = length * per_rest_mm - Vec4::ONE;
    let (long, short) = (strain.max(Vec4::ZERO), (-strain).max(Vec4::ZERO));
    let beyond = (long - Vec4::splat(BIPHASIC)).max(Vec4::ZERO);
    let short = short.min(Vec4::splat(SHORTEST));
    let phi = penalty(short);
    let pull = k.first * (long - phi * short) + (k.second - k.first) * beyond;
    let slope = k.first * (phi + short * ((phi * phi + Vec4::ONE) * (0.5 * PI * SIGMA)));
    let stretched = Vec4::select(beyond.cmpgt(Vec4::ZERO), k.second, k.first);
    Pull {
        per_mm: pull / length,
        stiffness: (stretched + slope) * per_rest_mm,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(strain: f32, k: [f32; 2]) -> f32 {
        let k = Stiffness {
            first: Vec4::splat(k[0]),
            second: Vec4::splat(k[1]),
        };
        let length = Vec4::splat(2.0 * (1.0 + strain));
        let pull = pull(length, Vec4::splat(0.5), &k);
        pull.per_mm.x * length.x
    }

    #[test]
    fn a_spring_pulls_as_lee_has_it() {
        assert!((of(0.1, [60.0, 60.0]) - 6.0).abs() < 1e-3);
        for strain in [0.05_f32, 0.3, 0.6, 0.9] {
            let wanted = -60.0 * (SIGMA * PI * strain / 2.0).tan() * strain;
            let got = of(-strain, [60.0, 60.0]);
            assert!(
                (got / wanted - 1.0).abs() < 2e-3,
                "{strain}: {got}, not {wanted}"
            );
        }
        // Bounded, whatever presses it.
        assert_eq!(of(-0.9, [60.0, 60.0]), of(-0.99, [60.0, 60.0]));
        // Continuous where the second phase begins, steeper behind it.
        let (before, after) = (
            of(BIPHASIC - 1e-4, [30.0, 70.0]),
            of(BIPHASIC + 1e-4, [30.0, 70.0]),
        );
        assert!((after - before) < 0.02, "{before} {after}");
        let behind = of(BIPHASIC + 0.1, [30.0, 70.0]) - of(BIPHASIC, [30.0, 70.0]);
        assert!((behind - 7.0).abs() < 1e-2, "{behind}");
    }
}
