//! Other avatars that are driven by our speech: the running daemon, and who listens to it over UDP.

use std::collections::HashMap;
use std::io::{BufRead as _, BufReader, Write as _};
use std::net::UdpSocket;
use std::os::unix::net::UnixStream;
use std::process::Stdio;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use mouthpiece_tests::binary;
use rosc::{OscPacket, OscType};
use serde_json::{Value, json};

/// Far more than anything here takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);
/// A listener that hears nothing for this long is done: the daemon sends 60 times a second until it ends.
const SILENCE: Duration = Duration::from_secs(5);
/// What is said, seconds: two open vowels and an /m/ between them.
const PHONES: [(f64, f64, &str); 5] = [
    (0.0, 0.4, "h#"),
    (0.4, 0.8, "aa"),
    (0.8, 1.1, "m"),
    (1.1, 1.5, "aa"),
    (1.5, 1.9, "h#"),
];
/// How well the start of the utterance can be told from outside, with room for a busy machine, seconds.
const SLACK_S: f64 = 0.06;

/// One packet: when it came since the test began, seconds, and its bytes.
type Packets = Vec<(f64, Vec<u8>)>;

/// Takes packets until none come any more. Gives the port.
fn listen(begun: Instant) -> (u16, JoinHandle<Packets>) {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let port = socket.local_addr().unwrap().port();
    let taking = std::thread::Builder::new().name(format!("udp-{port}"));
    let taking = taking.spawn(move || {
        let mut packets = Packets::new();
        let mut bytes = [0; 4096];
        socket.set_read_timeout(Some(PATIENCE)).unwrap();
        while let Ok(length) = socket.recv(&mut bytes) {
            packets.push((begun.elapsed().as_secs_f64(), bytes[..length].to_vec()));
            socket.set_read_timeout(Some(SILENCE)).unwrap();
        }
        packets
    });
    (port, taking.unwrap())
}

/// A face at an instant as a receiver knows it.
#[derive(Debug, Default)]
struct Seen {
    came: f64,
    time: f64,
    values: HashMap<String, f64>,
}

impl Seen {
    fn of(&self, name: &str) -> f64 {
        *self
            .values
            .get(name)
            .unwrap_or_else(|| panic!("no {name} in {:?}", self.values))
    }
}

fn float(value: &OscType) -> f64 {
    match value {
        OscType::Float(v) => f64::from(*v),
        OscType::Double(v) => *v,
        other => panic!("{other:?} is no float"),
    }
}

/// The messages of all packets in order, with when each came.
fn osc(packets: &Packets) -> Vec<(f64, String, Vec<OscType>)> {
    let mut messages = Vec::new();
    for (came, bytes) in packets {
        assert!(bytes.len() <= 1472, "{} bytes are two frames", bytes.len());
        let (rest, packet) = rosc::decoder::decode_udp(bytes).unwrap();
        assert!(rest.is_empty());
        let OscPacket::Bundle(bundle) = packet else {
            panic!("no bundle: {packet:?}")
        };
        for content in bundle.content {
            let OscPacket::Message(message) = content else {
                panic!("a bundle in a bundle")
            };
            messages.push((*came, message.addr, message.args));
        }
    }
    messages
}

/// What an avatar is after each `/VMC/Ext/Blend/Apply`.
fn vmc(packets: &Packets) -> Vec<Seen> {
    let mut all = Vec::new();
    let mut now = Seen::default();
    for (came, address, args) in osc(packets) {
        match address.as_str() {
            "/VMC/Ext/OK" => assert_eq!(args, [OscType::Int(1)]),
            "/VMC/Ext/T" => now.time = float(&args[0]),
            "/VMC/Ext/Bone/Pos" => {
                assert_eq!(args[0], OscType::String("Head".into()));
                let pose: Vec<f64> = args[1..].iter().map(float).collect();
                let turn: f64 = pose[3..].iter().map(|v| v * v).sum();
                assert!(pose.len() == 7 && (turn - 1.0).abs() < 1e-3, "{pose:?}");
            }
            "/VMC/Ext/Blend/Val" => {
                let OscType::String(name) = &args[0] else {
                    panic!("{args:?}")
                };
                now.values.insert(name.clone(), float(&args[1]));
            }
            "/VMC/Ext/Blend/Apply" => {
                now.came = came;
                all.push(std::mem::take(&mut now));
            }
            other => panic!("unknown {other}"),
        }
    }
    all
}

