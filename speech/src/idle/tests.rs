//! What a viewer would notice: rates, sizes, no jumps, and the same at any order of asking.

use mouthpiece_phonemes::{Phone, Segment, TICK_RATE};
use mouthpiece_rig::{Control, Controls};

use super::noise::Noise;
use super::{Idle, Manner, State, States, breath, ms};
use crate::prosody::{Accent, Delivery};
use crate::{Speech, Track};

const HOUR: i64 = 3600 * TICK_RATE;

fn at(idle: &Idle, ticks: i64, manner: impl Into<Manner>) -> Controls {
    let mut controls = Controls::default();
    idle.add(ticks, &manner.into(), &mut controls);
    controls
}

/// A head whose only muscle is its jaw, and lips that close with it.
fn speech() -> Speech {
    Speech::with(|a| {
        let mut c = Controls::default();
        c[Control::Jaw] = a.jaw_rad;
        c[Control::OrbicularisOrisSuperior] = if a.aperture_mm < 0.0 { 0.5 } else { 0.0 };
        c
    })
    .unwrap()
}

/// Phrases of 2.4 to 4.5 s with pauses of 0.4 to 1 s, for `ticks`.
fn phrases(ticks: i64) -> Track {
    let mut track = speech().track(&[]);
    let mut now = ms(500);
    track.push(Segment::new(Phone::HSharp, 0, now));
    let mut i: i64 = 0;
    while now < ticks {
        let end = now + ms(2400 + (i * 733) % 2100);
        let mut phones = [Phone::M, Phone::Ae, Phone::T, Phone::Iy]
            .into_iter()
            .cycle();
        while now < end {
            let phone = phones.next().unwrap();
            track.push(Segment::new(phone, now, now + ms(80)));
            now += ms(80);
        }
        let pause = ms(400 + (i * 271) % 600);
        track.push(Segment::new(Phone::Pau, now, now + pause));
        now += pause;
        i += 1;
    }
    track
}

/// Ticks at which the lids of a face begin to close.
fn blinks(lid: impl Fn(i64) -> f32) -> Vec<i64> {
    let mut closed = false;
    let mut out = Vec::new();
    for tick in (0..HOUR).step_by(ms(20) as usize) {
        let lid = lid(tick);
        if lid > 0.7 && !closed {
            out.push(tick);
        }
        closed = lid > 0.7 || (closed && lid > 0.3);
    }
    out
}

#[test]
fn blinks_come_as_often_as_peoples_at_log_normal_intervals() {
    let idle = Idle::new(3);
    let rest = blinks(|t| at(&idle, t, State::Idle)[Control::LidL]);
    let a_minute = rest.len() as f32 / 60.0;
    assert!((a_minute - 17.0).abs() < 2.0, "{a_minute} a minute at rest");
    let logs: Vec<f32> = rest
        .windows(2)
        .map(|w| ((w[1] - w[0]) as f32 / TICK_RATE as f32).ln())
        .collect();
    let mean = logs.iter().sum::<f32>() / logs.len() as f32;
    let moment = |k| logs.iter().map(|x| (x - mean).powi(k)).sum::<f32>() / logs.len() as f32;
    let skew = moment(3) / moment(2).powf(1.5);
    // Those of their logarithms are even, as a normal distribution's; those of an exponential's are not.
    assert!(
        skew.abs() < 0.6,
        "the intervals' logarithms have skew {skew}"
    );

    let track = phrases(HOUR);
    let talking = blinks(|t| {
        let mut controls = at(&idle, t, State::Speaking);
        idle.accompany(&track, t, 1.0, &mut controls);
        controls[Control::LidL]
    });
    let a_minute = talking.len() as f32 / 60.0;
    assert!((a_minute - 26.0).abs() < 3.0, "{a_minute} a minute talking");
    // More where phrases end: a pause's first half second is an eighth of the time.
    let at_end = |t: &&i64| {
        track
            .pauses_near(**t, 0)
            .any(|p| **t - p.0 < ms(500) && p.0 > 0)
    };
    let share = talking.iter().filter(at_end).count() as f32 / talking.len() as f32;
    assert!(share > 0.3, "{share} of blinks where phrases end");
}

