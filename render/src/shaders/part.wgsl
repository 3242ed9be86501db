// Vertices of the parts: rigid, each between its two bodies.

#include "frame"

struct PartVertex {
    @location(0) rest: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Occlusion, share of the second body, distance from the edge of the mesh (0 at it), unused.
    @location(3) shares: vec4<f32>,
    @location(4) bodies: vec4<u32>,
}

struct PartFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Position in the head's frame; w: occlusion.
    @location(3) head: vec4<f32>,
    // Height in the pile of layers (hair), distance from the edge.
    @location(4) layer: vec2<f32>,
}

fn part_world(body: mat4x4<f32>, other: mat4x4<f32>, share: f32, v: vec4<f32>) -> vec3<f32> {
    return mix((body * v).xyz, (other * v).xyz, share);
}

fn part_vertex(in: PartVertex, raise: f32) -> PartFragment {
    let a = frame.bodies[in.bodies.x];
    let b = frame.bodies[in.bodies.y];
    var out: PartFragment;
    let rest = in.rest + in.normal * raise;
    out.world = part_world(a, b, in.shares.y, vec4(rest, 1.0));
    out.normal = part_world(a, b, in.shares.y, vec4(in.normal, 0.0));
    out.clip = frame.clip_from_world * vec4(out.world, 1.0);
    out.uv = in.uv;
    out.head = vec4((frame.head_from_world * vec4(out.world, 1.0)).xyz, in.shares.x);
    out.layer = vec2(0.0, in.shares.z);
    return out;
}

@vertex
fn part(in: PartVertex) -> PartFragment {
    return part_vertex(in, 0.0);
}