/// Our own OSC: an instant ends where the next one's time is told.
fn plain(packets: &Packets) -> Vec<Seen> {
    let mut all: Vec<Seen> = Vec::new();
    for (came, address, args) in osc(packets) {
        let address = address.strip_prefix("/mouthpiece/").unwrap();
        if address == "time" {
            all.push(Seen {
                came,
                time: float(&args[0]),
                values: HashMap::new(),
            });
            continue;
        }
        let now = all.last_mut().unwrap();
        for (n, value) in args.iter().enumerate() {
            now.values.insert(format!("{address}.{n}"), float(value));
        }
    }
    all
}

/// Live Link Face's packet, read as the engine reads it.
fn livelink(packets: &Packets) -> Vec<Seen> {
    let mut all = Vec::new();
    for (came, bytes) in packets {
        let mut at = 0;
        let mut take = |n: usize| {
            at += n;
            &bytes[at - n..at]
        };
        let word = |b: &[u8]| u32::from_be_bytes(b.try_into().unwrap());
        assert_eq!(take(1), [6]);
        let length = word(take(4)) as usize;
        assert_eq!(length, 36, "a UUID");
        take(length);
        let length = word(take(4)) as usize;
        assert_eq!(take(length), b"Mouthpiece");
        let frame = f64::from(word(take(4)));
        let part = f64::from(f32::from_be_bytes(take(4).try_into().unwrap()));
        let (rate, over) = (word(take(4)), word(take(4)));
        assert_eq!((rate, over), (60, 1));
        assert_eq!(take(1), [61]);
        let mut value = || f64::from(f32::from_be_bytes(take(4).try_into().unwrap()));
        let values: Vec<f64> = (0..61).map(|_| value()).collect();
        assert_eq!(at, bytes.len());
        // By the engine's numbers.
        let named = [
            ("jawLeft", 15),
            ("jawRight", 16),
            ("jawOpen", 17),
            ("mouthClose", 18),
        ];
        all.push(Seen {
            came: *came,
            time: (frame + part) / f64::from(rate),
            values: named.map(|(n, i)| (n.to_owned(), values[i])).into(),
        });
    }
    all
}

/// What comes late on a busy machine comes late alone: the least late tells.
fn offset(times: impl Iterator<Item = (f64, f64)>) -> f64 {
    times
        .map(|(came, time)| time - came)
        .fold(f64::MIN, f64::max)
}

