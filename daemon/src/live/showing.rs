//! What a client has the face show besides speech: expressions and where it looks, each a function of
//! the tick, so that a rewind finds what was there.
//!
//! Changes begin at the instant that is heard when they come and go over smoothly, also out of a
//! change that is still under way. Expressions are laid over speech by rig, which keeps the lips for
//! what they must close ([`mouthpiece_rig::Mouth`], HEADSHOP 3). On the simulation thread.

use mouthpiece_rig::{Control, Controls, TICK_RATE};
use mouthpiece_speech::State;

/// What is to be shown from now on.
#[derive(Clone, Debug, PartialEq)]
pub enum Showing {
    /// A face, reached after `fade` ticks; all 0 is none.
    Face { controls: Box<Controls>, fade: i64 },
    /// Where to look; none is the face's own life. The eyes are quick, the head follows in `fade` ticks.
    Look { at: Option<Direction>, fade: i64 },
    /// What it does while it says nothing.
    State(State),
    /// The same, and what it goes back to some time after it has spoken.
    Rest(State),
}

/// Relative to where a head at rest looks, radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Direction {
    /// To the face's own left.
    pub yaw: f32,
    /// Up.
    pub pitch: f32,
}

impl Direction {
    /// Towards a point: mm to the face's left, up and to its front, from the middle between the eyes.
    pub fn to([left, up, front]: [f32; 3]) -> Self {
        Self {
            yaw: left.atan2(front),
            pitch: up.atan2(left.hypot(front)),
        }
    }
}

/// Up to here the eyes turn alone, radians: people turn the head for what is farther aside (15 degrees,
/// judgement; reported are 15 to 20).
const EYES_ALONE: f32 = 0.26;
/// Of what is beyond, the head's share (judgement).
const HEAD_SHARE: f32 = 0.6;
/// Eyes take 25 ms and 2.4 ms a degree to get somewhere (Becker); here for half the widest way, 40 degrees.
const SACCADE_TICKS: i64 = TICK_RATE * 121 / 1000;
/// How far the lids go down per radian of gaze (judgement: as those of the face's own glances).
const LID_PER_RAD: f32 = 0.9;
/// Changes under way or not yet forgotten. More come only from a client that floods; then the oldest
/// are taken as over.
const CHANGES_MAX: usize = 16;

/// The face and the gaze over time.
#[derive(Debug, Default)]
pub struct Shown {
    face: Fading<Controls>,
    eyes: Fading<Aim>,
    head: Fading<Aim>,
}

/// How much the eyes (or the head) are held, and where, times that.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Aim {
    held: f32,
    yaw: f32,
    pitch: f32,
}

impl Shown {
    pub fn face(&mut self, tick: i64, controls: Controls, fade: i64) {
        self.face.change(tick, controls, fade);
    }

    pub fn look(&mut self, tick: i64, at: Option<Direction>, fade: i64) {
        let eyes = at.map_or_else(Aim::default, |at| Aim {
            held: 1.0,
            yaw: at.yaw,
            pitch: at.pitch,
        });
        let turned = |angle: f32| {
            let beyond = (angle.abs() - EYES_ALONE).max(0.0);
            (beyond * HEAD_SHARE).copysign(angle)
        };
        let head = Aim {
            yaw: turned(eyes.yaw),
            pitch: turned(eyes.pitch),
            ..eyes
        };
        self.eyes.change(tick, eyes, SACCADE_TICKS);
        self.head.change(tick, head, fade);
    }

    /// The expression at `tick`, none where there is nothing to lay over speech.
    pub fn face_at(&self, tick: i64) -> Option<Controls> {
        (!self.face.is_still(&Controls::default())).then(|| self.face.at(tick))
    }

    /// Turns eyes and head away from what the face's own life has them do.
    pub fn aim(&self, tick: i64, controls: &mut Controls) {
        let (eyes, head) = (self.eyes.at(tick), self.head.at(tick));
        if eyes == Aim::default() && head == Aim::default() {
            return;
        }
        let own = 1.0 - eyes.held;
        let mut turn = |gaze: Control, neck: Control, eyes: f32, head: f32| {
            let direction = (controls[gaze] + controls[neck]) * own + eyes;
            let (least, most) = neck.range();
            controls[neck] = (controls[neck] + head).clamp(least, most);
            // Whatever the head does, the eyes stay where they look.
            controls[gaze] = direction - controls[neck];
        };
        turn(Control::GazeYaw, Control::HeadYaw, eyes.yaw, head.yaw);
        turn(
            Control::GazePitch,
            Control::HeadPitch,
            eyes.pitch,
            head.pitch,
        );
        let lid = (-eyes.pitch * LID_PER_RAD).clamp(0.0, 0.4);
        for side in [Control::LidL, Control::LidR] {
            controls[side] = controls[side].max(lid);
        }
        *controls = controls.clamped();
    }

    /// What was over before `tick` needs no time any more.
    pub fn forget_before(&mut self, tick: i64) {
        self.face.forget_before(tick);
        self.eyes.forget_before(tick);
        self.head.forget_before(tick);
    }
}

