// Cloth: matte, with the pale edge that fibres standing off it make.

#include "part"
#include "light"

@fragment
fn cloth(in: PartFragment) -> @location(0) vec4<f32> {
    let n = normalize(in.normal);
    let v = normalize(frame.eye.xyz - in.world);
    let albedo = vec3(0.043, 0.052, 0.068);
    let fuzz = grazing(dot(n, v)) * 0.35;
    let light = plain(albedo, n, in.world, in.head.w, 0.9, 0.01);
    return developed(light + albedo * fuzz * ambient_from(n));
}
