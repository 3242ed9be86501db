//! The rows of `dominance.toml`: how strongly and how long each class of phones holds its targets,
//! which controls are driven, and how contact is made.

use std::collections::BTreeMap;

use mouthpiece_rig::Control;
use serde::Deserialize;

use super::{TableError, figure, in_range, sourced};

/// Controls that share one dominance function. Opening and rounding of the lips are apart, because
/// /s/ and /t/ govern the one and leave the other (Cohen and Massaro's alpha of 0.06).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Group {
    Lips,
    Rounding,
    Jaw,
    Tongue,
}

impl Group {
    /// How many there are.
    pub const COUNT: usize = 4;
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; Self::COUNT] = [Self::Lips, Self::Rounding, Self::Jaw, Self::Tongue];
}

/// The whole of `dominance.toml`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DominanceTable {
    /// How much later than its muscles the skin is, ms.
    pub tissue_lag_ms: f32,
    /// How far a segment is felt, ms.
    pub support_ms: f32,
    /// Weight of rest, always there.
    pub rest_weight: f32,
    /// Longest hole between two labels that is no pause, ms.
    pub gap_ms: f32,
    /// What is driven.
    pub controls: Driven,
    /// How contact is made.
    pub contact: ContactTimes,
    /// How stress and loudness open the mouth.
    pub opening: Opening,
    /// Dominance per class.
    pub class: BTreeMap<String, ClassRow>,
}

/// Names of driven controls, by group.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "one field per Group")]
pub struct Driven {
    pub lips: Vec<String>,
    pub rounding: Vec<String>,
    pub jaw: Vec<String>,
    pub tongue: Vec<String>,
}

/// What a class touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Contact {
    /// Lip to lip.
    Lips,
    /// Lower lip to upper teeth.
    Teeth,
}

/// Times and shape of contact.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactTimes {
    /// How long the lips go over to the contact target, ms.
    pub approach_ms: f32,
    /// How long they come back, ms.
    pub release_ms: f32,
    /// How far inside the labelled hold they are fully there, ms from either end.
    pub inset_ms: f32,
    /// For how long they are at least, ms.
    pub core_ms_min: f32,
    /// And at most, in a hold that is not a long one, ms.
    pub core_ms_max: f32,
    /// From this length on a hold is a long one, ms.
    pub long_ms: f32,
    /// The jaw's approach, ms.
    pub jaw_approach_ms: f32,
    /// The jaw's release, ms.
    pub jaw_release_ms: f32,
    /// The part of a release without a closure of its own that is held.
    pub hold_share: f32,
    /// Protrusion of a closure between rounded phones, mm.
    pub rounded_mm: f32,
    /// Its width, as a share of rest.
    pub rounded_width: f32,
    /// Where the figures come from.
    pub source: String,
}

/// How far jaw and lips open in a vowel, as shares of what the tables say.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Opening {
    /// In a syllable with primary stress.
    pub primary: f32,
    /// With secondary stress.
    pub secondary: f32,
    /// With none. Labels that do not say are 1.
    pub unstressed: f32,
    /// What a deviation of loudness from the voice's mean adds or takes.
    pub loudness: f32,
    /// Where the figures come from.
    pub source: String,
}

/// Dominance of one class.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "one field per Group")]
pub struct ClassRow {
    /// A segment longer than twice this has no centre but a middle part, this far from its ends,
    /// over which its dominance stays at alpha, ms. Cohen and Massaro's centre alone would leave the
    /// ends of a long pause to what was said before it.
    pub edge_ms: f32,
    /// What the class touches.
    pub contact: Option<Contact>,
    pub lips: Dominance,
    pub rounding: Dominance,
    pub jaw: Dominance,
    pub tongue: Dominance,
    /// Where the figures come from.
    pub source: String,
}

/// D = alpha * exp(-theta * |tau|^c).
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dominance {
    /// Height.
    pub alpha: f32,
    /// Fall before the centre, per ms^c.
    pub theta_before: f32,
    /// Fall behind it.
    pub theta_after: f32,
    /// Exponent.
    pub c: f32,
    /// Where the peak is, relative to the segment's centre, ms.
    pub offset_ms: f32,
}

