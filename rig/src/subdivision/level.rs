//! One level of Loop's subdivision: edges, fans and sharp edges of a mesh, the weights that make the
//! next level's points and the limit of its own.
//!
//! The next level has this level's points first, then one per edge in the edges' order.

use std::collections::HashMap;

use super::{Topology, chains};

const NONE: u32 = u32::MAX;

/// An edge; where sharp, its ends are in the order of the crease.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) ends: [u32; 2],
    /// Third corners of the triangles on both sides.
    opposite: [u32; 2],
    /// Triangles in the fan between two sharp edges that this edge is in, seen from each end; 0 where
    /// the end has no such fan.
    fans: [u8; 2],
    sharp: bool,
}

/// How a vertex moves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Smooth,
    /// On a crease between these two.
    Crease(u32, u32),
    Corner,
}

/// A mesh and what is next to what in it.
#[derive(Debug)]
pub(super) struct Level {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Edge from each corner to the next.
    sides: Vec<[u32; 3]>,
    pub(super) edges: Vec<Edge>,
    kinds: Vec<Kind>,
    /// Edges at each vertex, flat.
    spokes: Vec<u32>,
    spoke_ends: Vec<u32>,
}

impl Level {
    /// The control mesh.
    pub(super) fn control(mesh: &Topology<'_>) -> Self {
        let mut numbers = HashMap::with_capacity(mesh.triangles.len() * 2);
        let mut ends: Vec<[u32; 2]> = Vec::with_capacity(mesh.triangles.len() * 2);
        let mut uses: Vec<u8> = Vec::new();
        let key = |a: u32, b: u32| (a.min(b), a.max(b));
        let mut sides = Vec::with_capacity(mesh.triangles.len());
        for t in mesh.triangles {
            sides.push([0, 1, 2].map(|i| {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                let number = *numbers.entry(key(a, b)).or_insert_with(|| {
                    ends.push([a, b]);
                    uses.push(0);
                    ends.len() as u32 - 1
                });
                uses[number as usize] = uses[number as usize].saturating_add(1);
                number
            }));
        }
        let mut sharp: Vec<bool> = uses.iter().map(|&uses| uses != 2).collect();
        for &[a, b] in mesh.creases {
            if let Some(&number) = numbers.get(&key(a, b)) {
                sharp[number as usize] = true;
            }
        }
        let mut at = vec![Vec::new(); mesh.vertex_count];
        for (number, ends) in ends.iter().enumerate().filter(|(n, _)| sharp[*n]) {
            for &end in ends {
                at[end as usize].push(number as u32);
            }
        }
        let mut fixed: Vec<bool> = at.iter().map(|at| at.len() == 1 || at.len() > 2).collect();
        for &corner in mesh.corners {
            fixed[corner as usize] = true;
        }
        chains::orient(&mut ends, &at, &fixed);
        let edges = ends
            .into_iter()
            .zip(sharp)
            .map(|(ends, sharp)| Edge {
                ends,
                opposite: [NONE; 2],
                fans: [0; 2],
                sharp,
            })
            .collect();
        let kinds = fixed
            .into_iter()
            .map(|fixed| if fixed { Kind::Corner } else { Kind::Smooth })
            .collect();
        let mut level = Self::joined(mesh.triangles.to_vec(), sides, edges, kinds);
        level.count_fans();
        level
    }

