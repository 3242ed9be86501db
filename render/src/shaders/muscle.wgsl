// Muscle: red-brown flesh in bundles of fibres, ending in pale silky tendon (HABER 4.2, drawn as anatomical
// plates do). `uv` says where along and across the fibres a place is: see Material::Muscle.

#include "anatomy"

// Height of the bundles' relief at a place across the fibres, 0..1: bundles of some millimetres, fibres in them.
fn bundles(across: f32, along: f32) -> f32 {
    let drift = (value_noise(vec2(across * 0.35, along * 5.0)) - 0.5) * 0.8;
    let a = value_noise(vec2((across + drift) * 0.75, along * 2.0 + 7.0));
    let b = value_noise(vec2((across + drift) * 1.9, along * 3.5));
    let c = value_noise(vec2(across * 4.6, along * 6.0 + 3.0));
    return 0.42 * a + 0.36 * b + 0.22 * c;
}

@fragment
fn muscle(in: AnatomyFragment) -> @location(0) vec4<f32> {
    var n = normalize(in.normal);
    let along = in.uv.x;
    let across = in.uv.y;
    let height = bundles(across, along);

    // Which way across the fibres is on the surface, from how uv changes over the picture.
    let px = dpdx(in.world);
    let py = dpdy(in.world);
    let vx = dpdx(across);
    let vy = dpdy(across);
    let area = cross(px, py);
    let slope = (cross(py, area) * vx + cross(area, px) * vy) / max(dot(area, area), 1e-12);
    let side = normalize(slope + vec3(1e-6));
    let d = 0.06;
    let rise = (bundles(across + d, along) - bundles(across - d, along)) / (2.0 * d);

    // Flesh runs into tendon in streaks of its own length each.
    let streak = (value_noise(vec2(across * 1.6, 41.0)) - 0.5) * 0.16 + (value_noise(vec2(across * 5.0, 17.0)) - 0.5) * 0.06;
    let beyond = max(-along, along - 1.0) + streak;
    let tendon = smoothstep(-0.07, 0.05, beyond);

    n = normalize(n - side * rise * mix(0.55, 0.22, tendon));
    let deep = vec3(0.150, 0.026, 0.020);
    let flesh = vec3(0.40, 0.098, 0.066);
    let pale = vec3(0.54, 0.235, 0.165);
    var red = mix(deep, flesh, smoothstep(0.18, 0.55, height));
    red = mix(red, pale, smoothstep(0.62, 0.86, height) * 0.7);
    let silk = mix(vec3(0.56, 0.46, 0.335), vec3(0.80, 0.73, 0.60), smoothstep(0.25, 0.75, height));
    let albedo = mix(red, silk, tendon);
    let colour = lit(in.world, n, albedo, in.occlusion, mix(0.42, 0.36, tendon), 0.035, mix(0.22, 0.12, tendon));
    return developed(colour);
}