impl DominanceTable {
    /// Controls that are driven, with the group they follow.
    pub(crate) fn driven(&self) -> impl Iterator<Item = (&str, Group)> {
        let lists = &self.controls;
        [&lists.lips, &lists.rounding, &lists.jaw, &lists.tongue]
            .into_iter()
            .zip(Group::ALL)
            .flat_map(|(list, group)| list.iter().map(move |name| (name.as_str(), group)))
    }

    pub(super) fn check(&self, file: &str) -> Result<(), TableError> {
        let top = [
            figure("tissue_lag_ms", self.tissue_lag_ms, 0.0, 200.0),
            figure("support_ms", self.support_ms, 100.0, 3000.0),
            figure("rest_weight", self.rest_weight, 1e-6, 0.1),
            figure("gap_ms", self.gap_ms, 0.0, 1000.0),
        ];
        in_range(file, "(top)", &top)?;
        let contact = &self.contact;
        let times = [
            figure("approach_ms", contact.approach_ms, 5.0, 300.0),
            figure("release_ms", contact.release_ms, 5.0, 300.0),
            figure("inset_ms", contact.inset_ms, 0.0, 50.0),
            figure("core_ms_min", contact.core_ms_min, 1.0, 60.0),
            figure(
                "core_ms_max",
                contact.core_ms_max,
                contact.core_ms_min,
                500.0,
            ),
            figure("long_ms", contact.long_ms, 50.0, 1000.0),
            figure("jaw_approach_ms", contact.jaw_approach_ms, 5.0, 300.0),
            figure("jaw_release_ms", contact.jaw_release_ms, 5.0, 300.0),
            figure("hold_share", contact.hold_share, 0.1, 0.9),
            figure("rounded_mm", contact.rounded_mm, 0.0, 12.0),
            figure("rounded_width", contact.rounded_width, 0.4, 1.6),
        ];
        in_range(file, "contact", &times)?;
        sourced(file, "contact", &contact.source)?;
        let opening = &self.opening;
        let shares = [
            figure("primary", opening.primary, 0.5, 1.5),
            figure("secondary", opening.secondary, 0.5, 1.5),
            figure("unstressed", opening.unstressed, 0.5, 1.5),
            figure("loudness", opening.loudness, 0.0, 0.5),
        ];
        in_range(file, "opening", &shares)?;
        sourced(file, "opening", &opening.source)?;
        let mut seen = Vec::new();
        for (name, _) in self.driven() {
            let (file, name) = (file.to_owned(), name.to_owned());
            if Control::from_name(&name).is_none() {
                return Err(TableError::UnknownControl { file, name });
            }
            if seen.contains(&name) {
                return Err(TableError::ControlTwice { file, name });
            }
            seen.push(name);
        }
        for (name, class) in &self.class {
            class.check(file, &format!("class.{name}"))?;
        }
        Ok(())
    }
}

impl ClassRow {
    /// Dominance by [`Group`].
    #[must_use]
    pub const fn groups(&self) -> [Dominance; Group::COUNT] {
        [self.lips, self.rounding, self.jaw, self.tongue]
    }

    fn check(&self, file: &str, row: &str) -> Result<(), TableError> {
        sourced(file, row, &self.source)?;
        in_range(file, row, &[figure("edge_ms", self.edge_ms, 1.0, 500.0)])?;
        let names = ["lips", "rounding", "jaw", "tongue"];
        for (d, name) in self.groups().iter().zip(names) {
            let figures = [
                figure("alpha", d.alpha, 0.0, 50.0),
                figure("theta_before", d.theta_before, 0.0005, 1.0),
                figure("theta_after", d.theta_after, 0.0005, 1.0),
                figure("c", d.c, 0.5, 2.5),
                figure("offset_ms", d.offset_ms, -150.0, 150.0),
            ];
            in_range(file, &format!("{row}.{name}"), &figures)?;
        }
        Ok(())
    }
}
