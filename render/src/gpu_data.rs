//! What goes to the graphics card, as plain arrays. Keep in step with shaders/frame.wgsl,
//! shaders/part.wgsl and shaders/skin.wgsl.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// The `Frame` of shaders/frame.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Frame {
    pub(crate) clip_from_world: [[f32; 4]; 4],
    pub(crate) shadow_from_world: [[f32; 4]; 4],
    pub(crate) head_from_world: [[f32; 4]; 4],
    pub(crate) bodies: [[[f32; 4]; 4]; 8],
    pub(crate) eye: [f32; 4],
    pub(crate) key_dir: [f32; 4],
    pub(crate) fill_dir: [f32; 4],
    pub(crate) rim_dir: [f32; 4],
    pub(crate) half_key: [f32; 4],
    pub(crate) key_colour: [f32; 4],
    pub(crate) fill_colour: [f32; 4],
    pub(crate) rim_colour: [f32; 4],
    pub(crate) ambient: [[f32; 4]; 7],
    pub(crate) mouth: [f32; 4],
    pub(crate) mouth_height: [f32; 4],
    pub(crate) eyeballs: [[f32; 4]; 2],
    pub(crate) lids: [[f32; 4]; 4],
    pub(crate) lids_at_rest: [[f32; 4]; 4],
    pub(crate) backdrop: [[f32; 4]; 2],
    pub(crate) picture: [f32; 4],
    pub(crate) wrinkled: [[f32; 4]; 4],
    pub(crate) toward_camera: [f32; 4],
    pub(crate) pupil: [f32; 4],
    pub(crate) placing: [f32; 4],
    pub(crate) reach: [f32; 4],
}

/// The part of a skin vertex that moves: head's frame, mm.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct SkinMoving {
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
    /// What a fold leaves of the light from around, how convex it is, unused twice; 255 is 1.
    pub(crate) bend: [u8; 4],
}

/// The part of a skin vertex that stays.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct SkinStill {
    pub(crate) uv: [f32; 2],
    /// Share of the skull, vermilion, wet, occlusion; 255 is 1.
    pub(crate) shares: [u8; 4],
    /// Place on the tile of the fine structure.
    pub(crate) grain: [f32; 2],
    /// Shares of the zones of both layers of wrinkles (see maps/zones.rs); 255 is 1.
    pub(crate) zones: [[u8; 4]; 2],
}

/// A vertex of a part.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct PartVertex {
    pub(crate) rest: [f32; 3],
    pub(crate) normal: [f32; 3],
    pub(crate) uv: [f32; 2],
    /// Occlusion, share of the second body, direction of the strands (see `octahedral`); 255 is 1.
    pub(crate) shares: [u8; 4],
    /// Numbers of the two bodies, unused twice.
    pub(crate) bodies: [u8; 4],
}

pub(crate) const SKIN_MOVING: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<SkinMoving>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 7 => Unorm8x4],
};

pub(crate) const SKIN_STILL: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<SkinStill>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![
        2 => Float32x2, 3 => Unorm8x4, 4 => Float32x2, 5 => Unorm8x4, 6 => Unorm8x4
    ],
};

pub(crate) const PART: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<PartVertex>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x2, 3 => Unorm8x4, 4 => Uint8x4
    ],
};

/// 0..1 as a byte.
pub(crate) fn unorm(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// A direction as two bytes: the octahedron's faces folded into a square.
pub(crate) fn octahedral(d: Vec3) -> [u8; 2] {
    let d = d / (d.x.abs() + d.y.abs() + d.z.abs()).max(1e-9);
    let sign = |v: f32| if v < 0.0 { -1.0 } else { 1.0 };
    let (x, y) = if d.z < 0.0 {
        ((1.0 - d.y.abs()) * sign(d.x), (1.0 - d.x.abs()) * sign(d.y))
    } else {
        (d.x, d.y)
    };
    [unorm(x * 0.5 + 0.5), unorm(y * 0.5 + 0.5)]
}
