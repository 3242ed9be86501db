// Short hair: layers over the cap, each showing only the strands that reach so high; along the strand
// the highlight of Kajiya and Kay, shifted twice (Marschner's two lobes, in little). Lit at the
// vertices; the map gives each strand its own share of that.
// The map is laid flat round the crown; strands run away from it. R tone, G height, B shift.

#include "part"
#include "light"

@group(2) @binding(0) var map_sampler: sampler;
@group(2) @binding(1) var hair_map: texture_2d<f32>;
@group(2) @binding(2) var unused_map: texture_2d<f32>;

override HAIR_LAYERS: f32 = 4.0;
override SAMPLES: u32 = 4u;
// Lowest and highest layer over the cap, mm.
const ROOT: f32 = -1.5;
const TIP: f32 = 3.0;
// Where the strands part from. Keep in step with maps/hair.rs.
const CROWN: vec3<f32> = vec3(0.0, 145.0, -35.0);

struct HairFragment {
    @builtin(position) clip: vec4<f32>,
    // Place in the map; height of the layer among the layers, distance from the hairline.
    @location(0) places: vec4<f32>,
    // Light that the strands' colour multiplies, and light they mirror.
    @location(1) light: vec4<f32>,
}

fn strand_lobe(t: vec3<f32>, h: vec3<f32>, sharp: f32) -> f32 {
    let along = dot(t, h);
    return pow(max(1.0 - along * along, 0.0), sharp);
}

@vertex
fn hair_vertex(in: PartVertex, @builtin(instance_index) layer: u32) -> HairFragment {
    let height = f32(layer) / max(HAIR_LAYERS - 1.0, 1.0);
    // At its edge the hair lies flat on the skin, and the lowest layer stays near it for a while.
    let edge = in.shares.z;
    let at = placed(in, mix(ROOT, TIP, height) * edge - 3.6 * edge * (1.0 - edge) * (1.0 - height));
    let n = normalize(at.normal);
    let v = normalize(frame.eye.xyz - at.world);
    // Strands lie along the surface, away from the crown, and stand off it a little.
    let away = (vec4(in_head(at.world) - CROWN, 0.0) * frame.head_from_world).xyz;
    let flat_t = normalize(away - n * dot(away, n) + vec3(0.0, -1e-3, 0.0));
    let t = normalize(flat_t + n * 0.15);
    let l = frame.key_dir.xyz;
    let h = normalize(l + v);
    let facing = clamp(dot(n, l) * 0.7 + 0.3, 0.0, 1.0);
    let along = dot(t, l);
    let depth = mix(0.5, 1.0, height) * mix(in.shares.x, 1.0, 0.25);
    let place = shadow_place(at.world, n);
    let key = frame.key_colour.rgb * shadow_read(place.xy, place.z);
    let rim_h = normalize(frame.rim_dir.xyz + v);
    let rim = frame.rim_colour.rgb * (max(dot(n, frame.rim_dir.xyz) + 0.2, 0.0) * depth);

    var out: HairFragment;
    out.clip = frame.clip_from_world * vec4(at.world, 1.0);
    out.places = vec4(in.uv, height, edge);
    let body = (key * facing * (sqrt(max(1.0 - along * along, 0.0)) + 1.4 * strand_lobe(normalize(t - n * 0.25), h, 14.0))
        + frame.fill_colour.rgb * max(dot(n, frame.fill_dir.xyz) * 0.5 + 0.5, 0.0)
        + ambient_from(n)) * depth + rim * 0.6;
    let shine = key * (0.085 * strand_lobe(t, h, 40.0) * facing * depth) + rim * (0.05 * strand_lobe(t, rim_h, 24.0));
    out.light = vec4(body, dot(shine, vec3(0.3333)));
    return out;
}

@fragment
fn hair(in: HairFragment) -> @location(0) vec4<f32> {
    let map = textureSample(hair_map, map_sampler, in.places.xy);
    let edge = in.places.w;
    // Thins out towards the hairline and towards the tips.
    let reach = map.g - 0.55 * clamp(1.0 - 2.0 * edge, 0.0, 1.0);
    var cover = select(1.0, (reach - in.places.z * 0.92 + 0.08) * 5.0, in.places.z > 0.0);
    cover = min(cover, (map.g + edge * 7.0 - 0.60) * 3.3);
    // Without samples to cover, a strand is there or not.
    if cover < select(0.02, 0.5, SAMPLES == 1u) {
        discard;
    }
    let base = vec3(0.060, 0.036, 0.023) * (0.25 + 1.5 * map.r * map.r);
    let light = base * in.light.rgb + vec3(in.light.w * map.r * (0.5 + map.b));
    return vec4(developed(light).rgb, cover);
}
