//! Weighted sums in flat arrays: what a frame costs. Also the sums of sums that build them.

use glam::{Vec3, Vec3A};

/// Rows of (index, weight); each row's weights sum to 1.
#[derive(Clone, Debug, Default)]
pub struct Stencils {
    /// Where each row ends.
    ends: Vec<u32>,
    indices: Vec<u32>,
    weights: Vec<f32>,
}

impl Stencils {
    /// How many rows there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// How many weights all rows have together.
    #[must_use]
    pub fn weight_count(&self) -> usize {
        self.weights.len()
    }

    pub(super) fn push(&mut self, row: impl Iterator<Item = (u32, f32)>) {
        for (index, weight) in row {
            self.indices.push(index);
            self.weights.push(weight);
        }
        self.ends.push(self.indices.len() as u32);
    }

    /// The indices and weights of one row; none where there is no such row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (u32, f32)> {
        let start = row
            .checked_sub(1)
            .and_then(|before| self.ends.get(before))
            .map_or(0, |e| *e as usize);
        let end = self.ends.get(row).map_or(start, |e| *e as usize);
        let range = start..end;
        self.indices[range.clone()]
            .iter()
            .copied()
            .zip(self.weights[range].iter().copied())
    }

    /// Sums each row over points. Allocates nothing.
    pub fn apply(&self, from: &[Vec3], out: &mut [Vec3]) {
        debug_assert_eq!(out.len(), self.len());
        let mut start = 0;
        for (out, &end) in out.iter_mut().zip(&self.ends) {
            let range = start..end as usize;
            start = end as usize;
            let mut sum = Vec3A::ZERO;
            for (&i, &w) in self.indices[range.clone()].iter().zip(&self.weights[range]) {
                sum += Vec3A::from(from[i as usize]) * w;
            }
            *out = sum.into();
        }
    }
}

/// Adds up sums of sums, in order of first appearance.
#[derive(Debug)]
pub(super) struct Mixer {
    place: Vec<u32>,
    row: Vec<(u32, f64)>,
}

impl Mixer {
    pub(super) fn new(control_count: usize) -> Self {
        Self {
            place: vec![u32::MAX; control_count],
            row: Vec::new(),
        }
    }

    /// The row that is `share` times each of `rows`.
    pub(super) fn mix<'a>(
        &mut self,
        rows: impl Iterator<Item = (&'a [(u32, f64)], f64)>,
    ) -> &[(u32, f64)] {
        for &(index, _) in &self.row {
            self.place[index as usize] = u32::MAX;
        }
        self.row.clear();
        for (row, share) in rows {
            for &(index, weight) in row {
                let place = &mut self.place[index as usize];
                if *place == u32::MAX {
                    *place = self.row.len() as u32;
                    self.row.push((index, 0.0));
                }
                self.row[*place as usize].1 += weight * share;
            }
        }
        &self.row
    }
}
