//! Draws the reference head from all sides and with its mouth open, and measures what a picture
//! costs: `cargo run --release -p mouthpiece-render --example sheet -- OUT_FOLDER [WxH]`.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::time::Instant;

use mouthpiece_render::{Background, Camera, Gpu, Offscreen, Tier, View};
use mouthpiece_rig::{Head, KeyFrame};

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let folder = args.next().unwrap_or_else(|| "target/sheet".into());
    let size = args.next().unwrap_or_else(|| "640x480".into());
    let (width, height) = size.split_once('x').ok_or("give the size as WxH")?;
    let size: (u32, u32) = (width.parse()?, height.parse()?);
    std::fs::create_dir_all(&folder)?;
    let head = Head::reference()?;
    let rest = head.rest_frame();

    let started = Instant::now();
    let gpu = Gpu::headless()?;
    println!("{} ({:?})", gpu.info().name, gpu.info().device_type);
    println!("adapter open after {:.0} ms", started.elapsed().as_secs_f64() * 1e3);
    println!("| tier | {} x {} | ready ms | first ms | median ms | batch ms |", size.0, size.1);
    for tier in Tier::ALL {
        measure(&gpu, &head, &rest, size, tier)?;
    }

    let mut offscreen = Offscreen::new(&gpu, &head, size, Tier::Medium)?;
    for (name, camera) in [("front", Camera::Front), ("side", Camera::Side), ("34", Camera::ThreeQuarter)] {
        let view = View { camera, ..View::default() };
        save(&folder, name, size, offscreen.render(&rest, &view)?)?;
    }
    let plain = View { background: Background::Plain([200, 205, 210]), flash: true, ..View::default() };
    save(&folder, "flash", size, offscreen.render(&rest, &plain)?)?;
    Ok(())
}

fn measure(gpu: &Gpu, head: &Head, frame: &KeyFrame, size: (u32, u32), tier: Tier) -> Result<(), Box<dyn Error>> {
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
