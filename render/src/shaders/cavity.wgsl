// The inside of the mouth behind the teeth: dark red that falls to black with depth.

#include "mouth"

@fragment
fn cavity(in: MouthFragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let n = normalize(select(-in.normal, in.normal, front));
    let depth = clamp((frame.mouth.z - in.head.z) / 45.0, 0.0, 1.0);
    let albedo = mix(vec3(0.26, 0.06, 0.055), vec3(0.07, 0.013, 0.012), depth);
    let lit = (ambient_from(n) + 0.4 * frame.key_colour.rgb) * in.inside.x + 0.25 * frame.key_colour.rgb * in.inside.y * max(dot(n, frame.key_dir.xyz), 0.0);
    // Light that wet walls throw at one another once the lips let it in: dim red, never a black hole.
    let thrown = 0.16 * clamp(frame.mouth_height.x / 5.0, 0.0, 1.0) * (1.0 - 0.8 * depth);
    return developed(albedo * (lit * in.inside.w + frame.key_colour.rgb * thrown));
}
