//! Lips that touch where they must, however short the label is.
//!
//! A weighted mean reaches no target, so blending alone leaves real /p b m/ open, and a virtual target
//! past contact (the tables' -2 mm) closes them only as long as they are not too short. So a labelled
//! hold has a window, after the special closure phases of Albrecht et al. 2002: within it the lip
//! controls go over from the blend to the contact target itself, and the jaw to no more than that
//! target's opening. The window is fully on in the hold's core, which keeps so far from its ends that
//! the lips meet and part at the label's own boundaries; contact has no lead but the tissue's lag.

use mouthpiece_rig::{Control, Controls};

use crate::blend::ticks;
use crate::speech::{Posture, Voice};
use crate::tables::{Contact, ContactTimes, Group};

/// The least time to go over, even between two contacts that follow each other at once, ms.
const RAMP_MS_MIN: f32 = 10.0;

/// A sound this many times as long as a long one is held throughout.
const LONG_HELD: f32 = 1.5;

/// A stretch of contact; ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hold {
    pub(crate) start: i64,
    pub(crate) end: i64,
    /// Where the first label of several ends, and where the last begins.
    pub(crate) parts: (i64, i64),
    pub(crate) kind: Contact,
    /// Index into [`Voice::postures`].
    pub(crate) posture: u16,
}

/// [`ContactTimes`] in ticks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Windows {
    lips: (i64, i64),
    jaw: (i64, i64),
    inset: i64,
    half_core_min: i64,
    half_core_max: i64,
    /// Holds longer than the first are held for longer than that, those longer than the second throughout.
    long: (i64, i64),
    ramp_min: i64,
}

impl Windows {
    pub(crate) fn new(times: &ContactTimes) -> Self {
        Self {
            lips: (ticks(times.approach_ms), ticks(times.release_ms)),
            jaw: (ticks(times.jaw_approach_ms), ticks(times.jaw_release_ms)),
            inset: ticks(times.inset_ms),
            half_core_min: ticks(times.core_ms_min / 2.0),
            half_core_max: ticks(times.core_ms_max / 2.0),
            long: (ticks(times.long_ms), ticks(times.long_ms * LONG_HELD)),
            ramp_min: ticks(RAMP_MS_MIN),
        }
    }

    /// No hold is felt further than this from its ends.
    pub(crate) fn reach(&self) -> i64 {
        let longest = [self.lips.0, self.lips.1, self.jaw.0, self.jaw.1];
        longest.into_iter().fold(self.ramp_min, i64::max) + self.half_core_min
    }

    /// Where the window of `hold` is fully on: from the first of its labels to the last.
    fn core(&self, hold: &Hold) -> (i64, i64) {
        let (first_end, last_start) = hold.parts;
        let first = self.core_of(hold.kind, hold.start, first_end);
        let last = self.core_of(hold.kind, last_start, hold.end);
        (first.0, last.1)
    }

    /// The same of one label.
    fn core_of(&self, kind: Contact, start: i64, end: i64) -> (i64, i64) {
        let half = end.saturating_sub(start) / 2;
        let middle = start.saturating_add(half);
        let whole = half - self.inset;
        // A label is longer than the contact within it, unless the sound is held on purpose.
        let (long, held) = self.long;
        let over = (half * 2 - long).max(0);
        let half = if kind == Contact::Teeth || over >= held - long {
            whole
        } else {
            let most = self.half_core_max;
            let more = (whole - most).max(0) * over / (held - long);
            whole.min(most + more)
        };
        let half = half.max(self.half_core_min);
        (middle.saturating_sub(half), middle.saturating_add(half))
    }

