//! The marking with its file, and the deeds that keys and buttons share.

use std::path::PathBuf;

use mouthpiece_shop::landmarks::MIN_LANDMARKS;
use mouthpiece_shop::marking::{Marking, Placed, State};

use crate::media::output;

/// What a user works on.
pub struct Session {
    pub marking: Marking,
    pub output: PathBuf,
    /// What happened last, one sentence.
    pub said: String,
    /// Whether what was said is bad news.
    pub bad: bool,
    /// Whether a click on a landmark not set before goes on to the next.
    pub go_on: bool,
    /// Whether the scan is drawn in its own colours.
    pub coloured: bool,
    /// Whether the question about unsaved landmarks is open.
    pub asking: bool,
    /// Whether the window should close.
    pub done: bool,
    /// Set where the landmarks came from another file than they go to: then there is something to save.
    elsewhere: bool,
}

impl Session {
    pub fn new(marking: Marking, output: PathBuf, said: String, elsewhere: bool) -> Self {
        let said = if said.is_empty() {
            "Click where the landmark at the right lies; from three on the others are placed by estimate."
                .to_owned()
        } else {
            said
        };
        Self {
            marking,
            output,
            said,
            bad: false,
            go_on: true,
            coloured: true,
            asking: false,
            done: false,
            elsewhere,
        }
    }

    /// Whether closing would lose anything.
    pub fn is_dirty(&self) -> bool {
        self.marking.is_dirty()
    }

    /// Writes the file; false if that failed.
    pub fn save(&mut self) -> bool {
        let json = self.marking.landmarks().json().map_err(anyhow::Error::from);
        let written = json.and_then(|json| output::write(&self.output, json.as_bytes()));
        match written {
            Ok(()) => {
                self.marking.mark_saved();
                self.elsewhere = false;
                let count = self.marking.set_count();
                let more = if count < MIN_LANDMARKS {
                    format!("; a fit needs at least {MIN_LANDMARKS}")
                } else {
                    String::new()
                };
                self.say(&format!("Saved {count} in {}{more}", self.output.display()));
                true
            }
            Err(error) => {
                self.said = format!("Not saved: {error:#}");
                self.bad = true;
                false
            }
        }
    }

    /// Whether saving would change the file.
    pub fn can_save(&self) -> bool {
        self.elsewhere || self.is_dirty()
    }

    /// Closes, or asks first.
    pub fn close(&mut self) {
        if self.is_dirty() {
            self.asking = true;
        } else {
            self.done = true;
        }
    }

    pub fn next(&mut self) {
        if !self.marking.next_unset() {
            self.say("All landmarks are set.");
        }
    }

    pub fn clear(&mut self) {
        self.marking.clear(self.marking.selected());
    }

    /// Keeps the estimate of the selected landmark as it is, and goes on.
    pub fn accept(&mut self) {
        let selected = self.marking.selected();
        if self.marking.accept(selected) {
            self.said.clear();
            self.marking.next_unset();
        } else if self.marking.state(selected) == State::Unknown {
            self.say("Nothing is estimated yet: set three landmarks first.");
        }
    }

    pub fn undo(&mut self) {
        let done = self.marking.undo();
        self.say(if done {
            ""
        } else {
            "There is nothing to undo."
        });
    }

    pub fn redo(&mut self) {
        let done = self.marking.redo();
        self.say(if done {
            ""
        } else {
            "There is nothing to do again."
        });
    }

    /// After a click that was to place the selected landmark, which was set `before` or not.
    pub fn placed(&mut self, placed: Placed, before: State) {
        let name = self.marking.name(self.marking.selected()).to_owned();
        match placed {
            Placed::OnScan => self.said.clear(),
            Placed::MidAir => {
                self.say(&format!("{name} hangs in mid-air, at the depth it had."));
            }
            Placed::Nowhere => {
                self.say(
                    "There is no scan under the pointer, and no estimate to take the depth from.",
                );
                return;
            }
        }
        self.bad = false;
        if self.go_on && before != State::Set {
            self.marking.next_unset();
        }
    }

    /// After a click that selected another landmark instead of placing the one that was.
    pub fn selected(&mut self) {
        let name = self.marking.name(self.marking.selected()).to_owned();
        self.say(&format!(
            "{name} is selected; Ctrl+click places on top of another landmark."
        ));
    }

    fn say(&mut self, text: &str) {
        text.clone_into(&mut self.said);
        self.bad = false;
    }
}
