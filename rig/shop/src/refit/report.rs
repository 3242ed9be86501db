//! What users read about a fit: the file of `head fit --report`.

use serde::Serialize;

use crate::fit::report::Spread;
use crate::mesh::Preparation;

/// Seconds of wall clock in each stage, reading and writing of files apart.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Tidying the scan, checking and placing the landmarks, building what closest points are found by.
    pub prepare: f64,
    /// The first warp, by landmarks alone.
    pub warp: f64,
    /// Feature-mesh refinement.
    pub refine: f64,
    /// The local fit.
    pub local: f64,
    /// Lips, lids, eyes, control points.
    pub skin: f64,
    /// Bones, muscles, teeth, hair and all other parts.
    pub parts: f64,
    /// The scan's colour in the new map.
    pub colour: f64,
    /// Measuring the result, for this report.
    pub measure: f64,
    /// All of it.
    pub total: f64,
}

/// How good a new head is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FitReport {
    /// Time.
    pub seconds: Seconds,
    /// From the landmarks that were given to those of the new skin.
    pub landmark_error_mm: Spread,
    /// From the new skin's vertices on the face to the scan, where it has a surface.
    pub skin_to_scan_mm: Spread,
    /// From the scan, evenly by area, to the new skin, on the face.
    pub scan_to_skin_mm: Spread,
    /// Share of all faces that are turned over.
    pub turned_faces: f64,
    /// How many of those are at lips, lids or nostrils.
    pub turned_at_features: usize,
    /// Names of the landmarks that were not given.
    pub estimated_landmarks: Vec<String>,
    /// Takes points of the new head (mm) to the scan's own coordinates and unit, row by row.
    pub scan_from_head: [[f64; 4]; 4],
    /// Correspondences found beside the landmarks.
    pub correspondences: usize,
    /// Share of the colour map that shows the scan's own colour.
    pub scan_colour: f64,
    /// What was found in the scan and done about it.
    pub preparation: Preparation,
}
