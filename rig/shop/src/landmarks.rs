//! Landmark files: where on a scan the points with Farkas's names lie (HEADSHOP 6.1), as JSON
//! `{"unit": "mm", "points": {"prn": [x, y, z], "en_l": [x, y, z]}}`; `_l` and `_r` are the subject's
//! left and right. Which names there are the reference head says, not this module.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use glam::DVec3;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// Longest landmark file: some 100 points take 10 kB.
const MAX_BYTES: u64 = 1 << 20;

/// Far beyond any scan, and its square is still finite.
const FAR: f64 = 1e9;

/// Fewest landmarks that place a head: three leave out which way it is mirrored.
pub const MIN_LANDMARKS: usize = 4;

/// What lengths are in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unit {
    /// Millimetres.
    #[default]
    #[serde(rename = "mm")]
    Millimetre,
    /// Centimetres.
    #[serde(rename = "cm")]
    Centimetre,
    /// Metres.
    #[serde(rename = "m")]
    Metre,
    /// Inches.
    #[serde(rename = "in")]
    Inch,
}

impl Unit {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Millimetre, Self::Centimetre, Self::Metre, Self::Inch];

    /// How many millimetres it has.
    #[must_use]
    pub fn mm(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Inch => 25.4,
        }
    }

    /// As in files: `mm`, `cm`, `m`, `in`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::Inch => "in",
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for Unit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|u| u.name() == text)
            .ok_or_else(|| format!("`{text}` is no unit: write mm, cm, m or in"))
    }
}

/// The landmarks of a scan.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Landmarks {
    /// What `points` is in.
    pub unit: Unit,
    /// Coordinates by name, in the frame of the scan.
    #[serde(deserialize_with = "each_once")]
    pub points: BTreeMap<String, DVec3>,
}

/// What is wrong with landmarks; the messages name the file, the landmark and the mend.
#[derive(Debug, thiserror::Error)]
#[error("{file}: {fault}")]
pub struct LandmarkError {
    /// The file, as the caller named it.
    pub file: String,
    /// What is wrong, and the mend.
    #[source]
    pub fault: LandmarkFault,
}

/// What is wrong with landmarks. Lengths are mm.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum LandmarkFault {
    #[error("cannot be read or written ({0}): check the path and its permissions")]
    Io(std::io::Error),
    #[error("it has more than {MAX_BYTES} bytes: this is no landmark file")]
    Huge,
    #[error(
        "{0}: a landmark file is {{\"unit\": \"mm\", \"points\": {{\"prn\": [x, y, z], …}}}}, with mm, cm, m or in"
    )]
    Json(serde_json::Error),
    #[error("there is no landmark `{name}`: {mend}")]
    UnknownName { name: String, mend: String },
    #[error("landmark `{name}` has the coordinate {value}: give it a finite one or leave it out")]
    NotFinite { name: String, value: f64 },
    #[error(
        "{0} landmark(s), and at least {MIN_LANDMARKS} are needed: add for example ex_l, ex_r, prn and gn"
    )]
    TooFew(usize),
    #[error("all landmarks lie on one spot: place each where its name belongs")]
    OneSpot,
    #[error(
        "landmarks `{first}` and `{second}` lie on one spot: move one to its place or leave it out"
    )]
    SameSpot { first: String, second: String },
    #[error(
        "all landmarks lie on one line, so they do not say how the head is turned: add one beside it, for example ex_l"
    )]
    Collinear,
    #[error(
        "left and right are swapped: exchange _l and _r, which are the subject's left and right, not the viewer's (if the landmarks are right, the scan is a mirror image)"
    )]
    Swapped,
    #[error(
        "left and right of {0} are swapped against the other landmarks: exchange them, _l is the subject's left"
    )]
    SwappedPairs(String),
    #[error(
        "landmark `{name}` lies {distance:.0} mm off the scan's surface: place it on the scan or leave it out, it will be estimated"
    )]
    Outside { name: String, distance: f64 },
    #[error(
        "the landmarks lie off the scan (`{name}` by {distance:.0} mm): they are from another scan, in another frame or in another unit than they say ({unit})"
    )]
    AllOutside {
        name: String,
        distance: f64,
        unit: Unit,
    },
    #[error(
        "landmark `{name}` lies {distance:.0} mm from where the others say it belongs: place it anew or leave it out, it will be estimated"
    )]
    Disagrees { name: String, distance: f64 },
    #[error(
        "the landmarks do not lie as on a face (`{name}` worst, by {distance:.0} mm): check that the names belong to the points"
    )]
    NoFace { name: String, distance: f64 },
    #[error(
        "with 1 unit = {mm_per_unit} mm the head would be {ratio:.3} times as large as the reference head: {mend}"
    )]
    Size {
        mm_per_unit: f64,
        ratio: f64,
        mend: &'static str,
    },
}

