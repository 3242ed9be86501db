//! The tongue: root, blade and tip on the mandible, moved by three muscles' targets, inside the mouth.
//!
//! HABER 4.1 has a rigid tongue and says no more of it. Here it has three degrees of freedom with
//! inertia, those of [`Control::TongueTip`], [`Control::TongueOut`] and [`Control::TongueBody`]; being the
//! whole of its state they are kept in a key frame and go back with it. Teeth and palate stop it at
//! places of its surface, without rebound ([`mouth`]); the floor that it lies on moves with the mandible.
//! A tongue that is put out gets thinner, as flesh of constant volume does, and looks for the gap
//! between the incisors; where there is none it stays behind them. It has no grooves, no sideways
//! motion and does not press on the lips.

mod mouth;

use glam::{Affine3A, Quat, Vec3, vec3};

use crate::follow::Follow;
use crate::head::about;
use crate::mesh::ramp;
use crate::{Body, Control, Controls, Head};
use mouth::Side;

/// Its degrees of freedom, in the order of all arrays below.
const FREEDOMS: [Control; 3] = [Control::TongueTip, Control::TongueOut, Control::TongueBody];
/// How fast each comes to where it is wanted (critically damped), 1/s: the tip is lighter than the body.
const RATES: [f32; 3] = [145.0, 130.0, 122.0];
/// How easily contact moves each of them, against the others, per unit of control: inverse masses of
/// 8 g of tip swung by 13 mm, of 80 g of blade and root drawn forward by 7 mm, lifted by 7 mm.
const EASE: [f32; 3] = [1.0, 0.35, 0.35];
/// Passes over all contacts in a step, and overlaps that count as touching, mm.
const PASSES: usize = 6;
const SLOP_MM: f32 = 0.05;
/// Speeds that count as none, per second.
const STILL: f32 = 1e-3;
/// Step of a control by which the way of a place is found.
const NUDGE: f32 = 1e-3;

/// What root and blade turn about, on the reference head, mm.
const ROOT: Vec3 = vec3(0.0, -46.0, 45.0);
const BLADE: Vec3 = vec3(0.0, -36.0, 80.0);
/// At full height of its body: how far the blade rises and goes back, mm, how it tilts and how the tip hangs from
/// it, radians. Chosen so that the back, not the blade, comes to the palate first.
const ARCH_MM: f32 = 11.0;
const BACK_MM: f32 = 4.0;
const ARCH_PITCH: f32 = 0.08;
const TIP_HANGS: f32 = 0.5;
/// Middle of the tip's height where it lies on the lower incisors, and its thickness there, mm.
const TIP_Y: f32 = -36.1;
const TIP_MM: f32 = 3.4;
/// How far it may come forward behind closed teeth, as a control's value.
const OUT_BEHIND: f32 = 0.12;
/// Thinnest it gets in a narrow gap, and in a wide one, as shares of its thickness at rest.
const THIN: [f32; 2] = [0.28, 0.7];
/// The gap has to be so wide before the tongue can begin to pass, and so wide for all of it, mm.
const PASSES_MM: [f32; 2] = [0.9, 1.3];

/// Root, blade and tip in the mandible's frame.
pub(crate) fn poses(head: &Head, controls: &Controls) -> [Affine3A; 3] {
    let gap = mouth::gap_mm(head, controls[Control::Jaw]);
    links(head, FREEDOMS.map(|c| controls[c]), gap)
}

