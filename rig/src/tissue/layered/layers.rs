//! Where fascia and skull lie under the skin: the layers that LEE 4 stacks in prisms.
//!
//! Each node of the skin has one of the fascia and one of the skull straight below it (against the skin's normal,
//! LEE 7). How deep the bone is comes from the muscles' own [`Space`]; lips and lids, which have no bone
//! within, are thin cushions instead. Where prisms would turn inside out (folds beside the nose, corners of
//! the mouth), their columns are made shallower.

use glam::Vec3;

use crate::muscle::Space;
use crate::tissue::Numbering;
use crate::{Head, Mesh};

/// The tissue between skin and bone is taken to be this deep at least and at most, mm: thinner has no room
/// for two layers, and deeper lies cheek fat that no prism of LEE's describes.
const DEPTH_MM: [f32; 2] = [2.4, 9.0];
/// Depth of lips and lids, mm.
const CUSHION_MM: f32 = 3.2;
/// The fascia lies this share of the way from skin to bone.
const FASCIA: f32 = 0.5;
/// The fascia's triangle under one of the skin has this share of its area at least, and faces as it does.
const AREA_LEAST: f32 = 0.3;
/// A column that is too deep for its prisms is shortened by this factor at a time, so often at most.
const SHORTER: f32 = 0.8;
const ROUNDS: usize = 14;

/// Per node: places at rest and the direction outwards.
pub(super) struct Layers {
    pub skin: Vec<Vec3>,
    pub fascia: Vec<Vec3>,
    pub skull: Vec<Vec3>,
    pub out: Vec<Vec3>,
    /// 1 on lips and lids, 0 over bone.
    pub tender: Vec<f32>,
    /// Triangles of nodes of which one at least moves, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Layers {
    pub(super) fn new(head: &Head, numbering: &Numbering) -> Self {
        let mesh = &head.skin.mesh;
        let skin = numbering.of(&mesh.positions);
        let out = numbering.of(&mesh.normals);
        let bones: Vec<&Mesh> = ["skull", "mandible"]
            .iter()
            .filter_map(|name| head.part(name).map(|part| &part.mesh))
            .collect();
        let space = Space::new(bones);
        let mut lids = vec![0.0_f32; mesh.positions.len()];
        for lid in &head.lids {
            lids[lid.vertex as usize] = lid.hold;
        }
        let tender: Vec<f32> = numbering
            .vertices
            .iter()
            .map(|&v| {
                let v = v as usize;
                head.skin.vermilion[v].max(head.skin.wet[v]).max(lids[v])
            })
            .collect();
        let mut depth: Vec<f32> = skin
            .iter()
            .zip(&tender)
            .map(|(p, tender)| {
                let depth = space.under(*p).1.clamp(DEPTH_MM[0], DEPTH_MM[1]);
                depth + (CUSHION_MM.min(depth) - depth) * tender
            })
            .collect();
        even(&mut depth, numbering);
        let triangles = triangles(head, numbering);
        for _ in 0..ROUNDS {
            if !shorten(&mut depth, &skin, &out, &triangles) {
                break;
            }
        }
        let below = |share: f32| -> Vec<Vec3> {
            let places = skin.iter().zip(&out).zip(&depth);
            places.map(|((p, n), d)| *p - *n * (d * share)).collect()
        };
        Self {
            fascia: below(FASCIA),
            skull: below(1.0),
            skin,
            out,
            tender,
            triangles,
        }
    }
}

/// The skin's triangles that move, as nodes.
fn triangles(head: &Head, numbering: &Numbering) -> Vec<[u32; 3]> {
    let mut node = vec![u32::MAX; head.skin.mesh.positions.len()];
    for (i, &v) in (0..).zip(&numbering.vertices) {
        node[v as usize] = i;
    }
    let moves = |t: &[u32; 3]| t.iter().any(|&i| (i as usize) < numbering.movable);
    let nodes = head.skin.mesh.triangles.iter();
    let mut triangles: Vec<[u32; 3]> = nodes.map(|t| t.map(|v| node[v as usize])).collect();
    triangles.retain(moves);
    // As the nodes lie in memory.
    triangles.sort_by_key(|t| t.iter().min().copied());
    triangles
}

/// Twice the mean with the neighbours, so that no column stands out of its surroundings.
fn even(depth: &mut [f32], numbering: &Numbering) {
    for _ in 0..2 {
        let mut sums: Vec<(f32, f32)> = depth.iter().map(|d| (*d, 1.0)).collect();
        for [a, b] in numbering.edges.iter().map(|e| e.map(|i| i as usize)) {
            sums[a] = (sums[a].0 + depth[b], sums[a].1 + 1.0);
            sums[b] = (sums[b].0 + depth[a], sums[b].1 + 1.0);
        }
        for (d, (sum, count)) in depth.iter_mut().zip(sums) {
            *d = sum / count;
        }
    }
}

/// Shortens the columns of prisms that the fascia closes too much; says whether there were any.
fn shorten(depth: &mut [f32], skin: &[Vec3], out: &[Vec3], triangles: &[[u32; 3]]) -> bool {
    let area = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a);
    let mut bad = vec![false; depth.len()];
    for t in triangles {
        let t = t.map(|i| i as usize);
        let above = area(t.map(|i| skin[i]));
        // The whole column, so that skull nodes are in order too.
        let below = area(t.map(|i| skin[i] - out[i] * depth[i]));
        if below.dot(above) < AREA_LEAST * above.length_squared() {
            for i in t {
                bad[i] = true;
            }
        }
    }
    for (d, _) in depth.iter_mut().zip(&bad).filter(|(_, bad)| **bad) {
        *d *= SHORTER;
    }
    bad.contains(&true)
}
