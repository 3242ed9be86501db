//! The volume of soft tissue in each cheek: closed between skin, bone and the walls round both.
//!
//! Tissue is mostly water and keeps its volume (LEE 6; HEADSHOP 3 has springs for it). Here a region is kept
//! as a whole: its volume is that of the closed surface of the skin's triangles, the same triangles on the
//! bone under them (which the mandible carries in part), and walls between their rims. A region's volume,
//! its gradient and so its energy are exact; the default model adds the gradient's part on the skin to its pass over
//! the springs, the layered one asks for it ([`Cheek::measure`]). Any model can be measured by it.

use glam::{Affine3A, Vec3, Vec3A};

use super::anatomy::{cheek, mandible_share, sides};
use super::{Nodes, Numbering};
use crate::Head;

/// Jaw angles that the bone's part is tabulated at, and the largest, rad.
const ANGLES: usize = 64;
const ANGLE_MAX: f32 = 0.45;
/// Tissue counts as no thinner, mm.
const THINNEST_MM: f32 = 3.0;

/// A place on the bone under a node.
#[derive(Clone, Copy, Debug)]
struct Foot {
    node: u32,
    bone: Vec3A,
    /// Share of the mandible in its motion.
    share: f32,
}

impl Foot {
    fn now(&self, mandible: &Affine3A) -> Vec3A {
        let carried = mandible.transform_point3a(self.bone) - self.bone;
        self.bone + carried * self.share
    }
}

/// One cheek.
#[derive(Clone, Debug)]
pub(crate) struct Cheek {
    /// Its triangles, by node.
    pub triangles: Vec<[u32; 3]>,
    /// Nodes that its volume depends on.
    pub nodes: Vec<u32>,
    /// Feet of its rim's edges, in the triangles' sense.
    rim: Vec<[Foot; 2]>,
    /// The bone's part of the volume, by the jaw's angle, mm³.
    bone: Vec<f32>,
    /// Its volume at rest, mm³.
    pub rest: f32,
}

/// Six times the volume between a triangle and the frame's origin.
fn cone(a: Vec3A, b: Vec3A, c: Vec3A) -> f32 {
    a.dot(b.cross(c))
}

impl Cheek {
    fn new(head: &Head, triangles: Vec<[u32; 3]>, foot: &[Foot], nodes: &Nodes) -> Self {
        let mut directed: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
            .collect();
        directed.sort_unstable();
        let rim = directed
            .iter()
            .filter(|[a, b]| directed.binary_search(&[*b, *a]).is_err())
            .map(|edge| edge.map(|i| foot[i as usize]))
            .collect();
        let bone = (0..ANGLES)
            .map(|k| {
                let mandible = head.mandible(ANGLE_MAX * k as f32 / (ANGLES - 1) as f32);
                let sum: f64 = triangles
                    .iter()
                    .map(|t| {
                        let [a, b, c] = t.map(|i| foot[i as usize].now(&mandible));
                        f64::from(cone(a, c, b))
                    })
                    .sum();
                (sum / 6.0) as f32
            })
            .collect();
        let mut touched: Vec<u32> = triangles.iter().flatten().copied().collect();
        touched.sort_unstable();
        touched.dedup();
        let mut cheek = Self {
            triangles,
            nodes: touched,
            rim,
            bone,
            rest: 0.0,
        };
        cheek.rest = cheek.volume(nodes, &Affine3A::IDENTITY, 0.0);
        cheek
    }

    /// Its volume now, mm³: the mandible is in that pose, at that angle.
    pub(crate) fn volume(&self, nodes: &Nodes, mandible: &Affine3A, jaw_rad: f32) -> f32 {
        let at = |i: u32| nodes.place[i as usize];
        let skin: f32 = self
            .triangles
            .iter()
            .map(|t| cone(at(t[0]), at(t[1]), at(t[2])))
            .sum();
        skin / 6.0 + self.walls(nodes, mandible, |_, _| {}) + self.of_bone(jaw_rad)
    }

    /// Its volume now, and how that changes with each of its nodes, mm²: left in their places of `gradient`.
    pub(crate) fn measure(
        &self,
        nodes: &Nodes,
        mandible: &Affine3A,
        jaw_rad: f32,
        gradient: &mut [Vec3A],
    ) -> f32 {
        for &i in &self.nodes {
            gradient[i as usize] = Vec3A::ZERO;
        }
        let mut skin = 0.0;
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| nodes.place[i as usize]);
            let changes = [b.cross(c), c.cross(a), a.cross(b)];
            skin += a.dot(changes[0]);
            for (i, change) in t.iter().zip(changes) {
                gradient[*i as usize] += change / 6.0;
            }
        }
        let rim = |node: u32, change: Vec3A| gradient[node as usize] += change;
        skin / 6.0 + self.walls(nodes, mandible, rim) + self.of_bone(jaw_rad)
    }

    /// The bone's part of the volume, mm³.
    pub(crate) fn of_bone(&self, jaw_rad: f32) -> f32 {
        let place = (jaw_rad / ANGLE_MAX).clamp(0.0, 1.0) * (ANGLES - 1) as f32;
        let low = (place as usize).min(ANGLES - 2);
        self.bone[low] + (self.bone[low + 1] - self.bone[low]) * (place - low as f32)
    }

    /// The walls' part of the volume, mm³; `gradient` is told how it changes with each node of the rim.
    pub(crate) fn walls(
        &self,
        nodes: &Nodes,
        mandible: &Affine3A,
        mut gradient: impl FnMut(u32, Vec3A),
    ) -> f32 {
        let mut sum = 0.0;
        for [a, b] in &self.rim {
            // Against the skin's sense along the edge they share: b, a, foot of a; b, foot of a, foot of b.
            let (p, q) = (nodes.place[a.node as usize], nodes.place[b.node as usize]);
            let (under, beside) = (a.now(mandible), b.now(mandible));
            sum += cone(q, p, under) + cone(q, under, beside);
            let first = (p - q).cross(under - q);
            let second = (under - q).cross(beside - q);
            gradient(a.node, first / 6.0);
            gradient(b.node, (first + second) / 6.0);
        }
        sum / 6.0
    }
}

/// The left and the right cheek of a head, whose bone lies under the nodes that move as [`bone_depth`] has it.
///
/// [`bone_depth`]: super::anatomy::bone_depth
pub(crate) fn cheeks(head: &Head, numbering: &Numbering, depth: &[(Vec3, f32)]) -> [Cheek; 2] {
    let rest = numbering.of(&head.skin.mesh.positions);
    let reference = numbering.of(&head.skin.reference);
    let side = numbering.of(&sides(head));
    let inside = |node: u32, left: bool| {
        let p = reference[node as usize];
        (node as usize) < numbering.movable && (p.x > 0.0) == left && cheek(p)
    };
    let feet: Vec<Foot> = (0..)
        .zip(&rest)
        .map(|(node, &place)| {
            let mut bone = place;
            if let Some((inwards, depth)) = depth.get(node as usize) {
                bone += *inwards * depth.max(THINNEST_MM);
            }
            Foot {
                node,
                bone: bone.into(),
                share: mandible_share(reference[node as usize], side[node as usize]),
            }
        })
        .collect();
    let nodes = Nodes::at(&rest);
    [true, false].map(|left| {
        let triangles = numbering
            .triangles
            .iter()
            .copied()
            .filter(|t| t.iter().all(|&v| inside(v, left)))
            .collect();
        Cheek::new(head, triangles, &feet, &nodes)
    })
}
