//! What the head can be told to do: one number per muscle, jaw, tongue, lid, gaze and head angle.
//!
//! The first twelve muscles, of the lower face, are HABER 4.2's number; the paper names none of them,
//! so the choice is by anatomy (Terminologia Anatomica): the two halves of the orbicularis oris and
//! the ten muscles that insert into it or into the chin. The others complete HEADSHOP 3's number, 24
//! (the orbicularis oculi is one muscle in two parts, so that there are 25): those that move brows,
//! lids and nose, the sheet of the neck and the two of the jaw that show under the skin.
//!
//! A paired muscle has one control for both bellies and one, its *side*, for how they differ: the left
//! one contracts by their sum, the right one by their difference. So that speech, which is even on
//! both sides, leaves the sides alone, and everything linear (filters, mixes) acts on both alike.

use serde::{Deserialize, Serialize};

/// A muscle of the face; paired ones stand for their left and right belly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(usize)]
#[allow(missing_docs, reason = "the names are the field's own")]
pub enum Muscle {
    OrbicularisOrisSuperior,
    OrbicularisOrisInferior,
    LevatorLabiiSuperioris,
    LevatorLabiiSuperiorisAlaequeNasi,
    LevatorAnguliOris,
    ZygomaticusMajor,
    ZygomaticusMinor,
    Risorius,
    Buccinator,
    DepressorAnguliOris,
    DepressorLabiiInferioris,
    Mentalis,
    FrontalisInner,
    FrontalisOuter,
    CorrugatorSupercilii,
    Procerus,
    DepressorSupercilii,
    OrbicularisOculiOrbital,
    OrbicularisOculiPalpebral,
    Nasalis,
    DilatorNaris,
    DepressorSeptiNasi,
    Platysma,
    Masseter,
    Temporalis,
}

impl Muscle {
    /// How many there are.
    pub const COUNT: usize = 25;

    /// All of them, in the order of their numbers.
    pub const ALL: [Self; Self::COUNT] = [
        Self::OrbicularisOrisSuperior,
        Self::OrbicularisOrisInferior,
        Self::LevatorLabiiSuperioris,
        Self::LevatorLabiiSuperiorisAlaequeNasi,
        Self::LevatorAnguliOris,
        Self::ZygomaticusMajor,
        Self::ZygomaticusMinor,
        Self::Risorius,
        Self::Buccinator,
        Self::DepressorAnguliOris,
        Self::DepressorLabiiInferioris,
        Self::Mentalis,
        Self::FrontalisInner,
        Self::FrontalisOuter,
        Self::CorrugatorSupercilii,
        Self::Procerus,
        Self::DepressorSupercilii,
        Self::OrbicularisOculiOrbital,
        Self::OrbicularisOculiPalpebral,
        Self::Nasalis,
        Self::DilatorNaris,
        Self::DepressorSeptiNasi,
        Self::Platysma,
        Self::Masseter,
        Self::Temporalis,
    ];
}

