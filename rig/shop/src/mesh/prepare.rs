//! A scan made ready for the fit (HEADSHOP 6): clean, in the head frame, in true millimetres, with its
//! landmarks checked against those of the reference head. Size and shape stay as they are; only the
//! place, the turn and the unit change.

use glam::{DMat3, DMat4, DVec3, Vec3};
use serde::Serialize;

use super::check::{Pairs, Verdict, mirror};
use super::error::{Fault, Place, ScanError};
use super::nearest::{Nearest, Spot, facing};
use super::scan::{Scan, ScanColour};
use super::similarity::{Similarity, mean};
use super::tidy::{Dropped, tidy};
use super::units::{self, Measured};
use crate::landmarks::{LandmarkError, LandmarkFault, Landmarks, MIN_LANDMARKS};

/// A landmark of the reference head.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferencePoint {
    /// As in landmark files.
    pub name: String,
    /// In the head frame, mm.
    pub at: Vec3,
    /// The skin's outward unit normal there.
    pub normal: Vec3,
}

/// What the user may say about a scan.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Millimetres in a unit of the scan; found from the landmarks where it is not said.
    pub mm_per_unit: Option<f64>,
    /// The scan's file, for messages.
    pub scan_file: String,
    /// The landmarks' file, for messages.
    pub landmarks_file: String,
}

/// Why a scan and its landmarks cannot be fitted to.
#[derive(Debug, thiserror::Error)]
pub enum PrepareError {
    /// The scan's fault.
    #[error(transparent)]
    Scan(#[from] ScanError),
    /// The landmarks' fault.
    #[error(transparent)]
    Landmarks(#[from] LandmarkError),
}

/// What preparing found and did.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Preparation {
    /// What was taken from the mesh.
    pub dropped: Dropped,
    /// Millimetres in a unit of the scan.
    pub mm_per_unit: f64,
    /// Size of the head as a share of the reference head's.
    pub size_ratio: f64,
    /// Root mean square of what the similarity leaves between the landmarks, mm.
    pub landmark_rms_mm: f64,
    /// Whether the triangles faced inwards and were turned.
    pub turned_inside_out: bool,
    /// Landmarks that hang over a hole, off the surface.
    pub mid_air_landmarks: Vec<String>,
    /// What the user should know, one sentence each.
    pub notes: Vec<String>,
}

/// A scan that can be fitted to.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// In the head frame, mm, at its true size.
    pub scan: Scan,
    /// Landmarks in the head frame: which of the reference points, and where.
    pub landmarks: Vec<(usize, Vec3)>,
    /// Takes points of the head frame (mm) to the scan's own coordinates and unit.
    pub scan_from_head: DMat4,
    /// What was found and done.
    pub report: Preparation,
}

impl Prepared {
    /// `scan_from_head` as rows, as reports have it.
    #[must_use]
    pub fn rows(&self) -> [[f64; 4]; 4] {
        self.scan_from_head.transpose().to_cols_array_2d()
    }
}

/// A landmark may be this far off the surface, mm: hair and the thickness of a pen.
const OFF_SURFACE: f64 = 20.0;
/// And this far where the nearest surface is the rim of a hole: HEADSHOP 6.1 has them in mid-air.
const OFF_RIM: f64 = 60.0;
/// Radius about the landmarks in which the surface is asked which way it lies, mm.
const AROUND: f64 = 30.0;
/// Farther than this a landmark of the reference has no counterpart on the scan, mm.
const FAR: f64 = 40.0;
/// A mirrored reference must lie this much nearer to the surface to be believed, mm.
const CLEARLY: f64 = 1.0;

