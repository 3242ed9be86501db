//! The sound device that goes and comes back: PulseAudio stopped and started under a running daemon.
//!
//! The face is seen through `--drive osc`, the sound through the sink's monitor, both from outside.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::UdpSocket;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use mouthpiece_tests::binary;
use rosc::{OscPacket, OscType};
use serde_json::{Value, json};

/// Far more than anything here takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);
/// What is said: so long that the device is back well before its end, seconds.
const UTTERANCE_S: f64 = 22.0;
/// When the sound server is stopped, by the position that is heard, and for how long it is gone.
const STOPPED_AT_S: f64 = 2.0;
const GONE: Duration = Duration::from_secs(10);
/// The default of `--look-ahead`, seconds.
const LOOK_AHEAD_S: f64 = 0.3;
/// A sixtieth of a second between two looks at the face, and as much for the way here, seconds.
const SEEN_S: f64 = 0.035;
/// A face that stands still for longer than this is frozen; the mouth changes twice a second.
const FROZEN_S: f64 = 1.5;
/// Sound in base64, 24 bytes: 6 samples of 0x4040, 6 of 0xc0c0.
const WAVE: &str = "QEBAQEBAQEBAQEBAwMDAwMDAwMDAwMDA";
/// A sample beyond this is [`WAVE`]'s, no silence.
const LOUD: u16 = 4000;

/// Ended whatever happens.
struct Running(Child);

impl Running {
    fn start(command: &mut Command) -> Self {
        let command = command.stdin(Stdio::null()).stderr(Stdio::null());
        Self(command.spawn().unwrap())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A PulseAudio of our own with a null sink; the folder is its home, too.
fn pulseaudio(folder: &Path) -> Running {
    let socket = folder.join("pulse.sock");
    let _ = std::fs::remove_file(&socket);
    let server = Running::start(
        at_home(&mut Command::new("pulseaudio"), folder)
            .args(["-n", "--daemonize=no", "--exit-idle-time=-1"])
            .args(["--use-pid-file=no", "--realtime=no", "--high-priority=no"])
            .arg("-L")
            .arg("module-null-sink sink_name=test rate=48000 format=s16le channels=2")
            .arg("-L")
            .arg(format!(
                "module-native-protocol-unix auth-anonymous=1 socket={}",
                socket.display()
            ))
            .stdout(Stdio::null()),
    );
    let begun = Instant::now();
    while UnixStream::connect(&socket).is_err() {
        assert!(begun.elapsed() < PATIENCE, "PulseAudio does not start");
        std::thread::sleep(Duration::from_millis(20));
    }
    server
}

fn at_home<'a>(command: &'a mut Command, folder: &Path) -> &'a mut Command {
    let server = format!("unix:{}", folder.join("pulse.sock").display());
    command
        .env("HOME", folder)
        .env("XDG_RUNTIME_DIR", folder)
        .env("PULSE_SERVER", server)
}

fn is_loud(sample: &i16) -> bool {
    sample.unsigned_abs() > LOUD
}

/// Whether the tools are here; in CI they must be.
fn has_tools() -> bool {
    let tools = ["pulseaudio", "parec"];
    let missing = tools
        .iter()
        .any(|tool| binary::tool(tool, &["--version"]).is_none());
    if missing {
        assert!(std::env::var_os("CI").is_none(), "CI must have {tools:?}");
        eprintln!("skipped: {tools:?} are not installed");
    }
    !missing
}

/// A daemon whose default sound device is a private server's.
struct Stage {
    /// Home of both.
    home: tempfile::TempDir,
    server: Running,
    begun: Instant,
    daemon: binary::Running,
    client: UnixStream,
    /// Where the daemon tells what its face does.
    watcher: UdpSocket,
    /// There from the beginning to the end of the server: the sink pauses when a recorder comes or goes.
    recording: Recording,
}

/// None: the tools are missing.
fn stage() -> Option<Stage> {
    if !has_tools() {
        return None;
    }
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let default = "pcm.!default pulse\nctl.!default pulse\n";
    std::fs::write(folder.join(".asoundrc"), default).unwrap();
    let server = pulseaudio(folder);
    let begun = Instant::now();
    let watcher = UdpSocket::bind("127.0.0.1:0").unwrap();
    watcher.set_nonblocking(true).unwrap();
    let socket = folder.join("face.sock");
    let listen = format!("unix:{}", socket.display());
    let drive = format!("osc:{}", watcher.local_addr().unwrap());
    let args = [
        "-v", "run", "--http", "none", "--listen", &listen, "--drive", &drive,
    ];
    let mut command = binary::command(&args);
    let mut daemon = binary::start(at_home(&mut command, folder).stdout(Stdio::null()));
    let client = loop {
        if let Ok(client) = UnixStream::connect(&socket) {
            break client;
        }
        assert!(!daemon.has_ended(), "{}", daemon.finish().stderr);
        assert!(begun.elapsed() < PATIENCE, "no socket");
        std::thread::sleep(Duration::from_millis(10));
    };
    let recording = record(folder);
    // Until stamps of the device are settled, and the log says its latency.
    std::thread::sleep(Duration::from_secs(3));
    Some(Stage {
        client,
        home,
        server,
        begun,
        daemon,
        watcher,
        recording,
    })
}

