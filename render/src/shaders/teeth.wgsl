// Teeth: slightly warm enamel, darker towards the gum and inside the mouth, a wet highlight.

#include "mouth"

@fragment
fn teeth(in: MouthFragment) -> @location(0) vec4<f32> {
    let n = normalize(in.normal);
    // Beside and behind the opening's middle, flesh stands between a tooth and the light: what comes is dim and red.
    let aside = max(abs(in.head.x - frame.mouth.x) - 0.45 * frame.mouth.w, 0.0);
    let behind = max(frame.mouth.z - 9.0 - in.head.z, 0.0);
    let depth = 1.0 - exp(-0.016 * aside * aside - 0.10 * behind);
    let albedo = vec3(0.60, 0.545, 0.45);
    let tint = mix(vec3(1.0), vec3(0.42, 0.25, 0.20), depth);
    return developed(wet_surface(in, n, albedo, 0.24, 0.045, 0.25) * tint);
}
