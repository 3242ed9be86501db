//! Key frames from the simulation thread to the render thread (HABER 5.3's ring buffer).
//!
//! Wanted: bounded; no lock; nothing allocated once it has filled; one writer; the simulation never
//! waits for the renderer, not even when that stands still; after a rewind the renderer draws
//! nothing of the void future.
//!
//! HABER guards one slot with a mutex and lets the simulation wait for it. Here whole frames move
//! through two bounded lock-free queues, full ones forward and used ones back to be filled again.
//! When the renderer takes nothing, the writer reuses the oldest frame that was not taken. A frame
//! carries its epoch; when one of a newer epoch arrives, the reader forgets what older epochs said
//! from that time on, while what lies before it stays true.

use std::collections::VecDeque;
use std::sync::Arc;

use crossbeam::queue::ArrayQueue;
use mouthpiece_rig::KeyFrame;

/// Frames on their way: twice the lead at 120 frames a second, so that a rewind's new frames fit
/// beside the void ones.
pub const QUEUED_MAX: usize = 64;
/// Frames that the reader holds: what it may need to interpolate up to the end of the lead.
pub const HELD_MAX: usize = 64;
/// All there are: those queued, those held, one being filled, one to spare.
const FRAMES: usize = QUEUED_MAX + HELD_MAX + 2;

/// The two ends of a ring.
pub fn key_frames() -> (FrameWriter, FrameReader) {
    let full = Arc::new(ArrayQueue::new(QUEUED_MAX));
    let empty = Arc::new(ArrayQueue::new(FRAMES));
    for _ in 0..FRAMES {
        // There is room for all of them.
        let _ = empty.push(KeyFrame::default());
    }
    (
        FrameWriter {
            full: Arc::clone(&full),
            empty: Arc::clone(&empty),
        },
        FrameReader {
            full,
            empty,
            held: VecDeque::with_capacity(HELD_MAX),
            epoch: 0,
        },
    )
}

/// The simulation's end.
#[derive(Debug)]
pub struct FrameWriter {
    full: Arc<ArrayQueue<KeyFrame>>,
    empty: Arc<ArrayQueue<KeyFrame>>,
}

impl FrameWriter {
    /// Sends a frame that `fill` writes into a used one.
    pub fn write(&mut self, fill: impl FnOnce(&mut KeyFrame)) {
        // Nobody reads: the oldest frame that was not taken is the one that is missed least.
        let used = self.empty.pop().or_else(|| self.full.pop());
        let mut frame = used.unwrap_or_default();
        fill(&mut frame);
        if let Some(oldest) = self.full.force_push(frame) {
            let _ = self.empty.push(oldest);
        }
    }
}

/// The renderer's end.
#[derive(Debug)]
pub struct FrameReader {
    full: Arc<ArrayQueue<KeyFrame>>,
    empty: Arc<ArrayQueue<KeyFrame>>,
    /// In order of time; the first is at or before the last time asked for, where there is one.
    held: VecDeque<KeyFrame>,
    epoch: u32,
}

impl FrameReader {
    /// Sets `out` to the head at `time`, held at the nearest frame beyond either end of what is
    /// there; false when nothing ever came. Times asked for must not fall.
    pub fn sample(&mut self, time: i64, out: &mut KeyFrame) -> bool {
        self.take_in(time);
        let mut held = self.held.iter();
        match (held.next(), held.next()) {
            (Some(a), Some(b)) => out.set_between(a, b, time),
            (Some(a), None) => out.copy_from(a),
            (None, _) => return false,
        }
        true
    }

    fn take_in(&mut self, time: i64) {
        loop {
            self.drop_before(time);
            if self.held.len() == HELD_MAX {
                return;
            }
            let Some(frame) = self.full.pop() else {
                return;
            };
            if frame.epoch != self.epoch {
                self.epoch = frame.epoch;
                while self.held.back().is_some_and(|f| f.time >= frame.time) {
                    let void = self.held.pop_back();
                    self.give_back(void);
                }
            }
            self.held.push_back(frame);
        }
    }

    /// Frames that no interpolation needs any more: those with a later one at or before `time`.
    fn drop_before(&mut self, time: i64) {
        while self.held.get(1).is_some_and(|f| f.time <= time) {
            let past = self.held.pop_front();
            self.give_back(past);
        }
    }

    fn give_back(&self, frame: Option<KeyFrame>) {
        if let Some(frame) = frame {
            let _ = self.empty.push(frame);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn write(writer: &mut FrameWriter, time: i64, epoch: u32, x: f32) {
        writer.write(|frame| {
            frame.time = time;
            frame.epoch = epoch;
            frame.skin.clear();
            frame.skin.push(Vec3::new(x, 0.0, 0.0));
        });
    }

    fn x_at(reader: &mut FrameReader, time: i64) -> f32 {
        let mut out = KeyFrame::default();
        assert!(reader.sample(time, &mut out));
        out.skin[0].x
    }

    #[test]
    fn frames_are_interpolated_and_held_at_the_ends() {
        let (mut writer, mut reader) = key_frames();
        assert!(!reader.sample(0, &mut KeyFrame::default()));
        write(&mut writer, 400, 0, 1.0);
        write(&mut writer, 800, 0, 2.0);
        write(&mut writer, 1200, 0, 4.0);
        assert_eq!(x_at(&mut reader, 0), 1.0);
        assert_eq!(x_at(&mut reader, 600), 1.5);
        assert_eq!(x_at(&mut reader, 1100), 3.5);
        assert_eq!(x_at(&mut reader, 9999), 4.0);
        write(&mut writer, 10_400, 0, 5.0);
        assert_eq!(x_at(&mut reader, 10_400), 5.0);
    }

    #[test]
    fn a_rewind_voids_the_future_and_keeps_the_past() {
        let (mut writer, mut reader) = key_frames();
        for n in 0..10 {
            write(&mut writer, n * 400, 0, 1.0);
        }
        assert_eq!(x_at(&mut reader, 1000), 1.0);
        // Rewound to 800: the frames from 1200 on are told again.
        for n in 3..10 {
            write(&mut writer, n * 400, 1, 3.0);
        }
        assert_eq!(x_at(&mut reader, 1000), 2.0);
        for time in (1200..3600).step_by(100) {
            assert_eq!(x_at(&mut reader, time), 3.0);
        }
    }

    #[test]
    fn a_reader_that_stands_still_stops_nobody_and_catches_up() {
        let (mut writer, mut reader) = key_frames();
        for n in 0..10_000 {
            write(&mut writer, n * 400, 0, n as f32);
        }
        assert_eq!(x_at(&mut reader, 9_999 * 400), 9_999.0);
        // All frames are still there to be reused.
        for n in 10_000..10_200 {
            write(&mut writer, n * 400, 0, n as f32);
            assert_eq!(x_at(&mut reader, n * 400), n as f32);
        }
        assert!(reader.empty.len() + reader.held.len() >= FRAMES - 1);
    }

    #[test]
    fn buffers_are_used_again() {
        let (mut writer, mut reader) = key_frames();
        let mut fresh = 0;
        for n in 0..1000 {
            writer.write(|frame| {
                frame.time = n * 400;
                if frame.skin.capacity() < 100 {
                    fresh += 1;
                }
                frame.skin.clear();
                frame.skin.resize(100, Vec3::ZERO);
            });
            x_at(&mut reader, n * 400);
        }
        assert!(fresh <= FRAMES);
    }
}
