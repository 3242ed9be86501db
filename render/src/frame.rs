//! What the shaders are told of one picture: bodies, camera, lamps, openings, backdrop.

use glam::{Mat4, Vec3, Vec4};
use mouthpiece_rig::{Body, Head, KeyFrame};

use crate::gaze;
use crate::gpu_data::Frame;
use crate::maps::zones;
use crate::openings::Open;
use crate::studio::{Lamp, Studio};
use crate::view::{Background, Extent, Shown, View, srgb};

/// Share of the picture's height that the flash square takes.
const FLASH_SHARE: f32 = 0.25;

/// No lips and no lids: light reaches teeth and eyeballs from all sides.
const BARE: Open = Open {
    mouth: Vec4::new(0.0, 0.0, -1e4, 1e4),
    mouth_half_height: 1e4,
    lids: WIDE_OPEN,
    lids_at_rest: WIDE_OPEN,
};
/// As [`Open::lids`], farther from the ball's middle than its radius.
const WIDE_OPEN: [Vec4; 4] = [
    Vec4::new(2.0, 0.0, 0.0, 1.0),
    Vec4::new(-2.0, 0.0, 0.0, 1.0),
    Vec4::new(2.0, 0.0, 0.0, 1.0),
    Vec4::new(-2.0, 0.0, 0.0, 1.0),
];

/// The uniform block of one picture.
pub(crate) fn data(
    pose: &Head,
    extent: &Extent,
    open: &Open,
    key_frame: &KeyFrame,
    view: &View,
    size: (u32, u32),
) -> Frame {
    let open = match view.shown {
        Shown::Face | Shown::Yardstick => open,
        Shown::Anatomy => &BARE,
    };
    let upright = view.placing.upright(size);
    let mut framing = extent.frame(view.camera, upright);
    view.placing.place(&mut framing, extent, upright);
    let studio = Studio::portrait(view.camera.yaw_rad(), &view.environment);
    let mut bodies = pose.bodies(&key_frame.state);
    gaze::converge(pose, &mut bodies);
    let ahead = bodies[Body::Skull as usize].transform_vector3(Vec3::Z);
    let pupil = gaze::pupil(studio.before(ahead), &key_frame.state, key_frame.time);
    let bodies = bodies.map(Mat4::from);
    let mut body_rows = [Mat4::IDENTITY.to_cols_array_2d(); 8];
    for (row, body) in body_rows.iter_mut().zip(bodies) {
        *row = body.to_cols_array_2d();
    }
    let direction = |lamp: &Lamp| lamp.direction.extend(lamp.half_angle).to_array();
    let colour = |lamp: &Lamp| lamp.colour.extend(0.0).to_array();
    let (middle, corner, down) = match &view.background {
        Background::Plain(c) => (srgb(*c), srgb(*c), 0.0),
        Background::Studio(c) => (srgb(*c) * 1.10, srgb(*c) * 0.58, 0.0),
        Background::Gradient { top, bottom } => (srgb(*top), srgb(*bottom), 1.0),
        Background::Picture(_) | Background::Transparent => (Vec3::ZERO, Vec3::ZERO, 0.0),
    };
    let cover = f32::from(u8::from(view.background != Background::Transparent));
    let ((cos, sin), wander) = (view.placing.turn(), view.placing.wander_px);
    let (width, height) = (size.0 as f32, size.1 as f32);
    Frame {
        clip_from_world: framing.clip_from_world.to_cols_array_2d(),
        shadow_from_world: studio.shadow_from_world(extent).to_cols_array_2d(),
        head_from_world: bodies[Body::Skull as usize].inverse().to_cols_array_2d(),
        bodies: body_rows,
        eye: framing.eye.extend(studio.exposure).to_array(),
        key_dir: direction(&studio.key),
        fill_dir: direction(&studio.fill),
        rim_dir: direction(&studio.rim),
        half_key: half_key(studio.key.direction, framing.eye - extent.centre()).to_array(),
        key_colour: colour(&studio.key),
        fill_colour: colour(&studio.fill),
        rim_colour: colour(&studio.rim),
        ambient: studio.ambient.rows(),
        mouth: open.mouth.to_array(),
        mouth_height: [open.mouth_half_height, 0.0, 0.0, 0.0],
        eyeballs: pose
            .eyes
            .map(|eye| eye.centre.extend(eye.radius).to_array()),
        lids: open.lids.map(|lid| lid.to_array()),
        lids_at_rest: open.lids_at_rest.map(|lid| lid.to_array()),
        backdrop: [
            middle
                .extend(upright.0 as f32 / upright.1 as f32)
                .to_array(),
            corner.extend(down).to_array(),
        ],
        picture: [width, height, FLASH_SHARE, cover],
        wrinkled: zones::wrinkled(&key_frame.state),
        toward_camera: (framing.eye - extent.centre())
            .normalize_or(Vec3::Z)
            .extend(0.0)
            .to_array(),
        pupil: [pupil, 0.0, 0.0, 0.0],
        placing: [cos, sin, wander.x, wander.y],
        reach: [view.placing.wander_max_px, 0.0, 0.0, 0.0],
    }
}

/// The direction half-way between lamp and camera, and the visibility and Fresnel part of the glossy lobe there
/// (see `gloss_lobe` in shaders/light.wgsl) for skin's roughness.
fn half_key(lamp: Vec3, to_camera: Vec3) -> Vec4 {
    let half = (lamp + to_camera.normalize_or(Vec3::Z)).normalize_or(Vec3::Z);
    let cosine = lamp.dot(half);
    half.extend(1.0 / ((cosine * cosine).max(0.1) * 3.2))
}
