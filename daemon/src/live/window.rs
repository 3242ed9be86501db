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
use mouthpiece_render::{Governor, Tier, WindowTarget};
use mouthpiece_rig::{Head, KeyFrame};
use tokio::sync::oneshot;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

use super::motion::Motion;
use super::player::Sight;
use super::sync::Flash;

mod awake;
mod caption;
mod cursor;
mod drawing;
mod look;
mod open;
mod pace;
mod screens;
mod wander;

use awake::Awake;
use caption::Painter;
use cursor::Cursor;
pub use look::Look;
use pace::Pace;
pub use screens::screens;

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
            coming: None,
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
    /// A look that is being made ready.
    coming: Option<Look>,
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
            Wake::Look(look) => self.prepare(look.keeping(&self.look)),
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
