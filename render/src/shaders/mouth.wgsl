// How much light the opening between the lips lets in. HABER 4.1 scales the brightness of teeth and
// tongue by the mouth's opening; here that is the share of a point's sky which the opening fills, so
// that a front tooth stays bright where the throat is dark.

#include "part"
#include "light"

struct MouthFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // Position in the head's frame.
    @location(2) head: vec3<f32>,
    // Shares of ambient, key and fill light that reach the place; occlusion at rest.
    @location(3) inside: vec4<f32>,
}

@vertex
fn mouth_vertex(in: PartVertex) -> MouthFragment {
    let at = placed(in, 0.0);
    var out: MouthFragment;
    out.world = at.world;
    out.normal = at.normal;
    out.clip = frame.clip_from_world * vec4(at.world, 1.0);
    out.head = in_head(at.world);
    let light = mouth_light(out.head, head_direction(normalize(at.normal)));
    out.inside = vec4(light.sky, light.key, light.fill, in.shares.x);
    return out;
}

struct MouthLight {
    // Share of ambient light.
    sky: f32,
    // Share of the key light and of the fill light.
    key: f32,
    fill: f32,
}

// Share of light from direction l (head's frame) that passes the opening, an ellipse with a soft edge.
fn through_lips(p: vec3<f32>, l: vec3<f32>) -> f32 {
    let half = vec2(frame.mouth.w, frame.mouth_height.x);
    let ahead = frame.mouth.z - p.z;
    let t = max(ahead, 0.0) / max(l.z, 0.15);
    let q = (p + l * t - frame.mouth.xyz).xy;
    // A lamp of some width: the further behind the lips, the softer their edge.
    let blur = 0.6 + t * 0.22;
    let outside = max(abs(q) - half, vec2(0.0)) - min(half - abs(q), vec2(blur));
    let inside = clamp(0.5 - outside / (2.0 * blur), vec2(0.0), vec2(1.0));
    let window = inside.x * inside.y * clamp(half.y / blur, 0.0, 1.0);
    return select(window, 1.0, ahead < -1.0);
}

fn mouth_light(p: vec3<f32>, n: vec3<f32>) -> MouthLight {
    let half = vec2(frame.mouth.w, frame.mouth_height.x);
    // The part of the opening that is nearest.
    var to = frame.mouth.xyz - p;
    to.x -= clamp(to.x, -0.7 * half.x, 0.7 * half.x);
    to.y -= clamp(to.y, -0.5 * half.y, 0.5 * half.y);
    let d2 = dot(to, to) + 1.0;
    let inverse = inverseSqrt(d2);
    let area = PI * half.x * half.y;
    // Wet walls pass light on, so that what faces away or stands aside is dim, not black.
    let facing = clamp(dot(n, to) * inverse * 0.4 + 0.6, 0.0, 1.0);
    let leaving = clamp(to.z * inverse * 0.8 + 0.2, 0.0, 1.0);
    var out: MouthLight;
    out.sky = max(area * leaving * facing / (1.3 * d2 + area), smoothstep(0.5, 3.0, -to.z) * 0.8);
    out.key = through_lips(p, head_direction(frame.key_dir.xyz));
    out.fill = through_lips(p, head_direction(frame.fill_dir.xyz));
    return out;
}

// A wet surface inside the mouth. `soft` lets light creep round the edge, as enamel and flesh do.
fn wet_surface(in: MouthFragment, n: vec3<f32>, albedo: vec3<f32>, roughness: f32, f0: f32, soft: f32) -> vec3<f32> {
    let v = normalize(frame.eye.xyz - in.world);
    let inside = MouthLight(in.inside.x, in.inside.y, in.inside.z);
    let occlusion = in.inside.w;
    let wrap = 1.0 / (1.0 + soft);
    let key = frame.key_colour.rgb * inside.key;
    let fill = frame.fill_colour.rgb * inside.fill;
    var light = albedo * key * max((dot(n, frame.key_dir.xyz) + soft) * wrap, 0.0) * mix(occlusion, 1.0, 0.4);
    light += albedo * fill * max((dot(n, frame.fill_dir.xyz) + soft) * wrap, 0.0) * mix(occlusion, 1.0, 0.4);
    // Through the opening come the room's light and what the lamps throw about.
    let room = ambient_from(n) + 0.40 * frame.key_colour.rgb + 0.25 * frame.fill_colour.rgb;
    light += albedo * room * (inside.sky * mix(occlusion, 1.0, 0.5));
    light += f0 * key * gloss(n, v, frame.key_dir.xyz, roughness);
    light += f0 * fill * gloss(n, v, frame.fill_dir.xyz, roughness);
    // The bright room mirrored in the wet film, stronger where the eye grazes it.
    let film = f0 + (0.5 - f0) * grazing(dot(n, v));
    light += (ambient_from(reflect(-v, n)) + 0.2 * frame.key_colour.rgb) * (film * inside.sky);
    return light;
}
