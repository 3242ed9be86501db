// Short hair: cards of painted strands over a dark cap; along the strand the highlight of Kajiya and Kay, shifted
// twice (Marschner's two lobes, in little). Lit at the vertices; the map gives each strand its own share of that.
// The map: R tone, B shift, A cover. The cap has v below 0 and shows no strands.

#include "part"
#include "light"

@group(2) @binding(0) var map_sampler: sampler;
@group(2) @binding(1) var hair_map: texture_2d<f32>;
@group(2) @binding(2) var unused_map: texture_2d<f32>;

override SAMPLES: u32 = 4u;
// Colour of the strands, linear, from dark to light ones.
const DARK: vec3<f32> = vec3(0.016, 0.0095, 0.0062);
const PALE: vec3<f32> = vec3(0.150, 0.092, 0.056);

// Colour of what the strands' surface mirrors: white on a single hair; between many it has met others.
const SHINE: vec3<f32> = vec3(1.0, 0.80, 0.62);

struct HairFragment {
    @builtin(position) clip: vec4<f32>,
    // Place in the map; light that strands mirror: at their surface, and once through them.
    @location(0) places: vec4<f32>,
    // Light that the strands' colour multiplies.
    @location(1) light: vec3<f32>,
}

// Kajiya and Kay's highlight to the eighth power of the squared sine: sharper ones square it again.
fn strand_lobe(t: vec3<f32>, h: vec3<f32>) -> f32 {
    let along = dot(t, h);
    let s = max(1.0 - along * along, 0.0);
    let s2 = s * s;
    let s4 = s2 * s2;
    return s4 * s4;
}

@vertex
fn hair_vertex(in: PartVertex) -> HairFragment {
    let at = placed(in, 0.0);
    let n = normalize(at.normal);
    let v = normalize(frame.eye.xyz - at.world);
    let t = normalize((frame.bodies[in.bodies.x] * vec4(strand_direction(in.shares.zw), 0.0)).xyz);
    let l = frame.key_dir.xyz;
    let h = normalize(l + v);
    let deep = in.shares.x;
    let facing = clamp(dot(n, l) * 0.65 + 0.35, 0.0, 1.0);
    let along = dot(t, l);
    // Hair lies outside all that could shade it: no look at the shadow map.
    let key = frame.key_colour.rgb;
    let rim = frame.rim_colour.rgb * (max(dot(n, frame.rim_dir.xyz) + 0.25, 0.0) * deep);
    let rim_h = normalize(frame.rim_dir.xyz + v);
    // Scales tilt the mirror towards the root, light that went through comes out towards the tip.
    let tight = strand_lobe(normalize(t - n * 0.10), h);
    let tight4 = tight * tight * tight * tight;
    let lit = facing * deep;
    let mirrored = tight4 * tight4 * lit;
    let broad = strand_lobe(normalize(t + n * 0.16), h);
    let through = broad * broad * lit;

    var out: HairFragment;
    out.clip = frame.clip_from_world * vec4(at.world, 1.0);
    out.light = key * (facing * sqrt(max(1.0 - along * along, 0.0)) * deep)
        + (frame.fill_colour.rgb * max(dot(n, frame.fill_dir.xyz) * 0.5 + 0.5, 0.0) + ambient_from(n)) * (deep * deep)
        + rim * 0.7;
    let bright = dot(key, vec3(0.3333));
    let rim_bright = dot(rim, vec3(0.3333)) * strand_lobe(t, rim_h);
    out.places = vec4(in.uv, 0.075 * mirrored * bright + 0.022 * rim_bright * deep, 1.5 * through * bright);
    return out;
}

@fragment
fn hair(in: HairFragment) -> @location(0) vec4<f32> {
    let map = textureSample(hair_map, map_sampler, in.places.xy);
    let cap = in.places.y < 0.0;
    let cover = select(map.a, 1.0, cap);
    // Without samples to cover, a strand is there or not.
    if cover < select(0.08, 0.45, SAMPLES == 1u) {
        discard;
    }
    let tone = select(map.r, 0.46, cap);
    let base = mix(DARK, PALE, tone * tone);
    let light = base * (in.light + vec3(in.places.w * map.b)) + SHINE * (in.places.z * (0.25 + map.b) * tone);
    return vec4(developed(light).rgb, cover);
}
