// Muscle: red-brown flesh in bundles of fibres, ending in pale silky tendon (HABER 4.2, drawn as anatomical
// plates do). `uv` says where along and across the fibres a place is: see Material::Muscle.

#include "anatomy"

// Height of the bundles' relief at a place across the fibres, 0..1: bundles of some millimetres, fibres in them.
// What is finer than `width` mm, the picture's own grain, is left out.
fn bundles(across: f32, along: f32, width: f32) -> f32 {
    let drift = (value_noise(vec2(across * 0.30, along * 4.0)) - 0.5) * 0.9;
    let at = across + drift;
    let a = value_noise(vec2(at * 0.55, along * 1.5 + 7.0)) - 0.5;
    let b = value_noise(vec2(at * 1.3, along * 2.5)) - 0.5;
    let c = value_noise(vec2(at * 2.9, along * 4.0 + 3.0)) - 0.5;
    let seen = 1.0 - smoothstep(vec3(0.25), vec3(0.8), width * vec3(0.55, 1.3, 2.9));
    return 0.5 + 0.42 * a * seen.x + 0.40 * b * seen.y + 0.32 * c * seen.z;
}

@fragment
fn muscle(in: AnatomyFragment) -> @location(0) vec4<f32> {
    var n = normalize(in.normal);
    let along = in.uv.x;
    let across = in.uv.y;
    let width = fwidth(across);
    let height = bundles(across, along, width);

    // Which way across the fibres is on the surface, from how uv changes over the picture.
    let px = dpdx(in.world);
    let py = dpdy(in.world);
    let vx = dpdx(across);
    let vy = dpdy(across);
    let area = cross(px, py);
    let slope = (cross(py, area) * vx + cross(area, px) * vy) / max(dot(area, area), 1e-12);
    let side = normalize(slope + vec3(1e-6));
    let d = 0.06;
    let rise = (bundles(across + d, along, width) - bundles(across - d, along, width)) / (2.0 * d);

    // Flesh runs into tendon in streaks of its own length each.
    let streak = (value_noise(vec2(across * 1.6, 41.0)) - 0.5) * 0.16 + (value_noise(vec2(across * 5.0, 17.0)) - 0.5) * 0.06;
    let beyond = max(-along, along - 1.0) + streak;
    let tendon = smoothstep(-0.07, 0.05, beyond);

    n = normalize(n - side * rise * mix(0.85, 0.35, tendon));
    let deep = vec3(0.085, 0.0125, 0.010);
    let flesh = vec3(0.235, 0.050, 0.034);
    let pale = vec3(0.38, 0.135, 0.088);
    var red = mix(deep, flesh, smoothstep(0.28, 0.56, height));
    red = mix(red, pale, smoothstep(0.58, 0.82, height) * 0.65);
    let silk = mix(vec3(0.47, 0.365, 0.25), vec3(0.72, 0.635, 0.50), smoothstep(0.3, 0.7, height));
    let albedo = mix(red, silk, tendon);
    return developed(lit(in.world, n, albedo, in.occlusion, mix(0.46, 0.38, tendon), 0.026, mix(0.20, 0.10, tendon)));
}
