// Vertices of the parts: rigid, each between its two bodies.

#include "frame"

struct PartVertex {
    @location(0) rest: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Occlusion, share of the second body; of hair, the strands' direction (see strand_direction).
    @location(3) shares: vec4<f32>,
    @location(4) bodies: vec4<u32>,
}

// A vertex where it is now.
struct Placed {
    world: vec3<f32>,
    normal: vec3<f32>,
}

fn placed(in: PartVertex, raise: f32) -> Placed {
    let a = frame.bodies[in.bodies.x];
    let b = frame.bodies[in.bodies.y];
    let p = vec4(in.rest + in.normal * raise, 1.0);
    let n = vec4(in.normal, 0.0);
    var out: Placed;
    out.world = mix((a * p).xyz, (b * p).xyz, in.shares.y);
    out.normal = mix((a * n).xyz, (b * n).xyz, in.shares.y);
    return out;
}

// The direction of the strands at rest: a square unfolded to an octahedron. Keep in step with gpu_data.rs.
fn strand_direction(square: vec2<f32>) -> vec3<f32> {
    let p = square * 2.0 - 1.0;
    let z = 1.0 - abs(p.x) - abs(p.y);
    let under = max(-z, 0.0);
    return normalize(vec3(p - under * sign(p), z));
}

fn in_head(world: vec3<f32>) -> vec3<f32> {
    return (frame.head_from_world * vec4(world, 1.0)).xyz;
}

fn head_direction(world: vec3<f32>) -> vec3<f32> {
    return (frame.head_from_world * vec4(world, 0.0)).xyz;
}