/// The gap between the lips of each packet that tells it, and when it came.
fn gaps(socket: &UdpSocket, begun: Instant, gaps: &mut Vec<(f64, f32)>) {
    let mut bytes = [0; 4096];
    while let Ok(length) = socket.recv(&mut bytes) {
        let packet = rosc::decoder::decode_udp(&bytes[..length]).unwrap().1;
        let OscPacket::Bundle(bundle) = packet else {
            continue;
        };
        for content in bundle.content {
            if let OscPacket::Message(message) = content
                && message.addr == "/mouthpiece/mouth"
                && let OscType::Float(gap) = message.args[0]
            {
                gaps.push((begun.elapsed().as_secs_f64(), gap));
            }
        }
    }
}

/// What the sink's monitor gave: samples, and how many there were when.
#[derive(Default)]
struct Tape {
    samples: Vec<i16>,
    pieces: Vec<(Instant, usize)>,
}

/// A recorder at work.
struct Recording(Running, std::thread::JoinHandle<Tape>);

impl Recording {
    fn end(self) -> Tape {
        drop(self.0);
        self.1.join().unwrap()
    }
}

/// Records until the recorder is ended.
fn record(folder: &Path) -> Recording {
    let mut recorder = Running::start(
        at_home(&mut Command::new("parec"), folder)
            .args(["-d", "test.monitor", "--raw", "--format=s16le"])
            .args(["--rate=48000", "--channels=1", "--latency-msec=5"])
            .stdout(Stdio::piped()),
    );
    let mut stream = recorder.0.stdout.take().unwrap();
    let reading = std::thread::Builder::new().name("parec".to_owned());
    let reading = reading.spawn(move || {
        let mut tape = Tape::default();
        let mut odd = Vec::new();
        let mut bytes = [0; 4096];
        while let Ok(read @ 1..) = stream.read(&mut bytes) {
            odd.extend(&bytes[..read]);
            let whole = odd.len() & !1;
            let samples = odd[..whole].chunks_exact(2);
            let samples = samples.map(|b| i16::from_le_bytes([b[0], b[1]]));
            tape.samples.extend(samples);
            odd.drain(..whole);
            tape.pieces.push((Instant::now(), tape.samples.len()));
        }
        tape
    });
    Recording(recorder, reading.unwrap())
}

impl Tape {
    /// How many samples were loud.
    fn loudness(&self) -> usize {
        self.samples.iter().filter(|s| is_loud(s)).count()
    }

    /// When the first loud sample was heard, seconds after `begun`: pieces come late, never early.
    fn onset(&self, begun: Instant) -> f64 {
        let loud = self.samples.iter().position(is_loud);
        let loud = loud.expect("nothing was heard") as f64 / 48_000.0;
        let lateness = self.pieces.iter().map(|(came, count)| {
            came.saturating_duration_since(begun).as_secs_f64() - *count as f64 / 48_000.0
        });
        loud + lateness.fold(f64::MAX, f64::min)
    }
}

/// Guards the answer of a kiosk: from the last byte of label and sound to the first sample that is
/// heard, no longer than the look-ahead, what the device itself takes, and 20 ms; and the mouth opens
/// no later than the sound begins.
#[test]
fn the_first_sound_comes_in_time_and_the_mouth_no_later() {
    let Some(mut stage) = stage() else { return };
    let begun = stage.begun;
    let look = Duration::from_millis(5);
    stage.client.set_read_timeout(Some(look)).unwrap();
    for line in [
        json!({"type": "begin", "id": "a", "audio": {"rate": 8000, "channels": 1, "format": "s16"}}),
        json!({"type": "phones", "phones": [{"start": 0.0, "end": 0.6, "phone": "aa"}]}),
        json!({"type": "audio", "data": WAVE.repeat(400)}),
        json!({"type": "end"}),
    ] {
        writeln!(stage.client, "{line}").unwrap();
    }
    let sent = begun.elapsed().as_secs_f64();
    let mut seen = Vec::new();
    // The face is looked at as often as it is told.
    let mut answers = BufReader::new(stage.client);
    let mut line = String::new();
    while !line.contains("\"finished\"") {
        assert!(begun.elapsed() < PATIENCE, "it never ends");
        gaps(&stage.watcher, begun, &mut seen);
        if line.ends_with('\n') {
            line.clear();
        }
        // Nothing yet, or half a line.
        let _ = answers.read_line(&mut line);
    }
    gaps(&stage.watcher, begun, &mut seen);
    let heard = stage.recording.end().onset(begun);
    stage.daemon.signal("TERM");
    let said = stage.daemon.finish_within(PATIENCE).stderr;
    drop(stage.server);
    let latency = said
        .split("latency_ms=")
        .nth(1)
        .and_then(|rest| rest.split_whitespace().next())
        .unwrap_or_else(|| panic!("no latency in the log\n{said}"));
    let latency: f64 = latency.parse::<f64>().unwrap() * 1e-3;
    let took = heard - sent;
    eprintln!(
        "{:.0} ms to the first sound; the device takes {:.0} ms of them",
        took * 1e3,
        latency * 1e3
    );
    assert!(took < LOOK_AHEAD_S + latency + 0.02, "{took} s\n{said}");
    let opened = seen.iter().find(|(came, gap)| *came > sent && *gap > 1.0);
    let (opened, _) = opened.expect("the mouth opens");
    eprintln!(
        "the mouth opens {:.0} ms before the sound",
        (heard - opened) * 1e3
    );
    assert!(*opened < heard + SEEN_S, "{opened} and {heard}");
}

