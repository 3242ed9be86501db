// Springs as bars: what kind they are is their colour, how far they are stretched its brightness and hue.

#include "anatomy"

@fragment
fn spring(in: AnatomyFragment) -> @location(0) vec4<f32> {
    let strain = clamp(in.uv.y * 4.0, -1.0, 1.0);
    // Keep in step with rig's SpringKind: skin, bone, muscle.
    var colour = vec3(0.50, 0.47, 0.42);
    if in.uv.x > 1.5 {
        colour = vec3(0.62, 0.060, 0.045);
    } else if in.uv.x > 0.5 {
        colour = vec3(0.055, 0.20, 0.30);
    } else {
        colour = mix(colour, vec3(0.95, 0.33, 0.03), max(strain, 0.0));
        colour = mix(colour, vec3(0.04, 0.22, 0.85), max(-strain, 0.0));
    }
    let n = normalize(in.normal);
    let light = 0.75 + 0.45 * max(dot(n, frame.key_dir.xyz), 0.0);
    return developed(colour * light);
}
