// Teeth: slightly warm enamel, darker towards the gum and inside the mouth, a wet highlight.

#include "mouth"

@fragment
fn teeth(in: MouthFragment) -> @location(0) vec4<f32> {
    let n = normalize(in.normal);
    let albedo = vec3(0.60, 0.545, 0.45);
    return developed(wet_surface(in, n, albedo, 0.24, 0.045, 0.25));
}
