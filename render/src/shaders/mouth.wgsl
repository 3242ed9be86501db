// How much light the opening between the lips lets in. HABER 4.1 scales the brightness of teeth and
// tongue by the mouth's opening; here that opening is seen from the place: the share of its sky is Lambert's formula
// for a polygon (Lambert, Photometria, 1760), and each lamp is seen through it or not. So a front tooth stays bright
// where the throat is dark, and all is dark behind a slit.

#include "part"
#include "light"

struct MouthFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // Position in the head's frame; occlusion at rest.
    @location(2) head: vec4<f32>,
    @location(3) uv: vec2<f32>,
}

@vertex
fn mouth_vertex(in: PartVertex) -> MouthFragment {
    let at = placed(in, 0.0);
    var out: MouthFragment;
    out.world = at.world;
    out.normal = at.normal;
    out.clip = frame.clip_from_world * vec4(at.world, 1.0);
    out.head = vec4(in_head(at.world), in.shares.x);
    out.uv = in.uv;
    return out;
}

struct MouthLight {
    // Share of ambient light that falls on a surface facing so.
    sky: f32,
    // Share of the place's whole surroundings that is outside.
    seen: f32,
    // Share of the key light and of the fill light.
    key: f32,
    fill: f32,
    // What the wet walls throw at one another, as a share of the light outside.
    thrown: f32,
}

// Lips are thick: nothing between them is nearer to the opening than that, mm.
const LIP_DEPTH: f32 = 2.0;

// Share of light from direction l (head's frame) that passes the opening, an ellipse with a soft edge.
fn through_lips(p: vec3<f32>, l: vec3<f32>) -> f32 {
    let half = vec2(frame.mouth.w, frame.mouth_height.x);
    let ahead = frame.mouth.z - p.z;
    let t = max(ahead, LIP_DEPTH) / max(l.z, 0.15);
    let q = (p + l * t - frame.mouth.xyz).xy;
    // A lamp of some width: the further behind the lips, the softer their edge.
    let blur = 0.6 + t * 0.22;
    let outside = max(abs(q) - half, vec2(0.0)) - min(half - abs(q), vec2(blur));
    let inside = clamp(0.5 - outside / (2.0 * blur), vec2(0.0), vec2(1.0));
    let window = inside.x * inside.y * clamp(half.y / blur, 0.0, 1.0);
    return select(window, 1.0, ahead < -1.0);
}

// One edge of the polygon between two directions: the angle it fills, along the normal of the plane through it and the
// place. Angle over sine is a fraction of polynomials, as Heitz and Hill fit it (Real-Time Area Lighting, 2016), which
// software rendering feels less than an arc.
fn edge_seen(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let x = dot(a, b);
    let y = abs(x);
    let v = (0.8543985 + (0.4965155 + 0.0145206 * y) * y) / (3.4175940 + (4.1616724 + y) * y);
    return cross(a, b) * select(0.5 * inverseSqrt(max(1.0 - x * x, 1e-7)) - v, v, x > 0.0);
}

// The opening as light falls from it on the place: over 2 pi it is the share of the sky, as a vector to be dotted with
// the normal. A rectangle as large as the ellipse, a little behind the lips' line where their inner edges are.
fn opening_seen(p: vec3<f32>) -> vec3<f32> {
    let half = vec2(frame.mouth.w * 0.84, frame.mouth_height.x * 0.93);
    let to = frame.mouth.xyz - p;
    let z = max(to.z, LIP_DEPTH);
    let a = normalize(vec3(to.x - half.x, to.y - half.y, z));
    let b = normalize(vec3(to.x + half.x, to.y - half.y, z));
    let c = normalize(vec3(to.x + half.x, to.y + half.y, z));
    let d = normalize(vec3(to.x - half.x, to.y + half.y, z));
    return edge_seen(a, b) + edge_seen(b, c) + edge_seen(c, d) + edge_seen(d, a);
}

fn mouth_light(p: vec3<f32>, n: vec3<f32>) -> MouthLight {
    let opening = opening_seen(p);
    let outside = smoothstep(0.5, 3.0, p.z - frame.mouth.z) * 0.8;
    var out: MouthLight;
    out.seen = max(length(opening), outside);
    // Flesh and enamel pass light on below their surface: what faces aside is dim, not black.
    out.sky = max(max(dot(n, opening), 0.0) * 1.05 + out.seen * 0.8, outside);
    // Between lips that are hardly parted their own shine is missing too: the paper's factor, as far as it goes beyond
    // what the opening hides.
    let parted = mix(0.5, 1.0, smoothstep(0.0, 6.5, frame.mouth_height.x));
    let through = mix(parted, 1.0, outside);
    out.sky *= through;
    out.key = through_lips(p, head_direction(frame.key_dir.xyz)) * through;
    out.fill = through_lips(p, head_direction(frame.fill_dir.xyz)) * through;
    // A mouth is a cave: what comes in at its opening is shared by all its walls, about 2500 mm2 of them.
    let area = PI * frame.mouth.w * frame.mouth_height.x;
    out.thrown = 0.9 * area / (area + 2500.0);
    return out;
}

fn lit_mouth(in: MouthFragment, n: vec3<f32>) -> MouthLight {
    return mouth_light(in.head.xyz, head_direction(n));
}

// A wet surface inside the mouth. `soft` lets light creep round the edge, as enamel and flesh do; `body` is the normal
// that light below the surface knows, `n` that of the film of spit on it.
fn wet_surface(in: MouthFragment, inside: MouthLight, body: vec3<f32>, n: vec3<f32>, albedo: vec3<f32>, roughness: f32, f0: f32, soft: f32) -> vec3<f32> {
    let v = normalize(frame.eye.xyz - in.world);
    let occlusion = in.head.w;
    let wrap = 1.0 / (1.0 + soft);
    let key = frame.key_colour.rgb * inside.key;
    let fill = frame.fill_colour.rgb * inside.fill;
    let open = mix(occlusion, 1.0, 0.45);
    var light = albedo * key * (max((dot(body, frame.key_dir.xyz) + soft) * wrap, 0.0) * open);
    light += albedo * fill * (max((dot(body, frame.fill_dir.xyz) + soft) * wrap, 0.0) * open);
    // Through the opening come the room's light and what the lamps throw about.
    let front = frame.bodies[1][2].xyz;
    let room = ambient_from(front) + 0.30 * frame.key_colour.rgb + 0.25 * frame.fill_colour.rgb;
    light += albedo * room * (inside.sky * open);
    // Thrown about among the walls it turns red.
    light += albedo * vec3(0.70, 0.36, 0.29) * (room + frame.key_colour.rgb) * (inside.thrown * open);
    light += f0 * key * gloss(n, v, frame.key_dir.xyz, roughness);
    light += f0 * fill * gloss(n, v, frame.fill_dir.xyz, roughness);
    // The opening itself, mirrored: the lit room as a broad lamp before the mouth, a little above the eye's line.
    let before = normalize(v + front + vec3(0.0, 0.35, 0.0));
    light += f0 * room * (inside.seen * gloss(n, v, before, roughness + 0.06));
    // And the wet film's rim where the eye grazes it.
    let film = f0 + (0.5 - f0) * grazing(dot(n, v));
    light += (ambient_from(reflect(-v, n)) + 0.2 * frame.key_colour.rgb) * (film * inside.sky);
    return light;
}
