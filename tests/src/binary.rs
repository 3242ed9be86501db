//! Finds and runs the release build of `mouthpiece`, away from this machine's display and settings.

use std::ffi::OsStr;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Longer than the slowest test takes on two busy cores; a program that hangs must not take the
/// whole run with it.
const PATIENCE: Duration = Duration::from_secs(600);

/// How often a running program is looked at.
const POLL: Duration = Duration::from_millis(10);

/// The root of the checkout.
#[must_use]
pub fn root() -> PathBuf {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    crate_folder.parent().unwrap_or(crate_folder).to_path_buf()
}

/// Where the build puts the binary that is tested: two levels above the test program itself.
#[must_use]
pub fn path() -> PathBuf {
    let test = std::env::current_exe().expect("the test program has a path");
    let folder = test.parent().and_then(Path::parent);
    let name = format!("mouthpiece{}", std::env::consts::EXE_SUFFIX);
    let binary = folder
        .expect("tests run from target/PROFILE/deps")
        .join(name);
    assert!(
        binary.is_file(),
        "{} is not there: these tests run the real program, so build it first (cargo build --release), or run `make test`",
        binary.display()
    );
    binary
}

/// What a finished program left.
#[derive(Debug)]
pub struct Finished {
    /// How it ended.
    pub status: ExitStatus,
    /// What it wrote to standard output.
    pub stdout: Vec<u8>,
    /// What it wrote to standard error.
    pub stderr: String,
}

impl Finished {
    /// The exit status, or -1 where a signal ended it.
    #[must_use]
    pub fn code(&self) -> i32 {
        self.status.code().unwrap_or(-1)
    }

    /// Standard output as text.
    #[must_use]
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.stdout).into_owned()
    }

    /// Fails unless the work was done.
    #[track_caller]
    pub fn expect_done(&self) -> &Self {
        assert_eq!(self.code(), 0, "{}", self.stderr);
        self
    }

    /// Fails unless it ended with `code` and one sentence about it; gives the sentence.
    #[track_caller]
    pub fn expect_sentence(&self, code: i32) -> &str {
        assert_eq!(self.code(), code, "exit status; it said: {}", self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        let mut said = self
            .stderr
            .lines()
            .filter_map(|line| line.strip_prefix("mouthpiece: "));
        let sentence = said.next().unwrap_or_default();
        assert!(
            sentence.len() > 20 && said.next().is_none(),
            "wanted one sentence after `mouthpiece: `, got: {}",
            self.stderr
        );
        // A sentence of a screenful is a dump.
        assert!(sentence.chars().count() < 400, "{sentence}");
        sentence
    }
}

/// A program that is running.
#[derive(Debug)]
pub struct Running {
    child: Child,
    stdout: Option<JoinHandle<Vec<u8>>>,
    stderr: Option<JoinHandle<Vec<u8>>>,
}

impl Running {
    /// Sends the signal of this name (`INT`, `TERM`).
    pub fn signal(&self, name: &str) {
        signal(self.child.id(), name);
    }

    /// Whether it has ended.
    pub fn has_ended(&mut self) -> bool {
        self.child
            .try_wait()
            .expect("a child can be asked")
            .is_some()
    }

    /// Waits for its end.
    #[must_use]
    pub fn finish(self) -> Finished {
        self.finish_within(PATIENCE)
    }

    /// Waits for its end, and fails when it has not come after `patience`.
    #[must_use]
    pub fn finish_within(mut self, patience: Duration) -> Finished {
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().expect("a child can be asked") {
                break status;
            }
            assert!(
                begun.elapsed() < patience,
                "still running after {patience:?}"
            );
            std::thread::sleep(POLL);
        };
        let stdout = joined(self.stdout.take());
        let stderr = joined(self.stderr.take());
        Finished {
            status,
            stdout,
            stderr: String::from_utf8_lossy(&stderr).into_owned(),
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // A failed test leaves nothing running; after the end both are errors of no interest.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends a process the signal of this name (`INT`, `TERM`).
pub fn signal(process: u32, name: &str) {
    // The shell's own kill: no further package, no unsafe code.
    let sent = Command::new("sh")
        .args(["-c", r#"kill -s "$1" "$2""#, "sh", name])
        .arg(process.to_string())
        .status();
    assert!(sent.is_ok_and(|s| s.success()), "kill -s {name}");
}

/// `mouthpiece` with `args`, without standard input, display or log settings of this machine.
#[must_use]
pub fn command<S: AsRef<OsStr>>(args: &[S]) -> Command {
    let mut command = Command::new(path());
    command
        .args(args)
        .stdin(Stdio::null())
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("DBUS_SESSION_BUS_ADDRESS")
        .env_remove("RUST_LOG")
        // No daemon of the user's is to be spoken through, no configuration of theirs read.
        .env("XDG_RUNTIME_DIR", runtime_folder())
        .env("XDG_CONFIG_HOME", runtime_folder());
    command
}

/// Starts `command` and reads what it prints.
#[must_use]
pub fn start(command: &mut Command) -> Running {
    command.stderr(Stdio::piped());
    let mut child = command.spawn().expect("the binary starts");
    let stdout = child.stdout.take().map(|pipe| drain(pipe, "stdout"));
    let stderr = child.stderr.take().map(|pipe| drain(pipe, "stderr"));
    Running {
        child,
        stdout,
        stderr,
    }
}

/// Runs `mouthpiece` with `args` to its end.
#[must_use]
pub fn run<S: AsRef<OsStr>>(args: &[S]) -> Finished {
    start(command(args).stdout(Stdio::piped())).finish()
}

/// Runs a tool of this machine and gives its standard output; none where it is not installed.
#[must_use]
pub fn tool<S: AsRef<OsStr>>(name: &str, args: &[S]) -> Option<Vec<u8>> {
    let out = Command::new(name)
        .args(args)
        .stdin(Stdio::null())
        .output()
        .ok()?;
    let said = String::from_utf8_lossy(&out.stderr);
    assert!(out.status.success(), "{name}: {said}");
    Some(out.stdout)
}

/// An empty folder for sockets, the same for all tests of this process.
fn runtime_folder() -> PathBuf {
    let folder = root().join("target/tests-runtime");
    std::fs::create_dir_all(&folder).expect("target/ can be written");
    folder
}

/// Reads a pipe to its end on a thread, so that a full one never blocks the program.
fn drain(mut pipe: impl Read + Send + 'static, name: &str) -> JoinHandle<Vec<u8>> {
    std::thread::Builder::new()
        .name(name.into())
        .spawn(move || {
            let mut bytes = Vec::new();
            // What was read before an error still tells what happened.
            let _ = pipe.read_to_end(&mut bytes);
            bytes
        })
        .expect("threads can be started")
}

fn joined(reader: Option<JoinHandle<Vec<u8>>>) -> Vec<u8> {
    reader.map_or_else(Vec::new, |reader| reader.join().unwrap_or_default())
}
