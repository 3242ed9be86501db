//! Teeth and gums: crowns of life-size along two arches. Sizes and places are figures of the ICT mean
//! head (widths and edges of its teeth); the shapes are our own.

use glam::{Vec3, vec2, vec3};

use super::shapes;
use mouthpiece_rig::{Body, Material, Mesh, Part};

/// A crown of the left half: centre of its biting edge (x, y, z), width along the arch, depth across it, height.
struct Crown {
    edge: Vec3,
    width: f32,
    depth: f32,
    height: f32,
    /// 0 a sharp incisor, 1 a flat molar.
    flat: f32,
}

const fn crown(x: f32, y: f32, z: f32, width: f32, depth: f32, height: f32, flat: f32) -> Crown {
    Crown {
        edge: vec3(x, y, z),
        width,
        depth,
        height,
        flat,
    }
}

const UPPER: [Crown; 7] = [
    crown(4.3, -35.3, 104.6, 8.6, 6.4, 10.5, 0.0),
    crown(11.6, -34.6, 102.3, 6.9, 6.0, 9.3, 0.0),
    crown(17.2, -34.7, 97.3, 7.6, 7.4, 10.0, 0.15),
    crown(20.4, -33.8, 90.4, 7.0, 8.8, 8.6, 0.6),
    crown(22.4, -33.5, 83.4, 6.7, 9.0, 8.0, 0.7),
    crown(24.4, -33.0, 74.8, 9.8, 10.4, 7.5, 1.0),
    crown(26.0, -31.6, 65.8, 9.0, 10.4, 7.0, 1.0),
];
const LOWER: [Crown; 7] = [
    crown(2.7, -34.0, 101.9, 5.4, 5.6, 9.0, 0.0),
    crown(8.1, -33.6, 100.6, 5.9, 5.8, 9.2, 0.0),
    crown(13.5, -33.2, 97.2, 6.8, 7.0, 10.2, 0.15),
    crown(17.5, -33.1, 91.4, 6.9, 7.6, 8.6, 0.6),
    crown(20.0, -32.9, 84.5, 7.0, 8.0, 8.0, 0.7),
    crown(22.4, -32.0, 75.6, 10.2, 9.4, 7.6, 1.0),
    crown(24.2, -30.4, 66.0, 9.6, 9.4, 7.0, 1.0),
];

/// Both rows with their gums.
pub(super) fn parts() -> Vec<Part> {
    let mut parts = Vec::new();
    for (crowns, up, names, body) in [
        (&UPPER, 1.0, ["teeth_upper", "gums_upper"], Body::Skull),
        (&LOWER, -1.0, ["teeth_lower", "gums_lower"], Body::Mandible),
    ] {
        let mut teeth = Mesh::default();
        for (i, crown) in crowns.iter().enumerate() {
            let along = tangent(crowns, i);
            let left = tooth(crown, along, up);
            shapes::append(&mut teeth, &left);
            shapes::append(&mut teeth, &shapes::mirrored(&left));
        }
        for (name, material, mesh) in [
            (names[0], Material::Teeth, teeth),
            (names[1], Material::Gums, gums(crowns, up)),
        ] {
            let weight = vec![0.0; mesh.positions.len()];
            parts.push(Part {
                name: name.into(),
                material,
                mesh,
                bodies: vec![body],
                weight,
            });
        }
    }
    parts
}

/// Direction along the arch at a tooth, towards the subject's left and back.
fn tangent(crowns: &[Crown; 7], i: usize) -> Vec3 {
    let before = if i == 0 {
        crowns[0].edge * vec3(-1.0, 1.0, 1.0)
    } else {
        crowns[i - 1].edge
    };
    let after = crowns[(i + 1).min(6)].edge;
    ((after - before) * vec3(1.0, 0.0, 1.0)).normalize_or(Vec3::X)
}

/// One crown: a rounded block that narrows to the neck, thin at the edge for incisors.
fn tooth(crown: &Crown, along: Vec3, up: f32) -> Mesh {
    let out = vec3(-along.z, 0.0, along.x);
    let out = if out.z < 0.0 || (out.z.abs() < 0.2 && out.x < 0.0) {
        -out
    } else {
        out
    };
    let mut mesh = shapes::outward(shapes::grid(14, 7, true, |u, v| {
        let turn = std::f32::consts::TAU * u;
        // A rounded square round the tooth's axis; v = 0 at the middle of the biting edge.
        let (c, s) = (turn.cos(), turn.sin());
        let round = (c.abs().powi(4) + s.abs().powi(4)).powf(-0.25);
        let rise = ((v - 0.22) / 0.78).max(0.0);
        let cap = (v / 0.22).min(1.0);
        let lip = 1.0 - (1.0 - cap).powi(2);
        let neck = 1.0 - 0.22 * rise.powi(2);
        let thin = crown.flat + (1.0 - crown.flat) * (0.30 + 0.70 * rise.powf(0.7));
        let width = 0.5 * crown.width * lip.max(0.02) * neck * c * round;
        let depth = 0.5 * crown.depth * cap.max(0.02).sqrt() * thin * s * round;
        let bow = if crown.flat < 0.5 {
            -0.5 * (1.0 - rise) * (1.0 - crown.flat)
        } else {
            0.0
        };
        let height = crown.height * rise + 0.28 * (lip - 1.0) + 0.7;
        crown.edge + along * width + out * (depth + bow) + vec3(0.0, up * height, 0.0)
    }));
    for (uv, p) in mesh.uvs.iter_mut().zip(&mesh.positions) {
        // v: 0 at the biting edge to 1 at the neck, for translucency.
        *uv = vec2(
            uv.x,
            ((p.y - crown.edge.y) * up / crown.height).clamp(0.0, 1.0),
        );
    }
    mesh
}

/// A ridge along the arch from which the crowns come, scalloped between them.
fn gums(crowns: &[Crown; 7], up: f32) -> Mesh {
    let centre = |s: f32| -> (Vec3, Vec3, f32, f32) {
        // s from -1 (right end) to 1 (left end).
        let along = s.abs() * 6.0;
        let i = (along as usize).min(5);
        let f = along - i as f32;
        let (a, b) = (&crowns[i], &crowns[i + 1]);
        let mut p = a.edge.lerp(b.edge, f);
        if s.abs() < 1e-3 {
            p = a.edge;
        }
        let t = tangent(crowns, i).lerp(tangent(crowns, i + 1), f);
        let side = s.signum();
        let depth = a.depth + (b.depth - a.depth) * f;
        let height = a.height + (b.height - a.height) * f;
        (
            vec3(p.x * side, p.y, p.z),
            vec3(t.x, 0.0, t.z * side),
            depth,
            height,
        )
    };
    shapes::outward(shapes::grid(72, 8, false, |u, v| {
        let (p, along, depth, height) = centre(2.0 * u - 1.0);
        let out = vec3(-along.z, 0.0, along.x).normalize_or(Vec3::Z);
        // v = 0 high on the outer side, over the ridge, to 1 high on the inner side.
        let turn = std::f32::consts::PI * v;
        let scallop = 0.5 * (u * 72.0 * 0.5).cos().abs();
        let across = (0.5 * depth + 0.6) * turn.cos();
        let rise = height * 0.86 + scallop + 9.0 * (1.0 - turn.sin().max(0.0).powf(0.6));
        p + out * (across + 0.8 * (1.0 - turn.sin())) + vec3(0.0, up * rise, 0.0)
    }))
}