    /// Completes a level whose corners are known.
    fn joined(
        triangles: Vec<[u32; 3]>,
        sides: Vec<[u32; 3]>,
        mut edges: Vec<Edge>,
        mut kinds: Vec<Kind>,
    ) -> Self {
        for (t, side) in triangles.iter().zip(&sides) {
            for i in 0..3 {
                let opposite = &mut edges[side[i] as usize].opposite;
                let free = usize::from(opposite[0] != NONE);
                opposite[free] = t[(i + 2) % 3];
            }
        }
        let mut spoke_ends = vec![0_u32; kinds.len()];
        for end in edges.iter().flat_map(|e| e.ends) {
            spoke_ends[end as usize] += 1;
        }
        let mut sum = 0;
        for end in &mut spoke_ends {
            // For now where the vertex's spokes begin; filling moves it to where they end.
            (*end, sum) = (sum, sum + *end);
        }
        let mut spokes = vec![0; sum as usize];
        for (number, edge) in edges.iter().enumerate() {
            for end in edge.ends {
                let place = &mut spoke_ends[end as usize];
                spokes[*place as usize] = number as u32;
                *place += 1;
            }
        }
        // Corners are settled: the rest of the vertices on sharp edges have one before and one after.
        for edge in edges.iter().filter(|e| e.sharp) {
            let [a, b] = edge.ends;
            for (vertex, before, after) in [(a, NONE, b), (b, a, NONE)] {
                let kind = &mut kinds[vertex as usize];
                *kind = match *kind {
                    Kind::Corner => Kind::Corner,
                    Kind::Smooth => Kind::Crease(before, after),
                    Kind::Crease(p, n) => Kind::Crease(p.min(before), n.min(after)),
                };
            }
        }
        Self {
            triangles,
            sides,
            edges,
            kinds,
            spokes,
            spoke_ends,
        }
    }

    /// Counts the triangles between the sharp edges round each vertex of a crease.
    fn count_fans(&mut self) {
        let mut round = vec![Vec::new(); self.kinds.len()];
        for (number, t) in self.triangles.iter().enumerate() {
            for &corner in t {
                if matches!(self.kinds[corner as usize], Kind::Crease(..)) {
                    round[corner as usize].push(number);
                }
            }
        }
        for (vertex, triangles) in round.iter().enumerate() {
            let vertex = vertex as u32;
            let mut left = triangles.clone();
            while let Some(first) = left.pop() {
                // Grow the fan over edges that are not sharp.
                let mut fan = vec![first];
                let mut at = 0;
                while at < fan.len() {
                    for side in self.sides[fan[at]] {
                        let edge = self.edges[side as usize];
                        if edge.sharp || !edge.ends.contains(&vertex) {
                            continue;
                        }
                        while let Some(next) =
                            left.iter().position(|&t| self.sides[t].contains(&side))
                        {
                            fan.push(left.swap_remove(next));
                        }
                    }
                    at += 1;
                }
                let count = fan.len().min(255) as u8;
                for side in fan.iter().flat_map(|&t| self.sides[t]) {
                    let edge = &mut self.edges[side as usize];
                    if let Some(end) = edge.ends.iter().position(|&e| e == vertex) {
                        edge.fans[end] = count;
                    }
                }
            }
        }
    }

    pub(super) fn point_count(&self) -> usize {
        self.kinds.len()
    }

    /// The next level.
    pub(super) fn refined(&self) -> Self {
        let points = self.point_count() as u32;
        let halves = 2 * self.edges.len() as u32;
        let mut edges = Vec::with_capacity(2 * self.edges.len() + 3 * self.triangles.len());
        for (middle, edge) in (points..).zip(&self.edges) {
            let [a, b] = edge.ends;
            // A new vertex of a crease has three triangles on each side.
            for (ends, fans) in [
                ([a, middle], [edge.fans[0], 3]),
                ([middle, b], [3, edge.fans[1]]),
            ] {
                edges.push(Edge {
                    ends,
                    opposite: [NONE; 2],
                    fans,
                    sharp: edge.sharp,
                });
            }
        }
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        let mut sides = Vec::with_capacity(4 * self.triangles.len());
        for (number, (t, side)) in self.triangles.iter().zip(&self.sides).enumerate() {
            let m = side.map(|s| points + s);
            // Across the corners: edge i cuts off corner i.
            let across = [0, 1, 2].map(|i| halves + 3 * number as u32 + i);
            for i in 0..3 {
                let before = (i + 2) % 3;
                edges.push(Edge {
                    ends: [m[i], m[before]],
                    opposite: [NONE; 2],
                    fans: [3; 2],
                    sharp: false,
                });
                let half = |s: u32| 2 * s + u32::from(self.edges[s as usize].ends[0] != t[i]);
                triangles.push([t[i], m[i], m[before]]);
                sides.push([half(side[i]), across[i], half(side[before])]);
            }
            triangles.push(m);
            sides.push([across[1], across[2], across[0]]);
        }
        let mut kinds: Vec<Kind> = self
            .kinds
            .iter()
            .map(|kind| match kind {
                Kind::Corner => Kind::Corner,
                _ => Kind::Smooth,
            })
            .collect();
        kinds.resize(self.point_count() + self.edges.len(), Kind::Smooth);
        Self::joined(triangles, sides, edges, kinds)
    }

