//! What writers of formats with labels in a row have in common: spans in order, gaps filled.

use crate::Labels;
use crate::tick::TICKS_MAX;
use crate::writer::WriteError;

/// Labels of one kind that follow one another.
#[derive(Debug)]
pub(super) struct Spans<'a> {
    /// What one is called in messages.
    pub(super) kind: &'static str,
    spans: Vec<(i64, i64, &'a str)>,
}

impl<'a> Spans<'a> {
    /// The phones; `None` where there is none.
    pub(super) fn phones(labels: &'a Labels) -> Result<Option<Self>, WriteError> {
        let phones = labels.segments.iter();
        Self::new("phone", phones.map(|s| (s.start, s.end, s.phone.code())))
    }

    /// The words; `None` where there is none.
    pub(super) fn words(labels: &'a Labels) -> Result<Option<Self>, WriteError> {
        let words = labels.words.iter();
        Self::new("word", words.map(|w| (w.start, w.end, w.text.as_str())))
    }

    fn new(
        kind: &'static str,
        spans: impl Iterator<Item = (i64, i64, &'a str)>,
    ) -> Result<Option<Self>, WriteError> {
        let mut all: Vec<(i64, i64, &'a str)> = Vec::new();
        for (index, (start, end, label)) in spans.enumerate() {
            let number = index + 1;
            let refuse = |reason| {
                Err(WriteError::Label {
                    kind,
                    number,
                    reason,
                })
            };
            if start < 0 || end <= start || end > TICKS_MAX {
                return refuse("does not last from 0 or later to its end within 24 hours; mend it");
            }
            let last_end = all.last().map_or(0, |last| last.1);
            if start < last_end && kind == "phone" {
                return refuse("starts before the one before it ends; sort and part them");
            }
            if start < last_end {
                // Words may share sounds, but a tier cannot say so: the one before is cut short.
                match all.last_mut() {
                    Some(last) if last.0 < start => last.1 = start,
                    _ => return refuse("starts with the one before it; part them"),
                }
            }
            all.push((start, end, label));
        }
        let spans = all;
        Ok((!spans.is_empty()).then_some(Self { kind, spans }))
    }

    /// Where the last one ends.
    pub(super) fn end(&self) -> i64 {
        self.spans.last().map_or(0, |last| last.1)
    }

    /// The labels from 0 on, with `filler` where there is none.
    pub(super) fn filled(&self, filler: &'a str) -> impl Iterator<Item = (i64, i64, &'a str)> {
        let mut at = 0;
        self.spans.iter().flat_map(move |(start, end, label)| {
            let gap = (*start > at).then_some((at, *start, filler));
            at = *end;
            gap.into_iter().chain([(*start, *end, *label)])
        })
    }
}

/// Whether a label would end its line early.
pub(super) fn has_breaks(label: &str) -> bool {
    label.contains(char::is_control) || label.trim() != label || label.is_empty()
}
