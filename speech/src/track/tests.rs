//! What a lip reader would notice, on a stand-in for a head whose measures are linear in its controls.

use mouthpiece_phonemes::{Phone, Segment};
use mouthpiece_rig::{Articulation, Control, Controls};
use proptest::prelude::*;

use super::Track;
use crate::Speech;
use crate::blend::ticks;

const MS: i64 = 48;

/// A linear head: two muscles and the jaw open the mouth, another puts the lower lip to the teeth.
fn calibrated(a: &Articulation) -> Controls {
    let mut c = Controls::default();
    let by_muscles = a.aperture_mm - 60.0 * a.jaw_rad;
    c[Control::LevatorLabiiSuperioris] = 0.5 + by_muscles / 60.0;
    c[Control::DepressorLabiiInferioris] = 0.5 + by_muscles / 60.0;
    c[Control::OrbicularisOrisSuperior] = 0.3 - a.aperture_mm / 60.0;
    c[Control::OrbicularisOrisInferior] =
        0.6 - a.lip_teeth_mm.unwrap_or(a.aperture_mm + 4.0) / 50.0;
    c[Control::ProtrusionSuperior] = a.protrusion_mm / 8.0;
    c[Control::ProtrusionInferior] = a.protrusion_mm / 8.0;
    c[Control::Risorius] = a.width - 0.5;
    c[Control::Jaw] = a.jaw_rad;
    c[Control::TongueTip] = a.tongue.tip;
    c[Control::TongueOut] = a.tongue.out;
    c[Control::TongueBody] = a.tongue.body;
    c
}

fn aperture_mm(c: &Controls) -> f32 {
    let muscles = c[Control::LevatorLabiiSuperioris] + c[Control::DepressorLabiiInferioris];
    30.0 * (muscles - 1.0) + 60.0 * c[Control::Jaw]
}

fn lip_teeth_mm(c: &Controls) -> f32 {
    50.0 * (0.6 - c[Control::OrbicularisOrisInferior])
}

fn protrusion_mm(c: &Controls) -> f32 {
    4.0 * (c[Control::ProtrusionSuperior] + c[Control::ProtrusionInferior])
}

fn speech() -> Speech {
    Speech::with(calibrated).unwrap()
}

/// Phones with their lengths in ms, one behind the other from 0.
fn spoken(phones: &str) -> Vec<Segment> {
    let mut at = 0;
    let mut words = phones.split_whitespace();
    let mut out = Vec::new();
    while let (Some(code), Some(length)) = (words.next(), words.next()) {
        let end = at + length.parse::<i64>().unwrap() * MS;
        out.push(Segment::new(code.parse().unwrap(), at, end));
        at = end;
    }
    out
}

fn say(phones: &str) -> Track {
    speech().track(&spoken(phones))
}

/// The controls that put the skin where it is at `ms`: the tissue's lag undone.
fn at(track: &Track, ms: i64) -> Controls {
    track.controls_at(ms * MS - track.voice.lag)
}

/// (first, last) ms in `from..to` at which the lips are closed.
fn closed(track: &Track, from: i64, to: i64) -> Option<(i64, i64)> {
    let is = |ms: &i64| aperture_mm(&at(track, *ms)) <= 0.0;
    let first = (from..to).find(is)?;
    Some((first, (from..to).rev().find(is)?))
}

#[test]
fn every_bilabial_closes_on_its_hold_however_short() {
    for phone in ["m", "pcl", "bcl", "em"] {
        for length in [20, 30, 55, 90, 150] {
            let track = say(&format!(
                "h# 200 s 90 aa 120 {phone} {length} aa 120 iy 90 h# 200"
            ));
            let (from, to) = closed(&track, 260, 520 + length).unwrap();
            let middle = (from + to) as f32 / 2.0 - (410.0 + length as f32 / 2.0);
            let most = if length > 100 { 8.0 } else { 5.0 };
            assert!(middle.abs() <= most, "{phone} {length}: off by {middle} ms");
            let over = to - from - length;
            // A label holds more than the contact.
            assert!(
                (-length * 2 / 3..=35).contains(&over),
                "{phone} {length}: {over} ms longer"
            );
            // One frame of film at least.
            assert!(
                to - from >= 41 || length > 41,
                "{phone} {length}: {from}-{to}"
            );
        }
    }
}

#[test]
fn a_release_that_brings_no_closure_closes_too() {
    let whole = say("h# 100 ah 90 p 100 ay 150 h# 100");
    let (from, to) = closed(&whole, 150, 320).unwrap();
    assert!(from >= 175 && to <= 265 && to - from > 40, "{from}-{to}");
    // With its closure, the release opens.
    let timit = say("h# 100 ah 90 pcl 60 p 40 ay 150 h# 100");
    let (_, to) = closed(&timit, 150, 320).unwrap();
    assert!((240..262).contains(&to), "{to}");
}

