//! The energy of springs and masses, by the formulas that the forces are the slopes of; in f64 and without haste.

use glam::Vec3A;

use super::simd::{MOST, SOFTEN};
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
            energy += 0.5 * before.as_dvec3().dot(after.as_dvec3()) / f64::from(node.light);
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
    let [slack, blend, most, soften] = [SLACK, BLEND, MOST, SOFTEN].map(f64::from);
    let strain = 0.5 * (length * length / (rest * rest) - 1.0);
    let torn = (strain - most).max(0.0);
    let strain = strain - torn;
    // The strain, softened, over the strain; then what of it is beyond the parabola round rest.
    let softened = |e: f64| e * e * (0.5 - soften * e / 3.0);
    let sign = 1.0_f64.copysign(strain);
    let edge = 0.5 * (1.0 - (1.0 - sign * 4.0 * soften * blend).sqrt()) / soften;
    let near = if sign > 0.0 {
        strain.min(edge)
    } else {
        strain.max(edge)
    };
    let parabola =
        near.powi(3) / 3.0 - soften * near.powi(4) / 2.0 + soften * soften * near.powi(5) / 5.0;
    let past = sign * (softened(strain) - softened(near)) - 0.5 * blend * (strain - near);
    let odd = parabola / (2.0 * blend) + past;
    let work = 0.5 * ((1.0 + slack) * softened(strain) + (1.0 - slack) * odd);
    f64::from(EDGE) * rest * rest * (work + torn * SpringPass::stress(strain))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_stores_what_it_is_stretched_with() {
        let (rest, step) = (1.3, 1e-4);
        for i in 0..120 {
            let length = rest * (0.6 + 0.01 * f64::from(i));
            let slope = (edge(length + step, rest) - edge(length - step, rest)) / (2.0 * step);
            let strain = 0.5 * (length * length / (rest * rest) - 1.0);
            let pull = f64::from(EDGE) * length * SpringPass::stress(strain);
            assert!(
                (slope - pull).abs() < 1e-3 * f64::from(EDGE),
                "{length}: {slope}, {pull}"
            );
        }
    }
}
