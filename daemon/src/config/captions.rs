//! `[captions]`: the words under the face.

use clap::ValueEnum;

use super::section::section;
use super::value::Whole;

section! {
    /// The words under the face: what clients send (`caption`), and the text of `say --text`.
    pub struct Captions {
        /// How they are shown: "off", on a dark "box", or white with a dark "outline". Their
        /// letters are Latin, Greek and Cyrillic.
        style: CaptionStyle = CaptionStyle::Off,
        /// Height of their letters, hundredths of the picture's height; smaller where they would not fit.
        size_percent: Whole<2, 20> = Whole::new(4),
    }
}

/// How captions are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CaptionStyle {
    Off,
    Box,
    Outline,
}
