//! Ribbons of strands, laid along the growth from many roots: dense ones that cover, loose locks over
//! them, and single hairs that break the outline.

use glam::{Vec3, vec2, vec3};
use mouthpiece_rig::Mesh;

use super::scalp::Scalp;
use super::style::{self, Growth};
use super::{COLUMNS, DENSE, EVEN, LOOSE, cap};
use crate::noise::Dice;
use crate::noise::ramp;

/// One kind of card.
#[derive(Clone, Copy, Debug)]
struct Kind {
    region: Region,
    /// Places tried, evenly over the whole sphere: about three tenths lie on the scalp.
    tries: usize,
    /// Least depth within the hairline, mm.
    depth_mm: f32,
    width_mm: [f32; 2],
    /// Share of the style's length.
    length: [f32; 2],
    /// Height among the layers: 1 is the outline.
    layer: [f32; 2],
    /// How far the tip leaves the outline, as a share of the length.
    lift: [f32; 2],
    /// How much it falls forward, and how much single cards stray.
    fall: f32,
    stray: f32,
    /// Columns of the strands' map: first and how many.
    columns: (usize, usize),
    steps: usize,
    /// Light at the root.
    root_light: f32,
    seed: u64,
}

/// Where a kind of card grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Region {
    /// Over the edge of the forehead.
    Fringe,
    /// The long hair.
    Top,
    /// Sides and nape, where hair is short and even.
    Short,
    /// Along the hairline.
    Edge,
    All,
}

const KINDS: [Kind; 6] = [
    // Thin locks that fall over the edge of the forehead.
    Kind {
        region: Region::Fringe,
        tries: 1900,
        depth_mm: 0.0,
        width_mm: [2.5, 6.0],
        length: [0.40, 0.72],
        layer: [0.7, 1.0],
        lift: [0.0, 0.05],
        fall: 0.75,
        stray: 0.7,
        columns: (DENSE + 1, LOOSE - 1),
        steps: 3,
        root_light: 0.75,
        seed: 70,
    },
    // Single hairs off the outline.
    Kind {
        region: Region::All,
        tries: 300,
        depth_mm: 2.0,
        width_mm: [1.2, 2.4],
        length: [0.55, 1.0],
        layer: [0.9, 1.12],
        lift: [0.03, 0.16],
        fall: 0.0,
        stray: 0.5,
        columns: (DENSE + LOOSE, COLUMNS - DENSE - LOOSE),
        steps: 3,
        root_light: 0.8,
        seed: 71,
    },
    // Short hair along the hairline, rooted on both sides of it.
    Kind {
        region: Region::Edge,
        tries: 1200,
        depth_mm: -2.0,
        width_mm: [2.6, 5.0],
        length: [0.55, 0.9],
        layer: [0.8, 1.2],
        lift: [0.0, 0.05],
        fall: 0.0,
        stray: 0.4,
        columns: (DENSE + 1, LOOSE - 1),
        steps: 2,
        root_light: 0.85,
        seed: 72,
    },
    // Loose locks over the dense layer.
    Kind {
        region: Region::Top,
        tries: 580,
        depth_mm: 5.0,
        width_mm: [5.0, 9.0],
        length: [0.80, 1.15],
        layer: [0.96, 1.01],
        lift: [0.0, 0.015],
        fall: 0.0,
        stray: 0.26,
        columns: (DENSE, 1),
        steps: 5,
        root_light: 0.80,
        seed: 73,
    },
    // Long flat cards close to the cap.
    Kind {
        region: Region::Short,
        tries: 900,
        depth_mm: 1.0,
        width_mm: [8.0, 12.0],
        length: [1.3, 1.7],
        layer: [0.98, 1.12],
        lift: [0.0, 0.02],
        fall: 0.0,
        stray: 0.12,
        columns: (EVEN, 1),
        steps: 4,
        root_light: 0.90,
        seed: 75,
    },
    // The dense layer.
    Kind {
        region: Region::Top,
        tries: 900,
        depth_mm: 3.0,
        width_mm: [11.0, 16.0],
        length: [0.80, 1.05],
        layer: [0.89, 0.95],
        lift: [0.0, 0.01],
        fall: 0.0,
        stray: 0.16,
        columns: (0, DENSE),
        steps: 4,
        root_light: 0.72,
        seed: 74,
    },
];

/// Longest step of a card, mm: the head curves away under longer ones.
const STEP_MM: f32 = 10.0;
/// How deep within the hairline the short hair of its edge grows.
const EDGE_MM: f32 = 8.0;
/// How deep those that fall over the forehead grow.
const FRINGE_MM: f32 = 12.0;
/// Share of the long hair up to which hair counts as short.
const SHORT: f32 = 0.35;
/// How far short hair reaches over the hairline, and how short a card is not worth drawing, mm.
const OVER_MM: f32 = 1.5;
const LEAST_MM: f32 = 4.0;
/// How far off the cap a card stays at its root and beyond, mm.
const CLEAR_MM: [f32; 2] = [0.35, 0.9];

