//! A loopback recorder for `doctor --sync`: what the sound server says is heard, through its own
//! `parec`, so that the clicks take the way of any sound and come back from outside this program.

use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result};

const RATE: usize = 48_000;
/// The monitor of whatever plays by default.
const SOURCE: &str = "@DEFAULT_MONITOR@";
/// Longest recording: 20 MB.
const SAMPLES_MAX: usize = 200 * RATE;
/// A click is at least so loud (of 32767), and this share of the loudest sound.
const LOUD_MIN: u16 = 300;
const LOUD_SHARE: f64 = 0.3;
/// Between two clicks.
const QUIET: usize = RATE * 3 / 10;
/// Over so much the least late piece tells when its samples were heard.
const ENVELOPE: usize = 4 * RATE;

/// What was recorded: samples, and how many there were when.
#[derive(Default)]
struct Tape {
    samples: Vec<i16>,
    pieces: Vec<(Instant, usize)>,
}

/// A running recorder.
pub struct Ear {
    recorder: Child,
    thread: JoinHandle<Tape>,
}

impl Ear {
    /// Starts it; an error in words where there is no loopback.
    pub fn start() -> Result<Self> {
        let mut recorder = Command::new("parec")
            .args(["-d", SOURCE, "--raw", "--format=s16le", "--rate=48000"])
            .args(["--channels=1", "--latency-msec=5"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("the sound cannot be recorded without `parec` (Debian: pulseaudio-utils)")?;
        let mut stream = recorder
            .stdout
            .take()
            .context("the recorder gives nothing")?;
        let thread = std::thread::Builder::new()
            .name("ear".to_owned())
            .spawn(move || record(&mut stream))?;
        Ok(Self { recorder, thread })
    }

    /// When each click was heard.
    pub fn finish(mut self) -> Result<Vec<Instant>> {
        // Ended already where there is no sound server.
        let _ = self.recorder.kill();
        let _ = self.recorder.wait();
        let tape = self.thread.join().ok().context("the recorder broke down")?;
        anyhow::ensure!(
            !tape.samples.is_empty(),
            "the monitor of the default sound device gives nothing: there is no PulseAudio or PipeWire, or no device"
        );
        Ok(tape.clicks())
    }
}

fn record(stream: &mut impl std::io::Read) -> Tape {
    let mut tape = Tape::default();
    let mut bytes = [0; 65_536];
    let mut kept = 0;
    while tape.samples.len() < SAMPLES_MAX {
        let Ok(read @ 1..) = stream.read(&mut bytes[kept..]) else {
            break;
        };
        let now = Instant::now();
        let there = kept + read;
        let samples = bytes[..there].chunks_exact(2);
        tape.samples
            .extend(samples.map(|b| i16::from_le_bytes([b[0], b[1]])));
        kept = there % 2;
        bytes[0] = bytes[there - 1];
        tape.pieces.push((now, tape.samples.len()));
    }
    tape
}

impl Tape {
    fn clicks(&self) -> Vec<Instant> {
        let loudest = self.samples.iter().map(|s| s.unsigned_abs()).max();
        let loud = (f64::from(loudest.unwrap_or(0)) * LOUD_SHARE).max(f64::from(LOUD_MIN));
        let mut clicks = Vec::new();
        let mut last = None;
        for (n, sample) in self.samples.iter().enumerate() {
            if f64::from(sample.unsigned_abs()) < loud {
                continue;
            }
            if last.is_none_or(|last| n - last > QUIET) {
                clicks.extend(self.heard(n));
            }
            last = Some(n);
        }
        clicks
    }

    /// When sample `n` was heard: pieces come late, never early, so that the earliest counts.
    fn heard(&self, n: usize) -> Option<Instant> {
        let first = self.pieces.first()?.0;
        let lateness = |&(came, count): &(Instant, usize)| {
            came.duration_since(first).as_secs_f64() - count as f64 / RATE as f64
        };
        let near = self
            .pieces
            .iter()
            .filter(|(_, count)| count.abs_diff(n) < ENVELOPE / 2);
        let least = near.map(lateness).min_by(f64::total_cmp)?;
        let after = Duration::try_from_secs_f64(least + n as f64 / RATE as f64).ok()?;
        Some(first + after)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clicks_are_found_where_they_were_heard_whatever_piece_is_late() {
        let first = Instant::now();
        let mut tape = Tape::default();
        for piece in 1..=500_usize {
            let mut samples = [0_i16; 480];
            // A click of 8 ms in the middle of every hundredth piece.
            if piece % 100 == 50 {
                samples[240..].fill(9000);
            }
            tape.samples.extend(samples);
            let late = (piece * 7 % 13) as u64;
            let came = Duration::from_millis(piece as u64 * 10 + late);
            tape.pieces.push((first + came, tape.samples.len()));
        }
        let at: Vec<_> = tape
            .clicks()
            .into_iter()
            .map(|click| click.duration_since(first).as_millis())
            .collect();
        let wanted = [495, 1495, 2495, 3495, 4495];
        assert_eq!(at.len(), wanted.len());
        for (at, wanted) in at.iter().zip(wanted) {
            assert!(at.abs_diff(wanted) <= 1, "{at} ms instead of {wanted}");
        }
    }

    #[test]
    fn silence_has_no_clicks() {
        let pieces = vec![(Instant::now(), 4800)];
        let tape = Tape {
            samples: vec![12; 4800],
            pieces,
        };
        assert!(tape.clicks().is_empty());
    }
}
