// The eyeball: a painted iris behind a bulging, wet cornea that bends the ray to it; a pupil that widens and
// narrows; white that is not white; the shadow of lids and lashes on it, which follows their opening
// (HABER 4.1: the aperture controls the brightness); a line of tears; a catch-light that never goes out.

#include "part"
#include "light"

@group(2) @binding(0) var map_sampler: sampler;
@group(2) @binding(1) var eye_map: texture_2d<f32>;
@group(2) @binding(2) var unused_map: texture_2d<f32>;

// The eye map covers this many iris radii from its middle, and its pupil is that wide. Keep in step with maps/eye.rs.
const MAP_REACH: f32 = 3.0;
const MAP_PUPIL: f32 = 0.36;
// Iris radius over the cornea's radius of curvature: 5.8 and 7.8 mm. What a unit of uv tilts the cornea's normal.
const DOME: f32 = 0.74;
// The iris lies that far behind the cornea's apex, in iris radii: 3 mm.
const CHAMBER: f32 = 0.52;
// Air to the fluid behind the cornea.
const ETA: f32 = 0.748;
// How far from the pupil's middle the catch-light may slide, in iris radii.
const CATCH_REACH: f32 = 0.72;

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
    // Above 0 in the subject's left eye; the catch-light's place in uv and how much of it the lids leave: alike all over an eye.
    @location(6) whole: vec4<f32>,
}

// Where the cornea mirrors the key lamp, in iris radii from the pupil. The lamp is taken nearer the camera, as portrait
// photographers place a second one, and slides with lids and gaze so that it always shows in an open eye.
fn catch_light(side: u32, turn: mat4x4<f32>) -> vec3<f32> {
    let ball = frame.eyeballs[side];
    let centre = (frame.bodies[1] * vec4(ball.xyz, 1.0)).xyz;
    let v = normalize(frame.eye.xyz - centre);
    let l = frame.key_dir.xyz;
    let h = normalize(normalize(l * 0.62 + v) + v);
    let along = max(dot(h, turn[2].xyz), 0.25);
    var at = vec2(dot(h, turn[0].xyz), dot(h, turn[1].xyz)) / (along * DOME);
    at *= min(1.0, CATCH_REACH * inverseSqrt(max(dot(at, at), 1e-6)));
    // A unit of uv in radii of the ball, and where that is in the head.
    let unit = 5.8 / ball.w;
    let over = head_direction(turn[2].xyz + (turn[0].xyz * at.x + turn[1].xyz * at.y) * unit);
    let poly = vec3(1.0, over.x, over.x * over.x);
    let upper = dot(frame.lids[side * 2u].xyz, poly);
    let lower = dot(frame.lids[side * 2u + 1u].xyz, poly);
    let gap = upper - lower;
    let room = min(0.5 * gap, 0.12);
    let y = clamp(over.y, lower + room, upper - room);
    at.y += (y - over.y) / unit;
    return vec3(at, smoothstep(0.03, 0.14, gap));
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
    out.whole = vec4(head.x, catch_light(side, frame.bodies[3u + side]));
    out.lids = vec4(over, dot(frame.lids[side * 2u].xyz, poly), dot(frame.lids[side * 2u + 1u].xyz, poly));
    let visible = mix(key_visible(shadow_place(at.world, n)), 1.0, 0.25);
    let wrap = vec3(0.35, 0.25, 0.22);
    let dim = mix(0.6, 1.0, open);
    out.key = frame.key_colour.rgb * max((vec3(dot(n, frame.key_dir.xyz)) + wrap) / (1.0 + wrap), vec3(0.0)) * (visible * dim);
    out.soft = (frame.fill_colour.rgb * max(dot(n, frame.fill_dir.xyz) * 0.7 + 0.3, 0.0) + ambient_from(n)) * dim;
    return out;
}

// A soft box as the cornea shows it: a square with round corners, a little brighter above.
fn soft_box(p: vec2<f32>, half: vec2<f32>, blur: f32) -> f32 {
    let round = 0.75 * half.x;
    let q = abs(p) - half + round;
    let d = length(max(q, vec2(0.0))) + min(max(q.x, q.y), 0.0) - round;
    return smoothstep(blur, -blur, d) * (0.82 + 0.18 * clamp(p.y / half.y, -1.0, 1.0));
}

