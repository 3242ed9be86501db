//! What formats of visemes have in common: mouth shapes with starts, each taken for one phone that
//! looks like it.
//!
//! A viseme says how a mouth looks and not what it says: lips are right, the tongue is a guess.
//! Of the phones that share a shape the one is taken that holds it throughout its label: `m` for
//! lips together, since `p` and `b` would open them halfway.

use super::sheet::{Piece, Said, Sheet};
use super::time::Time;
use crate::Phone;
use crate::error::LabelError;
use crate::note::Note;

/// How long the last shape is taken to last where nothing ends it.
const LAST: Time = Time::milliseconds(100);

/// Shapes as they come.
#[derive(Debug)]
pub(super) struct Visemes {
    /// The set, for messages.
    set: &'static str,
    starts: Vec<(Time, Phone, u64)>,
    unknown: Option<(String, u64, usize)>,
}

impl Visemes {
    /// None yet of `set`, such as `Azure's 22 visemes`.
    pub(super) fn new(set: &'static str) -> Self {
        Self {
            set,
            starts: Vec::new(),
            unknown: None,
        }
    }

    /// A shape from `start` on; `phone` is `None` for one that the set does not have, which rests.
    pub(super) fn push(&mut self, start: Time, phone: Option<Phone>, symbol: &str, line: u64) {
        if phone.is_none() {
            let (_, _, count) = self
                .unknown
                .get_or_insert_with(|| (crate::error::clip(symbol), line, 0));
            *count += 1;
        }
        self.starts.push((start, phone.unwrap_or(Phone::Pau), line));
    }

    /// Adds them all: each lasts until the next begins, the last to `end` where that is known.
    pub(super) fn finish(
        mut self,
        end: Option<Time>,
        sheet: &mut Sheet<'_>,
    ) -> Result<(), LabelError> {
        if self.starts.is_empty() {
            return Ok(());
        }
        self.starts.sort_by_key(|(start, _, _)| *start);
        for (index, (start, phone, line)) in self.starts.iter().enumerate() {
            let refuse = |fault| sheet.wrong(*line, fault);
            let until = match (self.starts.get(index + 1), end) {
                (Some((next, _, _)), _) => *next,
                (None, Some(end)) if end > *start => end,
                // Silence last of all marks the end.
                (None, _) if *phone == Phone::Pau && index > 0 => continue,
                (None, _) => start.plus(LAST).map_err(refuse)?,
            };
            if until == *start {
                continue;
            }
            let piece = Piece::saying(Said::Phone(*phone), *start, until, *line);
            let piece = piece.map_err(refuse)?;
            sheet.phone(piece)?;
        }
        let set = self.set;
        sheet.notes.push(Note::new(format!(
            "{set} stand for several phones each, and one that looks alike is taken: lips are right, \
             the tongue is coarse; give phones where you have them",
        )));
        if let Some((symbol, line, count)) = self.unknown {
            let text = format!("`{symbol}` is none of {set}; taken for rest ({count} in all)");
            sheet.notes.push(Note::at(line, text));
        }
        Ok(())
    }
}
