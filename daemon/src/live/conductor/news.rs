//! What is told once a turn: clients of what is heard, health of how it goes, the screen of its text.

use std::sync::Arc;

use mouthpiece_protocol::ErrorCode;

use super::{Conductor, Cue};
use crate::live::time::seconds;
use crate::live::utterance::Utterance;
use crate::live::vitals::DeviceState;

impl Conductor {
    /// Tells clients what is heard, and lets go of what was.
    pub(super) fn tell(&mut self, now_ns: i64) {
        let audible = self.output.audible(now_ns);
        let written = self.output.written();
        let mut over = Vec::new();
        for utterance in &mut self.utterances {
            utterance.tell_position(audible);
            if utterance.end().is_some_and(|end| end <= audible) {
                utterance.tell_finished();
                self.vitals.sound.finished.add(1);
                over.push(utterance.key);
            } else if !utterance.ended {
                let (hungry, most) = match utterance.start {
                    Some(start) => (
                        written - start - utterance.covered(),
                        self.rules.starved_ticks,
                    ),
                    None => (audible - utterance.fed, self.rules.unbegun_ticks()),
                };
                if hungry > most {
                    let why = format!(
                        "nothing came for {:.0} seconds; the utterance is over",
                        seconds(most)
                    );
                    utterance.tell_failed(ErrorCode::Busy, why);
                    self.vitals.sound.failed.add(1);
                    over.push(utterance.key);
                }
            }
        }
        for key in over {
            self.remove(key);
            self.cue(Cue::Done { key });
        }
        let held: i64 = self.utterances.iter().map(Utterance::sound_ticks).sum();
        let vitals = &self.vitals.sound;
        vitals.queue.set(self.utterances.len() as i64);
        vitals.held.set(held);
        vitals.audible.set(audible);
        vitals.underruns.set(self.output.underruns());
        vitals.set_device(if self.output.has_device() {
            DeviceState::Playing
        } else if self.output.wants_device() {
            DeviceState::Missing
        } else {
            DeviceState::Unwanted
        });
        self.caption(audible);
    }

    /// Shows the text that goes with what is heard, and clears it with its utterance.
    fn caption(&mut self, audible: i64) {
        let mut now = None;
        for utterance in &self.utterances {
            let Some(heard) = utterance.start.map(|start| audible - start) else {
                continue;
            };
            let begun = utterance.captions.partition_point(|(at, _)| *at <= heard);
            if let Some((_, text)) = begun.checked_sub(1).map(|n| &utterance.captions[n]) {
                now = Some(((utterance.key, begun), text));
            }
        }
        match now {
            Some((which, text)) if self.captioned != Some(which) => {
                self.ends.captions.set(Arc::clone(text));
                self.captioned = Some(which);
                self.captioned_alone = false;
            }
            None if self.captioned.take().is_some() && !self.captioned_alone => {
                self.ends.captions.set(Arc::from(""));
            }
            _ => {}
        }
    }
}
