//! The reference head's landmarks and feature lines, taken from the mean head to the template over it.

use glam::{Vec3, vec3};
use mouthpiece_rig::{Feature, Landmark, Layer, Skin, SurfacePoint};
use serde::Deserialize;

use super::SculptError;
use super::target::{Target, chart_of, uv_of};
use crate::closest::Surface;

const LANDMARKS: &str = include_str!("../../data/landmarks.json");
/// A landmark lies no farther from the skin than this, mm: lids are relaxed, lips closed.
const REACH_MM: f32 = 6.0;

/// A row of the table: a place on the mean head, of the subject's left where there are two.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    name: String,
    paired: bool,
    at: Vec3,
}

/// The landmarks as places on the triangles of `skin`, looked up where its drawn surface `drawn` lies.
pub(super) fn landmarks(skin: &Skin, drawn: &[Vec3]) -> Result<Vec<Landmark>, SculptError> {
    let rows: Vec<Row> = serde_json::from_str(LANDMARKS).map_err(SculptError::Landmarks)?;
    let surface = Surface::new(drawn, &skin.mesh.triangles).map_err(SculptError::Template)?;
    let on = |name: String, at: Vec3| -> Result<Landmark, SculptError> {
        let Some(hit) = surface.closest(at, REACH_MM) else {
            return Err(SculptError::Astray(name));
        };
        let vertices = skin.mesh.triangles[hit.triangle as usize];
        let at = SurfacePoint {
            vertices,
            shares: hit.barycentric,
        };
        Ok(Landmark {
            name,
            layer: Layer::Skin,
            at,
            of: None,
        })
    };
    let mut landmarks = Vec::new();
    for Row { name, paired, at } in rows {
        if paired {
            landmarks.push(on(format!("{name}_l"), at)?);
            landmarks.push(on(format!("{name}_r"), at * vec3(-1.0, 1.0, 1.0))?);
        } else {
            landmarks.push(on(name, at)?);
        }
    }
    Ok(landmarks)
}

/// The lines that the colour map is painted by and hair grows by, both sides, in the chart.
pub(super) fn features(target: &Target) -> Vec<Feature> {
    let curves = &target.curves;
    let lines = [
        ("brow_upper", &curves.brow_upper),
        ("brow_lower", &curves.brow_lower),
        ("lid_crease", &curves.upper_lid_crease),
        ("lid_margin", &curves.lid_margin_outer),
        ("vermilion_upper", &curves.vermilion_upper),
        ("vermilion_lower", &curves.vermilion_lower),
        ("hairline", &curves.hairline),
        ("alar_crease", &curves.alar_crease),
    ];
    let sides = [("l", 1.0), ("r", -1.0)];
    lines
        .into_iter()
        .flat_map(|(name, line)| sides.map(|(side, x)| (format!("{name}_{side}"), line, x)))
        .map(|(name, line, x)| Feature {
            name,
            points: line
                .iter()
                .map(|p| uv_of(chart_of(*p * vec3(x, 1.0, 1.0))))
                .collect(),
        })
        .collect()
}
