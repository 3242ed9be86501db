//! The recipe for a kiosk under Wayland, run as it is installed: cage without a screen, a picture of what it shows.

use std::fs;
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};
use std::os::unix::net::UnixDatagram;
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use mouthpiece_tests::binary;
use mouthpiece_tests::picture::Picture;

/// Far longer than anything here takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);
/// Who is nobody, on Debian and elsewhere: cage refuses to run as root.
const NOBODY: u32 = 65_534;

/// A command for who runs the test, or for nobody where that is root.
fn as_user(as_root: bool, program: &str) -> Command {
    if !as_root {
        return Command::new(program);
    }
    let mut command = Command::new("setpriv");
    command
        .arg(format!("--reuid={NOBODY}"))
        .arg(format!("--regid={NOBODY}"))
        .args(["--clear-groups", "--no-new-privs", program]);
    command
}

/// Why this cannot be tried here, if it cannot.
fn obstacle(as_root: bool) -> Option<String> {
    for (tool, argument) in [("cage", "-h"), ("grim", "-h"), ("Xwayland", "-version")] {
        if let Err(why) = Command::new(tool).arg(argument).output() {
            assert!(std::env::var_os("CI").is_none(), "CI must have {tool}");
            return Some(format!("{tool} cannot be started ({why})"));
        }
    }
    let reached = as_user(as_root, "test")
        .arg("-x")
        .arg(binary::path())
        .status();
    match reached {
        Ok(status) if status.success() => None,
        _ => Some("cage does not run as root, and nobody else may run the program".to_owned()),
    }
}

/// A compositor with what runs in it, ended with the test.
struct Kiosk(Child);

impl Drop for Kiosk {
    fn drop(&mut self) {
        // The whole group, as a service manager ends it: the face outlives its compositor else.
        let _ = Command::new("sh")
            .args(["-c", r#"kill -s TERM -- "-$1""#, "sh"])
            .arg(self.0.id().to_string())
            .stderr(Stdio::null())
            .status();
        let _ = self.0.wait();
    }
}

/// Guards `kiosk-cage`: systemd hears of the first picture through the compositor, and the face fills its screen upright.
#[test]
fn the_recipe_for_cage_shows_a_face() {
    let folder = tempfile::tempdir().unwrap();
    let as_root = folder.path().metadata().unwrap().uid() == 0;
    if let Some(why) = obstacle(as_root) {
        println!("skipped: {why}");
        return;
    }
    if !crate::graphics::are_there_for("the recipe for cage") {
        return;
    }
    let recipe = binary::root().join("daemon/kiosk/kiosk-cage");
    let at = |name: &str| folder.path().join(name);
    // The test's own words may lie where nobody looks.
    fs::copy(recipe, at("kiosk-cage")).unwrap();
    let config = "[window]\nfullscreen = true\nburn_in_shift_px = 0\n[look]\ntier = \"low\"\n\
                  background = \"gradient:#a03040,#203040\"\n[sound]\ndevice = \"none\"\n\
                  [health]\nhttp = \"none\"\n";
    fs::write(at("kiosk.toml"), config).unwrap();
    let manager = UnixDatagram::bind(at("notify")).unwrap();
    manager.set_read_timeout(Some(PATIENCE)).unwrap();
    if as_root {
        for path in [folder.path(), &at("notify")] {
            std::os::unix::fs::chown(path, Some(NOBODY), Some(NOBODY)).unwrap();
        }
    }
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o700)).unwrap();
    let bin = binary::path();
    let path = std::env::var("PATH").unwrap_or_default();
    let kiosk = as_user(as_root, "sh")
        .arg(at("kiosk-cage"))
        .arg(at("kiosk.toml"))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("DBUS_SESSION_BUS_ADDRESS")
        .env(
            "PATH",
            format!("{}:{path}", bin.parent().unwrap().display()),
        )
        .env("HOME", folder.path())
        .env("XDG_RUNTIME_DIR", folder.path())
        .env("NOTIFY_SOCKET", at("notify"))
        .env("WLR_BACKENDS", "headless")
        .env("WLR_RENDERER", "pixman")
        .env("WLR_LIBINPUT_NO_DEVICES", "1")
        .process_group(0)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(fs::File::create(at("log")).unwrap())
        .spawn()
        .unwrap();
    let kiosk = Kiosk(kiosk);
    let log = || fs::read_to_string(at("log")).unwrap();
    let mut bytes = [0; 4096];
    let n = manager.recv(&mut bytes);
    let n = n.unwrap_or_else(|why| panic!("no picture ({why}): {}", log()));
    let told = String::from_utf8_lossy(&bytes[..n]).into_owned();
    assert!(told.contains("READY=1"), "{told}");

    // The picture is the compositor's now, but it may not have shown it yet.
    let begun = Instant::now();
    let shown = loop {
        let shown = shot(as_root, folder.path(), &log);
        if near(pixel(&shown, 2, 1), [160, 48, 64]) {
            break shown;
        }
        assert!(begun.elapsed() < PATIENCE, "no face: {}", log());
    };
    let (width, height) = (shown.width as usize, shown.height as usize);
    let corner = pixel(&shown, width - 3, 1);
    assert!(near(corner, [160, 48, 64]), "{corner:?}");
    // What stands in the middle of the foot is cloth, far above it is skin: the face is upright.
    let [red, _, blue] = pixel(&shown, width / 2, height * 2 / 3);
    assert!(red > blue.saturating_add(20), "no skin: {red} {blue}");
    let foot = pixel(&shown, width / 2, height - 3);
    assert!(!near(foot, [32, 48, 64]), "{foot:?}");
    drop(kiosk);
}

fn pixel(picture: &Picture, x: usize, y: usize) -> [u8; 3] {
    let at = 3 * (y * picture.width as usize + x);
    [0, 1, 2].map(|n| picture.rgb[at + n])
}

fn near(a: [u8; 3], b: [u8; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 4)
}

/// What the compositor shows.
fn shot(as_root: bool, folder: &Path, log: &dyn Fn() -> String) -> Picture {
    let display = fs::read_dir(folder).unwrap().find_map(|entry| {
        let name = entry.unwrap().file_name().into_string().unwrap();
        (name.starts_with("wayland-") && !name.contains('.')).then_some(name)
    });
    let file = folder.join("shot.png");
    let grim = as_user(as_root, "grim")
        .arg(&file)
        .env("XDG_RUNTIME_DIR", folder)
        .env("WAYLAND_DISPLAY", display.unwrap_or_default())
        .stdin(Stdio::null())
        .output()
        .unwrap();
    assert!(grim.status.success(), "{grim:?} {}", log());
    Picture::read(&file)
}
