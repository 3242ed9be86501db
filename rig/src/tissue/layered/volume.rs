//! Prisms between skin and fascia that keep their volume (LEE 6).
//!
//! LEE's volume sums three products of edges, six times the prism's. Its forces act on the skin's
//! nodes alone: along the normal against the change of volume (`k1`), and towards the node's place about
//! the prism's middle at rest (`k2`). Here `k1` is per mm of mean thickness gained, over all the prism's sides, so
//! that large and small, flat and tall prisms are held alike; the normal counts by its area, as it
//! does in the gradient of the volume, so that a slender triangle does not push where it happens to face.
//!
//! Alone it holds little: the prisms of a cheek under a full smile change by 5.2 % instead of 6.5 %, for the force
//! acts on skin, as LEE has it, and conserves no momentum; six times stiffer it held little more and tore. Cheeks are therefore
//! held as a whole besides (see the model's own page).

use glam::Vec3A;

use super::springs::Columns;

/// Per mass and mm of thickness, 1/s²: some four times the spring between skin and fascia in a mean column.
const K1: f32 = 40_000.0;
/// Per mass and mm, 1/s²: so much that skin pressed together, where springs are slack, keeps one shape; more would
/// hold prisms against turning with the jaw.
const K2: f32 = 2_000.0;

/// No prism answers to more than this, mm: a torn one's volume grows as the cube of its size.
const THICKER_MM: f32 = 1.5;

#[derive(Clone, Copy, Debug)]
struct Prism {
    nodes: [u32; 3],
    /// Six times its volume, mm³, and one over six times its skin's area with half its walls', 1/mm².
    volume: f32,
    per_area: f32,
    /// The skin's part in those areas, over twice its area, 1/mm².
    part: f32,
    /// Places of the skin's nodes about the middle of all six.
    about: [Vec3A; 3],
}

/// All prisms of a head.
#[derive(Clone, Debug)]
pub(super) struct Prisms {
    prisms: Vec<Prism>,
    pub(super) k1: f32,
    k2: f32,
}

struct Corners {
    skin: [Vec3A; 3],
    fascia: [Vec3A; 3],
}

impl Corners {
    fn of(place: &Columns, nodes: [u32; 3]) -> Self {
        let columns = nodes.map(|i| place[i as usize]);
        Self {
            skin: columns.map(|c| Vec3A::from_vec4(c[0])),
            fascia: columns.map(|c| Vec3A::from_vec4(c[1])),
        }
    }

    /// Twice the skin's area, along its normal.
    fn normal(&self) -> Vec3A {
        let [a, b, c] = self.skin;
        (b - a).cross(c - a)
    }

    /// LEE's sum of three products (his are below 0 with the skin's corners counter-clockwise).
    fn volume(&self, normal: Vec3A) -> f32 {
        let ([v1, v2, v3], [v4, v5, v6]) = (self.skin, self.fascia);
        let v_1 = normal.dot(v4 - v1);
        let v_2 = (v5 - v6).cross(v4 - v6).dot(v3 - v6);
        let v_3 = (v4 - v5).cross(v3 - v5).dot(v2 - v5);
        -(v_1 + v_2 + v_3)
    }

    /// The area of its three walls, mm².
    fn walls(&self) -> f32 {
        (0..3)
            .map(|i| {
                let k = (i + 1) % 3;
                let down = self.skin[i] - self.fascia[i] + self.skin[k] - self.fascia[k];
                0.5 * (self.skin[k] - self.skin[i]).cross(down).length()
            })
            .sum()
    }

    fn middle(&self) -> Vec3A {
        let [a, b, c] = self.skin;
        let [d, e, f] = self.fascia;
        (a + b + c + d + e + f) / 6.0
    }
}

impl Prisms {
    pub(super) fn new(triangles: &[[u32; 3]], rest: &Columns, scale: f32) -> Self {
        let prisms = triangles
            .iter()
            .map(|&nodes| {
                let corners = Corners::of(rest, nodes);
                let (normal, middle) = (corners.normal(), corners.middle());
                let all = (3.0 * normal.length() + 3.0 * corners.walls()).max(1e-3);
                Prism {
                    nodes,
                    volume: corners.volume(normal),
                    per_area: 1.0 / all,
                    part: 3.0 / all,
                    about: corners.skin.map(|p| p - middle),
                }
            })
            .collect();
        Self {
            prisms,
            k1: K1 * scale,
            k2: K2 * scale,
        }
    }

    /// Adds the forces, those on volumes times `scale`; nodes that do not move take theirs too, in vain.
    pub(super) fn hold(&self, place: &Columns, scale: f32, force: &mut Columns) {
        let k1 = self.k1 * scale;
        // What the nodes' shares of the volume answer with, the fascia's among them.
        let stiffness = 2.0 * k1 + self.k2;
        for prism in &self.prisms {
            let corners = Corners::of(place, prism.nodes);
            let normal = corners.normal();
            let thicker_mm = (corners.volume(normal) - prism.volume) * prism.per_area;
            let thicker_mm = thicker_mm.clamp(-THICKER_MM, THICKER_MM);
            let push = normal * (-k1 * thicker_mm * prism.part);
            let middle = corners.middle();
            for k in 0..3 {
                let shape = (prism.about[k] - (corners.skin[k] - middle)) * self.k2;
                force[prism.nodes[k] as usize][0] += (push + shape).extend(stiffness);
            }
        }
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.prisms)
    }

    /// Volume of the prisms that `wanted` says yes to, by the skin's nodes, mm³.
    #[cfg(test)]
    pub(super) fn volume(&self, place: &Columns, wanted: impl Fn([u32; 3]) -> bool) -> f32 {
        let of = |nodes| {
            let corners = Corners::of(place, nodes);
            corners.volume(corners.normal()) / 6.0
        };
        let prisms = self.prisms.iter().map(|p| p.nodes);
        prisms.filter(|t| wanted(*t)).map(of).sum()
    }
}
