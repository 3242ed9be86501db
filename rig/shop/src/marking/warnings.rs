//! What looks wrong among landmarks that a person has set, said while it is easily mended: sides exchanged, or one
//! point far from where the others say it belongs.
//!
//! `mesh::prepare` judges the finished file more sharply; this only points at what to look at.

use glam::Vec3;

use super::names::opposite;
use crate::closest::Surface;
use crate::fit::align::Similarity;
use crate::fit::estimate::{Source, estimate};

/// A landmark may lie this far from where the others put it, mm of the reference head ...
const STRAY_MM: f32 = 16.0;
/// ... and farther by this share of the distance to the nearest other one.
const LEVER: f32 = 0.4;
/// Farther from the scan than this, mm of the reference head, a landmark counts as having missed it.
const MISSED_MM: f32 = 40.0;
/// By how much exchanged sides must bring the reference nearer to the scan, mm, to be believed.
const CLEARLY_MM: f32 = 2.0;
/// An exchange of one pair is believed if it leaves less than this share of the error ...
const EXPLAINED: f32 = 0.6;
/// ... and takes at least this away, mm.
const WORTH_MM: f32 = 3.0;

/// What looks wrong.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// Enough are set, but nearly on one line, which does not say how the head is turned about it.
    Line,
    /// Everything that has a side is on the other one.
    Swapped,
    /// The two of this pair (numbers of landmarks) stand in each other's places.
    Pair(usize, usize),
    /// This landmark is far from where the others say.
    Stray {
        /// Which.
        landmark: usize,
        /// How far, mm as long as the reference head's.
        mm: f32,
    },
}

impl Warning {
    /// As a sentence, with the landmarks' names.
    pub(super) fn words(&self, names: &[&str]) -> String {
        let name = |i: usize| names.get(i).copied().unwrap_or_default();
        match self {
            Self::Line => {
                "All that are set lie on one line: set one beside it, and the rest will be estimated.".to_owned()
            }
            Self::Swapped => "Left and right look swapped: _l is the subject's left, on the right of the picture in \
                              the front view."
                .to_owned(),
            Self::Pair(left, right) => format!("{} and {} look swapped.", name(*left), name(*right)),
            Self::Stray { landmark, mm } => format!(
                "{} lies {mm:.0} mm from where the others say it belongs.",
                name(*landmark)
            ),
        }
    }
}

/// All that looks wrong, the worst first. `names` and `sources` go entry by entry.
pub(super) fn find(names: &[&str], sources: &[Source], scan: &Surface) -> Vec<Warning> {
    let partner = |i: usize| -> Option<usize> {
        let other = opposite(names[i])?;
        names.iter().position(|n| *n == other)
    };
    let known = |sources: &[Source]| -> (Vec<Vec3>, Vec<Vec3>) {
        sources
            .iter()
            .filter_map(|s| Some((s.at, s.known?)))
            .unzip()
    };
    let (from, to) = known(sources);
    let Some(straight) = Similarity::between(&from, &to) else {
        return Vec::new();
    };
    let exchanged: Vec<Source> = (0..sources.len())
        .map(|i| Source {
            known: sources[partner(i).unwrap_or(i)].known,
            ..sources[i]
        })
        .collect();
    let (there, here) = known(&exchanged);
    if let Some(other) = Similarity::between(&there, &here) {
        let nearer = off_surface(sources, scan, &straight) - off_surface(sources, scan, &other);
        let errors = (rms(&straight, &from, &to), rms(&other, &there, &here));
        let plausible = errors.1 < errors.0 + CLEARLY_MM;
        if straight.mirrored || (plausible && nearer > CLEARLY_MM) {
            return vec![Warning::Swapped];
        }
    }
    let mut found = pairs(sources, &partner);
    if found.is_empty() {
        found = strays(sources, scan);
    }
    found
}

/// Root of the mean square of what a similarity leaves, mm of the reference head.
fn rms(similarity: &Similarity, from: &[Vec3], to: &[Vec3]) -> f32 {
    let sum: f32 = from
        .iter()
        .zip(to)
        .map(|(p, q)| similarity.point(*p).distance_squared(*q))
        .sum();
    (sum / from.len().max(1) as f32).sqrt() / similarity.scale
}

/// How far the reference's landmarks, moved onto the scan, lie from it on average, mm of the reference head.
fn off_surface(sources: &[Source], scan: &Surface, similarity: &Similarity) -> f32 {
    let far = MISSED_MM * similarity.scale;
    let off = |s: &Source| {
        let hit = scan.closest(similarity.point(s.at), far);
        hit.map_or(far, |hit| hit.distance)
    };
    sources.iter().map(off).sum::<f32>() / sources.len().max(1) as f32 / similarity.scale
}

/// Pairs whose exchange explains much of the error.
fn pairs(sources: &[Source], partner: &dyn Fn(usize) -> Option<usize>) -> Vec<Warning> {
    let mut sources = sources.to_vec();
    let mut found = Vec::new();
    let error = |sources: &[Source]| {
        let (from, to): (Vec<Vec3>, Vec<Vec3>) = sources
            .iter()
            .filter_map(|s| Some((s.at, s.known?)))
            .unzip();
        Similarity::between(&from, &to).map_or(f32::INFINITY, |s| rms(&s, &from, &to))
    };
    // Three points and a pair of two more: below that an exchange proves nothing.
    if sources.iter().filter(|s| s.known.is_some()).count() < 5 {
        return found;
    }
    for i in 0..sources.len() {
        let Some(j) = partner(i).filter(|j| *j > i) else {
            continue;
        };
        if sources[i].known.is_none() || sources[j].known.is_none() {
            continue;
        }
        let before = error(&sources);
        let exchange = |sources: &mut [Source]| {
            let known = sources[i].known;
            sources[i].known = sources[j].known;
            sources[j].known = known;
        };
        exchange(&mut sources);
        let after = error(&sources);
        if after < before * EXPLAINED && before - after > WORTH_MM {
            found.push(Warning::Pair(i, j));
        } else {
            exchange(&mut sources);
        }
    }
    found
}

/// Landmarks that the others, without them, would put elsewhere.
fn strays(sources: &[Source], scan: &Surface) -> Vec<Warning> {
    let set: Vec<usize> = (0..sources.len())
        .filter(|i| sources[*i].known.is_some())
        .collect();
    // The others must be enough for a warp of their own.
    if set.len() < 6 {
        return Vec::new();
    }
    let mut found = Vec::new();
    for &i in &set {
        let mut without = sources.to_vec();
        let Some(at) = without[i].known.take() else {
            continue;
        };
        let Ok(estimates) = estimate(&without, scan) else {
            continue;
        };
        let (from, to): (Vec<Vec3>, Vec<Vec3>) = without
            .iter()
            .filter_map(|s| Some((s.at, s.known?)))
            .unzip();
        let Some(similarity) = Similarity::between(&from, &to) else {
            continue;
        };
        let mm = estimates[i].at.distance(at) / similarity.scale;
        let nearest = from
            .iter()
            .map(|p| p.distance(sources[i].at))
            .fold(f32::INFINITY, f32::min);
        if mm > STRAY_MM + LEVER * nearest {
            found.push(Warning::Stray { landmark: i, mm });
        }
    }
    // One wrong point makes its neighbours look wrong too: the worst is the one to look at first.
    found.sort_by(|a, b| match (a, b) {
        (Warning::Stray { mm: a, .. }, Warning::Stray { mm: b, .. }) => b.total_cmp(a),
        _ => std::cmp::Ordering::Equal,
    });
    found.truncate(1);
    found
}
