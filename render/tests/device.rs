//! What the renderer asks of a device: no more than WebGPU's downlevel limits, nothing that its validation has to
//! complain of, and a way round what is not offered. Needs a graphics adapter and says so where there is none.

#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on has failed, and says where"
)]

use std::sync::{Arc, Mutex};

use log::{Level, LevelFilter, Metadata, Record};
use mouthpiece_render::{
    Background, Gpu, Offscreen, Picture, Renderer, Shown, SkinModel, Tier, View,
};
use mouthpiece_rig::{Anatomy, Control, Head, undressed};
use mouthpiece_tests::or_skipped;

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
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
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

/// Whether the card encodes sRGB or the shader does: the same picture. One sample a pixel, since a card that encodes also
/// averages in linear light.
#[test]
fn a_target_that_encodes_srgb_shows_the_same_picture() {
    let Ok(gpu) = Gpu::headless() else { return };
    let head = Head::reference().unwrap();
    let size = (64, 64);
    let frame = head.rest_frame();
    let mut plain = Offscreen::new(&gpu, &head, size, Tier::Low).unwrap();
    let plain = plain.render(&frame, &View::default()).unwrap();

    let format = wgpu::TextureFormat::Rgba8UnormSrgb;
    let mut renderer = Renderer::new(&gpu, &head, format, Tier::Low).unwrap();
    let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: size.0,
            height: size.1,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let target = texture.create_view(&wgpu::TextureViewDescriptor::default());
    renderer
        .draw(&gpu, &frame, &View::default(), &target, size)
        .unwrap();
    let rows = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(size.0 * size.1 * 4),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu
        .device()
        .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &rows,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(size.0 * 4),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    encoder.map_buffer_on_submit(&rows, wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
    gpu.queue().submit([encoder.finish()]);
    gpu.device()
        .poll(wgpu::PollType::wait_indefinitely())
        .unwrap();
    let encoded = rows.get_mapped_range(..).unwrap();
    let apart: Vec<u8> = plain
        .iter()
        .zip(encoded.iter())
        .map(|(a, b)| a.abs_diff(*b))
        .collect();
    // Only lashes are blended, and those the target blends in its own way.
    let beyond_rounding = apart.iter().filter(|d| **d > 1).count();
    assert!(
        beyond_rounding < apart.len() / 100,
        "{beyond_rounding} values differ by more than rounding"
    );
    let most = apart.iter().max().unwrap();
    assert!(*most <= 6, "a lash differs by {most}");
}
