//! The one offline pipeline: segments to muscle controls to a moving head, instant by instant.
//!
//! Export, curves and still all draw from here, so that what curves measure is what export shows.
//! The simulation runs on its own thread into a bounded queue, so that it overlaps with drawing
//! and encoding. The counter of instants is the only clock: the same utterance,
//! instants and seed give the same key frames, whatever the machine is doing meanwhile.

mod cost;

use std::sync::Arc;
use std::thread::JoinHandle;

use anyhow::Context as _;
use crossbeam::channel::{Receiver, Sender, bounded};
use mouthpiece_phonemes::Segment;
use mouthpiece_rig::{
    Controls, Head, KeyFrame, Library, Mouth, STEP_TICKS, Script, Simulation, TICK_RATE,
};
use mouthpiece_speech::{Idle, Listener, LookAhead, Manner, Speech, State, Track};

use crate::cli::{CastArgs, MoodArgs, Usage};
use crate::interrupt;
use cost::Cost;

/// The head runs this long before the first instant, so that it is settled by then.
const PRE_ROLL_TICKS: i64 = TICK_RATE;
const _: () = assert!(PRE_ROLL_TICKS % STEP_TICKS == 0);

/// Key frames between simulation and drawing: enough to even out slow frames; more would only hold
/// memory (some 150 kB each).
const QUEUE: usize = 8;

/// A head, and how it speaks.
#[derive(Clone)]
pub struct Cast {
    pub head: Arc<Head>,
    pub speech: Speech,
}

impl Cast {
    /// The head in a file, or the built-in one, with its own tissue or another.
    pub fn load(args: &CastArgs) -> anyhow::Result<Self> {
        let mut head = match &args.head {
            Some(file) => Head::load(file)?,
            None => Head::reference()?,
        };
        if let Some(tissue) = args.tissue {
            head.tissue.model = tissue.into();
        }
        let speech = Speech::new(&head.calibration)?;
        let head = Arc::new(head);
        Ok(Self { head, speech })
    }
}

/// What a face shows while it speaks: one expression throughout, a script, both or neither.
#[derive(Clone, Debug, Default)]
pub struct Mood {
    expression: Option<Controls>,
    script: Option<Script>,
    state: State,
}

impl Mood {
    /// As the command line has it.
    pub fn load(args: &MoodArgs) -> anyhow::Result<Self> {
        Ok(Self {
            expression: args.expression.as_deref().map(expression).transpose()?,
            script: args.script.as_deref().map(Script::read).transpose()?,
            state: args.state.into(),
        })
    }

    /// Lays it over what speech says at `ticks`.
    fn show(&self, ticks: i64, mouth: impl Fn(&Controls) -> Mouth, controls: &mut Controls) {
        if self.expression.is_none() && self.script.is_none() {
            return;
        }
        let mouth = mouth(controls);
        let scripted = self.script.as_ref().map(|script| script.controls_at(ticks));
        for face in [&self.expression, &scripted].into_iter().flatten() {
            controls.express(face, 1.0, mouth);
        }
    }
}

/// The expression of that name in the library; what is not there is wrong usage.
pub fn expression(name: &str) -> anyhow::Result<Controls> {
    let known = Library::built_in()?;
    let found = known
        .get(name)
        .map_err(|error| Usage(format!("--expression: {error}")))?;
    Ok(*found.controls())
}

/// What the head is told: speech, an expression over it, and on top of both what a living face does.
#[derive(Clone)]
pub struct Part {
    spoken: Spoken,
    head: Arc<Head>,
    mood: Mood,
    idle: Option<Idle>,
}

/// What is said: all of it, or as much as is known by now.
#[derive(Clone)]
enum Spoken {
    Whole(Track),
    Coming(Box<LookAhead>),
}

impl Spoken {
    fn track(&self) -> &Track {
        match self {
            Self::Whole(track) => track,
            Self::Coming(coming) => coming.stream().track(),
        }
    }

    fn controls_at(&self, ticks: i64) -> Controls {
        match self {
            Self::Whole(track) => track.controls_at(ticks),
            Self::Coming(coming) => coming.stream().controls_at(ticks),
        }
    }
}

