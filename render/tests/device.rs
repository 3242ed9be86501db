//! What the renderer asks of a device: no more than WebGPU's downlevel limits, nothing that its validation has to
//! complain of, and a way round what is not offered. Needs a graphics adapter and says so where there is none.

#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on has failed, and says where"
)]

use std::sync::{Arc, Mutex};

use log::{Level, LevelFilter, Metadata, Record};
use mouthpiece_render::{Background, Gpu, Offscreen, Picture, Shown, SkinModel, Tier, View};
use mouthpiece_rig::{Anatomy, Control, Head, undressed};

/// What wgpu, naga and the drivers behind them complain of.
struct Complaints(Mutex<Vec<String>>);

impl log::Log for Complaints {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.level() <= Level::Warn
    }
    fn log(&self, record: &Record<'_>) {
        let line = format!("{} {}: {}", record.level(), record.target(), record.args());
        if self.enabled(record.metadata()) {
            self.0.lock().unwrap().push(line);
        }
    }
    fn flush(&self) {}
}

static COMPLAINTS: Complaints = Complaints(Mutex::new(Vec::new()));

/// One test, since the log is the process's: everything that can be drawn is drawn.
#[test]
fn validation_has_nothing_to_say_of_anything_that_is_drawn() {
    log::set_logger(&COMPLAINTS).unwrap();
    log::set_max_level(LevelFilter::Warn);
    let gpu = match Gpu::headless() {
        Ok(gpu) => gpu,
        Err(error) => return println!("skipped: {error}"),
    };
    let head = Head::reference().unwrap();
    let mut open = head.rest_frame();
    open.state[Control::Jaw] = 0.2;
    for column in &head.lips.lower {
        column.iter().for_each(|v| open.skin[*v as usize].y -= 8.0);
    }
    let picture = Picture::from_rgba(3, 2, vec![[9, 8, 7, 200]; 6]).unwrap();
    let views = [
        View::default(),
        View {
            background: Background::Picture(Arc::new(picture)),
            flash: true,
            ..View::default()
        },
        View {
            background: Background::Transparent,
            skin: SkinModel::BlinnPhong,
            ..View::default()
        },
        View {
            shown: Shown::Yardstick,
            ..View::default()
        },
    ];
    for tier in Tier::ALL {
        let mut offscreen = Offscreen::new(&gpu, &head, (64, 48), tier).unwrap();
        for frame in [&head.rest_frame(), &open] {
            for view in &views {
                offscreen.render(frame, view).unwrap();
            }
        }
    }
    for what in [Anatomy::Muscles, Anatomy::Springs] {
        let plate = Head {
            parts: undressed(&head, &open, what),
            ..head.clone()
        };
        let view = View {
            shown: Shown::Anatomy,
            ..View::default()
        };
        let mut offscreen = Offscreen::new(&gpu, &plate, (64, 48), Tier::Medium).unwrap();
        offscreen.render(&open, &view).unwrap();
    }
    let complaints = COMPLAINTS.0.lock().unwrap();
    assert!(complaints.is_empty(), "{complaints:#?}");
}

#[test]
fn no_more_is_asked_for_than_the_downlevel_limits_but_the_size_of_pictures() {
    let Ok(gpu) = Gpu::headless() else { return };
    let asked = gpu.device().limits();
    let least = wgpu::Limits::downlevel_defaults().using_resolution(asked.clone());
    assert_eq!(asked, least);
    assert!(
        gpu.device().features().is_empty(),
        "{:?}",
        gpu.device().features()
    );
}

#[test]
fn samples_that_are_not_offered_become_one() {
    let Ok(gpu) = Gpu::headless() else { return };
    let format = wgpu::TextureFormat::Rgba8Unorm;
    assert_eq!(gpu.samples(format, 4), 4, "WebGPU promises four");
    assert_eq!(gpu.samples(format, 64), 1);
    assert_eq!(gpu.samples(format, 0), 1);
}
