//! What a viewer would notice: rates, sizes, no jumps, and the same at any order of asking.

use mouthpiece_phonemes::TICK_RATE;
use mouthpiece_rig::{Control, Controls};

use super::{Idle, ms};

fn at(idle: &Idle, ticks: i64, speaking: f32) -> Controls {
    let mut controls = Controls::default();
    idle.add(ticks, speaking, &mut controls);
    controls
}

fn blinks_per_minute(idle: &Idle, speaking: f32) -> f32 {
    let minutes = 60;
    let mut closed = false;
    let mut count = 0;
    for i in 0..minutes * 60 * 100 {
        let lid = at(idle, i * ms(10), speaking)[Control::LidL];
        if lid > 0.8 && !closed {
            count += 1;
        }
        closed = if lid > 0.8 { true } else { closed && lid > 0.3 };
    }
    count as f32 / minutes as f32
}

#[test]
fn blinks_come_as_often_as_peoples() {
    let idle = Idle::new(3);
    let rest = blinks_per_minute(&idle, 0.0);
    let talking = blinks_per_minute(&idle, 1.0);
    assert!((rest - 17.0).abs() < 2.5, "{rest} a minute at rest");
    assert!((talking - 26.0).abs() < 3.0, "{talking} a minute talking");
}

#[test]
fn nothing_jumps_and_nothing_leaves_its_size() {
    let idle = Idle::new(11);
    let mut last = at(&idle, 0, 1.0);
    // Across the blocks of the random events, too.
    for i in 1..400_000 {
        let now = at(&idle, i * ms(1), 1.0);
        for axis in [Control::HeadYaw, Control::HeadPitch, Control::HeadRoll] {
            assert!(now[axis].abs() < 4.0_f32.to_radians());
            assert!((now[axis] - last[axis]).abs() < 3e-4, "{i} ms");
        }
        assert!(
            (now[Control::LidL] - last[Control::LidL]).abs() < 0.03,
            "{i} ms"
        );
        assert!(
            (now[Control::GazeYaw] - last[Control::GazeYaw]).abs() < 0.02,
            "{i} ms"
        );
        last = now;
    }
}

#[test]
fn eyes_are_mostly_on_the_viewer() {
    let idle = Idle::new(5);
    let share = |speaking: f32| {
        let on = (0..120_000).filter(|i| {
            let c = at(&idle, i * ms(30), speaking);
            let off_yaw = c[Control::GazeYaw] + c[Control::HeadYaw];
            let off_pitch = c[Control::GazePitch] + c[Control::HeadPitch];
            off_yaw.hypot(off_pitch) < 1.5_f32.to_radians()
        });
        on.count() as f32 / 120_000.0
    };
    let (talking, listening) = (share(1.0), share(0.0));
    assert!((0.7..0.92).contains(&talking), "{talking} while talking");
    assert!(listening > 0.9, "{listening} while listening");
}

#[test]
fn any_tick_may_be_asked_for_first() {
    let (idle, other) = (Idle::new(8), Idle::new(9));
    let forwards: Vec<_> = (0..500).map(|i| at(&idle, i * 7001, 0.5)).collect();
    let backwards = (0..500).rev().map(|i| at(&idle, i * 7001, 0.5));
    assert!(forwards.iter().rev().copied().eq(backwards));
    assert_ne!(forwards[250], at(&other, 250 * 7001, 0.5));
    for tick in [i64::MIN, -TICK_RATE, i64::MAX] {
        let c = at(&idle, tick, f32::NAN);
        assert!(c.0.iter().all(|v| v.is_finite()));
    }
}
