//! Connections and the sound thread together, the latter on made-up time: whatever clients send in whatever
//! order, and however they go, every utterance that was accepted ends exactly once.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use proptest::prelude::*;
use serde_json::Value;
use tokio::io::{AsyncBufReadExt as _, AsyncWriteExt as _, BufReader, DuplexStream, WriteHalf};
use tokio::task::JoinHandle;

use super::*;
use crate::config::{Config, Turns};
use crate::live::conductor::by_hand::ByHand;
use crate::live::conductor::{Conductor, Cue};
use crate::live::rules::Rules;
use crate::live::vitals::Vitals;

/// Bytes under way between a client and its connection.
const PIPE_BYTES: usize = 1 << 16;
/// By then everything has ended: of each client 16 utterances wait at most, and one that gets nothing more
/// ends after half a minute.
const PATIENCE_MS: i64 = 600_000;
/// How often everybody has their turn before it is sure that nobody has anything left to do.
const TURNS: usize = 16;

/// What a client does.
#[derive(Clone, Debug)]
enum Deed {
    Line(&'static str),
    /// Half a line.
    Bytes(&'static [u8]),
    /// Sends no more, and reads on.
    Finish,
    /// Is gone without a word.
    Die,
    /// Milliseconds pass.
    Wait(i64),
}

const DEMO: &str = concat!(
    r#"{"type":"begin","id":"d","audio":{"file":""#,
    env!("CARGO_MANIFEST_DIR"),
    r#"/../tests/fixtures/demo.wav"}}"#
);

fn deed() -> impl Strategy<Value = Deed> {
    let lines = prop::sample::select(vec![
        r#"{"type":"begin","id":"a"}"#,
        r#"{"type":"begin","id":"b","audio":{"rate":8000}}"#,
        r#"{"type":"begin","id":"c","audio":{"file":"/nowhere.wav"}}"#,
        DEMO,
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

/// A client, and its connection.
struct Caller {
    write: Option<WriteHalf<DuplexStream>>,
    reader: JoinHandle<()>,
    /// What it was answered.
    answers: Arc<Mutex<Vec<Value>>>,
    served: JoinHandle<()>,
}

/// Three of them and the sound thread.
struct Stage {
    conductor: Conductor,
    cues: crossbeam::channel::Receiver<Cue>,
    vitals: Arc<Vitals>,
    now_ns: i64,
    clients: Vec<Caller>,
    /// The sound thread ends with the last of these.
    _handle: Handle,
}

/// Runs on one thread, with another one for files: see [`settle`].
fn run<T>(test: impl Future<Output = T>) -> T {
    let mut runtime = tokio::runtime::Builder::new_current_thread();
    let runtime = runtime.max_blocking_threads(1).enable_all().build();
    runtime.unwrap().block_on(test)
}

/// Waits until nobody has anything left to do but to wait for time or for each other. Files are read on one
/// thread, in turn, so those that were asked for before are read when that thread comes to what is asked here.
async fn settle() {
    for _ in 0..4 {
        for _ in 0..TURNS {
            tokio::task::yield_now().await;
        }
        tokio::task::spawn_blocking(|| ()).await.unwrap();
    }
}

impl Stage {
    fn new(turns: Turns) -> Self {
        let ByHand {
            conductor,
            commands,
            cues,
            vitals,
            now_ns,
        } = ByHand::new(Rules {
            turns,
            ..Rules::of(&Config::default())
        });
        let handle = Handle::new(commands, Arc::clone(&vitals));
        Self {
            conductor,
            cues,
            vitals,
            now_ns,
            clients: (0..3)
                .map(|number| Caller::connect(&handle, number))
                .collect(),
            _handle: handle,
        }
    }

    async fn act(&mut self, client: usize, deed: &Deed) {
        let caller = &mut self.clients[client];
        match deed {
            Deed::Line(line) => caller.send(format!("{line}\n").as_bytes()).await,
            Deed::Bytes(bytes) => caller.send(bytes).await,
            Deed::Finish => {
                if let Some(mut write) = caller.write.take() {
                    // Closed by the other end already, or now.
                    let _ = write.shutdown().await;
                }
            }
            Deed::Die => caller.die().await,
            Deed::Wait(ms) => self.pass_ms(*ms).await,
        }
        self.pass_ms(20).await;
    }

    async fn pass_ms(&mut self, ms: i64) {
        settle().await;
        for _ in 0..ms / 10 {
            for _ in 0..TURNS {
                tokio::task::yield_now().await;
            }
            self.now_ns += 10_000_000;
            self.conductor.step(self.now_ns);
            self.cues.try_iter().for_each(drop);
        }
        settle().await;
    }

    /// Lets time pass until nothing is spoken or waits.
    async fn pass_all(&mut self) {
        for _ in 0..PATIENCE_MS / 1000 {
            self.pass_ms(1000).await;
            if self.vitals.sound.queue.get() == 0 {
                return;
            }
        }
    }

    /// How many utterances were begun, and how they ended: finished, stopped, failed.
    fn ends(&self) -> (u64, [u64; 3]) {
        let sound = &self.vitals.sound;
        let [finished, stopped, failed] = [&sound.finished, &sound.stopped, &sound.failed];
        let ended = [finished.get(), stopped.get(), failed.get()];
        (sound.begun.get(), ended)
    }
}

impl Caller {
    fn connect(handle: &Handle, number: u64) -> Self {
        let (near, far) = tokio::io::duplex(PIPE_BYTES);
        let (read, write) = tokio::io::split(far);
        let terms = Terms {
            limits: Limits::default(),
            token: None,
            files: Files::Below("/".into()),
            write_patience: Duration::from_secs(5),
        };
        let peer = Peer::Lines((Box::new(read), Box::new(write)));
        let served = tokio::spawn(serve(peer, handle.clone(), terms, number));
        let (read, write) = tokio::io::split(near);
        let answers = Arc::new(Mutex::new(Vec::new()));
        let told = Arc::clone(&answers);
        let reader = tokio::spawn(async move {
            let mut lines = BufReader::new(read).lines();
            while let Ok(Some(line)) = lines.next_line().await {
                let answer = serde_json::from_str(&line).unwrap();
                told.lock().unwrap().push(answer);
            }
        });
        Self {
            write: Some(write),
            reader,
            answers,
            served,
        }
    }

    async fn send(&mut self, bytes: &[u8]) {
        if let Some(write) = &mut self.write {
            // A connection that was closed takes nothing.
            let _ = write.write_all(bytes).await;
        }
    }

    async fn die(&mut self) {
        self.write = None;
        self.reader.abort();
        // Its half is dropped with it.
        let _ = (&mut self.reader).await;
    }

    /// Of each of its ids how many were accepted and how many ended.
    fn tally(&self) -> BTreeMap<String, (usize, usize)> {
        let mut tally: BTreeMap<String, (usize, usize)> = BTreeMap::new();
        for answer in self.answers.lock().unwrap().iter() {
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
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn every_utterance_ends_once_whatever_clients_do(
        deeds in proptest::collection::vec((0_usize..3, deed()), 0..60),
        turns in prop::sample::select(vec![Turns::Queue, Turns::Replace, Turns::Refuse]),
    ) {
        run(async {
            let mut stage = Stage::new(turns);
            let (mut died, mut left) = ([false; 3], [false; 3]);
            for (client, deed) in &deeds {
                let deaf = died[*client] || stage.clients[*client].reader.is_finished();
                if deaf && matches!(deed, Deed::Die) {
                    continue;
                }
                stage.act(*client, deed).await;
                died[*client] |= matches!(deed, Deed::Die);
                left[*client] |= matches!(deed, Deed::Die | Deed::Finish);
            }
            // What is still open is never closed by its client: time does it.
            stage.pass_all().await;
            prop_assert_eq!(stage.vitals.sound.queue.get(), 0, "the queue is empty");
            let (begun, ends) = stage.ends();
            prop_assert_eq!(begun, ends.iter().sum::<u64>());
            for (number, caller) in stage.clients.iter().enumerate() {
                prop_assert_eq!(caller.served.is_finished(), left[number], "client {} is let go", number);
                if died[number] {
                    continue; // it did not hear the end
                }
                for (id, (accepted, ended)) in caller.tally() {
                    prop_assert_eq!(accepted, ended, "{} of client {}", id, number);
                }
            }
            Ok(())
        })?;
    }
}

const SENTENCE: &str = r#"{"type":"begin","id":"a"}
{"type":"phones","phones":[{"start":0,"end":0.5,"phone":"aa"}]}
"#;

/// What a client said before it went is spoken, though nobody takes the answers.
#[test]
fn who_leaves_without_reading_has_said_it_all_the_same() {
    for (last, then) in [
        // All of it, and gone before the first answer; and in the middle of a line, which is answered.
        ("{\"type\":\"end\"}\n", ""),
        ("{\"type\":\"end\"}\n", "{\"type\":\"pi"),
        ("", "{\"type\":\"pi"),
    ] {
        run(async {
            let mut stage = Stage::new(Turns::Queue);
            let caller = &mut stage.clients[0];
            caller
                .send(format!("{SENTENCE}{last}{then}").as_bytes())
                .await;
            caller.die().await;
            stage.pass_ms(2000).await;
            assert_eq!(stage.ends(), (1, [1, 0, 0]), "{last:?}, {then:?}");
            assert!(stage.clients[0].served.is_finished());
        });
    }
}

/// The same where the first answers were taken.
#[test]
fn who_dies_in_the_middle_of_a_line_has_ended_what_it_began() {
    run(async {
        let mut stage = Stage::new(Turns::Queue);
        stage.clients[0].send(SENTENCE.as_bytes()).await;
        stage.pass_ms(200).await;
        stage.clients[0].send(b"{\"type\":\"pho").await;
        stage.clients[0].die().await;
        stage.pass_ms(2000).await;
        assert_eq!(stage.ends(), (1, [1, 0, 0]));
    });
}
