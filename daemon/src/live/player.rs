//! The live machine put together: sound and simulation threads, and the ends that others hold.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;

use anyhow::{Context as _, Result};
use mouthpiece_phonemes::Segment;
use mouthpiece_protocol::ErrorCode;
use mouthpiece_rig::{Simulation, TICK_RATE};
use mouthpiece_speech::Idle;
use tokio::sync::mpsc;
use tokio_util::sync::CancellationToken;

use super::captions::Captions;
use super::clock::{AudibleClock, ClockCell};
use super::conductor::{COMMANDS_MAX, CUES_MAX, Command, Conductor, Ends};
use super::face::Face;
use super::frames::{FrameReader, key_frames};
use super::puppet::Puppeteer;
use super::rules::Rules;
use super::score::Score;
use super::shots::Shots;
use super::showing::Showing;
use super::sound::{Choice, Output};
use super::sync::Onsets;
use super::time::{Origin, drive};
use super::utterance::Begin;
use super::vitals::Vitals;
use crate::config::{self, Drive};
use crate::pipeline::Cast;

/// The head is settled by this much motion before anything is shown.
const PRE_ROLL_TICKS: i64 = TICK_RATE;

/// The running threads. Dropped last; [`Player::end`] waits for them.
pub struct Player {
    handle: Handle,
    threads: Vec<JoinHandle<()>>,
    puppeteer: Option<Puppeteer>,
    has_sound: bool,
}

/// What the window needs, and whoever else looks at the head.
pub struct Sight {
    /// Key frames.
    pub frames: FrameReader,
    /// What is heard.
    pub clock: AudibleClock,
    /// Process time.
    pub origin: Origin,
    /// Where the window says how it is.
    pub vitals: Arc<Vitals>,
    /// The text that goes with what is heard.
    pub captions: Arc<Captions>,
    /// Who wants to see the picture, too.
    pub shots: Shots,
}

/// Sends utterances to the sound thread. Clones reach the same one.
#[derive(Clone, Debug)]
pub struct Handle {
    commands: mpsc::Sender<Command>,
    keys: Arc<AtomicU64>,
    vitals: Arc<Vitals>,
    closing: CancellationToken,
}

impl Player {
    /// Starts both threads. `life` is what the face does by itself. `onsets` learn of clicks in what is said.
    pub fn start(
        cast: &Cast,
        choice: Choice,
        life: &config::Life,
        rules: Rules,
        avatars: &Drive,
        onsets: Option<Arc<Onsets>>,
    ) -> Result<(Self, Sight)> {
        let origin = Origin::new();
        let cell = Arc::new(ClockCell::default());
        let vitals = Arc::new(Vitals::new(origin));
        let (commands, inbox) = mpsc::channel(COMMANDS_MAX);
        let (cue, cues) = crossbeam::channel::bounded(CUES_MAX);
        let (writer, frames) = key_frames();
        let mut writers = vec![writer];
        let puppeteer = if avatars.to.is_empty() {
            None
        } else {
            let (writer, frames) = key_frames();
            writers.push(writer);
            let clock = AudibleClock::new(Arc::clone(&cell));
            Some(Puppeteer::start(
                avatars, &cast.head, frames, clock, origin,
            )?)
        };

        let calibration = cast.head.calibration.clone();
        let score = Score::new(
            &cast.speech,
            calibration,
            Idle::new(life.seed),
            life.state.into(),
        );
        let clock = AudibleClock::new(Arc::clone(&cell));
        let mut body = Simulation::new(Arc::clone(&cast.head));
        let face_vitals = Arc::clone(&vitals);
        let simulation = spawn("simulation", move || {
            body.set_time(-PRE_ROLL_TICKS);
            while body.time() < 0 {
                let controls = score.controls_at(body.time());
                body.step(&controls);
            }
            let mut face = Face::new(body, score, clock, cues, writers, face_vitals);
            drive(|| face.step(origin.now_ns()));
        })?;

        let face = simulation.thread().clone();
        let speech = cast.speech.clone();
        let captions = Arc::new(Captions::default());
        let written = Arc::clone(&captions);
        let sound_cell = Arc::clone(&cell);
        let sound_vitals = Arc::clone(&vitals);
        let (opened, has_sound) = std::sync::mpsc::sync_channel(1);
        let sound = spawn("sound", move || {
            let output = Output::open(choice, sound_cell, origin);
            // Nobody waits for it only when the start itself failed.
            let _ = opened.send(output.has_device());
            let ends = Ends {
                commands: inbox,
                cues: cue,
                face: Some(face),
                captions: written,
            };
            let mut conductor = Conductor::new(output, ends, speech, rules, sound_vitals);
            if let Some(onsets) = onsets {
                conductor.listen(onsets);
            }
            drive(|| conductor.step(origin.now_ns()));
        })?;

        let player = Self {
            handle: Handle::new(commands, Arc::clone(&vitals)),
            threads: vec![sound, simulation],
            puppeteer,
            has_sound: has_sound.recv().unwrap_or(false),
        };
        let sight = Sight {
            frames,
            clock: AudibleClock::new(cell),
            origin,
            vitals,
            captions,
            shots: Shots::default(),
        };
        Ok((player, sight))
    }

