// Bone and bared teeth: old ivory, a little mottled, warm where light does not reach. `uv`: see Material::Bone.

#include "anatomy"

@fragment
fn bone(in: AnatomyFragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let n = normalize(in.normal) * select(-1.0, 1.0, front);
    let tooth = in.uv.x;
    let coarse = 0.5 * grain(in.rest * 0.045, n) + 0.3 * grain(in.rest * 0.11 + 31.0, n) + 0.2 * grain(in.rest * 0.27, n);
    let fine = grain(in.rest * 0.8, n) * 0.6 + grain(in.rest * 1.9, n) * 0.4;
    let stain = smoothstep(0.30, 0.80, coarse) * 0.55 + 0.22 * fine;
    let depth = 1.0 - in.occlusion;
    var albedo = mix(vec3(0.62, 0.505, 0.355), vec3(0.50, 0.365, 0.225), stain);
    albedo = mix(albedo, vec3(0.30, 0.155, 0.075), smoothstep(0.15, 0.95, depth) * 0.8);
    albedo = mix(albedo, vec3(0.66, 0.585, 0.455), tooth * (1.0 - 0.5 * depth));
    // The vault's inside, seen through an orbit.
    albedo *= select(0.25, 1.0, front) * mix(1.0, 0.10, in.uv.y);
    let light = lit(in.world, n, albedo, in.occlusion, mix(0.5, 0.25, tooth), 0.035 * mix(1.0, 0.3, in.uv.y), 0.12);
    return developed(light);
}