    /// The weights of this level's points that make point `number` of the next.
    pub(super) fn next_terms(&self, number: u32, terms: &mut Vec<(u32, f64)>) {
        let points = self.point_count() as u32;
        if number >= points {
            self.edge_terms(&self.edges[(number - points) as usize], terms);
            return;
        }
        match self.kinds[number as usize] {
            Kind::Corner => terms.push((number, 1.0)),
            Kind::Crease(before, after) => {
                terms.extend([(before, 0.125), (number, 0.75), (after, 0.125)]);
            }
            Kind::Smooth => {
                let beta = loop_weight(self.spokes(number).len());
                self.fan_terms(number, terms, |_| beta);
            }
        }
    }

    /// The weights of this level's points that make the limit of point `number`.
    pub(super) fn limit_terms(&self, number: u32, terms: &mut Vec<(u32, f64)>) {
        match self.kinds[number as usize] {
            Kind::Corner => terms.push((number, 1.0)),
            Kind::Crease(before, after) => {
                terms.extend([(before, 1.0 / 6.0), (number, 2.0 / 3.0), (after, 1.0 / 6.0)]);
            }
            // One step with this level's own edge weights, then the limit of the even fan it makes.
            Kind::Smooth => {
                let beta = loop_weight(self.spokes(number).len());
                let count = self.spokes(number).len() as f64;
                let chi = 1.0 / (count + 0.375 / beta);
                let rest = (1.0 - count * chi) * beta;
                self.fan_terms(number, terms, |edge| {
                    let own = usize::from(edge.ends[0] != number);
                    rest + chi * (1.0 - self.end_shares(edge)[own])
                });
            }
        }
    }

    fn spokes(&self, number: u32) -> &[u32] {
        let start = match number {
            0 => 0,
            n => self.spoke_ends[n as usize - 1] as usize,
        };
        &self.spokes[start..self.spoke_ends[number as usize] as usize]
    }

    /// A vertex and its neighbours with `weight`s; the vertex has what is left of 1.
    fn fan_terms(&self, number: u32, terms: &mut Vec<(u32, f64)>, weight: impl Fn(&Edge) -> f64) {
        let own = terms.len();
        terms.push((number, 1.0));
        for &spoke in self.spokes(number) {
            let edge = &self.edges[spoke as usize];
            let weight = weight(edge);
            terms.push((edge.ends[usize::from(edge.ends[0] == number)], weight));
            terms[own].1 -= weight;
        }
    }

    fn edge_terms(&self, edge: &Edge, terms: &mut Vec<(u32, f64)>) {
        let [a, b] = edge.ends;
        if edge.sharp {
            terms.extend([(a, 0.5), (b, 0.5)]);
            return;
        }
        let [share_a, share_b] = self.end_shares(edge);
        terms.extend([(a, share_a), (b, share_b)]);
        terms.extend(edge.opposite.map(|o| (o, 0.125)));
    }

    /// Shares of an edge's ends in the point on it, unless it is sharp.
    fn end_shares(&self, edge: &Edge) -> [f64; 2] {
        let creased = edge
            .ends
            .map(|end| matches!(self.kinds[end as usize], Kind::Crease(..)));
        let share = |fan: u8| 0.5 - 0.25 * (std::f64::consts::PI / f64::from(fan.max(1))).cos();
        match creased {
            [true, false] => {
                let own = share(edge.fans[0]);
                [own, 0.75 - own]
            }
            [false, true] => {
                let own = share(edge.fans[1]);
                [0.75 - own, own]
            }
            _ => [0.375; 2],
        }
    }
}

/// Loop's weight of each of `count` neighbours.
fn loop_weight(count: usize) -> f64 {
    let count = count.max(1) as f64;
    let inner = 0.375 + 0.25 * (std::f64::consts::TAU / count).cos();
    (0.625 - inner * inner) / count
}
