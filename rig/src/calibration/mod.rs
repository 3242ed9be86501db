//! From what a mouth should do to what its muscles must do, for one head.
//!
//! | module | holds |
//! |---|---|
//! | `fit` | how a head's mouth answers to its muscles, learnt from its own simulation |
//! | `reach` | what of an articulation a head cannot do, and by how much |
//! | `verify` | whether postures come out as wanted, tried with everything on |
//!
//! [`Calibration::fit`] lets the head's own simulation settle on a spread of control values with lip
//! contact off (so that a target past contact means pressure), and fits the measured mouth as a full
//! quadratic in them. [`Calibration::controls`] then looks for the controls whose fitted mouth comes
//! nearest to an [`Articulation`], within their ranges and with as little muscle as will do: bounded,
//! held-back Gauss-Newton with cyclic coordinate descent inside. The reference head's fit is carried as data.
//!
//! It drives the five muscles that speech decides by (HABER 5.2 names no five: the two halves of the
//! orbicularis oris, levator labii superioris, risorius, depressor labii inferioris) and the
//! protrusion of the first two. Jaw and tongue are passed through.

mod fit;
mod reach;
mod verify;

use serde::{Deserialize, Serialize};

pub use reach::{Measure, Miss, Reach};
pub use verify::{MeasureError, Verification};

use crate::{Articulation, Control, Controls};

/// What is solved for, and the range the fit is sound in.
const SOLVED: [(Control, f32, f32); 7] = [
    (Control::OrbicularisOrisSuperior, 0.0, 0.9),
    (Control::OrbicularisOrisInferior, 0.0, 0.9),
    (Control::LevatorLabiiSuperioris, 0.0, 0.6),
    (Control::Risorius, 0.0, 0.5),
    (Control::DepressorLabiiInferioris, 0.0, 0.6),
    (Control::ProtrusionSuperior, -0.6, 0.9),
    (Control::ProtrusionInferior, -0.6, 0.9),
];
/// Highest jaw angle of the fit, radians.
const JAW_MAX: f32 = 0.22;
/// Variables of the quadratic: the solved controls and the jaw.
const VARIABLES: usize = SOLVED.len() + 1;
const TERMS: usize = 1 + VARIABLES + VARIABLES * (VARIABLES + 1) / 2;
/// Aperture, width, protrusion, lip to teeth.
const MEASURES: usize = 4;
/// Weight of a measure's error (per mm) and of a muscle's effort. A lip that is wanted at the teeth is wanted there above all.
const WEIGHTS: [f32; MEASURES] = [1.0, 0.45, 0.8, 2.0];
const EFFORT: [f32; SOLVED.len()] = [0.5, 0.5, 1.6, 1.0, 1.6, 0.3, 0.3];
/// Weight that keeps both halves of the orbicularis oris alike in contraction and in protrusion.
const ALIKE: f32 = 12.0;
/// Which of the solved are those halves.
const PAIRS: [(usize, usize); 2] = [(0, 1), (5, 6)];
/// Steps towards a posture, and those of them that the target takes to get where it is wanted.
const IMPROVEMENTS: usize = 100;
const APPROACH: usize = 50;
/// What holds them back: always, and per square of what is missed, weighted.
const HOLD: f32 = 4.0;
const HOLD_PER_MISSED: f32 = 0.6;

/// A calibration that cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// No JSON of the expected form.
    #[error("calibration: {0}; make it anew from the head")]
    Json(#[from] serde_json::Error),
    /// A quadratic of another length.
    #[error(
        "calibration has {found} terms where this version has {TERMS}; make it anew from the head"
    )]
    Terms {
        /// Terms in the file.
        found: usize,
    },
    /// A term that is no finite number, or a mouth without width.
    #[error("calibration holds a number that cannot be; make it anew from the head")]
    Number,
}

/// How one head's mouth answers to its muscles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Distance between the corners of the mouth at rest, mm.
    rest_width_mm: f32,
    /// Per measure: the quadratic's terms.
    quadratics: [Vec<f32>; MEASURES],
}

