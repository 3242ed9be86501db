//! Guards how words sound and where their phones fall: real sentences against the CMU dictionary's
//! phones, times of words and of characters, a user's dictionary; and that no text makes it fail.

mod material;

use std::path::Path;
use std::sync::Arc;

use mouthpiece_phonemes::pronounce::{Pronouncer, Said};
use mouthpiece_phonemes::{
    Phone, ReadOptions, Segment, Source, Stress, TICK_RATE, Word, pronounce, read, read_file,
    spread,
};
use proptest::prelude::*;

fn codes(said: &[Said]) -> String {
    let codes: Vec<&str> = said.iter().map(|(phone, _)| phone.code()).collect();
    codes.join(" ")
}

fn sentence(text: &str) -> String {
    let words = text.split(' ').map(|word| codes(&pronounce(word)));
    words
        .filter(|word| !word.is_empty())
        .collect::<Vec<_>>()
        .join(" | ")
}

#[test]
fn sentences_sound_as_the_cmu_dictionary_says() {
    for (text, phones) in [
        (
            "She had your dark suit in greasy wash water all year.",
            "sh iy | hh ae d | y ao r | d aa r k | s uw t | ix n | g r iy s iy | w aa sh | w ao t axr | ao l | y ih r",
        ),
        (
            "“Don't ask me to carry an oily rag like that,” Dr. Brown said — 3 times!",
            "d ow n t | ae s k | m iy | t uw | k ae r iy | ae n | oy l iy | r ae g | l ay k | dh ae t | d aa k t axr | b r aw n | s eh d | th r iy | t ay m z",
        ),
        // No common word: with an ending, of two, by rule.
        (
            "The mouthpiece's phonemes mumbled: blorp.",
            "dh ax | m aw th p iy s ix z | f ow n iy m z | m ah m b ax l d | b l ao r p",
        ),
        (
            "In 1990 the BBC paid $2.50.",
            "ix n | n ay n t iy n n ay n t iy | dh ax | b iy b iy s iy | p ey d | t uw d aa l axr z f ih f t iy s eh n t s",
        ),
    ] {
        assert_eq!(sentence(text), phones, "{text}");
    }
}

#[test]
fn every_word_that_has_a_vowel_has_one_main_stress() {
    for word in [
        "banana",
        "photography",
        "snowman",
        "blorp",
        "Tchaikovsky",
        "zzz",
        "McDonald",
        "b",
    ] {
        let said = pronounce(word);
        assert!(!said.is_empty(), "{word}");
        let vowel = said.iter().any(|(phone, _)| phone.is_vowel());
        let main = said.iter().filter(|s| s.1 == Some(Stress::Primary)).count();
        assert_eq!(main, usize::from(vowel), "{word}: {said:?}");
    }
}

#[test]
fn words_in_other_scripts_move_the_mouth_too() {
    assert_eq!(codes(&pronounce("Müller")), codes(&pronounce("muller")));
    assert_eq!(codes(&pronounce("мама")), "m aa m aa");
    assert_eq!(codes(&pronounce("νέα")), "n eh aa");
    for word in ["東京", "नमस्ते", "שלום", "مرحبا", "한국", "ở"] {
        let said = pronounce(word);
        assert!(
            said.iter().any(|(phone, _)| phone.is_vowel()),
            "{word}: {said:?}"
        );
        assert!(
            !said.iter().any(|(phone, _)| phone.is_bilabial()),
            "{word}: {said:?}"
        );
    }
}

#[test]
fn a_users_dictionary_goes_first() {
    let mut pronouncer = Pronouncer::new();
    let notes = pronouncer.add_dictionary("BOB  B OW1 B\nmouthpiece  B IY1 P\n");
    assert_eq!(notes, []);
    assert_eq!(codes(&pronouncer.pronounce("Bob,")), "b ow b");
    assert_eq!(codes(&pronouncer.pronounce("mouthpiece")), "b iy p");
    assert_eq!(codes(&pronouncer.pronounce("cat")), "k ae t");
}

fn word(text: &str, start: i64, end: i64) -> Word {
    Word {
        text: text.to_owned(),
        start,
        end,
    }
}

fn shown(segments: &[Segment]) -> String {
    let each = segments
        .iter()
        .map(|s| format!("{} {}-{}", s.phone, s.start, s.end));
    each.collect::<Vec<_>>().join(", ")
}

#[test]
fn phones_fill_their_words_and_no_more() {
    let words = [
        word("bob", 0, 14_400),
        // A comma, a word without time, and one that overlaps.
        word(",", 14_400, 20_000),
        word("a", 20_000, 20_000),
        word("may", 14_000, 28_800),
        // A source that counts the pause into the word.
        word("be", 28_800, 28_800 + 3 * TICK_RATE),
    ];
    let segments = spread(&words);
    let at = |phone: Phone| segments.iter().find(|s| s.phone == phone).unwrap();
    assert_eq!(segments[0].start, 0);
    assert_eq!(segments[2].end, 14_400);
    assert_eq!(at(Phone::M).start, 14_400, "{}", shown(&segments));
    assert_eq!(at(Phone::Ey).end, 28_800);
    assert_eq!(at(Phone::Ey).stress, Some(Stress::Primary));
    let pause = at(Phone::Pau);
    assert_eq!(pause.end, 28_800 + 3 * TICK_RATE);
    assert!(pause.start < 28_800 + TICK_RATE, "{}", shown(&segments));
    // The vowel has more of the time than a consonant.
    assert!(at(Phone::Aa).duration() > segments[0].duration());
}

