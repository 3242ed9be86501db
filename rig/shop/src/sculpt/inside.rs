//! The dark inside of the mouth behind the teeth, and the tongue in it.

use glam::{vec2, vec3};
use mouthpiece_rig::{Body, Material, Part};

use super::shapes;

/// Both parts.
pub(super) fn parts() -> Vec<Part> {
    vec![cavity(), tongue()]
}

/// A bag that closes the view behind the teeth; its floor hangs on the mandible, its roof on the skull.
fn cavity() -> Part {
    let (columns, rows) = (24, 14);
    let mesh = shapes::grid(columns, rows, true, |u, v| {
        // u round the mouth's axis, v from the throat to the rim behind the teeth.
        let turn = std::f32::consts::TAU * u;
        let depth = v * std::f32::consts::FRAC_PI_2;
        let radius = depth.sin().powf(0.7);
        let half = vec2(29.0, if turn.sin() > 0.0 { 21.5 } else { 20.5 });
        let (x, y) = (half.x * radius * turn.cos(), half.y * radius * turn.sin());
        // The rim comes forward past the lips' inner side, so that no look past the corner escapes.
        let bow = 13.0 * v * (x / 29.0).powi(2);
        vec3(
            x,
            -33.5 + y,
            22.0 + 83.0 * (1.0 - depth.cos()).powf(0.8) - bow,
        )
    });
    let weight = mesh
        .positions
        .iter()
        .map(|p| shapes::ramp(-24.0, -42.0, p.y))
        .collect();
    Part {
        name: "cavity".into(),
        material: Material::Cavity,
        mesh,
        bodies: vec![Body::Skull, Body::Mandible],
        weight,
    }
}

/// The tongue: a tapering body with a groove along its back, its tip just behind the lower teeth.
fn tongue() -> Part {
    let (columns, rows) = (20, 22);
    let mesh = shapes::grid(columns, rows, true, |u, v| {
        let turn = std::f32::consts::TAU * u;
        // Along the tongue: 0 at the tip, 1 at the root.
        let z = 98.5 - 62.0 * v;
        let taper = (1.0 - (1.0 - v).powi(5)).max(0.0).sqrt();
        let half_width = (9.0 + 9.5 * v.sqrt()) * taper;
        let height = (3.0 + 6.5 * v.powf(0.8)) * taper;
        let top =
            -35.8 + 7.0 * (v * 1.25).min(1.0).sin() - 9.0 * ((v - 0.55).max(0.0) / 0.45).powi(2);
        let across = turn.cos();
        let groove = if turn.sin() > 0.0 {
            -1.3 * (-(across / 0.25).powi(2)).exp() * taper
        } else {
            0.0
        };
        vec3(
            half_width * across,
            top + height * (turn.sin() * 0.75 - 0.4) + groove,
            z,
        )
    });
    let weight = mesh
        .positions
        .iter()
        .map(|p| shapes::ramp(46.0, 74.0, p.z) + shapes::ramp(74.0, 95.0, p.z))
        .collect();
    Part {
        name: "tongue".into(),
        material: Material::Tongue,
        mesh,
        bodies: vec![Body::TongueRoot, Body::TongueBlade, Body::TongueTip],
        weight,
    }
}
