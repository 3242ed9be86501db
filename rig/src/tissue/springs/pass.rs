//! The pass over skin edges alone, on any triangle mesh: for measuring it beside other kernels.

use glam::{Vec3, Vec3A};

use super::simd::{self, Ground, Isa, MOST, Mesh, Neighbour, SOFTEN};
use super::{BLEND, SLACK};
use crate::tissue::Nodes;
use crate::tissue::nodes::morton;

/// Forces of the edges of a mesh, as the default model has them, laid out and computed as there.
#[derive(Clone, Debug)]
pub struct SpringPass {
    mesh: Mesh,
    nodes: Nodes,
    force: Vec<Vec3A>,
    edges: Vec<[u32; 2]>,
    count: usize,
}

impl SpringPass {
    /// What an edge pulls with, over its stiffness and its length, when it has this strain (Green's: half of what its
    /// squared length has gained): the law that the pass computes, here in f64.
    #[must_use]
    pub fn stress(strain: f64) -> f64 {
        let [slack, blend, most, soften] = [SLACK, BLEND, MOST, SOFTEN].map(f64::from);
        let strain = strain.min(most);
        let strain = strain - soften * strain * strain;
        let (size, near) = (strain.abs(), strain.abs().min(blend));
        let odd = size - near + near * near / (2.0 * blend);
        0.5 * ((1.0 + slack) * strain + (1.0 - slack) * odd)
    }

    /// Of all edges of these triangles, mm, stretched by `stretch`; vertices are put in an order in which
    /// neighbours are close.
    ///
    /// # Panics
    /// When a triangle names a vertex that is not there.
    #[must_use]
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]], stretch: f32) -> Self {
        let mut order: Vec<u32> = (0..positions.len() as u32).collect();
        order.sort_by_key(|&v| morton(positions[v as usize]));
        let mut number = vec![0; positions.len()];
        for (new, &old) in (0..).zip(&order) {
            number[old as usize] = new;
        }
        let places: Vec<Vec3> = order.iter().map(|&v| positions[v as usize]).collect();
        let mut edges: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
            .map(|edge| edge.map(|v| number[v as usize]))
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let mut neighbours = vec![Vec::new(); places.len()];
        for &[a, b] in &edges {
            let rest_mm = places[a as usize].distance(places[b as usize]) / stretch;
            for (from, node) in [(a, b), (b, a)] {
                neighbours[from as usize].push(Neighbour {
                    node,
                    rest_mm,
                    corner: 0.0,
                });
            }
        }
        let ground: Vec<Ground> = places
            .iter()
            .map(|&rest| Ground {
                rest,
                ..Ground::default()
            })
            .collect();
        let mesh = Mesh::new(&ground, &neighbours, &[], places.len(), 0);
        let mut nodes = Nodes::at(&places);
        nodes.place.resize(mesh.nodes(), Vec3A::ZERO);
        nodes.velocity.resize(mesh.nodes(), Vec3A::ZERO);
        Self {
            force: vec![Vec3A::ZERO; mesh.nodes()],
            count: places.len(),
            mesh,
            nodes,
            edges,
        }
    }

    /// Computes the forces.
    pub fn run(&mut self, isa: Isa) {
        simd::stretch(
            isa,
            &self.mesh,
            &self.nodes,
            &mut self.force,
            [SLACK, BLEND],
        );
    }

    /// The forces of the last run, over the edges' stiffness, mm.
    pub fn forces(&self) -> impl Iterator<Item = Vec3> {
        self.force[..self.count].iter().map(|f| Vec3::from(*f))
    }

    /// The vertices in the order of the pass, mm.
    pub fn places(&self) -> impl Iterator<Item = Vec3> {
        self.nodes.place[..self.count]
            .iter()
            .map(|p| Vec3::from(*p))
    }

    /// The edges in that order, the lower number first.
    #[must_use]
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// Bytes that a run reads and writes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.mesh.spring_bytes() + size_of_val(&*self.nodes.place) + size_of_val(&*self.force)
    }
}
