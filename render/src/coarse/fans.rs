//! Triangles round each vertex, and triangles ring by ring.

use std::collections::VecDeque;
use std::ops::Range;

/// Triangles by vertex, in flat arrays.
pub(crate) struct Fans {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Fans {
    pub(crate) fn of(triangles: &[[u32; 3]], vertices: usize) -> Self {
        let mut starts = vec![0_u32; vertices + 1];
        for &i in triangles.as_flattened() {
            starts[i as usize + 1] += 1;
        }
        for i in 0..vertices {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut by_vertex = vec![0; triangles.len() * 3];
        for (number, t) in triangles.iter().enumerate() {
            for &i in t {
                by_vertex[next[i as usize] as usize] = number as u32;
                next[i as usize] += 1;
            }
        }
        Self {
            starts,
            triangles: by_vertex,
        }
    }

    fn range(&self, vertex: u32) -> Range<usize> {
        let i = vertex as usize;
        self.starts[i] as usize..self.starts[i + 1] as usize
    }

    /// The numbers of a vertex's triangles.
    pub(crate) fn at(&self, vertex: u32) -> &[u32] {
        &self.triangles[self.range(vertex)]
    }
}

/// The triangles ring by ring from a first one, so that a vertex is met again soon: what draws them remembers a few.
pub(crate) fn in_rings(triangles: &[[u32; 3]], vertices: usize) -> Vec<[u32; 3]> {
    let fans = Fans::of(triangles, vertices);
    let mut out = Vec::with_capacity(triangles.len());
    let mut taken = vec![false; triangles.len()];
    let mut seen = vec![false; vertices];
    let mut coming = VecDeque::new();
    for &[first, ..] in triangles {
        coming.push_back(first);
        while let Some(vertex) = coming.pop_front() {
            if std::mem::replace(&mut seen[vertex as usize], true) {
                continue;
            }
            for &number in fans.at(vertex) {
                if !std::mem::replace(&mut taken[number as usize], true) {
                    let triangle = triangles[number as usize];
                    out.push(triangle);
                    coming.extend(triangle);
                }
            }
        }
    }
    out
}