/// Of a head whose mouth is not learnt yet: no muscle does anything.
impl Default for Calibration {
    fn default() -> Self {
        Self {
            rest_width_mm: 50.0,
            quadratics: std::array::from_fn(|_| vec![0.0; TERMS]),
        }
    }
}

impl Calibration {
    /// Itself, when it is one that this version can work with.
    pub(crate) fn checked(self) -> Result<Self, CalibrationError> {
        if let Some(q) = self.quadratics.iter().find(|q| q.len() != TERMS) {
            return Err(CalibrationError::Terms { found: q.len() });
        }
        let finite = self.quadratics.iter().flatten().all(|t| t.is_finite());
        if finite && self.rest_width_mm.is_finite() && self.rest_width_mm > 0.0 {
            Ok(self)
        } else {
            Err(CalibrationError::Number)
        }
    }

    /// This one for a mouth of another width at rest: its answers in width are in proportion, the others stay. For a
    /// head fitted from the one that this was measured on; [`Self::fit`] is exact.
    #[must_use]
    pub fn for_width(&self, rest_width_mm: f32) -> Self {
        let mut other = self.clone();
        let ratio = rest_width_mm / self.rest_width_mm;
        if ratio.is_finite() && ratio > 0.0 {
            other.rest_width_mm = rest_width_mm;
            for term in &mut other.quadratics[1] {
                *term *= ratio;
            }
        }
        other
    }

    /// The muscles for a posture: lips by the fit, jaw and tongue as they are.
    #[must_use]
    pub fn controls(&self, articulation: &Articulation) -> Controls {
        let articulation = &bounded(articulation);
        let mut x = [0.0; VARIABLES];
        x[SOLVED.len()] = articulation.jaw_rad.min(JAW_MAX);
        let wanted = self.wanted(articulation);
        let mut weights = WEIGHTS;
        if articulation.lip_teeth_mm.is_none() {
            weights[3] = 0.0;
        }
        // Always as many steps, each a smooth function of the last: so is the whole.
        // The target sets out from where the mouth is: of several ways to reach it, that is taken which leads there
        // from rest, not now the one and now the other.
        let rest = self.value(&x);
        for i in 1..=IMPROVEMENTS {
            let share = (i as f32 / APPROACH as f32).min(1.0);
            let on_the_way = std::array::from_fn(|m| rest[m] + (wanted[m] - rest[m]) * share);
            x = self.improved(&x, &on_the_way, &weights);
        }
        let mut controls = controls_of(&x);
        controls[Control::Jaw] = articulation.jaw_rad;
        controls[Control::TongueTip] = articulation.tongue.tip;
        controls[Control::TongueOut] = articulation.tongue.out;
        controls[Control::TongueBody] = articulation.tongue.body;
        controls.clamped()
    }

    /// The mouth that the fit expects of `controls`: aperture, width, protrusion, lip to teeth, mm.
    #[must_use]
    pub fn expected(&self, controls: &Controls) -> [f32; 4] {
        let mut x = [0.0; VARIABLES];
        for (value, (control, ..)) in x.iter_mut().zip(SOLVED) {
            *value = controls[control];
        }
        x[SOLVED.len()] = controls[Control::Jaw];
        self.value(&x)
    }

    /// An articulation's measures, mm; one that does not matter counts as 0.
    fn wanted(&self, articulation: &Articulation) -> [f32; MEASURES] {
        [
            articulation.aperture_mm,
            articulation.width * self.rest_width_mm,
            articulation.protrusion_mm,
            articulation.lip_teeth_mm.unwrap_or(0.0),
        ]
    }

    fn value(&self, x: &[f32; VARIABLES]) -> [f32; MEASURES] {
        let terms = terms(x);
        std::array::from_fn(|m| {
            self.quadratics[m]
                .iter()
                .zip(&terms)
                .map(|(q, t)| q * t)
                .sum()
        })
    }

