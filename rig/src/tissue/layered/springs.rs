//! The springs of all layers: along the skin and the fascia, between them, and down to the skull (LEE 4).
//!
//! An edge of the mesh has four: one in the skin, one in the fascia, and two crossed between both, as in
//! Terzopoulos and Waters (1990), LEE's [8]; without these the skin would shear off its fascia, since a
//! spring straight down resists only its own lengthening. A node has two: skin to fascia and
//! fascia to skull. Four springs are one row of SIMD, so that a step reads each edge once.

use glam::{Mat4, Vec4, vec4};

use super::law::{Stiffness, pull};

/// LEE's table: epidermis, the two phases of the dermal-fatty layer, fascia, muscle.
const EPIDERMIS: f32 = 60.0;
const DERMAL_FATTY: [f32; 2] = [30.0, 70.0];
const FASCIA: f32 = 80.0;
const MUSCLE: f32 = 10.0;
/// What share of the dermal-fatty stiffness each crossed spring has; LEE gives none.
const CROSSED: f32 = 0.35;
/// One unit of LEE's table, mm/s² per unit of strain and per mass of a node: an edge of 4 mm is then
/// about as stiff as one of the default model.
const UNIT: f32 = 1_500.0;

/// Stiffness against turning over, of the second phase's. LEE's sign `I_s` turns the pull of an inverted spring
/// round; along the spring itself that would push a sheared column sideways.
const TURNED: f32 = 2.0;
/// What springs down and across keep in lids.
const LOOSE: f32 = 0.03;
/// Least length that is divided by, mm.
const SHORTEST_MM: f32 = 1e-3;

/// An edge of the mesh: its nodes, and one over the rest lengths of its springs, 1/mm.
#[derive(Clone, Copy, Debug)]
struct Edge {
    per_rest_mm: Vec4,
    ends: [u32; 2],
    /// What its crossed springs keep.
    keep: f32,
}

/// Places or forces of a column: skin, then fascia. What is left of a force's four floats sums up the
/// stiffness at the node.
pub(super) type Columns = [[Vec4; 2]];

/// All springs of a head.
#[derive(Clone, Debug)]
pub(super) struct Springs {
    edges: Vec<Edge>,
    /// Per node: one over the rest lengths of skin to fascia and fascia to skull, and what they keep.
    down: Vec<([f32; 2], f32)>,
    along: Stiffness,
    across: Stiffness,
}

