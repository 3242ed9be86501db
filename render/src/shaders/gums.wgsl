// Gums: wet, red, soft.

#include "mouth"

@fragment
fn gums(in: MouthFragment) -> @location(0) vec4<f32> {
    let n = normalize(in.normal);
    return developed(wet_surface(in, n, vec3(0.36, 0.105, 0.095), 0.32, 0.04, 0.35));
}
