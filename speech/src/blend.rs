//! Dominance functions and their blend (Cohen and Massaro 1993; HABER 5.2).
//!
//! D = alpha * exp(-theta * |tau|^c), F = sum(D * T) / sum(D), per control. Two additions: D runs out
//! to zero at the end of a bounded support, so that an evaluation only looks at segments near by;
//! and rest has a tiny constant weight, so that F is defined where no phone asks for a control.

use mouthpiece_phonemes::TICK_RATE;
use mouthpiece_rig::{Control, Controls};

use crate::speech::{Posture, Voice};
use crate::tables::{Dominance, Group};

const TICKS_PER_MS: f32 = TICK_RATE as f32 / 1000.0;

/// Milliseconds of a table as ticks.
pub(crate) fn ticks(ms: f32) -> i64 {
    (ms * TICKS_PER_MS).round() as i64
}

/// A segment, or a part of one with targets of its own, as the blend sees it; ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    pub(crate) start: i64,
    pub(crate) end: i64,
    /// The middle part, often a single instant, over which dominance is highest.
    pub(crate) core: (i64, i64),
    /// Index into [`Voice::postures`].
    pub(crate) posture: u16,
    /// How far lips and jaw go from rest, by stress; 1 is as the tables have it.
    pub(crate) scale: f32,
}

impl Piece {
    /// A piece whose core keeps `edge` ticks from its ends.
    pub(crate) fn new(start: i64, end: i64, edge: i64, posture: u16) -> Self {
        let half = end.saturating_sub(start) / 2;
        let edge = edge.min(half);
        Self {
            start,
            end,
            core: (start + edge, end - edge),
            posture,
            scale: 1.0,
        }
    }
}

/// A [`Dominance`] ready for evaluation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curve {
    dominance: Dominance,
    offset: i64,
}

impl Curve {
    pub(crate) fn new(dominance: Dominance) -> Self {
        Self {
            dominance,
            offset: ticks(dominance.offset_ms),
        }
    }

    /// How far the peak is from the middle of the segment, ticks, whichever way.
    pub(crate) const fn shift(&self) -> i64 {
        self.offset.abs()
    }

    /// D at `time` for a segment with this core, felt up to `support` ticks away.
    pub(crate) fn at(&self, time: i64, core: (i64, i64), support: i64) -> f32 {
        let d = &self.dominance;
        // The subtraction is the last thing done in integers.
        let before = core.0.saturating_add(self.offset).saturating_sub(time);
        let after = time.saturating_sub(core.1.saturating_add(self.offset));
        let (tau, theta) = if before > 0 {
            (before, d.theta_before)
        } else {
            (after.max(0), d.theta_after)
        };
        if d.alpha <= 0.0 || tau >= support {
            return 0.0;
        }
        let ms = tau as f32 / TICKS_PER_MS;
        let fall = if d.c == 1.0 { ms } else { ms.powf(d.c) };
        let edge = tau as f32 / support as f32;
        let taper = 1.0 - edge * edge;
        d.alpha * (-theta * fall).exp() * taper * taper
    }
}

/// The sums of D * T and of D, per control.
pub(crate) struct Blend<'a> {
    voice: &'a Voice,
    weighted: [f32; Control::COUNT],
    weight: [f32; Control::COUNT],
}

impl<'a> Blend<'a> {
    /// Nothing but rest.
    pub(crate) fn new(voice: &'a Voice) -> Self {
        Self {
            voice,
            weighted: voice.rest.0.map(|target| target * voice.rest_weight),
            weight: [voice.rest_weight; Control::COUNT],
        }
    }

    /// Adds what `posture` with its middle at `core` says at `time`.
    pub(crate) fn add(&mut self, time: i64, core: (i64, i64), posture: &Posture) {
        self.add_scaled(time, core, posture, 1.0);
    }

    /// The same, with the opening of lips and jaw `scale` times as far from rest.
    pub(crate) fn add_scaled(
        &mut self,
        time: i64,
        core: (i64, i64),
        posture: &Posture,
        scale: f32,
    ) {
        for group in Group::ALL {
            if !posture.governs[group as usize] {
                continue;
            }
            let curve = &self.voice.curves[posture.class][group as usize];
            let d = curve.at(time, core, self.voice.support);
            if d > 0.0 {
                let opens = matches!(group, Group::Lips | Group::Jaw);
                let scale = if opens { scale } else { 1.0 };
                for &control in &self.voice.driven[group as usize] {
                    let has = f32::from(u8::from(posture.has(control)));
                    let rest = self.voice.rest[control];
                    let target = rest + (posture.targets[control] - rest) * scale;
                    self.weighted[control as usize] += d * has * target;
                    self.weight[control as usize] += d * has;
                }
            }
        }
    }

    /// F. Controls that speech does not drive are 0.
    pub(crate) fn controls(&self) -> Controls {
        let mut out = Controls::default();
        for &control in self.voice.driven.iter().flatten() {
            out[control] = self.weighted[control as usize] / self.weight[control as usize];
        }
        out
    }
}