#[test]
fn a_nasal_before_its_stop_is_one_closure() {
    let track = say("h# 100 ae 120 m 50 pcl 40 p 30 ix 60 h# 100");
    let (from, to) = closed(&track, 150, 400).unwrap();
    assert!((from..=to).all(|ms| aperture_mm(&at(&track, ms)) <= 0.0));
    assert!((-25..=35).contains(&(to - from - 90)), "{from}-{to}");
}

#[test]
fn lower_lip_meets_the_teeth_in_f_and_v() {
    for phone in ["f", "v"] {
        for length in [20, 60, 120] {
            let track = say(&format!("h# 100 aa 100 {phone} {length} ao 100 h# 100"));
            let gap = lip_teeth_mm(&at(&track, 200 + length / 2));
            assert!(gap.abs() < 0.05, "{phone} {length}: {gap} mm");
        }
    }
}

#[test]
fn short_open_vowels_open_between_whatever_stands_there() {
    for vowel in ["aa", "ae", "ao", "aw", "ay"] {
        for context in [
            "pcl 60 p 30",
            "m 60",
            "s 100",
            "f 90",
            "w 60",
            "tcl 50 t 40",
            "uw 90",
            "h# 200",
        ] {
            let track = say(&format!(
                "h# 200 iy 80 {context} {vowel} 80 {context} iy 80 h# 200"
            ));
            let vowel_at = track
                .segments()
                .iter()
                .find(|s| s.phone.code() == vowel)
                .map(|s| s.start / MS)
                .unwrap();
            let most = (vowel_at..vowel_at + 80)
                .map(|ms| aperture_mm(&at(&track, ms)))
                .fold(f32::MIN, f32::max);
            assert!(most > 6.5, "{vowel} in {context}: {most} mm");
        }
    }
}

#[test]
fn rounding_begins_before_the_vowel_and_outlasts_it() {
    let round = say("h# 200 s 80 tcl 40 t 30 uw 120 tcl 40 t 30 s 80 h# 200");
    let spread = say("h# 200 s 80 tcl 40 t 30 iy 120 tcl 40 t 30 s 80 h# 200");
    let full = protrusion_mm(&at(&round, 380));
    assert!(full > 3.0, "{full} mm in uw");
    for ms in [260, 500] {
        let more = protrusion_mm(&at(&round, ms)) - protrusion_mm(&at(&spread, ms));
        assert!(more > 0.35 * full, "only {more} mm at {ms} ms");
    }
    // A bilabial between takes it over and closes all the same.
    let boo = say("h# 200 uw 100 bcl 60 b 15 uw 150 h# 200");
    let closure = at(&boo, 330);
    assert!(protrusion_mm(&closure) > 1.5 && aperture_mm(&closure) <= 0.0);
}

#[test]
fn sibilants_narrow_the_jaw_and_velars_leave_the_lips() {
    let track = say("h# 200 aa 120 s 90 aa 120 h# 200");
    assert!(at(&track, 365)[Control::Jaw] < 0.04);
    let track = say("h# 200 uw 120 kcl 50 k 40 uw 120 h# 200");
    let through = (250..480).map(|ms| protrusion_mm(&at(&track, ms)));
    assert!(through.fold(f32::MAX, f32::min) > 2.8);
}

#[test]
fn diphthongs_move_and_silence_rests() {
    let track = say("h# 300 ay 240 h# 900");
    let early = at(&track, 350);
    let late = at(&track, 490);
    assert!(early[Control::Jaw] > late[Control::Jaw] + 0.03);
    assert!(late[Control::TongueBody] > early[Control::TongueBody] + 0.3);
    for ms in [-2000, 50, 900, 5000] {
        let rest = at(&track, ms);
        assert!(
            (0.0..1.0).contains(&aperture_mm(&rest)),
            "{ms} ms: {rest:?}"
        );
    }
    // A hole between labels is a pause; a crack is not.
    let mut segments = spoken("aa 200 h# 0");
    segments.truncate(1);
    segments.push(Segment::new(Phone::Aa, 1000 * MS, 1200 * MS));
    let pause = speech().track(&segments);
    assert!(aperture_mm(&at(&pause, 600)) < 1.0);
    segments[1] = Segment::new(Phone::Aa, 220 * MS, 420 * MS);
    let crack = speech().track(&segments);
    assert!(aperture_mm(&at(&crack, 210)) > 9.0);
}

#[test]
fn truncated_and_forgotten_tracks_are_those_of_fewer_labels() {
    let speech = speech();
    let all = spoken("h# 200 m 80 aa 300 pcl 60 p 40 iy 900 s 300 uw 900 h# 500 b 90 ay 200");
    let mut track = speech.track(&all);
    track.truncate_after(all[2].end);
    let short = speech.track(&all[..3]);
    assert!((-300..900).all(|ms| at(&track, ms) == at(&short, ms)));
    assert_eq!(track.end(), all[2].end);
    let mut track = speech.track(&all);
    track.forget_before(all[9].start);
    assert!(track.segments().len() < all.len());
    let whole = speech.track(&all);
    let now = all[9].start / MS;
    assert!((now - 100..now + 500).all(|ms| at(&track, ms) == at(&whole, ms)));
    track.clear();
    assert_eq!(track.controls_at(0), speech.track(&[]).controls_at(0));
}

