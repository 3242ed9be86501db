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

struct EyeFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Place over the ball in its radii, heights of the upper and lower lid there.
    @location(3) lids: vec4<f32>,
    // Light that multiplies the eye's colour: the key's, and the rest.
    @location(4) key: vec3<f32>,
    @location(5) soft: vec3<f32>,
    // Above 0 in the subject's left eye.
    @location(6) side: f32,
}

@vertex
fn eye_vertex(in: PartVertex) -> EyeFragment {
    let at = placed(in, 0.0);
    let n = normalize(at.normal);
    let head = in_head(at.world);
    let side = select(1u, 0u, head.x > 0.0);
    let ball = frame.eyeballs[side];
    let over = (head.xy - ball.xy) / ball.w;
    let poly = vec3(1.0, over.x, over.x * over.x);
    let open = frame.lids[side * 2u].w;

    var out: EyeFragment;
    out.clip = frame.clip_from_world * vec4(at.world, 1.0);
    out.world = at.world;
    out.normal = n;
    out.uv = in.uv;
    out.side = head.x;
    out.lids = vec4(over, dot(frame.lids[side * 2u].xyz, poly), dot(frame.lids[side * 2u + 1u].xyz, poly));
    let visible = mix(key_visible(shadow_place(at.world, n)), 1.0, 0.25);
    let wrap = vec3(0.35, 0.25, 0.22);
    out.key = frame.key_colour.rgb * max((vec3(dot(n, frame.key_dir.xyz)) + wrap) / (1.0 + wrap), vec3(0.0)) * visible;
    out.soft = (frame.fill_colour.rgb * max(dot(n, frame.fill_dir.xyz) * 0.7 + 0.3, 0.0) + ambient_from(n)) * mix(0.55, 1.0, open);
    return out;
}

// The lamp's picture in the wet surface: a soft-edged disc round its direction.
fn lamp_mirrored(mirrored: vec3<f32>, lamp: vec4<f32>) -> f32 {
    let edge = cos(lamp.w);
    return smoothstep(edge - 0.02, edge + 0.01, dot(mirrored, lamp.xyz));
}

@fragment
fn eye(in: EyeFragment) -> @location(0) vec4<f32> {
    let v = normalize(frame.eye.xyz - in.world);
    let r = length(in.uv);
    let bulge = 1.0 - smoothstep(0.85, 1.2, r);
    // The eye's own axes: across, up and along its gaze.
    let turn = frame.bodies[select(4u, 3u, in.side > 0.0)];
    let axis_x = turn[0].xyz;
    let axis_y = turn[1].xyz;
    // The cornea as a sphere of 7.8 mm under an iris of 5.8 mm: smoother than the mesh could be.
    let dome = normalize(turn[2].xyz + (axis_x * in.uv.x + axis_y * in.uv.y) * 0.74);
    let n = normalize(mix(in.normal, dome, bulge));

    // Refraction: the iris lies behind the cornea, so it shifts against the eye's own motion.
    let sight = vec2(dot(v, axis_x), dot(v, axis_y));
    let iris_uv = in.uv - sight * (0.22 * bulge * bulge);
    let texel = textureSample(eye_map, map_sampler, iris_uv * (0.5 / MAP_REACH) + 0.5);
    let albedo = texel.rgb * texel.rgb;

    // Lids: shadow of the upper one, contact of both, dim corners.
    let upper = in.lids.z - in.lids.y;
    let lower = in.lids.y - in.lids.w;
    let shade = mix(0.22, 1.0, smoothstep(-0.04, 0.30, upper));
    let contact = mix(0.35, 1.0, smoothstep(-0.03, 0.14, min(upper, lower)));
    let corner = 1.0 - 0.6 * smoothstep(0.35, 0.85, abs(in.lids.x));
    let sky = shade * contact * corner;
    // The iris is a dish lit from across: it brightens away from the lamp.
    let l = frame.key_dir.xyz;
    let caustic = 1.0 - texel.a * 0.5 * dot(vec2(dot(l, axis_x), dot(l, axis_y)), in.uv);
    var light = albedo * (in.key * (shade * corner * caustic) + in.soft * (sky * contact));

    // What the wet surface mirrors: lamps, and the room at its edge.
    let mirrored = reflect(-v, n);
    let seen = smoothstep(-0.02, 0.04, upper) * smoothstep(0.0, 0.05, lower);
    // The catch-light: the key lamp as portrait photographers place a second one, nearer the camera, so
    // that the lid does not hide it.
    let catch_dir = normalize(l * 0.62 + v);
    let lamps = lamp_mirrored(mirrored, vec4(catch_dir, 0.18)) * 0.8 * frame.key_colour.rgb
        + lamp_mirrored(mirrored, frame.fill_dir) * 0.08 * frame.fill_colour.rgb;
    let film = 0.025 + 0.55 * grazing(max(dot(n, v), 0.0));
    light += lamps * (seen * mix(0.15, 1.0, bulge));
    light += ambient_from(mirrored) * (film * sky);
    // A tear line along the lower lid.
    let tear = smoothstep(0.09, 0.05, lower) * smoothstep(0.0, 0.03, lower) * seen;
    light += frame.key_colour.rgb * (tear * 0.10 * corner);
    return developed(light);
}
