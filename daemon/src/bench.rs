//! `mouthpiece bench`: speed of each stage on this machine, on the demo's sentence.
//!
//! Each figure is of the code that the product runs, not of a copy. Run it on a quiet machine: but for the
//! simulation's, a figure says what one run took, without repetition or statistics.

mod pictures;
mod simulation;

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant as Wall;

use mouthpiece_render::{Gpu, Offscreen};
use mouthpiece_rig::{STEP_TICKS, TICK_RATE};
use serde_json::{Value, json};

use crate::cli::{BenchArgs, Fps, LookArgs, SceneArgs, Size, TierArg, ViewArg};
use crate::export::job::Job;
use crate::export::stage::Stage;
use crate::input::Utterance;
use crate::media::mp4::Mp4Sink;
use crate::media::output;
use crate::pipeline::{Cast, Instant, Mood, Part, Performance};

/// Sizes that pictures are drawn at.
const SIZES: [Size; 2] = [
    Size {
        width: 640,
        height: 480,
    },
    Size {
        width: 1280,
        height: 720,
    },
];

/// Runs the command.
pub fn run(args: &BenchArgs) -> anyhow::Result<()> {
    let started = Wall::now();
    let utterance = Utterance::demo()?;
    let cast = Cast::load(&args.cast)?;
    let part = Part::new(&cast, &utterance.segments, Some(1)).hearing(utterance.sound.as_deref());
    let mut performance = Performance::new(Arc::clone(&cast.head), part.clone());
    let mut instant = Instant::default();
    performance.at(0, &mut instant);
    let gpu = Gpu::headless()?;
    let first = SIZES[0];
    Offscreen::new(
        &gpu,
        &cast.head,
        (first.width, first.height),
        TierArg::Medium.into(),
    )?
    .render(&instant.frame, &look(TierArg::Medium).view()?)?;
    let first_picture_ms = started.elapsed().as_secs_f64() * 1e3;

    let ticks = utterance.ticks;
    let times = (0..ticks).step_by(STEP_TICKS as usize);
    let controls: Vec<_> = times.map(|time| part.controls_at(time)).collect();
    let [springs, layered] = simulation::models(&cast.head, &controls);
    let report = json!({
        "first_picture_ms": rounded(first_picture_ms),
        "speech": speech(&part, ticks),
        "simulation": springs,
        "simulation_layered": layered,
        "spring_pass": simulation::spring_pass(&cast.head),
        "render": pictures::render(&cast, &gpu, &mut performance)?,
        "render_over_blinn_phong": pictures::over_blinn_phong(&cast, &gpu, &mut performance)?,
        "live_low": pictures::beside_simulation(&cast, &gpu, &part)?,
        "export": export(&cast, &utterance)?,
        "rss_mb": peak_mb(),
        "adapter": gpu.info().name,
    });
    let text = if args.json {
        serde_json::to_string_pretty(&report)?
    } else {
        plain(&report)
    };
    output::print(&(text + "\n"))
}

/// Three significant digits: more is noise.
fn rounded(value: f64) -> f64 {
    let scale = 10_f64.powf(2.0 - value.abs().max(1e-9).log10().floor());
    (value * scale).round() / scale
}

fn seconds(ticks: i64) -> f64 {
    ticks as f64 / TICK_RATE as f64
}

fn speech(part: &Part, ticks: i64) -> Value {
    let started = Wall::now();
    for time in (0..ticks).step_by(STEP_TICKS as usize) {
        black_box(part.controls_at(time));
    }
    json!({ "realtime_factor": rounded(seconds(ticks) / started.elapsed().as_secs_f64()) })
}

/// The whole export of the demo at its defaults, from labels to a file that is thrown away; and the same in the low tier.
fn export(cast: &Cast, utterance: &Utterance) -> anyhow::Result<Value> {
    Ok(json!({
        "realtime_factor": export_in(TierArg::Medium, cast, utterance.clone())?,
        "low": { "realtime_factor": export_in(TierArg::Low, cast, utterance.clone())? },
    }))
}

fn export_in(tier: TierArg, cast: &Cast, utterance: Utterance) -> anyhow::Result<f64> {
    let folder = tempfile::tempdir()?;
    let started = Wall::now();
    let clip_s = seconds(utterance.ticks);
    let job = Job {
        cast: cast.clone(),
        utterance,
        size: SIZES[0],
        fps: Fps { num: 30, den: 1 },
        look: look(tier),
        mood: Mood::default(),
        seed: 1,
        bitrate: None,
    };
    let clip = job.clip();
    let sink = Box::new(Mp4Sink::new(&folder.path().join("bench.mp4"), &clip)?);
    let mut stage = Stage::new(&Gpu::headless()?, &job)?;
    job.export(&mut stage, sink, &clip, &|_| ())?;
    Ok(rounded(clip_s / started.elapsed().as_secs_f64()))
}

fn look(tier: TierArg) -> LookArgs {
    LookArgs {
        tier,
        scene: SceneArgs::default(),
        view: ViewArg::Front,
    }
}

/// The most memory that this process has held, where the system tells.
fn peak_mb() -> Option<f64> {
    Some(rounded(crate::memory::status_kb("VmHWM:")? / 1024.0))
}

/// `a.b.c  value`, a line each.
fn plain(report: &Value) -> String {
    fn walk(name: &str, value: &Value, lines: &mut Vec<String>) {
        match value {
            Value::Object(map) => map.iter().for_each(|(key, value)| {
                let name = if name.is_empty() {
                    key.clone()
                } else {
                    format!("{name}.{key}")
                };
                walk(&name, value, lines);
            }),
            Value::String(text) => lines.push(format!("{name:<32} {text}")),
            value => lines.push(format!("{name:<32} {value}")),
        }
    }
    let mut lines = Vec::new();
    walk("", report, &mut lines);
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_keep_three_digits_and_plain_text_names_them_as_json_does() {
        assert_eq!(rounded(12_345.0), 12_300.0);
        assert_eq!(rounded(0.012_345), 0.0123);
        let text = plain(&json!({"a": {"b": 1.5}, "c": "x"}));
        let words: Vec<_> = text.split_whitespace().collect();
        assert_eq!(words, ["a.b", "1.5", "c", "x"]);
    }
}
