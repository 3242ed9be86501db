// The eyeball: a painted iris seen through a bulging, wet cornea; white that is not white; the shadow
// of the lids on it, which follows their opening (HABER 4.1: the aperture controls the brightness); a
// catch-light that never goes out.

#include "part"
#include "light"

@group(2) @binding(0) var map_sampler: sampler;
@group(2) @binding(1) var eye_map: texture_2d<f32>;
@group(2) @binding(2) var unused_map: texture_2d<f32>;

// The eye map covers this many iris radii from its middle. Keep in step with maps/eye.rs.
const MAP_REACH: f32 = 3.0;

// The lamp's picture in the wet surface: a soft-edged window round its direction.
fn lamp_mirrored(mirrored: vec3<f32>, lamp: vec4<f32>) -> f32 {
    let cosine = dot(mirrored, lamp.xyz);
    let edge = cos(lamp.w);
    return smoothstep(edge - 0.02, edge + 0.01, cosine);
}

@fragment
fn eye(in: PartFragment) -> @location(0) vec4<f32> {
    let n = normalize(in.normal);
    let v = normalize(frame.eye.xyz - in.world);
    let side = select(1u, 0u, in.head.x > 0.0);
    let ball = frame.eyeballs[side];

    // The cornea is a smaller sphere set into the ball: its normals turn faster.
    let r = length(in.uv);
    let bulge = 1.0 - smoothstep(0.85, 1.2, r);
    let axis_x = normalize(cross(vec3(0.0, 1.0, 0.0), n));
    let axis_y = cross(n, axis_x);
    let tilt = in.uv * (0.30 * bulge);
    let cornea = normalize(n + axis_x * tilt.x + axis_y * tilt.y);

    // Refraction: the iris lies behind the cornea, so it shifts against the eye's own motion.
    let sight = vec2(dot(v, axis_x), dot(v, axis_y));
    let iris_uv = in.uv - sight * (0.28 * bulge * bulge);
    let texel = textureSample(eye_map, map_sampler, iris_uv * (0.5 / MAP_REACH) + 0.5);
    let albedo = texel.rgb * texel.rgb;
    let iris = texel.a;

    // Lids: shadow of the upper one, contact of both, dim corners.
    let at = (in.head.xy - ball.xy) / ball.w;
    let poly = vec3(1.0, at.x, at.x * at.x);
    let upper = dot(frame.lids[side * 2u].xyz, poly) - at.y;
    let lower = at.y - dot(frame.lids[side * 2u + 1u].xyz, poly);
    let open = frame.lids[side * 2u].w;
    let shade = mix(0.30, 1.0, smoothstep(-0.04, 0.34, upper));
    let contact = mix(0.45, 1.0, smoothstep(-0.03, 0.10, min(upper, lower)));
    let corner = 1.0 - 0.45 * smoothstep(0.55, 1.0, abs(at.x));
    let sky = shade * contact * corner * mix(0.55, 1.0, open);

    // The iris is a dish lit from across: it brightens away from the lamp.
    let l = frame.key_dir.xyz;
    let caustic = 1.0 - iris * 0.9 * dot(vec2(dot(l, axis_x), dot(l, axis_y)), in.uv) * 0.6;
    let visible = mix(key_visible(in.world, n), 1.0, 0.25);
    let wrap = vec3(0.35, 0.25, 0.22);
    let key = clamp((vec3(dot(n, l)) + wrap) / (1.0 + wrap), vec3(0.0), vec3(1.0));
    var light = albedo * frame.key_colour.rgb * key * (visible * shade * corner * caustic);
    light += albedo * frame.fill_colour.rgb * (max(dot(n, frame.fill_dir.xyz) * 0.7 + 0.3, 0.0) * sky);
    light += albedo * ambient_from(n) * (sky * contact);

    // What the wet surface mirrors: lamps, and the room at its edge.
    let mirrored = reflect(-v, cornea);
    let seen = smoothstep(0.0, 0.08, upper) * smoothstep(0.0, 0.05, lower);
    let lamps = lamp_mirrored(mirrored, frame.key_dir) * 0.85 * frame.key_colour.rgb
        + lamp_mirrored(mirrored, frame.fill_dir) * 0.10 * frame.fill_colour.rgb;
    let film = 0.025 + 0.55 * grazing(max(dot(cornea, v), 0.0));
    light += lamps * (seen * mix(0.35, 1.0, bulge));
    light += ambient_from(mirrored) * (film * sky);
    // A tear line along the lower lid.
    let tear = smoothstep(0.09, 0.05, lower) * smoothstep(0.0, 0.03, lower) * seen;
    light += frame.key_colour.rgb * (tear * 0.10 * corner);
    return developed(light);
}
