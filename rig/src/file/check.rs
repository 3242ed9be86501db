//! What must hold of a head before it is moved and drawn: nothing later looks again.

use std::collections::HashSet;

use glam::Vec3;

use super::parts::{BONES, REQUIRED};
use super::{ANEW, HeadError, KEEP, nodes};
use crate::{Head, Layer, MuscleGrid, Part, Skin, SurfacePoint, TissueRecord};

/// Nothing of a head lies further from its middle, mm.
const FAR_MM: f32 = 2000.0;
/// By how much shares may miss a sum of 1 or the range 0..1: other programs' arithmetic.
const SLACK: f32 = 1e-3;
/// By how much of the way from skin to bone a muscle may miss it.
const DEPTH_SLACK: f32 = 0.02;
/// Radii of eyeballs, mm: from an infant's to more than any.
const EYE_MM: std::ops::RangeInclusive<f32> = 4.0..=30.0;
/// Factors from the reference head's teeth to this one's.
const SCALE: std::ops::RangeInclusive<f32> = 0.2..=5.0;

type Checked = Result<(), HeadError>;

fn that(holds: bool, element: impl Fn() -> String, fault: &str) -> Checked {
    if holds {
        Ok(())
    } else {
        Err(HeadError::element(element(), fault, ANEW))
    }
}

fn near(p: Vec3) -> bool {
    p.is_finite() && p.abs().max_element() <= FAR_MM
}

fn share(x: f32) -> bool {
    (-SLACK..=1.0 + SLACK).contains(&x)
}

/// All of it.
pub(super) fn head(head: &Head) -> Checked {
    skin(&head.skin)?;
    parts(&head.parts)?;
    let vertices = head.skin.mesh.positions.len();
    let on_skin = |v: u32| (v as usize) < vertices;
    lips(head, &on_skin)?;
    nodes::skin(head)?;
    for (i, lid) in head.lids.iter().enumerate() {
        let holds = on_skin(lid.vertex) && lid.turn.is_finite() && share(lid.hold);
        that(
            holds,
            || format!("lids[{i}]"),
            "its vertex, turn or hold cannot be",
        )?;
    }
    for feature in &head.features {
        let finite = feature.points.iter().all(|p| p.is_finite());
        that(
            finite,
            || format!("feature `{}`", feature.name),
            "a point is not finite",
        )?;
    }
    landmarks(head)?;
    let mut bones = BONES.iter().filter(|name| head.part(name).is_none());
    if let Some(name) = bones.next()
        && !head.muscles.is_empty()
    {
        let fault = "it is missing, and muscles begin on it";
        return Err(HeadError::element(format!("node `{name}`"), fault, KEEP));
    }
    for grid in &head.muscles {
        muscle(grid, vertices)?;
    }
    placement(head)
}

fn skin(skin: &Skin) -> Checked {
    let of = |what: &'static str| move || format!("skin: {what}");
    that(
        !skin.mesh.triangles.is_empty(),
        of("triangles"),
        "there are none",
    )?;
    that(
        skin.mesh.positions.iter().all(|p| near(*p)),
        of("POSITION"),
        "a vertex is metres away",
    )?;
    that(
        skin.reference.iter().all(|p| near(*p)),
        of("_REFERENCE"),
        "a vertex is metres away",
    )?;
    for (name, values) in [
        ("_WEIGHT", &skin.weight),
        ("_VERMILION", &skin.vermilion),
        ("_WET", &skin.wet),
        ("_OCCLUSION", &skin.mesh.occlusion),
    ] {
        that(
            values.iter().all(|x| share(*x)),
            of(name),
            "a value is not within 0 and 1",
        )?;
    }
    let vertices = skin.mesh.positions.len();
    let creases = skin
        .creases
        .iter()
        .all(|[a, b]| a != b && (*a.max(b) as usize) < vertices);
    that(
        creases,
        of("creases"),
        "one joins vertices that are not there",
    )
}

fn parts(parts: &[Part]) -> Checked {
    let mut names = HashSet::new();
    for part in parts {
        let of = |what: &'static str| move || format!("part `{}`: {what}", part.name);
        that(
            names.insert(&part.name),
            of("name"),
            "there are two of that name",
        )?;
        that(!part.bodies.is_empty(), of("bodies"), "it hangs on none")?;
        that(
            part.mesh.positions.iter().all(|p| near(*p)),
            of("POSITION"),
            "a vertex is metres away",
        )?;
        let end = part.bodies.len().saturating_sub(1) as f32 + SLACK;
        let along = part.weight.iter().all(|w| (-SLACK..=end).contains(w));
        that(
            along,
            of("_WEIGHT"),
            "a vertex is beyond its chain of bodies",
        )?;
        let lit = part.mesh.occlusion.iter().all(|x| share(*x));
        that(lit, of("_OCCLUSION"), "a value is not within 0 and 1")?;
    }
    match REQUIRED
        .iter()
        .find(|name| !names.iter().any(|n| n == *name))
    {
        Some(name) => Err(HeadError::element(
            format!("part `{name}`"),
            "it is missing",
            KEEP,
        )),
        None => Ok(()),
    }
}

