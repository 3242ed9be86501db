// Teeth: enamel over dentine. Yellower and darker to the neck; at the biting edge there is only enamel, which lets the
// dark of the mouth show through bluish; the film of spit on it glistens. uv.y is 0 at the edge, 1 at the neck.

#include "mouth"
#include "noise"

@fragment
fn teeth(in: MouthFragment) -> @location(0) vec4<f32> {
    let n = normalize(in.normal);
    // Light wanders inside a crown, so that its sides are not as dark as they are turned away: below the surface the
    // row counts as one arch.
    let arch = vec3(in.head.x - frame.mouth.x, 0.0, in.head.z - frame.mouth.z + 34.0);
    let row = normalize((frame.bodies[1] * vec4(arch, 0.0)).xyz);
    let body = normalize(mix(n, row, 0.55));
    let inside = lit_mouth(in, body);

    let neck = smoothstep(0.30, 0.95, in.uv.y);
    let shade = value_noise(vec2(in.head.x * 0.9, in.uv.y * 2.0)) - 0.5;
    var albedo = mix(vec3(0.545, 0.488, 0.395), vec3(0.50, 0.40, 0.27), neck) * (1.0 + 0.07 * shade);
    // Between crowns dentine is deep and light goes astray.
    albedo *= mix(vec3(0.62, 0.52, 0.44), vec3(1.0), smoothstep(0.05, 0.75, dot(n, row)));
    // Only incisors and canines are thin at the edge; molars end in a flat crown.
    let thin = (1.0 - smoothstep(0.04, 0.19, in.uv.y)) * (1.0 - smoothstep(14.0, 21.0, abs(in.head.x - frame.mouth.x)));
    albedo = mix(albedo, vec3(0.42, 0.43, 0.43), 0.55 * thin);
    // What is far behind the lips is lit through flesh and spit: dim and red.
    let behind = max(frame.mouth.z - 11.0 - in.head.z, 0.0);
    let depth = 1.0 - exp(-0.075 * behind);
    let light = wet_surface(in, inside, body, n, albedo, 0.20, 0.05, 0.35);
    // What little comes past the lips has their colour.
    let past = mix(vec3(1.12, 0.93, 0.82), vec3(1.0), smoothstep(0.05, 0.45, inside.seen));
    return developed(light * past * mix(vec3(1.0), vec3(0.45, 0.27, 0.21), depth));
}
