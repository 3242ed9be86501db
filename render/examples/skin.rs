//! Pictures that show the skin: the reference head in the poses whose wrinkles differ most.
//! `cargo run --release -p mouthpiece-render --example skin -- FOLDER [WxH] [TIER] [physical|blinn-phong] [NAME …]`
//! draws them (all, or those named); `… skin -- --join BEFORE_FOLDER AFTER_FOLDER OUT.png NAME …` lays the named
//! ones side by side, before above after: docs/skin.png.

use std::error::Error;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;
use std::sync::Arc;

use mouthpiece_render::{Background, Camera, Gpu, Offscreen, SkinModel, Tier, View};
use mouthpiece_rig::{Control, Controls, Head, KeyFrame, STEP_TICKS, Simulation, TICK_RATE};

/// Name, where from, and what contracts.
type Pose = (&'static str, Camera, &'static [(&'static str, f32)]);

const POSES: &[Pose] = &[
    ("front", Camera::Front, &[]),
    ("34", Camera::ThreeQuarter, &[]),
    ("side", Camera::Side, &[]),
    (
        "brow",
        Camera::Front,
        &[("frontalis_inner", 1.0), ("frontalis_outer", 1.0)],
    ),
    (
        "one_brow",
        Camera::Front,
        &[("frontalis_outer", 0.5), ("frontalis_outer_side", 0.5)],
    ),
    (
        "frown",
        Camera::Front,
        &[
            ("corrugator_supercilii", 1.0),
            ("procerus", 0.6),
            ("depressor_supercilii", 0.6),
        ],
    ),
    (
        "smile",
        Camera::ThreeQuarter,
        &[
            ("zygomaticus_major", 0.9),
            ("orbicularis_oculi_orbital", 0.8),
        ],
    ),
    (
        "sneer",
        Camera::Front,
        &[
            ("levator_labii_superioris_alaeque_nasi", 1.0),
            ("nasalis", 0.8),
            ("mentalis", 1.0),
        ],
    ),
    (
        "purse",
        Camera::Front,
        &[
            ("orbicularis_oris_superior", 0.9),
            ("orbicularis_oris_inferior", 0.9),
        ],
    ),
];

/// RGBA rows from the top.
struct Picture {
    size: (usize, usize),
    pixels: Vec<u8>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let arg = |i: usize, otherwise: &'static str| args.get(i).map_or(otherwise, String::as_str);
    if arg(0, "") == "--join" {
        let [_, before, after, out, names @ ..] = args.as_slice() else {
            return Err("give two folders, the file to write and the names of the pictures".into());
        };
        return join(Path::new(before), Path::new(after), Path::new(out), names);
    }
    let folder = Path::new(arg(0, "target/skin"));
    let (width, height) = arg(1, "640x640")
        .split_once('x')
        .ok_or("give the size as WxH")?;
    let size: (u32, u32) = (width.parse()?, height.parse()?);
    let tier: Tier = arg(2, "high").parse()?;
    let skin: SkinModel = arg(3, "physical").parse()?;
    let named = args.get(4..).unwrap_or_default();
    std::fs::create_dir_all(folder)?;
    let head = Arc::new(Head::reference()?);
    let mut offscreen = Offscreen::new(&Gpu::headless()?, &head, size, tier)?;
    let wanted = |name: &str| named.is_empty() || named.iter().any(|n| n == name);
    for (name, camera, pulls) in POSES.iter().filter(|(name, ..)| wanted(name)) {
        let view = View {
            camera: *camera,
            // No grain of a wall: the files are smaller.
            background: Background::Plain([92, 98, 104]),
            skin,
            ..View::default()
        };
        let pixels = offscreen.render(&settled(&head, pulls)?, &view)?.to_vec();
        let size = (size.0 as usize, size.1 as usize);
        save(
            &folder.join(format!("{name}.png")),
            &Picture { size, pixels },
        )?;
    }
    Ok(())
}

/// The head after half a second of holding.
fn settled(head: &Arc<Head>, pulls: &[(&str, f32)]) -> Result<KeyFrame, Box<dyn Error>> {
    if pulls.is_empty() {
        return Ok(head.rest_frame());
    }
    let mut controls = Controls::default();
    for (name, value) in pulls {
        let control = Control::from_name(name).ok_or_else(|| format!("no control {name}"))?;
        controls[control] = *value;
    }
    let mut simulation = Simulation::new(Arc::clone(head));
    for _ in 0..TICK_RATE / 2 / STEP_TICKS {
        simulation.step(&controls);
    }
    let mut frame = KeyFrame::default();
    simulation.save(&mut frame);
    Ok(frame)
}

/// The middle of pictures of two folders above each other.
fn join(before: &Path, after: &Path, out: &Path, names: &[String]) -> Result<(), Box<dyn Error>> {
    let mut sheet = Picture {
        size: (0, 0),
        pixels: Vec::new(),
    };
    for (row, folder) in [before, after].into_iter().enumerate() {
        for (column, name) in names.iter().enumerate() {
            let part = load(&folder.join(format!("{name}.png")))?;
            // As much as a head takes up.
            let (left, top) = (part.size.0 / 5, part.size.1 / 8);
            let (width, height) = (part.size.0 * 3 / 5, part.size.1 * 3 / 4);
            if sheet.pixels.is_empty() {
                sheet.size = (width * names.len(), height * 2);
                sheet.pixels = vec![255; sheet.size.0 * sheet.size.1 * 4];
            }
            for y in 0..height {
                let from = ((top + y) * part.size.0 + left) * 4;
                let to = ((row * height + y) * sheet.size.0 + column * width) * 4;
                sheet.pixels[to..to + width * 4]
                    .copy_from_slice(&part.pixels[from..from + width * 4]);
            }
        }
    }
    save(out, &sheet)
}

fn load(path: &Path) -> Result<Picture, Box<dyn Error>> {
    let mut reader = png::Decoder::new(BufReader::new(File::open(path)?)).read_info()?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("too large a picture")?];
    let info = reader.next_frame(&mut pixels)?;
    if info.color_type != png::ColorType::Rgba {
        return Err(format!("{} is not RGBA", path.display()).into());
    }
    Ok(Picture {
        size: (info.width as usize, info.height as usize),
        pixels,
    })
}

fn save(path: &Path, picture: &Picture) -> Result<(), Box<dyn Error>> {
    let file = BufWriter::new(File::create(path)?);
    let mut png = png::Encoder::new(file, picture.size.0 as u32, picture.size.1 as u32);
    png.set_color(png::ColorType::Rgba);
    png.set_compression(png::Compression::High);
    png.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    png.write_header()?.write_image_data(&picture.pixels)?;
    Ok(())
}
