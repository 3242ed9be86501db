//! Runs a program to its end, with bounded time and output: no engine can hang us or fill memory.
//!
//! No shell is involved, so no text is ever taken for a command. Three short threads serve the
//! pipes, because a program may stop reading before it has been told all, or print before it reads.

use std::io::{self, Read, Write as _};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use crossbeam::channel::{Receiver, bounded};

use super::error::VoiceError;
use crate::interrupt;

/// Most that is taken from a program's standard output: labels of an hour are some 2 MB.
const OUTPUT_BYTES_MAX: u64 = 32 * 1024 * 1024;

/// Most that is kept of its complaints.
const COMPLAINT_BYTES_MAX: u64 = 16 * 1024;

/// How often is looked whether it has ended.
const LOOK: Duration = Duration::from_millis(5);

/// How long its pipes may stay open after its end: a grandchild may hold them.
const PIPE_PATIENCE: Duration = Duration::from_secs(2);

/// What a program left.
pub struct Outcome {
    pub status: ExitStatus,
    pub stdout: Vec<u8>,
    stderr: Vec<u8>,
}

impl Outcome {
    /// The last thing that it complained of.
    pub fn complaint(&self) -> String {
        let text = String::from_utf8_lossy(&self.stderr);
        let last = text.lines().rfind(|line| !line.trim().is_empty());
        last.unwrap_or("it did not say why").trim().to_owned()
    }
}

/// Why a program could not be run to its end.
pub enum Trouble {
    /// There is no such program.
    Absent,
    /// Anything else.
    Error(VoiceError),
}

impl Trouble {
    /// The error, where a missing program is missed as `what`.
    pub fn or_missing(self, what: &'static str, install: &'static str) -> VoiceError {
        match self {
            Self::Absent => VoiceError::Missing { what, install },
            Self::Error(error) => error,
        }
    }
}

/// Runs `command`, which messages call `engine`, with `input` on its standard input.
pub fn run(
    engine: &'static str,
    mut command: Command,
    input: &[u8],
    patience: Duration,
) -> Result<Outcome, Trouble> {
    let failed = |error: io::Error| {
        Trouble::Error(VoiceError::Failed {
            engine,
            why: error.to_string(),
        })
    };
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let child = command.spawn().map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => Trouble::Absent,
        _ => failed(error),
    })?;
    let mut child = Guard(child);
    if let Some(mut pipe) = child.0.stdin.take() {
        let input = input.to_vec();
        // A program that does not want to hear all of it will say so by its status.
        thread(move || drop(pipe.write_all(&input))).map_err(failed)?;
    }
    let stdout = reader(child.0.stdout.take(), OUTPUT_BYTES_MAX).map_err(failed)?;
    let stderr = reader(child.0.stderr.take(), COMPLAINT_BYTES_MAX).map_err(failed)?;
    let until = Instant::now() + patience;
    let status = loop {
        if let Some(status) = child.0.try_wait().map_err(failed)? {
            break status;
        }
        interrupt::check().map_err(|e| Trouble::Error(e.into()))?;
        if Instant::now() >= until {
            return Err(Trouble::Error(VoiceError::Slow {
                engine,
                seconds: patience.as_secs(),
            }));
        }
        std::thread::sleep(LOOK);
    };
    let stdout = stdout.recv_timeout(PIPE_PATIENCE).unwrap_or_default();
    if stdout.len() as u64 > OUTPUT_BYTES_MAX {
        return Err(Trouble::Error(VoiceError::Failed {
            engine,
            why: "it printed more than any speech needs".into(),
        }));
    }
    Ok(Outcome {
        status,
        stdout,
        stderr: stderr.recv_timeout(PIPE_PATIENCE).unwrap_or_default(),
    })
}

/// A child that does not outlive us, whatever happens.
struct Guard(Child);

impl Drop for Guard {
    fn drop(&mut self) {
        // It has ended already, where all went well.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Reads a pipe to its end on a thread, keeping at most one byte more than `most`.
fn reader(pipe: Option<impl Read + Send + 'static>, most: u64) -> io::Result<Receiver<Vec<u8>>> {
    // One message is all there will be.
    let (send, receive) = bounded(1);
    thread(move || {
        let mut bytes = Vec::new();
        if let Some(mut pipe) = pipe {
            let kept = (&mut pipe).take(most + 1).read_to_end(&mut bytes);
            // The rest is read away, so that the program does not wait for us.
            let _ = kept.and_then(|_| io::copy(&mut pipe, &mut io::sink()));
        }
        let _ = send.send(bytes);
    })?;
    Ok(receive)
}

fn thread(work: impl FnOnce() + Send + 'static) -> io::Result<()> {
    std::thread::Builder::new()
        .name("engine pipe".into())
        .spawn(work)?;
    Ok(())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    const LONG: Duration = Duration::from_secs(30);

    #[test]
    fn what_goes_in_comes_out_and_complaints_are_kept_apart() {
        let input = vec![b'x'; 1 << 20];
        let run = run(
            "cat",
            shell("cat; echo first >&2; echo last >&2"),
            &input,
            LONG,
        );
        let outcome = run.ok().unwrap();
        assert_eq!(outcome.stdout, input);
        assert_eq!(outcome.complaint(), "last");
        assert!(outcome.status.success());
    }

    /// A program that neither reads nor ends is ended.
    #[test]
    fn a_program_that_hangs_is_given_up() {
        let started = Instant::now();
        let input = vec![b'x'; 1 << 20];
        let patience = Duration::from_millis(200);
        let run = run("sleep", shell("exec sleep 60"), &input, patience);
        assert!(matches!(
            run.err(),
            Some(Trouble::Error(VoiceError::Slow { .. }))
        ));
        assert!(started.elapsed() < LONG);
    }

    #[test]
    fn a_flood_is_refused_and_a_missing_program_is_told_apart() {
        let flood = format!("head -c {} /dev/zero", OUTPUT_BYTES_MAX + 70_000);
        assert!(matches!(
            run("flood", shell(&flood), b"", LONG).err(),
            Some(Trouble::Error(VoiceError::Failed { .. }))
        ));
        let absent = Command::new("mouthpiece-no-such-program");
        assert!(matches!(
            run("absent", absent, b"", LONG).err(),
            Some(Trouble::Absent)
        ));
    }
}
