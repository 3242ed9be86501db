// The studio: key with a shadow, fill, rim, ambient; and the pieces of the reflection models.
// What changes slowly over a surface is worked out at its vertices, the rest at its pixels.

#include "frame"

@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;

// Reads of the shadow map: 1, 2 or 9.
override SHADOW_TAPS: u32 = 2u;

// A world position in the shadow map: its place there and its depth. It is moved off the surface, so
// that the surface does not shade itself.
fn shadow_place(world: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let off = world + normal * 1.3 + frame.key_dir.xyz * 0.9;
    let clip = frame.shadow_from_world * vec4(off, 1.0);
    return vec3(clip.xy * vec2(0.5, -0.5) + 0.5, clip.z);
}

fn shadow_read(at: vec2<f32>, depth: f32) -> f32 {
    return textureSampleCompareLevel(shadow_map, shadow_sampler, at, depth);
}

// Step of the widest reads as a share of the map.
const WIDE_STEP: f32 = 0.012;

// Each read is itself a smooth mean of four texels: at a texel's distance they join without steps. The
// map is coarse on purpose: its texel is the softness of the lamp.
fn shadow_of_two(place: vec3<f32>) -> f32 {
    let d = vec2(0.55, 0.35) / f32(textureDimensions(shadow_map).x);
    return 0.5 * (shadow_read(place.xy + d, place.z) + shadow_read(place.xy - d, place.z));
}

fn shadow_of_nine(place: vec3<f32>) -> f32 {
    let d = 1.5 / f32(textureDimensions(shadow_map).x);
    var sum = 0.0;
    for (var i = -1; i <= 1; i++) {
        for (var j = -1; j <= 1; j++) {
            sum += shadow_read(place.xy + vec2(f32(i), f32(j)) * d, place.z);
        }
    }
    return sum / 9.0;
}

// Share of the key light that reaches that place.
fn key_visible(place: vec3<f32>) -> f32 {
    if SHADOW_TAPS == 1u {
        return shadow_read(place.xy, place.z);
    }
    if SHADOW_TAPS == 2u {
        return shadow_of_two(place);
    }
    return shadow_of_nine(place);
}

// The same, softer than the lamp is: for vertices too far apart to show its edge.
fn key_visible_around(place: vec3<f32>) -> f32 {
    var sum = 0.0;
    for (var i = -1; i <= 1; i++) {
        for (var j = -1; j <= 1; j++) {
            sum += shadow_read(place.xy + vec2(f32(i), f32(j)) * WIDE_STEP, place.z);
        }
    }
    return sum / 9.0;
}

// Ambient light from around a direction: the room's nine numbers a colour. Keep in step with harmonics.rs.
fn ambient_from(n: vec3<f32>) -> vec3<f32> {
    let v = vec4(n, 1.0);
    let q = n.xyzz * n.yzzx;
    let broad = vec3(dot(frame.ambient[0], v), dot(frame.ambient[1], v), dot(frame.ambient[2], v));
    let crossed = vec3(dot(frame.ambient[3], q), dot(frame.ambient[4], q), dot(frame.ambient[5], q));
    return max(broad + crossed + frame.ambient[6].rgb * (n.x * n.x - n.y * n.y), vec3(0.0));
}

// Occlusion of a coloured surface: what bounces within a fold keeps the surface's colour.
fn bounced(occlusion: f32, albedo: vec3<f32>) -> vec3<f32> {
    return vec3(occlusion) / (1.0 - albedo * 0.85 * (1.0 - occlusion));
}

// GGX with the visibility and Fresnel terms folded into one cheap divisor; times F0 it is a specular
// reflectance in units where a matte white is 1. `roughness` is perceptual.
fn gloss_lobe(ndh: f32, ldh: f32, roughness: f32) -> f32 {
    let a = roughness * roughness;
    let a2 = a * a;
    let d = ndh * ndh * (a2 - 1.0) + 1.00001;
    return a2 / (d * d * max(0.1, ldh * ldh) * (a * 4.0 + 2.0));
}

fn gloss(n: vec3<f32>, v: vec3<f32>, l: vec3<f32>, roughness: f32) -> f32 {
    let h = normalize(l + v);
    return gloss_lobe(max(dot(n, h), 0.0), max(dot(l, h), 0.0), roughness) * max(dot(n, l), 0.0);
}

// Schlick's fifth power.
fn grazing(cosine: f32) -> f32 {
    let m = clamp(1.0 - cosine, 0.0, 1.0);
    let m2 = m * m;
    return m2 * m2 * m;
}

// Light that a matte surface sends back, shadow included. For vertices.
fn matte(albedo: vec3<f32>, n: vec3<f32>, world: vec3<f32>, occlusion: f32) -> vec3<f32> {
    let key = frame.key_colour.rgb * key_visible_around(shadow_place(world, n));
    let light = key * max(dot(n, frame.key_dir.xyz), 0.0)
        + frame.fill_colour.rgb * max(dot(n, frame.fill_dir.xyz) * 0.75 + 0.25, 0.0) * occlusion
        + frame.rim_colour.rgb * max(dot(n, frame.rim_dir.xyz), 0.0)
        + ambient_from(n) * bounced(occlusion, albedo);
    return albedo * light;
}