impl Part {
    /// Speaks `segments`; with a seed it also blinks, glances, breathes and nods.
    pub fn new(cast: &Cast, segments: &[Segment], seed: Option<u64>) -> Self {
        Self {
            spoken: Spoken::Whole(cast.speech.track(segments)),
            head: Arc::clone(&cast.head),
            mood: Mood::default(),
            idle: seed.map(Idle::new),
        }
    }

    /// Speaks as loud and stressed as `sound`, 48 kHz mono, is.
    pub fn hearing(mut self, sound: Option<&[f32]>) -> Self {
        if let (Spoken::Whole(track), Some(sound)) = (&mut self.spoken, sound) {
            track.hear(&Listener::whole(sound));
        }
        self
    }

    /// Shows `mood` besides.
    pub fn with_mood(self, mood: Mood) -> Self {
        Self { mood, ..self }
    }

    /// From now on labels become known only `ticks` before they begin; says what that costs.
    pub fn look_ahead(&mut self, cast: &Cast, ticks: i64) -> Cost {
        let segments = self.spoken.track().segments().to_vec();
        let whole = cast.speech.track(&segments);
        let coming = LookAhead::new(&cast.speech, &segments, ticks);
        let cost = Cost::of(&whole, coming.clone());
        self.spoken = Spoken::Coming(Box::new(coming));
        cost
    }

    /// Learns what becomes known by `now`.
    fn advance(&mut self, now: i64) {
        if let Spoken::Coming(coming) = &mut self.spoken {
            coming.advance(now);
        }
    }

    /// The controls at `ticks`.
    pub fn controls_at(&self, ticks: i64) -> Controls {
        let mut controls = self.spoken.controls_at(ticks);
        let track = self.spoken.track();
        let speaking = track.speaking_at(ticks);
        let mouth = |speech: &Controls| Mouth::of(&self.head.calibration, speech, speaking);
        self.mood.show(ticks, mouth, &mut controls);
        if let Some(idle) = &self.idle {
            let manner = Manner::from(self.mood.state).towards(State::Speaking, speaking);
            idle.add(ticks, &manner, &mut controls);
            idle.accompany(track, ticks, 1.0, &mut controls);
        }
        controls
    }
}

/// One instant of a performance.
#[derive(Clone, Debug, Default)]
pub struct Instant {
    /// What the head was told.
    pub controls: Controls,
    /// Where it was.
    pub frame: KeyFrame,
}

/// A head stepped through a part; asked for instants in order of time.
pub struct Performance {
    simulation: Simulation,
    part: Part,
    before: KeyFrame,
    after: KeyFrame,
}

impl Performance {
    /// Settles the head before tick 0.
    pub fn new(head: Arc<Head>, part: Part) -> Self {
        let mut simulation = Simulation::new(head);
        simulation.set_time(-PRE_ROLL_TICKS);
        let mut performance = Self {
            simulation,
            part,
            before: KeyFrame::default(),
            after: KeyFrame::default(),
        };
        while performance.simulation.time() < 0 {
            performance.step();
        }
        performance.simulation.save(&mut performance.before);
        performance.simulation.save(&mut performance.after);
        performance
    }

    fn step(&mut self) {
        // What is to be reached by the end of the step.
        let time = self.simulation.time() + STEP_TICKS;
        self.part.advance(time);
        let controls = self.part.controls_at(time);
        self.simulation.step(&controls);
    }

    /// Sets `out` to tick `ticks`, which must not be before the one asked for last.
    pub fn at(&mut self, ticks: i64, out: &mut Instant) {
        while self.after.time < ticks {
            // Only the two steps around an instant are worth copying out.
            while self.simulation.time() + STEP_TICKS < ticks {
                self.step();
            }
            if self.simulation.time() > self.after.time {
                self.simulation.save(&mut self.before);
            } else {
                std::mem::swap(&mut self.before, &mut self.after);
            }
            self.step();
            self.simulation.save(&mut self.after);
        }
        out.controls = self.part.controls_at(ticks);
        out.frame.set_between(&self.before, &self.after, ticks);
    }
}

/// Instants as they come from the simulation thread.
pub struct Instants {
    ready: Receiver<Instant>,
    used: Sender<Instant>,
    thread: Option<JoinHandle<()>>,
}

