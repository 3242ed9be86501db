//! Where mixed speech goes: the sound device, or a steady clock while there is none.
//!
//! Runs on the sound thread. Watches the device: one that says it is gone, that stops calling, or
//! that swallows sound faster than time passes is given up; a steady clock carries time on from
//! where it stood, and from time to time the device is tried again. Sound that a dead device had
//! taken but not played is mixed again, so nothing is lost.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use mouthpiece_rig::TICK_RATE;

use super::device::Device;
use super::opening::Opening;
use super::resample::Resample;
use crate::live::clock::{AudibleClock, ClockCell, Stamp};
use crate::live::time::{Origin, seconds, ticks_from_frames, ticks_from_ns};

/// Sound that waits between mixer and device: what covers for a sound thread that is not let run.
const LEAD_TICKS: i64 = TICK_RATE * 80 / 1000;
/// Ticks mixed at once.
pub const BLOCK_TICKS: usize = 480;
/// A device that has not called for this long is dead. Some pause for up to 2 s when they start and
/// after an underrun: a PulseAudio sink that nobody else uses prepares that much at once.
const SILENT_NS: i64 = 2_500_000_000;
const SILENT_AT_START_NS: i64 = 3_000_000_000;
/// Periods that may be missed before the above counts, for devices with long ones.
const SILENT_PERIODS: i64 = 8;
/// The sound thread itself was not let run (suspended process): judge nothing by that.
const OVERSLEPT_NS: i64 = 500_000_000;
/// Over this long a device may take half as much sound again as time passes, and what fills the
/// largest buffers that were seen.
const PACE_NS: i64 = 8_000_000_000;
const PACE_SPARE_TICKS: i64 = 4 * TICK_RATE;
/// First and longest wait before a device is tried again: nothing tells of one that comes back, and
/// a try costs next to nothing.
const RETRY_NS: i64 = 1_000_000_000;
const RETRY_NS_MAX: i64 = 4_000_000_000;
/// How long the start waits for a device; one that takes longer is taken up when it comes.
const START_PATIENCE: Duration = Duration::from_secs(4);
/// A device that comes while time runs plays silence for so long before it keeps the clock: one that pauses
/// after its first calls would stop the face.
const WARM_NS: i64 = 2_500_000_000;
/// A device's first words about its latency are often wrong; by then they are not.
const SETTLED_NS: i64 = 1_000_000_000;
/// How far a steady clock may be read beyond its last stamp.
const STEADY_TICKS: i64 = TICK_RATE;

/// Which device is wanted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Choice {
    /// None: a steady clock.
    Silent,
    /// The system's default.
    Default,
    /// The one with this id.
    Id(String),
}

enum Sink {
    Device(Box<Playing>),
    Steady { base: i64, since_ns: i64 },
}

struct Playing {
    device: Device,
    base: i64,
    /// Frames put into the ring.
    pushed: i64,
    resample: Resample,
    frames: Vec<f32>,
    watch: Watch,
}

/// What the watchdog remembers.
struct Watch {
    opened_ns: i64,
    calls: u64,
    called_ns: i64,
    limit_ns: i64,
    /// Where the pace was last taken: time and frames taken.
    pace: (i64, i64),
    underruns: u64,
    /// Its latency was told.
    told: bool,
}

/// The way out.
pub struct Output {
    choice: Choice,
    cell: Arc<ClockCell>,
    clock: AudibleClock,
    origin: Origin,
    sink: Sink,
    /// The next tick to be mixed.
    written: i64,
    polled_ns: i64,
    retry_ns: i64,
    backoff_ns: i64,
    /// A device on its way; never more than one.
    opening: Option<Opening>,
    /// One that is open and not yet on the air, and since when.
    warming: Option<(Device, i64)>,
    /// Of the devices before this one.
    underruns: u64,
}

impl Output {
    /// Opens the device, or begins with a steady clock and says so.
    pub fn open(choice: Choice, cell: Arc<ClockCell>, origin: Origin) -> Self {
        let now_ns = origin.now_ns();
        let mut output = Self {
            choice,
            clock: AudibleClock::new(Arc::clone(&cell)),
            cell,
            origin,
            sink: Sink::Steady {
                base: 0,
                since_ns: now_ns,
            },
            written: 0,
            polled_ns: now_ns,
            retry_ns: now_ns,
            backoff_ns: RETRY_NS,
            opening: None,
            warming: None,
            underruns: 0,
        };
        if output.choice == Choice::Silent {
            output.retry_ns = i64::MAX;
            tracing::info!("no sound device wanted: a steady clock keeps time");
        } else {
            output.begin(now_ns);
        }
        output
    }

