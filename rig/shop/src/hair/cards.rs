//! Ribbons of strands, laid along the growth from many roots: dense ones that cover, loose locks over
//! them, and single hairs that break the outline.

use glam::{Vec3, vec2, vec3};
use mouthpiece_rig::Mesh;

use super::scalp::Scalp;
use super::style::{self, Growth};
use super::{COLUMNS, DENSE, LOOSE};
use crate::noise::Dice;
use crate::noise::ramp;

/// One kind of card.
#[derive(Clone, Copy, Debug)]
struct Kind {
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

const KINDS: [Kind; 5] = [
    // Thin locks that fall over the edge of the forehead.
    Kind {
        tries: 3200,
        depth_mm: 0.0,
        width_mm: [2.5, 6.0],
        length: [0.40, 0.72],
        layer: [0.7, 1.0],
        lift: [0.0, 0.05],
        fall: 0.75,
        stray: 0.7,
        columns: (DENSE + 1, LOOSE - 1),
        steps: 4,
        root_light: 0.75,
        seed: 70,
    },
    // Single hairs off the outline.
    Kind {
        tries: 260,
        depth_mm: 2.0,
        width_mm: [1.2, 2.4],
        length: [0.55, 1.0],
        layer: [0.9, 1.15],
        lift: [0.05, 0.22],
        fall: 0.0,
        stray: 0.5,
        columns: (DENSE + LOOSE, COLUMNS - DENSE - LOOSE),
        steps: 4,
        root_light: 0.8,
        seed: 71,
    },
    // Short hair along the hairline, rooted on both sides of it.
    Kind {
        tries: 2800,
        depth_mm: -2.5,
        width_mm: [2.2, 4.6],
        length: [0.5, 0.85],
        layer: [0.8, 1.2],
        lift: [0.0, 0.10],
        fall: 0.0,
        stray: 0.6,
        columns: (DENSE + 1, LOOSE - 1),
        steps: 3,
        root_light: 0.8,
        seed: 72,
    },
    // Loose locks over the dense layer.
    Kind {
        tries: 600,
        depth_mm: 5.0,
        width_mm: [5.0, 9.0],
        length: [0.75, 1.15],
        layer: [0.9, 1.03],
        lift: [0.0, 0.04],
        fall: 0.0,
        stray: 0.3,
        columns: (DENSE, 1),
        steps: 5,
        root_light: 0.7,
        seed: 73,
    },
    // The dense layer.
    Kind {
        tries: 1000,
        depth_mm: 3.0,
        width_mm: [11.0, 16.0],
        length: [0.75, 1.05],
        layer: [0.80, 0.95],
        lift: [0.0, 0.03],
        fall: 0.0,
        stray: 0.16,
        columns: (0, DENSE),
        steps: 4,
        root_light: 0.45,
        seed: 74,
    },
];

/// Longest step of a card, mm: the head curves away under longer ones.
const STEP_MM: f32 = 10.0;
/// How deep within the hairline the short hair of its edge grows.
const EDGE_MM: f32 = 8.0;
/// Number of the kind that does.
const EDGE: usize = 2;
/// How deep those that fall over the forehead grow.
const FRINGE_MM: f32 = 12.0;

/// Adds all cards, outermost kinds first.
pub(super) fn grow(mesh: &mut Mesh, scalp: &Scalp) {
    for (number, kind) in KINDS.iter().enumerate() {
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
            let fringe = depth < FRINGE_MM && root.z > 45.0 && root.y > 78.0 && root.x < 36.0;
            if depth < kind.depth_mm
                || (number == EDGE && depth > EDGE_MM)
                || (kind.fall > 0.0 && !fringe)
            {
                continue;
            }
            card(mesh, scalp, kind, root, depth, &mut dice);
        }
    }
}

fn between([low, high]: [f32; 2], share: f32) -> f32 {
    low + (high - low) * share
}

/// One card from its root, along the growth.
fn card(mesh: &mut Mesh, scalp: &Scalp, kind: &Kind, root: Vec3, depth: f32, dice: &mut Dice) {
    let Growth { length_mm, .. } = style::growth(root, scalp);
    // Hair at the very edge is shorter and finer.
    let edge = ramp(-2.0, 9.0, depth);
    let length = length_mm * between(kind.length, dice.roll()) * (0.62 + 0.38 * edge);
    let width = between(kind.width_mm, dice.roll()) * (0.7 + 0.3 * edge);
    // Short hair in narrow cards: none is wider than long.
    let width = width.min(1.6 + 0.34 * length);
    let steps = ((length / STEP_MM).ceil() as usize).clamp(2, kind.steps);
    let layer = between(kind.layer, dice.roll());
    let lift = between(kind.lift, dice.roll() * dice.roll()) * length;
    let lean = kind.stray * dice.spread();
    let fall = kind.fall * (0.4 + 0.9 * dice.roll());
    let column = kind.columns.0 + (dice.roll() * kind.columns.1 as f32) as usize;
    let flip = dice.roll() < 0.5;
    let light = 0.90 + 0.10 * dice.roll();

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
        let place = foot + normal * height;
        // Locks draw together at both ends; the dense layer hardly does.
        let fan = if kind.columns.0 < DENSE {
            1.0 - 0.25 * v
        } else {
            (0.5 + 0.5 * ramp(0.0, 0.4, v)) * (1.0 - 0.55 * v)
        };
        for (side, u) in [(-1.0, 0.0), (1.0, 1.0)] {
            mesh.positions
                .push(place + width_dir * (0.5 * width * side * fan));
            // Rounded like a lock.
            mesh.normals
                .push((normal + width_dir * (0.45 * side) + heading * 0.12).normalize_or(normal));
            let u = if flip { 1.0 - u } else { u };
            mesh.uvs
                .push(vec2((column as f32 + 0.04 + 0.92 * u) / COLUMNS as f32, v));
            let deep = kind.root_light + (1.0 - kind.root_light) * ramp(0.0, 0.7, v);
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
