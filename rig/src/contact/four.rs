//! Four nodes side by side, a coordinate each: to find out quickly which of many points may touch something.

use glam::{Affine3A, Vec3, Vec3A, Vec4};

/// The points that are looked at together.
pub(super) const FOUR: usize = 4;

/// Four points by the nodes that they hang on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Four {
    /// Twice the same of a point that hangs on one node.
    pub nodes: [[u32; 2]; FOUR],
    /// From the nodes' middle to the point at rest.
    offset: Places,
    /// Whether each of the four hangs on one node.
    single: bool,
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
    pub(super) fn all(points: &[([u32; 2], Vec3)]) -> Vec<Self> {
        let four = |points: &[([u32; 2], Vec3)]| {
            let at = |i: usize| points[i.min(points.len() - 1)];
            let offsets: [Vec3; FOUR] = std::array::from_fn(|i| at(i).1);
            let nodes: [[u32; 2]; FOUR] = std::array::from_fn(|i| at(i).0);
            Self {
                nodes,
                offset: Places::new(offsets.map(Vec3A::from)),
                single: nodes.iter().all(|[a, b]| a == b),
                some: (1 << points.len()) - 1,
            }
        };
        points.chunks(FOUR).map(four).collect()
    }

    /// Where the points are as far as they moved along with their nodes.
    #[inline]
    pub(super) fn at(&self, places: &[Vec3A]) -> Places {
        let first = Places::new(self.nodes.map(|[a, _]| places[a as usize]));
        let middle = if self.single {
            first
        } else {
            let other = Places::new(self.nodes.map(|[_, b]| places[b as usize]));
            Places {
                x: (first.x + other.x) * 0.5,
                y: (first.y + other.y) * 0.5,
                z: (first.z + other.z) * 0.5,
            }
        };
        Places {
            x: middle.x + self.offset.x,
            y: middle.y + self.offset.y,
            z: middle.z + self.offset.z,
        }
    }
}

impl Places {
    #[inline]
    fn new([a, b, c, d]: [Vec3A; FOUR]) -> Self {
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

    /// Keeps those of which it is true, in order.
    #[inline]
    pub(super) fn keep(&mut self, mut of: impl FnMut(usize) -> bool) {
        let mut kept = 0;
        for i in 0..self.count {
            let point = self.room[i];
            if of(point as usize) {
                self.room[kept] = point;
                kept += 1;
            }
        }
        self.count = kept;
    }
}
