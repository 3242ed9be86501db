// The inside of the mouth behind the teeth: dark red that falls to black with depth.

#include "mouth"

@fragment
fn cavity(in: MouthFragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let n = normalize(select(-in.normal, in.normal, front));
    let depth = clamp((frame.mouth.z - in.head.z) / 45.0, 0.0, 1.0);
    let albedo = mix(vec3(0.26, 0.07, 0.062), vec3(0.09, 0.020, 0.018), depth);
    let inside = lit_mouth(in, n);
    let light = wet_surface(in, inside, n, n, albedo, 0.45, 0.03, 0.3);
    // Light that wet walls throw at one another once the lips let it in: dim red, never a black hole.
    return developed(light + albedo * frame.key_colour.rgb * (inside.thrown * (1.0 - 0.8 * depth)));
}
