//! Words of timed letters: white space parts them, a word lasts from its first letter that has
//! times to its last.

use super::time::Time;

/// A word, and its times where any of its letters has some.
#[derive(Debug, PartialEq)]
pub(super) struct Word {
    pub(super) text: String,
    pub(super) times: Option<(Time, Time)>,
    pub(super) line: u64,
}

/// The word under way.
#[derive(Debug, Default)]
pub(super) struct Letters {
    open: Option<Word>,
}

impl Letters {
    /// Takes the next letter (or several, as some voices give) and gives the word that it ends.
    pub(super) fn push(
        &mut self,
        letter: &str,
        times: Option<(Time, Time)>,
        line: u64,
    ) -> Option<Word> {
        if letter.trim().is_empty() {
            return self.open.take();
        }
        let open = self.open.get_or_insert_with(|| Word {
            text: String::new(),
            times: None,
            line,
        });
        open.text.push_str(letter);
        open.times = match (open.times, times) {
            (Some((start, end)), Some((from, to))) => Some((start.min(from), end.max(to))),
            (known, new) => known.or(new),
        };
        None
    }

    /// The last word.
    pub(super) fn finish(&mut self) -> Option<Word> {
        self.open.take()
    }
}
