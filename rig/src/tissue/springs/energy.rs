//! The energy of springs and masses, by the formulas that the forces are the slopes of; in f64 and without haste.

use glam::Vec3A;

use super::simd::MOST;
use super::{BLEND, EDGE, SLACK, STOP, SpringPass, Springs, VOLUME};
use crate::Control;
use crate::tissue::Drive;

impl Springs {
    /// Energy per mass, mm²/s². Leapfrog has velocities half a step before and half a step after the places; of
    /// a mode that swings, what it conserves is with the product of the two.
    pub(super) fn energy_now(&self, drive: &Drive<'_>) -> f64 {
        let mut after = self.clone();
        after.accelerate(drive);
        let place = |i: usize| self.nodes.place[i].as_dvec3();
        let mut energy = 0.0;
        self.mesh.each_node(|i, node| {
            if i >= self.movable {
                return;
            }
            let (before, after) = (self.nodes.velocity[i], after.nodes.velocity[i]);
            energy += 0.5 * before.as_dvec3().dot(after.as_dvec3());
            for (other, rest) in &node.edges {
                let length = place(*other).distance(place(i));
                // Half of it, where the edge is met again at its other end.
                let share = if *other < self.movable { 0.5 } else { 1.0 };
                energy += f64::from(self.per_mass) * share * edge(length, f64::from(*rest));
            }
            let away = place(i) - node.rest.as_dvec3();
            let carried = drive.mandible.transform_point3a(node.rest) - node.rest;
            let off = away - (carried * node.share).as_dvec3();
            let beyond = (off.length() - f64::from(node.slip)).max(0.0);
            let deep = (-node.normal.as_dvec3().dot(off) - f64::from(node.gap)).max(0.0);
            let mut held = f64::from(node.soft) * off.length_squared()
                + f64::from(node.firm) * beyond * beyond
                + f64::from(STOP) * deep * deep;
            for (stiffness, shift) in node.ties(self.places.shift()) {
                let off = (away - shift.as_dvec3()).length_squared();
                held += f64::from(stiffness * drive.muscle_stiffness) * off;
            }
            energy += 0.5 * f64::from(self.per_mass) * held;
        });
        self.lids.pull(drive, |i, target: Vec3A, stiffness| {
            let off = (target.as_dvec3() - place(i)).length_squared();
            energy += 0.5 * f64::from(self.per_mass * stiffness) * off;
        });
        let jaw = drive.state[Control::Jaw];
        for cheek in &self.cheeks {
            let excess = f64::from(cheek.volume(&self.nodes, &drive.mandible, jaw) - cheek.rest);
            energy += 0.5 * f64::from(self.per_mass * VOLUME * drive.volume) * excess * excess
                / f64::from(cheek.rest.max(1.0));
        }
        energy
    }
}

/// Work done on an edge of length `rest` to make it `length`: the kernel's `length * stress(strain)`, integrated
/// over the length, which is its stress over Green's strain.
fn edge(length: f64, rest: f64) -> f64 {
    let (slack, blend) = (f64::from(SLACK), f64::from(BLEND));
    let strain = 0.5 * (length * length / (rest * rest) - 1.0);
    let torn = (strain - f64::from(MOST)).max(0.0);
    let strain = strain - torn;
    let near = strain.abs().min(blend);
    let past = strain.abs() - near;
    let odd = near.powi(3) / (6.0 * blend) + 0.5 * past * (blend + past);
    let even = 0.5 * strain * strain;
    let work = 0.5 * ((1.0 + slack) * even + (1.0 - slack) * odd.copysign(strain));
    f64::from(EDGE) * rest * rest * (work + torn * SpringPass::stress(strain))
}
