//! Shows the reference head in a window that is resized, shrunk to nothing and restored while it is
//! drawn, goes to another tier and loses its device, and prints what became of each picture: `cargo run --release -p mouthpiece-render --example window`.

use std::collections::BTreeMap;
use std::error::Error;
use std::sync::Arc;
use std::time::Duration;

use mouthpiece_render::{Outcome, Tier, View, WindowTarget};
use mouthpiece_rig::{Control, Head, KeyFrame};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowId};

/// Pictures to draw, and after how many the size changes.
const PICTURES: u32 = 240;
const PICTURES_A_SIZE: u32 = 20;
/// After how many it goes to another tier, and loses its device.
const TIER_AT: u32 = 60;
const LOST_AT: u32 = 150;
const SIZES: [(u32, u32); 5] = [(800, 600), (333, 77), (1, 1), (1280, 720), (400, 711)];

struct App {
    head: Arc<Head>,
    frame: KeyFrame,
    open: Option<(WindowTarget, Arc<Window>)>,
    drawn: u32,
    outcomes: BTreeMap<String, u32>,
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        match open(events, &self.head) {
            Ok(open) => self.open = Some(open),
            Err(error) => {
                eprintln!("{error}");
                events.exit();
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some((target, window)) = &mut self.open else {
            return;
        };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => target.resize((size.width, size.height)),
            WindowEvent::RedrawRequested => {
                self.drawn += 1;
                self.frame.state[Control::HeadYaw] = 0.4 * (self.drawn as f32 * 0.1).sin();
                if self.drawn.is_multiple_of(PICTURES_A_SIZE) {
                    let at = (self.drawn / PICTURES_A_SIZE) as usize;
                    let (width, height) = SIZES[at % SIZES.len()];
                    let _ = window.request_inner_size(PhysicalSize::new(width, height));
                    // What a minimised window reports on some systems.
                    if at % SIZES.len() == 2 {
                        target.resize((0, 0));
                    }
                }
                if self.drawn == TIER_AT {
                    target.prepare(&self.head, Tier::Medium);
                }
                if self.drawn == LOST_AT {
                    target.gpu().device().destroy();
                }
                window.pre_present_notify();
                let outcome = match target.draw(&self.frame, &View::default(), None) {
                    Ok(outcome) => {
                        if outcome == Outcome::Hidden {
                            // Nothing paces a loop whose pictures are not shown.
                            std::thread::sleep(Duration::from_millis(20));
                        }
                        format!("{outcome:?}")
                    }
                    Err(error) => {
                        let size = window.inner_size();
                        let (window, tier) = (Arc::clone(window), target.tier());
                        let again =
                            WindowTarget::new(window, (size.width, size.height), &self.head, tier);
                        match again {
                            Ok(again) => *target = again,
                            Err(error) => eprintln!("{error}"),
                        }
                        format!("error: {error}")
                    }
                };
                let outcome = format!("{outcome}, {}", target.tier().name());
                *self.outcomes.entry(outcome).or_default() += 1;
                if self.drawn >= PICTURES {
                    events.exit();
                } else {
                    window.request_redraw();
                }
            }
            _ => {}
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.open = None;
    }
}

fn open(
    events: &ActiveEventLoop,
    head: &Head,
) -> Result<(WindowTarget, Arc<Window>), Box<dyn Error>> {
    let window =
        Arc::new(events.create_window(Window::default_attributes().with_title("Mouthpiece"))?);
    let size = window.inner_size();
    let target = WindowTarget::new(
        Arc::clone(&window),
        (size.width, size.height),
        head,
        Tier::Low,
    )?;
    window.request_redraw();
    Ok((target, window))
}

fn main() -> Result<(), Box<dyn Error>> {
    let head = Arc::new(Head::reference()?);
    let mut app = App {
        frame: head.rest_frame(),
        head,
        open: None,
        drawn: 0,
        outcomes: BTreeMap::new(),
    };
    EventLoop::new()?.run_app(&mut app)?;
    println!("{:?}", app.outcomes);
    Ok(())
}
