// Lashes: nearly black, lit from both sides. uv.y runs from root to tip.

#include "part"
#include "light"

@fragment
fn lash(in: PartFragment, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let n = normalize(select(-in.normal, in.normal, front));
    let albedo = vec3(0.018, 0.013, 0.011);
    let light = albedo * (ambient_from(n) + 0.6 * frame.key_colour.rgb * max(dot(n, frame.key_dir.xyz), 0.0));
    return vec4(developed(light).rgb, 1.0);
}
