//! Draws the reference head from all sides and with its mouth open, and measures what a picture
//! costs: `cargo run --release -p mouthpiece-render --example sheet -- OUT_FOLDER [WxH] [TIER]`.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use mouthpiece_render::{Background, Camera, Gpu, Offscreen, Tier, View};
use mouthpiece_rig::{Articulation, Control, Head, KeyFrame, STEP_TICKS, Simulation, TICK_RATE};

/// Pictures of the sheet: name, where from, jaw (rad) and lip aperture (mm), width, protrusion (mm), lids, gaze and turn.
const POSES: &[(&str, Camera, [f32; 4], [f32; 3])] = &[
    (
        "front",
        Camera::Front,
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0],
    ),
    ("side", Camera::Side, [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0]),
    (
        "34",
        Camera::ThreeQuarter,
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0],
    ),
    ("ah", Camera::Front, [0.20, 12.0, 1.0, 0.0], [0.0, 0.0, 0.0]),
    (
        "ee",
        Camera::Front,
        [0.06, 5.0, 1.10, 0.0],
        [0.3, 0.15, 0.15],
    ),
    (
        "oo",
        Camera::ThreeQuarter,
        [0.06, 4.0, 0.85, 4.0],
        [0.6, -0.2, -0.3],
    ),
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let folder = args.next().unwrap_or_else(|| "target/sheet".into());
    let size = args.next().unwrap_or_else(|| "640x480".into());
    let tier: Tier = args.next().unwrap_or_else(|| "medium".into()).parse()?;
    let (width, height) = size.split_once('x').ok_or("give the size as WxH")?;
    let size: (u32, u32) = (width.parse()?, height.parse()?);
    std::fs::create_dir_all(&folder)?;
    let head = Arc::new(Head::reference()?);

    let started = Instant::now();
    let gpu = Gpu::headless()?;
    println!("{} ({:?})", gpu.info().name, gpu.info().device_type);
    println!(
        "adapter open after {:.0} ms",
        started.elapsed().as_secs_f64() * 1e3
    );
    let mut offscreen = Offscreen::new(&gpu, &head, size, tier)?;
    for (name, camera, mouth, rest) in POSES {
        let view = View {
            camera: *camera,
            ..View::default()
        };
        save(
            &folder,
            name,
            size,
            offscreen.render(&posed(&head, *mouth, *rest)?, &view)?,
        )?;
    }
    let flash = View {
        background: Background::Plain([200, 205, 210]),
        flash: true,
        ..View::default()
    };
    save(
        &folder,
        "flash",
        size,
        offscreen.render(&head.rest_frame(), &flash)?,
    )?;
    drop(offscreen);

    println!(
        "| tier | {} x {} | ready ms | first ms | median ms | batch ms |",
        size.0, size.1
    );
    let open = posed(&head, POSES[3].2, POSES[3].3)?;
    for tier in Tier::ALL {
        measure(&gpu, &head, &open, size, tier)?;
    }
    Ok(())
}

/// The head after half a second of holding a posture.
fn posed(head: &Arc<Head>, mouth: [f32; 4], rest: [f32; 3]) -> Result<KeyFrame, Box<dyn Error>> {
    let [jaw_rad, aperture_mm, width, protrusion_mm] = mouth;
    let articulation = Articulation {
        jaw_rad,
        aperture_mm,
        width,
        protrusion_mm,
        ..Articulation::REST
    };
    let mut controls = head.calibration.controls(&articulation);
    controls[Control::LidL] = rest[0];
    controls[Control::LidR] = rest[0];
    controls[Control::GazeYaw] = rest[1];
    controls[Control::HeadYaw] = rest[2];
    let mut simulation = Simulation::new(Arc::clone(head));
    for _ in 0..TICK_RATE / 2 / STEP_TICKS {
        simulation.step(&controls);
    }
    let mut frame = KeyFrame::default();
    simulation.save(&mut frame);
    Ok(frame)
}

fn measure(
    gpu: &Gpu,
    head: &Head,
    frame: &KeyFrame,
    size: (u32, u32),
    tier: Tier,
) -> Result<(), Box<dyn Error>> {
    let started = Instant::now();
    let mut offscreen = Offscreen::new(gpu, head, size, tier)?;
    let ready = started.elapsed();
    let view = View::default();
    offscreen.render(frame, &view)?;
    let first = started.elapsed();
    let mut times: Vec<f64> = Vec::new();
    for _ in 0..40 {
        let from = Instant::now();
        offscreen.render(frame, &view)?;
        times.push(from.elapsed().as_secs_f64() * 1e3);
    }
    times.sort_by(f64::total_cmp);
    // A batch: the next picture is submitted before the last is taken.
    let from = Instant::now();
    offscreen.submit(frame, &view)?;
    for _ in 0..40 {
        offscreen.submit(frame, &view)?;
        offscreen.take()?;
    }
    offscreen.take()?;
    let batch = from.elapsed().as_secs_f64() * 1e3 / 41.0;
    println!(
        "| {} | | {:.0} | {:.0} | {:.1} | {batch:.1} |",
        tier.name(),
        ready.as_secs_f64() * 1e3,
        first.as_secs_f64() * 1e3,
        times[times.len() / 2]
    );
    Ok(())
}

fn save(folder: &str, name: &str, size: (u32, u32), pixels: &[u8]) -> Result<(), Box<dyn Error>> {
    let file = File::create(Path::new(folder).join(format!("{name}.png")))?;
    let mut png = png::Encoder::new(BufWriter::new(file), size.0, size.1);
    png.set_color(png::ColorType::Rgba);
    png.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    png.write_header()?.write_image_data(pixels)?;
    Ok(())
}