/// Adds all cards, outermost kinds first.
pub(super) fn grow(mesh: &mut Mesh, scalp: &Scalp) {
    for kind in &KINDS {
        let mut dice = Dice::new(kind.seed);
        for i in 0..kind.tries {
            // Points on a sphere by the golden angle, shaken a little.
            let y = 1.0 - 2.0 * (i as f32 + dice.roll()) / kind.tries as f32;
            let turn = i as f32 * 2.399_963 + 0.5 * dice.spread();
            let flat = (1.0 - y * y).max(0.0).sqrt();
            let root = scalp.towards(vec3(flat * turn.sin(), y, flat * turn.cos()));
            // The edge of hair is no line, least of all on the forehead.
            let front = ramp(40.0, 60.0, root.z);
            let depth = scalp.depth_mm(root) + 1.5 * dice.spread() * front - 1.5 * (1.0 - front);
            let short = style::top(root) < SHORT;
            let within = match kind.region {
                Region::Fringe => {
                    depth < FRINGE_MM && root.z > 45.0 && root.y > 78.0 && root.x < 36.0
                }
                Region::Top => !short,
                Region::Short => short,
                Region::Edge => depth < EDGE_MM,
                Region::All => true,
            };
            if depth < kind.depth_mm || !within {
                continue;
            }
            card(mesh, scalp, kind, root, depth, &mut dice);
        }
    }
}

fn between([low, high]: [f32; 2], share: f32) -> f32 {
    low + (high - low) * share
}

/// How far along the growth hair of that length stays within the hairline, mm.
fn within(scalp: &Scalp, root: Vec3, length: f32) -> f32 {
    const STEP: f32 = 2.0;
    let mut foot = root;
    let mut gone = 0.0;
    while gone < length {
        foot = scalp.under(foot + style::growth(foot, scalp).along * STEP);
        if scalp.depth_mm(foot) < -OVER_MM {
            break;
        }
        gone += STEP;
    }
    gone.min(length)
}

/// One card from its root, along the growth.
fn card(mesh: &mut Mesh, scalp: &Scalp, kind: &Kind, root: Vec3, depth: f32, dice: &mut Dice) {
    let Growth { length_mm, .. } = style::growth(root, scalp);
    // Hair at the very edge is shorter and finer.
    let edge = ramp(-2.0, 9.0, depth);
    let mut length = length_mm * between(kind.length, dice.roll()) * (0.62 + 0.38 * edge);
    if style::top(root) < SHORT {
        // Clipped where hair ends.
        length = within(scalp, root, length);
        if length < LEAST_MM && kind.region == Region::Short {
            return;
        }
    }
    let width = between(kind.width_mm, dice.roll()) * (0.7 + 0.3 * edge);
    // Short hair in narrow cards: none is wider than long.
    let width = width
        .min(1.6 + 0.34 * length)
        .min(2.6 + 0.8 * depth.max(0.0));
    let steps = ((length / STEP_MM).ceil() as usize).clamp(2, kind.steps);
    let layer = between(kind.layer, dice.roll());
    let lift = between(kind.lift, dice.roll() * dice.roll()) * length;
    let lean = kind.stray * dice.spread();
    let fall = kind.fall * (0.4 + 0.9 * dice.roll());
    let column = kind.columns.0 + (dice.roll() * kind.columns.1 as f32) as usize;
    let flip = dice.roll() < 0.5;
    let light = 0.93 + 0.07 * dice.roll();
    // Short hair hides no roots.
    let root_light = 0.9 + (kind.root_light - 0.9) * style::top(root);
    let round = if kind.region == Region::Short {
        0.15
    } else {
        0.45
    };

    let base = mesh.positions.len() as u32;
    let step = length / steps as f32;
    let mut foot = root;
    let mut heading = Vec3::ZERO;
    for i in 0..=steps {
        let v = i as f32 / steps as f32;
        let growth = style::growth(foot, scalp);
        let normal = scalp.normal(foot);
        let across = normal.cross(growth.along);
        let falling = vec3(-0.15, -0.8, 0.3) * fall;
        let wanted = (growth.along + across * lean + falling).normalize_or(growth.along);
        // Hair bends slowly.
        heading = if i == 0 {
            wanted
        } else {
            heading.lerp(wanted, 0.6)
        };
        heading = (heading - normal * heading.dot(normal)).normalize_or(wanted);
        let width_dir = normal.cross(heading);
        // From the skin up to its layer, shingled: tips lie over the roots that follow.
        let stand = 0.30 + 0.70 * ramp(0.0, 0.45, v);
        // Where it lies over bare skin it still stands off it a little.
        let height =
            (style::height_mm(foot, scalp) * layer * stand).max(2.2 * v) + lift * v * v + 0.3;
        let clear = between(CLEAR_MM, v.min(0.5) * 2.0) * (0.6 + 0.8 * light);
        let height = if kind.region == Region::Short {
            height.min(style::height_mm(foot, scalp) * layer + 0.6)
        } else {
            height
        };
        let height = height.max(cap::height_mm(foot, scalp) + clear);
        let place = foot + normal * height;
        // Locks draw together at both ends; the dense layer hardly does.
        let fan = if kind.region == Region::Short {
            1.0
        } else if kind.columns.0 < DENSE {
            1.0 - 0.25 * v
        } else {
            (0.5 + 0.5 * ramp(0.0, 0.4, v)) * (1.0 - 0.55 * v)
        };
        for (side, u) in [(-1.0, 0.0), (1.0, 1.0)] {
            mesh.positions
                .push(place + width_dir * (0.5 * width * side * fan));
            // Rounded like a lock.
            mesh.normals
                .push((normal + width_dir * (round * side) + heading * 0.08).normalize_or(normal));
            let u = if flip { 1.0 - u } else { u };
            mesh.uvs
                .push(vec2((column as f32 + 0.04 + 0.92 * u) / COLUMNS as f32, v));
            let deep = root_light + (1.0 - root_light) * ramp(0.0, 0.7, v);
            mesh.occlusion.push(deep * light);
        }
        if i > 0 {
            let a = base + 2 * (i as u32 - 1);
            // Counter-clockwise from outside.
            mesh.triangles.push([a, a + 2, a + 3]);
            mesh.triangles.push([a, a + 3, a + 1]);
        }
        foot = scalp.under(foot + heading * step);
    }
}
