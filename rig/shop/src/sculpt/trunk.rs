//! A collar and shoulders, so that the head does not end in the air.

use glam::vec3;

use super::shapes;
use mouthpiece_rig::{Body, Material, Part};

/// A plain crew-neck top.
pub(super) fn cloth() -> Part {
    let mesh = shapes::grid(64, 15, true, |u, v| {
        let turn = std::f32::consts::TAU * u;
        let (side, front) = (turn.sin(), turn.cos());
        let rib = if v < 0.12 {
            2.2 * (std::f32::consts::PI * v / 0.12).sin()
        } else {
            0.0
        };
        let spread = shapes::ramp(0.05, 0.85, v);
        let half_x = 63.0 + rib + 150.0 * spread.powf(1.15);
        let half_z = 62.0 + rib + 34.0 * spread;
        let shoulder = (side.abs()).powf(1.6);
        let drop = 4.0 * v + 26.0 * v * v + (95.0 - 52.0 * shoulder) * v.powf(1.4) * 1.25;
        let collar = -88.0 - 13.0 * front.max(0.0) + 9.0 * (-front).max(0.0);
        vec3(
            half_x * side,
            collar - drop,
            -8.0 + half_z * front - 12.0 * v,
        )
    });
    let weight = vec![0.0; mesh.positions.len()];
    Part {
        name: "cloth".into(),
        material: Material::Cloth,
        mesh,
        bodies: vec![Body::Trunk],
        weight,
    }
}