/// Words and phones that an aligner found in a recording: when only the words are given, phones
/// must fall near to where it heard them.
#[test]
fn phones_fall_near_where_an_aligner_heard_them() {
    let (Some(words), Some(segs)) = (
        material::text("generated_formats/s1.festival.words"),
        material::text("generated_formats/s1.festival.lab"),
    ) else {
        return;
    };
    let ends = |text: &str| -> Vec<(i64, String)> {
        let rows = text.lines().filter_map(|line| {
            let mut fields = line.split_whitespace();
            let end: f64 = fields.next()?.parse().ok()?;
            Some(((end * 48_000.0).round() as i64, fields.nth(1)?.to_owned()))
        });
        rows.collect()
    };
    let segs = ends(&segs);
    // A word starts where the one before it ends, but for the pause in front.
    let pauses = |end: i64| segs.iter().any(|s| s.0 == end && s.1 == "pau");
    let mut at = segs[0].0;
    let mut given = Vec::new();
    for (end, text) in ends(&words) {
        let pause = segs.iter().find(|s| s.0 > at && s.0 < end && s.1 == "pau");
        let start = pause.map_or(at, |pause| pause.0);
        assert!(start == at || pauses(start));
        given.push(word(&text, start, end));
        at = end;
    }
    let found = spread(&given);
    let mut heard = segs.iter().filter(|s| s.1 != "pau").peekable();
    let mut errors = Vec::new();
    for segment in found.iter().filter(|s| !s.phone.is_silence()) {
        if let Some(next) = heard.next() {
            errors.push((segment.end - next.0).abs());
        }
    }
    let mean = errors.iter().sum::<i64>() / errors.len() as i64;
    println!("ends of phones differ by {} ms on average", mean / 48);
    assert!(mean < 40 * 48, "{} ms", mean / 48);
}

/// A project's utterance, spoken by Piper or espeak-ng, or by a person: its words, and where its
/// phones were said.
fn labelled(words: &Path, phones: &Path) -> (Vec<Word>, Vec<Segment>) {
    let read = |path: &Path| match read_file(path, None, &ReadOptions::default()) {
        Ok(labels) => labels,
        Err(error) => panic!("{error}"),
    };
    (read(words).words, read(phones).segments)
}

/// Mean error of the inner ends of phones in words, in ms: as spread, and were all phones alike.
fn errors((words, heard): &(Vec<Word>, Vec<Segment>)) -> (i64, i64) {
    let found = spread(words);
    let (mut count, mut ours, mut alike) = (0, 0, 0);
    for word in words {
        let inside = |all: &[Segment]| -> Vec<i64> {
            let sounds = all
                .iter()
                .filter(|s| !s.phone.is_silence() && !s.phone.is_closure());
            let within = sounds.filter(|s| word.start <= s.start && s.end <= word.end);
            within.map(|s| s.end).collect()
        };
        let (found, heard) = (inside(&found), inside(heard));
        // Said otherwise than the dictionary has it.
        if found.len() != heard.len() {
            continue;
        }
        let all = heard.len() as i64;
        for ((number, heard), found) in (1..all).zip(&heard).zip(&found) {
            let even = word.start + (word.end - word.start) * number / all;
            count += 1;
            ours += (found - heard).abs();
            alike += (even - heard).abs();
        }
    }
    assert!(count > 5);
    (ours / count / 48, alike / count / 48)
}

#[test]
fn phones_are_placed_better_than_by_equal_shares() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures");
    let ours = ["demo", "espeak"].map(|name| {
        let file = fixtures.join(name);
        (file.with_extension("WRD"), file.with_extension("PHN"))
    });
    let mary = material::path("praatio/mary.TextGrid").map(|file| (file.clone(), file));
    for (words, phones) in ours.into_iter().chain(mary) {
        let (spread, alike) = errors(&labelled(&words, &phones));
        println!("{}: {spread} ms, alike {alike} ms", words.display());
        assert!(spread < alike, "{}: {spread}, {alike}", words.display());
        assert!(spread <= 25, "{}: {spread} ms", words.display());
    }
}

proptest! {
    #[test]
    fn any_words_at_any_times_give_phones_in_order(
        words in prop::collection::vec(("\\PC{0,20}|[A-Za-z0-9$%.,:'-]{0,12}", -100_000_i64..100_000, -10_i64..50_000), 0..12),
    ) {
        let words: Vec<Word> = words.iter().map(|(text, start, ticks)| word(text, *start, start + ticks)).collect();
        let segments = spread(&words);
        for pair in segments.windows(2) {
            prop_assert!(pair[0].end <= pair[1].start);
        }
        for segment in &segments {
            prop_assert!(segment.start < segment.end);
            prop_assert!(words.iter().any(|w| w.start <= segment.start && segment.end <= w.end));
        }
    }

    #[test]
    fn any_dictionary_can_be_added(text in "(\\PC{0,30}\n){0,10}|([a-z(2)]{1,6}[ \t]+([A-Z]{1,2}[0-2]? ?){0,5}\r?\n){0,10}") {
        let mut pronouncer = Pronouncer::new();
        pronouncer.add_dictionary(&text);
        pronouncer.pronounce("bob");
    }
}

#[test]
fn readers_of_words_alone_say_them_as_they_are_told() {
    let json = r#"{"words": [{"word": "Bob", "start": 0.5, "end": 0.9}]}"#;
    let source = Source {
        name: "words.json",
        bytes: json.as_bytes(),
    };
    let heard = |options: &ReadOptions| {
        let labels = read(&source, None, options).unwrap();
        let codes: Vec<&str> = labels.segments.iter().map(|s| s.phone.code()).collect();
        codes.join(" ")
    };
    let mut options = ReadOptions::default();
    assert_eq!(heard(&options), "b aa b");
    let mut own = Pronouncer::new();
    own.add_dictionary("bob B OW1 B");
    options.pronouncer = Some(Arc::new(own));
    assert_eq!(heard(&options), "b ow b");
}
