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
/// A mirrored fit that is worse than twice this, mm, and twice the straight one is out of the question.
const SURE: f64 = 4.0;
/// The two of a pair stand on each other's places if they are farther than this from their own, mm,
/// and the squares of their distances from the other's have less than this share.
const CROSSED: f64 = 8.0;
const CROSSED_SHARE: f64 = 0.2;
/// Up to this number of pairs all choices of exchanges are tried.
const FEW_PAIRS: usize = 6;
/// Two landmarks nearer than this are on one spot if they are farther than `APART` on the reference, mm.
const SPOT: f64 = 0.5;
const APART: f64 = 4.0;
/// A landmark may lie this far from where the others put it, mm, and farther by `LEVER` of how far it
/// lies outside them.
const STRAY: f64 = 30.0;
const LEVER: f64 = 0.3;
/// More landmarks than this are no chance.
const ENOUGH: usize = 10;
/// From this number on the rest of the landmarks is a measure by itself.
const MANY: usize = 20;
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

/// What landmarks say of their hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Straight,
    Mirrored,
    /// The mirror image, but few landmarks say so.
    Likely,
    /// Both fit about as well: few landmarks, or all nearly in one plane.
    Open,
}

fn error(from: &[DVec3], to: &[DVec3]) -> f64 {
    Similarity::fit(from, to).rms(from, to)
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

    /// Which hand the landmarks alone speak for.
    pub(crate) fn hand(&self, ratio: f64) -> Verdict {
        let (straight, turned) = (self.error(), self.mirrored_error());
        if straight > ORDINARY * ratio && turned < EXPLAINED * straight {
            // Few landmarks may speak for a mirror by chance.
            if self.points.len() > ENOUGH {
                Verdict::Mirrored
            } else {
                Verdict::Likely
            }
        } else if turned * EXPLAINED < straight.max(SURE * ratio) {
            Verdict::Open
        } else {
            Verdict::Straight
        }
    }

    /// Which of `sides` explain the landmarks if they are exchanged; or all others, where landmarks are
    /// nearly in one plane. Of few pairs all choices are tried; among many, a pair gives itself away by
    /// lying nearer to each other's places than to its own, or by what its exchange does to the error.
    pub(crate) fn crossed(&self, sides: &[(usize, usize)], ratio: f64) -> Vec<bool> {
        if sides.len() <= FEW_PAIRS {
            let choice = self.best_choice(sides, ratio);
            if choice.contains(&true) {
                return choice;
            }
        }
        let mut points = self.points.clone();
        let mut crossed = vec![false; sides.len()];
        while let Some(k) = self.most_crossed(&points, sides, &crossed, ratio) {
            points.swap(sides[k].0, sides[k].1);
            crossed[k] = true;
        }
        let before = error(&self.reference, &points);
        let mut left = before;
        let mut tried = crossed.clone();
        while left > ORDINARY * ratio {
            let mut best = None;
            for (k, &(i, j)) in sides.iter().enumerate().filter(|(k, _)| !tried[*k]) {
                points.swap(i, j);
                let then = error(&self.reference, &points);
                points.swap(i, j);
                if then < best.map_or(left, |(_, least)| least) {
                    best = Some((k, then));
                }
            }
            let Some((k, then)) = best else { break };
            points.swap(sides[k].0, sides[k].1);
            (tried[k], left) = (true, then);
        }
        if left < EXPLAINED * before {
            tried
        } else {
            crossed
        }
    }

    /// What the best similarity leaves, mm.
    pub(crate) fn error(&self) -> f64 {
        error(&self.reference, &self.points)
    }

    /// What it leaves of the mirrored reference.
    pub(crate) fn mirrored_error(&self) -> f64 {
        error(&self.mirrored(), &self.points)
    }

    /// Of all choices of `sides` the one that leaves the least error, if it leaves much less than none.
    fn best_choice(&self, sides: &[(usize, usize)], ratio: f64) -> Vec<bool> {
        let none = vec![false; sides.len()];
        let before = self.error();
        if before < ORDINARY * ratio {
            return none;
        }
        let mut best = (none, EXPLAINED * before);
        for choice in 1u32..1 << sides.len() {
            let which: Vec<bool> = (0..sides.len()).map(|k| choice >> k & 1 == 1).collect();
            let left = self.exchanged(sides, &which).error();
            if left < best.1 {
                best = (which, left);
            }
        }
        best.0
    }

    /// Which pair of those not yet `crossed` lies most clearly nearer to each other's places than to its own.
    fn most_crossed(
        &self,
        points: &[DVec3],
        sides: &[(usize, usize)],
        crossed: &[bool],
        ratio: f64,
    ) -> Option<usize> {
        let fit = Similarity::fit(&self.reference, points);
        let gain = |&(i, j): &(usize, usize)| {
            let [a, b] = [i, j].map(|k| fit.apply(self.reference[k]));
            let own = a.distance_squared(points[i]) + b.distance_squared(points[j]);
            let other = a.distance_squared(points[j]) + b.distance_squared(points[i]);
            let clear = own > 2.0 * (CROSSED * ratio).powi(2) && other < CROSSED_SHARE * own;
            clear.then_some(own - other)
        };
        let open = sides.iter().enumerate().filter(|(k, _)| !crossed[*k]);
        let gains = open.filter_map(|(k, pair)| Some((k, gain(pair)?)));
        gains.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
    }

    /// The landmarks with some pairs exchanged.
    pub(crate) fn exchanged(&self, sides: &[(usize, usize)], which: &[bool]) -> Self {
        let mut points = self.points.clone();
        for (&(i, j), _) in sides.iter().zip(which).filter(|(_, which)| **which) {
            points.swap(i, j);
        }
        Self {
            names: self.names.clone(),
            reference: self.reference.clone(),
            points,
        }
    }

    /// The fault of these pairs' being exchanged.
    pub(crate) fn fault(&self, sides: &[(usize, usize)], which: &[bool]) -> LandmarkFault {
        let named = sides.iter().zip(which).filter(|(_, which)| **which);
        let named = named.map(|(&(i, j), _)| format!("{} and {}", self.names[i], self.names[j]));
        LandmarkFault::SwappedPairs(named.collect::<Vec<_>>().join(", "))
    }

    /// Places of the landmarks that come as `_l` and `_r`.
    pub(crate) fn sides(&self) -> Vec<(usize, usize)> {
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
            // Few landmarks fit anything but one: then it must explain nearly all.
            let explains = rest < EXPLAINED * error || count > MANY;
            if stray && explains && found.is_none_or(|f| rest < f.1) {
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
