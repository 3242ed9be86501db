//! What lies under the skin, as parts to be drawn in one pose: bones, muscles, springs (HEADSHOP 3).
//!
//! For pictures: parts are made anew for a pose, with the darkness of their folds worked out by rays,
//! which takes a second or two. The bones get smoother than the simulation needs them.

mod rays;

use glam::{Vec2, Vec3, vec2};

use crate::muscle::{MuscleSurfaces, Muscles};
use crate::tissue::spring_lines;
use crate::{
    Body, Control, Detail, Head, KeyFrame, Material, Mesh, Part, Subdivision, Topology, normals,
};

pub(crate) use rays::Rays;

/// What is shown in the skin's place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Anatomy {
    /// Bones, teeth and eyeballs.
    Skull,
    /// The same with the muscles on them, contracted as they are.
    Muscles,
    /// The springs that the skin hangs in, over the bones.
    Springs,
}

/// What a spring is fastened to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum SpringKind {
    /// Skin to skin.
    Skin = 0,
    /// Skin to the skull or the mandible.
    Bone = 1,
    /// Skin to a muscle.
    Muscle = 2,
}

/// A spring where it is now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringLine {
    /// Its end on the skin, mm.
    pub a: Vec3,
    /// Its other end, mm.
    pub b: Vec3,
    /// Its length over that at rest, less 1.
    pub strain: f32,
    /// What `b` is on.
    pub kind: SpringKind,
}

/// How often the bones' edges are halved.
const BONE_LEVELS: usize = 2;
/// How thick springs are drawn, mm from their middle.
const BAR_MM: [f32; 3] = [0.16, 0.22, 0.20];

/// The parts of `head` with its bones smooth and what `what` adds in the pose of `frame`: to be drawn
/// with the skin left out. Parts that are drawn only with a face are as they were.
#[must_use]
pub fn undressed(head: &Head, frame: &KeyFrame, what: Anatomy) -> Vec<Part> {
    let mut parts: Vec<Part> = head.parts.iter().map(bared).collect();
    match what {
        Anatomy::Skull => {}
        Anatomy::Muscles => parts.extend(muscles(head, frame)),
        Anatomy::Springs => parts.push(springs(head, frame)),
    }
    darken(head, frame, &mut parts);
    if what == Anatomy::Springs {
        // Springs are seen best against dark.
        for part in parts.iter_mut().filter(|p| p.material == Material::Bone) {
            part.mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0);
        }
    }
    parts
}

/// A part as it looks without skin: bones smooth, teeth standing in bone where there were gums.
fn bared(part: &Part) -> Part {
    let as_bone = |enamel: f32| {
        let mut part = part.clone();
        part.material = Material::Bone;
        part.mesh.uvs.fill(vec2(enamel, 0.0));
        part
    };
    match part.material {
        Material::Bone => smooth(part),
        Material::Gums => as_bone(0.0),
        Material::Teeth => as_bone(1.0),
        _ => part.clone(),
    }
}

/// A bone's limit surface.
fn smooth(part: &Part) -> Part {
    let mesh = &part.mesh;
    let topology = Topology {
        vertex_count: mesh.positions.len(),
        triangles: &mesh.triangles,
        ..Topology::default()
    };
    let detail = Detail {
        levels: BONE_LEVELS,
        rest: &mesh.positions,
        ..Detail::default()
    };
    let Ok(surface) = Subdivision::new(&topology, &detail) else {
        return part.clone();
    };
    let mut positions = vec![Vec3::ZERO; surface.point_count()];
    surface.apply(&mesh.positions, &mut positions);
    let triangles = surface.triangles().to_vec();
    Part {
        mesh: Mesh {
            normals: normals(&positions, &triangles),
            uvs: vec![Vec2::ZERO; positions.len()],
            occlusion: vec![1.0; positions.len()],
            triangles,
            positions,
        },
        weight: surface.spread(&part.weight),
        ..part.clone()
    }
}

/// Each muscle's surface, standing where the skull is: the jaw's part in it is in the shape.
fn muscles(head: &Head, frame: &KeyFrame) -> Vec<Part> {
    let mut fibres = Muscles::new(head);
    let mandible = head.mandible(frame.state[Control::Jaw]);
    fibres.contract(head, &frame.state, &mandible);
    MuscleSurfaces::new(head)
        .shaped(fibres.points())
        .into_iter()
        .map(|belly| still("muscle", Material::Muscle, belly.mesh))
        .collect()
}

/// All springs as bars with three sides.
fn springs(head: &Head, frame: &KeyFrame) -> Part {
    let mut mesh = Mesh::default();
    for line in spring_lines(head, frame) {
        let along = (line.b - line.a).normalize_or(Vec3::Z);
        let (u, v) = along.any_orthonormal_pair();
        let base = mesh.positions.len() as u32;
        let uv = vec2(f32::from(line.kind as u8), line.strain);
        for end in [line.a, line.b] {
            for k in 0..3 {
                let (s, c) = (std::f32::consts::TAU * k as f32 / 3.0).sin_cos();
                let out = u * c + v * s;
                mesh.positions.push(end + out * BAR_MM[line.kind as usize]);
                mesh.normals.push(out);
                mesh.uvs.push(uv);
                mesh.occlusion.push(1.0);
            }
        }
        for k in 0..3 {
            let (a, b) = (base + k, base + (k + 1) % 3);
            mesh.triangles.extend([[a, b, b + 3], [a, b + 3, a + 3]]);
        }
    }
    still("springs", Material::Spring, mesh)
}

/// A part that hangs on the skull and does nothing else.
fn still(name: &str, material: Material, mesh: Mesh) -> Part {
    Part {
        name: name.to_owned(),
        material,
        weight: vec![0.0; mesh.positions.len()],
        bodies: vec![Body::Skull],
        mesh,
    }
}

/// Works out how much light reaches bones and muscles in this pose.
fn darken(head: &Head, frame: &KeyFrame, parts: &mut [Part]) {
    let bodies = head.bodies(&frame.state);
    let skull = bodies[Body::Skull as usize].inverse();
    let solid = |m: Material| matches!(m, Material::Bone | Material::Muscle | Material::Eye);
    // Where everything is in the skull's frame.
    let posed: Vec<(Vec<Vec3>, Vec<Vec3>)> = parts
        .iter()
        .map(|part| {
            if !solid(part.material) {
                return (Vec::new(), Vec::new());
            }
            let poses = part.weight.iter().map(|w| {
                let ([a, b], share) = part.between(*w);
                let pose = if share < 0.5 { a } else { b };
                skull * bodies[pose as usize]
            });
            let places = part.mesh.positions.iter().zip(&part.mesh.normals);
            poses
                .zip(places)
                .map(|(pose, (p, n))| (pose.transform_point3(*p), pose.transform_vector3(*n)))
                .unzip()
        })
        .collect();
    let stops = parts
        .iter()
        .zip(&posed)
        .filter(|(part, _)| solid(part.material))
        .map(|(part, (places, _))| (&places[..], &part.mesh.triangles[..]));
    let rays = Rays::new(stops);
    for (part, (places, normals)) in parts.iter_mut().zip(&posed) {
        if !matches!(part.material, Material::Bone | Material::Muscle) {
            continue;
        }
        rays.light_all(places, normals, &mut part.mesh.occlusion);
    }
}
