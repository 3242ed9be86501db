//! Where vertices are drawn, as weighted sums of nodes: the limit of the skin's subdivision, flat, for every step.

use glam::{Vec3, Vec3A};

use crate::tissue::Numbering;
use crate::{Head, Stencils};

/// Terms of a block: a vertex with six neighbours fits into one.
const TERMS: usize = 8;

/// Drawn places of some vertices.
#[derive(Clone, Debug, Default)]
pub(super) struct Drawn {
    /// Where each row ends; a row starts where the one before ends.
    ends: Vec<u32>,
    blocks: Vec<Block>,
}

/// Some terms of a row; what a row leaves over has no weight.
#[derive(Clone, Copy, Debug)]
struct Block {
    nodes: [u32; TERMS],
    weights: [f32; TERMS],
}

/// The limit of a head's skin, while contacts are set up.
pub(super) struct Limit<'a> {
    stencils: Option<Stencils>,
    numbering: &'a Numbering,
}

impl<'a> Limit<'a> {
    /// Where the skin's numbers do not fit together, vertices count as drawn where they are.
    pub(super) fn new(head: &Head, numbering: &'a Numbering) -> Self {
        Self {
            stencils: head.skin_limit().ok(),
            numbering,
        }
    }

    pub(super) fn numbering(&self) -> &Numbering {
        self.numbering
    }

    /// Where a vertex is drawn for the skin's positions.
    pub(super) fn at(&self, vertex: u32, skin: &[Vec3]) -> Vec3 {
        let own = skin[vertex as usize];
        self.stencils.as_ref().map_or(own, |stencils| {
            let row = stencils.row(vertex as usize);
            row.map(|(v, weight)| skin[v as usize] * weight).sum()
        })
    }

    /// The nodes that a vertex is drawn from; what does not move of them counts as its own.
    fn row(&self, vertex: u32, node: u32) -> impl Iterator<Item = (u32, f32)> {
        let row = self
            .stencils
            .iter()
            .flat_map(move |s| s.row(vertex as usize));
        let (mut own, mut others) = (1.0, Vec::new());
        for (v, weight) in row.filter(|(v, _)| *v != vertex) {
            if let Some(other) = self.numbering.moving(v) {
                others.push((other, weight));
                own -= weight;
            }
        }
        std::iter::once((node, own)).chain(others)
    }
}

impl Drawn {
    /// Adds the row of a vertex that is the given node.
    pub(super) fn push(&mut self, limit: &Limit<'_>, vertex: u32, node: u32) {
        let terms: Vec<(u32, f32)> = limit.row(vertex, node).collect();
        self.close(&terms);
    }

    /// Adds the row of a place between vertices that move, given their shares; whether they all do.
    pub(super) fn push_mix(&mut self, limit: &Limit<'_>, mix: &[(u32, f32)]) -> bool {
        let nodes: Option<Vec<u32>> = mix
            .iter()
            .map(|(vertex, _)| limit.numbering().moving(*vertex))
            .collect();
        let Some(nodes) = nodes else {
            return false;
        };
        let mut terms: Vec<(u32, f32)> = Vec::new();
        for (&(vertex, share), node) in mix.iter().zip(nodes) {
            for (other, weight) in limit.row(vertex, node) {
                match terms.iter_mut().find(|(known, _)| *known == other) {
                    Some((_, sum)) => *sum += weight * share,
                    None => terms.push((other, weight * share)),
                }
            }
        }
        self.close(&terms);
        true
    }

    fn close(&mut self, terms: &[(u32, f32)]) {
        for terms in terms.chunks(TERMS) {
            let term = |i: usize| terms.get(i).copied().unwrap_or((terms[0].0, 0.0));
            self.blocks.push(Block {
                nodes: std::array::from_fn(|i| term(i).0),
                weights: std::array::from_fn(|i| term(i).1),
            });
        }
        self.ends.push(self.blocks.len() as u32);
    }

    /// Rows so far.
    pub(super) fn rows(&self) -> usize {
        self.ends.len()
    }

    /// Where the row's vertex is drawn.
    #[inline]
    pub(super) fn at(&self, row: usize, places: &[Vec3A]) -> Vec3A {
        let start = if row == 0 { 0 } else { self.ends[row - 1] };
        // Two sums: one would wait for itself at each term.
        let (mut even, mut odd) = (Vec3A::ZERO, Vec3A::ZERO);
        for block in &self.blocks[start as usize..self.ends[row] as usize] {
            for i in (0..TERMS).step_by(2) {
                even += places[block.nodes[i] as usize] * block.weights[i];
                odd += places[block.nodes[i + 1] as usize] * block.weights[i + 1];
            }
        }
        even + odd
    }
}
