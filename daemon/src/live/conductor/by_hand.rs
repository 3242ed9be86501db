//! The sound thread without its thread, on a steady clock, for tests that make up the time.

use mouthpiece_rig::{Control, Controls};

use super::*;
use crate::live::clock::ClockCell;
use crate::live::sound::Choice;
use crate::live::time::Origin;

/// It, and what leads to and from it.
pub(in crate::live) struct ByHand {
    pub(in crate::live) conductor: Conductor,
    pub(in crate::live) commands: mpsc::Sender<Command>,
    pub(in crate::live) cues: crossbeam::channel::Receiver<Cue>,
    pub(in crate::live) vitals: Arc<Vitals>,
    /// When it begins.
    pub(in crate::live) now_ns: i64,
}

impl ByHand {
    pub(in crate::live) fn new(rules: Rules) -> Self {
        let origin = Origin::new();
        let output = Output::open(Choice::Silent, Arc::new(ClockCell::default()), origin);
        let (commands, inbox) = mpsc::channel(COMMANDS_MAX);
        let (cue, cues) = crossbeam::channel::bounded(CUES_MAX);
        let speech = Speech::with(|a| {
            let mut controls = Controls::default();
            controls[Control::Jaw] = a.jaw_rad;
            controls
        });
        let vitals = Arc::new(Vitals::new(origin));
        let ends = Ends {
            commands: inbox,
            cues: cue,
            face: None,
            captions: Arc::default(),
        };
        Self {
            conductor: Conductor::new(output, ends, speech.unwrap(), rules, Arc::clone(&vitals)),
            commands,
            cues,
            vitals,
            now_ns: origin.now_ns(),
        }
    }
}
