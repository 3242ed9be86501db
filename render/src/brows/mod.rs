//! Brows as single hairs that stand off the skin and move with it: raised by the frontalis, drawn together by the
//! corrugator. Where pixels have several samples; where they have one the painted brow is all there is.
//!
//! Hairs grow between the head's own lines `brow_lower_*` and `brow_upper_*`, as the painted ones of the head shop do, so that
//! fitted heads get them too; a head without these lines has none. They grow only where the head's colour shows a brow,
//! and take their colour from it: a photographed brow keeps its shape and hue and gains relief, a shaved or fair one
//! gets few or none. What is painted stays as the shade between them.
//!
//! Root, middle and tip each lie over a place of a drawn triangle and are raised along the skin's normal there, so that a
//! hair neither leaves the skin nor sinks into it however the skin is bent. What this does not do: hairs do not keep
//! their length to the hair's breadth where skin is pressed together, and do not push each other aside.

mod growth;
mod shown;

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};
use mouthpiece_rig::Head;

use crate::gpu_data::{octahedral, unorm};
use crate::maps::CHART_MM;
use crate::surface::SkinGeometry;
use growth::{Bed, Hair};
use shown::Shown;

/// Vertices of a hair: a pair at root, middle and tip.
const PAIRS: usize = 3;
/// What a colour is multiplied by to fill a byte: hair is dark. Keep in step with shaders/brow.wgsl.
const COLOUR_SCALE: f32 = 4.0;
/// Thickness that is written as 1, against the mean hair's. Keep in step with shaders/brow.wgsl.
const THICK_MOST: f32 = 2.0;
/// How far off the skin a root and a middle are: the root a little, since the drawn skin is flat between its points.
const ROOT_OFF_MM: f32 = 0.05;
const MIDDLE_OFF: f32 = 0.75;

/// What moves of a vertex: place in the head's frame, mm; which way the hair runs and the skin faces (see `octahedral`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct BrowMoving {
    position: [f32; 3],
    directions: [u8; 4],
}

/// What stays of it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct BrowStill {
    /// Which side of the hair (0, 255), from root to tip, tone, what cover is rounded with; 255 is 1.
    shares: [u8; 4],
    /// The hair's colour, linear, times [`COLOUR_SCALE`]; how thick it is over [`THICK_MOST`].
    colour: [u8; 4],
}

pub(crate) const BROW_MOVING: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<BrowMoving>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Unorm8x4],
};

pub(crate) const BROW_STILL: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<BrowStill>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![2 => Unorm8x4, 3 => Unorm8x4],
};

/// A place on a drawn triangle, and how far off it, mm.
#[derive(Clone, Copy, Debug)]
struct Held {
    points: [u32; 3],
    shares: [f32; 3],
    off: f32,
}

impl Held {
    /// The place and the skin's normal there.
    fn on(&self, points: &[Vec3], normals: &[Vec3]) -> (Vec3, Vec3) {
        let mix = |values: &[Vec3]| -> Vec3 {
            let [a, b, c] = self.points.map(|i| values[i as usize]);
            let [p, q, r] = self.shares;
            a * p + b * q + c * r
        };
        let normal = mix(normals).normalize_or(Vec3::Z);
        (mix(points) + normal * self.off, normal)
    }
}

/// The hairs of both brows, as ribbons without width, which the shader gives them.
#[derive(Debug, Default)]
pub(crate) struct Brows {
    hairs: Vec<[Held; PAIRS]>,
    /// Filled anew each frame.
    pub(crate) moving: Vec<BrowMoving>,
    pub(crate) still: Vec<BrowStill>,
    pub(crate) indices: Vec<u32>,
}

impl Brows {
    /// Those of `head`, whose skin is drawn as `skin`.
    pub(crate) fn of(head: &Head, skin: &SkinGeometry) -> Self {
        let mut brows = Self::default();
        for (side, seed) in [("l", 71), ("r", 72)] {
            let Some(bed) = Bed::of(head, side) else {
                continue;
            };
            let shown = Shown::of(head.colour.as_ref(), &bed);
            let hairs = bed.hairs(seed, |along, root| shown.at(along, root));
            let ground = Ground::under(skin, &hairs);
            for hair in &hairs {
                brows.grow(hair, &ground, shown.colour);
            }
        }
        brows.moving = vec![BrowMoving::default(); brows.still.len()];
        brows.set(skin);
        brows
    }

