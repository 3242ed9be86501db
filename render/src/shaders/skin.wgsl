// Skin, after the maps of HEADSHOP 4.4 (colour, bump, mask) with a physically based reflection: two
// glossy lobes, scattering under the surface that softens the terminator and reddens it, ambient
// light dimmed in folds. Lips are the same skin with the vermilion's colour and wetness.

#include "light"

@group(2) @binding(0) var map_sampler: sampler;
// Colour as the square root of linear light; a: how much light shines through (ears, nose).
@group(2) @binding(1) var colour_map: texture_2d<f32>;
// Slopes of the surface across and up (0.5 is flat), gloss, unused.
@group(2) @binding(2) var detail_map: texture_2d<f32>;

// Part of the chart that the maps cover: u from .x to .y, v from .z to .w. Keep in step with maps/mod.rs.
const WINDOW: vec4<f32> = vec4(0.19, 0.81, 0.0, 1.0);

struct SkinVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Share of the skull, vermilion, wet, occlusion.
    @location(3) shares: vec4<f32>,
}

struct SkinFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Vermilion, wet, occlusion.
    @location(3) shares: vec3<f32>,
}

@vertex
fn skin_vertex(in: SkinVertex) -> SkinFragment {
    var out: SkinFragment;
    let p = vec4(in.position, 1.0);
    let n = vec4(in.normal, 0.0);
    out.world = mix((frame.bodies[0] * p).xyz, (frame.bodies[1] * p).xyz, in.shares.x);
    out.normal = mix((frame.bodies[0] * n).xyz, (frame.bodies[1] * n).xyz, in.shares.x);
    out.clip = frame.clip_from_world * vec4(out.world, 1.0);
    out.uv = (in.uv - WINDOW.xz) / (WINDOW.yw - WINDOW.xz);
    // What is dark at rest because the lips are closed opens up with them.
    let opened = in.shares.z * clamp(frame.mouth_height.x / 6.0, 0.0, 1.0);
    out.shares = vec3(in.shares.y, in.shares.z, mix(in.shares.w, max(in.shares.w, 0.55), opened));
    return out;
}

// Matte light with the three colours wrapped round the terminator by different widths.
fn scattered(smooth_cos: f32, bumped_cos: f32) -> vec3<f32> {
    let wrap = vec3(0.34, 0.14, 0.09);
    let cosine = mix(vec3(bumped_cos), vec3(smooth_cos), vec3(0.75, 0.45, 0.35));
    return max(cosine + wrap, vec3(0.0)) / ((1.0 + wrap) * (1.0 + wrap));
}

@fragment
fn skin(in: SkinFragment) -> @location(0) vec4<f32> {
    let texel = textureSample(colour_map, map_sampler, in.uv);
    let detail = textureSample(detail_map, map_sampler, in.uv);
    let smooth_n = normalize(in.normal);
    let v = normalize(frame.eye.xyz - in.world);

    // Bump: slopes lie across and up the chart.
    let up = frame.bodies[1][1].xyz;
    let across = normalize(cross(up, smooth_n) + vec3(1e-4, 0.0, 0.0));
    let climb = cross(smooth_n, across);
    let slope = detail.xy * 2.0 - 1.0;
    let n = normalize(smooth_n - across * slope.x - climb * slope.y);

    // Lips: the painted creases also break up the border of the red.
    let grain = slope.x * 0.35;
    let red = smoothstep(0.15, 0.62, in.shares.x + grain * in.shares.x);
    let wet = in.shares.y;
    var albedo = texel.rgb * texel.rgb;
    let tone = dot(albedo, vec3(0.3, 0.5, 0.2)) * 2.6;
    let lip = mix(vec3(0.40, 0.145, 0.125), vec3(0.29, 0.065, 0.06), wet) * tone;
    albedo = mix(albedo, lip, red * 0.86);
    let oil = mix(detail.z, 0.62, red);
    let roughness = mix(mix(0.58, 0.44, oil), mix(0.40, 0.22, wet), max(red * 0.8, wet));
    let occlusion = in.shares.z;

    let l = frame.key_dir.xyz;
    let f = frame.fill_dir.xyz;
    let b = frame.rim_dir.xyz;
    let key_cos = dot(smooth_n, l);
    // Near the terminator the wrapped light takes over from the shadow map, which only knows yes or no.
    let visible = mix(1.0, key_visible(in.world, smooth_n), smoothstep(-0.12, 0.22, key_cos));
    // In the soft edge of a shadow red light has crept in under the skin.
    let bleed = vec3(visible) + vec3(0.16, 0.02, 0.0) * (visible * (1.0 - visible) * 2.0);

    var light = albedo * frame.key_colour.rgb * scattered(key_cos, dot(n, l)) * bleed;
    light += albedo * frame.fill_colour.rgb * scattered(dot(smooth_n, f), dot(n, f)) * mix(occlusion, 1.0, 0.35);
    light += albedo * frame.rim_colour.rgb * scattered(dot(smooth_n, b), dot(n, b)) * occlusion;
    // Light from behind shines red through ears and nostrils.
    light += vec3(0.55, 0.10, 0.05) * frame.rim_colour.rgb * (texel.a * 0.22 * max(-dot(smooth_n, b) * 0.5 + 0.5, 0.0) * occlusion);
    light += albedo * ambient_from(n) * bounced(occlusion, albedo);

    // Oil: a broad lobe and a tighter one; water on the lips.
    let strength = 0.028 * (0.35 + 1.5 * oil) * mix(0.35, 1.0, occlusion);
    let half_key = normalize(l + v);
    let ndh = max(dot(n, half_key), 0.0);
    let ldh = max(dot(l, half_key), 0.0);
    let lobes = 0.72 * gloss_lobe(ndh, ldh, roughness) + 0.28 * gloss_lobe(ndh, ldh, roughness * 0.58);
    light += frame.key_colour.rgb * (strength * lobes * max(dot(n, l), 0.0) * visible);
    light += frame.fill_colour.rgb * (strength * gloss(n, v, f, roughness));
    let edge = grazing(max(dot(n, v), 0.0));
    light += frame.rim_colour.rgb * (strength * (1.0 + 6.0 * edge) * gloss(n, v, b, roughness));
    // The room mirrored, and the down of the cheek at grazing sight.
    light += ambient_from(reflect(-v, n)) * ((strength * 0.7 + 0.16 * edge * (1.0 - roughness)) * occlusion * occlusion);
    light += albedo * ambient_from(n) * (0.35 * edge * occlusion);
    return developed(light);
}
