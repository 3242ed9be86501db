//! Single hairs: short fine ones on both sides of the hairline, and those that stand off the outline. They are ribbons
//! without width, which the shader gives them. They grow as the head's cards near by do.

use glam::{Vec3, vec2};
use mouthpiece_rig::{Head, Mesh};

use super::{Card, join, push_pair};
use crate::maps::hairline::Hairline;
use crate::maps::noise::Dice;
use crate::maps::ramp;

/// Short hairs a square mm, and how far off the hairline they grow, outside and inside, mm.
const FINE_DENSITY: f32 = 0.145;
const FINE_MM: [f32; 2] = [-4.5, 3.5];
/// `uv.x` of a single hair: 2 on its left side, 6 on its right one, plus the place in the map that gives its tone. Keep in
/// step with shaders/hair.wgsl, which gives it its width.
const SINGLE: [f32; 2] = [2.0, 6.0];
/// Length up to which a hair is straight, mm.
const STRAIGHT_MM: f32 = 6.5;
/// How far from a card's root its growth is still known, mm.
const KNOWN_MM: f32 = 22.0;

/// Where cards begin and which way they grow.
pub(super) fn roots(mesh: &Mesh, cards: &[Card]) -> Vec<(Vec3, Vec3)> {
    let middle = |i: usize| 0.5 * (mesh.positions[i] + mesh.positions[i + 1]);
    cards
        .iter()
        .map(|card| {
            let root = middle(card.first);
            let along = middle(card.first + 2) - root;
            (root, along.normalize_or(Vec3::NEG_Y))
        })
        .collect()
}

/// Short fine hairs on both sides of the hairline, as the cards near by grow, shorter the farther out.
pub(super) fn grow_fine(
    out: &mut Mesh,
    head: &Head,
    hairline: &Hairline,
    roots: &[(Vec3, Vec3)],
    dice: &mut Dice,
) {
    let skin = &head.skin.mesh;
    let depth: Vec<f32> = skin.uvs.iter().map(|uv| hairline.depth_mm(*uv)).collect();
    let [outside, inside] = FINE_MM;
    for t in &skin.triangles {
        let corner = t.map(|i| i as usize);
        if corner.iter().all(|&i| depth[i] < outside) || corner.iter().all(|&i| depth[i] > inside) {
            continue;
        }
        let [a, b, c] = corner.map(|i| skin.positions[i]);
        let area = 0.5 * (b - a).cross(c - a).length();
        let count = (area * FINE_DENSITY + dice.roll()) as usize;
        for _ in 0..count {
            let (p, q) = (dice.roll(), dice.roll());
            let (p, q) = if p + q > 1.0 {
                (1.0 - p, 1.0 - q)
            } else {
                (p, q)
            };
            let mix = |v: [f32; 3]| v[0] + (v[1] - v[0]) * p + (v[2] - v[0]) * q;
            let deep = mix(corner.map(|i| depth[i]));
            let root = a + (b - a) * p + (c - a) * q;
            let edge = ramp(outside, inside, deep);
            // The farther out the fewer.
            if deep < outside || deep > inside || dice.roll() > 0.15 + edge {
                continue;
            }
            let known = roots
                .iter()
                .map(|(at, along)| (at.distance_squared(root), *along))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((_, along)) = known.filter(|k| k.0 < KNOWN_MM * KNOWN_MM) else {
                continue;
            };
            let normal = corner
                .iter()
                .map(|&i| skin.normals[i])
                .sum::<Vec3>()
                .normalize_or(Vec3::Z);
            let length = (3.0 + 7.0 * edge) * (0.7 + 0.6 * dice.roll());
            fine_hair(out, root, normal, along, length, dice);
        }
    }
}

/// One of them, from the skin and along it.
fn fine_hair(out: &mut Mesh, root: Vec3, normal: Vec3, along: Vec3, length: f32, dice: &mut Dice) {
    let first = out.positions.len();
    let flat = (along - normal * along.dot(normal)).normalize_or(normal.any_orthonormal_vector());
    let side = normal.cross(flat);
    let mut heading = (flat + side * (0.45 * dice.spread())).normalize_or(flat);
    let bend = side * (0.6 * dice.spread());
    let tone = 0.5 * dice.roll();
    let light = 0.75 + 0.2 * dice.roll();
    let mut place = root;
    // Short ones are straight.
    let steps = if length > STRAIGHT_MM { 2 } else { 1 };
    for i in 0..=steps {
        let v = i as f32 / steps as f32;
        let at = place + normal * (0.1 + 1.1 * v * (1.0 - 0.35 * v));
        push_pair(
            out,
            at,
            at,
            [normal; 2],
            SINGLE.map(|x| vec2(x + tone, v)),
            light,
        );
        heading = (heading + bend * 0.5).normalize_or(heading);
        place += heading * (length / steps as f32);
    }
    join(out, first);
}

/// A hair in place of a card that shows a few: it has the width of hairs at any distance.
pub(super) fn single(out: &mut Mesh, mesh: &Mesh, card: &Card, dice: &mut Dice) {
    let first = out.positions.len();
    let [from, to] = [dice.roll(), dice.roll()];
    let tone = 0.5 * dice.roll();
    for i in 0..card.pairs {
        let at = card.first + 2 * i;
        let v = mesh.uvs[at].y;
        let place = mesh.positions[at].lerp(mesh.positions[at + 1], from + (to - from) * v);
        push_pair(
            out,
            place,
            place,
            [(mesh.normals[at] + mesh.normals[at + 1]).normalize_or(Vec3::Y); 2],
            SINGLE.map(|x| vec2(x + tone, v)),
            mesh.occlusion[at],
        );
    }
    join(out, first);
}
