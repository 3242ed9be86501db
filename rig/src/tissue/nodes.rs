//! Point masses, and which of the skin's vertices they stand for.

use glam::{Vec3, Vec3A};

use super::anatomy::moves;
use super::holds::attachments;
use crate::Head;

/// Places, mm, and velocities, mm/s, of point masses. Four floats each: one load fetches a whole neighbour,
/// which is faster than three gathers of a coordinate.
#[derive(Clone, Debug, Default)]
pub(crate) struct Nodes {
    pub place: Vec<Vec3A>,
    pub velocity: Vec<Vec3A>,
}

impl Nodes {
    /// At these places, still.
    pub(crate) fn at(places: &[Vec3]) -> Self {
        Self {
            place: places.iter().map(|p| Vec3A::from(*p)).collect(),
            velocity: vec![Vec3A::ZERO; places.len()],
        }
    }
}

/// Nodes that are sorted by how many fibres hold them.
const NEIGHBOURHOOD: usize = 128;

/// Which skin vertices are simulated: those that move come first, in an order that keeps neighbours
/// close in memory; then the rim that their edges end at, which stays where it is.
#[derive(Clone, Debug)]
pub(crate) struct Numbering {
    /// Skin vertex of each node.
    pub vertices: Vec<u32>,
    /// How many of the nodes move.
    pub movable: usize,
    /// Node of each skin vertex; `u32::MAX` where it is none.
    number: Vec<u32>,
    /// Edges between nodes of which one at least moves: the lower number first, in order, each once.
    pub edges: Vec<[u32; 2]>,
    /// Triangles of which one corner at least moves, by node.
    pub triangles: Vec<[u32; 3]>,
}

impl Numbering {
    /// Of a head, in an order that is good for work done on many nodes side by side: within a neighbourhood those come
    /// together that as many fibres hold.
    pub(crate) fn new(head: &Head) -> Self {
        let plain = Self::plain(head);
        let mut holds = vec![0_u32; head.skin.mesh.positions.len()];
        for hold in attachments(head, &plain) {
            holds[plain.vertices[hold.vertex as usize] as usize] += 1;
        }
        Self::ordered(head, |v| holds[v as usize])
    }

    /// Of a head of which only the skin is known to be sound: the same nodes, in an order that asks for no more.
    pub(crate) fn plain(head: &Head) -> Self {
        Self::ordered(head, |_| 0)
    }

    fn ordered(head: &Head, holds: impl Fn(u32) -> u32) -> Self {
        let rest = &head.skin.mesh.positions;
        let mut vertices: Vec<u32> = (0..rest.len() as u32)
            .filter(|&i| moves(head.skin.reference[i as usize]))
            .collect();
        vertices.sort_by_key(|&i| morton(rest[i as usize]));
        for near in vertices.chunks_mut(NEIGHBOURHOOD) {
            near.sort_by_key(|&v| holds(v));
        }
        let movable = vertices.len();
        let mut number = vec![u32::MAX; rest.len()];
        for (new, &old) in vertices.iter().enumerate() {
            number[old as usize] = new as u32;
        }
        let (mut edges, mut triangles) = (Vec::new(), Vec::new());
        for t in &head.skin.mesh.triangles {
            if t.iter().all(|&v| number[v as usize] as usize >= movable) {
                continue;
            }
            for &v in t {
                if number[v as usize] == u32::MAX {
                    number[v as usize] = vertices.len() as u32;
                    vertices.push(v);
                }
            }
            let t = t.map(|v| number[v as usize]);
            triangles.push(t);
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                if (a.min(b) as usize) < movable {
                    edges.push([a.min(b), a.max(b)]);
                }
            }
        }
        edges.sort_unstable();
        edges.dedup();
        Self {
            vertices,
            movable,
            number,
            edges,
            triangles,
        }
    }

    /// The node of a skin vertex, where that one moves.
    pub(crate) fn moving(&self, skin_vertex: u32) -> Option<u32> {
        let number = self.number[skin_vertex as usize];
        ((number as usize) < self.movable).then_some(number)
    }

    /// The skin vertices of the nodes that move.
    pub(crate) fn moving_vertices(&self) -> &[u32] {
        &self.vertices[..self.movable]
    }

    /// What the nodes have of a list with one entry per skin vertex.
    pub(crate) fn of<T: Copy>(&self, per_vertex: &[T]) -> Vec<T> {
        self.vertices
            .iter()
            .map(|&v| per_vertex[v as usize])
            .collect()
    }
}

/// Interleaves the bits of a place on a 4 mm grid, so that neighbours lie close in memory.
pub(super) fn morton(p: Vec3) -> u64 {
    let cell = ((p + 256.0) / 4.0).max(Vec3::ZERO);
    let spread =
        |v: f32| (0..10).fold(0_u64, |sum, bit| sum | ((v as u64 >> bit & 1) << (3 * bit)));
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}
