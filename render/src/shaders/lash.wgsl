// Lashes: nearly black, lit from both sides. Lit at their vertices.

#include "part"
#include "light"

struct LashFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) light: vec3<f32>,
}

@vertex
fn lash_vertex(in: PartVertex) -> LashFragment {
    let at = placed(in, 0.0);
    let n = normalize(at.normal);
    let albedo = vec3(0.018, 0.013, 0.011);
    var out: LashFragment;
    out.clip = frame.clip_from_world * vec4(at.world, 1.0);
    out.light = albedo * (ambient_from(n) + 0.5 * frame.key_colour.rgb * abs(dot(n, frame.key_dir.xyz)));
    return out;
}

@fragment
fn lash(in: LashFragment) -> @location(0) vec4<f32> {
    return developed(in.light);
}
