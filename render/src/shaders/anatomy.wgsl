// What lies under the skin, as an anatomical plate shows it: lit by the studio at its pixels, with the
// shadow of the key lamp and the darkness of folds (occlusion).

#include "part"
#include "light"
#include "noise"

struct AnatomyFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Place at rest, for grain that stays on the surface.
    @location(3) rest: vec3<f32>,
    @location(4) occlusion: f32,
}

@vertex
fn anatomy_vertex(in: PartVertex) -> AnatomyFragment {
    let at = placed(in, 0.0);
    var out: AnatomyFragment;
    out.clip = frame.clip_from_world * vec4(at.world, 1.0);
    out.world = at.world;
    out.normal = at.normal;
    out.uv = in.uv;
    out.rest = in.rest;
    out.occlusion = in.shares.x;
    return out;
}

// Light sent back by a surface that is matte under a thin moist film; `soft` lets light creep round the
// edge, as flesh does.
fn lit(world: vec3<f32>, n: vec3<f32>, albedo: vec3<f32>, occlusion: f32, roughness: f32, f0: f32, soft: f32) -> vec3<f32> {
    let v = normalize(frame.eye.xyz - world);
    let visible = key_visible(shadow_place(world, n));
    let wrap = 1.0 / (1.0 + soft);
    let key = frame.key_colour.rgb * visible * mix(occlusion, 1.0, 0.35);
    let fill = frame.fill_colour.rgb * occlusion;
    let rim = frame.rim_colour.rgb * occlusion;
    var light = albedo * key * max((dot(n, frame.key_dir.xyz) + soft) * wrap, 0.0);
    light += albedo * fill * max((dot(n, frame.fill_dir.xyz) + soft) * wrap, 0.0);
    light += albedo * rim * max(dot(n, frame.rim_dir.xyz), 0.0);
    light += albedo * ambient_from(n) * bounced(occlusion, albedo);
    light += f0 * key * gloss(n, v, frame.key_dir.xyz, roughness);
    light += f0 * fill * gloss(n, v, frame.fill_dir.xyz, roughness);
    let film = f0 + (0.35 - f0) * grazing(max(dot(n, v), 0.0));
    light += ambient_from(reflect(-v, n)) * (film * occlusion * occlusion * 0.5);
    return light;
}

// Noise over three planes, by the surface's direction.
fn grain(p: vec3<f32>, n: vec3<f32>) -> f32 {
    let w = n * n;
    return value_noise(p.yz + 97.0) * w.x + value_noise(p.zx + 53.0) * w.y + value_noise(p.xy + 11.0) * w.z;
}
