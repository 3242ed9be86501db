// Lashes: nearly black, lit from both sides. Lit at their vertices. They turn with their lid: uv.x is where the root
// lies over the eyeball, in its radii from its centre; uv.y runs from root (0) to tip (1), plus 2 on the lower lid.

#include "part"
#include "light"

struct LashFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) light: vec3<f32>,
}

// How high over the ball's equator a lid's margin lies at a place across it, radians.
fn margin(lid: vec4<f32>, x: f32) -> f32 {
    let height = dot(lid.xyz, vec3(1.0, x, x * x));
    return asin(clamp(height * inverseSqrt(max(1.0 - x * x, 0.1)), -1.0, 1.0));
}

@vertex
fn lash_vertex(in: PartVertex) -> LashFragment {
    let side = select(1u, 0u, in.rest.x > 0.0);
    let lid = side * 2u + select(0u, 1u, in.uv.y > 1.5);
    let turn = margin(frame.lids[lid], in.uv.x) - margin(frame.lids_at_rest[lid], in.uv.x);
    let c = cos(turn);
    let s = sin(turn);
    let centre = frame.eyeballs[side].xyz;
    let off = in.rest - centre;
    var turned = in;
    turned.rest = centre + vec3(off.x, off.y * c + off.z * s, off.z * c - off.y * s);
    let at = placed(turned, 0.0);
    let n = normalize(at.normal);
    // Brown where light gets through the thin tips.
    let albedo = mix(vec3(0.014, 0.010, 0.009), vec3(0.040, 0.026, 0.019), fract(in.uv.y * 0.999));
    var out: LashFragment;
    out.clip = frame.clip_from_world * vec4(at.world, 1.0);
    out.light = albedo * (ambient_from(n) + 0.5 * frame.key_colour.rgb * abs(dot(n, frame.key_dir.xyz)));
    return out;
}

@fragment
fn lash(in: LashFragment) -> @location(0) vec4<f32> {
    return developed(in.light);
}
