//! Phones, times and label files: everything that Mouthpiece knows of what is said and when.
//!
//! Nothing here knows of sound or faces. Readers turn label files and streams into [`Segment`]s
//! in ticks of 48 kHz; speech turns those into muscles.
//!
//! | module | holds |
//! |---|---|
//! | `phone` | the 61 phones of TIMIT |
//! | `segment` | what a label says: phone, word, stress, times |
//! | `tick` | integer time and sample rates |
//! | `reader` | where label formats are chosen and read |
//! | `writer` | the same for writing |
//! | [`timit`] | `.PHN` and `.WRD`, as files and as streams |
//! | [`formats`] | the label formats of other programs, and our NDJSON |
//! | `closure` | the silence before a burst as its stop's closure |
//! | `check` | what is odd about labels that can be used |
//! | `error` | what is wrong with those that cannot |
//! | [`limits`] | how much a file or stream may ask for |
//! | `lines` | cuts pieces of any size into lines |
//! | [`alphabet`] | other alphabets' symbols as TIMIT's phones |
//! | [`pronounce`](mod@pronounce) | how written words sound, and when within them each phone does |
//! | `note` | what a reader had to guess |
//! | `nearest` | which code an unknown one resembles |

#![forbid(unsafe_code)]

pub mod alphabet;
mod check;
mod closure;
mod error;
pub mod formats;
pub mod limits;
mod lines;
mod nearest;
mod note;
mod phone;
pub mod pronounce;
mod reader;
mod segment;
mod tick;
pub mod timit;
mod writer;

pub use alphabet::{Alphabet, PhoneList, Spoken, UnknownAlphabet};
pub use check::{Warning, check};
pub use closure::close_before_bursts;
pub use error::{Fault, LabelError, LineError};
pub use nearest::nearest;
pub use note::{Note, Notes};
pub use phone::{Class, Phone, UnknownCode};
pub use pronounce::{pronounce, spread};
pub use reader::{
    Match, READERS, ReadOptions, Reader, Source, detect, read, read_file, read_from, reader,
};
pub use segment::{Labels, Segment, Stress, Word};
pub use tick::{BadRate, RATE_MAX, RATE_MIN, SampleRate, TICK_RATE, TICKS_MAX};
pub use writer::{WRITERS, WriteError, Writer, writer};
