//! `mouthpiece doctor`: what this machine has, and what to install, in words.

use std::fmt::Write as _;
use std::process::{Command, Stdio};

use cpal::traits::{DeviceTrait as _, HostTrait as _};
use mouthpiece_render::Gpu;

use crate::cli::{DoctorArgs, StageArgs};
use crate::live;
use crate::media::output;
use crate::voices;

/// Looks around, or judges sound against picture.
pub fn run(args: &DoctorArgs) -> anyhow::Result<()> {
    if !args.sync {
        return look_around();
    }
    let stage = StageArgs {
        audio_device: args.audio_device.clone(),
        av_offset: args.av_offset,
        size: args.size,
        ..StageArgs::default()
    };
    output::print(&live::doctor_sync(&stage, args.seconds)?)
}

/// Only a missing graphics driver stops the product; all else has a way round.
fn look_around() -> anyhow::Result<()> {
    let mut text = String::new();
    let can_draw = graphics(&mut text);
    sound(&mut text);
    display(&mut text);
    video(&mut text);
    speech(&mut text);
    output::print(&text)?;
    anyhow::ensure!(
        can_draw,
        "nothing can be drawn here; install the graphics driver named above"
    );
    Ok(())
}

fn line(text: &mut String, what: &str, found: std::fmt::Arguments<'_>) {
    let _ = writeln!(text, "{what:<9} {found}");
}

fn graphics(text: &mut String) -> bool {
    match Gpu::headless() {
        Ok(gpu) => {
            let info = gpu.info();
            let driver = format!("{} {}", info.driver, info.driver_info);
            line(
                text,
                "graphics",
                format_args!("{} ({}, {})", info.name, info.backend, driver.trim()),
            );
            if gpu.is_software() {
                line(
                    text,
                    "",
                    format_args!(
                        "draws on the processor: fine for export, slow for a large window; install the \
                     driver of the graphics card if there is one (Debian: mesa-vulkan-drivers)"
                    ),
                );
            }
            true
        }
        Err(error) => {
            line(text, "graphics", format_args!("none: {error}"));
            false
        }
    }
}

fn sound(text: &mut String) {
    let mut names = Vec::new();
    for id in cpal::available_hosts() {
        let devices = cpal::host_from_id(id)
            .ok()
            .and_then(|host| host.output_devices().ok());
        let ids = devices
            .into_iter()
            .flatten()
            .filter_map(|device| device.id().ok());
        names.extend(ids.map(|id| id.to_string()));
    }
    let chosen = cpal::default_host()
        .default_output_device()
        .and_then(|device| device.id().ok());
    match chosen {
        Some(id) => line(
            text,
            "sound",
            format_args!("{id} unless --audio-device names another"),
        ),
        None => line(
            text,
            "sound",
            format_args!(
                "no device: a live face runs on a steady clock, silently; export is not concerned \
             (Debian: install pipewire-alsa or pulseaudio, or plug a sound card in)"
            ),
        ),
    }
    for name in names {
        line(text, "", format_args!("{name}"));
    }
}

fn display(text: &mut String) {
    let found = ["WAYLAND_DISPLAY", "DISPLAY"].into_iter().find_map(|name| {
        let value = std::env::var(name).ok().filter(|value| !value.is_empty())?;
        Some(format!("{name}={value}"))
    });
    let native = cfg!(any(windows, target_os = "macos"));
    match found {
        Some(found) => {
            line(text, "display", format_args!("{found}"));
            match live::screens() {
                Ok(screens) => screens
                    .iter()
                    .for_each(|screen| line(text, "", format_args!("screen {screen}"))),
                Err(error) => line(text, "", format_args!("{error:#}")),
            }
        }
        None if native => line(text, "display", format_args!("the desktop's")),
        None => line(
            text,
            "display",
            format_args!(
                "none (neither WAYLAND_DISPLAY nor DISPLAY is set): start from a desktop session to see \
             a window; export and still need none"
            ),
        ),
    }
}

fn video(text: &mut String) {
    line(
        text,
        "video",
        format_args!("H.264 and Opus in MP4, built in"),
    );
    let ffmpeg = Command::new("ffmpeg")
        .arg("-version")
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()
        .filter(|out| out.status.success())
        .and_then(|out| String::from_utf8(out.stdout).ok())
        .and_then(|out| out.lines().next().map(str::to_owned));
    match ffmpeg {
        Some(version) => line(
            text,
            "",
            format_args!("{version}, for .webm, cameras and --via-ffmpeg"),
        ),
        None => line(
            text,
            "",
            format_args!(
                "no ffmpeg: install it for .webm, cameras and --via-ffmpeg; nothing else needs it"
            ),
        ),
    }
}

fn speech(text: &mut String) {
    line(
        text,
        "speech",
        format_args!("labels and sound of any engine; for --text these are looked for:"),
    );
    for engine in voices::found() {
        match engine.what {
            Some(what) => line(text, "", format_args!("{}: {what}", engine.name)),
            None => line(
                text,
                "",
                format_args!("no {}: install it {}", engine.name, engine.install),
            ),
        }
    }
}
