//! Nodes in blocks of sixteen, and the springs of each block in rows: one spring of each of its nodes.
//!
//! So every edge is seen from both its ends and nothing is scattered (ELLPACK, cut into blocks of their
//! own height). The neighbours of a node stand in their order round it, so that the triangles between them
//! come with them: that is what the volume is summed from.

use glam::{Vec3, Vec3A};

use crate::tissue::Nodes;

/// Nodes in a block.
pub(in crate::tissue::springs) const BLOCK: usize = 16;

/// Bytes of a node; whoever has 2^28 of them has other troubles.
const NODE: u32 = size_of::<Vec3A>() as u32;

/// One spring to a neighbour for each node of a block.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Row {
    /// Where the neighbours are: bytes from the first node.
    pub offset: [u32; BLOCK],
    /// Half over the squared length at rest, 1/mm²; below 0 where there is no spring (the node before it, or
    /// the first, again).
    pub grown: [f32; BLOCK],
}

/// One hold on a fibre for each node of a block.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Tie {
    /// Where the place is: bytes from the first.
    pub offset: [u32; BLOCK],
    pub stiffness: [f32; BLOCK],
}

/// What holds sixteen nodes from below.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Block {
    pub rest: [[f32; BLOCK]; 3],
    pub normal: [[f32; BLOCK]; 3],
    pub gap: [f32; BLOCK],
    pub soft: [f32; BLOCK],
    pub firm: [f32; BLOCK],
    pub slip: [f32; BLOCK],
    pub hold: [f32; BLOCK],
    pub share: [f32; BLOCK],
    /// 1 over the mass.
    pub light: [f32; BLOCK],
    /// Its rows, ties, and, where it has any, rows of `corners`.
    pub rows: [u32; 2],
    pub ties: [u32; 2],
    pub corners: Option<u32>,
    /// First of its sixteen gradients.
    pub gradients: u32,
    /// Bit k mod 128 is set when fibre k holds one of its nodes.
    pub fibres: u128,
    /// Whether the mandible carries any.
    pub jawed: bool,
}

/// What a node weighs and stands on.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::tissue::springs) struct Ground {
    /// By how much its mass is greater than the head's mass of a vertex, which is the unit.
    pub heavier: f32,
    /// Where it is at rest, mm.
    pub rest: Vec3,
    /// Stiffness of its spring to the bone, and what is added once it has stretched by `slip_mm`.
    pub soft: f32,
    pub firm: f32,
    pub slip_mm: f32,
    /// Away from the bone, and how far the node may approach it, mm.
    pub normal: Vec3,
    pub gap_mm: f32,
    /// Share of the mandible in the bone's motion.
    pub share: f32,
}

/// A neighbour of a node, in their order round it.
#[derive(Clone, Copy, Debug)]
pub(in crate::tissue::springs) struct Neighbour {
    pub node: u32,
    /// Length of the spring at rest, mm; below 0 for none.
    pub rest_mm: f32,
    /// Share of the triangle between the neighbour before this one, this one and the node in a volume.
    pub corner: f32,
}

/// A node's hold on a fibre.
#[derive(Clone, Copy, Debug)]
pub(in crate::tissue::springs) struct Hold {
    pub node: u32,
    pub fibre: u32,
    /// Which of the places on fibres it is.
    pub place: u32,
    pub stiffness: f32,
}

/// What holds one node, as it is laid out.
pub(in crate::tissue::springs) struct Laid<'a> {
    lane: usize,
    /// Neighbours, and the length of the spring to each.
    pub edges: Vec<(usize, f32)>,
    ties: &'a [Tie],
    pub rest: Vec3A,
    pub normal: Vec3A,
    pub gap: f32,
    pub soft: f32,
    pub firm: f32,
    pub slip: f32,
    pub share: f32,
    /// 1 over its mass.
    pub light: f32,
}

impl Laid<'_> {
    /// Stiffness of each spring to a fibre, and how far that has moved there.
    pub(in crate::tissue::springs) fn ties(
        &self,
        shift: &[Vec3A],
    ) -> impl Iterator<Item = (f32, Vec3A)> {
        let l = self.lane;
        self.ties
            .iter()
            .map(move |tie| (tie.stiffness[l], shift[(tie.offset[l] / NODE) as usize]))
    }
}