fn lips(head: &Head, on_skin: &impl Fn(u32) -> bool) -> Checked {
    let lips = &head.lips;
    let of = || "lips".to_owned();
    let alike = lips.upper.len() == lips.lower.len() && lips.upper.len() >= 3;
    that(
        alike,
        of,
        "upper and lower lip need the same columns, three at least",
    )?;
    let mut vertices = lips.upper.iter().chain(&lips.lower).flatten();
    that(
        vertices.all(|v| on_skin(*v)),
        of,
        "a column names a vertex that is not there",
    )
}

fn landmarks(head: &Head) -> Checked {
    let mut names = HashSet::new();
    for landmark in &head.landmarks {
        let of = || format!("landmark `{}`", landmark.name);
        that(
            names.insert((landmark.layer, &landmark.name)),
            of,
            "there are two of that name",
        )?;
        let vertices = head.layer(landmark.layer).len();
        that(point(&landmark.at, vertices), of, "it lies on no triangle")?;
    }
    for landmark in &head.landmarks {
        let of = || format!("landmark `{}`", landmark.name);
        let known = |name: &String| names.contains(&(Layer::Skin, name));
        that(
            landmark.of.as_ref().is_none_or(known),
            of,
            "its skin landmark is not there",
        )?;
    }
    Ok(())
}

fn point(at: &SurfacePoint, vertices: usize) -> bool {
    at.vertices.iter().all(|v| (*v as usize) < vertices)
        && at.shares.iter().all(|s| share(*s))
        && (at.shares.iter().sum::<f32>() - 1.0).abs() <= SLACK
}

fn muscle(grid: &MuscleGrid, vertices: usize) -> Checked {
    let of = || format!("muscle {:?}", grid.muscle);
    that(!grid.fibres.is_empty(), of, "it has no fibres")?;
    for (row, fibre) in grid.fibres.iter().enumerate() {
        that(fibre.len() >= 2, of, "a fibre has fewer than two points")?;
        let sound = fibre
            .iter()
            .all(|p| point(&p.at, vertices) && p.depth.is_finite() && share(p.mandible));
        that(sound, of, "a point of its grid cannot be")?;
        for (i, point) in fibre.iter().enumerate() {
            let at = || format!("{}, fibre {row}, point {i}", of());
            that(point.depth >= -DEPTH_SLACK, at, "it lies outside the skin")?;
            that(point.depth <= 1.0 + DEPTH_SLACK, at, "it lies in the bone")?;
        }
    }
    let axes = grid.axes.is_empty() || grid.axes.len() == grid.fibres.len();
    that(axes, of, "it has not one axis per fibre")?;
    let sound = grid.axes.iter().all(|axis| {
        near(axis.from_middle)
            && axis.spread_mm > 0.0
            && axis.spread_mm <= FAR_MM
            && share(axis.mandible)
            && share(axis.shrinking)
            && axis.protrusion_mm.abs() <= FAR_MM
    });
    that(
        (0.0..=FAR_MM).contains(&grid.bulge_mm),
        of,
        "its bulge cannot be",
    )?;
    that(sound, of, "an axis cannot be")
}

fn placement(head: &Head) -> Checked {
    for (eye, name) in head.eyes.iter().zip(["left", "right"]) {
        let holds = near(eye.centre) && EYE_MM.contains(&eye.radius);
        that(
            holds,
            || format!("{name} eye"),
            "its centre or radius cannot be",
        )?;
    }
    let scale = head.bite.scale.to_array().iter().all(|s| SCALE.contains(s));
    that(
        scale && near(head.bite.shift),
        || "bite".into(),
        "its scale or shift cannot be",
    )?;
    for (name, at) in [
        ("condyle_axis", head.condyle_axis),
        ("neck_pivot", head.neck_pivot),
    ] {
        that(near(at), || name.into(), "it is metres away")?;
    }
    tissue(&head.tissue)
}

fn tissue(tissue: &TissueRecord) -> Checked {
    let mass = tissue.vertex_mass_g;
    let (min, max) = (TissueRecord::MASS_MIN_G, TissueRecord::MASS_MAX_G);
    let fault = if !(mass > 0.0 && mass.is_finite()) {
        "there is no such mass".to_owned()
    } else if (min..=max).contains(&mass) {
        return Ok(());
    } else if mass < min {
        format!("{mass} g is too light for the step, which needs {min} g")
    } else {
        format!("{mass} g is heavier than skin can be, {max} g")
    };
    let mend = "set it to 0.07, or leave it out";
    Err(HeadError::element("tissue.vertex_mass_g", fault, mend))
}
