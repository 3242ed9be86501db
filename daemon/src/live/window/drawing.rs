//! One picture after the other: which instant, how it looks, what is written over it, and what becomes of a card that
//! fails. The thread's loop is in [`super`].

use std::sync::Arc;

use anyhow::Result;
use mouthpiece_render::{Background, Outcome, Overlay, WindowTarget};
use winit::event_loop::ActiveEventLoop;
use winit::monitor::MonitorHandle;
use winit::window::Window;

use super::awake::Awake;
use super::caption::{Painter, Words};
use super::cursor::Cursor;
use super::look::Look;
use super::{App, Open, open, wander};
use crate::config::CaptionStyle;
use crate::live::time::{ns_from_ticks, ticks_from_ns};

/// How long a covered window rests, and one whose card failed.
const HIDDEN_NS: i64 = 100_000_000;
const FAILED_NS: i64 = 1_000_000_000;
/// Failures in a row after which the window is given up.
const FAILURES_MAX: u32 = 5;

impl App {
    pub(super) fn open_window(&mut self, events: &ActiveEventLoop) -> Result<Open> {
        let wanted = &self.look.window;
        let monitor = open::monitor(events, &wanted.monitor);
        let refresh = monitor
            .as_ref()
            .and_then(MonitorHandle::refresh_rate_millihertz);
        if let Some(millihertz) = refresh {
            self.pace.set_refresh(millihertz);
        }
        let window = open::window(events, wanted, monitor.as_ref())?;
        let awake = (wanted.fullscreen && wanted.keep_awake).then(|| Awake::new(&window));
        let target = self.target(&window)?;
        Ok(Open {
            target: Some(target),
            painter: None,
            cursor: Cursor::new(self.sight.origin.now_ns()),
            awake,
            window,
        })
    }

    /// Makes ready for another look, beside drawing in this one.
    pub(super) fn prepare(&mut self, look: Look) {
        if let Background::Picture(picture) = &look.view.background
            && let Some(target) = self.open.as_mut().and_then(|o| o.target.as_mut())
        {
            target.hang(picture);
        }
        self.coming = Some(look);
    }

    /// Takes over the look that was made ready.
    fn take_over(&mut self) {
        let Some(look) = self.coming.take() else {
            return;
        };
        if look.tier != self.look.tier {
            self.tier = look.tier;
        }
        if let Some(open) = &mut self.open {
            let wanted = look.window.fullscreen && look.window.keep_awake;
            open.awake = match open.awake.take() {
                Some(awake) => wanted.then_some(awake),
                None => wanted.then(|| Awake::new(&open.window)),
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

    pub(super) fn draw(&mut self, events: &ActiveEventLoop) {
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
        if let Some(flash) = &mut self.flash {
            flash.shown(self.last_tick);
        }
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
        let target = self.open.as_mut().and_then(|o| o.target.as_mut());
        if !target.is_some_and(WindowTarget::is_hanging) {
            self.take_over();
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

    pub(super) fn give_up(&mut self, events: &ActiveEventLoop, error: anyhow::Error) {
        self.error = Some(error);
        self.open = None;
        events.exit();
    }
}
