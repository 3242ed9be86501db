//! Label formats of other programs, and our own NDJSON: a module each, with what its times mean
//! and what is known to be wrong with them.
//!
//! | module | reads | times |
//! |---|---|---|
//! | `xlabel` | ESPS, xwaves, festival (writes too) | ends, seconds |
//! | `flite` | `flite -psdur` | ends, seconds, from 0 in each sentence |
//! | `textgrid` | Praat, long and short (writes the long one) | starts and ends, seconds |
//! | `mbrola` | `.pho` | lengths, ms |
//! | `hts` | HTK and HTS `.lab`, full context or not | starts and ends, 100 ns |
//! | `gentle` | Gentle's JSON | words in seconds, phones by lengths |
//! | `mfa` | JSON of Montreal's aligner and praatIO | starts and ends, seconds |
//! | `whisper` | JSON of Whisper, WhisperX | words, seconds |
//! | `azure` | Azure's viseme events | starts, 100 ns |
//! | `polly` | Amazon Polly's speech marks | starts, ms |
//! | `rhubarb` | Rhubarb Lip Sync, JSON and TSV | starts, seconds |
//! | `characters` | voices that time characters | starts and ends, seconds or ms |
//! | `piper` | Piper's phoneme alignments | starts and ends, seconds |
//! | `espeak` | libespeak-ng's events | starts, ms and samples |
//! | `ndjson` | our own (writes too, and as a stream) | starts and ends, seconds or samples |
//!
//! What they share: `sheet` (labels gathered and put in order), `tiers` (which tier of several),
//! `visemes` (mouth shapes as phones), `letters` (words of timed letters), `time` (exact times),
//! `text` (encodings, lines), `json`, `write` (spans without gaps).

mod azure;
mod characters;
mod espeak;
mod flite;
mod gentle;
pub(crate) mod hts;
mod json;
mod letters;
mod mbrola;
mod mfa;
mod ndjson;
mod piper;
mod polly;
mod rhubarb;
mod sheet;
mod text;
mod textgrid;
mod tiers;
mod time;
mod visemes;
mod whisper;
mod write;
mod xlabel;

pub use azure::Azure;
pub use characters::Characters;
pub use espeak::Espeak;
pub use flite::Flite;
pub use gentle::Gentle;
pub use hts::Hts;
pub use mbrola::Mbrola;
pub use mfa::TiersJson;
pub use ndjson::{Ndjson, NdjsonStream};
pub use piper::Piper;
pub use polly::Polly;
pub use rhubarb::Rhubarb;
pub use textgrid::TextGrid;
pub use whisper::Whisper;
pub use xlabel::Xlabel;
