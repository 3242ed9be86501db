//! The rows of `articulation.toml`: what a mouth does for each phone, said alone.
//!
//! A row may leave articulators out: Beskow's underspecification (1995), so that /k/ leaves the lips
//! to its neighbours. What is left out gets no dominance.

use mouthpiece_phonemes::Phone;
use mouthpiece_rig::Articulation;
use serde::Deserialize;

use super::dominance::{Contact, DominanceTable};
use super::{TableError, figure, in_range, sourced};

/// Targets of one phone.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArticulationRow {
    /// The class of the dominance table that it follows.
    pub class: String,
    /// Lips; none: as the neighbours want.
    pub lips: Option<Lips>,
    /// Jaw rotation, radians.
    pub jaw_rad: Option<f32>,
    /// Tongue.
    #[serde(default)]
    pub tongue: Tongue,
    /// The second posture of a diphthong.
    pub glide: Option<Glide>,
    /// Where the figures come from.
    pub source: String,
}

/// Lip targets, as in [`Articulation`].
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "as in rig's Articulation")]
pub struct Lips {
    pub aperture_mm: f32,
    pub width: f32,
    pub protrusion_mm: f32,
    pub lip_teeth_mm: Option<f32>,
}

/// Tongue targets, as in [`mouthpiece_rig::Tongue`], each optional.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "as in rig's Tongue")]
pub struct Tongue {
    pub tip: Option<f32>,
    pub out: Option<f32>,
    pub body: Option<f32>,
}

/// Where a diphthong moves to.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Glide {
    /// The last part of the segment that belongs to it.
    pub share: f32,
    /// Lips.
    pub lips: Option<Lips>,
    /// Jaw rotation, radians.
    pub jaw_rad: Option<f32>,
    /// Tongue.
    #[serde(default)]
    pub tongue: Tongue,
}

impl ArticulationRow {
    pub(super) fn check(
        &self,
        file: &str,
        phone: Phone,
        dominance: &DominanceTable,
    ) -> Result<(), TableError> {
        let row = phone.code();
        let Some(class) = dominance.class.get(&self.class) else {
            return Err(TableError::UnknownClass {
                file: file.to_owned(),
                row: row.to_owned(),
                class: self.class.clone(),
            });
        };
        sourced(file, row, &self.source)?;
        check_posture(file, row, self.lips.as_ref(), self.jaw_rad, &self.tongue)?;
        if let Some(glide) = &self.glide {
            let row = format!("{row}.glide");
            in_range(file, &row, &[figure("share", glide.share, 0.05, 0.95)])?;
            check_posture(
                file,
                &row,
                glide.lips.as_ref(),
                glide.jaw_rad,
                &glide.tongue,
            )?;
        }
        let missing = match class.contact {
            Some(Contact::Lips) if self.lips.is_none_or(|l| l.aperture_mm > 0.0) => {
                Some(("other lip", "give lips with aperture_mm at or below 0"))
            }
            Some(Contact::Teeth) if self.lips.is_none_or(|l| l.lip_teeth_mm.is_none()) => {
                Some(("upper teeth", "give lips with lip_teeth_mm"))
            }
            _ => None,
        };
        match missing {
            None => Ok(()),
            Some((contact, mend)) => Err(TableError::NoContact {
                file: file.to_owned(),
                row: row.to_owned(),
                contact,
                mend,
            }),
        }
    }
}

/// A whole posture for the head's calibration. What is left out stands at rest there, and the
/// controls that follow from it are not used.
pub(crate) fn posture(lips: Option<&Lips>, jaw_rad: Option<f32>, tongue: &Tongue) -> Articulation {
    let mut posture = Articulation::REST;
    if let Some(lips) = lips {
        posture.aperture_mm = lips.aperture_mm;
        posture.width = lips.width;
        posture.protrusion_mm = lips.protrusion_mm;
        posture.lip_teeth_mm = lips.lip_teeth_mm;
    }
    posture.jaw_rad = jaw_rad.unwrap_or(posture.jaw_rad);
    posture.tongue.tip = tongue.tip.unwrap_or(posture.tongue.tip);
    posture.tongue.out = tongue.out.unwrap_or(posture.tongue.out);
    posture.tongue.body = tongue.body.unwrap_or(posture.tongue.body);
    posture
}

fn check_posture(
    file: &str,
    row: &str,
    lips: Option<&Lips>,
    jaw_rad: Option<f32>,
    tongue: &Tongue,
) -> Result<(), TableError> {
    if lips.is_some() && jaw_rad.is_none() {
        return Err(TableError::LipsWithoutJaw {
            file: file.to_owned(),
            row: row.to_owned(),
        });
    }
    let all = posture(lips, jaw_rad, tongue);
    in_range(
        file,
        row,
        &[
            figure("aperture_mm", all.aperture_mm, -10.0, 40.0),
            figure("width", all.width, 0.4, 1.6),
            figure("protrusion_mm", all.protrusion_mm, -5.0, 12.0),
            figure("lip_teeth_mm", all.lip_teeth_mm.unwrap_or(0.0), -3.0, 30.0),
            figure("jaw_rad", all.jaw_rad, 0.0, 0.45),
            figure("tongue.tip", all.tongue.tip, 0.0, 1.0),
            figure("tongue.out", all.tongue.out, -1.0, 1.0),
            figure("tongue.body", all.tongue.body, 0.0, 1.0),
        ],
    )
}
