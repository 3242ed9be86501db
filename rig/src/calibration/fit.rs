//! Learns how a head's mouth answers: postures settled in its own simulation, and quadratics through them.

use std::sync::Arc;

use super::{Calibration, JAW_MAX, MEASURES, SOLVED, TERMS, VARIABLES, controls_of, terms};
use crate::{Head, KeyFrame, Simulation, measure};

/// Postures that the fit is made from, and how long each is left to settle.
const SAMPLES: usize = 200;
pub(super) const SETTLE_STEPS: usize = 170;

impl Calibration {
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

/// Aperture, width, protrusion, lip to teeth, mm.
pub(super) fn measured(head: &Head, frame: &KeyFrame) -> [f32; MEASURES] {
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