#[test]
fn a_blink_goes_down_in_90_ms_and_up_in_240() {
    let lid = |t: i64| super::blink::closing(ms(t));
    assert_eq!((lid(-1), lid(0), lid(330), lid(5000)), (0.0, 0.0, 0.0, 0.0));
    assert_eq!(lid(90), 1.0);
    assert!((0..90).all(|t| lid(t) < lid(t + 1)) && (90..330).all(|t| lid(t) > lid(t + 1)));
}

#[test]
fn nothing_jumps_and_nothing_leaves_its_size() {
    let idle = Idle::new(11);
    let mut track = phrases(400 * TICK_RATE);
    track.hear(&accents(400));
    let mut states = States::default();
    for (i, state) in State::ALL.into_iter().cycle().take(12).enumerate() {
        states.change(i as i64 * 31 * TICK_RATE, state);
    }
    let told = |tick: i64| {
        let mut controls = at(&idle, tick, states.at(tick));
        idle.accompany(&track, tick, 1.0, &mut controls);
        controls
    };
    let mut last = told(0);
    // Across the blocks of the random events, too.
    for i in 1..400_000 {
        let now = told(i * ms(1));
        for axis in [Control::HeadYaw, Control::HeadPitch, Control::HeadRoll] {
            assert!(now[axis].abs() < 8.5_f32.to_radians(), "{i} ms");
            assert!((now[axis] - last[axis]).abs() < 1.5e-3, "{i} ms");
        }
        for control in Control::ALL {
            let most = match control {
                Control::LidL | Control::LidR => 0.03,
                Control::GazeYaw | Control::GazePitch => 0.02,
                _ => 0.008,
            };
            let step = (now[*control] - last[*control]).abs();
            assert!(step < most, "{} by {step} at {i} ms", control.name());
        }
        last = now;
    }
}

/// An accent each 0.7 s for so many seconds, every other with a rise of pitch.
fn accents(seconds: i64) -> Delivery {
    let accent = |i: i64| Accent {
        at: ms(700) * i + ms(300),
        size: (i % 5) as f32 / 4.0,
        rises: i % 2 == 0,
    };
    Delivery {
        loudness: vec![0.0; seconds as usize * 100],
        accents: (0..seconds * 10 / 7).map(accent).collect(),
    }
}

#[test]
fn brows_go_with_pitch_as_often_as_peoples_and_nods_go_down_and_up() {
    let idle = Idle::new(21);
    let mut track = speech().track(&[]);
    let heard = accents(3600);
    track.hear(&heard);
    let told = |tick: i64| {
        let mut controls = Controls::default();
        idle.accompany(&track, tick, 1.0, &mut controls);
        controls
    };
    let (mut with, mut all, mut nods) = (0, 0, 0);
    let mut last = [told(0), told(0)];
    for tick in (0..HOUR).step_by(ms(10) as usize) {
        let now = told(tick);
        let peak = |c: Control, sign: f32| {
            sign * last[1][c] > sign * last[0][c] && sign * last[1][c] >= sign * now[c]
        };
        if peak(Control::FrontalisInner, 1.0) {
            all += 1;
            let near = |a: &&Accent| a.rises && (a.at - tick).abs() < ms(200);
            with += usize::from(heard.accents.iter().any(|a| near(&a)));
        }
        if peak(Control::HeadPitch, -1.0) {
            nods += 1;
            let degrees = -last[1][Control::HeadPitch].to_degrees();
            assert!((1.4..3.3).contains(&degrees), "a nod of {degrees} degrees");
        }
        last = [last[1], now];
    }
    let share = with as f32 / all as f32;
    assert!(
        (share - 0.71).abs() < 0.06,
        "{with} of {all} brow raises go with pitch"
    );
    let share = nods as f32 / heard.accents.len() as f32;
    assert!((0.4..0.7).contains(&share), "{share} of accents have a nod");
}

#[test]
fn breath_comes_and_goes_12_to_16_times_a_minute() {
    let noise = Noise::new(5);
    let chest = |tick| breath::at(&noise, tick).chest;
    let mut breaths = 0;
    let step = ms(50);
    for tick in (0..HOUR).step_by(step as usize) {
        let (a, b, c) = (chest(tick - step), chest(tick), chest(tick + step));
        breaths += usize::from(b > 0.4 && b > a && b >= c);
    }
    let a_minute = breaths as f32 / 60.0;
    assert!((12.0..=16.0).contains(&a_minute), "{a_minute}");
}