    pub fn handle(&self) -> Handle {
        self.handle.clone()
    }

    /// Whether there was a sound device at the start.
    pub fn has_sound(&self) -> bool {
        self.has_sound
    }

    /// Ends the threads and waits for them; an error when one had died.
    pub fn end(mut self) -> Result<()> {
        // Full only while the sound thread is behind; it ends as well when all handles are gone.
        let _ = self.handle.commands.try_send(Command::Quit);
        drop(self.handle);
        self.threads
            .extend(self.puppeteer.take().map(Puppeteer::end));
        for thread in self.threads {
            let name = thread.thread().name().unwrap_or("a").to_owned();
            thread.thread().unpark();
            anyhow::ensure!(
                thread.join().is_ok(),
                "the {name} thread broke down; the lines above say where"
            );
        }
        Ok(())
    }
}

impl Handle {
    /// One that leads to whoever takes `commands`.
    pub fn new(commands: mpsc::Sender<Command>, vitals: Arc<Vitals>) -> Self {
        Self {
            commands,
            keys: Arc::default(),
            vitals,
            closing: CancellationToken::new(),
        }
    }

    /// A number that no other utterance has.
    pub fn new_key(&self) -> u64 {
        self.keys.fetch_add(1, Ordering::Relaxed)
    }

    /// What the live threads say of themselves.
    pub fn vitals(&self) -> &Arc<Vitals> {
        &self.vitals
    }

    pub async fn begin(&self, begin: Begin) {
        self.send(Command::Begin(begin)).await;
    }

    pub async fn segments(&self, key: u64, segments: Vec<Segment>) {
        self.send(Command::Segments(key, segments)).await;
    }

    /// Sound at 48 kHz, one channel.
    pub async fn sound(&self, key: u64, mono: Vec<f32>) {
        self.send(Command::Sound(key, mono)).await;
    }

    pub async fn end(&self, key: u64) {
        self.send(Command::End(key)).await;
    }

    pub async fn fail(&self, key: u64, code: ErrorCode, message: String) {
        self.send(Command::Fail(key, code, message)).await;
    }

    /// Stops one utterance, or everything.
    pub async fn stop(&self, key: Option<u64>) {
        self.send(Command::Stop(key)).await;
    }

    /// Has the face show something from now on.
    pub async fn show(&self, showing: Showing) {
        self.send(Command::Show(showing)).await;
    }

    /// A text for the screen: from tick `start` of an utterance's sound on, or at once.
    pub async fn caption(&self, key: Option<u64>, start: i64, text: String) {
        self.send(Command::Caption(key, start, text.into())).await;
    }

    /// Other rules for who speaks, and how much of it is held.
    pub async fn rule(&self, rules: Rules) {
        self.send(Command::Rules(Box::new(rules))).await;
    }

    /// Done when the process is ending: nothing more is begun, and what was begun has been stopped.
    pub fn closing(&self) -> &CancellationToken {
        &self.closing
    }

    /// Waits while the sound thread has enough to do. Without that thread there is nobody to tell:
    /// the process is ending.
    async fn send(&self, command: Command) {
        let _ = self.commands.send(command).await;
    }
}

/// Starts a named thread.
pub(super) fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>> {
    std::thread::Builder::new()
        .name(name.to_owned())
        .spawn(work)
        .with_context(|| format!("no thread for {name}; allow this process more of them"))
}
