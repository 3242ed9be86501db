//! Writes TextGrids: a tier of words and a tier of phones, as Montreal's aligner names them.

use std::io::Write;

use super::TextGrid;
use crate::Labels;
use crate::formats::time::seconds;
use crate::formats::write::Spans;
use crate::reader::Reader;
use crate::tick::SampleRate;
use crate::writer::{WriteError, Writer};

impl Writer for TextGrid {
    fn name(&self) -> &'static str {
        Reader::name(self)
    }

    /// Gaps become intervals without text, as Praat wants them. Words that overlap are cut short.
    fn write(
        &self,
        labels: &Labels,
        _rate: SampleRate,
        out: &mut dyn Write,
    ) -> Result<(), WriteError> {
        let tiers = [
            ("words", Spans::words(labels)?),
            ("phones", Spans::phones(labels)?),
        ];
        let tiers = tiers.iter().filter_map(|(n, t)| Some((*n, t.as_ref()?)));
        let count = tiers.clone().count();
        if count == 0 {
            return Err(WriteError::Nothing("phones or words"));
        }
        let last = tiers.clone().map(|(_, t)| t.end()).max().unwrap_or(0);
        let end = seconds(last);
        writeln!(
            out,
            "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n"
        )?;
        writeln!(out, "xmin = 0\nxmax = {end}\ntiers? <exists>")?;
        writeln!(out, "size = {count}\nitem []:")?;
        for (number, (name, spans)) in (1..).zip(tiers) {
            let rest = (spans.end() < last).then_some((spans.end(), last, ""));
            let intervals: Vec<_> = spans.filled("").chain(rest).collect();
            let size = intervals.len();
            writeln!(
                out,
                "    item [{number}]:\n        class = \"IntervalTier\""
            )?;
            writeln!(
                out,
                "        name = \"{name}\"\n        xmin = 0\n        xmax = {end}"
            )?;
            writeln!(out, "        intervals: size = {size}")?;
            for (number, (start, end, text)) in (1..).zip(intervals) {
                writeln!(out, "        intervals [{number}]:")?;
                writeln!(out, "            xmin = {}", seconds(start))?;
                writeln!(out, "            xmax = {}", seconds(end))?;
                writeln!(out, "            text = \"{}\"", text.replace('"', "\"\""))?;
            }
        }
        Ok(())
    }
}
