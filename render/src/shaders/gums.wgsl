// Gums: wet, red, soft; stippled as an orange's peel.

#include "mouth"
#include "noise"

@fragment
fn gums(in: MouthFragment) -> @location(0) vec4<f32> {
    let p = in.head.xy * 1.6;
    let stipple = vec3(value_noise(p) - 0.5, value_noise(p + 31.0) - 0.5, 0.0);
    let body = normalize(in.normal);
    let n = normalize(in.normal + stipple * 0.35);
    return developed(wet_surface(in, lit_mouth(in, body), body, n, vec3(0.37, 0.135, 0.120), 0.30, 0.04, 0.40));
}
