//! A whole new head from a scan (HEADSHOP 5.2 and 6): what `mouthpiece head fit` does between reading and writing.
//!
//! The reference head's skin, as it is drawn, is fitted to the scan; all that belongs to a head follows it; what it says
//! with (muscles painted on the skin, columns of the lips, calibration) keeps its topology, so that the new head speaks
//! at once. Occlusion is carried over with the topology: a bake takes longer than the whole fit and differs by little.
//!
//! | module | does |
//! |---|---|
//! | `skin` | the template, and the skin that was fitted: lips that close, control points |
//! | `eyes` | eyeballs by their lids, lids outside them, how far lids turn |
//! | `parts` | teeth, tongue, bones, hair and all else |
//! | `colour`, `blend` | the scan's colour in the new head's map |
//! | `report`, `stage`, `error` | what users read about a fit, while it runs, and where there is none |
//!
//! It reads and writes no files, and grows neither hair nor beard of the scanned person: hair is the reference's.

mod blend;
mod colour;
mod error;
mod eyes;
mod parts;
mod report;
mod skin;
mod stage;

use std::collections::HashSet;

use glam::Vec3;
use mouthpiece_rig::{ColourMap, Head, Layer, LipStencils, measure, normals, rebuild};

use crate::bones;
use crate::closest::Surface;
use crate::fit::estimate::{Source, estimate};
use crate::fit::report::{Spread, report as judge};
use crate::fit::{self, Template, fit};
use crate::landmarks::Landmarks;
use crate::mesh::{self, Prepared, ReferencePoint, Scan};
pub use error::RefitError;
pub use report::{FitReport, Seconds};
use skin::Rest;
use stage::Clock;
pub use stage::Stage;

/// A fit whose mean distance from skin to scan is more than this is none, mm.
const ASTRAY_MM: f64 = 4.0;
/// Nor is one with a larger share of faces turned over.
const CRUMPLED: f64 = 0.02;

/// How to make a head.
#[derive(Clone, Debug)]
pub struct Options {
    /// Unit and names of the scan.
    pub scan: mesh::Options,
    /// How the skin is fitted.
    pub fit: fit::Options,
    /// Thickness of the tissue over the bones, as a share of the reference head's.
    pub thickness: f32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            scan: mesh::Options::default(),
            fit: fit::Options::default(),
            thickness: 1.0,
        }
    }
}

/// A new head with what is to be said about it.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// The head, in the head frame, as large as the scanned one.
    pub head: Head,
    /// How good it is.
    pub report: FitReport,
}

/// The landmarks on the skin of `head`, as scans are prepared by. Their normals are those of the skin round them that a
/// scanner sees: just there, at the corner of an eye, the skin may turn inwards.
fn reference_points(head: &Head, rest: &Rest) -> Vec<ReferencePoint> {
    const ROUND_MM: f32 = 12.0;
    let normals = normals(&rest.drawn, &head.skin.mesh.triangles);
    let on_skin = head.landmarks.iter().filter(|l| l.layer == Layer::Skin);
    on_skin
        .map(|l| {
            let at = l.at.on(&rest.drawn);
            let near = (0..normals.len()).filter(|v| rest.drawn[*v].distance(at) < ROUND_MM);
            let sum: Vec3 = near.map(|v| normals[v] * rest.freedom[v]).sum();
            ReferencePoint {
                name: l.name.clone(),
                at,
                normal: sum.normalize_or(l.at.on(&normals).normalize_or(Vec3::Z)),
            }
        })
        .collect()
}

/// The landmarks that a scan for `reference` can have, where its skin is drawn.
///
/// # Errors
/// Where the reference head is not sound.
pub fn landmarks_of(reference: &Head) -> Result<Vec<ReferencePoint>, RefitError> {
    let rest = Rest::of(reference)?;
    Ok(reference_points(reference, &rest))
}

