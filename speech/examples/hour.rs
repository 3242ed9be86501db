//! How fast speech alone is over an hour of labels, as a live face would ask for it: `cargo run --release -p
//! mouthpiece-speech --example hour`. Labels come half a second ahead, what is over is forgotten.

use std::hint::black_box;
use std::time::{Duration, Instant};

use mouthpiece_phonemes::{Phone, Segment, TICK_RATE};
use mouthpiece_rig::{Controls, Head, STEP_TICKS};
use mouthpiece_speech::{Idle, Listener, Manner, Speech, State, Track};

const HOUR: i64 = 3600 * TICK_RATE;
/// 71 ms a phone, 14 a second.
const PHONE_TICKS: i64 = 3_400;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let head = Head::reference()?;
    let speech = Speech::new(&head.calibration)?;
    let idle = Idle::new(1);
    let mut track = Track::new(&speech);
    let (mut spoken, mut alive) = (Duration::ZERO, Duration::ZERO);
    let mut segments_max = 0;
    let mut pushed = 0;
    for second in 0..HOUR / TICK_RATE {
        let now = second * TICK_RATE;
        let started = Instant::now();
        while pushed < now + TICK_RATE * 3 / 2 {
            let i = (pushed / PHONE_TICKS) as usize;
            // All phones in turn, with a pause each three seconds.
            let phone = match i % 42 {
                0..4 => Phone::Pau,
                k => Phone::ALL[(i * 7 + k) % Phone::ALL.len()],
            };
            track.push(Segment::new(phone, pushed, pushed + PHONE_TICKS));
            pushed += PHONE_TICKS;
        }
        segments_max = segments_max.max(track.segments().len());
        let times = || (now..now + TICK_RATE).step_by(STEP_TICKS as usize);
        for time in times() {
            black_box(track.controls_at(time));
        }
        track.forget_before(now);
        spoken += started.elapsed();
        let started = Instant::now();
        for time in times() {
            let mut controls = Controls::default();
            let manner =
                Manner::from(State::Idle).towards(State::Speaking, track.speaking_at(time));
            idle.add(time, &manner, &mut controls);
            idle.accompany(&track, time, 1.0, &mut controls);
            black_box(controls);
        }
        alive += started.elapsed();
    }
    let sound = vec![0.1_f32; 60 * TICK_RATE as usize];
    let started = Instant::now();
    black_box(Listener::whole(&sound));
    let heard = started.elapsed() * 60;
    for (what, took) in [("speech", spoken), ("life", alive), ("listening", heard)] {
        let factor = 3600.0 / took.as_secs_f64();
        println!("{what}: {factor:.0} times real time");
    }
    println!("at most {segments_max} segments held");
    Ok(())
}