/// Makes `scan` ready.
///
/// # Errors
/// When scan or landmarks have a fault that would make a broken head; the message names it and the mend.
pub fn prepare(
    scan: Scan,
    landmarks: &Landmarks,
    reference: &[ReferencePoint],
    options: &Options,
) -> Result<Prepared, PrepareError> {
    let scan_fault = |f: Fault| PrepareError::from(f.at(&options.scan_file, Place::Whole));
    let fault = |f: LandmarkFault| PrepareError::from(f.in_file(&options.landmarks_file));
    landmarks
        .check(reference.iter().map(|r| r.name.as_str()))
        .map_err(fault)?;
    if landmarks.points.len() < MIN_LANDMARKS {
        return Err(fault(LandmarkFault::TooFew(landmarks.points.len())));
    }
    let (scan, dropped) = tidy(scan).map_err(scan_fault)?;
    let known: Vec<(usize, DVec3)> = reference
        .iter()
        .enumerate()
        .filter_map(|(i, r)| Some((i, *landmarks.points.get(&r.name)?)))
        .collect();
    let names: Vec<&str> = known.iter().map(|k| reference[k.0].name.as_str()).collect();
    let given: Vec<DVec3> = known.iter().map(|k| k.1).collect();
    let there: Vec<DVec3> = known.iter().map(|k| reference[k.0].at.as_dvec3()).collect();
    let measured = units::measure(
        &scan,
        &names,
        &given,
        &there,
        landmarks.unit,
        options.mm_per_unit,
    );
    let measured = measured.map_err(fault)?;
    let mid_air = on_surface(&scan, &names, &measured).map_err(fault)?;
    let mm = measured.mm_per_unit;
    let pairs = Pairs {
        names,
        reference: there,
        points: measured.points.iter().map(|&p| p * mm).collect(),
    };
    let seen = Seen {
        scan: &scan,
        reference,
        known: &known,
        measured: &measured,
    };
    let inside_out = match seen.hand(&pairs).map_err(fault)? {
        Hand::Right => false,
        Hand::InsideOut => true,
        Hand::Swapped => return Err(fault(LandmarkFault::Swapped)),
        Hand::Mirrored => return Err(scan_fault(Fault::Mirrored)),
    };
    pairs.apart(measured.ratio).map_err(fault)?;
    pairs.none_astray(measured.ratio).map_err(fault)?;
    let mut notes: Vec<String> = measured.note.iter().cloned().collect();
    if inside_out {
        notes.push("the scan's triangles faced inwards and were turned".to_owned());
    }
    let similarity = pairs.fit();
    let report = Preparation {
        dropped,
        mm_per_unit: mm,
        size_ratio: measured.ratio,
        landmark_rms_mm: similarity.rms(&pairs.reference, &pairs.points),
        turned_inside_out: inside_out,
        mid_air_landmarks: mid_air,
        notes,
    };
    Ok(place(scan, &known, &pairs, &similarity, report))
}

/// Names of the landmarks over holes, where all others lie on the surface.
fn on_surface(
    scan: &Scan,
    names: &[&str],
    measured: &Measured,
) -> Result<Vec<String>, LandmarkFault> {
    let distance = |i: usize| measured.distances[i].0 * measured.mm_per_unit;
    let off: Vec<usize> = (0..names.len())
        .filter(|&i| distance(i) > OFF_SURFACE)
        .collect();
    if off.is_empty() {
        return Ok(Vec::new());
    }
    let triangles: Vec<usize> = off.iter().map(|&i| measured.distances[i].1).collect();
    let rim = Nearest::new(scan).on_rim(&triangles);
    for (&i, rim) in off.iter().zip(rim) {
        if !rim || distance(i) > OFF_RIM {
            return Err(LandmarkFault::Outside {
                name: names[i].to_owned(),
                distance: distance(i),
            });
        }
    }
    Ok(off.into_iter().map(|i| names[i].to_owned()).collect())
}

enum Hand {
    Right,
    InsideOut,
    Swapped,
    Mirrored,
}

/// Scan and reference, to be held against each other.
struct Seen<'a> {
    scan: &'a Scan,
    reference: &'a [ReferencePoint],
    known: &'a [(usize, DVec3)],
    measured: &'a Measured,
}

