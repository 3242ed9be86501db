//! TIMIT `.PHN` files: reader and writer.

use std::io::Write;

use super::Kind;
use super::file::{gather, samples, shape};
use super::line::Order;
use super::stream::phone;
use crate::Labels;
use crate::error::LabelError;
use crate::formats::hts::counts_100ns;
use crate::reader::{Match, ReadOptions, Reader, Source};
use crate::tick::SampleRate;
use crate::writer::{WriteError, Writer};

/// The format of `.PHN` files. Stress is not part of it and is not written.
#[derive(Clone, Copy, Debug)]
pub struct Phones;

impl Reader for Phones {
    fn name(&self) -> &'static str {
        "timit"
    }

    fn about(&self) -> &'static str {
        "TIMIT .PHN: lines `start end phone`, in samples of 16 kHz"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        if source.has_extension("phn") {
            return Match::Surely;
        }
        // Some words are spelled like phones, and a file may have a mistake in its first lines.
        match shape(source.bytes) {
            Some((lines, phones)) if 2 * phones >= lines && !counts_100ns(source) => Match::Likely,
            // Longer than phones are, if these are samples.
            Some((lines, phones)) if 2 * phones >= lines => Match::Perhaps,
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let mut order = Order::default();
        Ok(Labels {
            segments: gather(source, |text| phone(text, options.rate, &mut order))?,
            ..Labels::default()
        })
    }
}

impl Writer for Phones {
    fn name(&self) -> &'static str {
        Reader::name(self)
    }

    fn write(
        &self,
        labels: &Labels,
        rate: SampleRate,
        out: &mut dyn Write,
    ) -> Result<(), WriteError> {
        if labels.segments.is_empty() {
            return Err(WriteError::Nothing(Kind::Phone.many()));
        }
        let mut last_end = 0;
        for (index, segment) in labels.segments.iter().enumerate() {
            let number = index + 1;
            let span = (segment.start, segment.end);
            let (start, end) = samples(Kind::Phone, number, span, rate)?;
            if segment.start < last_end {
                return Err(WriteError::Label {
                    kind: Kind::Phone.one(),
                    number,
                    reason: "starts before the one before it ends; sort and part them",
                });
            }
            last_end = segment.end;
            writeln!(out, "{start} {end} {}", segment.phone)?;
        }
        Ok(())
    }
}