#[test]
fn lips_part_for_the_breath_before_a_phrase_and_never_in_a_contact() {
    let idle = Idle::new(2);
    let track = phrases(60 * TICK_RATE);
    let (mut widest, mut in_contact) = (0.0_f32, 0.0_f32);
    for tick in (0..60 * TICK_RATE).step_by(ms(5) as usize) {
        let before = track.controls_at(tick);
        let mut after = before;
        idle.accompany(&track, tick, 1.0, &mut after);
        let more = after[Control::Jaw] - before[Control::Jaw];
        widest = widest.max(more);
        in_contact = in_contact.max(more * track.contact_at(tick));
        assert!(
            after[Control::OrbicularisOrisSuperior] >= before[Control::OrbicularisOrisSuperior]
        );
    }
    assert!(widest > 0.02, "{widest}");
    assert!(in_contact < 1e-3, "{in_contact}");
}

#[test]
fn a_long_pause_and_an_idle_face_swallow_now_and_then() {
    let idle = Idle::new(4);
    let pressed = |state: State| {
        let mut count = 0;
        let mut last = 0.0;
        for tick in (0..HOUR).step_by(ms(40) as usize) {
            let now = at(&idle, tick, state)[Control::OrbicularisOrisSuperior];
            count += usize::from(now >= 0.1 && last < 0.1);
            last = now;
        }
        count
    };
    let rest = pressed(State::Idle);
    assert!((40..90).contains(&rest), "{rest} an hour at rest");
    assert_eq!(pressed(State::Speaking), 0);
}

#[test]
fn each_state_looks_its_own_way() {
    let idle = Idle::new(5);
    let share = |state: State| {
        let on = (0..120_000).filter(|i| {
            let c = at(&idle, i * ms(30), state);
            let off_yaw = c[Control::GazeYaw] + c[Control::HeadYaw];
            let off_pitch = c[Control::GazePitch] + c[Control::HeadPitch];
            off_yaw.hypot(off_pitch) < 1.5_f32.to_radians()
        });
        on.count() as f32 / 120_000.0
    };
    let [idle, listening, thinking, speaking] = State::ALL.map(share);
    assert!((0.7..0.92).contains(&speaking), "{speaking} while talking");
    assert!(listening > 0.9, "{listening} while listening");
    assert!(idle > 0.8, "{idle} while idle");
    assert!((0.15..0.5).contains(&thinking), "{thinking} while thinking");
}

#[test]
fn states_go_over_smoothly_and_the_last_word_holds() {
    let mut states = States::always(State::Listening);
    states.change(100, State::Thinking);
    states.change(TICK_RATE, State::Speaking);
    assert_eq!(states.at(0), State::Listening.into());
    assert_eq!(states.at(10 * TICK_RATE), State::Speaking.into());
    let shares = |t: i64| State::ALL.map(|s| states.at(t).of(s));
    for tick in (0..2 * TICK_RATE).step_by(48) {
        let (a, b) = (shares(tick), shares(tick + 48));
        assert!((a.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.005));
    }
    for i in 0..100 {
        states.change(i * TICK_RATE, State::ALL[i as usize % 4]);
    }
    assert_eq!(states.at(99 * TICK_RATE + TICK_RATE), State::ALL[3].into());
}

#[test]
fn any_tick_may_be_asked_for_first() {
    let (idle, other) = (Idle::new(8), Idle::new(9));
    let half = Manner::default().towards(State::Speaking, 0.5);
    let forwards: Vec<_> = (0..500).map(|i| at(&idle, i * 7001, half)).collect();
    let backwards = (0..500).rev().map(|i| at(&idle, i * 7001, half));
    assert!(forwards.iter().rev().copied().eq(backwards));
    assert_ne!(forwards[250], at(&other, 250 * 7001, half));
    let track = phrases(TICK_RATE);
    for tick in [i64::MIN, -TICK_RATE, i64::MAX] {
        let mut c = at(
            &idle,
            tick,
            Manner::default().towards(State::Thinking, f32::NAN),
        );
        idle.accompany(&track, tick, 1.0, &mut c);
        assert!(c.0.iter().all(|v| v.is_finite()));
    }
}
