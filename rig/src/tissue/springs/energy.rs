//! The energy of springs and masses, by the formulas that the forces are the slopes of; in f64 and without haste.

use glam::Vec3A;

use super::{EDGE, SLACK, STOP, Springs, VOLUME};
use crate::Control;
use crate::tissue::Drive;

impl Springs {
    /// Energy per mass, mm²/s². The velocities are those half a step before the places: over many steps
    /// the mean tells whether energy leaves or comes.
    pub(super) fn energy_now(&self, drive: &Drive<'_>) -> f64 {
        let place = |i: usize| self.nodes.place[i].as_dvec3();
        let mut energy = 0.0;
        self.mesh.each_node(|i, node| {
            if i >= self.movable {
                return;
            }
            energy += 0.5 * self.nodes.velocity[i].as_dvec3().length_squared();
            for (other, rest) in &node.edges {
                let stretch = place(*other).distance(place(i)) - f64::from(*rest);
                let stiffness =
                    f64::from(EDGE) * if stretch < 0.0 { f64::from(SLACK) } else { 1.0 };
                // Half of it, where the edge is met again at its other end.
                let share = if *other < self.movable { 0.25 } else { 0.5 };
                energy += f64::from(self.per_mass) * share * stiffness * stretch * stretch;
            }
            let away = place(i) - node.rest.as_dvec3();
            let carried = drive.mandible.transform_point3a(node.rest) - node.rest;
            let off = away - (carried * node.share).as_dvec3();
            let beyond = (off.length() - f64::from(node.slip)).max(0.0);
            let deep = (-node.normal.as_dvec3().dot(off) - f64::from(node.gap)).max(0.0);
            let mut held = f64::from(node.soft) * off.length_squared()
                + f64::from(node.firm) * beyond * beyond
                + f64::from(STOP) * deep * deep;
            for (stiffness, shift) in node.ties(drive.muscles.shift()) {
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
