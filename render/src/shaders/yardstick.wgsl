// What the bench measures against: the same skin as a game of 2010 would draw them. One pass, four maps (colour,
// mask, two bumps), Blinn and Phong's model under two lamps, no shadow; nothing that a picture is made with.

#include "frame"
#include "skin_maps"

struct SkinVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
}

struct PlainFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
}

@vertex
fn yardstick_vertex(in: SkinVertex) -> PlainFragment {
    let at = frame.bodies[1] * vec4(in.position, 1.0);
    let normal = frame.bodies[1] * vec4(in.normal, 0.0);
    return PlainFragment(frame.clip_from_world * at, at.xyz, normal.xyz, in.uv);
}

fn lamp(n: vec3<f32>, v: vec3<f32>, l: vec3<f32>, colour: vec3<f32>, shine: f32) -> vec3<f32> {
    let h = normalize(l + v);
    return colour * max(dot(n, l), 0.0) + vec3(shine * pow(max(dot(n, h), 0.0), 24.0));
}

@fragment
fn yardstick(in: PlainFragment) -> @location(0) vec4<f32> {
    let colour = textureSample(colour_map, map_sampler, in.uv).rgb;
    let mask = textureSample(mask_map, map_sampler, in.uv);
    let folds = textureSample(wrinkle_map, map_sampler, in.uv).xy - 0.5;
    let grain = textureSample(grain_map, tile_sampler, in.uv * 8.0).xy - 0.5;
    let smooth_n = normalize(in.normal);
    let across = normalize(cross(vec3(0.0, 1.0, 0.0), smooth_n));
    let slope = grain * mask.g + folds * mask.a;
    let n = normalize(smooth_n + across * slope.x + cross(smooth_n, across) * slope.y);
    let v = normalize(frame.eye.xyz - in.world);
    return vec4(colour * 0.12 + lamp(n, v, frame.key_dir.xyz, colour, mask.r) + 0.35 * lamp(n, v, frame.fill_dir.xyz, colour, mask.r), 1.0);
}
