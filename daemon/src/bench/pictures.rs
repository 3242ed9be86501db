//! What pictures cost: in each tier and size, as ratios to a plain pass over the same meshes, and beside a simulation.

use std::hint::black_box;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant as Wall};

use mouthpiece_render::{FRAMES_IN_FLIGHT, Gpu, Offscreen, Shown, View};
use mouthpiece_rig::{KeyFrame, STEP_TICKS, Simulation, TICK_RATE};
use serde_json::{Map, Value, json};

use super::{SIZES, look, rounded};
use crate::cli::TierArg;
use crate::pipeline::{Cast, Instant, Part, Performance};

/// Pictures drawn for each figure, after one that is not counted.
const PICTURES: u32 = 8;
/// Turns that rivals take; of their times the shortest count, since other work on the machine only makes them longer.
const TURNS: usize = 8;
/// How long pictures are counted beside a simulation.
const BESIDE: Duration = Duration::from_secs(2);

/// Key frames of the demo to draw.
fn frames(performance: &mut Performance) -> Vec<KeyFrame> {
    let mut instant = Instant::default();
    (1..=i64::from(PICTURES) + 1)
        .map(|k| {
            performance.at(k * TICK_RATE / 10, &mut instant);
            instant.frame.clone()
        })
        .collect()
}

/// Milliseconds from picture to picture while pictures overlap, as in an export.
fn overlapped_ms(
    offscreen: &mut Offscreen,
    frames: &[KeyFrame],
    view: &View,
) -> anyhow::Result<f64> {
    let started = Wall::now();
    for frame in frames {
        offscreen.submit(frame, view)?;
        if offscreen.in_flight() >= FRAMES_IN_FLIGHT {
            black_box(offscreen.take()?);
        }
    }
    while black_box(offscreen.take()?).is_some() {}
    Ok(started.elapsed().as_secs_f64() * 1e3 / frames.len().max(1) as f64)
}

/// Each tier in each size.
pub(super) fn render(
    cast: &Cast,
    gpu: &Gpu,
    performance: &mut Performance,
) -> anyhow::Result<Value> {
    let frames = frames(performance);
    let mut tiers = Map::new();
    for tier in [TierArg::Low, TierArg::Medium, TierArg::High] {
        let view = look(tier).view()?;
        let mut sizes = Map::new();
        for size in SIZES {
            let mut offscreen =
                Offscreen::new(gpu, &cast.head, (size.width, size.height), tier.into())?;
            offscreen.render(&frames[0], &view)?;
            let ms = overlapped_ms(&mut offscreen, &frames[1..], &view)?;
            sizes.insert(size.to_string(), json!({ "ms": rounded(ms) }));
        }
        tiers.insert(tier.name().into(), Value::Object(sizes));
    }
    Ok(Value::Object(tiers))
}

/// The dearer tiers and a plain four-texture Blinn-Phong pass over their meshes, 4 samples a pixel, in turns: a ratio holds on a
/// machine where times do not.
pub(super) fn over_blinn_phong(
    cast: &Cast,
    gpu: &Gpu,
    performance: &mut Performance,
) -> anyhow::Result<Value> {
    let frames = frames(performance);
    let size = SIZES[1];
    let mut tiers = Map::new();
    for tier in [TierArg::Medium, TierArg::High] {
        let face = look(tier).view()?;
        let plain = View {
            shown: Shown::Yardstick,
            ..face.clone()
        };
        let mut offscreen =
            Offscreen::new(gpu, &cast.head, (size.width, size.height), tier.into())?;
        let mut shortest = [f64::INFINITY; 2];
        for view in [&plain, &face] {
            offscreen.render(&frames[0], view)?;
        }
        for _ in 0..TURNS {
            for (view, shortest) in [&plain, &face].into_iter().zip(&mut shortest) {
                let ms = overlapped_ms(&mut offscreen, &frames[1..], view)?;
                *shortest = shortest.min(ms);
            }
        }
        let [plain_ms, ms] = shortest;
        tiers.insert(
            tier.name().into(),
            json!({ "plain_ms": rounded(plain_ms), "ms": rounded(ms), "ratio": rounded(ms / plain_ms) }),
        );
    }
    Ok(Value::Object(tiers))
}

/// Pictures a second in the low tier, one at a time as a window draws them, while the head moves in real time on another thread.
pub(super) fn beside_simulation(cast: &Cast, gpu: &Gpu, part: &Part) -> anyhow::Result<Value> {
    let size = SIZES[0];
    let view = look(TierArg::Low).view()?;
    let mut offscreen = Offscreen::new(
        gpu,
        &cast.head,
        (size.width, size.height),
        TierArg::Low.into(),
    )?;
    let frame = cast.head.rest_frame();
    offscreen.render(&frame, &view)?;
    let done = AtomicBool::new(false);
    let moving = || {
        let mut simulation = Simulation::new(Arc::clone(&cast.head));
        let started = Wall::now();
        while !done.load(Ordering::Relaxed) {
            let now = (started.elapsed().as_secs_f64() * TICK_RATE as f64) as i64;
            while simulation.time() < now {
                simulation.step(&part.controls_at(simulation.time() + STEP_TICKS));
            }
            std::thread::sleep(Duration::from_millis(4));
        }
    };
    std::thread::scope(|scope| {
        std::thread::Builder::new()
            .name("simulation".into())
            .spawn_scoped(scope, moving)?;
        let started = Wall::now();
        let mut pictures = 0_u32;
        let mut drawn = Ok(());
        while started.elapsed() < BESIDE && drawn.is_ok() {
            drawn = offscreen.render(&frame, &view).map(|rgba| {
                black_box(rgba);
            });
            pictures += 1;
        }
        let fps = f64::from(pictures) / started.elapsed().as_secs_f64();
        done.store(true, Ordering::Relaxed);
        drawn?;
        Ok(json!({ "pictures_per_second": rounded(fps) }))
    })
}
