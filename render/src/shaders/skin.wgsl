// Skin, after the maps of HEADSHOP 4.4 (colour, bump, mask) with a physically based reflection: two
// glossy lobes, scattering under the surface that softens the terminator and reddens it, ambient
// light dimmed in folds. Lips are the same skin with the vermilion's colour and wetness.
//
// Fill, rim and ambient light change slowly over a face: they are worked out at the vertices. The key
// light, which shows the skin's grain, and its shadow are worked out at the pixels.

#include "light"

@group(2) @binding(0) var map_sampler: sampler;
// Colour as the square root of linear light, lips and brows in it; a: how much light shines through.
@group(2) @binding(1) var colour_map: texture_2d<f32>;
// Slopes of the surface across and up (0.5 is flat), gloss, what the grain leaves of the colour (0.5 is all).
@group(2) @binding(2) var detail_map: texture_2d<f32>;

// Part of the chart that the detail map covers: u from .x to .y, v from .z to .w. Keep in step with maps/mod.rs.
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

// Packed: the fewer slots, the cheaper a small triangle in software.
struct SkinFragment {
    @builtin(position) clip: vec4<f32>,
    // Normal; light that is only added: lamps but the key, and the room, mirrored.
    @location(0) normal: vec4<f32>,
    // Place in the colour map; place in the shadow map.
    @location(1) places: vec4<f32>,
    // Light but the key's that the skin's colour multiplies; depth in the shadow map.
    @location(2) soft: vec4<f32>,
    // Vermilion, wet, occlusion.
    @location(3) shares: vec3<f32>,
}

// How far each colour wraps round the terminator, and what keeps its energy.
const WRAP: vec3<f32> = vec3(0.27, 0.12, 0.08);
const WRAP_SCALE: vec3<f32> = vec3(0.6200, 0.7972, 0.8573);

// Matte light with the three colours wrapped round the terminator by different widths.
fn scattered(cosine: vec3<f32>) -> vec3<f32> {
    return max(cosine + WRAP, vec3(0.0)) * WRAP_SCALE;
}

// A smooth step over 0..1 of a value already scaled.
fn eased(value: f32) -> f32 {
    let t = clamp(value, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
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

    // The room and the lamps mirrored in the skin's oil, and the down of the cheek at grazing sight.
    let rim = gloss(n, v, frame.rim_dir.xyz, 0.5) * (1.0 + 6.0 * edge) * occlusion * occlusion;
    let fill = gloss(n, v, frame.fill_dir.xyz, 0.5) * occlusion;
    let mirrored = (frame.fill_colour.rgb * fill + frame.rim_colour.rgb * rim) * 0.022
        + ambient_from(reflect(-v, n)) * ((0.018 + 0.08 * edge) * occlusion * occlusion);
    let shadow = shadow_place(world, n);
    let soft = frame.fill_colour.rgb * scattered(vec3(f)) * mix(occlusion, 1.0, 0.2)
        + frame.rim_colour.rgb * scattered(vec3(b)) * occlusion
        + around * (bounced(occlusion, SKIN) + 0.35 * edge * occlusion);

    var out: SkinFragment;
    out.clip = frame.clip_from_world * vec4(world, 1.0);
    out.normal = vec4(n, dot(mirrored, vec3(0.3333)));
    out.places = vec4(in.uv, shadow.xy);
    out.soft = vec4(soft, shadow.z);
    out.shares = vec3(in.shares.y, in.shares.z, occlusion);
    return out;
}

@fragment
fn skin(in: SkinFragment) -> @location(0) vec4<f32> {
    let texel = textureSample(colour_map, map_sampler, in.places.xy);
    let detail = textureSample(detail_map, map_sampler, (in.places.xy - WINDOW.xz) * (1.0 / (WINDOW.yw - WINDOW.xz)));
    let smooth_n = in.normal.xyz;

    // Bump: slopes lie across and up the chart, which the face's normal is near enough square to.
    let slope = detail.xy * 2.0 - 1.0;
    let up = frame.bodies[1][1].xyz;
    let across = vec3(smooth_n.z, 0.0, -smooth_n.x);
    let n = normalize(smooth_n - across * slope.x - up * slope.y);

    // Lips: smoother than skin; their creases also break up the border.
    let red = eased(in.shares.x * (1.0 + 0.35 * slope.x) * 2.13 - 0.32);
    let wet = in.shares.y;
    let albedo = texel.rgb * texel.rgb * (2.0 * detail.w);
    let oil = mix(detail.z, 0.62, red);
    let roughness = mix(mix(0.62, 0.49, oil), mix(0.40, 0.22, wet), max(red * 0.8, wet));

    let l = frame.key_dir.xyz;
    let smooth_cos = dot(smooth_n, l);
    let bumped_cos = dot(n, l);
    // Near the terminator the wrapped light takes over from the shadow map, which only knows yes or no.
    let visible = mix(1.0, key_visible(vec3(in.places.zw, in.soft.w)), eased(smooth_cos * 2.94 + 0.353));
    // Into nostrils and between lips no lamp shines.
    let reached = visible * eased(in.shares.z * 2.5 - 0.125);
    // In the soft edge of a shadow red light has crept in under the skin.
    let bleed = vec3(reached) + vec3(0.32, 0.04, 0.0) * (visible - visible * visible);
    // Red light travels furthest, so it sees least of the bumps.
    let cosine = mix(vec3(bumped_cos), vec3(smooth_cos), vec3(0.75, 0.45, 0.35));
    var light = albedo * (frame.key_colour.rgb * scattered(cosine) * bleed + in.soft.xyz);

    // Oil: a broad lobe and a tighter one; water on the lips. The camera is far off, so one direction
    // half-way to the key lamp does for the whole head. Both GGX lobes over one divisor.
    let ndh = max(dot(n, frame.half_key.xyz), 0.0);
    let ndh2 = ndh * ndh;
    let a = roughness * roughness;
    let a2 = a * a;
    let b2 = a2 * 0.1132;
    let da = ndh2 * (a2 - 1.0) + 1.00001;
    let db = ndh2 * (b2 - 1.0) + 1.00001;
    let da2 = da * da;
    let db2 = db * db;
    let lobes = (0.72 * a2 * db2 + 0.28 * b2 * da2) / (da2 * db2);
    // Painted hair does not shine like skin.
    let oiled = (0.25 + 1.2 * oil) * min(9.0 * albedo.g, 1.0);
    let strength = 0.028 * frame.half_key.w * oiled * (0.35 + 0.65 * in.shares.z);
    light += frame.key_colour.rgb * (strength * lobes * max(bumped_cos, 0.0) * reached);
    light += vec3(in.normal.w * oiled);
    // Light from behind shines red through ears and nostrils.
    light += vec3(0.055, 0.010, 0.005) * (texel.a * in.shares.z);
    return developed(light);
}