/// Something between two of its kind.
trait Blend: Copy + PartialEq {
    fn towards(&self, other: &Self, share: f32) -> Self;
}

impl Blend for Controls {
    fn towards(&self, other: &Self, share: f32) -> Self {
        self.lerp(other, share)
    }
}

impl Blend for Aim {
    fn towards(&self, other: &Self, share: f32) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * share;
        Self {
            held: mix(self.held, other.held),
            yaw: mix(self.yaw, other.yaw),
            pitch: mix(self.pitch, other.pitch),
        }
    }
}

/// A value that goes from change to change without a jump, nor one of its speed.
#[derive(Debug)]
struct Fading<T> {
    /// Before the first change.
    base: T,
    /// In order of time.
    changes: Vec<Change<T>>,
}

#[derive(Debug)]
struct Change<T> {
    tick: i64,
    fade: i64,
    to: T,
}

impl<T: Default> Default for Fading<T> {
    fn default() -> Self {
        Self {
            base: T::default(),
            // Never more, so that the simulation thread does not allocate here.
            changes: Vec::with_capacity(CHANGES_MAX),
        }
    }
}

impl<T: Blend> Fading<T> {
    /// From `tick` on it goes to `to`; what was to come after that does not.
    fn change(&mut self, tick: i64, to: T, fade: i64) {
        self.changes.retain(|c| c.tick < tick);
        if self.changes.len() >= CHANGES_MAX {
            self.base = self.changes.remove(0).to;
        }
        self.changes.push(Change { tick, fade, to });
    }

    fn at(&self, tick: i64) -> T {
        let begun = self.changes.iter().take_while(|c| c.tick <= tick);
        begun.fold(self.base, |value, change| {
            let since = tick.saturating_sub(change.tick);
            if since >= change.fade {
                return change.to;
            }
            let x = since as f32 / change.fade as f32;
            value.towards(&change.to, x * x * (3.0 - 2.0 * x))
        })
    }

    fn is_still(&self, value: &T) -> bool {
        self.base == *value && self.changes.is_empty()
    }

    fn forget_before(&mut self, tick: i64) {
        let over = |c: &Change<T>| c.tick.saturating_add(c.fade) <= tick;
        while self.changes.first().is_some_and(over) {
            self.base = self.changes.remove(0).to;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn smile(share: f32) -> Controls {
        let mut controls = Controls::default();
        controls[Control::ZygomaticusMajor] = share;
        controls
    }

    #[test]
    fn faces_go_over_smoothly_also_out_of_one_another_and_end() {
        let mut shown = Shown::default();
        assert!(shown.face_at(0).is_none());
        shown.face(100, smile(1.0), 4800);
        shown.face(2500, smile(0.2), 4800);
        shown.face(9000, smile(0.0), 4800);
        let value = |tick| shown.face_at(tick).unwrap()[Control::ZygomaticusMajor];
        assert_eq!((value(100), value(7300), value(20_000)), (0.0, 0.2, 0.0));
        assert!(value(2500) > 0.4);
        for tick in (0..20_000).step_by(48) {
            assert!((value(tick + 48) - value(tick)).abs() < 0.02, "at {tick}");
        }
        shown.forget_before(20_000);
        assert!(shown.face_at(20_000).is_none(), "nothing left to lay over");
    }

    #[test]
    fn a_flood_of_changes_is_bounded_and_the_last_one_holds() {
        let mut shown = Shown::default();
        for tick in 0..1000 {
            shown.face(tick, smile((tick % 2) as f32), 48_000);
        }
        assert_eq!(shown.face.changes.len(), CHANGES_MAX);
        assert_eq!(shown.face_at(100_000), Some(smile(1.0)));
    }

    #[test]
    fn eyes_reach_the_point_before_the_head_does_and_stay_on_it() {
        let mut shown = Shown::default();
        let right = Direction::to([-500.0, 0.0, 500.0]);
        shown.look(0, Some(right), 24_000);
        let told = |tick: i64| {
            // Its own life glances and sways.
            let mut controls = Controls::default();
            controls[Control::GazeYaw] = 0.1;
            controls[Control::HeadYaw] = 0.02;
            shown.aim(tick, &mut controls);
            (controls[Control::GazeYaw], controls[Control::HeadYaw])
        };
        assert_eq!(told(-1), (0.1, 0.02));
        for tick in (SACCADE_TICKS..48_000).step_by(480) {
            let (gaze, head) = told(tick);
            // As far as eyes turn.
            let seen = gaze + head;
            let most = 0.6 + head.abs();
            assert!(
                (seen - right.yaw.max(-most)).abs() < 1e-4,
                "{seen} at {tick}"
            );
        }
        assert!(told(48_000).1 < -0.28, "{:?}", told(48_000));
    }

    #[test]
    fn directions_are_the_faces_own() {
        let there = Direction::to([300.0, 400.0, 400.0]);
        assert!(there.yaw > 0.0 && (there.pitch - (400.0_f32 / 500.0).atan()).abs() < 1e-6);
        assert_eq!(Direction::to([0.0, 0.0, 1000.0]), Direction::default());
    }
}
