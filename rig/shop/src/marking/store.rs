//! Landmark files in and out of a marking, with units: a file says what its numbers are in, a scan does not.

use glam::Vec3;

use super::Marking;
use crate::landmarks::{LandmarkFault, Landmarks, Unit};

/// Landmarks lie on the scan if the middle one of their distances is below this share of the scan.
const NEAR: f32 = 0.03;

/// Size of a scanned head, mm across its box: with neck and a little of the shoulders.
const HEAD_MM: f64 = 380.0;

impl Marking {
    /// What lengths of the scan are in: what was said, else what makes a head of it.
    #[must_use]
    pub fn unit(&self) -> Unit {
        if let Some(unit) = self.unit {
            return unit;
        }
        let mm_per_unit = match &self.similarity {
            Some(similarity) => 1.0 / f64::from(similarity.scale),
            None => HEAD_MM / f64::from(self.size()),
        };
        let off = |unit: &Unit| (unit.mm() / mm_per_unit).ln().abs();
        Unit::ALL
            .into_iter()
            .min_by(|a, b| off(a).total_cmp(&off(b)))
            .unwrap_or_default()
    }

    /// What was set by hand. Estimates are left to the fit, which knows more.
    #[must_use]
    pub fn landmarks(&self) -> Landmarks {
        let points = self
            .reference
            .iter()
            .zip(&self.set)
            .filter_map(|(r, at)| Some((r.name.clone(), (*at)?.as_dvec3())))
            .collect();
        Landmarks {
            unit: self.unit(),
            points,
        }
    }

    /// Sets what a file says, as one deed, and counts that as saved.
    ///
    /// # Errors
    /// When a name is unknown, a coordinate not finite, or the points lie off this scan.
    pub fn load(&mut self, file: &Landmarks) -> Result<(), LandmarkFault> {
        file.check(self.reference.iter().map(|r| r.name.as_str()))?;
        let factor = self.factor(file)?;
        let mut set = vec![None; self.count()];
        for (name, at) in &file.points {
            if let Some(landmark) = self.find(name) {
                set[landmark] = Some((*at * factor).as_vec3());
            }
        }
        self.remember();
        self.set = set;
        self.drag = None;
        self.renew();
        self.mark_saved();
        if self.state(self.selected) == super::State::Set {
            self.next_unset();
        }
        Ok(())
    }

    /// Whether anything differs from what was saved last.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.set != self.saved
    }

    /// After saving.
    pub fn mark_saved(&mut self) {
        self.saved.clone_from(&self.set);
    }

    /// From the file's numbers to the scan's: as they are, or in another unit if that brings them onto the scan.
    fn factor(&self, file: &Landmarks) -> Result<f64, LandmarkFault> {
        let units = self.unit.map_or(Unit::ALL.to_vec(), |unit| vec![unit]);
        let others = units.iter().map(|unit| file.unit.mm() / unit.mm());
        let factors: Vec<f64> = std::iter::once(1.0).chain(others).collect();
        for &factor in &factors {
            let mut off: Vec<f32> = file
                .points
                .values()
                .map(|at| self.off_scan((*at * factor).as_vec3()))
                .collect();
            off.sort_by(f32::total_cmp);
            let middle = off.get(off.len() / 2);
            if middle.is_none_or(|middle| *middle < NEAR * self.size()) {
                return Ok(factor);
            }
        }
        let worst = file
            .points
            .iter()
            .map(|(name, at)| (name, self.off_scan(at.as_vec3())))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        match worst {
            Some((name, off)) => Err(LandmarkFault::AllOutside {
                name: name.clone(),
                distance: f64::from(off) * file.unit.mm(),
                unit: file.unit,
            }),
            None => Ok(1.0),
        }
    }

    fn off_scan(&self, at: Vec3) -> f32 {
        let hit = self.scan.closest(at, f32::INFINITY);
        hit.map_or(f32::INFINITY, |hit| hit.distance)
    }

    /// Of the box round the scan.
    fn size(&self) -> f32 {
        let (low, high) = self
            .scan
            .positions()
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| {
                (low.min(*p), high.max(*p))
            });
        (high - low).length()
    }
}