    /// Adds a hair, where there is skin under all of it.
    fn grow(&mut self, hair: &Hair, ground: &Ground, colour: Vec3) {
        let off = [ROOT_OFF_MM, MIDDLE_OFF * hair.off, hair.off];
        let [Some(root), Some(middle), Some(tip)] =
            std::array::from_fn(|k| ground.hold(hair.places[k], off[k]))
        else {
            return;
        };
        let base = self.still.len() as u32;
        self.hairs.push([root, middle, tip]);
        let [r, g, b] = (colour * COLOUR_SCALE).to_array().map(unorm);
        let colour = [r, g, b, unorm(hair.thick / THICK_MOST)];
        for pair in 0..PAIRS {
            let along = pair as f32 / (PAIRS - 1) as f32;
            for side in [0.0, 1.0] {
                self.still.push(BrowStill {
                    shares: [side, along, hair.tone, hair.chance].map(unorm),
                    colour,
                });
            }
        }
        for a in (base..).step_by(2).take(PAIRS - 1) {
            self.indices
                .extend([a, a + 2, a + 3].into_iter().chain([a, a + 3, a + 1]));
        }
    }

    /// Lets the hairs follow the skin as it is now. Allocates nothing.
    pub(crate) fn set(&mut self, skin: &SkinGeometry) {
        let (points, normals) = (skin.points(), skin.normals());
        for (hair, out) in self
            .hairs
            .iter()
            .zip(self.moving.chunks_exact_mut(2 * PAIRS))
        {
            let at = hair.map(|held| held.on(points, normals));
            let [root, middle, tip] = at.map(|(place, _)| place);
            let along = [middle - root, tip - root, tip - middle];
            for ((pair, (place, normal)), along) in out.chunks_exact_mut(2).zip(at).zip(along) {
                let [tx, ty] = octahedral(along);
                let [nx, ny] = octahedral(normal);
                pair.fill(BrowMoving {
                    position: place.to_array(),
                    directions: [tx, ty, nx, ny],
                });
            }
        }
    }
}

/// The drawn triangles near a brow, on the chart.
#[derive(Debug)]
struct Ground {
    triangles: Vec<([u32; 3], [Vec2; 3])>,
}

impl Ground {
    fn under(skin: &SkinGeometry, hairs: &[Hair]) -> Self {
        let places = || hairs.iter().flat_map(|hair| hair.places);
        let low = places().fold(Vec2::INFINITY, Vec2::min);
        let high = places().fold(Vec2::NEG_INFINITY, Vec2::max);
        let points = skin.points().len() as u32;
        let triangles = skin
            .indices
            .chunks_exact(3)
            // Copies lie at the chart's cuts, which no brow crosses.
            .filter(|t| t.iter().all(|i| *i < points))
            .filter_map(|t| {
                let numbers = [t[0], t[1], t[2]];
                let uv = numbers.map(|i| Vec2::from(skin.still[i as usize].uv) * CHART_MM);
                let [a, b, c] = uv;
                let near = a.max(b).max(c).cmpge(low).all() && a.min(b).min(c).cmple(high).all();
                near.then_some((numbers, uv))
            })
            .collect();
        Self { triangles }
    }

