//! `mouthpiece labels`: reads a label file, says what is odd about it, writes another.

use std::path::Path;

use mouthpiece_phonemes::{SampleRate, TICK_RATE, Writer as _, check, timit, writer};
use serde_json::json;

use crate::cli::LabelsArgs;
use crate::input::{read_labels, read_options};
use crate::media::output;

/// Runs the command.
pub fn run(args: &LabelsArgs) -> anyhow::Result<()> {
    let options = read_options(
        SampleRate::new(args.rate)?,
        args.alphabet,
        args.label_tier.as_deref(),
        args.dictionary.as_deref(),
    )?;
    let labels = read_labels(&args.file, args.from.as_deref(), &options)?;
    let name = match &args.file {
        path if path == Path::new("-") => "<stdin>".into(),
        path => path.display().to_string(),
    };
    let warnings = check(&labels, None);
    if args.json {
        let report = json!({
            "file": name,
            "tick_rate": TICK_RATE,
            "end": labels.end(),
            "segments": labels.segments,
            "words": labels.words,
            "notes": labels.notes.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "warnings": warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        });
        let text = serde_json::to_string_pretty(&report)? + "\n";
        return output::write_or_print(args.output.as_deref(), &text);
    }
    for note in &labels.notes {
        tracing::warn!("{name}: {note}");
    }
    for warning in &warnings {
        tracing::warn!("{name}: {warning}");
    }
    // What was read as words has no phones to write as phones.
    let to = match &args.to {
        Some(to) => to.as_str(),
        None if labels.segments.is_empty() => timit::Words.name(),
        None => timit::Phones.name(),
    };
    let mut text = Vec::new();
    writer(to)?.write(&labels, SampleRate::new(args.out_rate)?, &mut text)?;
    output::write_or_print(args.output.as_deref(), &String::from_utf8_lossy(&text))
}