impl LandmarkFault {
    /// The error of this fault in `file`.
    #[must_use]
    pub fn in_file(self, file: &str) -> LandmarkError {
        LandmarkError {
            file: file.to_owned(),
            fault: self,
        }
    }
}

impl Landmarks {
    /// The landmarks in the file at `path`.
    ///
    /// # Errors
    /// When it is no landmark file.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, LandmarkError> {
        let path = path.as_ref();
        let read = || {
            if std::fs::metadata(path).map_err(LandmarkFault::Io)?.len() > MAX_BYTES {
                return Err(LandmarkFault::Huge);
            }
            Self::parse(&std::fs::read(path).map_err(LandmarkFault::Io)?)
        };
        read().map_err(|fault| fault.in_file(&path.display().to_string()))
    }

    /// The landmarks in a file's bytes.
    ///
    /// # Errors
    /// When they are no landmark file.
    pub fn parse(json: &[u8]) -> Result<Self, LandmarkFault> {
        serde_json::from_slice(json).map_err(LandmarkFault::Json)
    }

    /// As a file's text: one landmark a line.
    ///
    /// # Errors
    /// When a coordinate is not finite, which JSON cannot hold.
    pub fn json(&self) -> Result<String, LandmarkFault> {
        self.check_finite()?;
        let mut lines = Vec::with_capacity(self.points.len());
        for (name, at) in &self.points {
            let name = serde_json::to_string(name).map_err(LandmarkFault::Json)?;
            lines.push(format!("    {name}: [{}, {}, {}]", at.x, at.y, at.z));
        }
        let points = lines.join(",\n");
        Ok(format!(
            "{{\n  \"unit\": \"{}\",\n  \"points\": {{\n{points}\n  }}\n}}\n",
            self.unit
        ))
    }

    /// Writes the file at `path`.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), LandmarkError> {
        let path = path.as_ref();
        self.json()
            .and_then(|json| std::fs::write(path, json).map_err(LandmarkFault::Io))
            .map_err(|fault| fault.in_file(&path.display().to_string()))
    }

    /// Whether every name is one of `known` and every coordinate finite.
    ///
    /// # Errors
    /// At the first that is not; a wrong name with the nearest right one.
    pub fn check<'n>(
        &self,
        known: impl Iterator<Item = &'n str> + Clone,
    ) -> Result<(), LandmarkFault> {
        for name in self.points.keys() {
            if !known.clone().any(|k| k == name) {
                return Err(LandmarkFault::UnknownName {
                    name: name.chars().take(40).collect(),
                    mend: nearest(name, known),
                });
            }
        }
        self.check_finite()
    }

    fn check_finite(&self) -> Result<(), LandmarkFault> {
        for (name, at) in &self.points {
            if let Some(value) = at
                .to_array()
                .into_iter()
                .find(|v| v.is_nan() || v.abs() >= FAR)
            {
                return Err(LandmarkFault::NotFinite {
                    name: name.clone(),
                    value,
                });
            }
        }
        Ok(())
    }
}

/// What to write instead of `name`.
fn nearest<'n>(name: &str, known: impl Iterator<Item = &'n str> + Clone) -> String {
    let sides: Vec<&str> = known
        .clone()
        .filter(|k| k.strip_suffix("_l").or(k.strip_suffix("_r")) == Some(name))
        .collect();
    if let [first, second] = sides[..] {
        return format!("say which side, {first} or {second}");
    }
    let name: String = name.chars().take(40).collect();
    let near = known.min_by_key(|k| edits(&name.to_lowercase(), &k.to_lowercase()));
    match near {
        Some(near) => format!("the nearest name is `{near}`; `head info` lists all"),
        None => "`head info` lists the names".to_owned(),
    }
}

/// Least number of characters to add, drop or change.
fn edits(from: &str, to: &str) -> usize {
    let mut row: Vec<usize> = (0..=to.chars().count()).collect();
    for (i, a) in from.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, b) in to.chars().enumerate() {
            let change = diagonal + usize::from(a != b);
            diagonal = row[j + 1];
            row[j + 1] = change.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[row.len() - 1]
}

/// Points by name, where a name that comes twice is an error and not the last one's victory.
fn each_once<'de, D: Deserializer<'de>>(from: D) -> Result<BTreeMap<String, DVec3>, D::Error> {
    struct Points;
    impl<'de> Visitor<'de> for Points {
        type Value = BTreeMap<String, DVec3>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("names with [x, y, z]")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut points = BTreeMap::new();
            while let Some((name, at)) = map.next_entry::<String, [f64; 3]>()? {
                if points.contains_key(&name) {
                    let why = format!("landmark `{name}` is given twice, so leave one out");
                    return Err(A::Error::custom(why));
                }
                points.insert(name, DVec3::from_array(at));
            }
            Ok(points)
        }
    }
    from.deserialize_map(Points)
}
