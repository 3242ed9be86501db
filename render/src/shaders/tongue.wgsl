// Tongue: a rough wet surface. Papillae break the highlight up, larger ones stand as red dots in a paler coat, a furrow
// runs down the middle.

#include "mouth"
#include "noise"

@fragment
fn tongue(in: MouthFragment) -> @location(0) vec4<f32> {
    let p = in.head.xz * vec2(1.0, 0.8);
    let fine = vec2(value_noise(p * 2.3), value_noise(p * 2.3 + 17.0)) - 0.5;
    let coarse = vec2(value_noise(p * 0.85 + 5.0), value_noise(p * 0.85 + 41.0)) - 0.5;
    let body = normalize(in.normal);
    let bumps = fine * 0.75 + coarse * 0.60;
    let n = normalize(body + vec3(bumps.x, 0.0, bumps.y));
    let rough = normalize(body + vec3(bumps.x, 0.0, bumps.y) * 0.5);
    let furrow = 1.0 - 0.30 * exp(-in.head.x * in.head.x * 0.22);
    let dots = smoothstep(0.66, 0.86, value_noise(p * 1.5 + 9.0));
    let coat = mix(vec3(0.58, 0.325, 0.300), vec3(0.49, 0.205, 0.185), max(dots * 0.8, 0.5 - fine.x));
    return developed(wet_surface(in, lit_mouth(in, rough), rough, n, coat * (furrow * (1.0 + 0.3 * coarse.y)), 0.30, 0.06, 0.40));
}
