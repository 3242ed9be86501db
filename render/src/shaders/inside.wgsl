// The back of the skin round the mouth, seen through the open mouth past the teeth: the inside of lips
// and cheeks. Dark, and cheap; it keeps the backdrop from showing through.

#include "frame"

struct InsideVertex {
    @location(0) position: vec3<f32>,
    @location(3) shares: vec4<f32>,
}

struct InsideFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) light: f32,
}

@vertex
fn inside_vertex(in: InsideVertex) -> InsideFragment {
    let v = vec4(in.position, 1.0);
    let world = mix(frame.bodies[0] * v, frame.bodies[1] * v, in.shares.x);
    // Darker away from the opening.
    let to = in.position - frame.mouth.xyz;
    let area = PI * frame.mouth.w * frame.mouth_height.x;
    var out: InsideFragment;
    out.clip = frame.clip_from_world * vec4(world.xyz, 1.0);
    out.light = area / (area + 3.0 * dot(to, to));
    return out;
}

@fragment
fn inside(in: InsideFragment) -> @location(0) vec4<f32> {
    return developed(vec3(0.20, 0.055, 0.05) * in.light);
}
