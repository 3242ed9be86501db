//! On sounds whose loudness and pitch are known.

use mouthpiece_phonemes::TICK_RATE;

use super::frame::Window;
use super::{Delivery, HOP, Listener};

/// A buzz of `syllables` of (ms, Hz at its start, Hz at its end, amplitude).
fn buzz(syllables: &[(i64, f32, f32, f32)]) -> Vec<f32> {
    let mut phase = 0.0_f32;
    let mut out = Vec::new();
    for &(ms, from, to, amplitude) in syllables {
        let count = ms * TICK_RATE / 1000;
        for i in 0..count {
            let share = i as f32 / count as f32;
            phase += (from + (to - from) * share) / TICK_RATE as f32;
            phase -= phase.floor();
            let swell = (std::f32::consts::PI * share).sin();
            let harmonics =
                (1..=8).map(|k| (std::f32::consts::TAU * phase * k as f32).sin() / k as f32);
            out.push(amplitude * swell * 0.5 * harmonics.sum::<f32>());
        }
    }
    out
}

#[test]
fn pitch_is_that_of_the_sound() {
    for hz in [80.0, 110.0, 150.0, 220.0, 330.0] {
        let mut window = Window::new();
        let frames: Vec<_> = buzz(&[(400, hz, hz, 0.5)])
            .into_iter()
            .filter_map(|x| window.push(x))
            .collect();
        for frame in &frames[8..32] {
            let expected = 12.0 * (hz / (8000.0 / 114.0)).log2();
            let pitch = frame.pitch.unwrap();
            assert!(
                (pitch - expected).abs() < 0.3,
                "{hz}: {pitch} for {expected}"
            );
        }
    }
    let mut window = Window::new();
    let mut state = 1_u32;
    let noise = (0..TICK_RATE).map(|_| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32 - 0.5
    });
    let frames: Vec<_> = noise.filter_map(|x| window.push(x)).collect();
    let voiced = frames.iter().filter(|f| f.pitch.is_some()).count();
    assert!(voiced < 10, "{voiced} of 100 moments of noise have a pitch");
}

/// Ten syllables, of which the fourth and eighth stand out; the eighth by loudness alone.
fn utterance() -> Vec<f32> {
    let mut syllables = [(200, 120.0, 115.0, 0.2); 10];
    syllables[3] = (200, 120.0, 190.0, 0.45);
    syllables[7] = (200, 120.0, 112.0, 0.7);
    buzz(&syllables)
}

#[test]
fn stressed_syllables_are_found_and_a_rise_is_told_from_none() {
    let heard = Listener::whole(&utterance());
    let near = |ms: i64| {
        let tick = ms * TICK_RATE / 1000;
        let found = heard
            .accents
            .iter()
            .filter(|a| (a.at - tick).abs() < TICK_RATE / 10);
        found.copied().collect::<Vec<_>>()
    };
    let (fourth, eighth) = (near(700), near(1500));
    assert!(fourth.len() == 1 && fourth[0].rises, "{:?}", heard.accents);
    assert!(eighth.len() == 1 && !eighth[0].rises, "{:?}", heard.accents);
    assert!(heard.accents.len() <= 5, "{:?}", heard.accents);
    // Loud there, soft beside it, nothing where there is no sound.
    let at = |ms: i64| heard.loudness[(ms * TICK_RATE / 1000 / HOP) as usize];
    assert!(
        at(1510) > 0.8 && at(1110) < 0.7,
        "{} {}",
        at(1510),
        at(1110)
    );
    assert!(
        Listener::whole(&vec![0.0; 9600])
            .loudness
            .iter()
            .all(|l| *l == 0.0)
    );
}

#[test]
fn pieces_give_what_the_whole_gives_whatever_the_gain() {
    let sound = utterance();
    let whole = Listener::whole(&sound);
    for size in [1, 333, 24_000] {
        let (mut listener, mut out) = (Listener::default(), Delivery::default());
        for piece in sound.chunks(size) {
            listener.hear(piece, &mut out);
        }
        assert_eq!(out, whole);
    }
    let soft: Vec<f32> = sound.iter().map(|x| x * 0.5).collect();
    let soft = Listener::whole(&soft);
    let fourth_and_eighth = |heard: &Delivery| {
        let near = |ms: i64| heard.accents.iter().any(|a| (a.at / 48 - ms).abs() < 100);
        near(700) && near(1500)
    };
    assert!(fourth_and_eighth(&whole) && fourth_and_eighth(&soft));
    let broken = [f32::NAN, f32::INFINITY, -1e30].repeat(48_000);
    assert!(
        Listener::whole(&broken)
            .loudness
            .iter()
            .all(|l| l.is_finite())
    );
}
