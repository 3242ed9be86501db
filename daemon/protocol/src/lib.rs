//! The wire: what programs that speak through Mouthpiece send and get, and which message is legal when.
//!
//! Newline-delimited JSON, one object a line, over a Unix socket, TCP or a WebSocket. Nothing here does
//! IO, keeps time or starts threads: bytes go in, [`Action`]s come out, so that the whole of it can
//! be tested and fuzzed. Who speaks when, and what is heard, is the daemon's. `README.md` beside this
//! crate shows every message at work, `schema.json` is generated from the types.
//!
//! A conversation (`>` is the client):
//!
//! ```text
//! > {"type":"begin","id":"hello","audio":{"rate":22050,"channels":1,"format":"s16"}}
//! < {"type":"accepted","id":"hello"}
//! > {"type":"phones","phones":[{"start":0.0,"end":0.12,"phone":"h#"},{"start":0.12,"end":0.2,"phone":"hh"}]}
//! > {"type":"audio","data":"AAAB/wIA…"}
//! > {"type":"end"}
//! < {"type":"started","id":"hello"}
//! < {"type":"progress","id":"hello","position_s":0.1}
//! < {"type":"finished","id":"hello","position_s":0.9}
//! ```
//!
//! Lines that are no JSON object are taken as TIMIT labels (`start end phone`, samples of 16 kHz)
//! and make an utterance of their own, which ends with an empty line, `end`, `begin` or the end of
//! the stream:
//!
//! ```text
//! > 0 1920 h#
//! < {"type":"accepted","id":"timit-1"}
//! > 1920 3200 hh
//! ```
//!
//! | module | holds |
//! |---|---|
//! | [`message`] | every message of a client |
//! | [`answer`] | every message of the daemon |
//! | [`limits`] | every bound, named, with its reason |
//! | `lines` | bytes in any pieces to whole lines |
//! | [`token`] | the secret that lets clients in from beyond this machine |
//! | [`schema`] | all messages as a JSON schema |
//! | `session` | the state of one connection: which message is legal when |
//! | `raw` | a line of TIMIT labels |
//! | `pcm` | sound as it is sent, to mono samples |

#![forbid(unsafe_code)]

pub mod answer;
pub mod limits;
mod lines;
pub mod message;
mod pcm;
mod raw;
pub mod schema;
mod session;
pub mod token;

pub use answer::{DaemonMessage, ErrorCode};
pub use limits::Limits;
pub use message::ClientMessage;
pub use pcm::{Pcm, SampleFormat};
pub use session::{Action, Session, Sound};
pub use token::Token;

/// Version of this protocol, told in `hello` and `pong`: grows when a client could notice. Version 1 had
/// TIMIT's alphabet alone, refused unknown symbols, and knew of no face, caption, `hello` and `auth`.
pub const VERSION: u32 = 2;
