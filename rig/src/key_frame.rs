//! The simulation's whole state at one instant: what the renderer draws and what a rewind resumes from.
//!
//! HABER 5.3 keeps displacements and component parameters in each slot of its ring; velocities are
//! added here, so that `stop` or a late label can go back to any slot and simulate again from there.

use glam::Vec3;

use crate::Controls;

/// Ticks in a second: all time in Mouthpiece is counted in frames of 48 kHz sound, in integers.
pub const TICK_RATE: i64 = 48_000;

/// The head at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeyFrame {
    /// When, in ticks of [`TICK_RATE`].
    pub time: i64,
    /// Which past this follows from; a rewind starts a new epoch and older frames are void.
    pub epoch: u32,
    /// Skin vertices in the head's frame, mm, in the order of [`Head::skin`](crate::Head).
    pub skin: Vec<Vec3>,
    /// Velocities of the same, mm/s.
    pub velocity: Vec<Vec3>,
    /// Places and velocities of what the tissue has below the skin, one after the other; empty for the default
    /// model, which has nothing there.
    pub inner: Vec<Vec3>,
    /// Where muscles, jaw, tongue, lids, gaze and head really are (they have inertia), as controls.
    pub state: Controls,
    /// How fast the same change, per second.
    pub state_rate: Controls,
}

impl KeyFrame {
    /// Sets this frame to what lies between `a` and `b` at `time`, without allocating once its
    /// buffers have grown. Times outside the two are held at the nearer one.
    pub fn set_between(&mut self, a: &Self, b: &Self, time: i64) {
        let span = (b.time - a.time).max(1) as f32;
        let share = ((time - a.time) as f32 / span).clamp(0.0, 1.0);
        self.time = time;
        self.epoch = b.epoch;
        self.state = a.state.lerp(&b.state, share);
        self.state_rate = a.state_rate.lerp(&b.state_rate, share);
        blend(&mut self.skin, &a.skin, &b.skin, share);
        blend(&mut self.velocity, &a.velocity, &b.velocity, share);
        blend(&mut self.inner, &a.inner, &b.inner, share);
    }

    /// Copies `other` into this frame's own buffers.
    pub fn copy_from(&mut self, other: &Self) {
        self.time = other.time;
        self.epoch = other.epoch;
        self.state = other.state;
        self.state_rate = other.state_rate;
        self.skin.clone_from(&other.skin);
        self.velocity.clone_from(&other.velocity);
        self.inner.clone_from(&other.inner);
    }
}

fn blend(out: &mut Vec<Vec3>, a: &[Vec3], b: &[Vec3], share: f32) {
    out.clear();
    out.extend(a.iter().zip(b).map(|(a, b)| a.lerp(*b, share)));
}
