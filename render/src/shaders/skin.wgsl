// Skin, after the maps of HEADSHOP 4.4 (colour, bump, mask) with a physically based reflection: two
// glossy lobes, scattering under the surface that softens the terminator and reddens it, ambient
// light dimmed in folds. Lips are the same skin with the vermilion's colour and wetness.
//
// Fill, rim and ambient light change slowly over a face: they are worked out at the vertices. The key
// light, which shows the skin's grain, and its shadow are worked out at the pixels.

#include "light"

@group(2) @binding(0) var map_sampler: sampler;
// Colour as the square root of linear light; a: how much light shines through (ears, nose).
@group(2) @binding(1) var colour_map: texture_2d<f32>;
// Slopes of the surface across and up (0.5 is flat), gloss, unused.
@group(2) @binding(2) var detail_map: texture_2d<f32>;

// Part of the chart that the maps cover: u from .x to .y, v from .z to .w. Keep in step with maps/mod.rs.
const WINDOW: vec4<f32> = vec4(0.19, 0.81, 0.0, 1.0);
// Colour of skin on the whole, linear: for light that bounces in folds.
const SKIN: vec3<f32> = vec3(0.56, 0.32, 0.23);

struct SkinVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Share of the skull, vermilion, wet, occlusion.
    @location(3) shares: vec4<f32>,
}

struct SkinFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
    // Between the key light and the eye, not of unit length.
    @location(1) halfway: vec3<f32>,
    // Place in the maps.
    @location(2) uv: vec2<f32>,
    // Place in the shadow map.
    @location(3) shadow: vec3<f32>,
    // Light other than the key's that the skin's colour multiplies; and light that is only added.
    @location(4) soft: vec3<f32>,
    @location(5) added: vec3<f32>,
    // Vermilion, wet, occlusion, light that shines through from behind.
    @location(6) shares: vec4<f32>,
}

// Matte light with the three colours wrapped round the terminator by different widths.
fn scattered(cosine: vec3<f32>) -> vec3<f32> {
    let wrap = vec3(0.34, 0.14, 0.09);
    return max(cosine + wrap, vec3(0.0)) / ((1.0 + wrap) * (1.0 + wrap));
}

@vertex
fn skin_vertex(in: SkinVertex) -> SkinFragment {
    let p = vec4(in.position, 1.0);
    let turned = vec4(in.normal, 0.0);
    let world = mix((frame.bodies[0] * p).xyz, (frame.bodies[1] * p).xyz, in.shares.x);
    let n = normalize(mix((frame.bodies[0] * turned).xyz, (frame.bodies[1] * turned).xyz, in.shares.x));
    let v = normalize(frame.eye.xyz - world);
    // What is dark at rest because the lips are closed opens up with them.
    let opened = in.shares.z * clamp(frame.mouth_height.x / 6.0, 0.0, 1.0);
    let occlusion = mix(in.shares.w, max(in.shares.w, 0.55), opened);
    let edge = grazing(max(dot(n, v), 0.0));
    let f = dot(n, frame.fill_dir.xyz);
    let b = dot(n, frame.rim_dir.xyz);
    let around = ambient_from(n);

    var out: SkinFragment;
    out.clip = frame.clip_from_world * vec4(world, 1.0);
    out.normal = n;
    out.halfway = frame.key_dir.xyz + v;
    out.uv = (in.uv - WINDOW.xz) / (WINDOW.yw - WINDOW.xz);
    out.shadow = shadow_place(world, n);
    out.soft = frame.fill_colour.rgb * scattered(vec3(f)) * mix(occlusion, 1.0, 0.2)
        + frame.rim_colour.rgb * scattered(vec3(b)) * occlusion
        + around * (bounced(occlusion, SKIN) + 0.35 * edge * occlusion);
    // The room and the lamps mirrored in the skin's oil, and the down of the cheek at grazing sight.
    let rim = gloss(n, v, frame.rim_dir.xyz, 0.5) * (1.0 + 6.0 * edge);
    let fill = gloss(n, v, frame.fill_dir.xyz, 0.5);
    out.added = (frame.fill_colour.rgb * fill + frame.rim_colour.rgb * rim) * 0.022
        + ambient_from(reflect(-v, n)) * ((0.018 + 0.08 * edge) * occlusion * occlusion);
    out.shares = vec4(in.shares.y, in.shares.z, occlusion, max(0.5 - 0.5 * b, 0.0) * occlusion * 0.2);
    return out;
}

@fragment
fn skin(in: SkinFragment) -> @location(0) vec4<f32> {
    let texel = textureSample(colour_map, map_sampler, in.uv);
    let detail = textureSample(detail_map, map_sampler, in.uv);

    // Bump: slopes lie across and up the chart, which the face's normal is near enough square to.
    let slope = detail.xy * 2.0 - 1.0;
    let up = frame.bodies[1][1].xyz;
    let across = vec3(in.normal.z, 0.0, -in.normal.x);
    let n = normalize(in.normal - across * slope.x - up * slope.y);

    // Lips: the painted creases also break up the border of the red.
    let red = smoothstep(0.15, 0.62, in.shares.x + slope.x * 0.35 * in.shares.x);
    let wet = in.shares.y;
    var albedo = texel.rgb * texel.rgb;
    let tone = dot(albedo, vec3(0.78, 1.3, 0.52));
    let lip = mix(vec3(0.43, 0.125, 0.110), vec3(0.29, 0.065, 0.06), wet) * tone;
    albedo = mix(albedo, lip, red * 0.86);
    let oil = mix(detail.z, 0.62, red);
    let roughness = mix(mix(0.62, 0.49, oil), mix(0.40, 0.22, wet), max(red * 0.8, wet));

    let l = frame.key_dir.xyz;
    let smooth_cos = dot(in.normal, l);
    let bumped_cos = dot(n, l);
    // Near the terminator the wrapped light takes over from the shadow map, which only knows yes or no.
    let visible = mix(1.0, key_visible(in.shadow), smoothstep(-0.12, 0.22, smooth_cos));
    // Into nostrils and between lips no lamp shines.
    let reached = visible * smoothstep(0.05, 0.45, in.shares.z);
    // In the soft edge of a shadow red light has crept in under the skin.
    let bleed = vec3(reached) + vec3(0.32, 0.04, 0.0) * (visible - visible * visible);
    // Red light travels furthest, so it sees least of the bumps.
    let cosine = mix(vec3(bumped_cos), vec3(smooth_cos), vec3(0.75, 0.45, 0.35));
    var light = albedo * (frame.key_colour.rgb * scattered(cosine) * bleed + in.soft);

    // Oil: a broad lobe and a tighter one; water on the lips.
    let h = normalize(in.halfway);
    let ndh = max(dot(n, h), 0.0);
    let ldh = dot(l, h);
    let lobes = 0.72 * gloss_lobe(ndh, ldh, roughness) + 0.28 * gloss_lobe(ndh, ldh, roughness * 0.58);
    let strength = 0.028 * (0.25 + 1.2 * oil) * (0.35 + 0.65 * in.shares.z);
    light += frame.key_colour.rgb * (strength * lobes * max(bumped_cos, 0.0) * reached);
    light += in.added * (0.25 + 1.2 * oil);
    // Light from behind shines red through ears and nostrils.
    light += vec3(0.55, 0.10, 0.05) * (texel.a * in.shares.w);
    return developed(light);
}
