//! Landmarks as dots in the picture, and what a pointing device does to them.

use glam::{Vec2, Vec3};

use super::{Marking, State};
use crate::closest::Facing;

/// A dot counts as hidden if the scan is in front of it by more than this share of the distance to the eye: dots sit on
/// the surface itself.
const BEHIND: f32 = 0.012;

/// A landmark in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dot {
    /// Which.
    pub landmark: usize,
    /// Pixels from the upper left.
    pub at: Vec2,
    /// Where it stands.
    pub state: State,
    /// Whether the scan is in front of it.
    pub hidden: bool,
}

/// What a click did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Placed {
    /// The selected landmark is on the scan now.
    OnScan,
    /// There is no scan under the pixel: the landmark is at the depth it had before.
    MidAir,
    /// There is no scan under the pixel, and no depth to keep.
    Nowhere,
}

/// A landmark that is being dragged.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drag {
    landmark: usize,
    /// From the pixel pressed to the landmark's own, so that it does not jump.
    offset: Vec2,
    /// Whose depth it keeps where there is no scan.
    depth: Vec3,
    moved: bool,
}

impl Marking {
    /// All landmarks whose places are known and in front of the eye.
    #[must_use]
    pub fn dots(&self, size: Vec2) -> Vec<Dot> {
        (0..self.count())
            .filter_map(|landmark| {
                let place = self.place(landmark)?;
                Some(Dot {
                    landmark,
                    at: self.camera.pixel_of(place, size)?,
                    state: self.state(landmark),
                    hidden: self.is_hidden(place),
                })
            })
            .collect()
    }

    fn is_hidden(&self, place: Vec3) -> bool {
        let eye = self.camera.eye();
        let length = eye.distance(place);
        let way = (place - eye).normalize_or_zero();
        let clear = length * (1.0 - BEHIND);
        self.scan.ray(eye, way, clear, Facing::ANY).is_some()
    }

    /// The dot nearest to the pixel, within `reach` pixels; visible ones first.
    #[must_use]
    pub fn dot_at(&self, at: Vec2, size: Vec2, reach: f32) -> Option<usize> {
        self.dots(size)
            .into_iter()
            .filter(|dot| !dot.hidden && dot.at.distance(at) <= reach)
            .min_by(|a, b| a.at.distance(at).total_cmp(&b.at.distance(at)))
            .map(|dot| dot.landmark)
    }

    /// Places the selected landmark under the pixel; with `in_air` at the depth that it has, whatever is there.
    pub fn click(&mut self, at: Vec2, size: Vec2, in_air: bool) -> Placed {
        let selected = self.selected();
        let depth = self.place(selected);
        let (place, placed) = match (self.pick(at, size).filter(|_| !in_air), depth) {
            (Some(place), _) => (place, Placed::OnScan),
            (None, Some(depth)) => match self.camera.on_plane(at, size, depth) {
                Some(place) => (place, Placed::MidAir),
                None => return Placed::Nowhere,
            },
            (None, None) => return Placed::Nowhere,
        };
        self.set(selected, place);
        placed
    }

    /// Takes hold of the dot under the pixel and selects it; false if there is none.
    pub fn press(&mut self, at: Vec2, size: Vec2, reach: f32) -> bool {
        self.release();
        let Some(landmark) = self.dot_at(at, size, reach) else {
            return false;
        };
        let Some(depth) = self.place(landmark) else {
            return false;
        };
        self.select(landmark);
        let pixel = self.camera.pixel_of(depth, size).unwrap_or(at);
        self.drag = Some(Drag {
            landmark,
            offset: pixel - at,
            depth,
            moved: false,
        });
        true
    }

    /// Moves what was taken hold of: along the scan, or in the view's plane with `in_air` and where there is no scan.
    pub fn drag(&mut self, at: Vec2, size: Vec2, in_air: bool) {
        let Some(mut drag) = self.drag else {
            return;
        };
        let pixel = at + drag.offset;
        let on_scan = self.pick(pixel, size).filter(|_| !in_air);
        let Some(place) = on_scan.or_else(|| self.camera.on_plane(pixel, size, drag.depth)) else {
            return;
        };
        if !drag.moved {
            // The whole drag is one deed.
            self.remember();
            drag.moved = true;
        }
        drag.depth = place;
        self.drag = Some(drag);
        self.set[drag.landmark] = Some(place);
        self.renew();
    }

    /// Lets go; false if nothing was moved.
    pub fn release(&mut self) -> bool {
        let Some(drag) = self.drag.take() else {
            return false;
        };
        if drag.moved {
            let now = self.set.clone();
            self.history.forget_if_same(&now);
            self.renew();
        }
        drag.moved
    }

    /// Whether a dot is held.
    #[must_use]
    pub fn is_dragging(&self) -> bool {
        self.drag.is_some()
    }
}
