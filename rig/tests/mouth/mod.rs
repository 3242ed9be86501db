//! How deep places lie in teeth, gums or palate, measured on the drawn meshes and by nothing of the simulation's own.

use std::collections::HashMap;

use glam::{Vec3, vec3};
use mouthpiece_rig::{Body, Head, Mesh, Part};

/// Side of a cell, mm; places farther than this from all triangles are free.
const CELL_MM: f32 = 3.0;

/// Triangles of one body, findable by place.
pub(crate) struct Solid {
    corners: Vec<[Vec3; 3]>,
    normals: Vec<[Vec3; 3]>,
    cells: HashMap<[i32; 3], Vec<u32>>,
}

fn cell(p: Vec3) -> [i32; 3] {
    (p / CELL_MM).floor().to_array().map(|x| x as i32)
}

impl Solid {
    fn new(meshes: &[&Mesh]) -> Self {
        let mut solid = Self {
            corners: Vec::new(),
            normals: Vec::new(),
            cells: HashMap::new(),
        };
        for mesh in meshes {
            for t in &mesh.triangles {
                let id = solid.corners.len() as u32;
                let corners = t.map(|v| mesh.positions[v as usize]);
                solid.corners.push(corners);
                solid.normals.push(t.map(|v| mesh.normals[v as usize]));
                let low = corners[0].min(corners[1]).min(corners[2]) - CELL_MM;
                let high = corners[0].max(corners[1]).max(corners[2]) + CELL_MM;
                let (low, high) = (cell(low), cell(high));
                for x in low[0]..=high[0] {
                    for y in low[1]..=high[1] {
                        for z in low[2]..=high[2] {
                            solid.cells.entry([x, y, z]).or_default().push(id);
                        }
                    }
                }
            }
        }
        solid
    }

    /// How deep a place is inside, mm; 0 outside.
    fn depth(&self, p: Vec3) -> f32 {
        let (mut best, mut depth) = (CELL_MM, 0.0);
        for &id in self.cells.get(&cell(p)).map_or(&[][..], |v| v) {
            let [a, b, c] = self.corners[id as usize];
            let shares = nearest(p, a, b, c);
            let place = a * shares.x + b * shares.y + c * shares.z;
            let distance = p.distance(place);
            if distance < best {
                let [na, nb, nc] = self.normals[id as usize];
                let normal = na * shares.x + nb * shares.y + nc * shares.z;
                best = distance;
                depth = if (p - place).dot(normal) < 0.0 {
                    distance
                } else {
                    0.0
                };
            }
        }
        depth
    }
}

/// Shares of a triangle's corners in its place nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
fn nearest(p: Vec3, a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return vec3(1.0, 0.0, 0.0);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return vec3(0.0, 1.0, 0.0);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return vec3(1.0 - v, v, 0.0);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return vec3(0.0, 0.0, 1.0);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return vec3(1.0 - w, 0.0, w);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return vec3(0.0, 1.0 - w, w);
    }
    let all = va + vb + vc;
    vec3(va / all, vb / all, vc / all)
}

/// The mouth of a head: what the tongue must not be in.
pub(crate) struct Mouth {
    upper: Solid,
    lower: Solid,
    roof: Vec<[Vec3; 3]>,
}

/// Where a tongue went too far, and by how much, mm.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Worst {
    pub upper_teeth: f32,
    pub lower_teeth: f32,
    pub palate: f32,
}

impl Worst {
    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            upper_teeth: self.upper_teeth.max(other.upper_teeth),
            lower_teeth: self.lower_teeth.max(other.lower_teeth),
            palate: self.palate.max(other.palate),
        }
    }

    pub(crate) fn most(self) -> f32 {
        self.upper_teeth.max(self.lower_teeth).max(self.palate)
    }
}

impl Mouth {
    pub(crate) fn of(head: &Head) -> Self {
        let mesh = |name: &str| &head.part(name).unwrap().mesh;
        let cavity = head.part("cavity").unwrap();
        let roof = cavity.mesh.triangles.iter();
        let roof = roof.filter(|t| t.iter().all(|v| cavity.weight[*v as usize] == 0.0));
        let place = |v: u32| cavity.mesh.positions[v as usize];
        Self {
            upper: Solid::new(&[mesh("teeth_upper"), mesh("gums_upper")]),
            lower: Solid::new(&[mesh("teeth_lower"), mesh("gums_lower")]),
            roof: roof.map(|t| t.map(place)).collect(),
        }
    }

    /// How far a place in the skull's frame stands above the roof, mm.
    fn above(&self, p: Vec3) -> f32 {
        for [a, b, c] in &self.roof {
            let side = |u: Vec3, v: Vec3| (v.x - u.x) * (p.z - u.z) - (v.z - u.z) * (p.x - u.x);
            let (i, j, k) = (side(*b, *c), side(*c, *a), side(*a, *b));
            let all = i + j + k;
            if all != 0.0 && [i, j, k].iter().all(|s| s / all >= 0.0) {
                return (p.y - (a.y * i + b.y * j + c.y * k) / all).max(0.0);
            }
        }
        0.0
    }

    /// Of the tongue's vertices and the middles of its triangles, for a state of the head's components.
    pub(crate) fn worst(&self, head: &Head, state: &mouthpiece_rig::Controls) -> Worst {
        let bodies = head.bodies(state);
        let tongue = head.part("tongue").unwrap();
        let places = posed(tongue, &bodies);
        let middles = tongue.mesh.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|v| places[v as usize]);
            (a + b + c) / 3.0
        });
        let skull = bodies[Body::Skull as usize].inverse();
        let mandible = bodies[Body::Mandible as usize].inverse();
        let mut worst = Worst::default();
        for p in places.iter().copied().chain(middles) {
            let (above, below) = (skull.transform_point3(p), mandible.transform_point3(p));
            worst = worst.with(Worst {
                upper_teeth: self.upper.depth(above),
                lower_teeth: self.lower.depth(below),
                palate: self.above(above),
            });
        }
        worst
    }
}

/// A part's vertices where its bodies are, as the renderer blends them.
pub(crate) fn posed(part: &Part, bodies: &[glam::Affine3A; Body::COUNT]) -> Vec<Vec3> {
    let vertices = part.mesh.positions.iter().zip(&part.weight);
    vertices
        .map(|(p, weight)| {
            let ([a, b], share) = part.between(*weight);
            let place = |body: Body| bodies[body as usize].transform_point3(*p);
            place(a).lerp(place(b), share)
        })
        .collect()
}
