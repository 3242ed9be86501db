//! Devices that show other programs what is written to them as if a camera saw it: v4l2loopback, on Linux.
//!
//! Which device is one is asked of sysfs: a real camera hangs on a bus, a loopback device on nothing.

use std::path::Path;

use anyhow::bail;

/// Whether a name is that of a video device.
pub fn is_named(target: &Path) -> bool {
    let text = target.to_str().unwrap_or_default();
    text.strip_prefix("/dev/video")
        .is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
}

/// Fails where `target` is not a device that pictures can be shown through.
pub fn check(target: &Path) -> anyhow::Result<()> {
    check_in(Path::new("/sys/class/video4linux"), target)
}

fn check_in(class: &Path, target: &Path) -> anyhow::Result<()> {
    let name = target.file_name().unwrap_or_default();
    let number = name.to_string_lossy().replace("video", "");
    if !target.exists() {
        bail!(
            "{} is not there; make it: modprobe v4l2loopback video_nr={number} exclusive_caps=1 (Debian: apt install \
             v4l2loopback-dkms)",
            target.display()
        );
    }
    // Devices without a bus lie under /sys/devices/virtual.
    let device = class.join(name).canonicalize();
    if !device.is_ok_and(|device| device.iter().any(|part| part == "virtual")) {
        bail!(
            "{} is no loopback device, so nothing can be shown through it; name one that v4l2loopback made",
            target.display()
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[cfg(unix)]
    #[test]
    fn a_camera_on_a_bus_is_no_loopback() {
        let dir = tempfile::tempdir().unwrap();
        let (class, dev) = (dir.path().join("class"), dir.path().join("dev"));
        for folder in [&class, &dev] {
            fs::create_dir(folder).unwrap();
        }
        for (name, place) in [
            ("video0", "pci0000/usb1/video0"),
            ("video9", "virtual/video4linux/video9"),
        ] {
            let device = dir.path().join("devices").join(place);
            fs::create_dir_all(&device).unwrap();
            std::os::unix::fs::symlink(&device, class.join(name)).unwrap();
            fs::write(dev.join(name), b"").unwrap();
        }
        let says = |name: &str| check_in(&class, &dev.join(name)).map_err(|e| e.to_string());
        assert_eq!(says("video9"), Ok(()));
        assert!(says("video0").unwrap_err().contains("no loopback"));
        assert!(says("video7").unwrap_err().contains("video_nr=7"));
    }

    #[test]
    fn only_video_devices_are_named_as_such() {
        for (name, wanted) in [
            ("/dev/video0", true),
            ("/dev/video", false),
            ("/dev/videox", false),
            ("video0", false),
        ] {
            assert_eq!(is_named(Path::new(name)), wanted, "{name}");
        }
    }
}
