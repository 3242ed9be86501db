// Depth as the key light sees it.

#include "part"

struct SkinVertex {
    @location(0) position: vec3<f32>,
    @location(3) shares: vec4<f32>,
}

@vertex
fn skin_shadow(in: SkinVertex) -> @builtin(position) vec4<f32> {
    let v = vec4(in.position, 1.0);
    let world = mix(frame.bodies[0] * v, frame.bodies[1] * v, in.shares.x);
    return frame.shadow_from_world * vec4(world.xyz, 1.0);
}

@vertex
fn part_shadow(in: PartVertex) -> @builtin(position) vec4<f32> {
    return frame.shadow_from_world * vec4(placed(in, 0.0).world, 1.0);
}