impl Springs {
    /// Columns that are `loose` keep little of their springs; `scale` is what stiffnesses per mass are multiplied by.
    pub(super) fn new(
        edges: &[[u32; 2]],
        rest: &Columns,
        skull: &[Vec4],
        loose: &[bool],
        scale: f32,
    ) -> Self {
        let unit = UNIT * scale;
        let crossed = DERMAL_FATTY.map(|k| k * CROSSED);
        let keep = |loose| if loose { LOOSE } else { 1.0 };
        let edges = edges
            .iter()
            .map(|&ends| Edge {
                per_rest_mm: length(between(rest, ends)).recip(),
                ends,
                keep: keep(ends.iter().any(|i| loose[*i as usize])),
            })
            .collect();
        let down = loose[..skull.len()].iter().enumerate().map(|(i, &loose)| {
            let [skin, fascia] = rest[i];
            let per_rest_mm =
                [skin - fascia, fascia - skull[i]].map(|d| d.length().max(SHORTEST_MM).recip());
            (per_rest_mm, keep(loose))
        });
        let down = down.collect();
        Self {
            edges,
            down,
            along: Stiffness {
                first: vec4(EPIDERMIS, FASCIA, crossed[0], crossed[0]) * unit,
                second: vec4(EPIDERMIS, FASCIA, crossed[1], crossed[1]) * unit,
            },
            across: Stiffness {
                first: vec4(DERMAL_FATTY[0], MUSCLE, DERMAL_FATTY[0], MUSCLE) * unit,
                second: vec4(DERMAL_FATTY[1], MUSCLE, DERMAL_FATTY[1], MUSCLE) * unit,
            },
        }
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.edges) + size_of_val(&*self.down)
    }

    pub(super) fn count(&self) -> usize {
        4 * self.edges.len() + 2 * self.down.len()
    }

    /// Adds the forces of the edges' springs.
    pub(super) fn along_layers(&self, place: &Columns, force: &mut Columns) {
        const OPPOSITE: Vec4 = vec4(-1.0, -1.0, -1.0, 1.0);
        for edge in &self.edges {
            let d = between(place, edge.ends);
            let mut law = pull(length(d), edge.per_rest_mm, &self.along);
            let keep = vec4(1.0, 1.0, edge.keep, edge.keep);
            law.per_mm *= keep;
            law.stiffness *= keep;
            let pulls = Mat4::from_cols(
                d.x_axis * law.per_mm,
                d.y_axis * law.per_mm,
                d.z_axis * law.per_mm,
                law.stiffness,
            )
            .transpose();
            let [a, b] = edge.ends.map(|i| i as usize);
            force[a][0] += pulls.x_axis + pulls.z_axis;
            force[a][1] += pulls.y_axis + pulls.w_axis;
            force[b][0] += (pulls.x_axis + pulls.w_axis) * OPPOSITE;
            force[b][1] += (pulls.y_axis + pulls.z_axis) * OPPOSITE;
        }
    }

    /// Sets the forces of the springs straight down; `out` is the direction in which they stand upright.
    pub(super) fn down(&self, place: &Columns, skull: &[Vec4], out: &[Vec4], force: &mut Columns) {
        // Two nodes at a time fill a row; an odd last one is its own partner.
        let count = self.down.len();
        for i in (0..count).step_by(2) {
            let j = (i + 1).min(count - 1);
            let step = |k: usize| {
                let [skin, fascia] = place[k];
                [fascia - skin, skull[k] - fascia]
            };
            let ([a, b], [c, d]) = (step(i), step(j));
            let upright = vec4(a.dot(out[i]), b.dot(out[i]), c.dot(out[j]), d.dot(out[j]));
            let rows = Mat4::from_cols(a, b, c, d).transpose();
            let [(p, keep_i), (q, keep_j)] = [self.down[i], self.down[j]];
            let keep = vec4(keep_i, keep_i, keep_j, keep_j);
            let per_rest = vec4(p[0], p[1], q[0], q[1]);
            let mut law = pull(length(rows), per_rest, &self.across);
            law.per_mm *= keep;
            law.stiffness *= keep;
            // What has turned over is pushed back along its own normal.
            let back = self.across.second * per_rest * TURNED;
            let push = back * upright.max(Vec4::ZERO);
            let stiffness = law.stiffness + Vec4::select(push.cmpgt(Vec4::ZERO), back, Vec4::ZERO);
            let pulls = |d: Vec4, out: Vec4, k: usize| {
                (d * law.per_mm[k] + out * push[k]).with_w(stiffness[k])
            };
            let (one, two) = (out[i], out[j]);
            for (node, [top, bottom]) in [
                (i, [pulls(a, one, 0), pulls(b, one, 1)]),
                (j, [pulls(c, two, 2), pulls(d, two, 3)]),
            ] {
                let back = vec4(-top.x, -top.y, -top.z, top.w);
                force[node] = [top, back + bottom];
            }
        }
    }
}

/// From end to end of an edge's four springs, a coordinate a row: skin, fascia, skin to fascia, fascia to skin.
fn between(place: &Columns, ends: [u32; 2]) -> Mat4 {
    let [[skin_a, fascia_a], [skin_b, fascia_b]] = ends.map(|i| place[i as usize]);
    Mat4::from_cols(
        skin_b - skin_a,
        fascia_b - fascia_a,
        fascia_b - skin_a,
        skin_b - fascia_a,
    )
    .transpose()
}

fn length(d: Mat4) -> Vec4 {
    let square = d.x_axis * d.x_axis + d.y_axis * d.y_axis + d.z_axis * d.z_axis;
    square.sqrt().max(Vec4::splat(SHORTEST_MM))
}
