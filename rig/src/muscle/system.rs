//! All fibres of a head at a moment: each contracted alone, merged ones joined, contracted ones thicker.
//!
//! A pure function of controls and mandible: what is kept from call to call are buffers, and that a fibre
//! at rest stays there is only a short cut.

use glam::{Affine3A, Vec3, Vec3A};

use super::bulge::thickened;
use super::merge::Joined;
use super::{Measure, length};
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
    /// Per fibre: measures at rest, whether it hangs on the mandible, how hard it works.
    measures: Vec<Measure>,
    hangs: Vec<bool>,
    works: Vec<f32>,
    /// Per point: how far a muscle twice as thick pushes the skin, mm.
    swelling: Vec<Vec3A>,
    joined: Vec<Group>,
}

/// Joined muscles, and which fibres they are.
#[derive(Clone, Debug)]
struct Group {
    joined: Joined,
    fibres: Vec<usize>,
}

impl Muscles {
    pub(crate) fn new(head: &Head) -> Self {
        let fibres = &head.fibres;
        let rest: Vec<Vec3> = fibres.iter().flat_map(|f| f.points.clone()).collect();
        let mut starts = vec![0];
        for fibre in fibres {
            starts.push(starts[starts.len() - 1] + fibre.points.len());
        }
        let swelling = fibres
            .iter()
            .flat_map(|f| (0..f.points.len()).map(|i| f.swelling(i).into()))
            .collect();
        let joined = Joined::find(fibres, &starts)
            .into_iter()
            .map(|joined| Group {
                fibres: joined.fibres().collect(),
                joined,
            })
            .collect();
        Self {
            points: rest.clone(),
            shift: vec![Vec3A::ZERO; rest.len()],
            moved: vec![false; fibres.len()],
            measures: fibres.iter().map(Measure::new).collect(),
            hangs: fibres.iter().map(super::Fibre::hangs_on_mandible).collect(),
            works: vec![0.0; fibres.len()],
            swelling,
            joined,
            rest,
            starts,
        }
    }

    /// Where every control point is now; those of a fibre lie between two of [`Self::starts`].
    pub(crate) fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// How far skin on every control point is drawn and pushed from rest.
    pub(crate) fn shift(&self) -> &[Vec3A] {
        &self.shift
    }

    /// Where each fibre starts among the points, and where the last one ends.
    pub(crate) fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// Bit k mod 128 is set when anything of fibre k is away from rest.
    pub(crate) fn moved_bits(&self) -> u128 {
        (0..)
            .zip(&self.moved)
            .fold(0, |bits, (k, moved)| bits | u128::from(*moved) << (k % 128))
    }

    /// Contracts all fibres as `state` has it.
    pub(crate) fn contract(&mut self, head: &Head, state: &Controls, mandible: &Affine3A) {
        let jaw_still = state[Control::Jaw].abs() < STILL;
        // Each alone; `moved` says for now whether it was away from rest before.
        for (k, fibre) in head.fibres.iter().enumerate() {
            let range = self.starts[k]..self.starts[k + 1];
            let works = fibre.works(&self.measures[k], state);
            self.works[k] = works;
            if works >= STILL || (self.hangs[k] && !jaw_still) {
                let points = &mut self.points[range];
                fibre.contract(&self.measures[k], state, mandible, points);
                self.moved[k] = true;
            } else if self.moved[k] {
                self.still(k);
            }
        }
        for group in &mut self.joined {
            if group.fibres.iter().all(|k| !self.moved[*k]) {
                continue;
            }
            let Self {
                works,
                rest,
                starts,
                points,
                ..
            } = self;
            group.joined.resolve(works, mandible, rest, starts, points);
            for &k in &group.fibres {
                self.moved[k] = true;
            }
        }
        for k in 0..self.moved.len() {
            if self.moved[k] && !self.shift_fibre(k) {
                self.still(k);
            }
        }
    }

    /// Puts a fibre exactly to rest.
    fn still(&mut self, k: usize) {
        let range = self.starts[k]..self.starts[k + 1];
        self.points[range.clone()].copy_from_slice(&self.rest[range.clone()]);
        self.shift[range].fill(Vec3A::ZERO);
        self.moved[k] = false;
    }

    /// Sets how far one fibre is from rest, and says whether it is.
    fn shift_fibre(&mut self, k: usize) -> bool {
        let range = self.starts[k]..self.starts[k + 1];
        let now = length(&self.points[range.clone()]);
        let thicker = thickened(self.measures[k].length, now) - 1.0;
        let mut moved = false;
        for i in range {
            let shift = Vec3A::from(self.points[i] - self.rest[i]) + self.swelling[i] * thicker;
            moved |= shift.length_squared() > STILL_MM * STILL_MM;
            self.shift[i] = shift;
        }
        moved
    }
}