/// The same for values of the degrees of freedom and a gap between the incisors.
fn links(head: &Head, [tip, out, body]: [f32; 3], gap: f32) -> [Affine3A; 3] {
    let scale = head.bite.scale;
    let millimetres = |v: Vec3| Affine3A::from_translation(v * scale);
    let pivot = |p: Vec3, pitch: f32| about(head.bite.place(p), Quat::from_rotation_x(-pitch));
    // The root stays near the hyoid bone and takes part of the blade's motion.
    let lift = |share: f32| {
        millimetres(vec3(0.0, ARCH_MM * body, 9.0 * out - BACK_MM * body) * share)
            * pivot(ROOT, ARCH_PITCH * body * share)
    };
    let blade = lift(1.0);
    // On its way out it rises over the lower incisors, to the middle of the gap, and stretches flat:
    // there neither tip nor body is told apart any more.
    let passing = ramp(0.04, 0.3, out);
    let over = mouth::LOWER_EDGE_Y + 0.5 * gap.clamp(0.0, TIP_MM) - TIP_Y;
    let wide = ((gap - PASSES_MM[0]) / TIP_MM).clamp(0.0, 1.0);
    let thin = THIN[0] + (THIN[1] - THIN[0]) * wide;
    let flat = 1.0 + (thin - 1.0) * passing;
    let squeeze = about_y(head.bite.place(BLADE.with_y(TIP_Y)).y, flat);
    let tip = tip * (1.0 - passing);
    let arm = BLADE - ROOT;
    let (risen, drawn) = (ARCH_MM + arm.z * ARCH_PITCH, BACK_MM + arm.y * ARCH_PITCH);
    let raise = millimetres(vec3(
        0.0,
        3.5 * tip + passing * (over - risen * body),
        2.0 * tip + passing * drawn * body,
    ));
    // Under an arched back the tip hangs down, behind the lower teeth.
    let pitch = 0.55 * tip - body * (TIP_HANGS + (ARCH_PITCH - TIP_HANGS) * passing);
    [
        lift(0.7),
        blade,
        blade * raise * pivot(BLADE, pitch) * squeeze,
    ]
}

/// Scales heights about `y`.
fn about_y(y: f32, scale: f32) -> Affine3A {
    Affine3A::from_translation(vec3(0.0, y * (1.0 - scale), 0.0))
        * Affine3A::from_scale(vec3(1.0, scale, 1.0))
}

/// The farthest that it can be put out, for a gap between the incisors.
fn out_most(gap: f32) -> f32 {
    OUT_BEHIND + (1.0 - OUT_BEHIND) * ramp(PASSES_MM[0], PASSES_MM[1], gap)
}

/// A place of its surface that may touch: where it is at rest, between which links, and the share of
/// the second.
#[derive(Clone, Copy, Debug)]
struct Feeler {
    at: Vec3,
    link: usize,
    share: f32,
}

impl Feeler {
    fn place(&self, links: &[Affine3A; 3]) -> Vec3 {
        let place = |link: usize| links[link].transform_point3(self.at);
        if self.share == 0.0 {
            place(self.link)
        } else {
            place(self.link).lerp(place(self.link + 1), self.share)
        }
    }
}

/// A head's tongue in motion; where it is and how fast lies in the simulation's controls.
#[derive(Clone, Debug)]
pub(crate) struct Tongue {
    feelers: Vec<Feeler>,
}

impl Tongue {
    /// Of a head; one without the part, or with another chain of bodies, is moved but never stopped.
    pub(crate) fn new(head: &Head) -> Self {
        const LINKS: [Body; 3] = [Body::TongueRoot, Body::TongueBlade, Body::TongueTip];
        let feelers = match head.part("tongue") {
            Some(part) if part.bodies == LINKS => {
                let chosen = mouth::feelers(&part.mesh, head.bite);
                let feeler = |v: usize| {
                    let weight = part.weight.get(v).map_or(0.0, |w| w.clamp(0.0, 2.0));
                    let link = (weight as usize).min(1);
                    Feeler {
                        at: part.mesh.positions[v],
                        link,
                        share: weight - link as f32,
                    }
                };
                chosen.into_iter().map(feeler).collect()
            }
            _ => Vec::new(),
        };
        Self { feelers }
    }

