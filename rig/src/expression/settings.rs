//! Controls by name, as expressions and scripts give them.
//!
//! A name is a [`Control`]'s, or that of a paired muscle with `_l` or `_r` behind it for the subject's
//! left or right belly alone; a belly's own value goes before that of the pair.

use std::fmt;

use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::text::nearest;
use crate::{Control, Controls, Muscle};

/// What is given is set, and all else 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Settings(pub(super) Controls);

/// [`Controls`] with the contraction of the left belly in place of that of both, and that of the right
/// belly in place of the side: what is blended is then what the muscles feel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bellies(pub(super) [f32; Control::COUNT]);

/// The controls of each paired muscle.
pub(super) fn pairs() -> impl Iterator<Item = (Muscle, Control, Control)> {
    Muscle::ALL
        .into_iter()
        .filter_map(|m| Control::side(m).map(|side| (m, Control::contraction(m), side)))
}

impl From<&Controls> for Bellies {
    fn from(controls: &Controls) -> Self {
        let mut values = controls.0;
        for (muscle, both, side) in pairs() {
            values[both as usize] = controls.contraction(muscle, true);
            values[side as usize] = controls.contraction(muscle, false);
        }
        Self(values)
    }
}

impl From<&Bellies> for Controls {
    fn from(bellies: &Bellies) -> Self {
        let mut controls = Self(bellies.0);
        for (_, both, side) in pairs() {
            let (left, right) = (bellies.0[both as usize], bellies.0[side as usize]);
            // Even bellies stay so to the last bit.
            if left == right {
                controls[side] = 0.0;
            } else {
                controls[both] = (left + right) / 2.0;
                controls[side] = (left - right) / 2.0;
            }
        }
        controls
    }
}

/// Who a name in a file means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Control(Control),
    /// Index into [`Bellies`] of one belly.
    Belly(usize),
}

impl Place {
    fn of(name: &str) -> Option<Self> {
        if let Some(control) = Control::from_name(name) {
            return Some(Self::Control(control));
        }
        let left = name.strip_suffix("_l");
        let base = left.or_else(|| name.strip_suffix("_r"))?;
        pairs()
            .find(|(_, both, _)| both.name() == base)
            .map(|(_, both, side)| Self::Belly(if left.is_some() { both } else { side } as usize))
    }

    fn range(self) -> (f32, f32) {
        match self {
            Self::Control(control) => control.range(),
            Self::Belly(_) => (0.0, 1.0),
        }
    }
}

/// The message for a name that means nobody.
fn unknown(name: &str) -> String {
    let sided: Vec<String> = pairs()
        .flat_map(|(_, both, _)| ["l", "r"].map(|end| format!("{}_{end}", both.name())))
        .collect();
    let names = Control::ALL.iter().map(|c| c.name());
    let near = nearest(name, names.chain(sided.iter().map(String::as_str)));
    format!(
        "there is no control `{name}`; the nearest is `{near}`, and `mouthpiece curves` shows all as columns"
    )
}

impl<'de> Deserialize<'de> for Settings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Named;
        impl<'de> Visitor<'de> for Named {
            type Value = Settings;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("controls with their values, as {\"zygomaticus_major\": 0.5}")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Settings, A::Error> {
                let mut given: Vec<(Place, f32)> = Vec::new();
                while let Some(name) = map.next_key::<String>()? {
                    let place = Place::of(&name).ok_or_else(|| A::Error::custom(unknown(&name)))?;
                    if given.iter().any(|(other, _)| *other == place) {
                        let message = format!("`{name}` is there twice; remove one");
                        return Err(A::Error::custom(message));
                    }
                    let value: f32 = map.next_value()?;
                    let (least, most) = place.range();
                    // Not a number is in no range.
                    if !(least..=most).contains(&value) {
                        return Err(A::Error::custom(format!(
                            "`{name}` goes from {least} to {most}, not to {value}; choose a value within"
                        )));
                    }
                    given.push((place, value));
                }
                Ok(settings(&given))
            }
        }
        deserializer.deserialize_map(Named)
    }
}

fn settings(given: &[(Place, f32)]) -> Settings {
    let mut controls = Controls::default();
    for &(place, value) in given {
        if let Place::Control(control) = place {
            controls[control] = value;
        }
    }
    let mut bellies = Bellies::from(&controls);
    for &(place, value) in given {
        if let Place::Belly(index) = place {
            bellies.0[index] = value;
        }
    }
    Settings(Controls::from(&bellies))
}
