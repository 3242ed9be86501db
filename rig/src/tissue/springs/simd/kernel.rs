//! From springs to velocities, from velocities to places: written once, over any lanes.

use std::ops::Range;

use glam::{Affine3A, Vec3A};

use super::lanes::Lanes;
use super::mesh::{BLOCK, Block, Mesh};
use crate::tissue::Nodes;

/// What is the same for all nodes during a step.
#[derive(Clone, Copy, Debug)]
pub(in crate::tissue::springs) struct Kick {
    /// Length of the step in seconds, by what a unit of force is divided by (1 at the default mass).
    pub step: f32,
    /// Share of its velocity that a node keeps.
    pub keep: f32,
    /// Stiffness of skin edges; what is left of it in one that is pressed together.
    pub edge: f32,
    pub slack: f32,
    /// Strain within which it goes from the one to the other.
    pub blend: f32,
    /// Stiffness of the bone.
    pub bone: f32,
    /// Scales the springs to muscles.
    pub muscle: f32,
    /// From a place to how far the mandible carries it.
    pub carry: Affine3A,
    /// Bit k mod 128 is set when fibre k is away from rest.
    pub moved: u128,
}

const AXES: Range<usize> = 0..3;

/// `a x b`, for lanes.
#[inline(always)]
fn cross<L: Lanes>(a: [L; 3], b: [L; 3]) -> [L; 3] {
    let minor = |i: usize, j: usize| a[i].mul(b[j]).sub(a[j].mul(b[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

#[inline(always)]
fn square<L: Lanes>(v: [L; 3]) -> L {
    // Never quite 0: its inverse is asked for.
    let x = v[0].mul_add(v[0], L::splat(1e-12));
    v[2].mul_add(v[2], v[1].mul_add(v[1], x))
}

/// Strain beyond which the stress of an edge grows no more (its force still does, with its length): 1.3 times its
/// length at rest. Without that, edges that are torn at would grow stiffer than the step can follow.
pub(in crate::tissue::springs) const MOST: f32 = 0.4;
/// What a strain loses by its square. Under Green's strain alone an edge would pull the harder per mm the longer it is;
/// so it pulls the same or less, and nothing swings faster than at rest.
pub(in crate::tissue::springs) const SOFTEN: f32 = 1.1;

/// How an edge answers to strain, Green's: half of what its squared length has gained, which needs no root. With its
/// stiffness when stretched, with `slack` of it pressed together, and a parabola round rest that joins the two
/// without a kink.
#[derive(Clone, Copy)]
struct Give<L> {
    even: L,
    odd: L,
    blend: L,
    curve: L,
    most: L,
    soften: L,
}

impl<L: Lanes> Give<L> {
    #[inline(always)]
    fn new([slack, blend]: [f32; 2]) -> Self {
        let odd = 0.5 * (1.0 - slack);
        Self {
            even: L::splat(0.5 * (1.0 + slack)),
            odd: L::splat(odd),
            blend: L::splat(blend),
            curve: L::splat(odd * 0.5 / blend),
            most: L::splat(MOST),
            soften: L::splat(-SOFTEN),
        }
    }

    #[inline(always)]
    fn stress(&self, strain: L) -> L {
        let strain = strain.min(self.most);
        let strain = strain.mul(strain).mul_add(self.soften, strain);
        let size = strain.abs();
        let near = size.min(self.blend);
        let straight = size.mul_add(self.odd, strain.mul(self.even));
        // near * (near * curve - odd): the parabola instead of the straight part.
        near.mul_add(near.mul(self.curve).sub(self.odd), straight)
    }
}

/// Sum of what a block's edges pull with, over their stiffness; with `VOLUME`, also of the areas between
/// neighbours.
///
/// # Safety
/// The rows' offsets are those of nodes.
#[inline(always)]
unsafe fn edges<L: Lanes, const VOLUME: bool>(
    mesh: &Mesh,
    block: &Block,
    part: usize,
    nodes: &[Vec3A],
    own: [L; 3],
    give: &Give<L>,
) -> ([L; 3], [L; 3]) {
    let (minus_half, zero) = (L::splat(-0.5), L::splat(0.0));
    let (mut pull, mut area, mut before) = ([zero; 3], [zero; 3], [zero; 3]);
    let rows = &mesh.rows[block.rows[0] as usize..block.rows[1] as usize];
    let corners = block.corners.unwrap_or(0) as usize;
    for (r, row) in rows.iter().enumerate() {
        // SAFETY: as the caller promises.
        let other = unsafe { L::fetch(nodes, &row.offset, part) };
        let d = [
            other[0].sub(own[0]),
            other[1].sub(own[1]),
            other[2].sub(own[2]),
        ];
        let grown = L::load(&row.grown, part);
        let length = d[2].mul_add(d[2], d[1].mul(d[1]));
        let length = d[0].mul_add(d[0], length);
        let mut stress = give.stress(length.mul_add(grown, minus_half));
        if VOLUME {
            // Only round a volume is a neighbour met twice, the second time without a spring.
            stress = stress.where_positive(grown);
        }
        for axis in AXES {
            pull[axis] = d[axis].mul_add(stress, pull[axis]);
        }
        if VOLUME {
            let corner = L::load(&mesh.corners[corners + r], part);
            let normal = cross(before, d);
            for axis in AXES {
                area[axis] = normal[axis].mul_add(corner, area[axis]);
            }
            before = d;
        }
    }
    (pull, area)
}

/// See [`super::kick`]; sizes are checked there.
#[inline(always)]
pub(super) fn kick<L: Lanes>(
    mesh: &Mesh,
    nodes: &mut Nodes,
    shift: &[Vec3A],
    gradient: &mut [Vec3A],
    kick: &Kick,
) {
    let zero = L::splat(0.0);
    let give = Give::new([kick.slack, kick.blend]);
    let (edge, bone, muscle) = (
        L::splat(kick.edge),
        L::splat(kick.bone),
        L::splat(kick.muscle),
    );
    let m = kick.carry.matrix3;
    let carry = [m.x_axis, m.y_axis, m.z_axis, kick.carry.translation]
        .map(|c| [L::splat(c.x), L::splat(c.y), L::splat(c.z)]);
    for (b, block) in mesh.blocks.iter().enumerate() {
        for part in 0..BLOCK / L::N {
            let first = b * BLOCK + part * L::N;
            let own = L::own(&nodes.place, first);
            // SAFETY: `Mesh::new` has checked the offsets against the number of nodes, and `Mesh::check` that number.
            let (pull, area) = unsafe {
                if block.corners.is_some() {
                    edges::<L, true>(mesh, block, part, &nodes.place, own, &give)
                } else {
                    edges::<L, false>(mesh, block, part, &nodes.place, own, &give)
                }
            };
            if block.corners.is_some() {
                let sixth = L::splat(1.0 / 6.0);
                let at = block.gradients as usize + part * L::N;
                L::put(gradient, at, area.map(|a| a.mul(sixth)));
            }

            let rest = block.rest.each_ref().map(|r| L::load(r, part));
            let away = [
                own[0].sub(rest[0]),
                own[1].sub(rest[1]),
                own[2].sub(rest[2]),
            ];
            // Muscles: what they hold back, and what they draw along.
            let hold = L::load(&block.hold, part).mul(muscle);
            let mut force = [zero; 3];
            for axis in AXES {
                force[axis] = pull[axis].mul(edge).sub(away[axis].mul(hold));
            }
            if block.fibres & kick.moved != 0 {
                let ties = &mesh.ties[block.ties[0] as usize..block.ties[1] as usize];
                let mut drawn = [zero; 3];
                for tie in ties {
                    // SAFETY: as above, against the number of places.
                    let place = unsafe { L::fetch(shift, &tie.offset, part) };
                    let stiffness = L::load(&tie.stiffness, part);
                    for axis in AXES {
                        drawn[axis] = place[axis].mul_add(stiffness, drawn[axis]);
                    }
                }
                for axis in AXES {
                    force[axis] = drawn[axis].mul_add(muscle, force[axis]);
                }
            }
            // Bone: what is left of the way once the mandible has carried its share.
            let mut off = away;
            if block.jawed {
                let share = L::load(&block.share, part);
                for axis in AXES {
                    let mut carried = carry[3][axis];
                    for from in AXES {
                        carried = carry[from][axis].mul_add(rest[from], carried);
                    }
                    off[axis] = off[axis].sub(carried.mul(share));
                }
            }
            // Two phases: soft until it has slipped, then firm (LEE 4's biphasic spring).
            let slip = L::load(&block.slip, part);
            let beyond = L::splat(1.0).sub(slip.mul(square(off).rsqrt())).max(zero);
            let soft = L::load(&block.soft, part);
            let stiff = L::load(&block.firm, part).mul_add(beyond, soft);
            // The bone stops it: no deeper than the gap under it.
            let normal = block.normal.each_ref().map(|n| L::load(n, part));
            let mut height = L::load(&block.gap, part);
            for axis in AXES {
                height = normal[axis].mul_add(off[axis], height);
            }
            let stop = zero.sub(height).max(zero).mul(bone);
            let light = L::load(&block.light, part);
            for axis in AXES {
                force[axis] = force[axis].sub(off[axis].mul(stiff));
                force[axis] = normal[axis].mul_add(stop, force[axis]).mul(light);
            }
            L::kick(&mut nodes.velocity, first, force, kick.step, kick.keep);
        }
    }
}

/// See [`super::drift`].
#[inline(always)]
pub(super) fn drift<L: Lanes>(nodes: &mut Nodes, step_s: f32) {
    let count = nodes.place.len().min(nodes.velocity.len()) / BLOCK * BLOCK;
    for first in (0..count).step_by(L::N) {
        L::drift(&mut nodes.place, &nodes.velocity, first, step_s);
    }
}

/// See [`super::stretch`]; sizes are checked there.
#[inline(always)]
pub(super) fn stretch<L: Lanes>(mesh: &Mesh, nodes: &Nodes, force: &mut [Vec3A], law: [f32; 2]) {
    let give = Give::new(law);
    for (b, block) in mesh.blocks.iter().enumerate() {
        for part in 0..BLOCK / L::N {
            let first = b * BLOCK + part * L::N;
            let own = L::own(&nodes.place, first);
            // SAFETY: `Mesh::new` has checked the offsets against the number of nodes, and `Mesh::check` that number.
            let (pull, _) =
                unsafe { edges::<L, false>(mesh, block, part, &nodes.place, own, &give) };
            L::put(force, first, pull);
        }
    }
}
