//! Muscles that LEE lacks, as forces of our own by his profiles.
//!
//! Linear ones pull along their fibre as it bends, `Θ1` by the way along it and `Θ2` by the distance from it. A
//! sphincter (both halves of the orbicularis oris, the orbicularis oculi) draws what lies near its fibres to
//! its axis, by the distance that is left, and pushes it along the axis by its protrusion. Muscles
//! between bones push outwards what lies over their bellies.

use glam::{Affine3A, Vec3, Vec4, vec3};

use super::layers::Layers;
use super::springs::Columns;
use super::strength::{self, Strength};
use super::vectors::{Actuator, across, along, is_vector, other_lip, over_bone};
use crate::muscle::{Contraction, carried};
use crate::tissue::anatomy::Side;
use crate::{Control, Controls, Fibre, Head, Muscle};

/// A sphincter's fibre: nodes that it draws to its axis, each with its share.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    muscle: Muscle,
    left: bool,
    centre: Vec3,
    mandible: f32,
    /// Forces per mass at full contraction per mm from the axis, 1/s², and at full protrusion, mm/s².
    draw: f32,
    protrude: f32,
    nodes: Vec<(u32, f32)>,
}

/// Radius that a sphincter's strength is meant at, mm: nearer to its axis it draws less.
const RADIUS_MM: f32 = 20.0;
/// Force of protrusion per mm that the default model protrudes a free fibre by, mm/s² per mass.
const PROTRUDE_PER_MM: f32 = 11_000.0;

/// How a node lies to a fibre: shares of the way along it and distance, and the direction to its start.
struct Nearest {
    ratio: f32,
    distance: f32,
    back: Vec3,
    beyond: f32,
}

fn nearest(fibre: &Fibre, p: Vec3) -> Nearest {
    let total: f32 = fibre.points.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut best = Nearest {
        ratio: 0.0,
        distance: f32::MAX,
        back: Vec3::ZERO,
        beyond: 0.0,
    };
    let mut walked = 0.0;
    for w in fibre.points.windows(2) {
        let d = w[1] - w[0];
        let length = d.length().max(1e-3);
        let share = (p - w[0]).dot(d) / (length * length);
        let on = share.clamp(0.0, 1.0);
        let distance = p.distance(w[0] + d * on);
        if distance < best.distance {
            best = Nearest {
                ratio: (walked + on * length) / total.max(1e-3),
                distance,
                back: -d / length,
                beyond: (share - on).max(0.0) * length,
            };
        }
        walked += length;
    }
    best
}

const fn of_the_nose(muscle: Muscle) -> bool {
    matches!(muscle, Muscle::DilatorNaris | Muscle::DepressorSeptiNasi)
}

/// Linear muscles and bellies that LEE has no vector for.
pub(super) fn linear(
    head: &Head,
    layers: &Layers,
    movable: usize,
    side: &[Side],
    lids: &[f32],
) -> Vec<Actuator> {
    let mut actuators = Vec::new();
    for muscle in Muscle::ALL.into_iter().filter(|m| !is_vector(*m)) {
        let Strength { force, reach_mm } = strength::of(muscle);
        for left in [true, false] {
            let of_side = |f: &&Fibre| {
                let sphincter = matches!(f.contraction, Contraction::Sphincter { .. });
                let middle: f32 = f.points.iter().map(|p| p.x).sum();
                f.muscle == muscle && (middle > 0.0) == left && !sphincter
            };
            let fibres: Vec<&Fibre> = head.fibres.iter().filter(of_side).collect();
            let mut forces = Vec::new();
            for i in 0..movable {
                if other_lip(muscle, side[i]) {
                    continue;
                }
                // The fibre that has most to say, so that a muscle of many is no stronger.
                let mut most = (1e-3, Vec3::ZERO);
                for fibre in &fibres {
                    let near = nearest(fibre, layers.fascia[i]);
                    let wide = across(near.distance / reach_mm);
                    let (weight, way) = match fibre.contraction {
                        Contraction::Belly { out } => {
                            let belly = (std::f32::consts::PI * near.ratio).sin();
                            (wide * belly, out.normalize_or_zero())
                        }
                        // What lies behind the wings and the septum stops them: they go aside and down.
                        _ if of_the_nose(muscle) => {
                            let way = near.back * vec3(1.0, 1.0, 0.0);
                            (wide * along(near.ratio), way.normalize_or_zero())
                        }
                        _ => (
                            wide * along(near.ratio) * across(near.beyond / reach_mm),
                            near.back,
                        ),
                    };
                    let weight = weight * (1.0 - lids[i]).powi(2);
                    if weight > most.0 {
                        most = (weight, way);
                    }
                }
                if most.1 != Vec3::ZERO {
                    forces.push((
                        i as u32,
                        over_bone(most.1, layers.out[i]) * (most.0 * force),
                    ));
                }
            }
            if !forces.is_empty() {
                actuators.push(Actuator {
                    muscles: [muscle, muscle],
                    left,
                    forces,
                });
            }
        }
    }
    actuators
}

