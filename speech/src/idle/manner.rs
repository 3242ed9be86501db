//! What a face is doing while it says nothing, or something: the four states of a conversation, and how it
//! goes over from one to the next.

use mouthpiece_phonemes::TICK_RATE;

use crate::contact::ease;

/// What a face is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum State {
    /// Nobody is there.
    #[default]
    Idle,
    /// Somebody speaks to it.
    Listening,
    /// It looks for words.
    Thinking,
    /// It has the word, also between sentences.
    Speaking,
}

impl State {
    const COUNT: usize = 4;
    /// All of them.
    pub const ALL: [Self; Self::COUNT] =
        [Self::Idle, Self::Listening, Self::Thinking, Self::Speaking];
}

/// How much of each state a face is in; the shares sum to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manner {
    shares: [f32; State::COUNT],
}

impl From<State> for Manner {
    fn from(state: State) -> Self {
        let mut shares = [0.0; State::COUNT];
        shares[state as usize] = 1.0;
        Self { shares }
    }
}

impl Default for Manner {
    fn default() -> Self {
        State::Idle.into()
    }
}

impl Manner {
    /// `share` of the way to `other`.
    #[must_use]
    pub fn towards(self, other: impl Into<Self>, share: f32) -> Self {
        // What is no number is nothing.
        let share = share.clamp(0.0, 1.0);
        let share = if share.is_finite() { share } else { 0.0 };
        let other = other.into();
        let mut shares = self.shares;
        for (own, other) in shares.iter_mut().zip(other.shares) {
            *own += (other - *own) * share;
        }
        Self { shares }
    }

    /// How much of `state`.
    #[must_use]
    pub fn of(&self, state: State) -> f32 {
        self.shares[state as usize]
    }

    /// The mean of a figure that each state has, in the order of [`State::ALL`].
    pub(super) fn mean(&self, figures: [f32; State::COUNT]) -> f32 {
        self.shares.iter().zip(figures).map(|(s, f)| s * f).sum()
    }
}

/// How long a face takes from one state to another, ticks (judgement: a shift of posture takes a second or
/// two, one of attention less).
const CHANGE: i64 = TICK_RATE * 7 / 10;
/// Changes that are remembered: more than fit into the time that anyone goes back to.
const CHANGES_MAX: usize = 16;

/// States over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct States {
    /// In order of time.
    changes: Vec<(i64, State)>,
}

impl States {
    /// One state throughout.
    #[must_use]
    pub fn always(state: State) -> Self {
        Self {
            changes: vec![(i64::MIN, state)],
        }
    }

    /// From `ticks` on it is `state`; what was to come after that does not.
    pub fn change(&mut self, ticks: i64, state: State) {
        self.changes.retain(|(at, _)| *at < ticks);
        if self.changes.len() >= CHANGES_MAX {
            // Long over: the first is what it was before.
            self.changes.remove(0);
        }
        self.changes.push((ticks, state));
    }

    /// The manner at `ticks`.
    #[must_use]
    pub fn at(&self, ticks: i64) -> Manner {
        let mut manner = Manner::default();
        for &(at, state) in self.changes.iter().take_while(|(at, _)| *at <= ticks) {
            let share = ticks.saturating_sub(at) as f32 / CHANGE as f32;
            manner = manner.towards(state, ease(share));
        }
        manner
    }
}
