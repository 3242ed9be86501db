//! Standard measurements of a head: distances between Farkas's landmarks.
//!
//! Names and meaning follow Farkas, Anthropometry of the Head and Face (1994). All are straight
//! distances between two points, as a sliding or spreading caliper takes them; his projective and
//! tangential (tape) measurements are not here.

use std::collections::HashMap;

use glam::Vec3;

use crate::{Head, Layer};

/// Landmarks of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ends {
    /// Two of the midline.
    Midline(&'static str, &'static str),
    /// The left and the right one of a pair.
    Across(&'static str),
    /// A pair's, each to one of the midline.
    ToMidline(&'static str, &'static str),
    /// Two pairs, on each side.
    Sides(&'static str, &'static str),
}
use Ends::{Across, Midline, Sides, ToMidline};

/// What is measured: landmarks, and the name that Farkas gives the distance.
const TABLE: [(Ends, &str); 47] = [
    (Midline("g", "op"), "head length"),
    (Across("eu"), "head breadth"),
    (Across("ft"), "forehead breadth"),
    (Midline("v", "n"), "height of the calvarium to the nasion"),
    (Midline("v", "gn"), "height of head and face"),
    (Midline("tr", "g"), "forehead height to the glabella"),
    (Midline("tr", "n"), "forehead height"),
    (Midline("tr", "gn"), "physiognomical face height"),
    (Across("zy"), "face breadth"),
    (Across("go"), "mandible breadth"),
    (Midline("n", "gn"), "morphological face height"),
    (Midline("n", "sto"), "upper face height"),
    (Midline("g", "sn"), "middle face height from the glabella"),
    (Midline("sn", "gn"), "lower face height"),
    (Midline("sto", "gn"), "mandible height"),
    (Midline("sl", "gn"), "chin height"),
    (ToMidline("t", "g"), "supraorbital depth"),
    (ToMidline("t", "n"), "upper face depth"),
    (ToMidline("t", "sn"), "middle face depth"),
    (ToMidline("t", "gn"), "lower face depth"),
    (ToMidline("go", "gn"), "mandible body length"),
    (Sides("ex", "t"), "orbito-tragial depth"),
    (Sides("ex", "go"), "orbito-gonial distance"),
    (Across("en"), "intercanthal width"),
    (Across("ex"), "biocular width"),
    (Sides("en", "ex"), "eye fissure length"),
    (Sides("ps", "pi"), "eye fissure height"),
    (Sides("os", "ps"), "upper lid height"),
    (Sides("pi", "or"), "lower lid height"),
    (Midline("n", "sn"), "nose height"),
    (Midline("n", "prn"), "nasal bridge length"),
    (Across("mf"), "nasal root width"),
    (Across("al"), "nose width"),
    (Across("ac"), "nose width between the alar creases"),
    (Midline("sn", "prn"), "nasal tip protrusion"),
    (ToMidline("ac", "prn"), "ala length"),
    (Across("sbal"), "nostril floors and columella width"),
    (Across("ch"), "mouth width"),
    (Across("cph"), "philtrum width"),
    (Midline("sn", "ls"), "upper lip height, skin"),
    (Midline("sn", "sto"), "upper lip height"),
    (Midline("ls", "sto"), "upper vermilion height"),
    (Midline("sto", "li"), "lower vermilion height"),
    (Midline("ls", "li"), "vermilion height"),
    (Midline("sto", "sl"), "lower lip height"),
    (Sides("sa", "sba"), "ear length"),
    (Sides("pra", "pa"), "ear width"),
];

/// A distance between landmarks.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Its landmarks: `n-gn`, `en-ex` …
    pub name: String,
    /// What it is.
    pub title: &'static str,
    /// How long, mm; of paired ones the mean.
    pub mm: f32,
    /// Of paired ones: left and right, mm.
    pub sides_mm: Option<[f32; 2]>,
}

/// All that the head's landmarks suffice for.
#[must_use]
pub fn measurements(head: &Head) -> Vec<Measurement> {
    let places = head.landmark_places();
    let marks: HashMap<&str, Vec3> = head
        .landmarks
        .iter()
        .zip(places)
        .filter(|(mark, _)| mark.layer == Layer::Skin)
        .map(|(mark, place)| (mark.name.as_str(), place))
        .collect();
    let between = |a: &str, b: &str| Some(marks.get(a)?.distance(*marks.get(b)?));
    let side = |name: &str, side: &str| format!("{name}_{side}");
    TABLE
        .iter()
        .filter_map(|&(ends, title)| {
            let (a, b, both) = match ends {
                Midline(a, b) => (a, b, [between(a, b)?; 2]),
                Across(a) => (a, a, [between(&side(a, "l"), &side(a, "r"))?; 2]),
                ToMidline(a, b) => {
                    let at = |s| between(&side(a, s), b);
                    (a, b, [at("l")?, at("r")?])
                }
                Sides(a, b) => {
                    let at = |s| between(&side(a, s), &side(b, s));
                    (a, b, [at("l")?, at("r")?])
                }
            };
            let paired = matches!(ends, ToMidline(..) | Sides(..));
            Some(Measurement {
                name: format!("{a}-{b}"),
                title,
                mm: 0.5 * (both[0] + both[1]),
                sides_mm: paired.then_some(both),
            })
        })
        .collect()
}
