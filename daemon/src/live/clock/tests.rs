//! The clock against a device that stalls, jumps and drifts.

use super::*;

const MS: i64 = 1_000_000;
/// A device's buffer: 20 ms.
const PERIOD: i64 = 960;

/// A device whose stamps a test bends: every buffer is handed over 60 ms before it is heard.
struct Device {
    cell: Arc<ClockCell>,
    handed: i64,
}

impl Device {
    fn new() -> (Self, AudibleClock) {
        let cell = Arc::new(ClockCell::default());
        let clock = AudibleClock::new(Arc::clone(&cell));
        (Self { cell, handed: 0 }, clock)
    }

    /// Hands a buffer over; `true_ns` is when it will be heard, `error_ns` how wrong the stamp is.
    fn buffer(&mut self, true_ns: i64, error_ns: i64) {
        self.cell.publish(Stamp {
            first: self.handed,
            end: self.handed + PERIOD,
            playback_ns: true_ns + error_ns,
        });
        self.handed += PERIOD;
    }
}

/// A cheap sequence of numbers in -1..=1.
fn noise(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Plays `count` buffers with stamps bent by `error`, reads every 5 ms, and returns the error of
/// each reading in ticks, asserting that time never goes back.
fn play(
    device: &mut Device,
    clock: &mut AudibleClock,
    count: i64,
    start_ns: i64,
    mut error: impl FnMut(i64) -> i64,
) -> Vec<i64> {
    let mut errors = Vec::new();
    let first = device.handed;
    let mut last = i64::MIN;
    for n in 0..count {
        let heard_ns = start_ns + n * 20 * MS;
        device.buffer(heard_ns, error(n));
        for read in 0..4 {
            let now_ns = heard_ns - 60 * MS + read * 5 * MS;
            let heard = clock.at(now_ns);
            assert!(heard >= last, "time went back");
            assert!(heard <= device.handed, "heard what was not handed over");
            last = heard;
            errors.push(heard - (first + ticks_from_ns(now_ns - start_ns)));
        }
    }
    errors
}

#[test]
fn jitter_is_smoothed_to_below_two_milliseconds() {
    let (mut device, mut clock) = Device::new();
    let mut seed = 1;
    let errors = play(&mut device, &mut clock, 500, 100 * MS, |_| {
        (noise(&mut seed) * 6e6) as i64
    });
    let worst = errors[200..].iter().map(|e| e.abs()).max();
    assert!(worst < Some(96), "{worst:?} ticks");
}

#[test]
fn wrong_first_stamps_are_forgotten() {
    let (mut device, mut clock) = Device::new();
    let errors = play(&mut device, &mut clock, 100, 100 * MS, |n| {
        if n < 3 { -1500 * MS } else { 0 }
    });
    let worst = errors[100..].iter().map(|e| e.abs()).max();
    assert!(worst <= Some(1), "{worst:?} ticks");
}

#[test]
fn a_single_wild_stamp_moves_nothing() {
    let (mut device, mut clock) = Device::new();
    let errors = play(&mut device, &mut clock, 100, 100 * MS, |n| {
        if n % 10 == 5 { 700 * MS } else { 0 }
    });
    let worst = errors[40..].iter().map(|e| e.abs()).max();
    assert!(worst <= Some(1), "{worst:?} ticks");
}

#[test]
fn a_stalled_device_stops_the_clock_at_what_was_handed_over() {
    let (mut device, mut clock) = Device::new();
    play(&mut device, &mut clock, 50, 100 * MS, |_| 0);
    let handed = device.handed;
    let stall_ns = 100 * MS + 50 * 20 * MS;
    assert_eq!(clock.at(stall_ns + 1500 * MS), handed);
    // It goes on 1.5 s later: right again within half a second, and never back.
    let errors = play(&mut device, &mut clock, 100, stall_ns + 1560 * MS, |_| 0);
    let worst = errors[100..].iter().map(|e| e.abs()).max();
    assert!(worst <= Some(1), "{worst:?} ticks");
}

#[test]
fn a_drifting_quartz_is_followed() {
    let (mut device, mut clock) = Device::new();
    // 200 parts in a million: 4 us a buffer.
    let mut errors = Vec::new();
    for n in 0..3000 {
        let heard_ns = 100 * MS + n * 20 * MS + n * 4000;
        device.buffer(heard_ns, 0);
        let heard = clock.at(heard_ns);
        errors.push(heard - n * PERIOD);
    }
    let worst = errors[100..].iter().map(|e| e.abs()).max();
    assert!(worst < Some(10), "{worst:?} ticks");
}

#[test]
fn before_the_first_stamp_time_stands() {
    let (_device, mut clock) = Device::new();
    assert_eq!((clock.at(5 * MS), clock.at(500 * MS)), (0, 0));
}

#[test]
fn a_reader_never_sees_half_a_stamp() {
    let cell = Arc::new(ClockCell::default());
    let writer = {
        let cell = Arc::clone(&cell);
        std::thread::Builder::new()
            .name("writer".to_owned())
            .spawn(move || {
                for n in 0..200_000 {
                    cell.publish(Stamp {
                        first: n,
                        end: n + 1,
                        playback_ns: n + 2,
                    });
                }
            })
            .unwrap()
    };
    while !writer.is_finished() {
        if let Some((count, stamp)) = cell.read() {
            assert_eq!(stamp.end, stamp.first + 1);
            assert_eq!(stamp.playback_ns, stamp.first + 2);
            assert_eq!(count, u64::try_from(stamp.first).unwrap() + 1);
        }
    }
    writer.join().unwrap();
}
