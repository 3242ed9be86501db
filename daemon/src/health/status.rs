//! `/status.json`: what the page shows, in one object.

use serde::Serialize;

use super::judge::{Verdict, judge};
use crate::live::time::seconds;
use crate::live::vitals::{DeviceState, Vitals};
use crate::memory;

/// What the page shows.
#[derive(Debug, Serialize)]
pub struct Status {
    version: &'static str,
    #[serde(flatten)]
    verdict: Verdict,
    rss_mb: Option<f64>,
    window: Window,
    simulation: Simulation,
    sound: Sound,
    utterances: Utterances,
    clients: i64,
}

#[derive(Debug, Serialize)]
struct Window {
    pictures: u64,
    pictures_per_second: f64,
    tier: Option<&'static str>,
    skew_ms: f64,
    failures: u64,
}

#[derive(Debug, Serialize)]
struct Simulation {
    lead_ms: f64,
    key_frames: u64,
    rewinds: u64,
    skips: u64,
}

#[derive(Debug, Serialize)]
struct Sound {
    device: &'static str,
    losses: u64,
    underruns: i64,
    heard_s: f64,
    dropped_labels: u64,
    dropped_s: f64,
}

#[derive(Debug, Serialize)]
struct Utterances {
    queue: i64,
    held_s: f64,
    accepted: u64,
    finished: u64,
    stopped: u64,
    error: u64,
}

/// As it is now.
pub fn status(vitals: &Vitals, stall_ns: i64) -> Status {
    let now_ns = vitals.origin.now_ns();
    let (window, simulation, sound) = (&vitals.window, &vitals.simulation, &vitals.sound);
    Status {
        version: env!("CARGO_PKG_VERSION"),
        verdict: judge(vitals, now_ns, stall_ns),
        rss_mb: memory::status_kb("VmRSS:").map(|kb| kb / 1024.0),
        window: Window {
            pictures: window.presented.get(),
            pictures_per_second: window.per_second(now_ns),
            tier: window.tier().map(mouthpiece_render::Tier::name),
            skew_ms: window.skew_ns.get() as f64 * 1e-6,
            failures: window.failures.get(),
        },
        simulation: Simulation {
            lead_ms: 1e3 * seconds(simulation.lead.get()),
            key_frames: simulation.key_frames.get(),
            rewinds: simulation.rewinds.get(),
            skips: simulation.skips.get(),
        },
        sound: Sound {
            device: match sound.device() {
                DeviceState::Playing => "playing",
                DeviceState::Missing => "missing",
                DeviceState::Unwanted => "not wanted",
            },
            losses: sound.losses.get(),
            underruns: sound.underruns.get(),
            heard_s: seconds(sound.audible.get()),
            dropped_labels: sound.dropped_labels.get(),
            dropped_s: seconds(i64::try_from(sound.dropped.get()).unwrap_or(i64::MAX)),
        },
        utterances: Utterances {
            queue: sound.queue.get(),
            held_s: seconds(sound.held.get()),
            accepted: sound.begun.get(),
            finished: sound.finished.get(),
            stopped: sound.stopped.get(),
            error: sound.failed.get(),
        },
        clients: vitals.net.clients.get(),
    }
}
