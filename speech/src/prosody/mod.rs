//! What the sound of an utterance says about how it is said: how loud each moment is, and which syllables
//! stand out. For [`Track`](crate::Track), whose mouth opens wider for what is loud, and
//! [`Idle`](crate::Idle), whose head and brows go with stressed words.
//!
//! Sound comes in pieces as it arrives; the same sound in other pieces gives the same. A moment is
//! judged for stress a tenth of a second after it. After the start nothing is allocated but what comes out. Loudness and
//! pitch are compared with what the voice did before, so that neither gain nor voice matters. It knows no
//! words and no phones.

mod accent;
mod frame;

use mouthpiece_phonemes::TICK_RATE;

use accent::Peaks;
use frame::Window;

/// Ticks from one moment to the next: 10 ms.
pub(crate) const HOP: i64 = TICK_RATE / 100;

/// A syllable that stands out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accent {
    /// Its loudest moment, ticks from the sound's start.
    pub at: i64,
    /// How much it stands out, 0 to 1.
    pub size: f32,
    /// Whether the voice's pitch rises to it.
    pub rises: bool,
}

/// How an utterance is said, as far as it was heard.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Delivery {
    /// Loudness of voiced sound against the voice's mean, in its deviations, -1 to 1; 0 where there is
    /// none. One each 10 ms.
    pub loudness: Vec<f32>,
    /// Stressed syllables in order of time.
    pub accents: Vec<Accent>,
}

/// Listens to an utterance.
#[derive(Clone, Debug)]
pub struct Listener {
    window: Window,
    peaks: Peaks,
}

impl Default for Listener {
    fn default() -> Self {
        Self {
            window: Window::new(),
            peaks: Peaks::new(),
        }
    }
}

impl Listener {
    /// Hears more sound, 48 kHz, one channel, and adds to `out` what is known by now.
    pub fn hear(&mut self, mono: &[f32], out: &mut Delivery) {
        for &sample in mono {
            if let Some(frame) = self.window.push(sample) {
                let (loudness, accent) = self.peaks.push(frame);
                out.loudness.push(loudness);
                out.accents.extend(accent);
            }
        }
    }

    /// All of a sound at once.
    #[must_use]
    pub fn whole(mono: &[f32]) -> Delivery {
        let mut out = Delivery::default();
        Self::default().hear(mono, &mut out);
        out
    }
}

#[cfg(test)]
mod tests;
