//! The live face: `run`, `say`, and the threads between a client's bytes and what is heard and seen.
//!
//! | thread | module | does |
//! |---|---|---|
//! | main | [`window`] | draws the head as it is at the audible instant of the picture |
//! | `simulation` | [`face`], [`score`], [`showing`] | moves the head, a bounded lead ahead (HABER 5.3) |
//! | `sound` | [`conductor`], [`utterance`], [`rules`], [`sound`] | utterances in turn, mixed into the device's ring |
//! | the device's own | `sound::callback` | takes from the ring, stamps the clock |
//! | `puppet` | [`puppet`] | drives other avatars over UDP, where asked |
//! | `net` | [`server`], [`connection`] | sockets; nothing real-time |
//!
//! Between them: [`clock`] (which tick is heard now), [`frames`] (key frames, with epochs), bounded
//! channels for commands, cues and answers, and a slot with the text on the screen ([`captions`]). [`player`] puts
//! them together. [`vitals`] is what each says of itself, [`motion`] whether the face moves, [`shots`] gives the picture on
//! the screen to whoever asks. [`speaker`] is what `say`
//! does without a daemon, [`client`] what it does with one; both take their utterance from [`source`]; [`subtitles`] makes captions of a
//! text that is spoken.
//! [`reload`] takes a changed configuration over, [`service`] tells systemd,
//! [`deadline`] ends what does not end. [`sync`] is a test of sound against picture, judged from outside. All time is [`time`]'s.

mod address;
mod captions;
mod client;
mod clock;
mod commands;
mod conductor;
mod connection;
mod deadline;
mod face;
mod faults;
mod frames;
mod motion;
mod player;
mod puppet;
mod reload;
mod rules;
mod score;
mod server;
mod service;
pub mod shots;
mod showing;
mod sound;
mod source;
mod speaker;
mod stop;
mod subtitles;
mod sync;
pub mod time;
mod utterance;
pub mod vitals;
mod window;

/// With this, allocating in the device's callback ends the process at once.
#[cfg(feature = "alloc-check")]
#[global_allocator]
static ALLOCATOR: assert_no_alloc::AllocDisabler = assert_no_alloc::AllocDisabler;

pub use commands::{doctor_sync, run, say, sync_test};
pub use sound::resample::Resample;
pub use window::screens;
