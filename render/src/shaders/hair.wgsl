// Short hair: cards of painted strands over a dark cap. The highlights are those of a fibre (Marschner et al. 2003,
// on the tangent as Kajiya and Kay have it): light mirrored by the scales, tilted towards the root and white;
// light that went in, was mirrored at the back and came out tilted towards the tip, wider and of the hair's colour;
// and light from behind that shines through. What changes slowly is worked out at the vertices; where along the strand a
// highlight lies is at the pixel, so that every strand has its own.
// The map: R tone, G light between strands, B shift, A cover. On the cap v is -1 and less towards its edge.

#include "part"
#include "light"

@group(2) @binding(0) var map_sampler: sampler;
@group(2) @binding(1) var hair_map: texture_2d<f32>;
@group(2) @binding(2) var unused_map: texture_2d<f32>;

override SAMPLES: u32 = 4u;
// Colour of the strands, linear, from dark to light ones.
const DARK: vec3<f32> = vec3(0.014, 0.0082, 0.0052);
const PALE: vec3<f32> = vec3(0.165, 0.098, 0.057);
// What is left of white light that crossed a strand.
const THROUGH: vec3<f32> = vec3(0.46, 0.27, 0.15);
// Colour of what the strands' surface mirrors: white on a single hair; between many it has met others.
const SHINE: vec3<f32> = vec3(1.0, 0.86, 0.72);

// Tilt of the scales as the tangent's shift, and how much it differs from strand to strand.
const TILT: f32 = 0.10;
const JITTER: f32 = 0.34;
// How narrow the mirrored lobe is, and the coloured one: see fibre_lobe.
const SHARP: f32 = 16.5;
const BROAD: f32 = 2.6;

// Half the width of a single hair at its root, mm: of two that lie together.
const SINGLE_MM: f32 = 0.075;

struct HairFragment {
    @builtin(position) clip: vec4<f32>,
    // Place in the map; cosines of the half-way direction to tangent and normal.
    @location(0) places: vec4<f32>,
    // Light that the strands' colour multiplies; key light that highlights may have.
    @location(1) light: vec4<f32>,
    // Light from behind through the strands; cover of a single hair, 2 on cards, whose map has theirs.
    @location(2) behind: vec2<f32>,
}

// A broad highlight over the sine of the angle to a strand, zero at one.
fn round_lobe(sine: f32) -> f32 {
    let s = max(1.0 - sine * sine, 0.0);
    return s * s * s;
}

// Nearly a bell curve, without a power: software rendering feels it.
fn fibre_lobe(sine: f32, narrow: f32) -> f32 {
    let s = max(1.0 - narrow * sine * sine, 0.0);
    let s2 = s * s;
    return s2 * s2;
}

@vertex
fn hair_vertex(in: PartVertex) -> HairFragment {
    // Hair hangs on one body, and what is turned keeps its length.
    let body = frame.bodies[in.bodies.x];
    let world = (body * vec4(in.rest, 1.0)).xyz;
    let n = (body * vec4(in.normal, 0.0)).xyz;
    let t = (body * vec4(strand_direction(in.shares.zw), 0.0)).xyz;
    let v = normalize(frame.eye.xyz - world);
    let l = frame.key_dir.xyz;
    let r = frame.rim_dir.xyz;
    let h = normalize(l + v);
    let deep = in.shares.x;
    let facing = clamp(dot(n, l) * 0.65 + 0.35, 0.0, 1.0);
    let along = dot(t, l);
    // Hair lies outside all that could shade it: no look at the shadow map.
    let key = frame.key_colour.rgb;
    let rim = frame.rim_colour.rgb * (max(dot(n, r) + 0.25, 0.0) * deep);
    // Through: most where the lamp is behind and the outline thin.
    let thin = 1.0 - clamp(dot(n, v), 0.0, 1.0);
    let cone = dot(t, r) + dot(t, v);
    let ahead = max(-dot(r, v) * 0.6 + 0.4, 0.0);
    let behind = dot(frame.rim_colour.rgb, vec3(0.3333)) * (round_lobe(cone) * ahead * thin * thin * deep * deep);

    var out: HairFragment;
    out.clip = frame.clip_from_world * vec4(world, 1.0);
    var uv = in.uv;
    var cover = 2.0;
    if uv.x > 1.5 {
        // A single hair: never drawn narrower than a pixel; what it would lack in width it lacks in cover.
        let right = uv.x > 5.5;
        let up = vec3(frame.clip_from_world[0].y, frame.clip_from_world[1].y, frame.clip_from_world[2].y);
        let pixel = 2.0 * out.clip.w / (length(up) * frame.picture.y);
        let half = SINGLE_MM * (1.0 - 0.8 * uv.y * uv.y);
        let drawn = max(half, 0.5 * pixel);
        let across = normalize(cross(v, t)) * select(-drawn, drawn, right);
        out.clip = frame.clip_from_world * vec4(world + across, 1.0);
        cover = half / drawn;
        uv = vec2(uv.x - select(2.0, 6.0, right), 0.35 + 0.2 * uv.y);
    }
    out.light = vec4(key * (facing * sqrt(max(1.0 - along * along, 0.0)) * deep)
        + (frame.fill_colour.rgb * max(dot(n, frame.fill_dir.xyz) * 0.5 + 0.5, 0.0) + ambient_from(n)) * (deep * deep)
        + rim * 0.7, dot(key, vec3(0.3333)) * facing * deep);
    let rim_along = dot(t, normalize(r + v));
    out.behind = vec2(0.35 * behind + 0.055 * dot(rim, vec3(0.3333)) * round_lobe(2.0 * rim_along), cover);
    out.places = vec4(uv, dot(t, h), dot(n, h));
    return out;
}

@fragment
fn hair(in: HairFragment) -> @location(0) vec4<f32> {
    let cap = in.places.y < -0.5;
    // Towards its edge the cap shows the strands' ragged roots, then nothing. Keep in step with hairs/mod.rs.
    let gone = -1.0 - in.places.y;
    let along = select(in.places.y, 0.6 * (1.0 - gone), cap);
    let map = textureSample(hair_map, map_sampler, vec2(in.places.x, along));
    let card = select(map.a, max(map.a, 1.0 - 2.5 * (gone - 0.42)), cap);
    let cover = select(card, in.behind.y, in.behind.y < 1.5);
    // Whole samples: every card rounds alike. Keep in step with maps/hair.rs.
    let samples = f32(SAMPLES);
    let covered = floor(cover * samples + 0.5);
    if covered < 0.5 {
        discard;
    }
    let shift = (map.b - 0.5) * JITTER;
    let mirrored = in.places.z + (shift - TILT) * in.places.w;
    let coloured = in.places.z + (shift + 1.5 * TILT) * in.places.w;
    // The cap lies deep and shows its strands faintly.
    let tone = select(map.r, 0.8 * map.r + 0.09, cap);
    let reached = select(map.g, 0.7 * map.g + 0.24, cap);
    let base = mix(DARK, PALE, tone * tone);
    let near = reached * reached;
    let light = base * (in.light.rgb * reached)
        + (SHINE * (0.055 * fibre_lobe(mirrored, SHARP))
            + base * (1.35 * fibre_lobe(coloured, BROAD))) * (in.light.w * near * (0.4 + map.b))
        + THROUGH * (in.behind.x * reached);
    return vec4(developed(light).rgb, covered / samples);
}