/// Makes the head of `scan`; calls `progress` as each stage begins.
///
/// # Errors
/// Where scan, landmarks or the reference head have a fault that would make a broken head.
pub fn fit_head(
    reference: &Head,
    scan: Scan,
    landmarks: &Landmarks,
    options: &Options,
    mut progress: impl FnMut(Stage),
) -> Result<Fitted, RefitError> {
    let mut seconds = Seconds::default();
    let mut clock = Clock::new();

    progress(Stage::Prepare);
    let rest = Rest::of(reference)?;
    let points = reference_points(reference, &rest);
    if points.len() < crate::landmarks::MIN_LANDMARKS {
        return Err(RefitError::Bare(points.len()));
    }
    let prepared = mesh::prepare(scan, landmarks, &points, &options.scan)?;
    let surface = Surface::new(&prepared.scan.positions, &prepared.scan.triangles)
        .map_err(RefitError::Scan)?;
    let (pairs, estimated) = correspond(&points, &prepared, &surface)?;
    seconds.prepare = clock.lap();

    progress(Stage::Skin);
    let template = Template {
        positions: &rest.drawn,
        triangles: &reference.skin.mesh.triangles,
        freedom: &rest.freedom,
    };
    let mut fitted = fit(&template, &surface, &pairs, &options.fit)?;
    seconds.warp = fitted.seconds.warp;
    seconds.refine = fitted.seconds.refine;
    seconds.local = fitted.seconds.local;
    clock.lap();
    let mut head = carried_over(reference);
    skin::close_lips(&head.lips, &mut fitted.positions);
    eyes::follow(reference, &rest.drawn, &mut fitted.positions, &mut head);
    rest.control(&fitted.positions, &mut head);
    rest.limit
        .apply(&head.skin.mesh.positions, &mut fitted.positions);
    seconds.skin = clock.lap();

    progress(Stage::Parts);
    let carrier = fitted.carrier(&template)?;
    let carry = |from: &[Vec3]| {
        let mut to = vec![Vec3::ZERO; from.len()];
        carrier.apply(from, &mut to);
        to
    };
    parts::follow(reference, &rest.drawn, &fitted.positions, &carry, &mut head);
    let bones = bones::follow(
        reference,
        &head.skin.mesh.positions,
        carry,
        options.thickness,
    )?;
    parts::bones(&mut head, bones);
    head.fibres = rebuild(
        &head.muscles,
        &head.skin.mesh.positions,
        parts::bone_meshes(&head.parts),
    );
    let width = measure(&head, &head.rest_frame()).width_mm;
    head.calibration = head.calibration.for_width(width);
    seconds.parts = clock.lap();

    progress(Stage::Colour);
    let coloured = colour::bake(&prepared.scan, &surface, &fitted.positions, &head);
    let scan_colour = coloured.as_ref().map_or(0.0, |c| c.share);
    if let Some(coloured) = coloured {
        head.colour = Some(coloured.map);
    }
    seconds.colour = clock.lap();

    progress(Stage::Measure);
    let given: Vec<bool> = estimated.iter().map(|e| !e).collect();
    let face = rest.face(reference, &surface, &fitted.positions);
    fitted.landmarks = points_on(reference, &fitted.positions);
    let judged = judge(&template, &fitted, &surface, &pairs, &face).map_err(RefitError::Scan)?;
    let errors = (0..pairs.len()).filter(|i| given[*i]);
    let landmark_error_mm = Spread::of(
        errors
            .map(|i| fitted.landmarks[i].distance(pairs[i].1))
            .collect(),
    );
    seconds.measure = clock.lap();
    seconds.total = clock.total();
    check(&head, &judged)?;
    let report = FitReport {
        seconds,
        landmark_error_mm,
        skin_to_scan_mm: judged.skin_to_scan_mm,
        scan_to_skin_mm: judged.scan_to_skin_mm,
        turned_faces: judged.turned_faces,
        turned_at_features: turned_at_features(reference, &judged.turned),
        estimated_landmarks: points
            .iter()
            .zip(&estimated)
            .filter(|(_, estimated)| **estimated)
            .map(|(p, _)| p.name.clone())
            .collect(),
        scan_from_head: prepared.rows(),
        correspondences: fitted.found,
        scan_colour,
        preparation: prepared.report,
    };
    Ok(Fitted { head, report })
}

/// Pairs of all landmarks, on the reference head and on the scan; and which of the latter were guessed.
#[allow(clippy::type_complexity, reason = "two lists of the same length")]
fn correspond(
    points: &[ReferencePoint],
    prepared: &Prepared,
    surface: &Surface,
) -> Result<(Vec<(Vec3, Vec3)>, Vec<bool>), RefitError> {
    let mut sources: Vec<Source> = points
        .iter()
        .map(|p| Source {
            at: p.at,
            normal: p.normal,
            known: None,
        })
        .collect();
    for (i, at) in &prepared.landmarks {
        sources[*i].known = Some(*at);
    }
    let estimates = estimate(&sources, surface)?;
    let pairs = points.iter().zip(&estimates).map(|(p, e)| (p.at, e.at));
    Ok((
        pairs.collect(),
        estimates.iter().map(|e| e.estimated).collect(),
    ))
}

fn points_on(head: &Head, drawn: &[Vec3]) -> Vec<Vec3> {
    let on_skin = head.landmarks.iter().filter(|l| l.layer == Layer::Skin);
    on_skin.map(|l| l.at.on(drawn)).collect()
}

/// The reference head, to be changed into the new one: without its picture, which is large.
fn carried_over(reference: &Head) -> Head {
    Head {
        lip_stencils: LipStencils::default(),
        ..reference.clone()
    }
}

/// Faces turned over at lips, lids and nostrils.
fn turned_at_features(head: &Head, turned: &[usize]) -> usize {
    let skin = &head.skin;
    let mut watched: HashSet<u32> = head.lids.iter().map(|l| l.vertex).collect();
    watched.extend(head.lips.upper.iter().chain(&head.lips.lower).flatten());
    let at = |v: &u32| watched.contains(v) || skin.wet[*v as usize] > 0.05;
    turned
        .iter()
        .filter(|f| skin.mesh.triangles[**f].iter().any(at))
        .count()
}

/// Whether this is a head at all.
fn check(head: &Head, judged: &crate::fit::report::Report) -> Result<(), RefitError> {
    let places = head.parts.iter().flat_map(|p| &p.mesh.positions);
    if !places
        .chain(&head.skin.mesh.positions)
        .all(|p| p.is_finite())
    {
        return Err(RefitError::Astray("a place is not finite".into()));
    }
    let mean = judged.skin_to_scan_mm.mean;
    if mean > ASTRAY_MM {
        return Err(RefitError::Astray(format!(
            "the skin is {mean:.1} mm off the scan"
        )));
    }
    if judged.turned_faces > CRUMPLED {
        let share = judged.turned_faces * 100.0;
        return Err(RefitError::Astray(format!(
            "{share:.1} % of the skin is turned over"
        )));
    }
    Ok(())
}

/// A colour map with its share of texels that the scan decides.
struct Coloured {
    map: ColourMap,
    share: f64,
}
