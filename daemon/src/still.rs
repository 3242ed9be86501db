//! `mouthpiece still`: one picture of a settled face.

mod outline;

use std::collections::BTreeMap;
use std::sync::Arc;

use anyhow::Context as _;
use mouthpiece_phonemes::{Phone, Segment};
use mouthpiece_render::{Gpu, Offscreen, Shown};
use mouthpiece_rig::{
    Control, Controls, Head, KeyFrame, STEP_TICKS, Simulation, TICK_RATE, undressed,
};

use crate::cli::{StillArgs, Usage};
use crate::media::{frames, output};
use crate::pipeline::{Cast, Instant, Part, Performance, expression};

/// How long the tissue is given to come to rest: ten times what a vowel takes.
const SETTLE_TICKS: i64 = TICK_RATE;

/// Runs the command.
pub fn run(args: &StillArgs) -> anyhow::Result<()> {
    let cast = Cast::load(&args.cast)?;
    let size = (args.size.width, args.size.height);
    let mut view = args.look.view()?;
    let canvas = |head: &Head| -> anyhow::Result<Offscreen> {
        let gpu = Gpu::headless()?;
        Ok(Offscreen::new(&gpu, head, size, args.look.tier.into())?)
    };
    let (frame, ready) = std::thread::scope(|scope| {
        // Graphics take as long to start as the head takes to settle; what lies under the skin is known only then.
        let beside = args.show.anatomy().is_none().then(|| {
            std::thread::Builder::new()
                .name("graphics".into())
                .spawn_scoped(scope, || canvas(&cast.head))
        });
        let frame = posed(args, &cast);
        let ready = beside.and_then(Result::ok);
        (frame, ready.and_then(|thread| thread.join().ok()))
    });
    let frame = frame?;
    let mut offscreen = match (args.show.anatomy(), ready) {
        (Some(what), _) => {
            view.shown = Shown::Anatomy;
            canvas(&Head {
                parts: undressed(&cast.head, &frame, what),
                ..Head::clone(&cast.head)
            })?
        }
        (None, Some(ready)) => ready?,
        (None, None) => canvas(&cast.head)?,
    };
    let rgba = offscreen.render(&frame, &view)?;
    output::write(&args.output, &frames::png(rgba, size.0, size.1)?)?;
    if let Some(path) = &args.outline {
        let outline = outline::outline(&cast.head, &frame, &view, size)?;
        output::write(path, &serde_json::to_vec_pretty(&outline)?)?;
    }
    Ok(())
}

/// The head as it was asked for.
fn posed(args: &StillArgs, cast: &Cast) -> anyhow::Result<KeyFrame> {
    Ok(match (&args.phone, &args.controls) {
        (Some(code), _) => phone(cast, code)?,
        (None, Some(text)) => settled(cast, &controls(text)?),
        (None, None) => settled(
            cast,
            &match &args.expression {
                Some(name) => expression(name)?,
                None => Controls::default(),
            },
        ),
    })
}

/// The head at rest under `controls`.
fn settled(cast: &Cast, controls: &Controls) -> KeyFrame {
    let mut simulation = Simulation::new(Arc::clone(&cast.head));
    while simulation.time() < SETTLE_TICKS {
        simulation.step(controls);
    }
    let mut frame = KeyFrame::default();
    simulation.save(&mut frame);
    frame
}

/// The head in the middle of a long phone.
fn phone(cast: &Cast, code: &str) -> anyhow::Result<KeyFrame> {
    let phone = Phone::from_code(code).ok_or_else(|| {
        let near: Vec<_> = mouthpiece_phonemes::nearest(code)
            .iter()
            .map(ToString::to_string)
            .collect();
        Usage(format!(
            "--phone {code}: there is no such TIMIT phone; the nearest are {}",
            near.join(", ")
        ))
    })?;
    let (start, end) = (TICK_RATE / 2, 5 * TICK_RATE / 2);
    let segments = [
        Segment::new(Phone::HSharp, 0, start),
        Segment::new(phone, start, end),
        Segment::new(Phone::HSharp, end, end + start),
    ];
    let part = Part::new(cast, &segments, None);
    let mut instant = Instant::default();
    let middle = (start + end) / 2 / STEP_TICKS * STEP_TICKS;
    Performance::new(Arc::clone(&cast.head), part).at(middle, &mut instant);
    Ok(instant.frame)
}

/// Controls by name from JSON text, or from a file that holds it.
fn controls(text: &str) -> anyhow::Result<Controls> {
    let read;
    let (name, json) = if text.trim_start().starts_with('{') {
        ("--controls", text)
    } else {
        read = std::fs::read_to_string(text)
            .with_context(|| format!("--controls {text} is neither JSON like '{{\"jaw_rad\": 0.2}}' nor a file that can be read"))?;
        (text, read.as_str())
    };
    let values: BTreeMap<String, f32> = serde_json::from_str(json)
        .with_context(|| format!("{name} is not an object of numbers like {{\"jaw_rad\": 0.2}}"))?;
    let mut controls = Controls::default();
    for (key, value) in values {
        let control = Control::from_name(&key).ok_or_else(|| {
            let known: Vec<_> = Control::ALL.iter().map(|c| c.name()).collect();
            Usage(format!(
                "{name}: there is no control `{key}`; there are {}",
                known.join(", ")
            ))
        })?;
        let (least, most) = control.range();
        if !(least..=most).contains(&value) {
            tracing::warn!("{name}: {key} goes from {least} to {most}; {value} is cut to that");
        }
        controls[control] = value;
    }
    Ok(controls.clamped())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn controls_are_read_by_name_and_what_is_unknown_is_refused() {
        let read = controls(r#"{"jaw_rad": 0.2, "lid_l": 7}"#).unwrap();
        assert_eq!((read[Control::Jaw], read[Control::LidL]), (0.2, 1.0));
        for bad in [
            r#"{"jaw": 1}"#,
            "{",
            r#"{"jaw_rad": "x"}"#,
            "no/such/file.json",
        ] {
            assert!(controls(bad).is_err(), "{bad}");
        }
    }
}
