//! Engines as they are installed; a test of one that is not is skipped, with a word.

use super::*;
use mouthpiece_phonemes::Phone;

/// Bilabials at the beginning, within words and across them, and a pause.
const TEXT: &str = "Bob, my puppy: keep the map by the lamp! Papa may bump into people.";
/// How many closures of the lips it has at least: /p b m/, fewer where neighbours merge.
const BILABIALS: usize = 15;

/// What `engine` makes of [`TEXT`], none where it is not installed.
fn speak(engine: Engine) -> Option<Spoken> {
    match engine.speak(TEXT, None) {
        Ok(spoken) => Some(spoken),
        Err(error @ VoiceError::Missing { .. }) => {
            eprintln!("skipped: {error}");
            None
        }
        Err(VoiceError::Failed { why, .. }) if engine == Engine::Piper => {
            eprintln!("skipped: {why}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Labels that cover the sound, with all bilabials, and rest where it is silent.
fn check(spoken: &Spoken) {
    let segments = &spoken.labels.segments;
    let ticks = spoken.sound.frames.len() as i64;
    assert_eq!(segments.last().map(|s| s.end), Some(ticks));
    assert!(segments.windows(2).all(|s| s[0].end == s[1].start));
    assert!((2 * 48_000..9 * 48_000).contains(&ticks), "{ticks}");
    let lips = segments
        .iter()
        .filter(|s| matches!(s.phone, Phone::P | Phone::B | Phone::M));
    assert!(lips.count() >= BILABIALS, "{segments:?}");
    assert!(spoken.labels.notes.is_empty(), "{:?}", spoken.labels.notes);
    // Labels in step with the sound: it is far louder in vowels than in pauses.
    let loudness = |wanted: fn(Phone) -> bool| {
        let (mut sum, mut count) = (0.0, 1.0);
        for s in segments.iter().filter(|s| wanted(s.phone)) {
            for x in &spoken.sound.frames[s.start as usize..s.end as usize] {
                sum += f64::from(x * x);
                count += 1.0;
            }
        }
        (sum / count).sqrt()
    };
    let (vowels, pauses) = (loudness(Phone::is_vowel), loudness(Phone::is_silence));
    assert!(vowels > 8.0 * pauses, "{vowels} {pauses}");
}

#[test]
fn flite_speaks() {
    let Some(spoken) = speak(Engine::Flite) else {
        return;
    };
    check(&spoken);
    // `kal16` cuts its last pause; labels are cut with it.
    check(&Engine::Flite.speak(TEXT, Some("kal16")).unwrap());
    let error = Engine::Flite.speak(TEXT, Some("nobody")).unwrap_err();
    assert!(error.to_string().contains("slt"), "{error}");
}

#[test]
fn espeak_speaks_and_closures_hold_the_silence() {
    let Some(spoken) = speak(Engine::EspeakNg) else {
        return;
    };
    check(&spoken);
    let segments = &spoken.labels.segments;
    let mut closures = 0;
    for pair in segments.windows(2) {
        if matches!(pair[1].phone, Phone::P | Phone::T | Phone::K) && pair[0].phone.is_closure() {
            closures += 1;
            let (start, end) = (pair[0].start as usize, pair[0].end as usize);
            let milliseconds = (end - start) / 48;
            assert!((12..=60).contains(&milliseconds), "{pair:?}");
            let loudest = spoken.sound.frames[start + 96..end - 96]
                .iter()
                .fold(0.0_f32, |a, x| a.max(x.abs()));
            assert!(loudest < 0.01, "{pair:?}: {loudest}");
        }
    }
    assert!(closures >= 8, "{closures} of {segments:?}");
    let error = Engine::EspeakNg.speak(TEXT, Some("nobody")).unwrap_err();
    assert!(error.to_string().contains("--voices"), "{error}");
}

#[test]
fn festival_speaks() {
    let Some(spoken) = speak(Engine::Festival) else {
        return;
    };
    check(&spoken);
    let hostile = r#"She said "stop" \ ") (exit) ("#;
    assert!(Engine::Festival.speak(hostile, None).is_ok());
    let error = Engine::Festival.speak(TEXT, Some("nobody")).unwrap_err();
    assert!(matches!(error, VoiceError::NoVoice { .. }), "{error}");
    assert!(error.to_string().contains("kal_diphone"), "{error}");
}

#[test]
fn piper_speaks_the_same_every_time() {
    let Some(spoken) = speak(Engine::Piper) else {
        return;
    };
    check(&spoken);
    let again = speak(Engine::Piper).unwrap();
    assert_eq!(again.sound, spoken.sound);
    let error = Engine::Piper.speak(TEXT, Some("nobody")).unwrap_err();
    assert!(matches!(error, VoiceError::NoVoice { .. }), "{error}");
}

/// The demo's words are found within its sound near where its labels say.
#[test]
fn a_recording_is_aligned_with_its_text() {
    let demo = crate::input::Utterance::demo().unwrap();
    let sound = Sound {
        frames: demo.sound.as_deref().unwrap().to_vec(),
    };
    let text = "Hello, I'm Mouthpiece. Give me your words and a voice, and I will bring them to life: \
                lips, jaw, and the tip of my tongue.";
    let spoken = match align(text, sound.clone(), "demo.wav") {
        Err(error @ VoiceError::Missing { .. }) => return eprintln!("skipped: {error}"),
        other => other.unwrap(),
    };
    let starts = |segments: &[Segment]| {
        let is_closing = |s: &&Segment| matches!(s.phone, Phone::M | Phone::Pcl | Phone::Bcl);
        let closing = segments.iter().filter(is_closing);
        closing.map(|s| s.start).collect::<Vec<_>>()
    };
    let found = starts(&spoken.labels.segments);
    let labelled = starts(&demo.segments);
    assert_eq!(found.len(), labelled.len());
    let mut off: Vec<i64> = found
        .iter()
        .zip(&labelled)
        .map(|(a, b)| (a - b).abs() / 48)
        .collect();
    off.sort_unstable();
    // Of "I'm Mouthpiece" nobody can tell where one /m/ ends and the other begins.
    assert!(off[off.len() - 2] <= 15, "{off:?} ms");
    let wrong = "There is another sentence altogether, and it is about something else, I believe.";
    let error = align(wrong, sound, "demo.wav").unwrap_err();
    assert!(matches!(error, VoiceError::NoFit { .. }), "{error}");
}

#[test]
fn text_that_says_nothing_or_too_much_is_refused() {
    assert!(matches!(
        Engine::Flite.speak(" ?!\n", None),
        Err(VoiceError::NoText)
    ));
    let long = "a ".repeat(TEXT_BYTES_MAX);
    assert!(matches!(
        Engine::Flite.speak(&long, None),
        Err(VoiceError::TextTooLong)
    ));
}