@fragment
fn eye(in: EyeFragment) -> @location(0) vec4<f32> {
    let v = normalize(frame.eye.xyz - in.world);
    let r2 = dot(in.uv, in.uv);
    let bulge = 1.0 - smoothstep(0.72, 1.44, r2);
    // The eye's own axes: across, up and along its gaze.
    let left = in.whole.x > 0.0;
    let turn = frame.bodies[select(4u, 3u, left)];
    // The cornea as a sphere of 7.8 mm under an iris of 5.8 mm: smoother than the mesh could be.
    let dome = normalize(turn[2].xyz + (turn[0].xyz * in.uv.x + turn[1].xyz * in.uv.y) * DOME);
    let n = normalize(mix(in.normal, dome, bulge));

    // The ray bends at the cornea and goes on to the plane of the iris: seen from aside the iris moves behind its
    // window, seen from the front it looks an eighth wider.
    let bent = refract(-v, n, ETA);
    let ray = vec3(dot(bent, turn[0].xyz), dot(bent, turn[1].xyz), dot(bent, turn[2].xyz));
    let depth = CHAMBER * max(1.0 - r2, 0.0);
    let iris = in.uv + ray.xy * (depth / max(-ray.z, 0.3));
    // The pupil: the iris is stretched between its rim and the painted pupil.
    let r = max(length(iris), 1e-4);
    let p = frame.pupil.x;
    let stretched = select(MAP_PUPIL + (r - p) * (1.0 - MAP_PUPIL) / (1.0 - p), r * MAP_PUPIL / p, r < p);
    let map_uv = iris * (select(stretched / r, 1.0, r > 1.0));
    let texel = textureSample(eye_map, map_sampler, map_uv * (0.5 / MAP_REACH) + 0.5);
    var albedo = texel.rgb * texel.rgb;

    // The corner by the nose: the fold of the conjunctiva and the caruncle are flesh.
    let nasal = select(in.lids.x, -in.lids.x, left);
    albedo = mix(albedo, vec3(0.50, 0.20, 0.165), 0.75 * smoothstep(0.42, 0.86, nasal) * (1.0 - texel.a));

    // Lids: the upper one's shadow, the lashes' beyond it in streaks that slant from the lamp, both lids' touch, dim corners.
    let l = frame.key_dir.xyz;
    let key = vec3(dot(l, turn[0].xyz), dot(l, turn[1].xyz), dot(l, turn[2].xyz));
    let upper = in.lids.z - in.lids.y;
    let lower = in.lids.y - in.lids.w;
    let slant = in.lids.x + upper * key.x / max(key.z, 0.3);
    let streaks = 0.5 + 0.5 * sin(slant * 47.0 + 1.7 * sin(slant * 13.0));
    // As the lids come down so do the lashes: what they shade narrows with the gap.
    let gap = clamp((in.lids.z - in.lids.w) * 1.6, 0.3, 1.0);
    let lash = (1.0 - smoothstep(0.08, 0.46, upper / gap)) * (0.26 + 0.20 * streaks) * gap;
    let shade = mix(0.14, 1.0, smoothstep(-0.02, 0.20, upper / gap)) * (1.0 - lash);
    let contact = mix(0.30, 1.0, smoothstep(-0.03, 0.17, upper)) * mix(0.60, 1.0, smoothstep(-0.05, 0.10, lower));
    let corner = 1.0 - 0.6 * smoothstep(0.30, 0.90, abs(in.lids.x));
    let sky = mix(shade, 1.0, 0.25) * contact * corner;
    // The iris is a dish behind a lens: it brightens across from the lamp, and its rim shades it towards the lamp.
    let across = dot(key.xy, iris);
    let dish = 1.0 - texel.a * clamp(0.85 * across, -0.75, 0.75);
    let lens = mix(1.0, 0.92 + 0.22 * dish, texel.a);
    var light = albedo * (in.key * (shade * corner * dish) + in.soft * (sky * contact * lens));

    // What the wet surface mirrors: the room at its edge, the lamps.
    let mirrored = reflect(-v, n);
    let below = smoothstep(-0.02, 0.05, upper);
    let seen = below * smoothstep(0.0, 0.05, lower);
    let film = 0.025 + 0.50 * grazing(max(dot(n, v), 0.0));
    light += ambient_from(mirrored) * (film * sky);
    let glint = in.uv - in.whole.yz;
    let box = soft_box(glint, vec2(0.120, 0.140), 0.045) * 0.85;
    // Round the box a faint glow of what it lights: the edge is not cut with scissors.
    let glow = 0.018 * exp(-12.0 * dot(glint, glint));
    // The fill is a broad dim panel on the other side, below.
    let other = in.uv - vec2(-in.whole.y * 1.25, in.whole.z - 0.75);
    let panel = soft_box(other, vec2(0.22, 0.16), 0.12) * 0.022;
    light += frame.key_colour.rgb * ((box + glow * bulge) * in.whole.w * mix(seen, 1.0, 0.3));
    light += frame.fill_colour.rgb * (panel * seen * bulge);
    // Tears stand along the lower lid: a line that mirrors the lamp brightest below the catch-light.
    let tear = smoothstep(0.065, 0.025, lower) * below;
    let under = in.uv.x - in.whole.y;
    light += frame.key_colour.rgb * (tear * corner * (0.07 + 0.34 * exp(-2.2 * under * under)));
    return developed(light);
}
