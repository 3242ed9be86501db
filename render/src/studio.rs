//! The light: key, fill and rim lamps of a portrait studio, and the ambient light of the room.
//!
//! The lamps follow the camera round the head by part of its angle, as a photographer would move
//! them, so that every view is lit for its own sake.

use glam::{Mat4, Vec3, camera::rh, vec3};

use crate::environment::Environment;
use crate::harmonics::Harmonics;
use crate::view::Extent;

/// A lamp far away.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lamp {
    /// Towards it, unit length, world.
    pub(crate) direction: Vec3,
    /// Light that a white matte surface facing it returns, linear.
    pub(crate) colour: Vec3,
    /// Half the angle it fills, radians: the size of its picture in the eye.
    pub(crate) half_angle: f32,
}

/// All the light of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Studio {
    pub(crate) key: Lamp,
    pub(crate) fill: Lamp,
    pub(crate) rim: Lamp,
    /// The room.
    pub(crate) ambient: Harmonics,
    /// Brightness of the film.
    pub(crate) exposure: f32,
}

/// How far the lamps follow the camera's angle.
const FOLLOW: f32 = 0.62;

impl Studio {
    /// Lit for a camera at that angle round the head, in that room.
    pub(crate) fn portrait(camera_yaw_rad: f32, room: &Environment) -> Self {
        let turn = camera_yaw_rad * FOLLOW;
        let lamp = |azimuth_deg: f32, height_deg: f32, colour: Vec3, half_angle: f32| {
            let (azimuth, height) = (azimuth_deg.to_radians() + turn, height_deg.to_radians());
            Lamp {
                direction: vec3(
                    azimuth.sin() * height.cos(),
                    height.sin(),
                    azimuth.cos() * height.cos(),
                ),
                colour,
                half_angle,
            }
        };
        Self {
            key: lamp(-38.0, 34.0, vec3(1.62, 1.44, 1.30), 0.30),
            fill: lamp(52.0, 6.0, vec3(0.40, 0.43, 0.48), 0.42),
            rim: lamp(148.0, 28.0, vec3(0.95, 0.98, 1.05), 0.25),
            ambient: room.seen(turn),
            exposure: 0.76,
        }
    }

    /// Luminance of a white card before the face that faces where it does.
    pub(crate) fn before(&self, ahead: Vec3) -> f32 {
        let lamps = [&self.key, &self.fill, &self.rim]
            .map(|lamp| lamp.colour * lamp.direction.dot(ahead).max(0.0));
        let light = self.ambient.returned(ahead) + lamps.into_iter().sum::<Vec3>();
        light.dot(vec3(0.2126, 0.7152, 0.0722)).max(0.0)
    }

    /// World to the key lamp's picture of the head: x and y -1..1, depth 0..1.
    pub(crate) fn shadow_from_world(&self, extent: &Extent) -> Mat4 {
        let centre = (extent.min + extent.max) * 0.5;
        let radius = (extent.max - extent.min).length() * 0.5 * 0.94;
        let from = centre + self.key.direction * (radius * 2.0);
        rh::proj::directx::orthographic(
            -radius,
            radius,
            -radius,
            radius,
            radius * 0.5,
            radius * 3.5,
        ) * rh::view::look_at_mat4(from, centre, Vec3::Y)
    }
}
