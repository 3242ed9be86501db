//! The reference head, built by program from the surface data of a mean human head.
//!
//! HEADSHOP 3 lists the parts: a skin whose edges follow the features and whose tessellation follows
//! how much a region moves, muscles, eyes, teeth and tongue. Here the skin is a graded, constrained
//! Delaunay mesh over a cylindrical chart, mirrored left to right, with openings at mouth, eyes and
//! nostrils whose insides are extruded. What it does not do: fit other people's scans.

mod crown;
mod eyes;
mod hair;
mod layout;
mod mouth;
mod polyline;
mod shapes;
mod skin;
mod surface;
mod teeth;
mod trunk;

use glam::vec3;
use thiserror::Error;

use crate::{Calibration, CalibrationError, Eye, Feature, Head, Placement};
use surface::{Surface, chart_of, uv_of};

/// Levels of a lip's column in this template.
const LEVELS: usize = 7;

/// What can be wrong with the data that the crate carries; none of it is a user's doing.
#[derive(Debug, Error)]
pub enum ReferenceError {
    /// The surface map is no PNG.
    #[error("rig/data/surface.png is not a PNG: {0}; restore it from the repository")]
    Map(#[from] png::DecodingError),
    /// The surface map has another size.
    #[error(
        "rig/data/surface.png holds {0} radii instead of 65536; restore it from the repository"
    )]
    MapSize(usize),
    /// The curves are no JSON of the expected form.
    #[error("rig/data/curves.json: {0}; restore it from the repository")]
    Curves(#[from] serde_json::Error),
    /// The muscle table has a wrong row.
    #[error("rig/data/muscles.json: {0}; restore it from the repository")]
    Muscles(serde_json::Error),
    /// The calibration is damaged.
    #[error("rig/data/calibration.json: {0}; restore it from the repository")]
    Calibration(#[from] CalibrationError),
    /// The template could not be triangulated.
    #[error("the skin template cannot be triangulated: {0}")]
    Triangulation(#[from] spade::InsertionError),
}

impl Head {
    /// The reference head.
    ///
    /// # Errors
    /// Only where the crate's own data is damaged.
    pub fn reference() -> Result<Self, ReferenceError> {
        let surface = Surface::load()?;
        let eyes = eyes::Eyes::new();
        let (skin, lips, lids) = skin::build(&surface, &eyes)?;
        let mut parts = eyes.parts();
        parts.extend(teeth::parts());
        parts.extend(mouth::parts());
        parts.push(hair::cap(&surface));
        parts.push(trunk::cloth());
        let mut head = Self {
            skin,
            parts,
            features: features(&surface),
            lips,
            lip_stencils: crate::LipStencils::default(),
            lids,
            fibres: Vec::new(),
            landmarks: Vec::new(),
            muscles: Vec::new(),
            eyes: [1.0, -1.0].map(|side| Eye {
                centre: eyes.centre * vec3(side, 1.0, 1.0),
                radius: eyes.radius,
            }),
            bite: Placement::default(),
            condyle_axis: vec3(0.0, 13.77, 25.43),
            neck_pivot: vec3(0.0, -45.0, 5.0),
            calibration: Calibration::reference()?,
            colour: None,
        };
        head.fibres = fibres()?;
        crate::occlusion::bake(&mut head);
        Ok(head)
    }
}

/// The reference head's fibres, for heads without muscles painted on their skin.
pub(crate) fn fibres() -> Result<Vec<crate::Fibre>, ReferenceError> {
    let surface = Surface::load()?;
    let round = |longitude: f32, y: f32| {
        surface.point(glam::vec2(
            longitude * surface::BACK / std::f32::consts::PI,
            y,
        ))
    };
    crate::muscle::fibres(|x, y| surface.seen_from_front(x, y), round)
        .map_err(ReferenceError::Muscles)
}

/// The lines that the colour map is painted by, both sides.
fn features(surface: &Surface) -> Vec<Feature> {
    let curves = &surface.curves;
    let sided = [
        (["brow_upper_l", "brow_upper_r"], &curves.brow_upper),
        (["brow_lower_l", "brow_lower_r"], &curves.brow_lower),
        (["lid_crease_l", "lid_crease_r"], &curves.upper_lid_crease),
        (["lid_margin_l", "lid_margin_r"], &curves.lid_margin_outer),
        (
            ["vermilion_upper_l", "vermilion_upper_r"],
            &curves.vermilion_upper,
        ),
        (
            ["vermilion_lower_l", "vermilion_lower_r"],
            &curves.vermilion_lower,
        ),
        (["hairline_l", "hairline_r"], &curves.hairline),
        (["alar_crease_l", "alar_crease_r"], &curves.alar_crease),
    ];
    sided
        .into_iter()
        .flat_map(|(names, line)| {
            names
                .into_iter()
                .zip([1.0, -1.0])
                .map(move |(name, side)| Feature {
                    name: name.into(),
                    points: line
                        .iter()
                        .map(|p| uv_of(chart_of(*p * vec3(side, 1.0, 1.0))))
                        .collect(),
                })
        })
        .collect()
}
