//! The camera that a person turns about a scan: numbers in, numbers out.
//!
//! Pixels run from the upper left; sizes are those of the view. A scan comes in any orientation, so the camera turns
//! freely until landmarks say where the head's top is, and about that axis from then on.

use glam::camera::rh::proj::directx;
use glam::{Mat4, Quat, Vec2, Vec3};

/// Opening of the view upwards and downwards together: that of a lens for portraits, rad.
const FOV: f32 = 0.5;

/// How nearly the camera may look along the head's axis (cosine), beyond which turning about it means nothing.
const POLE: f32 = 0.985;

/// From where to look at a head.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// Into the face.
    Front,
    /// At the back of the head.
    Back,
    /// At the subject's left.
    Left,
    /// At the subject's right.
    Right,
    /// From above, the face downwards in the picture.
    Above,
    /// From below.
    Below,
}

impl View {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Front,
        Self::Left,
        Self::Right,
        Self::Back,
        Self::Above,
        Self::Below,
    ];

    /// A word for a button.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "Front",
            Self::Back => "Back",
            Self::Left => "Left",
            Self::Right => "Right",
            Self::Above => "Above",
            Self::Below => "Below",
        }
    }

    /// The camera's turn in the head's frame.
    fn turn(self) -> Quat {
        use std::f32::consts::{FRAC_PI_2, PI};
        match self {
            Self::Front => Quat::IDENTITY,
            Self::Back => Quat::from_rotation_y(PI),
            Self::Left => Quat::from_rotation_y(FRAC_PI_2),
            Self::Right => Quat::from_rotation_y(-FRAC_PI_2),
            Self::Above => Quat::from_rotation_x(-FRAC_PI_2),
            Self::Below => Quat::from_rotation_x(FRAC_PI_2),
        }
    }
}

/// Where the camera is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// What is in the middle of the picture.
    pub target: Vec3,
    /// From the camera's axes (right, up, backwards) to the scan's.
    pub turn: Quat,
    /// From the target to the eye.
    pub distance: f32,
    /// The head's axis in the scan's frame, once known.
    pub up: Option<Vec3>,
    middle: Vec3,
    radius: f32,
}