    /// Whether sound can be heard now.
    pub fn has_device(&self) -> bool {
        matches!(self.sink, Sink::Device(_))
    }

    /// Whether sound is to be heard at all.
    pub fn wants_device(&self) -> bool {
        self.choice != Choice::Silent
    }

    /// How often a device ran dry so far.
    pub fn underruns(&self) -> i64 {
        let now = match &self.sink {
            Sink::Device(playing) => playing.watch.underruns,
            Sink::Steady { .. } => 0,
        };
        i64::try_from(self.underruns + now).unwrap_or(i64::MAX)
    }

    /// The tick that is heard at `now_ns`.
    pub fn audible(&mut self, now_ns: i64) -> i64 {
        self.clock.at(now_ns)
    }

    /// The first tick that can still be decided on.
    pub fn written(&self) -> i64 {
        self.written
    }

    /// Keeps the clock going and the device watched. True when sound has to be mixed again from
    /// [`Self::written`], which went back.
    pub fn poll(&mut self, now_ns: i64) -> bool {
        let overslept = now_ns - self.polled_ns > OVERSLEPT_NS;
        self.polled_ns = now_ns;
        let fault = match &mut self.sink {
            Sink::Device(playing) => playing.fault(&self.cell, now_ns, overslept),
            Sink::Steady { base, since_ns } => {
                let first = *base + ticks_from_ns(now_ns - *since_ns);
                self.cell.publish(Stamp {
                    first,
                    end: first + STEADY_TICKS,
                    playback_ns: now_ns,
                });
                // Nothing can begin in the past.
                self.written = self.written.max(first);
                None
            }
        };
        if let Some(fault) = fault {
            self.give_up(fault, now_ns);
            return true;
        }
        if self.has_device() {
            return false;
        }
        let warm = |(_, since_ns): &mut (Device, i64)| now_ns - *since_ns > WARM_NS;
        if let Some((device, _)) = self.warming.take_if(warm) {
            return match self.adopt(device, now_ns) {
                Ok(()) => true,
                Err(why) => self.try_again(&why, now_ns),
            };
        }
        if let Some(result) = self.opening.as_ref().and_then(Opening::poll) {
            self.opening = None;
            match result {
                Ok(device) => self.warming = Some((device, now_ns)),
                Err(why) => return self.try_again(&why, now_ns),
            }
        }
        if self.opening.is_none()
            && self.warming.is_none()
            && now_ns >= self.retry_ns
            && let Err(why) = self.try_device()
        {
            return self.try_again(&why, now_ns);
        }
        false
    }

    /// Nothing has to be mixed again for a device that did not come.
    fn try_again(&mut self, why: &str, now_ns: i64) -> bool {
        tracing::debug!("{why}; still without sound");
        self.try_later(now_ns);
        false
    }

    /// How many ticks are to be mixed now.
    pub fn wanted(&mut self, now_ns: i64) -> usize {
        let missing = match &self.sink {
            Sink::Device(playing) => {
                let taken = playing.device.link.taken.load(Ordering::Acquire);
                LEAD_TICKS - ticks_from_frames(playing.pushed - taken, playing.device.rate)
            }
            Sink::Steady { .. } => self.clock.at(now_ns) + LEAD_TICKS - self.written,
        };
        usize::try_from(missing).unwrap_or(0)
    }

    /// Hands over the ticks from [`Self::written`] on.
    pub fn push(&mut self, mixed: &[f32]) {
        if let Sink::Device(playing) = &mut self.sink {
            playing.push(mixed);
        }
        self.written += i64::try_from(mixed.len()).unwrap_or(0);
    }

    /// Silences everything that was handed over; returns the first tick that is not heard.
    pub fn silence(&mut self, now_ns: i64) -> i64 {
        match &self.sink {
            Sink::Device(playing) => {
                let link = &playing.device.link;
                let until = playing.pushed + playing.resample.inside();
                link.silent_until.store(until, Ordering::Release);
                let taken = link.taken.load(Ordering::Acquire);
                playing.base + ticks_from_frames(taken, playing.device.rate)
            }
            Sink::Steady { .. } => self.clock.at(now_ns),
        }
    }

