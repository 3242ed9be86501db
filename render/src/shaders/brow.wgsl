// Brows: single hairs over the skin, lit at their vertices, with a fibre's highlights (see hair.wgsl, after Marschner
// et al. 2003). A hair is never drawn narrower than a pixel: what it would lack in width it lacks in cover, and each
// rounds that to whole samples in its own way, so that it neither breaks into dots nor flickers when it moves.

#include "light"
#include "part"

override SAMPLES: u32 = 4u;

// Half the width of a hair at its root, mm: of some that lie together, so that few of them make a brow.
const HALF_MM: f32 = 0.055;
// What a whole byte of colour and of thickness means. Keep in step with brows/mod.rs.
const COLOUR_SCALE: f32 = 4.0;
const THICK_MOST: f32 = 2.0;
// Tilt of the scales as the tangent's shift; how narrow the mirrored lobe is, and the coloured one.
const TILT: f32 = 0.10;
const SHARP: f32 = 9.0;
const BROAD: f32 = 2.4;

struct BrowVertex {
    // In the head's frame, mm.
    @location(0) position: vec3<f32>,
    // Which way the hair runs, and the skin's normal: see strand_direction.
    @location(1) directions: vec4<f32>,
    // Side of the hair, from root to tip, tone, what cover is rounded with.
    @location(2) shares: vec4<f32>,
    // Colour and thickness.
    @location(3) colour: vec4<f32>,
}

struct BrowFragment {
    @builtin(position) clip: vec4<f32>,
    // Light; cover.
    @location(0) light: vec4<f32>,
}

// As in hair.wgsl: nearly a bell curve, without a power.
fn fibre_lobe(sine: f32, narrow: f32) -> f32 {
    let s = max(1.0 - narrow * sine * sine, 0.0);
    let s2 = s * s;
    return s2 * s2;
}

@vertex
fn brow_vertex(in: BrowVertex) -> BrowFragment {
    let body = frame.bodies[1];
    let world = (body * vec4(in.position, 1.0)).xyz;
    let t = (body * vec4(strand_direction(in.directions.xy), 0.0)).xyz;
    let n = (body * vec4(strand_direction(in.directions.zw), 0.0)).xyz;
    let v = normalize(frame.eye.xyz - world);
    let l = frame.key_dir.xyz;
    let h = normalize(l + v);
    let along = in.shares.y;

    let middle = frame.clip_from_world * vec4(world, 1.0);
    let up = vec3(frame.clip_from_world[0].y, frame.clip_from_world[1].y, frame.clip_from_world[2].y);
    let pixel = 2.0 * middle.w / (length(up) * frame.picture.y);
    let half = HALF_MM * THICK_MOST * in.colour.w * (1.0 - 0.8 * along * along);
    let drawn = max(half, 0.5 * pixel);
    let across = normalize(cross(v, t)) * select(-drawn, drawn, in.shares.x > 0.5);

    // Others stand over its root.
    let deep = 0.55 + 0.45 * along;
    let facing = clamp(dot(n, l) * 0.75 + 0.25, 0.0, 1.0);
    let place = shadow_place(world, n);
    let key = frame.key_colour.rgb * (facing * deep * shadow_read(place.xy, place.z));
    let lk = dot(t, l);
    let base = in.colour.rgb * ((0.25 + 0.75 * in.shares.z) / COLOUR_SCALE);
    let soft = key * sqrt(max(1.0 - lk * lk, 0.0))
        + (frame.fill_colour.rgb * max(dot(n, frame.fill_dir.xyz) * 0.5 + 0.5, 0.0) + ambient_from(n)) * (deep * deep)
        + frame.rim_colour.rgb * (0.5 * max(dot(n, frame.rim_dir.xyz), 0.0) * deep);
    // No two hairs are tilted alike.
    let th = dot(t, h) + 0.3 * (in.shares.w - 0.5);
    let nh = dot(n, h);
    let mirrored = 0.035 * fibre_lobe(th - TILT * nh, SHARP);
    let coloured = 1.0 * fibre_lobe(th + 1.5 * TILT * nh, BROAD);

    var out: BrowFragment;
    out.clip = frame.clip_from_world * vec4(world + across, 1.0);
    // Rounded down after that: so of many hairs as many show as their cover says.
    out.light = vec4(base * soft + (vec3(mirrored) + base * coloured) * key,
        half / drawn + (0.05 + 0.9 * in.shares.w) / f32(SAMPLES));
    return out;
}

@fragment
fn brow(in: BrowFragment) -> @location(0) vec4<f32> {
    let samples = f32(SAMPLES);
    let covered = min(floor(in.light.w * samples), samples);
    if covered < 0.5 {
        discard;
    }
    return vec4(developed(in.light.rgb).rgb, covered / samples);
}
