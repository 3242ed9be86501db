//! TIMIT's label files, the product's first language: `.PHN` holds phones, `.WRD` words.
//!
//! Each line is `start end label`: sample indices of 16 kHz sound unless the user says otherwise,
//! the end exclusive. Phones follow one another; words may overlap, since neighbours share sounds.
//! The last label may end before the sound does.

mod file;
mod line;
mod phn;
mod stream;
mod wrd;

pub use phn::Phones;
pub use stream::TimitStream;
pub use wrd::Words;

/// A line that can be read, for messages.
pub(crate) const EXAMPLE: &str = "0 8000 h#";

/// What a file's labels are, for messages.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Phone,
    Word,
}

impl Kind {
    fn one(self) -> &'static str {
        match self {
            Self::Phone => "phone",
            Self::Word => "word",
        }
    }

    fn many(self) -> &'static str {
        match self {
            Self::Phone => "phones",
            Self::Word => "words",
        }
    }
}
