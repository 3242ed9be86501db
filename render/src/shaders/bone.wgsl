// Bone: old ivory, a little mottled, warm where light does not reach.

#include "anatomy"

@fragment
fn bone(in: AnatomyFragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let n = normalize(in.normal) * select(-1.0, 1.0, front);
    let coarse = grain(in.rest * 0.11, n);
    let fine = grain(in.rest * 0.9, n);
    let stain = smoothstep(0.35, 0.85, coarse) * 0.6 + 0.25 * fine;
    let depth = 1.0 - in.occlusion;
    var albedo = mix(vec3(0.68, 0.585, 0.43), vec3(0.56, 0.445, 0.285), stain);
    albedo = mix(albedo, vec3(0.36, 0.21, 0.11), depth * 0.75);
    // The vault's inside, seen through an orbit.
    albedo *= select(0.25, 1.0, front);
    return developed(lit(in.world, n, albedo, in.occlusion, 0.5, 0.03, 0.12));
}
