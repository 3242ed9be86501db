//! The main thread: a window that shows the head as it is when the picture can be seen.
//!
//! Wanted: each picture shows the instant that is heard in the middle of its time on the screen;
//! no processor is burnt while nothing new can be shown; whatever becomes of the surface or the
//! card, nothing panics and the rest of the process goes on.
//!
//! Pictures are paced by this thread's own timer, since presenting does not block everywhere. Time
//! is the audible clock's, taken once per picture, plus what drawing took lately, plus half the
//! time until the next picture.

use std::sync::Arc;

use anyhow::{Context as _, Result, anyhow, bail};
use mouthpiece_render::{Governor, Outcome, Overlay, Tier, WindowTarget};
use mouthpiece_rig::{Head, KeyFrame};
use tokio::sync::oneshot;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::keyboard::{Key, NamedKey};
use winit::monitor::MonitorHandle;
use winit::window::{Window, WindowId};

use super::motion::Motion;
use super::player::Sight;
use super::sync::Flash;
use super::time::{ns_from_ticks, ticks_from_ns};
use crate::config::CaptionStyle;

mod awake;
mod caption;
mod cursor;
mod look;
mod open;
mod pace;
mod screens;
mod wander;

use awake::Awake;
use caption::{Painter, Words};
use cursor::Cursor;
pub use look::Look;
use pace::Pace;
pub use screens::screens;

/// How long a covered window rests, and one whose card failed.
const HIDDEN_NS: i64 = 100_000_000;
const FAILED_NS: i64 = 1_000_000_000;
/// Failures in a row after which the window is given up.
const FAILURES_MAX: u32 = 5;

/// What other threads tell the event loop.
#[derive(Clone, Debug)]
pub enum Wake {
    /// The process is to end.
    Quit,
    /// From the next picture on it looks like this.
    Look(Box<Look>),
    /// The graphics device is to be lost, as a test of what comes then.
    LoseDevice,
}

/// A connection to the display.
pub struct Display(EventLoop<Wake>);

impl Display {
    /// Connects; an error where there is no display. Main thread only.
    pub fn open() -> Result<Self> {
        let named = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"]
            .into_iter()
            .find_map(|name| std::env::var(name).ok().filter(|v| !v.is_empty()));
        if cfg!(target_os = "linux") && named.is_none() {
            bail!("there is no display (neither WAYLAND_DISPLAY nor DISPLAY is set)");
        }
        let events = EventLoop::with_user_event().build().map_err(|error| {
            tracing::debug!(%error, "no event loop");
            anyhow!("the display {} cannot be opened", named.unwrap_or_default())
        })?;
        Ok(Self(events))
    }

    /// Wakes the event loop from other threads.
    pub fn proxy(&self) -> EventLoopProxy<Wake> {
        self.0.create_proxy()
    }

    /// Shows `head` until the window is closed or [`Wake::Quit`] comes. `shown` learns of the first
    /// picture.
    pub fn show(
        self,
        head: Arc<Head>,
        sight: Sight,
        look: Look,
        flash: Option<Flash>,
        shown: Option<oneshot::Sender<()>>,
    ) -> Result<()> {
        let mut app = App {
            head,
            sight,
            look,
            flash,
            shown,
            frame: KeyFrame::default(),
            heard: 0,
            last_tick: i64::MIN,
            motion: Motion::default(),
            text: Arc::from(""),
            text_seen: 0,
            open: None,
            pace: Pace::default(),
            governor: Governor::default(),
            tier: None,
            failures: 0,
            error: None,
        };
        self.0
            .run_app(&mut app)
            .context("the connection to the display broke")?;
        app.pace.report();
        app.error.map_or(Ok(()), Err)
    }
}

struct App {
    head: Arc<Head>,
    sight: Sight,
    look: Look,
    flash: Option<Flash>,
    shown: Option<oneshot::Sender<()>>,
    frame: KeyFrame,
    /// What was heard when the last picture was begun, and what it shows.
    heard: i64,
    last_tick: i64,
    motion: Motion,
    /// The text that goes with what is heard, and its number.
    text: Arc<str>,
    text_seen: u64,
    open: Option<Open>,
    pace: Pace,
    governor: Governor,
    /// A tier that was asked for while it lived, and is not in the making yet.
    tier: Option<Tier>,
    failures: u32,
    error: Option<anyhow::Error>,
}

struct Open {
    // Dropped before the window.
    target: Option<WindowTarget>,
    /// Of that target, once there was something to write.
    painter: Option<Painter>,
    window: Arc<Window>,
    cursor: Cursor,
    awake: Option<Awake>,
}

