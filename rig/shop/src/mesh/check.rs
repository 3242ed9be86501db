//! Whether landmarks lie as on a face: left and right, single ones that stand where they cannot, lines
//! and spots. All of it compares with the reference head's landmarks under the best similarity.

use glam::{DVec3, dvec3};

use super::similarity::{Similarity, widths};
use crate::landmarks::LandmarkFault;

/// Landmarks of a scan beside those of the reference, mm.
pub(crate) struct Pairs<'a> {
    pub(crate) names: Vec<&'a str>,
    pub(crate) reference: Vec<DVec3>,
    pub(crate) points: Vec<DVec3>,
}

/// Below this ratio of their second width to their first, points lie on a line.
const LINE: f64 = 0.04;
/// Heads differ by some millimetres at each landmark; what is below this is no evidence, mm.
const ORDINARY: f64 = 6.0;
/// A mirror image, or an exchange, explains the landmarks if it leaves this share of the error.
const EXPLAINED: f64 = 0.5;
/// Two landmarks nearer than this are on one spot if they are farther than `APART` on the reference, mm.
const SPOT: f64 = 0.5;
const APART: f64 = 4.0;
/// A landmark may lie this far from where the others put it, mm, and farther by `LEVER` of how far it
/// lies outside them.
const STRAY: f64 = 25.0;
const LEVER: f64 = 0.3;
/// Error as a share of the landmarks' width from which they are no face's.
const NO_FACE: f64 = 0.4;

pub(crate) fn mirror(p: DVec3) -> DVec3 {
    p * dvec3(-1.0, 1.0, 1.0)
}

/// Whether points lie on one line, and say nothing of how a head is turned about it.
pub(crate) fn on_a_line(points: &[DVec3]) -> bool {
    let [first, second, _] = widths(points);
    second < LINE * first
}

/// Pairs of landmarks whose sides were exchanged, and the error that is left once they are put right.
pub(crate) struct Exchanged {
    names: Vec<String>,
    left: f64,
}

impl Pairs<'_> {
    pub(crate) fn fit(&self) -> Similarity {
        Similarity::fit(&self.reference, &self.points)
    }

    /// From the mirrored reference.
    pub(crate) fn fit_mirrored(&self) -> Similarity {
        Similarity::fit(&self.mirrored(), &self.points)
    }

    fn mirrored(&self) -> Vec<DVec3> {
        self.reference.iter().map(|&p| mirror(p)).collect()
    }

    pub(crate) fn apart(&self, ratio: f64) -> Result<(), LandmarkFault> {
        for i in 0..self.points.len() {
            for j in 0..i {
                let here = self.points[i].distance(self.points[j]);
                if here < SPOT && self.reference[i].distance(self.reference[j]) * ratio > APART {
                    return Err(LandmarkFault::SameSpot {
                        first: self.names[j].to_owned(),
                        second: self.names[i].to_owned(),
                    });
                }
            }
        }
        Ok(())
    }

    /// Whether the mirrored reference explains the landmarks, the reference itself does not, and the
    /// exchange of some pairs does not do better.
    pub(crate) fn is_mirrored(&self, ratio: f64, exchanged: Option<&Exchanged>) -> bool {
        let straight = self.fit().rms(&self.reference, &self.points);
        let mirrored = self.mirrored();
        let turned = Similarity::fit(&mirrored, &self.points).rms(&mirrored, &self.points);
        straight > ORDINARY * ratio
            && turned < EXPLAINED * straight
            && exchanged.is_none_or(|e| turned < 1.05 * e.left + 0.1 * ratio)
    }

    /// Pairs whose exchange explains the landmarks: those that help most, one by one.
    pub(crate) fn exchanged(&self, ratio: f64) -> Option<Exchanged> {
        let mut points = self.points.clone();
        let error = |points: &[DVec3]| {
            Similarity::fit(&self.reference, points).rms(&self.reference, points)
        };
        let before = error(&points);
        let mut left = before;
        let mut pairs = self.sides();
        let mut names = Vec::new();
        while left > ORDINARY * ratio && !pairs.is_empty() {
            let mut best = (0, left);
            for (k, &(i, j)) in pairs.iter().enumerate() {
                points.swap(i, j);
                let then = error(&points);
                points.swap(i, j);
                if then < best.1 {
                    best = (k, then);
                }
            }
            if best.1 >= left {
                break;
            }
            let (i, j) = pairs.swap_remove(best.0);
            points.swap(i, j);
            left = best.1;
            names.push(format!("{} and {}", self.names[i], self.names[j]));
        }
        (!names.is_empty() && left < EXPLAINED * before).then_some(Exchanged { names, left })
    }

    /// Places of the landmarks that come as `_l` and `_r`.
    fn sides(&self) -> Vec<(usize, usize)> {
        let place = |name: String| self.names.iter().position(|&n| n == name);
        let pair = |(i, name): (usize, &&str)| {
            let base = name.strip_suffix("_l")?;
            Some((i, place(format!("{base}_r"))?))
        };
        self.names.iter().enumerate().filter_map(pair).collect()
    }

    /// Whether no single landmark lies where the others cannot have it.
    pub(crate) fn none_astray(&self, ratio: f64) -> Result<(), LandmarkFault> {
        let count = self.points.len();
        let all = self.fit();
        let error = all.rms(&self.reference, &self.points);
        let off =
            |fit: &Similarity, i: usize| fit.apply(self.reference[i]).distance(self.points[i]);
        let worst = (0..count)
            .max_by(|&i, &j| off(&all, i).total_cmp(&off(&all, j)))
            .unwrap_or(0);
        let mut found: Option<(usize, f64, f64)> = None;
        // Four leave three, which say nothing of the fourth.
        for i in (0..count).filter(|_| count > 4) {
            let without = |points: &[DVec3]| {
                let mut rest = points.to_vec();
                rest.remove(i);
                rest
            };
            let (from, to) = (without(&self.reference), without(&self.points));
            let [first, second, _] = widths(&from);
            if second < 2.0 * LINE * first {
                continue;
            }
            let fit = Similarity::fit(&from, &to);
            let rest = fit.rms(&from, &to);
            let middle = super::similarity::mean(&from);
            let outside = (self.reference[i].distance(middle) - 1.5 * first).max(0.0);
            let distance = off(&fit, i);
            let stray = distance > (STRAY + LEVER * outside) * ratio && distance > 4.0 * rest;
            if stray && rest < EXPLAINED * error && found.is_none_or(|f| rest < f.1) {
                found = Some((i, rest, distance));
            }
        }
        if let Some((i, _, distance)) = found {
            return Err(LandmarkFault::Disagrees {
                name: self.names[i].to_owned(),
                distance,
            });
        }
        if error > NO_FACE * widths(&self.points)[0].max(ORDINARY) {
            return Err(LandmarkFault::NoFace {
                name: self.names[worst].to_owned(),
                distance: off(&all, worst),
            });
        }
        Ok(())
    }
}

impl Exchanged {
    pub(crate) fn fault(&self) -> LandmarkFault {
        LandmarkFault::SwappedPairs(self.names.join(", "))
    }
}
