// Skin, physically based: two glossy lobes, what they mirror taken from what is scattered, scattering under the
// surface that softens the terminator and reddens it, light that shines through where skin is thin.

#include "skin_surface"

// Whether all lamps and the room see the bumps pixel by pixel, or only the key lamp.
override ALL_LAMPS: bool = false;

// Fill, rim and the room's light on a pixel: what the skin's colour multiplies, and in w what is mirrored.
fn all_but_key(in: SkinFragment, n: vec3<f32>, edge: f32, roughness: f32) -> vec4<f32> {
    let v = frame.toward_camera.xyz;
    let occlusion = in.shares.z;
    let width = creep(in.shares.w);
    let fill_cos = seen_by(dot(n, frame.fill_dir.xyz), dot(in.normal.xyz, frame.fill_dir.xyz));
    let rim_cos = seen_by(dot(n, frame.rim_dir.xyz), dot(in.normal.xyz, frame.rim_dir.xyz));
    let soft = frame.fill_colour.rgb * scattered(fill_cos, width) * lamp_reaching(occlusion)
        + frame.rim_colour.rgb * scattered(rim_cos, width) * occlusion
        + ambient_from(n) * (bounced(occlusion, SKIN) + 0.35 * edge * occlusion);
    let fill = gloss(n, v, frame.fill_dir.xyz, roughness) * occlusion;
    let rim = gloss(n, v, frame.rim_dir.xyz, roughness) * (1.0 + 6.0 * edge) * occlusion * occlusion;
    let mirrored = (frame.fill_colour.rgb * fill + frame.rim_colour.rgb * rim) * 0.8 * MIRROR
        + ambient_from(reflect(-v, n)) * ((0.020 + 0.10 * edge) * occlusion * occlusion);
    return vec4(soft, dot(mirrored, vec3(0.3333)));
}

// Red light travels furthest under the skin, so it sees least of the bumps.
fn seen_by(bumped: f32, smooth_cos: f32) -> vec3<f32> {
    return mix(vec3(bumped), vec3(smooth_cos), vec3(0.62, 0.32, 0.22));
}

@fragment
fn skin(in: SkinFragment) -> @location(0) vec4<f32> {
    let s = surface(in);
    let smooth_n = in.normal.xyz;
    let n = s.normal;
    let wet = in.shares.y;
    let oil = mix(s.gloss, 0.62, s.red);
    let roughness = mix(mix(0.60, 0.46, oil), mix(0.40, 0.22, wet), max(s.red * 0.8, wet));

    let l = frame.key_dir.xyz;
    let smooth_cos = dot(smooth_n, l);
    let bumped_cos = dot(n, l);
    let shadow = key_reaching(in);
    let visible = shadow.x;
    let reached = shadow.y;
    // In the soft edge of a shadow red light has crept in under the skin.
    let bleed = vec3(reached) + vec3(0.13, 0.01, 0.0) * (visible - visible * visible);
    let edge = grazing(max(dot(n, frame.toward_camera.xyz), 0.0));
    var others: vec4<f32>;
    if ALL_LAMPS {
        others = all_but_key(in, n, edge, roughness);
    } else {
        // What the vertices know of the other lamps, and what the bumps make of that.
        let tilt = dot(n - smooth_n, frame.fill_dir.xyz + vec3(0.0, 0.4, 0.0));
        others = vec4(in.soft.xyz * (1.0 + 0.8 * tilt), in.normal.w * max(1.0 + 2.5 * tilt, 0.0));
    }
    let cosine = seen_by(bumped_cos, smooth_cos);
    let matte = frame.key_colour.rgb * scattered(cosine, creep(in.shares.w)) * bleed + others.xyz;

    // Mirrored at grazing sight, more so the sleeker; scattered is what is left.
    let mirror = MIRROR + 0.30 * edge * oil;
    var light = s.albedo * matte * (1.0 - mirror);

    // Oil: a broad lobe and a tighter one; water on the lips. The camera is far off, so one direction
    // half-way to the key lamp does for the whole head. Both GGX lobes over one divisor.
    let ndh = max(dot(n, frame.half_key.xyz), 0.0);
    let ndh2 = ndh * ndh;
    let a = roughness * roughness;
    let a2 = a * a;
    let b2 = a2 * 0.1132;
    let da = ndh2 * (a2 - 1.0) + 1.00001;
    let db = ndh2 * (b2 - 1.0) + 1.00001;
    let da2 = da * da;
    let db2 = db * db;
    let lobes = (0.72 * a2 * db2 + 0.28 * b2 * da2) / (da2 * db2);
    // Painted hair does not shine like skin.
    let oiled = (0.25 + 1.2 * oil) * min(9.0 * s.albedo.g, 1.0) * s.open;
    let strength = MIRROR * frame.half_key.w * oiled * (0.35 + 0.65 * in.shares.z);
    light += frame.key_colour.rgb * (strength * lobes * max(bumped_cos, 0.0) * reached);
    light += vec3(others.w * oiled);
    // Light from behind shines red through ears and nostrils.
    let behind = max(0.35 - dot(smooth_n, frame.rim_dir.xyz), 0.0);
    light += frame.rim_colour.rgb * vec3(0.024, 0.006, 0.003) * (s.through * in.shares.z * (0.4 + behind));
    return developed(light);
}
