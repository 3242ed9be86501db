//! The tables in terms of one head's muscles: each phone's posture goes through the head's
//! calibration once, here; after that only controls are blended (HABER 5.2 blends muscle targets).

use std::collections::BTreeMap;
use std::sync::Arc;

use mouthpiece_phonemes::{Phone, Segment};
use mouthpiece_rig::{Articulation, Calibration, Control, Controls};
use thiserror::Error;

use crate::blend::{Curve, ticks};
use crate::contact::{ContactTargets, Windows};
use crate::tables::{
    self, ArticulationRow, Contact, DominanceTable, Group, Lips, TableError, Tables, Tongue,
};
use crate::track::Track;

/// Why there is no speech for a head.
#[derive(Debug, Error)]
pub enum SpeechError {
    /// A table was refused.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The head's calibration gave no number.
    #[error(
        "the head's calibration gives {value} for {control} at the phone `{phone}`; calibrate the head again"
    )]
    NotFinite {
        /// The phone whose posture it was.
        phone: Phone,
        /// The control.
        control: &'static str,
        /// What came out.
        value: f32,
    },
}

/// How one head speaks. Cheap to clone; tracks share its tables.
#[derive(Clone, Debug)]
pub struct Speech {
    voice: Arc<Voice>,
}

impl Speech {
    /// The built-in tables for a calibrated head.
    ///
    /// # Errors
    /// When the calibration gives something that is not a number.
    pub fn new(calibration: &Calibration) -> Result<Self, SpeechError> {
        Self::with(|articulation| calibration.controls(articulation))
    }

    /// The built-in tables for whatever turns an articulation into controls.
    ///
    /// # Errors
    /// When `controls` gives something that is not a number.
    pub fn with(controls: impl Fn(&Articulation) -> Controls) -> Result<Self, SpeechError> {
        Self::from_tables(&Tables::built_in()?, controls)
    }

    /// Other tables, for whatever turns an articulation into controls.
    ///
    /// # Errors
    /// When `controls` gives something that is not a number.
    pub fn from_tables(
        tables: &Tables,
        controls: impl Fn(&Articulation) -> Controls,
    ) -> Result<Self, SpeechError> {
        let voice = Arc::new(Voice::new(tables, controls)?);
        Ok(Self { voice })
    }

    /// A track that says `segments`; more may be pushed on it. With none, a track at rest.
    #[must_use]
    pub fn track(&self, segments: &[Segment]) -> Track {
        let mut track = Track::new(self);
        for &segment in segments {
            track.push(segment);
        }
        track
    }

    pub(crate) fn voice(&self) -> Arc<Voice> {
        Arc::clone(&self.voice)
    }
}

/// A posture as controls.
#[derive(Clone, Debug)]
pub(crate) struct Posture {
    pub(crate) targets: Controls,
    /// Index into [`Voice::curves`].
    pub(crate) class: usize,
    /// Which groups it says anything about.
    pub(crate) governs: [bool; Group::COUNT],
    /// Controls of the groups that it governs but leaves open all the same.
    open: [bool; Control::COUNT],
    pub(crate) contact: Option<ContactTargets>,
    pub(crate) kind: Option<Contact>,
}

impl Posture {
    /// Whether it has a target for `control`, given that it governs its group.
    pub(crate) const fn has(&self, control: Control) -> bool {
        !self.open[control as usize]
    }
}

/// What a phone is made of: indices into [`Voice::postures`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sound {
    pub(crate) posture: u16,
    /// The last `.0` of the segment has posture `.1`.
    pub(crate) glide: Option<(f32, u16)>,
}

/// Everything that a track needs to know, in ticks and controls.
#[derive(Debug)]
pub(crate) struct Voice {
    /// By [`Phone::index`].
    pub(crate) sounds: Vec<Sound>,
    pub(crate) postures: Vec<Posture>,
    /// By class and group.
    pub(crate) curves: Vec<[Curve; Group::COUNT]>,
    /// By class.
    pub(crate) edges: Vec<i64>,
    /// By group.
    pub(crate) driven: [Vec<Control>; Group::COUNT],
    pub(crate) windows: Windows,
    /// What everything goes back to: the posture of `h#`.
    pub(crate) rest: Controls,
    pub(crate) rest_weight: f32,
    pub(crate) support: i64,
    /// The furthest that any peak is from the middle of its segment.
    pub(crate) shift_max: i64,
    pub(crate) lag: i64,
    pub(crate) gap: i64,
    pub(crate) hold_share: f32,
    /// Opening with primary, secondary and no stress, and how much a deviation of loudness adds.
    pub(crate) stress: [f32; 3],
    pub(crate) loudness_gain: f32,
}