    /// One step of the tongue's part of `state` and `rate` towards `wanted`; the jaw's part is this step's already.
    pub(crate) fn step(
        &self,
        head: &Head,
        wanted: &Controls,
        state: &mut Controls,
        rate: &mut Controls,
        step_s: f32,
    ) {
        let jaw = state[Control::Jaw];
        let gap = mouth::gap_mm(head, jaw);
        let (mut x, mut v) = (FREEDOMS.map(|c| state[c]), FREEDOMS.map(|c| rate[c]));
        for (k, control) in FREEDOMS.into_iter().enumerate() {
            (x[k], v[k]) = Follow::new(RATES[k], step_s).step(x[k], v[k], wanted[control]);
        }
        // Where all stands still, it stood as well a step ago, and was stopped then.
        let still = rate[Control::Jaw].abs() < STILL && v.iter().all(|v| v.abs() < STILL);
        if !still {
            self.stop(head, jaw, gap, &mut x, &mut v);
        }
        for (k, control) in FREEDOMS.into_iter().enumerate() {
            (state[control], rate[control]) = (x[k], v[k]);
        }
    }

    /// Keeps it inside: places and speeds of `x` and `v` are corrected, nothing rebounds.
    fn stop(&self, head: &Head, jaw: f32, gap: f32, x: &mut [f32; 3], v: &mut [f32; 3]) {
        within(gap, x, v);
        let mandible = head.mandible(jaw);
        for _ in 0..PASSES {
            let now = links(head, *x, gap);
            let nudged: [_; 3] = std::array::from_fn(|k| {
                let mut there = *x;
                there[k] += NUDGE;
                there
            });
            let mut ways: Option<[[Affine3A; 3]; 3]> = None;
            let mut deepest = 0.0_f32;
            for feeler in &self.feelers {
                let p = feeler.place(&now);
                let Some((out, side)) = mouth::overlap(head, &mandible, p, SLOP_MM) else {
                    continue;
                };
                let depth = out.length();
                deepest = deepest.max(depth);
                let normal = out / depth;
                // Contact of the skull's side, told in the mandible's frame.
                let normal = match side {
                    Side::Lower => normal,
                    Side::Upper => mandible.inverse().transform_vector3(normal),
                };
                let ways = ways.get_or_insert_with(|| nudged.map(|x| links(head, x, gap)));
                let slope = ways
                    .each_ref()
                    .map(|way| normal.dot(feeler.place(way) - p) / NUDGE);
                push(x, v, &slope, depth);
            }
            within(gap, x, v);
            if deepest < SLOP_MM {
                break;
            }
        }
    }
}

/// Moves the degrees of freedom, the easier the farther, until a place has gone `depth` along a normal
/// that they move it along by `slope` each; what goes against it stops.
fn push(x: &mut [f32; 3], v: &mut [f32; 3], slope: &[f32; 3], depth: f32) {
    /// Slopes below this, mm per unit, say that nothing can move the place that way.
    const SLOPE_MIN: f32 = 0.5;
    let sum: f32 = (0..3).map(|k| EASE[k] * slope[k] * slope[k]).sum();
    if sum < SLOPE_MIN * SLOPE_MIN {
        return;
    }
    let speed: f32 = (0..3).map(|k| slope[k] * v[k]).sum();
    for k in 0..3 {
        let share = EASE[k] * slope[k] / sum;
        x[k] += depth * share;
        v[k] -= speed.min(0.0) * share;
    }
}

/// Holds each degree of freedom within its range, and the tongue behind teeth that it cannot pass.
fn within(gap: f32, x: &mut [f32; 3], v: &mut [f32; 3]) {
    for (k, control) in FREEDOMS.into_iter().enumerate() {
        let (low, mut high) = control.range();
        if control == Control::TongueOut {
            high = high.min(out_most(gap));
        }
        if x[k] < low {
            (x[k], v[k]) = (low, v[k].max(0.0));
        } else if x[k] > high {
            (x[k], v[k]) = (high, v[k].min(0.0));
        }
    }
}
