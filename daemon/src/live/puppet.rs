//! The `puppet` thread: other avatars that move with our speech, over UDP (`--drive`).
//!
//! Wanted: each message shows the face as it is at the instant that is heard when it is sent; a
//! steady rate; nothing that a network does is felt by the rest of the program; where nobody
//! listens, nothing happens.
//!
//! So this thread has a ring of key frames of its own beside the window's, reads the audible clock
//! as the window does, and sends without ever waiting: what the socket does not take is lost, as
//! with UDP anyway. What it sends is what `curves --as arkit` writes, from the same code. At the end
//! it sends the face at rest, so that no avatar is left with its mouth open.
//!
//! | module | holds |
//! |---|---|
//! | [`link`] | the socket, and what is spoken through it |
//! | [`vmc`] | VMC protocol, for VRM avatars |
//! | [`osc`] | plain OSC |
//! | [`livelink`] | Live Link Face's packet |

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use anyhow::Result;
use mouthpiece_rig::{Head, KeyFrame};

use super::clock::AudibleClock;
use super::frames::FrameReader;
use super::time::{self, Flow, Origin};
use crate::avatar::face::{Face, Reader};
use crate::config::Drive;

mod link;
mod livelink;
mod osc;
mod vmc;

use link::Link;

/// Until the simulation has begun: how long to wait.
const NOT_YET: Duration = Duration::from_millis(10);

/// The running thread.
pub struct Puppeteer {
    thread: JoinHandle<()>,
    end: Arc<AtomicBool>,
}

impl Puppeteer {
    /// Opens the sockets and starts the thread.
    pub fn start(
        drive: &Drive,
        head: &Arc<Head>,
        frames: FrameReader,
        clock: AudibleClock,
        origin: Origin,
    ) -> Result<Self> {
        let links: Result<Vec<Link>> = drive.to.iter().map(Link::open).collect();
        let rate_hz = u16::try_from(drive.rate_hz.get())?;
        let mut hands = Hands {
            links: links?,
            reader: Reader::new(head),
            rest: head.rest_frame(),
            frame: KeyFrame::default(),
            interval_ns: 1_000_000_000 / i64::from(rate_hz),
            rate_hz,
            due_ns: 0,
            end: Arc::default(),
            frames,
            clock,
        };
        let end = Arc::clone(&hands.end);
        let thread = super::player::spawn("puppet", move || {
            time::drive(|| hands.step(origin.now_ns()));
        })?;
        Ok(Self { thread, end })
    }

    /// Asks it to end; whoever waits for it takes the thread.
    pub fn end(self) -> JoinHandle<()> {
        self.end.store(true, Ordering::Release);
        self.thread
    }
}

/// The thread's state; [`Hands::step`] is its body.
struct Hands {
    links: Vec<Link>,
    reader: Reader,
    rest: KeyFrame,
    frame: KeyFrame,
    frames: FrameReader,
    clock: AudibleClock,
    interval_ns: i64,
    rate_hz: u16,
    due_ns: i64,
    end: Arc<AtomicBool>,
}

/// A face at an instant, as encoders take it.
struct Moment<'a> {
    face: Face<'a>,
    /// The audible instant, ticks.
    ticks: i64,
    rate_hz: u16,
}

impl Hands {
    fn step(&mut self, now_ns: i64) -> Flow {
        let ending = self.end.load(Ordering::Acquire);
        if now_ns < self.due_ns && !ending {
            return Flow::Wait(nanoseconds(self.due_ns - now_ns));
        }
        let ticks = self.clock.at(now_ns);
        if !self.frames.sample(ticks, &mut self.frame) {
            return if ending {
                Flow::End
            } else {
                Flow::Wait(NOT_YET)
            };
        }
        let frame = if ending { &self.rest } else { &self.frame };
        let moment = Moment {
            face: self.reader.face(frame),
            ticks,
            rate_hz: self.rate_hz,
        };
        for link in &mut self.links {
            link.send(&moment);
        }
        if ending {
            return Flow::End;
        }
        // In step with the last one; what was missed is not sent after.
        self.due_ns += self.interval_ns;
        if self.due_ns <= now_ns {
            self.due_ns = now_ns + self.interval_ns;
        }
        Flow::Wait(nanoseconds(self.due_ns - now_ns))
    }
}

fn nanoseconds(ns: i64) -> Duration {
    Duration::from_nanos(u64::try_from(ns).unwrap_or(0))
}