/// The fibres of sphincters.
pub(super) fn rings(
    head: &Head,
    layers: &Layers,
    movable: usize,
    side: &[Side],
    lids: &[f32],
) -> Vec<Ring> {
    let mut rings: Vec<Ring> = Vec::new();
    for muscle in Muscle::ALL {
        let Strength { force, reach_mm } = strength::of(muscle);
        let first = rings.len();
        for fibre in head.fibres.iter().filter(|f| f.muscle == muscle) {
            let Contraction::Sphincter {
                centre,
                mandible,
                protrusion_mm,
                ..
            } = fibre.contraction
            else {
                continue;
            };
            let share = |i: u32| {
                let k = i as usize;
                let near = nearest(fibre, layers.fascia[k]);
                let alone = if muscle == Muscle::OrbicularisOculiOrbital {
                    (1.0 - lids[k]).powi(2)
                } else {
                    1.0
                };
                let on = across(near.distance / reach_mm) * alone;
                (!other_lip(muscle, side[k]) && on > 1e-3).then_some((i, on))
            };
            rings.push(Ring {
                muscle,
                left: centre.x > 0.0,
                centre,
                mandible,
                draw: force / RADIUS_MM,
                protrude: protrusion_mm * PROTRUDE_PER_MM,
                nodes: (0..movable as u32).filter_map(share).collect(),
            });
        }
        // Where fibres of one muscle and side lie side by side, they share the node.
        let mut sums = vec![[0.0_f32; 2]; movable];
        for ring in &rings[first..] {
            for (i, share) in &ring.nodes {
                sums[*i as usize][usize::from(ring.left)] += share;
            }
        }
        for ring in &mut rings[first..] {
            for (i, share) in &mut ring.nodes {
                *share /= sums[*i as usize][usize::from(ring.left)].max(1.0);
            }
        }
    }
    rings
}

impl Ring {
    /// Adds its forces on fascia nodes; `scale` multiplies all of them.
    pub(super) fn pull(
        &self,
        state: &Controls,
        mandible: &Affine3A,
        scale: f32,
        place: &Columns,
        force: &mut Columns,
    ) {
        let draw = state.contraction(self.muscle, self.left) * self.draw * scale;
        let forward = match self.muscle {
            Muscle::OrbicularisOrisSuperior => state[Control::ProtrusionSuperior],
            Muscle::OrbicularisOrisInferior => state[Control::ProtrusionInferior],
            _ => 0.0,
        } * self.protrude
            * scale;
        if draw == 0.0 && forward == 0.0 {
            return;
        }
        let axis = carried(self.centre, self.mandible, mandible);
        let flat = vec3(1.0, 1.0, 0.0);
        for &(i, share) in &self.nodes {
            let p = place[i as usize][1].truncate();
            let f = (axis - p) * flat * draw + Vec3::Z * forward;
            force[i as usize][1] += Vec4::from((f, draw)) * share;
        }
    }
}
