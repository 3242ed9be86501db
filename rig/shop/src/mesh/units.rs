//! What a scan and its landmarks are measured in. A mesh file says nothing of it (or is wrong), a
//! landmark file says something; the surface tells whether both are in one unit, and the size of a head
//! tells which.

use glam::DVec3;

use super::check::on_a_line;
use super::nearest::Nearest;
use super::scan::Scan;
use super::tidy::diagonal;
use crate::landmarks::{LandmarkFault, Unit};

/// Landmarks lie on the scan if the middle one of their distances is below this share of the scan.
const NEAR: f64 = 0.03;
/// Below this share of the scan's size all landmarks are on one spot: lips alone span more.
const SPOT: f64 = 0.02;
/// How much smaller or larger than the reference a head can be: newborns to giants, with room.
const SIZES: std::ops::RangeInclusive<f64> = 0.5..=2.0;

/// A scan and its landmarks, measured.
pub(crate) struct Measured {
    /// Millimetres in a unit of the scan.
    pub(crate) mm_per_unit: f64,
    /// Landmarks in the scan's unit.
    pub(crate) points: Vec<DVec3>,
    /// Their distances to the surface in the scan's unit, and the nearest triangles.
    pub(crate) distances: Vec<(f64, usize)>,
    /// Size of the head as a share of the reference's.
    pub(crate) ratio: f64,
    /// What the user should know.
    pub(crate) note: Option<String>,
}

/// Landmarks times `factor`: distances to the surface, and the middle one as a share of the scan's size.
struct Candidate {
    factor: f64,
    middle: f64,
    distances: Vec<(f64, usize)>,
}

/// `points` are landmarks as given in `unit`, `reference` the same ones in mm; `given` is the scan's unit
/// if the user said it.
pub(crate) fn measure(
    scan: &Scan,
    names: &[&str],
    points: &[DVec3],
    reference: &[DVec3],
    unit: Unit,
    given: Option<f64>,
) -> Result<Measured, LandmarkFault> {
    let span = |points: &[DVec3]| {
        let far = points.iter().map(|p| p.distance(points[0]));
        far.fold(0.0, f64::max)
    };
    if span(points) <= 0.0 {
        return Err(LandmarkFault::OneSpot);
    }
    let nearest = Nearest::new(scan);
    let size = f64::from(diagonal(&scan.positions));
    // Landmarks are in the scan's own unit, or the scan is in another one than they say.
    let units: Vec<f64> = given.map_or(Unit::ALL.map(Unit::mm).to_vec(), |mm| vec![mm]);
    let others = units
        .iter()
        .map(|mm| unit.mm() / mm)
        .filter(|k| (k - 1.0).abs() > 1e-9);
    let mut best: Option<Candidate> = None;
    for factor in std::iter::once(1.0).chain(others) {
        let distances: Vec<_> = points.iter().map(|&p| nearest.find(p * factor)).collect();
        let mut sorted: Vec<f64> = distances.iter().map(|d| d.0).collect();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted[sorted.len() / 2] / size;
        if best.as_ref().is_none_or(|b| middle < b.middle) {
            best = Some(Candidate {
                factor,
                middle,
                distances,
            });
        }
        if middle < NEAR {
            break;
        }
    }
    // There is always the factor 1.
    let Candidate {
        factor,
        middle,
        distances,
    } = best.ok_or(LandmarkFault::TooFew(0))?;
    let worst = (0..points.len()).max_by(|&i, &j| distances[i].0.total_cmp(&distances[j].0));
    if middle >= NEAR {
        let worst = worst.unwrap_or(0);
        return Err(LandmarkFault::AllOutside {
            name: names[worst].to_owned(),
            distance: distances[worst].0 * unit.mm() / factor,
            unit,
        });
    }
    let points: Vec<DVec3> = points.iter().map(|&p| p * factor).collect();
    if span(&points) < SPOT * size {
        return Err(LandmarkFault::OneSpot);
    }
    if on_a_line(&points) || on_a_line(reference) {
        return Err(LandmarkFault::Collinear);
    }
    let raw = ratio(reference, &points);
    let (mm_per_unit, note) = choose(raw, unit, factor, given)?;
    Ok(Measured {
        mm_per_unit,
        ratio: raw * mm_per_unit,
        points,
        distances,
        note,
    })
}

/// The scan's unit, where `raw` is the head's size in it as a share of the reference's in mm.
fn choose(
    raw: f64,
    unit: Unit,
    factor: f64,
    given: Option<f64>,
) -> Result<(f64, Option<String>), LandmarkFault> {
    let fits = |mm: f64| SIZES.contains(&(raw * mm));
    let wrong = |mm_per_unit: f64, mend| LandmarkFault::Size {
        mm_per_unit,
        ratio: raw * mm_per_unit,
        mend,
    };
    if let Some(given) = given {
        return if fits(given) {
            Ok((given, None))
        } else {
            Err(wrong(
                given,
                "leave the unit out, so that it is found, or give the right one",
            ))
        };
    }
    // What the landmark file says holds if it makes a head of it.
    let said = unit.mm() / factor;
    if fits(said) {
        let note =
            format!("the landmarks are in {unit}; the scan is taken to be 1 unit = {said} mm");
        return Ok((said, (factor != 1.0).then_some(note)));
    }
    let off = |u: &Unit| (raw * u.mm()).ln().abs();
    let found = Unit::ALL
        .into_iter()
        .min_by(|a, b| off(a).total_cmp(&off(b)))
        .unwrap_or_default();
    if factor == 1.0 && fits(found.mm()) {
        let note = format!(
            "the landmarks say {unit}, but in that the head would be {:.3} times as large as the reference head, so scan and landmarks are taken to be in {found}",
            raw * said
        );
        return Ok((found.mm(), Some(note)));
    }
    Err(wrong(
        said,
        "scale the scan and its landmarks to life size, or say how many mm its unit has",
    ))
}

/// The middle one of the ratios of distances between points: one wrong point does not move it.
fn ratio(reference: &[DVec3], points: &[DVec3]) -> f64 {
    const SHORTEST_MM: f64 = 5.0;
    let mut ratios = Vec::new();
    for i in 0..points.len() {
        for j in 0..i {
            let length = reference[i].distance(reference[j]);
            if length > SHORTEST_MM {
                ratios.push(points[i].distance(points[j]) / length);
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().unwrap_or(1.0)
}