/// Guards a kiosk whose sound server is restarted in mid-sentence: the face goes on, the utterance
/// ends when it should, nothing of it is lost, and the sound comes back by itself.
#[test]
fn a_sound_server_that_goes_for_ten_seconds_stops_only_the_sound() {
    let Some(stage) = stage() else { return };
    let Stage {
        home,
        server,
        begun,
        daemon,
        mut client,
        watcher,
        recording,
    } = stage;
    let folder = home.path();

    // A square wave of 8 kHz in as many lines as it takes, and a mouth that opens and closes.
    let phones: Vec<Value> = (0..(UTTERANCE_S / 0.5) as i32)
        .map(|n| {
            let start = f64::from(n) * 0.5;
            json!({"start": start, "end": start + 0.5, "phone": if n % 2 == 0 { "aa" } else { "m" }})
        })
        .collect();
    let mut lines = vec![
        json!({"type": "begin", "id": "a", "audio": {"rate": 8000, "channels": 1, "format": "s16"}}),
        json!({"type": "phones", "phones": phones}),
    ];
    for _ in 0..UTTERANCE_S as usize {
        lines.push(json!({"type": "audio", "data": WAVE.repeat(8000 / 12)}));
    }
    // What is missing to whole seconds by the rounding above.
    lines.push(
        json!({"type": "audio", "data": WAVE.repeat(8000 % 12 * UTTERANCE_S as usize / 12 + 1)}),
    );
    lines.push(json!({"type": "end"}));
    for line in lines {
        writeln!(client, "{line}").unwrap();
    }

    client
        .set_read_timeout(Some(Duration::from_millis(50)))
        .unwrap();
    let mut answers = BufReader::new(client);
    let mut seen = Vec::new();
    let (mut line, mut server, mut started, mut stopped) =
        (String::new(), Some(server), None, None);
    let mut recording = Some(recording);
    let finished = loop {
        assert!(begun.elapsed() < 2 * PATIENCE, "it never ends");
        gaps(&watcher, begun, &mut seen);
        if let Some(at) = stopped
            && server.is_none()
            && Instant::elapsed(&at) > GONE
        {
            server = Some(pulseaudio(folder));
            recording = Some(record(folder));
        }
        match answers.read_line(&mut line) {
            Ok(0) => panic!("closed"),
            Ok(_) => {}
            Err(_) => continue, // nothing yet, or half a line
        }
        let answer: Value = serde_json::from_str(&line).unwrap();
        line.clear();
        match answer["type"].as_str() {
            Some("started") => started = Some(Instant::now()),
            Some("progress") => {
                let at = answer["position_s"].as_f64().unwrap();
                if at > STOPPED_AT_S && stopped.is_none() {
                    let loud = recording.take().unwrap().end().loudness();
                    assert!(loud > 1000, "{loud} loud samples before the stop");
                    server = None;
                    stopped = Some(Instant::now());
                }
            }
            Some("finished") => break answer,
            Some("error" | "stopped") => panic!("{answer}"),
            _ => {}
        }
    };
    let lasted = started.unwrap().elapsed().as_secs_f64();
    let loud = recording.unwrap().end().loudness();
    gaps(&watcher, begun, &mut seen);
    daemon.signal("TERM");
    let said = daemon.finish_within(PATIENCE).stderr;
    drop(server);

    let whole = finished["position_s"].as_f64().unwrap();
    assert_eq!(
        finished["dropped_s"].as_f64().unwrap_or(0.0),
        0.0,
        "{finished}"
    );
    assert!(loud > 1000, "the sound did not come back\n{said}");
    assert_eq!(said.matches("going on without sound").count(), 1, "{said}");
    assert!(
        (whole..whole + 2.0).contains(&lasted),
        "{whole} s took {lasted} s\n{said}"
    );
    // The face, from a moment after its start to its end.
    let end = begun.elapsed().as_secs_f64();
    let (mut still_since, mut frozen, mut last) = (None, 0.0_f64, f32::MIN);
    for &(came, gap) in seen.iter().filter(|(came, _)| *came > end - lasted) {
        if (gap - last).abs() > 0.05 {
            still_since = Some(came);
        }
        last = gap;
        frozen = frozen.max(came - still_since.unwrap_or(came));
    }
    eprintln!("the mouth stood still for {frozen:.2} s at most; {whole} s took {lasted:.2} s");
    assert!(
        frozen < FROZEN_S,
        "the face froze for {frozen:.2} s\n{said}"
    );
}