    /// The triangle under a place, and where on it that is.
    fn hold(&self, place: Vec2, off: f32) -> Option<Held> {
        self.triangles.iter().find_map(|(points, [a, b, c])| {
            // Most are elsewhere: that is seen without a division.
            if (place.x < a.x.min(b.x).min(c.x)) | (place.x > a.x.max(b.x).max(c.x)) {
                return None;
            }
            let area = (*b - *a).perp_dot(*c - *a);
            if area.abs() < 1e-9 {
                return None;
            }
            let second = (place - *a).perp_dot(*c - *a) / area;
            let third = (*b - *a).perp_dot(place - *a) / area;
            let shares = [1.0 - second - third, second, third];
            shares.iter().all(|s| *s >= -1e-4).then_some(Held {
                points: *points,
                shares,
                off,
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tier::Tier;
    use mouthpiece_rig::{Control, Controls, KeyFrame, STEP_TICKS, Simulation, TICK_RATE};
    use std::sync::Arc;

    fn drawn(head: &Head) -> (SkinGeometry, Brows) {
        let skin = SkinGeometry::of(head, Tier::Medium.detail().smoothness).unwrap();
        let brows = Brows::of(head, &skin);
        (skin, brows)
    }

    /// How far each hair's root, middle and tip is above the drawn skin, mm: none where no triangle lies under it.
    fn above(skin: &SkinGeometry, brows: &Brows) -> Vec<[Option<f32>; PAIRS]> {
        let points = skin.points();
        let triangles: Vec<[Vec3; 3]> = skin
            .indices
            .chunks_exact(3)
            .filter(|t| t.iter().all(|i| (*i as usize) < points.len()))
            .map(|t| [t[0], t[1], t[2]].map(|i| points[i as usize]))
            .filter(|[a, ..]| a.z > 60.0 && a.y > 30.0)
            .collect();
        let height = |p: Vec3| {
            triangles
                .iter()
                .filter_map(|[a, b, c]| {
                    let up = (b - a).cross(c - a);
                    // A little past the sides: between two triangles there is a gap above a ridge.
                    let inside = [[a, b], [b, c], [c, a]].iter().all(|[from, to]| {
                        let share = (*to - *from).cross(p - *from).dot(up);
                        share >= -0.2 * up.length_squared()
                    });
                    inside.then(|| (p - *a).dot(up.normalize_or_zero()))
                })
                .min_by(|a, b| a.abs().total_cmp(&b.abs()))
        };
        let place = |pair: &[BrowMoving]| Vec3::from(pair[0].position);
        brows
            .moving
            .chunks_exact(2 * PAIRS)
            .map(|hair| std::array::from_fn(|k| height(place(&hair[2 * k..]))))
            .collect()
    }

    fn assert_on_skin(skin: &SkinGeometry, brows: &Brows) {
        for [root, middle, tip] in above(skin, brows) {
            let (root, middle, tip) = (root.unwrap(), middle.unwrap(), tip.unwrap());
            assert!((-0.1..0.2).contains(&root), "a root {root} mm off the skin");
            assert!((0.0..1.4).contains(&middle), "a hair {middle} mm off it");
            assert!((0.0..1.9).contains(&tip), "a tip {tip} mm off it");
        }
    }

    fn mean_height(brows: &Brows) -> f32 {
        let sum: f32 = brows.moving.iter().map(|v| v.position[1]).sum();
        sum / brows.moving.len() as f32
    }

    #[test]
    fn hairs_stay_on_the_skin_when_brows_are_raised_or_drawn_together() {
        let head = Arc::new(Head::reference().unwrap());
        let (mut skin, mut brows) = drawn(&head);
        let count = brows.hairs.len();
        assert!((200..700).contains(&count), "{count} hairs");
        assert_on_skin(&skin, &brows);
        let rest = mean_height(&brows);
        for (pulled, least, most) in [
            (["frontalis_inner", "frontalis_outer"], 2.0, 15.0),
            (["corrugator_supercilii", "procerus"], -8.0, -0.5),
        ] {
            let mut controls = Controls::default();
            for name in pulled {
                controls[Control::from_name(name).unwrap()] = 1.0;
            }
            let mut simulation = Simulation::new(Arc::clone(&head));
            for _ in 0..TICK_RATE / 2 / STEP_TICKS {
                simulation.step(&controls);
            }
            let mut frame = KeyFrame::default();
            simulation.save(&mut frame);
            skin.set(&frame.skin);
            brows.set(&skin);
            assert_on_skin(&skin, &brows);
            let raised = mean_height(&brows) - rest;
            assert!((least..most).contains(&raised), "{pulled:?}: {raised} mm");
        }
    }

    #[test]
    fn a_face_whose_colour_shows_no_brows_or_that_has_no_lines_for_them_grows_none() {
        let mut head = Head::reference().unwrap();
        let map = head.colour.as_mut().unwrap();
        for texel in map.rgb.chunks_exact_mut(3) {
            texel.copy_from_slice(&[204, 154, 132]);
        }
        assert!(drawn(&head).1.hairs.is_empty());
        let mut head = Head::reference().unwrap();
        head.features.retain(|f| !f.name.starts_with("brow"));
        assert!(drawn(&head).1.hairs.is_empty());
    }

    #[test]
    fn hairs_have_the_colour_of_the_brow_that_the_head_shows() {
        let hue = |head: &Head| {
            let (_, brows) = drawn(head);
            brows.still[0].colour
        };
        let mut head = Head::reference().unwrap();
        let dark = hue(&head);
        let map = head.colour.as_mut().unwrap();
        for texel in map.rgb.chunks_exact_mut(3) {
            // A fair brow: half way to the skin.
            texel[0] = 100 + texel[0] / 2;
        }
        assert!(hue(&head)[0] > dark[0] + 20, "{:?} {dark:?}", hue(&head));
    }
}