    /// How far `holds[i]` is in charge at `time`, 0..1, with `ramps` to come and go; both are cut
    /// short by the cores of its neighbours, so that lips part between two.
    fn weight(&self, holds: &[Hold], i: usize, time: i64, ramps: (i64, i64)) -> f32 {
        let core = self.core(&holds[i]);
        let (away, room, ramp) = if time < core.0 {
            let before = i.checked_sub(1).map(|i| self.core(&holds[i]).1);
            let room = before.map_or(i64::MAX, |before| core.0.saturating_sub(before));
            (core.0.saturating_sub(time), room, ramps.0)
        } else {
            let next = holds.get(i + 1).map(|next| self.core(next).0);
            let room = next.map_or(i64::MAX, |next| next.saturating_sub(core.1));
            (time.saturating_sub(core.1), room, ramps.1)
        };
        let ramp = ramp.min(room / 3 * 2).max(self.ramp_min);
        if away <= 0 {
            1.0
        } else if away >= ramp {
            0.0
        } else {
            ease(1.0 - away as f32 / ramp as f32)
        }
    }
}

/// 0 to 1 with no corner at either end.
pub(crate) fn ease(share: f32) -> f32 {
    let x = share.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The lips' targets of a contact as calibrated: plain, and between rounded phones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactTargets {
    pub(crate) flat: Controls,
    /// None where the contact is made in one way only, as that with the teeth.
    pub(crate) rounded: Option<Controls>,
}

impl ContactTargets {
    /// The targets for lips as rounded as `blended` says they are.
    fn at(&self, voice: &Voice, blended: &Controls) -> Controls {
        let Some(rounded) = &self.rounded else {
            return self.flat;
        };
        let (mut along, mut length) = (0.0, 0.0);
        for &control in &voice.driven[Group::Rounding as usize] {
            let span = rounded[control] - self.flat[control];
            along += span * (blended[control] - self.flat[control]);
            length += span * span;
        }
        let share = if length > 0.0 { along / length } else { 0.0 };
        self.flat.lerp(rounded, share.clamp(0.0, 1.0))
    }
}

/// Brings `controls`, the blend at `time`, into contact as far as the holds near by ask for it. That
/// of lip to lip has the last word, since all see it open.
pub(crate) fn apply(voice: &Voice, holds: &[Hold], time: i64, controls: &mut Controls) {
    let reach = voice.windows.reach();
    let first = holds.partition_point(|h| h.end < time.saturating_sub(reach));
    let near = holds[first..]
        .iter()
        .take_while(|h| h.start <= time.saturating_add(reach))
        .count();
    let blended = *controls;
    for kind in [Contact::Teeth, Contact::Lips] {
        for (i, hold) in holds.iter().enumerate().skip(first).take(near) {
            let posture = &voice.postures[usize::from(hold.posture)];
            if let (true, Some(targets)) = (hold.kind == kind, &posture.contact) {
                let windows = &voice.windows;
                let lips = windows.weight(holds, i, time, windows.lips);
                let jaw = windows.weight(holds, i, time, windows.jaw);
                close_lips(voice, targets, lips, &blended, controls);
                close_jaw(voice, posture, jaw, controls);
            }
        }
    }
}

/// How far lip to lip is in charge at `time`, or lip to teeth.
pub(crate) fn closing(voice: &Voice, holds: &[Hold], time: i64) -> f32 {
    let windows = &voice.windows;
    let reach = windows.reach();
    let first = holds.partition_point(|h| h.end < time.saturating_sub(reach));
    let mut most = 0.0_f32;
    for (i, hold) in holds.iter().enumerate().skip(first) {
        if hold.start > time.saturating_add(reach) {
            break;
        }
        most = most.max(windows.weight(holds, i, time, windows.lips));
    }
    most
}

fn close_lips(
    voice: &Voice,
    targets: &ContactTargets,
    weight: f32,
    blended: &Controls,
    controls: &mut Controls,
) {
    if weight > 0.0 {
        let target = targets.at(voice, blended);
        for group in [Group::Lips, Group::Rounding] {
            for &control in &voice.driven[group as usize] {
                let open = controls[control];
                // Written so that the target itself comes out at full weight.
                controls[control] = open * (1.0 - weight) + target[control] * weight;
            }
        }
    }
}

fn close_jaw(voice: &Voice, posture: &Posture, weight: f32, controls: &mut Controls) {
    if weight > 0.0 && voice.driven[Group::Jaw as usize].contains(&Control::Jaw) {
        let too_far = (controls[Control::Jaw] - posture.targets[Control::Jaw]).max(0.0);
        controls[Control::Jaw] -= too_far * weight;
    }
}
