// Lashes: dark blades, lit from both sides, with a fibre's highlight. Lit at their vertices. They turn with their
// lid: uv.x is where the root lies over the eyeball, in its radii from its centre; uv.y runs from root (0) to tip (1), plus
// 2 on the lower lid. A blade is never drawn narrower than a pixel: what it would lack in width it lacks in cover, so
// that thin tips fade instead of breaking into dots. Where a pixel has one sample, cover is blended.

#include "part"
#include "light"

override SAMPLES: u32 = 4u;
// What a whole share of half a width means, mm. Keep in step with geometry.rs.
const HALF_MM: f32 = 0.5;
// An upper lash is finer than its blade at the root, a lower one about as wide.
const FINE_UPPER: f32 = 0.62;
const FINE_LOWER: f32 = 1.0;

// How far a tip curls up, and down on the lower lid, beyond its blade.
const CURL_UP_MM: f32 = 1.1;
const CURL_DOWN_MM: f32 = 0.5;
// How far it strays to the side, at one radius of the eyeball from its middle.
const FAN_MM: f32 = 1.5;

struct LashFragment {
    @builtin(position) clip: vec4<f32>,
    // Light; w: cover, and what it is rounded with: one lash up, another down, so that many do not make one veil.
    @location(0) light: vec4<f32>,
}

// How high over the ball's equator a lid's margin lies at a place across it, radians.
fn margin(lid: vec4<f32>, x: f32) -> f32 {
    let height = dot(lid.xyz, vec3(1.0, x, x * x));
    return asin(clamp(height * inverseSqrt(max(1.0 - x * x, 0.1)), -1.0, 1.0));
}

@vertex
fn lash_vertex(in: PartVertex) -> LashFragment {
    let side = select(1u, 0u, in.rest.x > 0.0);
    let lid = side * 2u + select(0u, 1u, in.uv.y > 1.5);
    let turn = margin(frame.lids[lid], in.uv.x) - margin(frame.lids_at_rest[lid], in.uv.x);
    let c = cos(turn);
    let s = sin(turn);
    let centre = frame.eyeballs[side].xyz;
    // The blade's middle, then out again as far as a pixel asks.
    let across = strand_direction(in.shares.zw);
    let half = in.shares.x * HALF_MM;
    // Seen from before, lashes point at the eye that sees them: their curl shows their length.
    let lower = in.uv.y > 1.5;
    let tip = in.uv.y - select(0.0, 2.0, lower);
    // No two alike, and away from each other towards the corners.
    let chance = fract(sin(in.uv.x * 917.0) * 437.58);
    let curl = (0.55 + 0.9 * chance) * select(tip * tip * CURL_UP_MM, -tip * (2.0 - tip) * CURL_DOWN_MM, lower);
    // Lower ones hang before they sweep aside.
    let fan = select(tip, tip * tip, lower) * (FAN_MM * in.uv.x + 0.5 * (chance - 0.5));
    let off = in.rest + vec3(fan, curl, 0.0) - across * half - centre;
    var turned = in;
    turned.rest = centre + vec3(off.x, off.y * c + off.z * s, off.z * c - off.y * s);
    let at = placed(turned, 0.0);
    let n = normalize(at.normal);
    let outward = (frame.bodies[in.bodies.x] * vec4(across, 0.0)).xyz;
    let distance = (frame.clip_from_world * vec4(at.world, 1.0)).w;
    let up = vec3(frame.clip_from_world[0].y, frame.clip_from_world[1].y, frame.clip_from_world[2].y);
    let pixel = 2.0 * distance / (length(up) * frame.picture.y);
    let fine = half * select(FINE_UPPER, FINE_LOWER, lower);
    // Coarse pixels show no blades but a band along the margin, the smoother the wider they are drawn.
    let coarse = clamp(3.4 * pixel - 1.35, 0.0, 1.0);
    let drawn = max(fine, pixel * select(0.5 + 0.3 * coarse, 0.7, SAMPLES == 1u));

    // Brown where light gets through the thin tips, and all along below, where they are finer and catch the light.
    let upper_albedo = mix(vec3(0.010, 0.007, 0.006), vec3(0.040, 0.026, 0.019), tip);
    let lower_albedo = mix(vec3(0.050, 0.032, 0.023), vec3(0.130, 0.084, 0.060), tip);
    let albedo = select(upper_albedo, lower_albedo, lower);
    let v = normalize(frame.eye.xyz - at.world);
    let h = normalize(frame.key_dir.xyz + v);
    // Along the lash, the other way on its other side; so is what lies across it as it is seen.
    let tangent = cross(outward, n);
    let along = dot(tangent, h);
    let aside = cross(tangent, v);
    let seen = aside * inverseSqrt(max(dot(aside, aside), 1e-6));
    let shine = 0.016 * exp2(-along * along * 20.0) * dot(frame.key_colour.rgb, vec3(0.3333));
    var out: LashFragment;
    out.clip = frame.clip_from_world * vec4(at.world + seen * drawn, 1.0);
    let unlike = 0.9 - 0.6 * coarse;
    let rounded = select((0.5 + unlike * (chance - 0.5)) / f32(SAMPLES), 0.0, SAMPLES == 1u);
    out.light = vec4(albedo * (ambient_from(n) + 0.5 * frame.key_colour.rgb * abs(dot(n, frame.key_dir.xyz))) + shine,
        fine / drawn + rounded);
    return out;
}

@fragment
fn lash(in: LashFragment) -> @location(0) vec4<f32> {
    if SAMPLES == 1u {
        let cover = min(in.light.w, 1.0);
        // A target that encodes sRGB blends light, not what is shown: what is nearly black must cover more to darken as much.
        let of_light = 1.0 - pow(1.0 - cover, 2.2);
        return vec4(developed(in.light.rgb).rgb, select(cover, of_light, DECODE_SRGB));
    }
    let samples = f32(SAMPLES);
    let covered = min(floor(in.light.w * samples), samples);
    if covered < 0.5 {
        discard;
    }
    return vec4(developed(in.light.rgb).rgb, covered / samples);
}
