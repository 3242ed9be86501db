//! Where vertices are drawn, as weighted sums of nodes: the limit of the skin's subdivision, flat, for every step.

use glam::{Vec3, Vec3A};

use crate::tissue::Numbering;
use crate::{Head, Stencils};

/// Drawn places of some vertices.
#[derive(Clone, Debug, Default)]
pub(super) struct Drawn {
    /// Where each row ends; a row starts where the one before ends.
    ends: Vec<u32>,
    terms: Vec<(u32, f32)>,
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
        self.terms.extend(limit.row(vertex, node));
        self.close();
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
        for (&(vertex, share), node) in mix.iter().zip(nodes) {
            let row = limit.row(vertex, node);
            self.terms.extend(row.map(|(other, w)| (other, w * share)));
        }
        self.close();
        true
    }

    /// Ends a row, which may be empty.
    pub(super) fn close(&mut self) {
        self.ends.push(self.terms.len() as u32);
    }

    fn range(&self, row: usize) -> std::ops::Range<usize> {
        let start = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        start as usize..self.ends[row] as usize
    }

    /// The vertex's own node; none of an empty row.
    #[inline]
    pub(super) fn node(&self, row: usize) -> Option<usize> {
        let terms = &self.terms[self.range(row)];
        terms.first().map(|(node, _)| *node as usize)
    }

    /// Where the row's vertex is drawn.
    #[inline]
    pub(super) fn at(&self, row: usize, places: &[Vec3A]) -> Vec3A {
        let mut sum = Vec3A::ZERO;
        for &(node, weight) in &self.terms[self.range(row)] {
            sum += places[node as usize] * weight;
        }
        sum
    }
}