/// Springs laid out for the passes.
#[derive(Clone, Debug)]
pub(in crate::tissue::springs) struct Mesh {
    pub(super) blocks: Vec<Block>,
    pub(super) rows: Vec<Row>,
    pub(super) corners: Vec<[f32; BLOCK]>,
    pub(super) ties: Vec<Tie>,
    nodes: usize,
    places: usize,
    gradients: usize,
}

impl Mesh {
    /// Of nodes that stand on `ground` with these neighbours (as many as grounds), among `nodes` nodes of
    /// which the first ones move; `holds` sorted by node, on `places` places of fibres.
    pub(in crate::tissue::springs) fn new(
        ground: &[Ground],
        neighbours: &[Vec<Neighbour>],
        holds: &[Hold],
        nodes: usize,
        places: usize,
    ) -> Self {
        let mut mesh = Self {
            blocks: Vec::with_capacity(ground.len().div_ceil(BLOCK)),
            rows: Vec::new(),
            corners: Vec::new(),
            ties: Vec::new(),
            nodes: nodes.max(ground.len().next_multiple_of(BLOCK)),
            places,
            gradients: 0,
        };
        for first in (0..ground.len()).step_by(BLOCK) {
            let lanes = first..(first + BLOCK).min(ground.len());
            mesh.block(&ground[lanes.clone()], &neighbours[lanes], holds, first);
        }
        let inside = |offset: &u32, count: usize| {
            offset.is_multiple_of(NODE) && ((*offset / NODE) as usize) < count
        };
        let sound = mesh
            .rows
            .iter()
            .all(|r| r.offset.iter().all(|i| inside(i, mesh.nodes)))
            && mesh
                .ties
                .iter()
                .all(|t| t.offset.iter().all(|i| inside(i, places)));
        // The passes rely on this: it is what makes their unchecked fetches sound.
        assert!(sound, "a spring ends at a node or point that is not there");
        mesh
    }

    fn block(&mut self, ground: &[Ground], near: &[Vec<Neighbour>], holds: &[Hold], first: usize) {
        let lanes = |value: &dyn Fn(&Ground) -> f32| -> [f32; BLOCK] {
            std::array::from_fn(|l| ground.get(l).map_or(0.0, value))
        };
        let axes = |value: &dyn Fn(&Ground) -> Vec3| {
            [0, 1, 2].map(|axis| lanes(&|g: &Ground| value(g)[axis]))
        };
        let volume = near.iter().flatten().any(|n| n.corner != 0.0);
        // Where there is no volume, a neighbour without a spring says nothing.
        let near: Vec<Vec<Neighbour>> = near
            .iter()
            .map(|list| {
                let says = |n: &&Neighbour| volume || n.rest_mm >= 0.0;
                list.iter().filter(says).copied().collect()
            })
            .collect();
        let height = near.iter().map(Vec::len).max().unwrap_or(0);
        let rows = self.rows.len() as u32;
        let corners = volume.then_some(self.corners.len() as u32);
        for r in 0..height {
            let mut row = Row {
                offset: std::array::from_fn(|l| (first + l) as u32 * NODE),
                grown: [-1.0; BLOCK],
            };
            let mut corner = [0.0; BLOCK];
            for (l, near) in near.iter().enumerate() {
                match (near.get(r), near.last()) {
                    (Some(n), _) => {
                        row.offset[l] = n.node * NODE;
                        let none = n.rest_mm < 0.0;
                        row.grown[l] = if none { -1.0 } else { 0.5 / n.rest_mm.powi(2) };
                        corner[l] = n.corner;
                    }
                    // Past its last neighbour: no area with that one again, or no way to itself.
                    (None, Some(last)) if volume => row.offset[l] = last.node * NODE,
                    _ => {}
                }
            }
            self.rows.push(row);
            if volume {
                self.corners.push(corner);
            }
        }
        let mut of_lane: [&[Hold]; BLOCK] = [&[]; BLOCK];
        let mut hold = [0.0; BLOCK];
        let mut fibres = 0;
        for (l, list) in of_lane.iter_mut().enumerate().take(ground.len()) {
            let node = (first + l) as u32;
            let start = holds.partition_point(|h| h.node < node);
            let end = holds.partition_point(|h| h.node <= node);
            *list = &holds[start..end];
            hold[l] = list.iter().map(|h| h.stiffness).sum();
            fibres |= list
                .iter()
                .fold(0_u128, |bits, h| bits | 1 << (h.fibre % 128));
        }
        let ties = self.ties.len() as u32;
        for r in 0..of_lane.iter().map(|list| list.len()).max().unwrap_or(0) {
            let of = |l: usize| of_lane[l].get(r);
            self.ties.push(Tie {
                offset: std::array::from_fn(|l| of(l).map_or(0, |h| h.place * NODE)),
                stiffness: std::array::from_fn(|l| of(l).map_or(0.0, |h| h.stiffness)),
            });
        }
        self.blocks.push(Block {
            rest: axes(&|g| g.rest),
            normal: axes(&|g| g.normal),
            gap: lanes(&|g| g.gap_mm),
            soft: lanes(&|g| g.soft),
            firm: lanes(&|g| g.firm),
            slip: lanes(&|g| g.slip_mm),
            share: lanes(&|g| g.share),
            light: lanes(&|g| (1.0 + g.heavier).recip()),
            hold,
            rows: [rows, self.rows.len() as u32],
            ties: [ties, self.ties.len() as u32],
            corners,
            gradients: self.gradients as u32,
            fibres,
            jawed: ground.iter().any(|g| g.share > 0.0),
        });
        if volume {
            self.gradients += BLOCK;
        }
    }