impl Instants {
    /// Starts the simulation thread on `part` at each of `times`, which must ascend.
    pub fn start(
        head: Arc<Head>,
        part: Part,
        times: impl Iterator<Item = i64> + Send + 'static,
    ) -> anyhow::Result<Self> {
        let (send, ready) = bounded(QUEUE);
        // Buffers come back for another turn; as many as can be under way.
        let (used, reuse) = bounded(QUEUE + 2);
        let run = move || {
            let mut performance = Performance::new(head, part);
            for time in times {
                let mut instant = reuse.try_recv().unwrap_or_default();
                performance.at(time, &mut instant);
                if send.send(instant).is_err() {
                    return; // nobody wants the rest
                }
            }
        };
        let thread = std::thread::Builder::new()
            .name("simulation".into())
            .spawn(run)
            .context("no thread for the simulation")?;
        Ok(Self {
            ready,
            used,
            thread: Some(thread),
        })
    }

    /// The next instant, none behind the last.
    pub fn next(&self) -> Option<Instant> {
        self.ready.recv().ok()
    }

    /// Gives an instant's buffers back.
    pub fn recycle(&self, instant: Instant) {
        // When there are enough already, this one goes.
        let _ = self.used.try_send(instant);
    }

    /// Gives each instant with its number to `take`, until that wants no more.
    pub fn each(
        self,
        mut take: impl FnMut(u64, &Instant) -> anyhow::Result<bool>,
    ) -> anyhow::Result<()> {
        let mut k = 0;
        while let Some(instant) = self.next() {
            interrupt::check()?;
            let wanted = take(k, &instant)?;
            self.recycle(instant);
            if !wanted {
                return Ok(());
            }
            k += 1;
        }
        self.finish()
    }

    /// Waits for the thread; an error when it died instead of finishing.
    pub fn finish(mut self) -> anyhow::Result<()> {
        let died = self
            .thread
            .take()
            .is_some_and(|thread| thread.join().is_err());
        anyhow::ensure!(
            !died,
            "the simulation broke down; the lines above say where"
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mouthpiece_phonemes::Phone;

    fn part(cast: &Cast) -> Part {
        let segments = [
            Segment::new(Phone::HSharp, 0, 24_000),
            Segment::new(Phone::Aa, 24_000, 33_600),
            Segment::new(Phone::HSharp, 33_600, 38_400),
        ];
        Part::new(cast, &segments, Some(3))
    }

    /// Frames at any rate are samples of one motion: asking more often changes nothing.
    #[test]
    fn an_instant_does_not_depend_on_those_asked_for_before_it() {
        let cast = Cast::load(&CastArgs::default()).unwrap();
        let mut often = Performance::new(Arc::clone(&cast.head), part(&cast));
        let mut once = Performance::new(Arc::clone(&cast.head), part(&cast));
        let (mut a, mut b) = (Instant::default(), Instant::default());
        for ticks in [0, 7, 80, 81, 1601, 3200, 3203, 29_999] {
            often.at(ticks, &mut a);
        }
        once.at(29_999, &mut b);
        assert_eq!(a.frame.time, 29_999);
        assert_eq!(a.frame, b.frame);
    }

    #[test]
    fn the_thread_gives_what_the_performance_gives_and_the_head_is_settled_at_first() {
        let cast = Cast::load(&CastArgs::default()).unwrap();
        let times = || (0..20).map(|k| k * 1601);
        let mut performance = Performance::new(Arc::clone(&cast.head), part(&cast));
        let instants = Instants::start(Arc::clone(&cast.head), part(&cast), times()).unwrap();
        let mut expected = Instant::default();
        for time in times() {
            let got = instants.next().unwrap();
            performance.at(time, &mut expected);
            assert_eq!(got.frame, expected.frame);
            if time == 0 {
                let fastest = got
                    .frame
                    .velocity
                    .iter()
                    .map(|v| v.length())
                    .fold(0.0, f32::max);
                assert!(fastest < 20.0, "{fastest} mm/s at the start");
            }
            instants.recycle(got);
        }
        assert!(instants.next().is_none());
        instants.finish().unwrap();
    }
}