/// Guards `--drive`: each protocol says the same, in step with what is heard: lips closed in /m/ and
/// open in /aa/, and at rest at the end.
#[test]
fn avatars_are_driven_in_step_with_the_sound() {
    let begun = Instant::now();
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("face.sock");
    let (listen_at, kinds) = (
        format!("unix:{}", socket.display()),
        ["vmc", "vmc-arkit", "osc", "livelink"],
    );
    let (ports, listeners): (Vec<u16>, Vec<_>) = kinds.iter().map(|_| listen(begun)).unzip();
    let mut args = vec!["run".to_owned(), "--listen".into(), listen_at];
    args.extend(["--audio-device", "none", "--http", "none"].map(String::from));
    for (kind, port) in kinds.iter().zip(&ports) {
        args.extend(["--drive".into(), format!("{kind}:127.0.0.1:{port}")]);
    }
    // Nobody listens at this one, which must not matter.
    args.extend(["--drive".into(), "osc:127.0.0.1:9".into()]);
    let mut daemon = binary::start(binary::command(&args).stdout(Stdio::null()));
    while !socket.exists() {
        assert!(!daemon.has_ended(), "{}", daemon.finish().stderr);
        assert!(begun.elapsed() < PATIENCE, "no socket");
        std::thread::sleep(Duration::from_millis(10));
    }
    let mut client = UnixStream::connect(&socket).unwrap();
    client.set_read_timeout(Some(PATIENCE)).unwrap();
    let phones =
        PHONES.map(|(start, end, phone)| json!({"start": start, "end": end, "phone": phone}));
    for line in [
        json!({"type": "begin", "id": "a"}),
        json!({"type": "phones", "phones": phones}),
        json!({"type": "end"}),
    ] {
        writeln!(client, "{line}").unwrap();
    }
    let mut progress = Vec::new();
    for line in BufReader::new(client).lines() {
        let answer: Value = serde_json::from_str(&line.unwrap()).unwrap();
        match answer["type"].as_str() {
            Some("progress") => progress.push((
                begun.elapsed().as_secs_f64(),
                answer["position_s"].as_f64().unwrap(),
            )),
            Some("finished") => break,
            Some("error") => panic!("{answer}"),
            _ => {}
        }
    }
    daemon.signal("TERM");
    let ended = daemon.finish_within(PATIENCE);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    assert!(progress.len() > 5);
    let position = offset(progress.into_iter());

    let packets: Vec<Packets> = listeners.into_iter().map(|l| l.join().unwrap()).collect();
    type Gap = fn(&Seen) -> f64;
    let arkit: Gap = |s| s.of("jawOpen") - s.of("mouthClose");
    let faces: [(Vec<Seen>, Gap, f64); 4] = [
        (
            vmc(&packets[0]),
            |s| ["aa", "ih", "ou", "ee", "oh"].map(|v| s.of(v)).iter().sum(),
            0.8,
        ),
        (vmc(&packets[1]), arkit, 0.15),
        (plain(&packets[2]), |s| s.of("mouth.0"), 6.0),
        (livelink(&packets[3]), arkit, 0.15),
    ];
    for ((seen, gap, open), kind) in faces.iter().zip(kinds) {
        // The first tick of the utterance by this listener's own clock.
        let start = offset(seen.iter().map(|s| (s.came, s.time))) - position;
        let during = |from: f64, to: f64| {
            let inside = seen
                .iter()
                .filter(move |s| (from..to).contains(&(s.time - start)));
            let values: Vec<f64> = inside.map(gap).collect();
            // Half of the 60 a second, on a machine that is busy with other tests.
            let wanted = (to - from) * 30.0;
            assert!(values.len() as f64 >= wanted, "{kind}: {}", values.len());
            values
        };
        for (from, to, phone) in PHONES {
            let values = during(from + SLACK_S, to - SLACK_S);
            let widest = values.iter().copied().fold(f64::MIN, f64::max);
            let least = values.iter().copied().fold(f64::MAX, f64::min);
            match phone {
                "aa" => assert!(widest > *open, "{kind}: /aa/ opens to {widest}"),
                "m" => assert!(least < 0.02 * open, "{kind}: /m/ closes to {least}"),
                _ => {}
            }
        }
        // Time goes on by itself, at 60 a second as a rule, and ends at rest.
        assert!(seen.windows(2).all(|w| w[0].time <= w[1].time), "{kind}");
        let last = seen.last().unwrap();
        assert!(gap(last) < 0.02 * open, "{kind} ends with {last:?}");
    }
    let shapes = &faces[1].0[0].values;
    assert!(shapes.len() == 52 && shapes.contains_key("eyeBlinkLeft"));
}

/// Guards against sending to everybody, and options without effect.
#[test]
fn what_cannot_be_driven_is_said_at_once() {
    for (target, said) in [
        ("osc:224.0.0.1:9000", "many machines"),
        ("osc:127.0.0.1", "port"),
        ("tcp:127.0.0.1:9000", "vmc-arkit"),
    ] {
        let out = binary::run(&["run", "--audio-device", "none", "--drive", target]);
        let sentence = out.expect_sentence(2);
        assert!(sentence.contains(said), "{sentence}");
    }
    for option in [
        ["--seed", "3"],
        ["--look-ahead", "100"],
        ["--expression", "smile"],
    ] {
        let mut args = vec!["curves", "--demo", "--as", "oculus"];
        args.extend(option);
        let out = binary::run(&args);
        let sentence = out.expect_sentence(2);
        assert!(sentence.contains("no effect"), "{sentence}");
    }
    let out = binary::run(&["curves", "--demo", "--as", "fap", "--rate", "29.97"]);
    assert!(out.expect_sentence(2).contains("whole number"));
}
