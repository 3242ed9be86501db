//! How the picture sits on the screen: closer or farther, moved, turned for a screen that hangs on
//! its side, and wandering by pixels so that nothing burns in.
//!
//! All of it is done where points become places in the picture, so none of it costs a pass, and parts
//! of a pixel move as smoothly as whole ones. Right, left, up and down are the picture's, not the
//! screen's. The room's light knows nothing of it.

use glam::{Mat4, Vec2, Vec4, vec2, vec3};

use crate::view::{Extent, Framing};

/// How far below the chin a bust is sure to be as wide as its shoulders.
const SHOULDERS_MM: f32 = 90.0;

/// The picture's place on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// 1: the head fills the picture; below, it is smaller; above, closer.
    pub zoom: f32,
    /// Where the head sits, to the right and up from where it would, shares of the picture's width
    /// and height.
    pub shift: Vec2,
    /// Quarters of a turn, clockwise.
    pub quarters: u32,
    /// How far all of it is moved now, pixels to the right and down.
    pub wander_px: Vec2,
    /// How far it is ever moved, pixels: what a picture behind the head reaches over each edge.
    pub wander_max_px: f32,
}

impl Default for Placing {
    fn default() -> Self {
        Self {
            zoom: 1.0,
            shift: Vec2::ZERO,
            quarters: 0,
            wander_px: Vec2::ZERO,
            wander_max_px: 0.0,
        }
    }
}

impl Placing {
    /// Width and height of the picture as its viewers see it, on a screen of `size`.
    #[must_use]
    pub fn upright(&self, (width, height): (u32, u32)) -> (u32, u32) {
        if self.quarters % 2 == 1 {
            (height, width)
        } else {
            (width, height)
        }
    }

    /// Cosine and sine of the turn, without the rounding of either.
    #[must_use]
    pub fn turn(&self) -> (f32, f32) {
        [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][(self.quarters % 4) as usize]
    }

    /// Puts `framing` of `extent` in an upright picture of `upright` pixels in its place.
    pub(crate) fn place(&self, framing: &mut Framing, extent: &Extent, upright: (u32, u32)) {
        let pixels = vec2(upright.0.max(1) as f32, upright.1.max(1) as f32);
        let mut moved = (self.shift + self.wander_px * vec2(1.0, -1.0) / pixels) * 2.0;
        // A smaller head stands lower: its shoulders go on beyond the picture's foot, as in any portrait.
        let lowest = vec3(0.0, extent.min.y - SHOULDERS_MM, extent.centre().z);
        let lowest = framing.clip_from_world.project_point3(lowest).y.min(-1.0);
        moved.y += (-1.0 - self.zoom * lowest).min(0.0);
        let (c, s) = self.turn();
        let zoomed = Mat4::from_cols(
            Vec4::X * self.zoom,
            Vec4::Y * self.zoom,
            Vec4::Z,
            Vec4::new(moved.x, moved.y, 0.0, 1.0),
        );
        let turned = Mat4::from_cols(
            Vec4::new(c, -s, 0.0, 0.0),
            Vec4::new(s, c, 0.0, 0.0),
            Vec4::Z,
            Vec4::W,
        );
        framing.clip_from_world = turned * zoomed * framing.clip_from_world;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Camera;
    use glam::Vec3;

    const EXTENT: Extent = Extent {
        min: vec3(-90.0, -80.0, -90.0),
        max: vec3(90.0, 145.0, 131.0),
    };

    fn shown(placing: &Placing, size: (u32, u32), point: Vec3) -> Vec2 {
        let extent = EXTENT;
        let upright = placing.upright(size);
        let mut framing = extent.frame(Camera::Front, upright);
        placing.place(&mut framing, &extent, upright);
        let clip = framing.clip_from_world.project_point3(point);
        vec2(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y) * vec2(size.0 as f32, size.1 as f32)
    }

    #[test]
    fn a_turned_picture_is_the_same_picture_turned() {
        let point = vec3(40.0, 100.0, 50.0);
        let upright = shown(&Placing::default(), (300, 400), point);
        let turned = |quarters, size| {
            let placing = Placing {
                quarters,
                ..Placing::default()
            };
            shown(&placing, size, point)
        };
        let near = |a: Vec2, b: Vec2| assert!(a.distance(b) < 0.01, "{a} {b}");
        near(turned(1, (400, 300)), vec2(400.0 - upright.y, upright.x));
        near(turned(2, (300, 400)), vec2(300.0, 400.0) - upright);
        near(turned(3, (400, 300)), vec2(upright.y, 300.0 - upright.x));
    }

    #[test]
    fn a_smaller_head_stands_on_the_picture_s_foot() {
        let below = vec3(0.0, EXTENT.min.y - SHOULDERS_MM, EXTENT.centre().z);
        for size in [(400, 300), (300, 400), (300, 900), (1600, 300)] {
            let foot = size.1 as f32;
            let as_it_was = shown(&Placing::default(), size, below).y;
            for zoom in [0.5, 0.7, 0.9, 1.0] {
                let placing = Placing {
                    zoom,
                    ..Placing::default()
                };
                let y = shown(&placing, size, below).y;
                assert!(y >= foot.min(as_it_was) - 0.01, "{y} of {foot} at {zoom}");
            }
        }
    }

    #[test]
    fn shifts_and_steps_are_as_long_as_they_say_at_any_depth() {
        let placing = Placing {
            shift: vec2(0.1, 0.2),
            wander_px: vec2(3.0, -2.0),
            ..Placing::default()
        };
        for point in [vec3(0.0, 0.0, 90.0), vec3(30.0, 60.0, -80.0)] {
            let moved =
                shown(&placing, (400, 300), point) - shown(&Placing::default(), (400, 300), point);
            assert!(moved.distance(vec2(43.0, -62.0)) < 0.01, "{moved}");
        }
    }
}