#[test]
fn speaking_is_known_around_sounds_only() {
    let track = say("h# 1000 aa 200 h# 2000 iy 100");
    assert!(track.speaking_at(100 * MS) < 0.01);
    assert!(track.speaking_at(1100 * MS) > 0.99);
    assert!(track.speaking_at(2200 * MS) < 0.01);
    let edge = track.speaking_at(800 * MS);
    assert!((0.3..0.7).contains(&edge), "{edge}");
}

fn any_phone() -> impl Strategy<Value = Phone> {
    (0..Phone::ALL.len()).prop_map(|i| Phone::ALL[i])
}

/// Labels as a careful source writes them: each 20 to 200 ms, no holes.
fn labels() -> impl Strategy<Value = Vec<Segment>> {
    prop::collection::vec((any_phone(), 20..200_i64), 1..25).prop_map(|phones| {
        let mut at = 0;
        let segment = |(phone, length)| {
            let start = at;
            at += length * MS;
            Segment::new(phone, start, at)
        };
        phones.into_iter().map(segment).collect()
    })
}

/// Labels as no source should write them.
fn wild_labels() -> impl Strategy<Value = Vec<Segment>> {
    let time = prop_oneof![
        Just(0),
        Just(i64::MAX),
        Just(i64::MIN),
        any::<i64>(),
        -100_000..100_000_i64
    ];
    let segment = (any_phone(), time.clone(), time);
    prop::collection::vec(segment, 0..40).prop_map(|all| {
        all.into_iter()
            .map(|(p, s, e)| Segment::new(p, s, e))
            .collect()
    })
}

proptest! {
    #[test]
    fn bilabials_close_and_labiodentals_touch_in_any_company(segments in labels()) {
        let track = speech().track(&segments);
        for hold in &track.holds {
            let middle = hold.start + (hold.end - hold.start) / 2;
            let there = track.controls_at(middle - track.voice.lag);
            match hold.kind {
                crate::Contact::Lips => prop_assert!(aperture_mm(&there) <= 0.0, "{hold:?}"),
                crate::Contact::Teeth => prop_assert!(lip_teeth_mm(&there) <= 0.3, "{hold:?}"),
            }
        }
    }

    #[test]
    fn the_blend_stays_among_its_targets(segments in labels(), ms in -1000..6000_i64) {
        let track = speech().track(&segments);
        let blended = track.blended(ms * MS);
        for &control in track.voice.driven.iter().flatten() {
            let targets = track.voice.postures.iter().map(|p| p.targets[control]);
            let low = targets.clone().fold(f32::MAX, f32::min) - 1e-5;
            let high = targets.fold(f32::MIN, f32::max) + 1e-5;
            prop_assert!((low..=high).contains(&blended[control]), "{}", control.name());
        }
    }

    #[test]
    fn controls_do_not_jump(segments in labels()) {
        let track = speech().track(&segments);
        let mut last = at(&track, -800);
        for ms in -799..track.end() / MS + 800 {
            let now = at(&track, ms);
            for &control in Control::ALL {
                let step = (now[control] - last[control]).abs();
                prop_assert!(step < 0.12, "{} by {step} at {ms} ms", control.name());
            }
            last = now;
        }
    }

    #[test]
    fn growing_and_repeating_change_nothing(segments in labels(), ms in -500..5000_i64) {
        let speech = speech();
        let whole = speech.track(&segments);
        let mut grown = Track::new(&speech);
        for &segment in &segments {
            grown.push(segment);
            let _ = grown.controls_at(ms * MS);
        }
        prop_assert_eq!(whole.controls_at(ms * MS), grown.controls_at(ms * MS));
        prop_assert_eq!(whole.controls_at(ms * MS), whole.controls_at(ms * MS));
    }

    #[test]
    fn any_labels_give_numbers(segments in wild_labels(), time in any::<i64>(), cut in any::<i64>()) {
        let mut track = speech().track(&segments);
        let near = segments.first().map_or(0, |s| s.start);
        for time in [time, near, i64::MIN, 0, i64::MAX] {
            let controls = track.controls_at(time);
            for &control in Control::ALL {
                let (low, high) = control.range();
                prop_assert!((low..=high).contains(&controls[control]));
            }
            prop_assert!((0.0..=1.0).contains(&track.speaking_at(time)));
        }
        track.truncate_after(cut);
        track.forget_before(cut);
        prop_assert!(track.controls_at(time).0.iter().all(|v| v.is_finite()));
    }
}

#[test]
fn a_calibration_without_numbers_is_refused() {
    let broken = |a: &Articulation| {
        let mut c = calibrated(a);
        c[Control::Risorius] = if a.width > 1.1 { f32::NAN } else { 0.0 };
        c
    };
    let message = Speech::with(broken).unwrap_err().to_string();
    assert!(
        message.contains("risorius") && message.contains("`iy`"),
        "{message}"
    );
    assert_eq!(ticks(10.0), 480);
}
