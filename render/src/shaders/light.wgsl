// The studio: key with a shadow, fill, rim, ambient; and the pieces of the reflection models.

#include "frame"

@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;

// Reads of the shadow map a pixel: 1, 4 or 9.
override SHADOW_TAPS: u32 = 4u;

// Share of the key light that reaches a world position. The place is moved off the surface, so that
// it does not shade itself.
fn key_visible(world: vec3<f32>, normal: vec3<f32>) -> f32 {
    let off = world + normal * 2.0 + frame.key_dir.xyz * 1.5;
    let clip = frame.shadow_from_world * vec4(off, 1.0);
    let uv = clip.xy * vec2(0.5, -0.5) + 0.5;
    let texel = 1.0 / f32(textureDimensions(shadow_map).x);
    if SHADOW_TAPS == 1u {
        return textureSampleCompareLevel(shadow_map, shadow_sampler, uv, clip.z);
    }
    var sum = 0.0;
    if SHADOW_TAPS == 4u {
        // A turned square: softer than a straight one for the same four reads.
        let a = vec2(2.1, 0.8) * texel * 1.4;
        let b = vec2(-a.y, a.x);
        sum = textureSampleCompareLevel(shadow_map, shadow_sampler, uv + a, clip.z)
            + textureSampleCompareLevel(shadow_map, shadow_sampler, uv - a, clip.z)
            + textureSampleCompareLevel(shadow_map, shadow_sampler, uv + b, clip.z)
            + textureSampleCompareLevel(shadow_map, shadow_sampler, uv - b, clip.z);
        return sum * 0.25;
    }
    for (var i = -1; i <= 1; i++) {
        for (var j = -1; j <= 1; j++) {
            let at = uv + vec2(f32(i), f32(j)) * texel * 4.0;
            sum += textureSampleCompareLevel(shadow_map, shadow_sampler, at, clip.z);
        }
    }
    return sum / 9.0;
}

// Ambient light from around a direction.
fn ambient_from(n: vec3<f32>) -> vec3<f32> {
    let v = vec4(n, 1.0);
    return max(vec3(dot(frame.ambient[0], v), dot(frame.ambient[1], v), dot(frame.ambient[2], v)), vec3(0.0));
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

// A plain surface: matte with one glossy lobe. Enough for cloth, gums, lashes.
fn plain(albedo: vec3<f32>, n: vec3<f32>, world: vec3<f32>, occlusion: f32, roughness: f32, f0: f32) -> vec3<f32> {
    let v = normalize(frame.eye.xyz - world);
    let key = frame.key_colour.rgb * key_visible(world, n);
    var light = albedo * key * max(dot(n, frame.key_dir.xyz), 0.0);
    light += albedo * frame.fill_colour.rgb * max(dot(n, frame.fill_dir.xyz) * 0.75 + 0.25, 0.0) * occlusion;
    light += albedo * frame.rim_colour.rgb * max(dot(n, frame.rim_dir.xyz), 0.0);
    light += albedo * ambient_from(n) * bounced(occlusion, albedo);
    light += f0 * key * gloss(n, v, frame.key_dir.xyz, roughness);
    return light;
}
