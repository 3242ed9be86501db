//! The reference head: our own template over the surface of a mean human head.
//!
//! HEADSHOP 3 lists the parts: a skin whose edges follow the features and whose tessellation follows how much a region
//! moves, muscles, skull, eyes, teeth and tongue. The left half of the skin is built from structured rings round mouth,
//! eye and nostril, an ear of its own, and graded constrained Delaunay triangles between them, over feature curves; it is
//! evened out on the surface, mirrored, and given control positions whose drawn surface passes through it.
//!
//! | module | holds |
//! |---|---|
//! | `target` | the surface, its feature curves, the chart |
//! | `half` | the half template while it grows |
//! | `mouth`, `sockets`, `ear`, `chart`, `crown` | its regions |
//! | `fill` | triangles over a flat region |
//! | `relax` | slides and flips what is free |
//! | `skin` | both halves |
//! | `marks` | landmarks and feature lines |
//! | `bones` | skull and mandible |
//! | `eyes`, `teeth`, `inside`, `trunk` | the other parts |

mod bones;
mod chart;
mod crown;
mod ear;
mod eyes;
mod fill;
mod half;
mod inside;
mod marks;
mod mouth;
mod polyline;
mod relax;
mod shapes;
mod skin;
mod sockets;
mod target;
mod teeth;
mod trunk;

use glam::{Vec3, vec3};
use mouthpiece_rig::{
    Calibration, Eye, Head, LipStencils, Material, Placement, SubdivisionError, TissueRecord,
    fit_control, normals,
};
use thiserror::Error;

use crate::closest::SurfaceError;
use crate::mesh::ScanError;
use crate::{colour, hair, muscles, occlusion};
use target::Target;

/// What can be wrong with the data that the crate carries; none of it is a user's doing.
#[derive(Debug, Error)]
pub enum SculptError {
    /// A mesh cannot be read.
    #[error("{0}; restore it from the repository")]
    Surface(#[from] ScanError),
    /// The surface is none.
    #[error("rig/shop/data/mean_head.ply: {0}; restore it from the repository")]
    Mesh(#[from] SurfaceError),
    /// The curves are no JSON of the expected form.
    #[error("rig/shop/data/curves.json: {0}; restore it from the repository")]
    Curves(#[from] serde_json::Error),
    /// The landmarks are no JSON of the expected form.
    #[error("rig/shop/data/landmarks.json: {0}; restore it from the repository")]
    Landmarks(serde_json::Error),
    /// The bones' landmarks are no JSON of the expected form.
    #[error("rig/shop/data/skull_landmarks.json: {0}; restore it from the repository")]
    BoneLandmarks(serde_json::Error),
    /// A landmark is not where its surface is.
    #[error(
        "the landmark {0} lies far from its surface; restore rig/shop/data from the repository"
    )]
    Astray(String),
    /// The muscles cannot be painted on it.
    #[error(transparent)]
    Muscles(#[from] muscles::MuscleError),
    /// The template is no surface.
    #[error("the skin template is no surface: {0}")]
    Template(SurfaceError),
    /// The template has no drawn surface.
    #[error("the skin template cannot be drawn: {0}")]
    Drawn(#[from] SubdivisionError),
    /// The template could not be triangulated.
    #[error("the skin template cannot be triangulated: {0}")]
    Triangulation(#[from] spade::InsertionError),
}

/// What the head turns about, and a point of the axis through the condyles (skull of the figures, registered), mm.
const NECK_PIVOT: Vec3 = vec3(0.0, -45.0, 5.0);
const CONDYLE_AXIS: Vec3 = vec3(0.0, 13.77, 25.43);

/// The reference head. `calibration` is taken over as it is: it is fitted from the finished head.
///
/// # Errors
/// Only where the crate's own data is damaged.
pub fn reference(calibration: Calibration) -> Result<Head, SculptError> {
    let target = Target::load()?;
    let eyes = eyes::Eyes::new();
    let (skin, lips, lids) = skin::build(&target, &eyes)?;
    let drawn = skin.mesh.positions.clone();
    let mut parts = eyes.parts();
    parts.extend(teeth::parts());
    parts.extend(inside::parts());
    parts.push(trunk::cloth());
    let (skeleton, on_bone) = bones::build()?;
    parts.extend(skeleton);
    let mut landmarks = marks::landmarks(&skin, &drawn)?;
    landmarks.extend(on_bone);
    let mut head = Head {
        landmarks,
        features: marks::features(&target),
        skin,
        parts,
        lips,
        lids,
        muscles: Vec::new(),
        fibres: Vec::new(),
        eyes: [1.0, -1.0].map(|side| Eye {
            centre: eyes.centre * vec3(side, 1.0, 1.0),
            radius: eyes.radius,
        }),
        bite: Placement::default(),
        condyle_axis: CONDYLE_AXIS,
        neck_pivot: NECK_PIVOT,
        tissue: TissueRecord::default(),
        calibration,
        lip_stencils: LipStencils::default(),
        colour: None,
    };
    // The drawn surface is to pass through the template's vertices.
    head.skin.mesh.positions = fit_control(&head.skin_limit()?, &drawn);
    head.skin.reference.clone_from(&head.skin.mesh.positions);
    head.skin.mesh.normals = normals(&head.skin.mesh.positions, &head.skin.mesh.triangles);
    let bones = head.parts.iter().filter(|p| p.material == Material::Bone);
    head.muscles = muscles::paint(&head.skin.mesh, bones.map(|p| &p.mesh))?;
    head.parts.extend(hair::grow(&head));
    head.parts.extend(hair::lashes(&head));
    occlusion::bake(&mut head);
    head.colour = Some(colour::paint(&head, colour::WIDTH));
    Ok(head)
}
