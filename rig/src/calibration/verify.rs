//! Whether postures come out as wanted: random ones that the fit has not seen, with all contact on.

use std::sync::Arc;

use super::fit::{SETTLE_STEPS, measured};
use super::reach::Measure;
use super::{Calibration, MEASURES};
use crate::{Articulation, Head, Simulation};

/// Postures that are tried.
const POSTURES: usize = 60;
/// Random ones are drawn until so many can be reached, at most this often: speech's box of targets is some
/// four times larger than what one mouth can do of it.
const DRAWS_MAX: usize = 40 * POSTURES;
/// A posture counts as within reach where the fit comes so near on every measure, mm.
const NEAR_MM: f32 = 0.5;
/// Ranges of postures as speech asks for them: aperture, width, protrusion, jaw.
const RANGES: [(f32, f32); 4] = [(0.5, 14.0), (0.75, 1.15), (-1.0, 4.0), (0.0, 0.2)];

/// How far tried postures came out from what was wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct Verification {
    /// How many were tried: 0 where the head can reach none.
    pub postures: usize,
    /// Per measure but the last, which few phones want.
    pub errors: [MeasureError; MEASURES - 1],
}

/// Of one measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasureError {
    /// Which.
    pub measure: Measure,
    /// Half of the postures came nearer than this, mm.
    pub median_mm: f32,
    /// Nine tenths did.
    pub p90_mm: f32,
    /// The farthest off, mm.
    pub worst_mm: f32,
    /// What was wanted there.
    pub worst_at: Articulation,
}

impl Calibration {
    /// Tries random postures within reach on the head's own simulation, lips stopping each other; half a second of
    /// work. Another `seed`, other postures.
    #[must_use]
    pub fn verify(&self, head: &Arc<Head>, seed: u64) -> Verification {
        let mut simulation = Simulation::new(Arc::clone(head));
        let rest = head.rest_frame();
        let mut frame = rest.clone();
        let mut tried: Vec<(Articulation, [f32; MEASURES])> = Vec::with_capacity(POSTURES);
        for wanted in self.within_reach(seed) {
            let controls = self.controls(&wanted);
            simulation.restore(&rest);
            for _ in 0..SETTLE_STEPS {
                simulation.step(&controls);
            }
            simulation.save(&mut frame);
            let goal = self.wanted(&wanted);
            let got = measured(head, &frame);
            tried.push((wanted, std::array::from_fn(|m| (got[m] - goal[m]).abs())));
        }
        let errors = std::array::from_fn(|m| {
            tried.sort_by(|a, b| a.1[m].total_cmp(&b.1[m]));
            let at = |share: f32| {
                let index = (share * tried.len().saturating_sub(1) as f32).round() as usize;
                tried
                    .get(index)
                    .copied()
                    .unwrap_or((Articulation::REST, [0.0; MEASURES]))
            };
            let (worst_at, worst) = at(1.0);
            MeasureError {
                measure: Measure::ALL[m],
                median_mm: at(0.5).1[m],
                p90_mm: at(0.9).1[m],
                worst_mm: worst[m],
                worst_at,
            }
        });
        Verification {
            postures: tried.len(),
            errors,
        }
    }

    /// Random postures of speech's range that the fit expects to come out.
    fn within_reach(&self, seed: u64) -> Vec<Articulation> {
        let mut state = seed;
        let mut random = |(low, high): (f32, f32)| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            low + (high - low) * ((state >> 40) as f32 / (1_u32 << 24) as f32)
        };
        let mut found = Vec::with_capacity(POSTURES);
        for _ in 0..DRAWS_MAX {
            let [aperture_mm, width, protrusion_mm, jaw_rad] = RANGES.map(&mut random);
            let wanted = Articulation {
                aperture_mm,
                width,
                protrusion_mm,
                jaw_rad,
                ..Articulation::REST
            };
            let reach = self.reach(&wanted);
            let near = (reach.wanted_mm.into_iter().zip(reach.expected_mm))
                .all(|(wanted, expected)| wanted.is_none_or(|w| (w - expected).abs() < NEAR_MM));
            if near {
                found.push(wanted);
            }
            if found.len() == POSTURES {
                break;
            }
        }
        found
    }
}