impl Voice {
    fn new(
        tables: &Tables,
        controls: impl Fn(&Articulation) -> Controls,
    ) -> Result<Self, SpeechError> {
        let table = &tables.dominance;
        let curves = table.class.values().map(|c| c.groups().map(Curve::new));
        let curves: Vec<_> = curves.collect();
        let mut compiler = Compiler {
            controls,
            table,
            classes: table
                .class
                .keys()
                .zip(0..)
                .map(|(k, i)| (&**k, i))
                .collect(),
            postures: Vec::new(),
        };
        let mut sounds = Vec::with_capacity(Phone::ALL.len());
        for (phone, row) in Phone::ALL.into_iter().zip(&tables.articulation) {
            sounds.push(compiler.sound(phone, row)?);
        }
        let postures = compiler.postures;
        let mut driven: [Vec<Control>; Group::COUNT] = Default::default();
        for (name, group) in table.driven() {
            driven[group as usize].extend(Control::from_name(name));
        }
        let silence = usize::from(sounds[Phone::HSharp.index()].posture);
        Ok(Self {
            rest: postures[silence].targets,
            sounds,
            postures,
            shift_max: curves.iter().flatten().map(Curve::shift).fold(0, i64::max),
            curves,
            edges: table.class.values().map(|c| ticks(c.edge_ms)).collect(),
            driven,
            windows: Windows::new(&table.contact),
            rest_weight: table.rest_weight,
            support: ticks(table.support_ms),
            lag: ticks(table.tissue_lag_ms),
            gap: ticks(table.gap_ms),
            hold_share: table.contact.hold_share,
            stress: [
                table.opening.primary,
                table.opening.secondary,
                table.opening.unstressed,
            ],
            loudness_gain: table.opening.loudness,
        })
    }

    pub(crate) fn sound(&self, phone: Phone) -> Sound {
        self.sounds[phone.index()]
    }

    pub(crate) fn posture(&self, index: u16) -> &Posture {
        &self.postures[usize::from(index)]
    }
}

/// Turns rows into postures.
struct Compiler<'a, F> {
    controls: F,
    table: &'a DominanceTable,
    classes: BTreeMap<&'a str, usize>,
    postures: Vec<Posture>,
}

impl<F: Fn(&Articulation) -> Controls> Compiler<'_, F> {
    fn sound(&mut self, phone: Phone, row: &ArticulationRow) -> Result<Sound, SpeechError> {
        let class = &row.class;
        let posture = self.posture(phone, class, row.lips.as_ref(), row.jaw_rad, &row.tongue)?;
        let glide = match &row.glide {
            None => None,
            Some(to) => {
                let lips = to.lips.as_ref();
                let index = self.posture(phone, class, lips, to.jaw_rad, &to.tongue)?;
                Some((to.share, index))
            }
        };
        Ok(Sound { posture, glide })
    }

    fn posture(
        &mut self,
        phone: Phone,
        class: &str,
        lips: Option<&Lips>,
        jaw_rad: Option<f32>,
        tongue: &Tongue,
    ) -> Result<u16, SpeechError> {
        let articulation = tables::posture(lips, jaw_rad, tongue);
        let targets = self.calibrated(phone, &articulation)?;
        // The tables were checked, so every class is there; a new one would govern nothing.
        let kind = self.table.class.get(class).and_then(|row| row.contact);
        let contact = match kind {
            None => None,
            Some(kind) => Some(self.contact(phone, kind, &articulation, targets)?),
        };
        let mut open = [false; Control::COUNT];
        open[Control::TongueTip as usize] = tongue.tip.is_none();
        open[Control::TongueOut as usize] = tongue.out.is_none();
        open[Control::TongueBody as usize] = tongue.body.is_none();
        let any_tongue = tongue.tip.or(tongue.out).or(tongue.body).is_some();
        let index = self.postures.len() as u16;
        self.postures.push(Posture {
            targets,
            class: self.classes.get(class).copied().unwrap_or_default(),
            governs: [
                lips.is_some(),
                lips.is_some(),
                jaw_rad.is_some(),
                any_tongue,
            ],
            open,
            contact,
            kind,
        });
        Ok(index)
    }

    fn contact(
        &self,
        phone: Phone,
        kind: Contact,
        articulation: &Articulation,
        flat: Controls,
    ) -> Result<ContactTargets, SpeechError> {
        let rounded = match kind {
            Contact::Teeth => None,
            Contact::Lips => Some(self.calibrated(
                phone,
                &Articulation {
                    protrusion_mm: self.table.contact.rounded_mm,
                    width: self.table.contact.rounded_width,
                    ..*articulation
                },
            )?),
        };
        Ok(ContactTargets { flat, rounded })
    }

    fn calibrated(
        &self,
        phone: Phone,
        articulation: &Articulation,
    ) -> Result<Controls, SpeechError> {
        let controls = (self.controls)(articulation);
        match Control::ALL.iter().find(|c| !controls[**c].is_finite()) {
            None => Ok(controls),
            Some(&control) => Err(SpeechError::NotFinite {
                phone,
                control: control.name(),
                value: controls[control],
            }),
        }
    }
}
