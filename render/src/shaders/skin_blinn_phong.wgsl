// Skin as HEADSHOP 4.4 shades it: Blinn and Phong's model in one pass over four maps, the glossy part by the mask's
// gloss, the bumps by its intensity. No scattering: the terminator is the lamp's alone.

#include "skin_surface"

// Phong's exponent for skin's broad highlight, and for wet lips.
const SHINE: f32 = 22.0;
const SHINE_WET: f32 = 90.0;

@fragment
fn skin_blinn_phong(in: SkinFragment) -> @location(0) vec4<f32> {
    let s = surface(in);
    let reached = key_reaching(in).y;
    let wet = max(in.shares.y, 0.6 * s.red);
    let cosine = max(dot(s.normal, frame.key_dir.xyz), 0.0);
    let half = max(dot(s.normal, frame.half_key.xyz), 0.0);
    let shine = mix(SHINE, SHINE_WET, wet);
    let glossy = 0.55 * mix(s.gloss, 0.6, s.red) * s.open * pow(half, shine) * min(9.0 * s.albedo.g, 1.0);
    let light = s.albedo * (frame.key_colour.rgb * (cosine * reached) + in.soft.xyz)
        + frame.key_colour.rgb * (glossy * reached * min(cosine * 4.0, 1.0));
    return developed(light);
}
