//! Conversations, legal and not: what a session makes of lines that come whole, in pieces, or broken.

use super::*;
use proptest::prelude::*;

/// What comes of these lines, errors shortened to their code.
fn talk(session: &mut Session, lines: &[&str]) -> Vec<String> {
    let mut out = Vec::new();
    for line in lines {
        session.receive(line.as_bytes(), &mut out);
        session.receive(b"\n", &mut out);
    }
    out.iter().map(told).collect()
}

fn told(action: &Action) -> String {
    match action {
        Action::Reply(DaemonMessage::Error { code, .. }) => format!("error {code:?}"),
        Action::Reply(DaemonMessage::Accepted { id }) => format!("accepted {id}"),
        Action::Reply(DaemonMessage::Pong { .. }) => "pong".to_owned(),
        Action::Reply(DaemonMessage::Hello { .. }) => "hello".to_owned(),
        Action::Reply(DaemonMessage::Warning { .. }) => "warning".to_owned(),
        Action::Reply(other) => format!("{other:?}"),
        Action::Begin { id, sound } => format!("begin {id} {sound:?}"),
        Action::Segments { id, segments } => {
            let spans: Vec<String> = segments
                .iter()
                .map(|s| format!("{}..{} {}", s.start, s.end, s.phone))
                .collect();
            format!("{id} {}", spans.join(", "))
        }
        Action::Audio { id, mono } => format!("{id} {} samples", mono.len()),
        Action::End { id } => format!("end {id}"),
        Action::Stop { id } => format!("stop {id:?}"),
        Action::Express(face) => format!("express {:?}", face.expression),
        Action::Look(look) => format!("look {:?}", look.at),
        Action::State(state) => format!("state {state:?}"),
        Action::Caption { id, start, text } => format!("caption {id:?} {start} {text}"),
        Action::Close => "close".to_owned(),
    }
}

#[test]
fn an_utterance_is_opened_filled_and_closed() {
    let mut session = Session::new(Limits::default());
    let said = talk(
        &mut session,
        &[
            r#"{"type":"begin","id":"u","audio":{"rate":16000}}"#,
            r#"{"type":"phones","phones":[{"start":0,"end":0.1,"phone":"h#"},{"start":0.1,"end":0.25,"phone":"aa","stress":1}]}"#,
            r#"{"type":"audio","data":"AAAAAA=="}"#,
            r#"{"type":"end"}"#,
            r#"{"type":"end"}"#,
        ],
    );
    assert_eq!(
        said,
        [
            "accepted u",
            "begin u Sent(Pcm { rate: 16000, channels: 1, format: S16 })",
            "u 0..4800 h#, 4800..12000 aa",
            "u 2 samples",
            "end u",
            "error State",
        ]
    );
    assert!(session.has_pending());
    assert!(session.ended("u"));
    assert!(!session.ended("u"), "an end is told once");
}

#[test]
fn timit_lines_are_an_utterance_of_their_own() {
    let mut session = Session::new(Limits::default());
    let said = talk(
        &mut session,
        &[
            "",
            "0 1600 h#",
            "1600 3200 aa",
            "nonsense",
            "3200 3100 b",
            "",
            "0 10 q",
        ],
    );
    assert_eq!(
        said,
        [
            "accepted timit-1",
            "begin timit-1 Silent",
            "timit-1 0..4800 h#",
            "timit-1 4800..9600 aa",
            "error Malformed",
            "error Label",
            "end timit-1",
            "accepted timit-2",
            "begin timit-2 Silent",
            "timit-2 0..30 q",
        ]
    );
    let mut out = Vec::new();
    session.receive(b"10 20 aa", &mut out);
    session.closed(&mut out);
    assert_eq!(
        out.iter().map(told).collect::<Vec<_>>(),
        ["timit-2 30..60 aa", "end timit-2"],
        "a last line without its newline counts"
    );
}