impl Camera {
    /// Looks along -z at all of the points.
    #[must_use]
    pub fn at(points: &[Vec3]) -> Self {
        let (low, high) = points
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| {
                (low.min(*p), high.max(*p))
            });
        let mut camera = Self {
            target: Vec3::ZERO,
            turn: Quat::IDENTITY,
            distance: 1.0,
            up: None,
            middle: (low + high) / 2.0,
            radius: ((high - low).length() / 2.0).max(f32::MIN_POSITIVE),
        };
        camera.fit();
        camera
    }

    /// Moves so far back that all is in sight.
    pub fn fit(&mut self) {
        self.target = self.middle;
        self.distance = self.whole();
    }

    fn whole(&self) -> f32 {
        // The corners of a box round a head are empty.
        self.radius * 0.8 / (FOV / 2.0).sin()
    }

    /// Looks from `view`, where `head` turns the head's frame into the scan's.
    pub fn look(&mut self, view: View, head: Quat) {
        self.turn = head * view.turn();
        self.fit();
    }

    /// Turns by a drag of `by` pixels; a drag over the whole height is half a turn.
    pub fn orbit(&mut self, by: Vec2, size: Vec2) {
        let angle = by * (std::f32::consts::PI / size.y.max(1.0));
        let pitched = self.turn * Quat::from_rotation_x(-angle.y);
        match self.up {
            None => self.turn = pitched * Quat::from_rotation_y(-angle.x),
            Some(up) => {
                let over = (pitched * Vec3::Z).dot(up).abs();
                let turn = if over < POLE || over < self.back().dot(up).abs() {
                    pitched
                } else {
                    self.turn
                };
                self.turn = Quat::from_axis_angle(up, -angle.x) * turn;
            }
        }
        self.turn = self.turn.normalize();
    }

    /// Turns the picture about its middle, rad, against the clock.
    pub fn roll(&mut self, angle: f32) {
        self.turn = (self.turn * Quat::from_rotation_z(-angle)).normalize();
    }

    /// Shifts the picture by `by` pixels.
    pub fn pan(&mut self, by: Vec2, size: Vec2) {
        let shift = Vec3::new(-by.x, by.y, 0.0) * self.pixel(self.distance, size);
        self.target += self.turn * shift;
    }

    /// Goes nearer (`factor` above 1) or farther, keeping what lies under the pixel `at` there: at the depth of
    /// `point`, so that a nose does not come at the eye faster than it grows.
    pub fn zoom(&mut self, factor: f32, at: Vec2, size: Vec2, point: Vec3) {
        self.aim(point);
        let limits = (self.radius * 0.05, self.radius * 40.0);
        let distance = (self.distance / factor).clamp(limits.0, limits.1);
        let before = self.pixel(self.distance, size);
        let after = self.pixel(distance, size);
        let off = at - size / 2.0;
        self.target += self.turn * Vec3::new(off.x, -off.y, 0.0) * (before - after);
        self.distance = distance;
    }

    /// What to turn about: what is in the middle of the picture (`seen`) if that is near, else the middle of it all.
    pub fn pivot(&mut self, seen: Option<Vec3>) {
        /// As a share of the distance from which all is in sight.
        const NEAR: f32 = 0.5;
        let near = NEAR * self.whole();
        let seen = seen.filter(|p| (self.eye() - *p).dot(self.back()) < near);
        self.aim(seen.unwrap_or(self.middle));
    }

    /// Moves the target along the view to the depth of `point`; the picture stays as it is.
    fn aim(&mut self, point: Vec3) {
        let depth = (self.eye() - point).dot(self.back());
        if depth > self.radius * 0.01 {
            self.target = self.eye() - self.back() * depth;
            self.distance = depth;
        }
    }

    /// The eye's place.
    #[must_use]
    pub fn eye(&self) -> Vec3 {
        self.target + self.back() * self.distance
    }

    /// From the target towards the eye, of length one.
    #[must_use]
    pub fn back(&self) -> Vec3 {
        self.turn * Vec3::Z
    }

    /// The ray through the pixel `at`: the eye, and a direction of length one.
    #[must_use]
    pub fn ray(&self, at: Vec2, size: Vec2) -> (Vec3, Vec3) {
        let off = (at - size / 2.0) * self.pixel(1.0, size);
        let way = self.turn * Vec3::new(off.x, -off.y, -1.0);
        (self.eye(), way.normalize())
    }

    /// The pixel on which a point is seen; none behind the eye.
    #[must_use]
    pub fn pixel_of(&self, point: Vec3, size: Vec2) -> Option<Vec2> {
        let p = self.turn.conjugate() * (point - self.eye());
        let depth = -p.z;
        (depth > self.distance * 1e-3)
            .then(|| size / 2.0 + Vec2::new(p.x, -p.y) / self.pixel(depth, size))
    }

    /// Where the ray through `at` meets the plane through `point` that lies square to the view.
    #[must_use]
    pub fn on_plane(&self, at: Vec2, size: Vec2, point: Vec3) -> Option<Vec3> {
        let (eye, way) = self.ray(at, size);
        let along = (point - eye).dot(self.back()) / way.dot(self.back());
        (along > 0.0 && along.is_finite()).then(|| eye + way * along)
    }

    /// For the graphics card: clip coordinates, depth 0..1, of points in the scan's frame.
    #[must_use]
    pub fn clip_from_world(&self, aspect: f32) -> Mat4 {
        let reach = self.radius * 2.5 + self.target.distance(self.middle);
        let near = (self.distance - reach).max(self.distance * 0.02);
        let far = self.distance + reach;
        let view = Mat4::from_rotation_translation(self.turn, self.eye()).inverse();
        directx::perspective(FOV, aspect, near, far) * view
    }

    /// Length of a pixel at a depth.
    fn pixel(&self, depth: f32, size: Vec2) -> f32 {
        2.0 * (FOV / 2.0).tan() * depth / size.y.max(1.0)
    }
}
