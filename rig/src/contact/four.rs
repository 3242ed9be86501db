//! Four nodes side by side, a coordinate each: to find out quickly which of many points may touch something.

use glam::{Affine3A, Vec3, Vec3A, Vec4};

/// The points that are looked at together.
pub(super) const FOUR: usize = 4;

/// Four points by the nodes that they hang on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Four {
    nodes: [u32; FOUR],
    /// From the nodes to the points at rest.
    offset: Places,
    /// Bits of the points that there are: the last four may be fewer.
    pub some: u32,
}

/// Four places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    pub x: Vec4,
    pub y: Vec4,
    pub z: Vec4,
}

impl Four {
    /// Points, four at a time.
    pub(super) fn all(points: &[(u32, Vec3)]) -> Vec<Self> {
        let four = |points: &[(u32, Vec3)]| {
            let at = |i: usize| points[i.min(points.len() - 1)];
            Self {
                nodes: std::array::from_fn(|i| at(i).0),
                offset: Places::new(std::array::from_fn(|i| at(i).1.into())),
                some: (1 << points.len()) - 1,
            }
        };
        points.chunks(FOUR).map(four).collect()
    }

    /// Where the points are as far as they moved along with their nodes.
    #[inline]
    pub(super) fn at(&self, places: &[Vec3A]) -> Places {
        let at = Places::new(self.nodes.map(|node| places[node as usize]));
        Places {
            x: at.x + self.offset.x,
            y: at.y + self.offset.y,
            z: at.z + self.offset.z,
        }
    }
}

impl Places {
    #[inline]
    pub(super) fn new([a, b, c, d]: [Vec3A; FOUR]) -> Self {
        Self {
            x: Vec4::new(a.x, b.x, c.x, d.x),
            y: Vec4::new(a.y, b.y, c.y, d.y),
            z: Vec4::new(a.z, b.z, c.z, d.z),
        }
    }

    /// The same seen from elsewhere.
    #[inline]
    pub(super) fn moved(&self, by: &Affine3A) -> Self {
        let (m, t) = (&by.matrix3, by.translation);
        let row = |i: usize| {
            let (a, b, c) = (m.x_axis[i], m.y_axis[i], m.z_axis[i]);
            self.x * a + self.y * b + self.z * c + Vec4::splat(t[i])
        };
        Self {
            x: row(0),
            y: row(1),
            z: row(2),
        }
    }
}

/// The places of the bits that are set, lowest first.
#[inline]
pub(super) fn bits(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = mask.trailing_zeros();
        (mask != 0).then(|| {
            mask &= mask - 1;
            bit as usize
        })
    })
}

/// Numbers of points, of which there is room for all from the start: a step allocates nothing, nor one of a clone.
#[derive(Clone, Debug, Default)]
pub(super) struct List {
    room: Vec<u32>,
    count: usize,
}

impl List {
    pub(super) fn with_room(count: usize) -> Self {
        Self {
            room: vec![0; count],
            count: 0,
        }
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    pub(super) fn push(&mut self, point: usize) {
        if let Some(place) = self.room.get_mut(self.count) {
            *place = point as u32;
            self.count += 1;
        }
    }

    pub(super) fn points(&self) -> &[u32] {
        &self.room[..self.count]
    }

    /// Asks of four at a time which to keep; the bits that it is given say which of them there are.
    #[inline]
    pub(super) fn keep(&mut self, mut of: impl FnMut([usize; FOUR], u32) -> u32) {
        let mut kept = 0;
        for first in (0..self.count).step_by(FOUR) {
            let count = (self.count - first).min(FOUR);
            let points = std::array::from_fn(|i| self.room[first + i.min(count - 1)]);
            for i in bits(of(points.map(|point| point as usize), (1 << count) - 1)) {
                self.room[kept] = points[i];
                kept += 1;
            }
        }
        self.count = kept;
    }
}
