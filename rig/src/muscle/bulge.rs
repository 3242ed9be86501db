//! Contracted muscles become thicker (HABER 5.1: bulging), and push out the skin that lies on them.
//!
//! A muscle keeps its volume and its width: its thickness goes with the inverse of its length. It lies on
//! bone or teeth, so that all of what it gains shows outside. Thicknesses are by anatomy (Gray's Anatomy,
//! "The muscles of the head"), in millimetres by judgement; the two muscles of the jaw, which keep their
//! length between bones, come out by what their painted grid says.

use glam::Vec3;

use super::grid::inwards;
use super::{Contraction, Fibre, length};
use crate::Muscle;

/// No muscle is drawn out thinner or swells thicker than this many times its thickness at rest.
const THINNEST: f32 = 0.75;
const THICKEST: f32 = 1.6;

impl Fibre {
    /// Thickness of its muscle at a control point at rest, mm: most in the belly. A sphincter is as thick
    /// everywhere but at ends.
    #[must_use]
    pub fn thickness_mm(&self, point: usize) -> f32 {
        let whole = length(&self.points).max(1e-3);
        let last = self.points.len().saturating_sub(1);
        let along = length(&self.points[..=point.min(last)]) / whole;
        belly_mm(self.muscle) * (THIN_END + (1.0 - THIN_END) * self.belly(along))
    }

    /// How many times as thick as at rest it is with its control points at `now`.
    #[must_use]
    pub fn thickened(&self, now: &[Vec3]) -> f32 {
        thickened(length(&self.points), length(now))
    }

    /// How far skin on a control point is pushed out when the muscle becomes twice as thick, mm.
    pub(super) fn swelling(&self, point: usize) -> Vec3 {
        if matches!(self.contraction, Contraction::Belly { .. }) {
            return Vec3::ZERO;
        }
        let whole = length(&self.points).max(1e-3);
        let along = length(&self.points[..=point]) / whole;
        -inwards(self.points[point]) * (belly_mm(self.muscle) * self.belly(along))
    }

    /// The share of the belly's thickness at a share of the length.
    fn belly(&self, along: f32) -> f32 {
        let bell = (std::f32::consts::PI * along).sin().max(0.0);
        match self.contraction {
            Contraction::Sphincter { .. } => {
                let ends = self.points.first().zip(self.points.last());
                let closed = ends.is_some_and(|(a, b)| a.distance(*b) < 1.0);
                if closed { 1.0 } else { bell.sqrt() }
            }
            _ => bell,
        }
    }
}

/// Share of the belly's thickness that is left at the ends.
const THIN_END: f32 = 0.45;

/// Thickness against rest, for a length at rest and now.
pub(super) fn thickened(rest_mm: f32, now_mm: f32) -> f32 {
    (rest_mm / now_mm.max(1e-3)).clamp(THINNEST, THICKEST)
}

/// Thickness of the belly at rest, mm.
const fn belly_mm(muscle: Muscle) -> f32 {
    use Muscle::{
        Buccinator, CorrugatorSupercilii, DepressorAnguliOris, DepressorLabiiInferioris,
        DepressorSeptiNasi, DepressorSupercilii, DilatorNaris, FrontalisInner, FrontalisOuter,
        LevatorAnguliOris, LevatorLabiiSuperioris, LevatorLabiiSuperiorisAlaequeNasi, Masseter,
        Mentalis, Nasalis, OrbicularisOculiOrbital, OrbicularisOculiPalpebral,
        OrbicularisOrisInferior, OrbicularisOrisSuperior, Platysma, Procerus, Risorius, Temporalis,
        ZygomaticusMajor, ZygomaticusMinor,
    };
    match muscle {
        Masseter => 9.0,
        Temporalis | Mentalis => 5.0,
        ZygomaticusMajor => 4.6,
        OrbicularisOrisSuperior | OrbicularisOrisInferior | CorrugatorSupercilii => 4.0,
        LevatorAnguliOris | Buccinator => 3.4,
        DepressorAnguliOris => 3.2,
        LevatorLabiiSuperioris | ZygomaticusMinor => 3.0,
        DepressorLabiiInferioris => 2.8,
        LevatorLabiiSuperiorisAlaequeNasi | OrbicularisOculiOrbital | Procerus => 2.4,
        Risorius | FrontalisInner | FrontalisOuter | DepressorSupercilii | DepressorSeptiNasi => {
            2.2
        }
        Nasalis | DilatorNaris => 1.8,
        Platysma => 1.7,
        OrbicularisOculiPalpebral => 1.2,
    }
}
