// Cloth: matte, with the pale edge that fibres standing off it make. Lit at its vertices.

#include "part"
#include "light"

struct ClothFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) light: vec3<f32>,
}

@vertex
fn cloth_vertex(in: PartVertex) -> ClothFragment {
    let at = placed(in, 0.0);
    let n = normalize(at.normal);
    let v = normalize(frame.eye.xyz - at.world);
    let albedo = vec3(0.040, 0.045, 0.054);
    let fuzz = albedo * ambient_from(n) * (grazing(dot(n, v)) * 0.5);
    var out: ClothFragment;
    out.clip = frame.clip_from_world * vec4(at.world, 1.0);
    out.light = matte(albedo, n, at.world, in.shares.x) + fuzz;
    return out;
}

@fragment
fn cloth(in: ClothFragment) -> @location(0) vec4<f32> {
    return developed(in.light);
}