impl Seen<'_> {
    /// Which hand landmarks and surface are of. Landmarks alone cannot tell exchanged sides from a
    /// mirrored scan, and landmarks in one plane cannot even tell front from back: the surface tells.
    fn hand(&self, given: &Pairs<'_>) -> Result<Hand, LandmarkFault> {
        let ratio = self.measured.ratio;
        let sides = given.sides();
        let mut crossed = given.crossed(&sides, ratio);
        let mut pairs = given.exchanged(&sides, &crossed);
        if given.mirrored_error() < 1.05 * pairs.error() + 0.1 * ratio {
            // One exchange of everything says it all.
            pairs = given.exchanged(&sides, &[]);
            crossed.fill(false);
        }
        let straight = pairs.fit();
        let mirrored = pairs.fit_mirrored();
        let nearer = |by: f64| {
            let off = self.off_surface(&straight, &|p| p);
            self.off_surface(&mirrored, &mirror) + by < off
        };
        let turned = match pairs.hand(ratio) {
            Verdict::Straight => false,
            Verdict::Mirrored => true,
            Verdict::Likely => nearer(0.0),
            Verdict::Open => nearer(CLEARLY * ratio),
        };
        let faces_out = if turned {
            self.faces_out(&|normal| mirrored.rotation * mirror(normal))
        } else {
            self.faces_out(&|normal| straight.rotation * normal)
        };
        if turned && crossed.contains(&true) {
            // Then the others are the ones that are exchanged.
            crossed.iter_mut().for_each(|c| *c = !*c);
        } else if turned {
            return Ok(if faces_out {
                Hand::Swapped
            } else {
                Hand::Mirrored
            });
        }
        let count = crossed.iter().filter(|c| **c).count();
        let lateral = |name: &&&str| name.ends_with("_l") || name.ends_with("_r");
        match count {
            0 => Ok(if faces_out {
                Hand::Right
            } else {
                Hand::InsideOut
            }),
            n if 2 * n == given.names.iter().filter(lateral).count() => Ok(if faces_out {
                Hand::Swapped
            } else {
                Hand::Mirrored
            }),
            _ => Err(given.fault(&sides, &crossed)),
        }
    }

    /// Whether the triangles about the landmarks face the way that `turn` makes of the reference's normals.
    fn faces_out(&self, turn: &dyn Fn(DVec3) -> DVec3) -> bool {
        let spot = |(k, &at): (&(usize, DVec3), &DVec3)| Spot {
            at,
            outward: turn(self.reference[k.0].normal.as_dvec3()),
        };
        let spots: Vec<Spot> = self
            .known
            .iter()
            .zip(&self.measured.points)
            .map(spot)
            .collect();
        let radius = AROUND * self.measured.ratio / self.measured.mm_per_unit;
        facing(self.scan, &spots, radius) >= 0.0
    }

    /// How far the reference's landmarks, all of them, lie from the surface once `fit` has moved them,
    /// mm on average; what is farther than `FAR` counts as that, since scans have holes.
    fn off_surface(&self, fit: &Similarity, shape: &dyn Fn(DVec3) -> DVec3) -> f64 {
        let nearest = Nearest::new(self.scan);
        let mm = self.measured.mm_per_unit;
        let off = |r: &ReferencePoint| {
            let at = fit.apply(shape(r.at.as_dvec3())) / mm;
            (nearest.find(at).0 * mm).min(FAR * self.measured.ratio)
        };
        self.reference.iter().map(off).sum::<f64>() / self.reference.len() as f64
    }
}

/// The scan in the head frame.
fn place(
    mut scan: Scan,
    known: &[(usize, DVec3)],
    pairs: &Pairs<'_>,
    similarity: &Similarity,
    report: Preparation,
) -> Prepared {
    let turn = DMat3::from_quat(similarity.rotation);
    let shift = mean(&pairs.points) - turn * mean(&pairs.reference);
    let mm = report.mm_per_unit;
    let back = turn.transpose();
    let head = |mm_point: DVec3| (back * (mm_point - shift)).as_vec3();
    for p in &mut scan.positions {
        *p = head(p.as_dvec3() * mm);
    }
    if report.turned_inside_out {
        for t in &mut scan.triangles {
            t.swap(1, 2);
        }
        if let Some(ScanColour::Texture { uvs, .. }) = &mut scan.colour {
            for uv in uvs {
                uv.swap(1, 2);
            }
        }
    }
    let landmarks = known
        .iter()
        .zip(&pairs.points)
        .map(|(k, &p)| (k.0, head(p)))
        .collect();
    let scan_from_head = DMat4::from_scale(DVec3::splat(1.0 / mm))
        * DMat4::from_translation(shift)
        * DMat4::from_mat3(turn);
    Prepared {
        scan,
        landmarks,
        scan_from_head,
        report,
    }
}
