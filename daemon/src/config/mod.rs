//! The configuration: a TOML file under the flags of the command line.
//!
//! | module | holds |
//! |---|---|
//! | `window`, `look`, `captions`, `sound`, `life`, `drive`, `wire`, `health`, `log` | one section each: keys, types, defaults, documentation |
//! | `section` | how a section is declared |
//! | `value` | values with bounds or a syntax of their own |
//! | `file` | finding and reading the file; what is wrong with it |
//! | `source` | flag over file over default |
//! | `change` | what differs between two |
//! | `print` | the whole of it as TOML with its documentation |
//! | `command` | `mouthpiece config check` and `print` |
//!
//! To add a key, add it to its section: reading, printing and checking follow. To add a section,
//! add its file and name it in [`Config`] and in [`Config::sections`].

mod captions;
mod change;
mod command;
mod drive;
mod file;
mod health;
mod life;
mod log;
mod look;
mod print;
mod section;
mod sound;
mod source;
#[cfg(test)]
mod tests;
mod value;
mod window;
mod wire;

use serde::{Deserialize, Serialize};

pub use captions::{CaptionStyle, Captions};
pub use change::Changed;
pub use command::run;
pub use drive::Drive;
pub use health::Health;
pub use life::Life;
pub use log::{Level, Log};
pub use look::Look;
pub use sound::Sound;
pub use source::Source;
pub use window::Window;
pub use wire::{Turns, Wire};

use section::{Key, Section};

/// All that can be configured.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    pub window: Window,
    pub look: Look,
    pub captions: Captions,
    pub sound: Sound,
    pub life: Life,
    pub drive: Drive,
    pub wire: Wire,
    pub health: Health,
    pub log: Log,
}

/// A section's heading, what it is about, and its keys.
type About = (&'static str, &'static [&'static str], &'static [Key]);

impl Config {
    /// The sections, in the order in which they are printed.
    fn sections() -> [About; 9] {
        fn about<S: Section>(name: &'static str, _: fn(Config) -> S) -> About {
            (name, S::ABOUT, S::KEYS)
        }
        [
            about("window", |c| c.window),
            about("look", |c| c.look),
            about("captions", |c| c.captions),
            about("sound", |c| c.sound),
            about("life", |c| c.life),
            about("drive", |c| c.drive),
            about("wire", |c| c.wire),
            about("health", |c| c.health),
            about("log", |c| c.log),
        ]
    }
}
