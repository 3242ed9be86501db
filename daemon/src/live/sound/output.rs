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
use super::playing::{Fault, Playing};
use crate::live::clock::{AudibleClock, ClockCell, Stamp};
use crate::live::time::{Origin, seconds, ticks_from_frames, ticks_from_ns};

/// Sound that waits between mixer and device: what covers for a sound thread that is not let run.
const LEAD_TICKS: i64 = TICK_RATE * 80 / 1000;
/// Ticks mixed at once.
pub const BLOCK_TICKS: usize = 480;
/// The sound thread itself was not let run (suspended process): judge nothing by that.
const OVERSLEPT_NS: i64 = 500_000_000;
/// First and longest wait before a device is tried again: nothing tells of one that comes back, and
/// a try costs next to nothing.
const RETRY_NS: i64 = 1_000_000_000;
const RETRY_NS_MAX: i64 = 4_000_000_000;
/// How long the start waits for a device; one that takes longer is taken up when it comes.
const START_PATIENCE: Duration = Duration::from_secs(4);
/// A device that comes while time runs plays silence for so long before it keeps the clock: one that pauses
/// after its first calls would stop the face.
const WARM_NS: i64 = 2_500_000_000;
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
        let lost = |(device, _): &mut (Device, i64)| device.link.lost.load(Ordering::Acquire);
        if let Some((device, _)) = self.warming.take_if(lost) {
            close(device);
            return self.try_again("the sound device went before it was warm", now_ns);
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
            close(playing.device);
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

/// Closes a device on a thread of its own: some that have died do not let go.
fn close(device: Device) {
    let closing = std::thread::Builder::new()
        .name("sound-close".to_owned())
        .spawn(move || drop(device.stream));
    if let Err(error) = closing {
        tracing::warn!(%error, "a dead sound device was not closed");
    }
}