    /// Opens the wanted device for the first time.
    fn begin(&mut self, now_ns: i64) {
        let first = self.try_device();
        let opened = match (first, &self.opening) {
            (Err(why), _) => Err(why),
            (Ok(()), Some(opening)) => match opening.wait(START_PATIENCE) {
                Some(result) => {
                    self.opening = None;
                    result
                }
                None => Err("the sound device does not open".to_owned()),
            },
            (Ok(()), None) => return,
        };
        if let Err(why) = opened.and_then(|device| self.adopt(device, self.origin.now_ns())) {
            tracing::warn!("{why}; going on without sound, a steady clock keeps time");
            self.try_later(now_ns);
        }
    }

    /// Begins to open the wanted device.
    fn try_device(&mut self) -> Result<(), String> {
        let wanted = match &self.choice {
            Choice::Silent => return Ok(()),
            Choice::Default => None,
            Choice::Id(id) => Some(id.clone()),
        };
        self.opening = Some(Opening::start(wanted, &self.cell, self.origin)?);
        Ok(())
    }

    fn try_later(&mut self, now_ns: i64) {
        self.retry_ns = now_ns + self.backoff_ns;
        self.backoff_ns = (self.backoff_ns * 2).min(RETRY_NS_MAX);
    }

    /// Puts an open device on the air where time stands now.
    fn adopt(&mut self, device: Device, now_ns: i64) -> Result<(), String> {
        let base = self.clock.at(now_ns);
        let playing = Playing::new(device, base, now_ns)?;
        let link = &playing.device.link;
        link.base.store(base, Ordering::Relaxed);
        link.on_air.store(true, Ordering::Release);
        self.sink = Sink::Device(Box::new(playing));
        self.written = base;
        self.backoff_ns = RETRY_NS;
        Ok(())
    }

    /// Puts the steady clock in the device's place.
    fn give_up(&mut self, fault: Fault, now_ns: i64) {
        let base = self.clock.at(now_ns);
        let steady = Sink::Steady {
            base,
            since_ns: now_ns,
        };
        if let Sink::Device(playing) = std::mem::replace(&mut self.sink, steady) {
            tracing::warn!(
                device = %playing.device.name, at_s = seconds(base),
                "the sound device {}; going on without sound, a steady clock keeps time", fault.words()
            );
            self.underruns += playing.watch.underruns;
            playing.device.link.on_air.store(false, Ordering::Release);
            close(*playing);
        }
        // What the dead device was given and did not play is handed over anew.
        self.written = base;
        self.retry_ns = match fault {
            Fault::Unpaced => i64::MAX,
            Fault::Gone | Fault::Silent => now_ns + self.backoff_ns,
        };
        self.cell.publish(Stamp {
            first: base,
            end: base + STEADY_TICKS,
            playback_ns: now_ns,
        });
    }
}

#[derive(Clone, Copy)]
enum Fault {
    Gone,
    Silent,
    Unpaced,
}

impl Fault {
    fn words(self) -> &'static str {
        match self {
            Self::Gone => "is gone",
            Self::Silent => "has stopped asking for sound",
            Self::Unpaced => "takes sound faster than time passes and is of no use as a clock",
        }
    }
}

impl Playing {
    fn new(device: Device, base: i64, now_ns: i64) -> Result<Self, String> {
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

    fn push(&mut self, mixed: &[f32]) {
        self.frames.clear();
        if let Err(error) = self.resample.push(mixed, &mut self.frames) {
            tracing::error!("sound was lost: {error:#}");
        }
        let (_, left) = self.device.ring.push_partial_slice(&self.frames);
        self.pushed += i64::try_from(self.frames.len() - left.len()).unwrap_or(0);
    }

    fn fault(&mut self, cell: &ClockCell, now_ns: i64, overslept: bool) -> Option<Fault> {
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

/// Closes a device on a thread of its own: some that have died do not let go.
fn close(playing: Playing) {
    let closing = std::thread::Builder::new()
        .name("sound-close".to_owned())
        .spawn(move || drop(playing.device.stream));
    if let Err(error) = closing {
        tracing::warn!(%error, "a dead sound device was not closed");
    }
}
