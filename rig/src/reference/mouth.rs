//! The reference mouth: lips as columns from the vermilion border over crest and contact line to the
//! inner side, and the dark inside behind the teeth with the tongue in it.

use glam::{Vec2, Vec3, vec2, vec3};

use super::LEVELS as LIP_LEVELS;
use super::polyline::at_x;
use super::shapes;
use super::surface::{Surface, chart_of};
use crate::{Body, Material, Part};

/// Columns from the mid line to the corner of the mouth, both included.
pub(super) const STATIONS: usize = 12;
/// Where the slit between the lips ends; the corner's skin (cheilion) lies a little further out.
const SLIT_END: Vec3 = vec3(24.2, -35.0, 101.9);
const CHEILION_X: f32 = 26.4;

/// A column of one lip: places in the chart of the levels that lie in it, and points of all levels.
pub(super) struct Column {
    pub chart: [Vec2; 4],
    pub points: [Vec3; LIP_LEVELS],
}

/// One lip's columns, from the mid line to the corner. `sign` is 1 for the upper lip.
///
/// The surface data holds the lips 0.8 mm apart; here they meet at rest, since a mouth at rest is
/// closed: the contact line goes to the middle, the crest a quarter of the way.
pub(super) fn lip(surface: &Surface, sign: f32) -> Vec<Column> {
    let curves = &surface.curves;
    let (vermilion, own, other) = if sign > 0.0 {
        (
            &curves.vermilion_upper,
            &curves.lip_contact_upper,
            &curves.lip_contact_lower,
        )
    } else {
        (
            &curves.vermilion_lower,
            &curves.lip_contact_lower,
            &curves.lip_contact_upper,
        )
    };
    let contact = |line: &[Vec3], x: f32| {
        let last = line.last().copied().unwrap_or(SLIT_END);
        if x <= last.x {
            at_x(line, x)
        } else {
            last.lerp(SLIT_END, (x - last.x) / (SLIT_END.x - last.x))
        }
    };
    (0..STATIONS)
        .map(|i| {
            let share = i as f32 / (STATIONS - 1) as f32;
            let x = SLIT_END.x * share;
            let meeting = (contact(own, x) + contact(other, x)) * 0.5;
            let closing = meeting - contact(own, x);
            let corner = i == STATIONS - 1;
            let border = if corner {
                surface.seen_from_front(CHEILION_X, -35.2)
            } else {
                at_x(vermilion, x * 1.03)
            };
            // Apart in the chart, so that the slit is a hole there.
            let apart = sign * 0.5 * (1.0 - share * share).max(0.0).sqrt();
            let v = chart_of(border);
            let k = chart_of(meeting) + vec2(0.0, apart);
            let (c, b) = if corner {
                (v, k)
            } else {
                (v.lerp(k, 0.36), v.lerp(k, 0.70))
            };
            let crest = surface.point(c) + closing * 0.25;
            let brim = surface.point(b) + closing * 0.6;
            let inner = |rise: f32, back: f32| {
                let narrow = 1.0 - 0.5 * share.powi(3);
                let rise = if corner { 0.0 } else { sign * rise * narrow };
                meeting + vec3(-0.05 * x * share * back / 6.0, rise, -back)
            };
            Column {
                chart: [v, c, b, k],
                points: [
                    border,
                    if corner { border } else { crest },
                    if corner { meeting } else { brim },
                    meeting,
                    inner(0.0, 2.6),
                    inner(3.4, 3.9),
                    inner(9.0, 4.3),
                ],
            }
        })
        .collect()
}

/// Inside of the mouth and the tongue.
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