/// Makes an enum of controls together with its names and bounds, so that the three cannot drift.
macro_rules! controls {
    ($($(#[$doc:meta])* $variant:ident = $name:literal in $min:literal ..= $max:literal;)*) => {
        /// One thing the head can be told to do. The first are the contractions of
        /// [`Muscle::ALL`], in that order.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(usize)]
        pub enum Control { $($(#[$doc])* $variant,)* }

        impl Control {
            /// All controls, in the order of their numbers.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];
            /// How many there are.
            pub const COUNT: usize = Self::ALL.len();

            /// The name used in columns and JSON.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// Lowest and highest value the head accepts.
            #[must_use]
            pub const fn range(self) -> (f32, f32) {
                match self { $(Self::$variant => ($min, $max),)* }
            }
        }
    };
}

controls! {
    /// Contraction, 0 relaxed to 1.
    OrbicularisOrisSuperior = "orbicularis_oris_superior" in 0.0 ..= 1.0;
    /// Contraction.
    OrbicularisOrisInferior = "orbicularis_oris_inferior" in 0.0 ..= 1.0;
    /// Contraction.
    LevatorLabiiSuperioris = "levator_labii_superioris" in 0.0 ..= 1.0;
    /// Contraction.
    LevatorLabiiSuperiorisAlaequeNasi = "levator_labii_superioris_alaeque_nasi" in 0.0 ..= 1.0;
    /// Contraction.
    LevatorAnguliOris = "levator_anguli_oris" in 0.0 ..= 1.0;
    /// Contraction.
    ZygomaticusMajor = "zygomaticus_major" in 0.0 ..= 1.0;
    /// Contraction.
    ZygomaticusMinor = "zygomaticus_minor" in 0.0 ..= 1.0;
    /// Contraction.
    Risorius = "risorius" in 0.0 ..= 1.0;
    /// Contraction.
    Buccinator = "buccinator" in 0.0 ..= 1.0;
    /// Contraction.
    DepressorAnguliOris = "depressor_anguli_oris" in 0.0 ..= 1.0;
    /// Contraction.
    DepressorLabiiInferioris = "depressor_labii_inferioris" in 0.0 ..= 1.0;
    /// Contraction.
    Mentalis = "mentalis" in 0.0 ..= 1.0;
    /// Contraction.
    FrontalisInner = "frontalis_inner" in 0.0 ..= 1.0;
    /// Contraction.
    FrontalisOuter = "frontalis_outer" in 0.0 ..= 1.0;
    /// Contraction.
    CorrugatorSupercilii = "corrugator_supercilii" in 0.0 ..= 1.0;
    /// Contraction.
    Procerus = "procerus" in 0.0 ..= 1.0;
    /// Contraction.
    DepressorSupercilii = "depressor_supercilii" in 0.0 ..= 1.0;
    /// Contraction.
    OrbicularisOculiOrbital = "orbicularis_oculi_orbital" in 0.0 ..= 1.0;
    /// Contraction; it closes the lids as gently as [`Self::LidL`] and [`Self::LidR`] do.
    OrbicularisOculiPalpebral = "orbicularis_oculi_palpebral" in 0.0 ..= 1.0;
    /// Contraction.
    Nasalis = "nasalis" in 0.0 ..= 1.0;
    /// Contraction.
    DilatorNaris = "dilator_naris" in 0.0 ..= 1.0;
    /// Contraction.
    DepressorSeptiNasi = "depressor_septi_nasi" in 0.0 ..= 1.0;
    /// Contraction.
    Platysma = "platysma" in 0.0 ..= 1.0;
    /// Contraction.
    Masseter = "masseter" in 0.0 ..= 1.0;
    /// Contraction.
    Temporalis = "temporalis" in 0.0 ..= 1.0;
    /// Protrusion of the upper half of the orbicularis oris along its axis; below 0 is tucked in.
    ProtrusionSuperior = "protrusion_superior" in -1.0 ..= 1.0;
    /// Protrusion of the lower half.
    ProtrusionInferior = "protrusion_inferior" in -1.0 ..= 1.0;
    /// Jaw rotation about the condylar axis, radians, 0 with the teeth together.
    Jaw = "jaw_rad" in 0.0 ..= 0.45;
    /// Tongue tip: 0 at rest to 1 at the alveolar ridge.
    TongueTip = "tongue_tip" in 0.0 ..= 1.0;
    /// Tongue forward: 0 at rest to 1 with its tip between the teeth; -1 drawn back.
    TongueOut = "tongue_out" in -1.0 ..= 1.0;
    /// Tongue body: 0 at rest to 1 with the dorsum at the palate.
    TongueBody = "tongue_body" in 0.0 ..= 1.0;
    /// Closing of the subject's left lids, 0 open to 1 closed; below 0 wide open.
    LidL = "lid_l" in -0.4 ..= 1.0;
    /// Closing of the subject's right lids.
    LidR = "lid_r" in -0.4 ..= 1.0;
    /// Gaze to the subject's left, radians.
    GazeYaw = "gaze_yaw_rad" in -0.6 ..= 0.6;
    /// Gaze up, radians.
    GazePitch = "gaze_pitch_rad" in -0.45 ..= 0.45;
    /// Head turned to the subject's left, radians.
    HeadYaw = "head_yaw_rad" in -0.6 ..= 0.6;
    /// Head raised, radians.
    HeadPitch = "head_pitch_rad" in -0.4 ..= 0.4;
    /// Head tilted towards the subject's left shoulder, radians.
    HeadRoll = "head_roll_rad" in -0.3 ..= 0.3;
    /// How much more the left belly contracts than both on average.
    LevatorLabiiSuperiorisSide = "levator_labii_superioris_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    LevatorLabiiSuperiorisAlaequeNasiSide = "levator_labii_superioris_alaeque_nasi_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    LevatorAnguliOrisSide = "levator_anguli_oris_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    ZygomaticusMajorSide = "zygomaticus_major_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    ZygomaticusMinorSide = "zygomaticus_minor_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    RisoriusSide = "risorius_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    BuccinatorSide = "buccinator_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    DepressorAnguliOrisSide = "depressor_anguli_oris_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    DepressorLabiiInferiorisSide = "depressor_labii_inferioris_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    MentalisSide = "mentalis_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    FrontalisInnerSide = "frontalis_inner_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    FrontalisOuterSide = "frontalis_outer_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    CorrugatorSuperciliiSide = "corrugator_supercilii_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    ProcerusSide = "procerus_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    DepressorSuperciliiSide = "depressor_supercilii_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    OrbicularisOculiOrbitalSide = "orbicularis_oculi_orbital_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    OrbicularisOculiPalpebralSide = "orbicularis_oculi_palpebral_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    NasalisSide = "nasalis_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    DilatorNarisSide = "dilator_naris_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    DepressorSeptiNasiSide = "depressor_septi_nasi_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    PlatysmaSide = "platysma_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    MasseterSide = "masseter_side" in -1.0 ..= 1.0;
    /// How much more the left belly contracts than both on average.
    TemporalisSide = "temporalis_side" in -1.0 ..= 1.0;
}

impl Control {
    /// The contraction of `muscle`.
    #[must_use]
    pub const fn contraction(muscle: Muscle) -> Self {
        Self::ALL[muscle as usize]
    }

    /// How the two bellies of `muscle` differ; none for the halves of the orbicularis oris, which
    /// each cross the middle.
    #[must_use]
    pub const fn side(muscle: Muscle) -> Option<Self> {
        match (muscle as usize).checked_sub(Muscle::LevatorLabiiSuperioris as usize) {
            Some(pair) => Some(Self::ALL[Self::LevatorLabiiSuperiorisSide as usize + pair]),
            None => None,
        }
    }

    /// The control of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|c| c.name() == name)
    }
}

/// A value for every [`Control`]; the default is the head at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls(pub [f32; Control::COUNT]);

impl Default for Controls {
    fn default() -> Self {
        Self([0.0; Control::COUNT])
    }
}

impl std::ops::Index<Control> for Controls {
    type Output = f32;
    fn index(&self, control: Control) -> &f32 {
        &self.0[control as usize]
    }
}

impl std::ops::IndexMut<Control> for Controls {
    fn index_mut(&mut self, control: Control) -> &mut f32 {
        &mut self.0[control as usize]
    }
}

impl Controls {
    /// The contraction of one belly of `muscle`, the subject's left or right one, 0 to 1.
    #[must_use]
    pub fn contraction(&self, muscle: Muscle, left: bool) -> f32 {
        let both = self[Control::contraction(muscle)];
        match Control::side(muscle).map(|side| self[side]) {
            Some(side) if side != 0.0 => {
                (if left { both + side } else { both - side }).clamp(0.0, 1.0)
            }
            _ => both,
        }
    }

    /// Every value within its range; what is not a number becomes 0.
    #[must_use]
    pub fn clamped(mut self) -> Self {
        for &control in Control::ALL {
            let (min, max) = control.range();
            let value = self[control];
            self[control] = if value.is_finite() {
                value.clamp(min, max)
            } else {
                0.0
            };
        }
        self
    }

    /// The mix `self * (1 - share) + other * share`.
    #[must_use]
    pub fn lerp(&self, other: &Self, share: f32) -> Self {
        Self(std::array::from_fn(|i| {
            self.0[i] + (other.0[i] - self.0[i]) * share
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers tie muscles, contractions and sides together: their names must agree.
    #[test]
    fn each_muscle_has_its_contraction_and_its_side() {
        for muscle in Muscle::ALL {
            let contraction = Control::contraction(muscle);
            let Some(side) = Control::side(muscle) else {
                assert!(contraction.name().starts_with("orbicularis_oris"));
                continue;
            };
            assert_eq!(side.name(), format!("{}_side", contraction.name()));
        }
        let sides = Muscle::ALL.into_iter().filter_map(Control::side).count();
        assert_eq!(sides, Muscle::COUNT - 2);
        assert_eq!(Control::ALL.len(), Control::HeadRoll as usize + 1 + sides);
    }

    #[test]
    fn a_side_sets_the_bellies_apart_and_none_leaves_them_even() {
        let muscle = Muscle::ZygomaticusMajor;
        let mut controls = Controls::default();
        controls[Control::ZygomaticusMajor] = 0.4;
        for left in [true, false] {
            assert_eq!(controls.contraction(muscle, left), 0.4);
        }
        controls[Control::ZygomaticusMajorSide] = 0.4;
        assert_eq!(controls.contraction(muscle, true), 0.8);
        assert_eq!(controls.contraction(muscle, false), 0.0);
        controls[Control::ZygomaticusMajorSide] = -0.7;
        assert_eq!(controls.contraction(muscle, true), 0.0);
        assert_eq!(controls.contraction(muscle, false), 1.0);
    }
}
