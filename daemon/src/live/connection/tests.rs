//! Connections and the sound thread together, on made-up time: whatever clients send in whatever order, and
//! however they go, every utterance that was accepted ends exactly once.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use mouthpiece_rig::{Control, Controls};
use mouthpiece_speech::Speech;
use proptest::prelude::*;
use serde_json::Value;
use tokio::io::{AsyncBufReadExt as _, AsyncWriteExt as _, BufReader, DuplexStream, WriteHalf};
use tokio::sync::mpsc;

use super::*;
use crate::config::{Config, Turns};
use crate::live::clock::ClockCell;
use crate::live::conductor::{COMMANDS_MAX, CUES_MAX, Conductor, Cue, Ends};
use crate::live::rules::Rules;
use crate::live::sound::{Choice, Output};
use crate::live::time::Origin;
use crate::live::vitals::Vitals;

/// Bytes under way between a client and its connection.
const PIPE_BYTES: usize = 1 << 16;

/// What a client does.
#[derive(Clone, Debug)]
enum Deed {
    Line(&'static str),
    /// Half a line, or sound cut anywhere.
    Bytes(&'static [u8]),
    /// Sends no more, and reads on.
    Finish,
    /// Is gone without a word.
    Die,
    /// Milliseconds pass.
    Wait(i64),
}

fn deed() -> impl Strategy<Value = Deed> {
    let lines = prop::sample::select(vec![
        r#"{"type":"begin","id":"a"}"#,
        r#"{"type":"begin","id":"b","audio":{"rate":8000}}"#,
        r#"{"type":"begin","id":"c","audio":{"file":"/nowhere.wav"}}"#,
        r#"{"type":"phones","phones":[{"start":0,"end":0.1,"phone":"m"}]}"#,
        r#"{"type":"phones","phones":[{"start":0.1,"end":0.5,"phone":"aa"}]}"#,
        r#"{"type":"audio","data":"AAAAAAAAAAAAAAAAAAAAAAAA"}"#,
        r#"{"type":"end"}"#,
        r#"{"type":"stop"}"#,
        r#"{"type":"stop","id":"a"}"#,
        r#"{"type":"caption","text":"t"}"#,
        r#"{"type":"express","expression":"smile"}"#,
        r#"{"type":"ping"}"#,
        "0 800 aa",
        "800 1600 m",
        "",
        "nonsense",
    ]);
    prop_oneof![
        12 => lines.prop_map(Deed::Line),
        1 => Just(Deed::Bytes(b"{\"type\":")),
        1 => Just(Deed::Finish),
        1 => Just(Deed::Die),
        3 => (0_i64..800).prop_map(Deed::Wait),
    ]
}

/// Three clients and the sound thread.
struct Stage {
    conductor: Conductor,
    cues: crossbeam::channel::Receiver<Cue>,
    vitals: Arc<Vitals>,
    now_ns: i64,
    clients: Vec<Option<WriteHalf<DuplexStream>>>,
    /// What each was answered.
    answers: Vec<Arc<Mutex<Vec<Value>>>>,
    readers: Vec<tokio::task::JoinHandle<()>>,
}

impl Stage {
    fn new(turns: Turns) -> Self {
        let origin = Origin::new();
        let output = Output::open(Choice::Silent, Arc::new(ClockCell::default()), origin);
        let (commands, inbox) = mpsc::channel(COMMANDS_MAX);
        let (cue, cues) = crossbeam::channel::bounded(CUES_MAX);
        let speech = Speech::with(|a| {
            let mut controls = Controls::default();
            controls[Control::Jaw] = a.jaw_rad;
            controls
        });
        let vitals = Arc::new(Vitals::new(origin));
        let ends = Ends {
            commands: inbox,
            cues: cue,
            face: None,
            captions: Arc::default(),
        };
        let rules = Rules {
            turns,
            ..Rules::of(&Config::default())
        };
        let handle = Handle::new(commands, Arc::clone(&vitals));
        let mut stage = Self {
            conductor: Conductor::new(output, ends, speech.unwrap(), rules, Arc::clone(&vitals)),
            cues,
            vitals,
            now_ns: origin.now_ns(),
            clients: Vec::new(),
            answers: Vec::new(),
            readers: Vec::new(),
        };
        for number in 0..3 {
            stage.connect(&handle, number);
        }
        stage
    }

    fn connect(&mut self, handle: &Handle, number: u64) {
        let (near, far) = tokio::io::duplex(PIPE_BYTES);
        let (read, write) = tokio::io::split(far);
        let terms = Terms {
            limits: Limits::default(),
            token: None,
            files: Files::None,
            write_patience: Duration::from_secs(5),
        };
        let peer = Peer::Lines((Box::new(read), Box::new(write)));
        tokio::spawn(serve(peer, handle.clone(), terms, number));
        let (read, write) = tokio::io::split(near);
        let answers = Arc::new(Mutex::new(Vec::new()));
        let told = Arc::clone(&answers);
        self.readers.push(tokio::spawn(async move {
            let mut lines = BufReader::new(read).lines();
            while let Ok(Some(line)) = lines.next_line().await {
                let answer = serde_json::from_str(&line).unwrap();
                told.lock().unwrap().push(answer);
            }
        }));
        self.answers.push(answers);
        self.clients.push(Some(write));
    }

    async fn act(&mut self, client: usize, deed: &Deed) {
        match deed {
            Deed::Line(line) => self.send(client, format!("{line}\n").as_bytes()).await,
            Deed::Bytes(bytes) => self.send(client, bytes).await,
            Deed::Finish => {
                if let Some(mut write) = self.clients[client].take() {
                    let _ = write.shutdown().await;
                }
            }
            Deed::Die => {
                self.readers[client].abort();
                self.clients[client] = None;
            }
            Deed::Wait(ms) => self.pass_ms(*ms).await,
        }
        self.pass_ms(10).await;
    }

    async fn send(&mut self, client: usize, bytes: &[u8]) {
        if let Some(write) = &mut self.clients[client] {
            // A connection that was closed takes nothing.
            let _ = write.write_all(bytes).await;
        }
    }

    async fn pass_ms(&mut self, ms: i64) {
        for _ in 0..=ms / 10 {
            // Everybody has had their turn several times over: nothing here waits for real time.
            for _ in 0..16 {
                tokio::task::yield_now().await;
            }
            self.now_ns += 10_000_000;
            self.conductor.step(self.now_ns);
            self.cues.try_iter().for_each(drop);
        }
    }

    /// Of each client's ids how many were accepted and how many ended.
    fn tally(&self, client: usize) -> BTreeMap<String, (usize, usize)> {
        let mut tally: BTreeMap<String, (usize, usize)> = BTreeMap::new();
        for answer in self.answers[client].lock().unwrap().iter() {
            let Some(id) = answer["id"].as_str() else {
                continue;
            };
            let (accepted, ended) = tally.entry(id.to_owned()).or_default();
            match answer["type"].as_str().unwrap() {
                "accepted" => *accepted += 1,
                "finished" | "stopped" => *ended += 1,
                "error" if answer["fatal"] == true => *ended += 1,
                _ => {}
            }
            assert!(*ended <= *accepted, "{id} ended before it was accepted");
        }
        tally
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn every_utterance_ends_once_whatever_clients_do(
        deeds in proptest::collection::vec((0_usize..3, deed()), 0..60),
        turns in prop::sample::select(vec![Turns::Queue, Turns::Replace, Turns::Refuse]),
    ) {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let mut stage = Stage::new(turns);
            let mut dead = [false; 3];
            for (client, deed) in &deeds {
                stage.act(*client, deed).await;
                dead[*client] |= matches!(deed, Deed::Die);
            }
            // What is still open is never closed by its client: time does it.
            stage.pass_ms(100_000).await;
            let sound = &stage.vitals.sound;
            prop_assert_eq!(sound.queue.get(), 0, "the queue is empty");
            let ended = sound.finished.get() + sound.stopped.get() + sound.failed.get();
            prop_assert_eq!(sound.begun.get(), ended);
            for client in 0..3 {
                if dead[client] {
                    continue; // it did not hear the end
                }
                for (id, (accepted, ended)) in stage.tally(client) {
                    prop_assert_eq!(accepted, ended, "{} of client {}", id, client);
                }
            }
            Ok(())
        })?;
    }
}
