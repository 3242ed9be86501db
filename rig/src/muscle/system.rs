//! All fibres of a head in motion: contracted, merged, and how far each control point is from rest.

use glam::{Affine3A, Vec3, Vec3A};

use super::{Merge, carried, merges};
use crate::{Control, Controls, Head};

/// A control nearer to 0 than this does nothing, and a fibre's point nearer to rest than so many mm.
const STILL: f32 = 1e-6;
const STILL_MM: f32 = 1e-5;

/// The fibres' control points, all in one list.
#[derive(Clone, Debug)]
pub(crate) struct Muscles {
    points: Vec<Vec3>,
    rest: Vec<Vec3>,
    shift: Vec<Vec3A>,
    /// Where each fibre starts among the points, and where the last one ends.
    starts: Vec<usize>,
    /// Whether anything of a fibre is away from rest.
    moved: Vec<bool>,
    merges: Vec<Merge>,
}

impl Muscles {
    pub(crate) fn new(head: &Head) -> Self {
        let rest: Vec<Vec3> = head
            .fibres
            .iter()
            .flat_map(|f| f.points.iter().copied())
            .collect();
        let mut starts = vec![0];
        for fibre in &head.fibres {
            starts.push(starts[starts.len() - 1] + fibre.points.len());
        }
        Self {
            points: rest.clone(),
            shift: vec![Vec3A::ZERO; rest.len()],
            moved: vec![false; head.fibres.len()],
            merges: merges(&head.fibres),
            rest,
            starts,
        }
    }

    /// Where every control point is now; those of a fibre lie between two of [`Self::starts`].
    pub(crate) fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// How far every control point is from rest.
    pub(crate) fn shift(&self) -> &[Vec3A] {
        &self.shift
    }

    /// Where each fibre starts among the points, and where the last one ends.
    pub(crate) fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// Whether anything of a fibre is away from rest.
    pub(crate) fn moved(&self, fibre: usize) -> bool {
        self.moved[fibre]
    }

    /// Contracts all fibres as `state` has it.
    pub(crate) fn contract(&mut self, head: &Head, state: &Controls, mandible: &Affine3A) {
        let jaw_still = state[Control::Jaw].abs() < STILL;
        for (k, fibre) in head.fibres.iter().enumerate() {
            let range = self.starts[k]..self.starts[k + 1];
            if fibre.rests(state, jaw_still, STILL) {
                self.points[range.clone()].copy_from_slice(&self.rest[range]);
            } else {
                fibre.contracted(state, mandible, &mut self.points[range]);
            }
        }
        for merge in &self.merges {
            let end = self.starts[merge.puller + 1] - 1;
            let puller = &head.fibres[merge.puller];
            let share = puller.mandible.last().copied().unwrap_or(0.0);
            let pull = self.points[end] - carried(self.rest[end], share, mandible);
            self.points[self.starts[merge.fibre] + merge.point] += pull * merge.share;
        }
        for ((shift, point), rest) in self.shift.iter_mut().zip(&self.points).zip(&self.rest) {
            *shift = (*point - *rest).into();
        }
        for (moved, range) in self.moved.iter_mut().zip(self.starts.windows(2)) {
            *moved = self.shift[range[0]..range[1]]
                .iter()
                .any(|s| s.length_squared() > STILL_MM * STILL_MM);
        }
    }
}
