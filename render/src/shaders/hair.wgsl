// Short hair: layers over the cap, each showing only the strands that reach so high; along the strand
// the highlight of Kajiya and Kay, shifted twice (Marschner's two lobes, in little).
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

@vertex
fn hair_vertex(in: PartVertex, @builtin(instance_index) layer: u32) -> PartFragment {
    let height = f32(layer) / max(HAIR_LAYERS - 1.0, 1.0);
    // At its edge the hair lies flat on the skin.
    var out = part_vertex(in, mix(ROOT, TIP, height) * in.shares.z);
    out.layer.x = height;
    return out;
}

fn strand_lobe(t: vec3<f32>, h: vec3<f32>, sharp: f32) -> f32 {
    let along = dot(t, h);
    return pow(max(1.0 - along * along, 0.0), sharp);
}

@fragment
fn hair(in: PartFragment) -> @location(0) vec4<f32> {
    let map = textureSample(hair_map, map_sampler, in.uv);
    let edge = in.layer.y;
    // Thins out towards the hairline and towards the tips.
    let reach = map.g - 0.55 * (1.0 - smoothstep(0.0, 0.5, edge));
    var cover = select(1.0, smoothstep(-0.10, 0.10, reach - in.layer.x * 0.92 - 0.02), in.layer.x > 0.0);
    cover = min(cover, smoothstep(-0.12, 0.12, map.g + edge * 2.4 - 0.6));
    // Without samples to cover, a strand is there or not.
    if cover < select(0.02, 0.5, SAMPLES == 1u) {
        discard;
    }
    let n = normalize(in.normal);
    let v = normalize(frame.eye.xyz - in.world);
    // Away from the crown, in the surface; the map bends it.
    let away = in.head.xyz - CROWN;
    let flow = (vec4(away, 0.0) * frame.head_from_world).xyz;
    var t = normalize(flow - n * dot(flow, n));
    t = normalize(t + n * ((map.b - 0.5) * 0.5 + 0.1) + cross(n, t) * (map.r - 0.5) * 0.35);
    let l = frame.key_dir.xyz;
    let h = normalize(l + v);
    let facing = clamp(dot(n, l) * 0.7 + 0.3, 0.0, 1.0);
    let along = dot(t, l);
    let matte = sqrt(max(1.0 - along * along, 0.0)) * facing;
    let visible = key_visible(in.world, n);
    let base = vec3(0.043, 0.026, 0.017) * (0.45 + 1.1 * map.r);
    let depth = mix(0.45, 1.0, in.layer.x) * in.head.w;
    let key = frame.key_colour.rgb * visible;
    var light = base * key * matte * depth;
    light += key * (0.045 * strand_lobe(t, h, 60.0) * map.r + base * 1.4 * strand_lobe(normalize(t - n * 0.22), h, 16.0)) * (facing * depth);
    let rim = normalize(frame.rim_dir.xyz + v);
    light += frame.rim_colour.rgb * (0.05 * strand_lobe(t, rim, 24.0) + base * 0.5) * max(dot(n, frame.rim_dir.xyz) + 0.2, 0.0) * depth;
    light += base * (frame.fill_colour.rgb * max(dot(n, frame.fill_dir.xyz) * 0.5 + 0.5, 0.0) + ambient_from(n)) * depth;
    return vec4(developed(light).rgb, cover);
}