    /// Nodes that a list for the passes has: whole blocks.
    pub(in crate::tissue::springs) fn nodes(&self) -> usize {
        self.nodes
    }

    /// Places on fibres that the ties name.
    pub(in crate::tissue::springs) fn places(&self) -> usize {
        self.places
    }

    /// How many gradients of volumes there are: sixteen per block that has any.
    pub(in crate::tissue::springs) fn gradients(&self) -> usize {
        self.gradients
    }

    /// Where a node's gradient is, if it has one.
    pub(in crate::tissue::springs) fn gradient_of(&self, node: usize) -> Option<usize> {
        let block = &self.blocks[node / BLOCK];
        block
            .corners
            .map(|_| block.gradients as usize + node % BLOCK)
    }

    /// 1 over a node's mass.
    pub(in crate::tissue::springs) fn light(&self, node: usize) -> f32 {
        self.blocks[node / BLOCK].light[node % BLOCK]
    }

    /// Tells of every node what holds it, as it is laid out: for sums that need no haste.
    pub(in crate::tissue::springs) fn each_node(&self, mut tell: impl FnMut(usize, &Laid<'_>)) {
        for (b, block) in self.blocks.iter().enumerate() {
            for l in 0..BLOCK {
                let rows = &self.rows[block.rows[0] as usize..block.rows[1] as usize];
                let axis =
                    |of: &[[f32; BLOCK]; 3]| Vec3A::from_array([of[0][l], of[1][l], of[2][l]]);
                let node = Laid {
                    lane: l,
                    edges: rows
                        .iter()
                        .filter(|r| {
                            r.grown[l] >= 0.0 && (r.offset[l] / NODE) as usize != b * BLOCK + l
                        })
                        .map(|r| ((r.offset[l] / NODE) as usize, (0.5 / r.grown[l]).sqrt()))
                        .collect(),
                    ties: &self.ties[block.ties[0] as usize..block.ties[1] as usize],
                    rest: axis(&block.rest),
                    normal: axis(&block.normal),
                    gap: block.gap[l],
                    soft: block.soft[l],
                    firm: block.firm[l],
                    slip: block.slip[l],
                    share: block.share[l],
                    light: block.light[l],
                };
                tell(b * BLOCK + l, &node);
            }
        }
    }

    /// Bytes of the springs between nodes.
    pub(in crate::tissue::springs) fn spring_bytes(&self) -> usize {
        size_of_val(&*self.rows)
    }

    /// Bytes of everything laid out here.
    pub(in crate::tissue::springs) fn bytes(&self) -> usize {
        size_of_val(&*self.blocks)
            + size_of_val(&*self.rows)
            + size_of_val(&*self.corners)
            + size_of_val(&*self.ties)
            + self.gradients * size_of::<Vec3A>()
    }

    /// Panics unless the lists are of the size that this was made for.
    pub(super) fn check(&self, nodes: &Nodes, places: usize, gradients: usize) {
        assert!(
            nodes.place.len() == self.nodes && nodes.velocity.len() == self.nodes,
            "as many nodes as the mesh was made for"
        );
        assert_eq!(
            places, self.places,
            "as many places as the mesh was made for"
        );
        assert_eq!(
            gradients, self.gradients,
            "one gradient per node of a volume"
        );
    }
}
