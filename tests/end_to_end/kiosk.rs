//! A face that is on a screen all day: what systemd is told, what a changed configuration does, how it ends.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::os::unix::net::{UnixDatagram, UnixStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use mouthpiece_tests::binary;
use mouthpiece_tests::daemon::wait_for_words;
use mouthpiece_tests::display::Display;
use mouthpiece_tests::or_skipped;
use mouthpiece_tests::picture::Picture;
use serde_json::{Value, json};
use tempfile::TempDir;

/// Far longer than anything here takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);
/// The watchdog's period; four times in it there is news, while pictures come.
const WATCHDOG: Duration = Duration::from_secs(2);
/// An end takes less than a second; a busy machine may need a moment to see it.
const END: Duration = Duration::from_millis(1500);

/// A daemon with a configuration file, a socket, a service manager and a log, in a folder of its own.
struct Face {
    child: Child,
    folder: TempDir,
    manager: UnixDatagram,
}

impl Face {
    fn start(config: &str, display: Option<&Display>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let manager = UnixDatagram::bind(at("notify")).unwrap();
        fs::write(at("face.toml"), config).unwrap();
        let mut command = binary::command(&["run", "--config"]);
        command
            .arg(at("face.toml"))
            .args(["--audio-device", "none", "--http", "none"])
            .env("XDG_RUNTIME_DIR", folder.path())
            .env("NOTIFY_SOCKET", at("notify"))
            .env("WATCHDOG_USEC", WATCHDOG.as_micros().to_string())
            .stdout(Stdio::null())
            .stderr(fs::File::create(at("log")).unwrap());
        if let Some(display) = display {
            command.env("DISPLAY", &display.screen.name);
        }
        let child = command.spawn().unwrap();
        Self {
            child,
            folder,
            manager,
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn configure(&self, text: &str) {
        fs::write(self.path("face.toml"), text).unwrap();
    }

    fn log(&self) -> String {
        fs::read_to_string(self.path("log")).unwrap()
    }

    /// Waits until the log holds `words` so many times.
    #[track_caller]
    fn wait_for_log(&self, words: &str, times: usize) {
        wait_for_words(|| self.log(), words, times);
    }

    /// What the service manager is told next; none when it is told nothing for so long.
    fn told(&self, within: Duration) -> Option<String> {
        self.manager.set_read_timeout(Some(within)).unwrap();
        let mut bytes = [0; 4096];
        let n = self.manager.recv(&mut bytes).ok()?;
        Some(String::from_utf8_lossy(&bytes[..n]).into_owned())
    }

    /// What has been told already is of no interest any more.
    fn forget_told(&self) {
        while self.told(Duration::from_millis(1)).is_some() {}
    }

    fn call(&self, socket: &Path) -> Client {
        let begun = Instant::now();
        let stream = loop {
            match UnixStream::connect(socket) {
                Ok(stream) => break stream,
                Err(why) => assert!(begun.elapsed() < PATIENCE, "{why}: {}", self.log()),
            }
            std::thread::sleep(Duration::from_millis(20));
        };
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        Client {
            lines: BufReader::new(stream.try_clone().unwrap()),
            stream,
        }
    }

    /// Asks for the end and expects it: in time, orderly, without a socket left.
    fn end(mut self, socket: &Path) {
        let begun = Instant::now();
        binary::signal(self.child.id(), "TERM");
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(begun.elapsed() < PATIENCE, "{}", self.log());
            std::thread::sleep(Duration::from_millis(2));
        };
        let took = begun.elapsed();
        assert_eq!(status.code(), Some(0), "{}", self.log());
        assert!(took < END, "{took:?}: {}", self.log());
        assert!(!socket.exists(), "the socket stays");
    }
}

impl Drop for Face {
    fn drop(&mut self) {
        // A failed test leaves nothing running.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

struct Client {
    stream: UnixStream,
    lines: BufReader<UnixStream>,
}

impl Client {
    fn say(&mut self, message: &Value) {
        writeln!(self.stream, "{message}").unwrap();
    }

    /// A vowel of a minute and a half, of which the beginning is waited for.
    fn speak(&mut self) {
        self.say(&json!({"type": "begin", "id": "long"}));
        self.say(&json!({"type": "phones", "phones": [{"start": 0, "end": 90, "phone": "aa"}]}));
        self.say(&json!({"type": "end"}));
        assert_eq!(self.answer()["type"], "accepted");
        assert_eq!(self.answer()["type"], "started");
    }

    /// The next answer that is not about progress.
    fn answer(&mut self) -> Value {
        loop {
            let mut line = String::new();
            assert!(self.lines.read_line(&mut line).unwrap() > 0, "closed");
            let answer: Value = serde_json::from_str(&line).unwrap();
            if answer["type"] != "progress" {
                return answer;
            }
        }
    }
}

fn config(colour: &str, more: &str) -> String {
    format!(
        "[window]\nfullscreen = true\n[look]\ntier = \"low\"\nbackground = \"{colour}\"\n{more}"
    )
}

/// Guards a kiosk: systemd hears of pictures and of nothing else, the file is felt while the face speaks, a wrong
/// one is not, and the end is clean.
#[test]
fn a_kiosk_is_watched_over_reconfigured_and_ended() {
    let Some(display) = or_skipped(Display::start(320, 400)) else {
        return;
    };
    if !crate::graphics::are_there_for("a kiosk") {
        return;
    }
    display.blank_soon();
    display.wait("a blank screen", Display::is_blank);
    let (blue, red) = ([32, 48, 64], [160, 48, 64]);
    let face = Face::start(&config("#203040", ""), Some(&display));

    // Ready with the first picture.
    let first = face.told(PATIENCE).unwrap_or_else(|| face.log());
    assert!(
        first.contains("READY=1") && first.contains("STATUS="),
        "{first}"
    );
    display.wait_for((2, 2), blue);
    display.wait_for((317, 2), blue);
    let cloth = display.pixels(160, 398, 1, 1);
    assert_ne!(cloth, [blue], "it fills the screen down to its foot");

    // The file changes while it speaks: the picture is turned, the sky is red.
    let socket = face.path("mouthpiece.sock");
    let mut client = face.call(&socket);
    client.speak();
    face.configure(&config("#a03040", "").replace("fullscreen", "rotate = 180\nfullscreen"));
    display.wait_for((2, 397), red);
    assert_ne!(display.pixels(160, 2, 1, 1), [red], "it is turned");

    // A picture from beside the file.
    Picture::from_rgba(2, 2, &[0, 96, 160, 255].repeat(4)).write(&face.path("sky.png"));
    face.configure(&config("sky.png", ""));
    display.wait_for((2, 2), [0, 96, 160]);
    face.configure(&config("#a03040", ""));
    display.wait_for((2, 2), red);

    // A wrong one changes nothing, nor does it when it is read again.
    face.configure(&config("#008000", "seed = 3\n"));
    let refused = "line 6: look.seed: there is no such key";
    face.wait_for_log(refused, 1);
    binary::signal(face.child.id(), "HUP");
    face.wait_for_log(refused, 2);
    display.wait_for((2, 2), red);

    // What is felt at the next start only is said, and the rest of that file is felt.
    face.configure(&config(
        "#203040",
        "[captions]\nstyle = \"box\"\nsize_percent = 8\n[life]\nseed = 3\n",
    ));
    face.wait_for_log("felt at the next start keys=life.seed", 1);
    display.wait_for((2, 2), blue);
    client.say(&json!({"type": "caption", "text": "Good morning, everybody"}));
    display.wait("white letters", |d| {
        let foot = d.pixels(20, 340, 280, 60);
        foot.iter().filter(|p| p.iter().all(|c| *c > 225)).count() > 20
    });

    // While the screen takes no pictures nobody feeds the watchdog, whatever else still runs.
    display.screen.signal("STOP");
    let begun = Instant::now();
    while face.told(WATCHDOG).is_some() {
        assert!(
            begun.elapsed() < PATIENCE,
            "the watchdog is fed without pictures"
        );
    }
    client.say(&json!({"type": "ping", "token": "there"}));
    assert_eq!(client.answer()["token"], "there");
    display.screen.signal("CONT");
    let fed = face.told(PATIENCE).unwrap_or_default();
    assert!(fed.contains("WATCHDOG=1"), "{fed:?}");
    assert!(!display.is_blank(), "the screen has gone blank");

    face.forget_told();
    binary::signal(face.child.id(), "TERM");
    assert_eq!(client.answer()["type"], "stopped");
    let last = std::iter::from_fn(|| face.told(Duration::from_secs(1)));
    let last: Vec<String> = last.collect();
    assert!(last.iter().any(|t| t.contains("STOPPING=1")), "{last:?}");
    display.wait("a blank screen", Display::is_blank);
}

/// Guards the end of a face that speaks, where there is a window and where there is none: clients hear of it, and it
/// takes no second.
#[test]
fn the_end_is_clean_while_it_speaks() {
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("by_file.sock");
    let wire = format!("[wire]\nlisten = \"unix:{}\"\n", socket.display());
    let mut faces = vec![Face::start(&wire, None)];
    let display = or_skipped(Display::start(320, 320));
    if let Some(display) = &display {
        let elsewhere = wire.replace("by_file", "on_screen");
        faces.push(Face::start(&elsewhere, Some(display)));
    }
    for (face, name) in faces.into_iter().zip(["by_file.sock", "on_screen.sock"]) {
        let socket = folder.path().join(name);
        let mut client = face.call(&socket);
        client.speak();
        face.end(&socket);
        assert_eq!(client.answer()["type"], "stopped");
        let mut rest = String::new();
        assert_eq!(client.lines.read_line(&mut rest).unwrap(), 0, "{rest}");
    }
}

/// Guards the units: systemd reads them without a complaint, but for two words that it learnt later than Debian 12.
#[test]
fn systemd_understands_the_units() {
    let folder = tempfile::tempdir().unwrap();
    let programs = binary::root().join("daemon/kiosk");
    for (unit, as_called) in [
        ("mouthpiece@.service", "mouthpiece@cage.service"),
        ("mouthpiece.service", "mouthpiece.service"),
    ] {
        let text = fs::read_to_string(programs.join(unit)).unwrap();
        // What will be installed lies elsewhere here.
        let text = text
            .replace("/usr/local/lib/mouthpiece", &programs.to_string_lossy())
            .replace(
                "/usr/local/bin/mouthpiece",
                &binary::path().to_string_lossy(),
            )
            .replace("/usr/bin/pkill", "/bin/sh");
        let file = folder.path().join(as_called);
        fs::write(&file, text).unwrap();
        let verified = Command::new("systemd-analyze")
            .args(["verify", "--recursive-errors=no"])
            .arg(&file)
            .stdin(Stdio::null())
            .output();
        let verified = match verified {
            Ok(verified) => verified,
            Err(why) => {
                println!("skipped: systemd-analyze: {why}");
                return;
            }
        };
        let said = String::from_utf8_lossy(&verified.stderr);
        let ours = said.lines().filter(|line| line.contains("mouthpiece"));
        let mut complaints = ours
            .filter(|line| !line.contains("RestartSteps") && !line.contains("RestartMaxDelaySec"));
        assert_eq!(complaints.next(), None, "{said}");
    }
}