impl ApplicationHandler<Wake> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        match self.open_window(events) {
            Ok(open) => {
                self.open = Some(open);
                self.pace.due_now(self.sight.origin.now_ns());
            }
            Err(error) => self.give_up(events, error),
        }
    }

    fn new_events(&mut self, _events: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, Some(open)) = (cause, &self.open) {
            open.window.request_redraw();
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, wake: Wake) {
        match wake {
            Wake::Quit => events.exit(),
            Wake::Look(look) => self.look(*look),
            Wake::LoseDevice => {
                if let Some(target) = self.open.as_ref().and_then(|o| o.target.as_ref()) {
                    target.gpu().device().destroy();
                }
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _id: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => events.exit(),
            WindowEvent::KeyboardInput { event, .. }
                if event.state == ElementState::Pressed
                    && event.logical_key == Key::Named(NamedKey::Escape) =>
            {
                events.exit();
            }
            WindowEvent::Resized(size) => {
                if let Some(target) = self.open.as_mut().and_then(|o| o.target.as_mut()) {
                    target.resize((size.width, size.height));
                }
            }
            WindowEvent::CursorMoved { .. } => {
                let now_ns = self.sight.origin.now_ns();
                if let Some(open) = &mut self.open
                    && let Some(visible) = open.cursor.moved(now_ns)
                {
                    open.window.set_cursor_visible(visible);
                }
            }
            WindowEvent::RedrawRequested => self.draw(events),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let due_ns = self.pace.due_ns();
        if self.open.is_none() {
            events.set_control_flow(ControlFlow::Wait);
            return;
        }
        let due = self.sight.origin.instant(due_ns);
        events.set_control_flow(ControlFlow::WaitUntil(due));
    }

    fn exiting(&mut self, _events: &ActiveEventLoop) {
        // The surface goes before the connection to the display does.
        self.open = None;
    }
}

impl App {
    fn open_window(&mut self, events: &ActiveEventLoop) -> Result<Open> {
        let wanted = &self.look.window;
        let monitor = open::monitor(events, &wanted.monitor);
        let refresh = monitor
            .as_ref()
            .and_then(MonitorHandle::refresh_rate_millihertz);
        if let Some(millihertz) = refresh {
            self.pace.set_refresh(millihertz);
        }
        let window = open::window(events, wanted, monitor.as_ref())?;
        let awake = (wanted.fullscreen && wanted.keep_awake)
            .then(Awake::new)
            .flatten();
        let target = self.target(&window)?;
        Ok(Open {
            target: Some(target),
            painter: None,
            cursor: Cursor::new(self.sight.origin.now_ns()),
            awake,
            window,
        })
    }

    /// Takes over what has changed in the configuration.
    fn look(&mut self, look: Look) {
        let look = look.keeping(&self.look);
        if look.tier != self.look.tier {
            self.tier = look.tier;
        }
        if let Some(open) = &mut self.open {
            let wanted = look.window.fullscreen && look.window.keep_awake;
            open.awake = match open.awake.take() {
                Some(awake) => wanted.then_some(awake),
                None => wanted.then(Awake::new).flatten(),
            };
        }
        self.look = look;
    }

    fn target(&mut self, window: &Arc<Window>) -> Result<WindowTarget> {
        let size = window.inner_size();
        let size = (size.width, size.height);
        let tier = self.look.tier.unwrap_or_else(|| self.governor.tier());
        let target = WindowTarget::new(Arc::clone(window), size, &self.head, tier)?;
        self.pace.set_software(target.gpu().is_software());
        Ok(target)
    }

    fn draw(&mut self, events: &ActiveEventLoop) {
        let now_ns = self.sight.origin.now_ns();
        if !self.pace.is_due(now_ns) {
            return; // asked for by the window system; the timer asks again
        }
        match self.picture(now_ns) {
            Ok(Outcome::Shown) => {
                self.failures = 0;
                self.shown(now_ns, self.sight.origin.now_ns());
                if let Some(shown) = self.shown.take() {
                    let _ = shown.send(()); // nobody waits any more
                }
            }
            Ok(Outcome::Retry) => self.pace.retry(now_ns),
            Ok(Outcome::Hidden) => self.pace.rest(now_ns, HIDDEN_NS),
            Err(error) => {
                self.failures += 1;
                self.sight.vitals.window.failures.add(1);
                if self.failures >= FAILURES_MAX {
                    return self.give_up(events, error);
                }
                tracing::warn!("{error:#}; the window is set up again");
                if let Some(open) = &mut self.open {
                    (open.target, open.painter) = (None, None);
                }
                self.pace.rest(now_ns, FAILED_NS);
            }
        }
    }

    /// A picture that was begun at `begun_ns` is on its way to the screen.
    fn shown(&mut self, begun_ns: i64, now_ns: i64) {
        let seen_ns = now_ns - begun_ns + self.pace.interval_ns() / 2;
        let skew_ns = seen_ns - ns_from_ticks(self.last_tick + self.look.delay - self.heard);
        self.pace.shown(begun_ns, now_ns);
        let moved = self.motion.differs(&self.frame);
        let vitals = &self.sight.vitals.window;
        vitals.shown(begun_ns, now_ns, moved, skew_ns);
        if let Some(target) = self.open.as_ref().and_then(|o| o.target.as_ref()) {
            vitals.set_tier(target.tier());
        }
    }

    /// Draws the picture that can be seen soonest.
    fn picture(&mut self, now_ns: i64) -> Result<Outcome> {
        self.heard = self.sight.clock.at(now_ns);
        let tick = self.heard + ticks_from_ns(self.pace.ahead_ns()) - self.look.delay;
        self.last_tick = self.last_tick.max(tick);
        if !self.sight.frames.sample(self.last_tick, &mut self.frame) {
            return Ok(Outcome::Retry); // the simulation has not begun
        }
        let mut view = self.look.view.clone();
        view.flash |= self
            .flash
            .as_ref()
            .is_some_and(|f| f.is_lit(self.last_tick));
        let wander = wander::at(now_ns, view.placing.wander_max_px);
        view.placing.wander_px = wander;
        let words = self.words(wander);
        let Some(open) = &self.open else {
            return Ok(Outcome::Hidden);
        };
        let window = Arc::clone(&open.window);
        let mut target = match self.open.as_mut().and_then(|o| o.target.take()) {
            Some(target) => target,
            None => self.target(&window)?,
        };
        if let Some(answer) = self.sight.shots.asked() {
            // Gone in between: nobody wants it.
            target.shoot(|shot| drop(answer.send(shot)));
        }
        let Some(open) = &mut self.open else {
            return Ok(Outcome::Hidden);
        };
        let mut over = words.map(|words| {
            let fresh = || Painter::new(target.gpu(), target.format());
            open.painter.get_or_insert_with(fresh).over(words)
        });
        let over = over.as_mut().map(|over| over as &mut dyn Overlay);
        window.pre_present_notify();
        let outcome = target.draw(&self.frame, &view, over)?;
        let idle_s = self.look.window.hide_cursor_after_s.get();
        if self.look.window.fullscreen
            && let Some(visible) = open.cursor.rest(now_ns, idle_s)
        {
            window.set_cursor_visible(visible);
        }
        if let Some(tier) = self.tier
            && !target.is_preparing()
        {
            target.prepare(&self.head, tier);
            self.tier = None;
        }
        if outcome == Outcome::Shown && self.look.tier.is_none() {
            self.govern(&mut target);
        }
        if let Some(open) = &mut self.open {
            open.target = Some(target);
        }
        Ok(outcome)
    }

    /// What is to be read in the picture.
    fn words(&mut self, wander: glam::Vec2) -> Option<Words> {
        if let Some(text) = self.sight.captions.latest(&mut self.text_seen) {
            self.text = text;
        }
        if self.look.captions.style == CaptionStyle::Off {
            return None;
        }
        let wander = wander.round().as_ivec2();
        Some(Words {
            text: (!self.text.is_empty()).then(|| Arc::clone(&self.text))?,
            captions: self.look.captions.clone(),
            quarters: self.look.view.placing.quarters,
            wander: (wander.x, wander.y),
        })
    }

    /// Goes to another tier where the picture just drawn says so.
    fn govern(&mut self, target: &mut WindowTarget) {
        if target.is_preparing() {
            return; // and that costs time, too: what pictures cost meanwhile says nothing
        }
        if self.governor.tier() != target.tier() {
            self.governor.failed(target.tier());
        }
        let cost_ns = target.cost_ns();
        if let Some(tier) = self.governor.picture(cost_ns, self.pace.budget_ns()) {
            let ms = cost_ns as f64 * 1e-6;
            tracing::info!(tier = tier.name(), ms, "another tier suits this machine");
            target.prepare(&self.head, tier);
        }
    }

    fn give_up(&mut self, events: &ActiveEventLoop, error: anyhow::Error) {
        self.error = Some(error);
        self.open = None;
        events.exit();
    }
}