#[test]
fn what_still_comes_for_a_stopped_utterance_is_ignored() {
    let mut session = Session::new(Limits::default());
    talk(
        &mut session,
        &[r#"{"type":"begin","id":"u","audio":{"rate":16000}}"#],
    );
    assert!(session.ended("u"));
    let said = talk(
        &mut session,
        &[
            r#"{"type":"audio","data":"AAAA"}"#,
            r#"{"type":"phones","phones":[]}"#,
            r#"{"type":"end"}"#,
            r#"{"type":"begin","id":"u"}"#,
        ],
    );
    assert_eq!(said, ["accepted u", "begin u Silent"]);
}

#[test]
fn every_limit_is_answered_and_the_connection_goes_on() {
    let mut session = Session::new(Limits {
        line_bytes: 200,
        phones_per_message: 2,
        phones_per_utterance: 3,
        utterance_seconds: 1,
        pending: 1,
        files: false,
        ..Limits::default()
    });
    let long = "x".repeat(201);
    let id = format!(r#"{{"type":"begin","id":"{}"}}"#, "i".repeat(65));
    let label = |start: f64, end: f64| format!(r#"{{"start":{start},"end":{end},"phone":"m"}}"#);
    let phones =
        |labels: &[String]| format!(r#"{{"type":"phones","phones":[{}]}}"#, labels.join(","));
    let said = talk(
        &mut session,
        &[
            &long,
            &id,
            r#"{"type":"begin","id":"f","audio":{"file":"/a.wav"}}"#,
            r#"{"type":"begin","id":"r","audio":{"rate":7999}}"#,
            r#"{"type":"begin","id":"c","audio":{"rate":8000,"channels":9}}"#,
            r#"{"type":"begin","id":"u"}"#,
            &phones(&[label(0.0, 0.1), label(0.1, 0.2), label(0.2, 0.3)]),
            &phones(&[label(0.0, 0.1), label(0.1, 0.2)]),
            &phones(&[label(0.2, 0.3), label(0.3, 0.4)]),
            &phones(&[label(0.2, 1.1)]),
            r#"{"type":"end"}"#,
            r#"{"type":"begin","id":"v"}"#,
            r#"{"type":"ping"}"#,
        ],
    );
    assert_eq!(
        said,
        [
            "error Limit",
            "error Limit",
            "error Audio",
            "error Audio",
            "error Audio",
            "accepted u",
            "begin u Silent",
            "error Limit",
            "u 0..4800 m, 4800..9600 m",
            "error Limit",
            "error Limit",
            "end u",
            "error Limit",
            "pong",
        ]
    );
}

#[test]
fn a_refused_message_changes_nothing() {
    let mut session = Session::new(Limits::default());
    let said = talk(
        &mut session,
        &[
            r#"{"type":"begin","id":"u","label_rate":8000}"#,
            r#"{"type":"phones","phones":[{"start":0,"end":80,"phone":"b"},{"start":80,"end":90,"phone":"b","stress":3}]}"#,
            r#"{"type":"phones","phones":[{"start":0,"end":80,"phone":"b"},{"start":79,"end":90,"phone":"aa"}]}"#,
            r#"{"type":"phones","phones":[{"start":0.5,"end":80,"phone":"b"}]}"#,
            r#"{"type":"phones","phones":[{"start":0,"end":80,"phone":"b"}]}"#,
            r#"{"type":"audio","data":""}"#,
            r#"{"type":"begin","id":"v"}"#,
            r#"{"type":"begin","id":"v","colour":1}"#,
            r#"{"type":"stop","id":"v"}"#,
            "0 1 aa",
        ],
    );
    assert_eq!(
        said,
        [
            "accepted u",
            "begin u Silent",
            "error Label",
            "error Label",
            "error Label",
            "u 0..480 b",
            "error State",
            "error State",
            "error Malformed",
            "error State",
            "error State",
        ]
    );
}

#[test]
fn labels_of_any_alphabet_become_phones_and_strange_ones_the_nearest() {
    let mut session = Session::new(Limits::default());
    let said = talk(
        &mut session,
        &[
            r#"{"type":"begin","id":"u","alphabet":"ipa"}"#,
            r#"{"type":"phones","phones":[{"start":0,"end":0.1,"phone":"ʃ"},{"start":0.1,"end":0.2,"phone":"ɬ"}]}"#,
            r#"{"type":"phones","phones":[{"start":0.2,"end":0.3,"phone":"ɬ"},{"start":0.3,"end":0.4,"phone":"aɪɚ"}]}"#,
            r#"{"type":"end"}"#,
            r#"{"type":"begin","id":"v","alphabet":"klingon"}"#,
            r#"{"type":"begin","id":"w"}"#,
            r#"{"type":"phones","phones":[{"start":0,"end":0.1,"phone":"zz9"}]}"#,
        ],
    );
    let phones: Vec<&str> = said.iter().map(|s| s.split(' ').next().unwrap()).collect();
    assert_eq!(said[2], "warning", "{said:?}");
    assert!(said[3].starts_with("u 0..4800 sh, 4800..9600 "), "{said:?}");
    // Told once; a triphthong is two phones within its label.
    assert_eq!(said[4].matches("..").count(), 3, "{said:?}");
    assert_eq!(
        phones[5..],
        ["end", "error", "accepted", "begin", "warning", "w"]
    );
}

#[test]
fn faces_and_captions_are_checked_and_captions_go_with_their_utterance() {
    let mut session = Session::new(Limits::default());
    let said = talk(
        &mut session,
        &[
            r#"{"type":"express","expression":"smile","weight":0.5}"#,
            r#"{"type":"express"}"#,
            r#"{"type":"express","expression":"smile","muscles":{}}"#,
            r#"{"type":"express","expression":"smile","weight":2}"#,
            r#"{"type":"express","expression":"smile","fade_s":-1}"#,
            r#"{"type":"look","at":[1,2,300]}"#,
            r#"{"type":"look","at":[1,2,0]}"#,
            r#"{"type":"look"}"#,
            r#"{"type":"state","state":"thinking"}"#,
            r#"{"type":"state","state":"dancing"}"#,
            r#"{"type":"caption","text":"now\nhere"}"#,
            r#"{"type":"begin","id":"u"}"#,
            r#"{"type":"caption","text":"one"}"#,
            r#"{"type":"caption","text":"two","start":1.5}"#,
            r#"{"type":"caption","text":"before","start":1}"#,
        ],
    );
    assert_eq!(
        said,
        [
            "express Some(\"smile\")",
            "express None",
            "error Face",
            "error Face",
            "error Face",
            "look Some([1.0, 2.0, 300.0])",
            "error Face",
            "look None",
            "state Thinking",
            "error Malformed",
            "caption None 0 now here",
            "accepted u",
            "begin u Silent",
            "caption Some(\"u\") 0 one",
            "caption Some(\"u\") 72000 two",
            "error Label",
        ]
    );
}

#[test]
fn a_stranger_gets_nothing_but_a_greeting_until_the_token_comes() {
    let token = || Token::new("0123456789abcdef").unwrap();
    let mut session = Session::guarded(Limits::default(), token());
    let long = "x".repeat(limits::STRANGER_LINE_BYTES_MAX + 1);
    let said = talk(
        &mut session,
        &[
            r#"{"type":"hello","version":1}"#,
            r#"{"type":"hello","version":99}"#,
            r#"{"type":"stop"}"#,
            "0 100 aa",
            &long,
            r#"{"type":"auth","token":"0123456789abcdef"}"#,
            r#"{"type":"ping"}"#,
        ],
    );
    assert_eq!(
        said,
        [
            "hello",
            "error Version",
            "error Auth",
            "error Auth",
            "error Auth",
            "hello",
            "pong"
        ]
    );
    let mut session = Session::guarded(Limits::default(), token());
    let said = talk(
        &mut session,
        &[
            r#"{"type":"auth","token":"0123456789abcdeF"}"#,
            r#"{"type":"auth","token":"0123456789abcdef"}"#,
        ],
    );
    assert_eq!(said, ["error Auth", "close"]);
    assert!(!session.is_trusted());
}

#[test]
fn frames_of_a_websocket_are_lines_and_sound() {
    let mut session = Session::new(Limits::default());
    let mut out = Vec::new();
    session.receive_sound(&[0, 0], &mut out);
    session.receive_text(
        r#"{"type":"begin","id":"u","audio":{"rate":8000}}"#,
        &mut out,
    );
    session.receive_sound(&[0, 0, 1], &mut out);
    session.receive_sound(&[1], &mut out);
    session.receive_text("{\"type\":\"end\"}\n{\"type\":\"ping\"}\n", &mut out);
    let said: Vec<String> = out.iter().map(told).collect();
    assert_eq!(said[0], "error State");
    assert_eq!(said[3..], ["u 1 samples", "u 1 samples", "end u", "pong"]);
    assert_eq!(session.taken(), 6);
}

/// Lines of clients, good and bad.
fn line() -> impl Strategy<Value = Vec<u8>> {
    let fixed = prop::sample::select(vec![
        r#"{"type":"begin","id":"a"}"#,
        r#"{"type":"begin","id":"b","audio":{"rate":8000,"format":"f32","channels":2}}"#,
        r#"{"type":"phones","phones":[{"start":0.2,"end":0.3,"phone":"m"}]}"#,
        r#"{"type":"audio","data":"AAAAAAAAAAAA"}"#,
        r#"{"type":"end"}"#,
        r#"{"type":"stop"}"#,
        r#"{"type":"stop","id":"a"}"#,
        r#"{"type":"ping","token":"t"}"#,
        r#"{"type":"hello","version":1,"client":"c"}"#,
        r#"{"type":"auth","token":"anything"}"#,
        r#"{"type":"express","expression":"smile"}"#,
        r#"{"type":"look","at":[0,0,1]}"#,
        r#"{"type":"state","state":"listening"}"#,
        r#"{"type":"caption","text":"t","start":1}"#,
        "",
        "0 100 aa",
        "100 200 b\r",
        "{",
    ]);
    prop_oneof![
        8 => fixed.prop_map(|s| s.as_bytes().to_vec()),
        1 => proptest::collection::vec(any::<u8>(), 0..40),
    ]
}

proptest! {
    /// Whatever comes, cut wherever: never a panic, each begun utterance is ended or still open,
    /// nothing is said of one that was not begun, and the cuts change nothing.
    #[test]
    fn any_bytes_leave_a_defined_state(
        lines in proptest::collection::vec(line(), 0..40),
        piece in 1_usize..50,
    ) {
        let bytes = lines.join(&b'\n');
        let mut whole = Vec::new();
        let mut session = Session::new(Limits::default());
        session.receive(&bytes, &mut whole);
        session.closed(&mut whole);

        let mut cut = Vec::new();
        let mut session = Session::new(Limits::default());
        for part in bytes.chunks(piece) {
            session.receive(part, &mut cut);
        }
        session.closed(&mut cut);
        prop_assert_eq!(&whole, &cut);

        let mut open: Option<&str> = None;
        for action in &whole {
            match action {
                Action::Begin { id, .. } => {
                    prop_assert!(open.is_none());
                    open = Some(id);
                }
                Action::Segments { id, segments } => {
                    prop_assert_eq!(open, Some(id.as_str()));
                    prop_assert!(segments.windows(2).all(|w| w[0].end <= w[1].start));
                }
                Action::Audio { id, .. } => prop_assert_eq!(open, Some(id.as_str())),
                Action::End { id } => {
                    prop_assert_eq!(open, Some(id.as_str()));
                    open = None;
                }
                _ => {}
            }
        }
        prop_assert!(open.is_none(), "the end of the stream closes what is open");
    }

    /// Every line that is not empty is answered or acted on, except where the rule says ignored.
    #[test]
    fn no_line_is_lost(line in line()) {
        let text = String::from_utf8_lossy(&line).into_owned();
        prop_assume!(!line.contains(&b'\n') && !text.trim().is_empty());
        let mut session = Session::new(Limits::default());
        let mut out = Vec::new();
        session.receive(&line, &mut out);
        session.receive(b"\n", &mut out);
        prop_assert!(!out.is_empty(), "{text}");
    }
}
