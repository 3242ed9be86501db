//! From what a mouth should do to what its muscles must do, for one head.
//!
//! [`Calibration::fit`] lets the head's own simulation settle on a spread of control values with lip
//! contact off (so that a target past contact means pressure), and fits the measured mouth as a full
//! quadratic in them. [`Calibration::controls`] then looks for the controls whose fitted mouth comes
//! nearest to an [`Articulation`], within their ranges and with as little muscle as will do: bounded
//! Gauss-Newton with cyclic coordinate descent inside. The reference head's fit is carried as data.
//!
//! It drives the five muscles that speech decides by (HABER 5.2 names no five: the two halves of the
//! orbicularis oris, levator labii superioris, risorius, depressor labii inferioris) and the
//! protrusion of the first two. Jaw and tongue are passed through.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::{Articulation, Control, Controls, Head, KeyFrame, Simulation, measure};

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
/// Postures that the fit is made from, and how long each is left to settle.
const SAMPLES: usize = 200;
const SETTLE_STEPS: usize = 170;
/// Weight of a measure's error (per mm) and of a muscle's effort.
const WEIGHTS: [f32; MEASURES] = [1.0, 0.45, 0.8, 0.9];
const EFFORT: [f32; SOLVED.len()] = [0.5, 0.5, 1.6, 1.0, 1.6, 0.3, 0.3];
/// Weight that keeps both halves of the orbicularis oris alike in contraction and in protrusion.
const ALIKE: f32 = 1.2;

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

    /// Fits `head`: some seconds of work.
    #[must_use]
    pub fn fit(head: &Arc<Head>) -> Self {
        let done = Self::fit_reporting(head, |_, _| Ok::<(), std::convert::Infallible>(()));
        match done {
            Ok(calibration) => calibration,
            Err(never) => match never {},
        }
    }

    /// As [`Self::fit`]; calls `progress` with the postures done and all of them, and ends early
    /// with its error.
    ///
    /// # Errors
    /// Only those of `progress`.
    pub fn fit_reporting<E>(
        head: &Arc<Head>,
        mut progress: impl FnMut(usize, usize) -> Result<(), E>,
    ) -> Result<Self, E> {
        let mut simulation = Simulation::new(Arc::clone(head));
        simulation.set_lip_contact(false);
        let rest = head.rest_frame();
        let mut frame = rest.clone();
        let mut rows = Vec::with_capacity(SAMPLES);
        let mut values = [const { Vec::new() }; MEASURES];
        for sample in 0..SAMPLES {
            progress(sample, SAMPLES)?;
            let x = posture(sample);
            simulation.restore(&rest);
            for _ in 0..SETTLE_STEPS {
                simulation.step(&controls_of(&x));
            }
            simulation.save(&mut frame);
            rows.push(terms(&x));
            for (list, value) in values.iter_mut().zip(measured(head, &frame)) {
                list.push(value);
            }
        }
        let rest_width_mm = measure(head, &rest).width_mm;
        Ok(Self {
            rest_width_mm,
            quadratics: values.map(|v| least_squares(&rows, &v)),
        })
    }

    /// The muscles for a posture: lips by the fit, jaw and tongue as they are.
    #[must_use]
    pub fn controls(&self, articulation: &Articulation) -> Controls {
        let mut x = [0.0; VARIABLES];
        x[SOLVED.len()] = articulation.jaw_rad.clamp(0.0, JAW_MAX);
        let wanted = [
            articulation.aperture_mm,
            articulation.width * self.rest_width_mm,
            articulation.protrusion_mm,
            articulation.lip_teeth_mm.unwrap_or(0.0),
        ];
        let mut weights = WEIGHTS;
        if articulation.lip_teeth_mm.is_none() {
            weights[3] = 0.0;
        }
        for _ in 0..24 {
            self.improve(&mut x, &wanted, &weights);
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

    /// One damped Gauss-Newton step on the solved controls.
    fn improve(
        &self,
        x: &mut [f32; VARIABLES],
        wanted: &[f32; MEASURES],
        weights: &[f32; MEASURES],
    ) {
        const N: usize = SOLVED.len();
        const STEP: f32 = 1e-3;
        let now = self.value(x);
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
            gram[i][i] += EFFORT[i];
            slope[i] -= EFFORT[i] * x[i];
        }
        for (a, b) in [(0, 1), (5, 6)] {
            gram[a][a] += ALIKE;
            gram[b][b] += ALIKE;
            gram[a][b] -= ALIKE;
            gram[b][a] -= ALIKE;
            slope[a] -= ALIKE * (x[a] - x[b]);
            slope[b] -= ALIKE * (x[b] - x[a]);
        }
        let mut step = [0.0_f32; N];
        for _ in 0..40 {
            for i in 0..N {
                let rest: f32 = (0..N)
                    .filter(|&j| j != i)
                    .map(|j| gram[i][j] * step[j])
                    .sum();
                let (_, low, high) = SOLVED[i];
                step[i] = ((slope[i] - rest) / gram[i][i]).clamp(low - x[i], high - x[i]);
            }
        }
        for (value, change) in x.iter_mut().zip(step) {
            *value += 0.7 * change;
        }
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

/// The n-th posture of a Halton sequence over the fit's ranges; the first is the head at rest.
fn posture(n: usize) -> [f32; VARIABLES] {
    const PRIMES: [usize; VARIABLES] = [2, 3, 5, 7, 11, 13, 17, 19];
    if n == 0 {
        return [0.0; VARIABLES];
    }
    std::array::from_fn(|i| {
        let (low, high) = SOLVED
            .get(i)
            .map_or((0.0, JAW_MAX), |&(_, low, high)| (low, high));
        let (mut rest, mut scale, mut share) = (n + 20, 1.0, 0.0);
        while rest > 0 {
            scale /= PRIMES[i] as f32;
            share += scale * (rest % PRIMES[i]) as f32;
            rest /= PRIMES[i];
        }
        // Denser towards the relaxed end: muscles are rarely all hard at work.
        let share = if low < 0.0 { share } else { share * share };
        low + (high - low) * share
    })
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

fn measured(head: &Head, frame: &KeyFrame) -> [f32; MEASURES] {
    let m = measure(head, frame);
    [m.aperture_mm, m.width_mm, m.protrusion_mm, m.lip_teeth_mm]
}

/// Least squares by normal equations and Cholesky, with a trace of ridge; in f64.
fn least_squares(rows: &[[f32; TERMS]], values: &[f32]) -> Vec<f32> {
    const RIDGE: f64 = 1e-4;
    let mut a = vec![[0.0_f64; TERMS]; TERMS];
    let mut b = [0.0_f64; TERMS];
    for (row, value) in rows.iter().zip(values) {
        for i in 0..TERMS {
            b[i] += f64::from(row[i]) * f64::from(*value);
            for j in 0..TERMS {
                a[i][j] += f64::from(row[i]) * f64::from(row[j]);
            }
        }
    }
    for (i, row) in a.iter_mut().enumerate() {
        row[i] += RIDGE;
    }
    for i in 0..TERMS {
        for j in 0..=i {
            let sum: f64 = a[i][j] - (0..j).map(|k| a[i][k] * a[j][k]).sum::<f64>();
            a[i][j] = if i == j {
                sum.max(1e-12).sqrt()
            } else {
                sum / a[j][j]
            };
        }
    }
    for i in 0..TERMS {
        b[i] = (b[i] - (0..i).map(|k| a[i][k] * b[k]).sum::<f64>()) / a[i][i];
    }
    for i in (0..TERMS).rev() {
        b[i] = (b[i] - (i + 1..TERMS).map(|k| a[k][i] * b[k]).sum::<f64>()) / a[i][i];
    }
    b.iter().map(|v| *v as f32).collect()
}