    /// A Gauss-Newton step on the solved controls, held back the more the farther the mouth still is from where it
    /// is wanted (Levenberg and Marquardt's way): at a target out of reach it would swing to and fro.
    fn improved(
        &self,
        x: &[f32; VARIABLES],
        wanted: &[f32; MEASURES],
        weights: &[f32; MEASURES],
    ) -> [f32; VARIABLES] {
        const N: usize = SOLVED.len();
        const STEP: f32 = 1e-3;
        let now = self.value(x);
        let missed: f32 = (0..MEASURES)
            .map(|m| (weights[m] * (wanted[m] - now[m])).powi(2))
            .sum();
        let hold = HOLD + HOLD_PER_MISSED * missed;
        // Normal equations of the linearised problem: gram * d = slope.
        let (mut gram, mut slope) = ([[0.0_f32; N]; N], [0.0_f32; N]);
        let slopes: [[f32; MEASURES]; N] = std::array::from_fn(|i| {
            let mut moved = *x;
            moved[i] += STEP;
            let there = self.value(&moved);
            std::array::from_fn(|m| (there[m] - now[m]) / STEP)
        });
        for i in 0..N {
            for j in 0..N {
                gram[i][j] = (0..MEASURES)
                    .map(|m| weights[m].powi(2) * slopes[i][m] * slopes[j][m])
                    .sum();
            }
            slope[i] = (0..MEASURES)
                .map(|m| weights[m].powi(2) * slopes[i][m] * (wanted[m] - now[m]))
                .sum();
            gram[i][i] += EFFORT[i] + hold;
            slope[i] -= EFFORT[i] * x[i];
        }
        for (a, b) in PAIRS {
            gram[a][a] += ALIKE;
            gram[b][b] += ALIKE;
            gram[a][b] -= ALIKE;
            gram[b][a] -= ALIKE;
            slope[a] -= ALIKE * (x[a] - x[b]);
            slope[b] -= ALIKE * (x[b] - x[a]);
        }
        let mut step = [0.0_f32; N];
        for _ in 0..30 {
            for i in 0..N {
                let rest: f32 = (0..N)
                    .filter(|&j| j != i)
                    .map(|j| gram[i][j] * step[j])
                    .sum();
                let (_, low, high) = SOLVED[i];
                step[i] = ((slope[i] - rest) / gram[i][i]).clamp(low - x[i], high - x[i]);
            }
        }
        let mut there = *x;
        for (value, change) in there.iter_mut().zip(step) {
            // Half of the way: the whole would swing to and fro between bounds.
            *value += 0.5 * change;
        }
        there
    }
}

/// The articulation within bounds that no mouth leaves; what is no number is as at rest.
fn bounded(a: &Articulation) -> Articulation {
    let within = |value: f32, low: f32, high: f32, rest: f32| {
        if value.is_finite() {
            value.clamp(low, high)
        } else {
            rest
        }
    };
    let rest = Articulation::REST;
    Articulation {
        aperture_mm: within(a.aperture_mm, -10.0, 40.0, rest.aperture_mm),
        width: within(a.width, 0.4, 1.6, rest.width),
        protrusion_mm: within(a.protrusion_mm, -6.0, 12.0, rest.protrusion_mm),
        lip_teeth_mm: a
            .lip_teeth_mm
            .filter(|mm| mm.is_finite())
            .map(|mm| mm.clamp(-3.0, 30.0)),
        jaw_rad: {
            let (low, high) = Control::Jaw.range();
            within(a.jaw_rad, low, high, rest.jaw_rad)
        },
        tongue: a.tongue,
    }
}

fn controls_of(x: &[f32; VARIABLES]) -> Controls {
    let mut controls = Controls::default();
    for (value, (control, ..)) in x.iter().zip(SOLVED) {
        controls[control] = *value;
    }
    controls[Control::Jaw] = x[SOLVED.len()];
    controls
}

fn terms(x: &[f32; VARIABLES]) -> [f32; TERMS] {
    let mut terms = [1.0; TERMS];
    terms[1..=VARIABLES].copy_from_slice(x);
    let mut next = 1 + VARIABLES;
    for i in 0..VARIABLES {
        for j in i..VARIABLES {
            terms[next] = x[i] * x[j];
            next += 1;
        }
    }
    terms
}
