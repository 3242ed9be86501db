//! A device on the air: what it was given, and whether it can be relied on.
//!
//! For the sound thread's way out. One that says it is gone, that stops calling, or that swallows sound faster than
//! time passes is named a [`Fault`]; what is done about it is not decided here.

use std::sync::atomic::Ordering;

use mouthpiece_rig::TICK_RATE;

use super::device::Device;
use super::resample::Resample;
use crate::live::clock::ClockCell;
use crate::live::time::{ticks_from_frames, ticks_from_ns};

/// A device that has not called for this long is dead. Some pause for up to 2 s when they start and
/// after an underrun: a PulseAudio sink that nobody else uses prepares that much at once.
const SILENT_NS: i64 = 2_500_000_000;
const SILENT_AT_START_NS: i64 = 3_000_000_000;
/// Periods that may be missed before the above counts, for devices with long ones.
const SILENT_PERIODS: i64 = 8;
/// Over this long a device may take half as much sound again as time passes, and what fills the
/// largest buffers that were seen.
const PACE_NS: i64 = 8_000_000_000;
const PACE_SPARE_TICKS: i64 = 4 * TICK_RATE;
/// A device's first words about its latency are often wrong; by then they are not.
const SETTLED_NS: i64 = 1_000_000_000;

/// An open device that plays what is mixed.
pub(super) struct Playing {
    pub(super) device: Device,
    /// The tick of its first frame.
    pub(super) base: i64,
    /// Frames put into the ring.
    pub(super) pushed: i64,
    pub(super) resample: Resample,
    frames: Vec<f32>,
    pub(super) watch: Watch,
}

/// What the watchdog remembers.
pub(super) struct Watch {
    opened_ns: i64,
    calls: u64,
    called_ns: i64,
    limit_ns: i64,
    /// Where the pace was last taken: time and frames taken.
    pace: (i64, i64),
    /// How often the device ran dry.
    pub(super) underruns: u64,
    /// Its latency was told.
    told: bool,
}

/// Why a device is of no use.
#[derive(Clone, Copy)]
pub(super) enum Fault {
    Gone,
    Silent,
    Unpaced,
}

impl Fault {
    /// For "the sound device ...".
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Gone => "is gone",
            Self::Silent => "has stopped asking for sound",
            Self::Unpaced => "takes sound faster than time passes and is of no use as a clock",
        }
    }
}

impl Playing {
    pub(super) fn new(device: Device, base: i64, now_ns: i64) -> Result<Self, String> {
        let ticks = u32::try_from(TICK_RATE).map_err(|e| e.to_string())?;
        let resample = Resample::new(ticks, device.rate).map_err(|e| format!("{e:#}"))?;
        Ok(Self {
            watch: Watch {
                opened_ns: now_ns,
                calls: 0,
                called_ns: now_ns,
                limit_ns: SILENT_AT_START_NS,
                pace: (now_ns, 0),
                underruns: 0,
                told: false,
            },
            device,
            base,
            pushed: 0,
            resample,
            frames: Vec::new(),
        })
    }

    /// Hands over the next ticks.
    pub(super) fn push(&mut self, mixed: &[f32]) {
        self.frames.clear();
        if let Err(error) = self.resample.push(mixed, &mut self.frames) {
            tracing::error!("sound was lost: {error:#}");
        }
        let (_, left) = self.device.ring.push_partial_slice(&self.frames);
        self.pushed += i64::try_from(self.frames.len() - left.len()).unwrap_or(0);
    }

    /// What is wrong with it at `now_ns`; a thread that was not let run has nothing to judge by.
    pub(super) fn fault(
        &mut self,
        cell: &ClockCell,
        now_ns: i64,
        overslept: bool,
    ) -> Option<Fault> {
        let watch = &mut self.watch;
        let calls = cell.count();
        if calls != watch.calls {
            let period_ns =
                i64::from(self.device.period) * 1_000_000_000 / i64::from(self.device.rate.max(1));
            // The first calls are far apart in some devices, so the patience of the start lasts a
            // few of them.
            if now_ns - watch.opened_ns > SILENT_AT_START_NS {
                watch.limit_ns = SILENT_NS.max(SILENT_PERIODS * period_ns);
            }
            watch.calls = calls;
            watch.called_ns = now_ns;
        } else if overslept {
            watch.called_ns = now_ns;
        }
        if now_ns - watch.opened_ns > SETTLED_NS && !std::mem::replace(&mut watch.told, true) {
            let latency_ms = self.device.link.latency_ns.load(Ordering::Relaxed) as f64 * 1e-6;
            tracing::info!(latency_ms, "the sound device has settled");
        }
        let underruns = self.device.link.underruns.load(Ordering::Relaxed);
        if underruns != watch.underruns {
            tracing::debug!(underruns, "the sound device ran dry");
            watch.underruns = underruns;
        }
        if self.device.link.lost.load(Ordering::Acquire) {
            return Some(Fault::Gone);
        }
        if now_ns - watch.called_ns > watch.limit_ns {
            return Some(Fault::Silent);
        }
        let taken = self.device.link.taken.load(Ordering::Acquire);
        let elapsed_ns = now_ns - watch.pace.0;
        let played = ticks_from_frames(taken - watch.pace.1, self.device.rate);
        if played > ticks_from_ns(elapsed_ns) * 3 / 2 + PACE_SPARE_TICKS {
            return Some(Fault::Unpaced);
        }
        if elapsed_ns > PACE_NS {
            watch.pace = (now_ns, taken);
        }
        None
    }
}
