//! The places on fibres that skin is held at: how far each is from rest.
//!
//! A place is rounded to an eighth of the way from one control point to the next (a millimetre), so that many
//! holds share one and each costs the pass a single fetch.

use glam::Vec3A;

use crate::muscle::Muscles;

/// Parts that the way between two control points is cut into.
const PARTS: u32 = 8;

/// A place between control point `point`, counted over all fibres, and the next.
#[derive(Clone, Copy, Debug)]
struct Place {
    point: u32,
    share: f32,
}

/// All places, fibre by fibre.
#[derive(Clone, Debug)]
pub(super) struct Places {
    keys: Vec<u32>,
    places: Vec<Place>,
    /// Where each fibre's start among them.
    starts: Vec<u32>,
    /// How far each is from rest, mm; and whether any of a fibre's is.
    shift: Vec<Vec3A>,
    moved: Vec<bool>,
}

fn key(point: u32, share: f32) -> u32 {
    point * PARTS + (share * PARTS as f32).round() as u32
}

impl Places {
    /// For holds at `(control point, share of the way to the next)`, on fibres whose points begin at `starts`.
    pub(super) fn new(holds: impl Iterator<Item = (u32, f32)>, starts: &[u32]) -> Self {
        let mut keys: Vec<u32> = holds.map(|(point, share)| key(point, share)).collect();
        keys.sort_unstable();
        keys.dedup();
        let place = |key: &u32| {
            let (point, part) = (key / PARTS, key % PARTS);
            // The last point of a fibre has none after it.
            let share = part as f32 / PARTS as f32;
            Place { point, share }
        };
        let begin = |start: &u32| keys.partition_point(|key| *key < start * PARTS) as u32;
        Self {
            places: keys.iter().map(place).collect(),
            starts: starts.iter().map(begin).collect(),
            shift: vec![Vec3A::ZERO; keys.len()],
            moved: vec![false; starts.len().saturating_sub(1)],
            keys,
        }
    }

    /// The number of a hold's place.
    pub(super) fn number(&self, point: u32, share: f32) -> u32 {
        let key = key(point, share);
        self.keys.partition_point(|k| *k < key) as u32
    }

    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// How far each place is from rest, mm.
    pub(super) fn shift(&self) -> &[Vec3A] {
        &self.shift
    }

    /// Reads where the fibres are now.
    pub(super) fn follow(&mut self, muscles: &Muscles) {
        let points = muscles.shift();
        let bits = muscles.moved_bits();
        for (k, was) in self.moved.iter_mut().enumerate() {
            let range = self.starts[k] as usize..self.starts[k + 1] as usize;
            let moved = bits >> (k % 128) & 1 == 1;
            if moved {
                for (shift, place) in self.shift[range.clone()]
                    .iter_mut()
                    .zip(&self.places[range])
                {
                    let here = place.point as usize;
                    let next = (here + 1).min(points.len() - 1);
                    *shift = points[here].lerp(points[next], place.share);
                }
            } else if *was {
                self.shift[range].fill(Vec3A::ZERO);
            }
            *was = moved;
        }
    }
}
