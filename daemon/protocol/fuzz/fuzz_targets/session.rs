//! Any bytes as what a client sends, in pieces of any size, as lines or as frames of a WebSocket, with or
//! without a token, while utterances end at any moment: nothing panics, each accepted utterance is begun, closed and ended
//! once, and how the bytes were cut changes nothing.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mouthpiece_protocol::{Action, DaemonMessage, Limits, Session, Token};

/// So many bytes of the input say how it comes: what kind of client, how long the pieces are.
const HEAD: usize = 4;
const TOKEN: &str = "0123456789abcdef";

fuzz_target!(|input: &[u8]| {
    let (head, bytes) = input.split_at(HEAD.min(input.len()));
    let kind = head.first().copied().unwrap_or(0);
    let whole = lines(kind, bytes, &[]);
    check(&whole, kind & 2 == 0);
    assert_eq!(lines(kind, bytes, &head[1.min(head.len())..]), whole);
    check(&frames(kind, bytes), kind & 2 == 0);
});

fn session(kind: u8) -> Session {
    // Small bounds are met sooner.
    let limits = Limits {
        line_bytes: 256,
        phones_per_message: 4,
        phones_per_utterance: 16,
        utterance_seconds: 2,
        pending: 3,
        files: kind & 4 != 0,
        ..Limits::default()
    };
    match (kind & 1, Token::new(TOKEN)) {
        (1, Ok(token)) => Session::guarded(limits, token),
        _ => Session::new(limits),
    }
}

/// All of `bytes` as a stream of lines, in pieces as long as `cuts` say, in turn.
fn lines(kind: u8, bytes: &[u8], cuts: &[u8]) -> Vec<Action> {
    let mut session = session(kind);
    let mut all = Vec::new();
    let mut rest = bytes;
    for cut in cuts.iter().cycle().take(bytes.len()) {
        let (piece, after) = rest.split_at(usize::from(*cut).min(rest.len()));
        session.receive(piece, &mut all);
        rest = after;
    }
    session.receive(rest, &mut all);
    session.closed(&mut all);
    all
}

/// The same as frames, one a line; what is no text is sound. The daemon ends utterances as they come.
fn frames(kind: u8, bytes: &[u8]) -> Vec<Action> {
    let mut session = session(kind);
    let mut all = Vec::new();
    for (n, line) in bytes.split(|b| *b == b'\n').enumerate() {
        match std::str::from_utf8(line) {
            Ok(text) => session.receive_text(text, &mut all),
            Err(_) => session.receive_sound(line, &mut all),
        }
        let last = all.iter().rev().find_map(|action| match action {
            Action::Begin { id, .. } => Some(id.clone()),
            _ => None,
        });
        if let Some(id) = last.filter(|_| kind & 2 != 0 && n % 3 == 2) {
            session.ended(&id);
            assert!(!session.ended(&id), "an end is told once");
        }
    }
    session.closed(&mut all);
    all
}

/// Whether actions follow one another as they must; `whole` when no utterance was ended from outside.
fn check(actions: &[Action], whole: bool) {
    let mut open: Option<&str> = None;
    let mut labelled = 0;
    let mut accepted = 0;
    for action in actions {
        match action {
            Action::Reply(message) => {
                assert!(message.line().len() < 2000, "{message:?}");
                accepted += usize::from(matches!(message, DaemonMessage::Accepted { .. }));
            }
            Action::Begin { id, .. } => {
                assert!(accepted > 0, "begun and not accepted");
                assert!(open.is_none() || !whole, "two are open");
                (open, labelled) = (Some(id.as_str()), 0);
            }
            Action::Segments { id, segments } => {
                assert_eq!(open, Some(id.as_str()));
                for segment in segments {
                    assert!(segment.start >= labelled && segment.end > segment.start);
                    labelled = segment.end;
                }
            }
            Action::Audio { id, mono } => {
                assert_eq!(open, Some(id.as_str()));
                assert!(mono.iter().all(|x| (-1.0..=1.0).contains(x)));
            }
            Action::End { id } => {
                assert_eq!(open, Some(id.as_str()));
                open = None;
            }
            Action::Caption { id, text, .. } => {
                assert!(id.is_none() || open == id.as_deref());
                assert!(!text.contains(char::is_control));
            }
            _ => {}
        }
    }
    assert!(open.is_none() || !whole, "the end of the stream closes what is open");
}
