// Tongue: a rough wet surface; the papillae break the highlight up, a furrow runs down the middle.

#include "mouth"
#include "noise"

@fragment
fn tongue(in: MouthFragment) -> @location(0) vec4<f32> {
    let p = in.head;
    let grain = vec3(value_noise(p.xz * 1.9), value_noise(p.zx * 1.9 + 17.0), value_noise(p.xz * 0.7 + 5.0)) - 0.5;
    let n = normalize(in.normal + vec3(grain.x, 0.0, grain.y) * 0.5);
    let furrow = 1.0 - 0.25 * exp(-p.x * p.x * 0.35);
    let albedo = vec3(0.42, 0.135, 0.125) * (furrow * (1.0 + 0.25 * grain.z));
    return developed(wet_surface(in, n, albedo, 0.42, 0.04, 0.35));
}
