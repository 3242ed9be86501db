//! What it costs to know labels only shortly before they begin: for `curves --look-ahead`.

use std::fmt;

use mouthpiece_rig::{Control, STEP_TICKS, TICK_RATE};
use mouthpiece_speech::{LookAhead, Track};

/// Controls that move less than this are not counted.
const MOVES: f32 = 0.01;

/// How far from all that is known offline, as shares of each control's range in the utterance.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// Root of the mean square over all controls that move.
    pub rms: f32,
    /// The same of the control that is furthest off.
    pub worst_rms: f32,
    worst: Option<Control>,
}

impl Cost {
    /// Speaks all of `coming` beside `whole`.
    pub fn of(whole: &Track, mut coming: LookAhead) -> Self {
        let count = Control::COUNT;
        let (mut low, mut high) = (vec![f32::MAX; count], vec![f32::MIN; count]);
        let mut square = vec![0.0_f64; count];
        let mut instants = 0.0;
        let mut time = whole.start() - TICK_RATE;
        while time < whole.end() {
            coming.advance(time);
            let known = coming.stream().controls_at(time);
            let all = whole.controls_at(time);
            for &control in Control::ALL {
                let i = control as usize;
                low[i] = low[i].min(all[control]);
                high[i] = high[i].max(all[control]);
                square[i] += f64::from(known[control] - all[control]).powi(2);
            }
            instants += 1.0;
            time += STEP_TICKS;
        }
        let shares = Control::ALL.iter().filter_map(|&control| {
            let i = control as usize;
            let range = high[i] - low[i];
            (range > MOVES).then(|| (control, (square[i] / instants).sqrt() as f32 / range))
        });
        let shares: Vec<_> = shares.collect();
        let mean = shares.iter().map(|(_, s)| s * s).sum::<f32>() / shares.len().max(1) as f32;
        let worst = shares.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        Self {
            rms: mean.sqrt(),
            worst_rms: worst.map_or(0.0, |w| w.1),
            worst: worst.map(|w| w.0),
        }
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:.2} % of range RMS off what is told when all is known",
            self.rms * 100.0
        )?;
        match self.worst {
            Some(control) => write!(
                f,
                " (at most {:.2} %, in {})",
                self.worst_rms * 100.0,
                control.name()
            ),
            None => Ok(()),
        }
    }
}
