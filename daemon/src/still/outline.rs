//! `still --outline`: where in the picture lips, lids and landmarks lie, for whoever composites the
//! face or compares it with what a face tracker finds (`tests/mediapipe_check.py`).
//!
//! Points are those of the drawn surface, seen by the picture's camera, in pixels from its upper left
//! corner. What hides behind nearer skin, as the far side does in a side view, is listed all the same.

use std::collections::BTreeMap;

use anyhow::Context as _;
use glam::{Mat4, Vec2, Vec3, vec2};
use mouthpiece_render::{Extent, View};
use mouthpiece_rig::{Body, Head, KeyFrame, LIP_LEVELS, Layer, lip_level};
use serde::Serialize;

/// A point of the picture, pixels: across and down.
type Pixel = [f32; 2];

/// What is written.
#[derive(Debug, Serialize)]
pub struct Outline {
    /// Width and height of the picture.
    size: [u32; 2],
    lips: Lips,
    lids: Sides<Lids>,
    /// Farkas's points on the skin by name.
    landmarks: BTreeMap<String, Pixel>,
}

/// Closed lines: from the subject's right corner along the upper lip to the left one, back along the
/// lower lip.
#[derive(Debug, Serialize)]
struct Lips {
    /// The vermilion border.
    outer: Vec<Pixel>,
    /// Where the lips touch; flat while they do.
    inner: Vec<Pixel>,
}

/// One for each of the subject's sides.
#[derive(Debug, Serialize)]
struct Sides<T> {
    left: T,
    right: T,
}

/// Margins of the lids, from the picture's left to its right.
#[derive(Debug, Default, Serialize)]
struct Lids {
    upper: Vec<Pixel>,
    lower: Vec<Pixel>,
}

/// Measures the picture of `frame`.
pub fn outline(
    head: &Head,
    frame: &KeyFrame,
    view: &View,
    size: (u32, u32),
) -> anyhow::Result<Outline> {
    let mut skin = vec![Vec3::ZERO; frame.skin.len()];
    head.skin_limit()
        .context("the head's skin cannot be drawn")?
        .apply(&frame.skin, &mut skin);
    let picture = Picture::new(head, frame, view, size);
    let pixels: Vec<Vec2> = skin
        .iter()
        .zip(&head.skin.weight)
        .map(|(p, weight)| picture.of(*p, *weight))
        .collect();
    let at = |vertex: u32| pixels.get(vertex as usize).map_or([0.0; 2], Vec2::to_array);
    let loop_of = |level: usize| {
        let along = |column: &[u32; LIP_LEVELS]| at(column[level]);
        let upper = head.lips.upper.iter().map(along);
        // The corners are the upper lip's too.
        let inner = head.lips.lower.len().saturating_sub(1);
        let lower = head.lips.lower.iter().take(inner).skip(1).rev().map(along);
        upper.chain(lower).collect()
    };
    let landmarks = head.landmarks.iter().filter(|l| l.layer == Layer::Skin);
    Ok(Outline {
        size: size.into(),
        lips: Lips {
            outer: loop_of(lip_level::BORDER),
            inner: loop_of(lip_level::CONTACT),
        },
        lids: Sides {
            left: lids(head, true, &at),
            right: lids(head, false, &at),
        },
        landmarks: landmarks
            .map(|l| {
                let sum: Vec2 =
                    l.at.vertices
                        .iter()
                        .zip(l.at.shares)
                        .map(|(v, share)| Vec2::from(at(*v)) * share)
                        .sum();
                (l.name.clone(), sum.to_array())
            })
            .collect(),
    })
}

/// The margins: what a lid holds wholly of the skin that stays dry, where it turns wet.
fn lids(head: &Head, left: bool, at: &dyn Fn(u32) -> Pixel) -> Lids {
    let mut lids = Lids::default();
    let on_margin = |vertex: u32| head.skin.creases.iter().flatten().any(|v| *v == vertex);
    for lid in &head.lids {
        if lid.left != left || lid.hold < 0.99 || !on_margin(lid.vertex) {
            continue;
        }
        // Lower lids turn up.
        let margin = if lid.turn > 0.0 {
            &mut lids.lower
        } else {
            &mut lids.upper
        };
        margin.push(at(lid.vertex));
    }
    lids.upper.sort_by(|a, b| a[0].total_cmp(&b[0]));
    lids.lower.sort_by(|a, b| a[0].total_cmp(&b[0]));
    lids
}

/// From the head's frame to pixels.
struct Picture {
    clip_from_world: Mat4,
    trunk: Mat4,
    skull: Mat4,
    size: Vec2,
}

impl Picture {
    fn new(head: &Head, frame: &KeyFrame, view: &View, size: (u32, u32)) -> Self {
        let bodies = head.bodies(&frame.state);
        Self {
            clip_from_world: Extent::of(head).frame(view.camera, size).clip_from_world,
            trunk: bodies[Body::Trunk as usize].into(),
            skull: bodies[Body::Skull as usize].into(),
            size: vec2(size.0 as f32, size.1 as f32),
        }
    }

    /// `weight` is the share of the skull against the trunk.
    fn of(&self, skin: Vec3, weight: f32) -> Vec2 {
        let world = self
            .trunk
            .transform_point3(skin)
            .lerp(self.skull.transform_point3(skin), weight);
        let clip = self.clip_from_world.project_point3(world);
        vec2(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y) * self.size
    }
}
