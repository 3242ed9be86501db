// The skin's surface, whatever reflects off it: its vertices, its four maps (HEADSHOP 4.4: colour, bump of the fine
// structure, bump of expressive wrinkles, mask) and what they say of a pixel.
//
// Fill, rim and ambient light change slowly over a face: they are worked out at the vertices. The key
// light, which shows the skin's grain, and its shadow are worked out at the pixels.

#include "light"
#include "skin_maps"

// Whether the fine structure is drawn.
override GRAIN: bool = true;

// Part of the chart that the wrinkles cover: u from .x to .y, v from .z to .w. Keep in step with maps/mod.rs.
const WINDOW: vec4<f32> = vec4(0.29, 0.71, 0.06, 0.94);
// A byte that is flat, as it is read.
const FLAT: f32 = 128.0 / 255.0;
// Colour of skin on the whole, linear: for light that bounces in folds.
const SKIN: vec3<f32> = vec3(0.56, 0.32, 0.23);
// Share of light from straight ahead that skin mirrors.
const MIRROR: f32 = 0.028;

struct SkinVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Share of the skull, vermilion, wet, occlusion.
    @location(3) shares: vec4<f32>,
    // Place on the tile of the fine structure.
    @location(4) grain: vec2<f32>,
    // Shares of the zones of both layers of wrinkles.
    @location(5) raised: vec4<f32>,
    @location(6) drawn: vec4<f32>,
    // What its fold leaves of the light from around, 0.5 as at rest; how convex it is.
    @location(7) bend: vec4<f32>,
}

// Packed: the fewer slots, the cheaper a small triangle in software.
struct SkinFragment {
    @builtin(position) clip: vec4<f32>,
    // Normal; light that is only added: lamps but the key, and the room, mirrored.
    @location(0) normal: vec4<f32>,
    // Place in the colour map; place in the shadow map.
    @location(1) places: vec4<f32>,
    // Light but the key's that the skin's colour multiplies; depth in the shadow map.
    @location(2) soft: vec4<f32>,
    // Vermilion, wet, occlusion, how convex.
    @location(3) shares: vec4<f32>,
    // Place on the tile; how far the two layers of wrinkles are folded.
    @location(4) fine: vec4<f32>,
}

// How far light has crept round the terminator by the time it leaves the skin again: in part because the lamp is
// broad, in part, red most, because it has been under the skin (a broad lamp's angle and d'Eon's profile of skin over
// the radius of the surface, as one width). `convex` is one over that radius.
fn creep(convex: f32) -> vec3<f32> {
    return vec3(0.30, 0.24, 0.22) + vec3(0.30, 0.12, 0.08) * convex;
}

// Matte light whose terminator is that wide: straight where lit, a parabola across the terminator.
fn scattered(cosine: vec3<f32>, width: vec3<f32>) -> vec3<f32> {
    let t = clamp(cosine + width, vec3(0.0), 2.0 * width);
    return t * t / (4.0 * width) + max(cosine - width, vec3(0.0));
}

// What occlusion leaves of a lamp: more than of the room's light where it is slight, nothing in a hole.
fn lamp_reaching(occlusion: f32) -> f32 {
    return occlusion * (1.35 - 0.35 * occlusion);
}

// A smooth step over 0..1 of a value already scaled.
fn eased(value: f32) -> f32 {
    let t = clamp(value, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

@vertex
fn skin_vertex(in: SkinVertex) -> SkinFragment {
    let p = vec4(in.position, 1.0);
    let turned = vec4(in.normal, 0.0);
    let world = mix((frame.bodies[0] * p).xyz, (frame.bodies[1] * p).xyz, in.shares.x);
    let n = normalize(mix((frame.bodies[0] * turned).xyz, (frame.bodies[1] * turned).xyz, in.shares.x));
    let v = normalize(frame.eye.xyz - world);
    // What is dark at rest because the lips are closed opens up with them; folds deepen and open.
    let opened = in.shares.z * clamp(frame.mouth_height.x / 6.0, 0.0, 1.0);
    let still = mix(in.shares.w, max(in.shares.w, 0.55), opened);
    let occlusion = min(still * 2.0 * in.bend.x, 1.0);
    let edge = grazing(max(dot(n, v), 0.0));
    let f = dot(n, frame.fill_dir.xyz);
    let b = dot(n, frame.rim_dir.xyz);
    let around = ambient_from(n);
    let width = creep(in.bend.y);

    // The room and the lamps mirrored in the skin's oil, and the down of the cheek at grazing sight.
    let rim = gloss(n, v, frame.rim_dir.xyz, 0.5) * (1.0 + 6.0 * edge) * occlusion * occlusion;
    let fill = gloss(n, v, frame.fill_dir.xyz, 0.5) * occlusion;
    let mirrored = (frame.fill_colour.rgb * fill + frame.rim_colour.rgb * rim) * 0.8 * MIRROR
        + ambient_from(reflect(-v, n)) * ((0.020 + 0.10 * edge) * occlusion * occlusion);
    let shadow = shadow_place(world, n);
    let soft = frame.fill_colour.rgb * scattered(vec3(f), width) * lamp_reaching(occlusion)
        + frame.rim_colour.rgb * scattered(vec3(b), width) * occlusion
        + around * (bounced(occlusion, SKIN) + 0.35 * edge * occlusion);

    let left = clamp(in.position.x * 0.08 + 0.5, 0.0, 1.0);
    let raised = dot(in.raised, mix(frame.wrinkled[1], frame.wrinkled[0], left));
    let drawn = dot(in.drawn, mix(frame.wrinkled[3], frame.wrinkled[2], left));

    var out: SkinFragment;
    out.clip = frame.clip_from_world * vec4(world, 1.0);
    out.normal = vec4(n, dot(mirrored, vec3(0.3333)));
    out.places = vec4(in.uv, shadow.xy);
    out.soft = vec4(soft, shadow.z);
    out.shares = vec4(in.shares.y, in.shares.z, occlusion, in.bend.y);
    // The lips' own creases are of the first layer and always there.
    out.fine = vec4(in.grain, min(raised + 2.0 * in.shares.y, 1.0), min(drawn, 1.0));
    return out;
}

// What the maps say of a pixel.
struct Surface {
    // With its bumps.
    normal: vec3<f32>,
    albedo: vec3<f32>,
    gloss: f32,
    // What furrows, pores and wrinkles leave of what is mirrored.
    open: f32,
    through: f32,
    // How much of it is the lips' red.
    red: f32,
}

fn surface(in: SkinFragment) -> Surface {
    let texel = textureSample(colour_map, map_sampler, in.places.xy);
    let mask = textureSample(mask_map, map_sampler, in.places.xy);
    let window = (in.places.xy - WINDOW.xz) * (1.0 / (WINDOW.yw - WINDOW.xz));
    let wrinkles = textureSample(wrinkle_map, map_sampler, window) - FLAT;
    var slope = 2.0 * (wrinkles.xy * in.fine.z + wrinkles.zw * in.fine.w);
    var furrow = 0.0;
    var pore = 0.0;
    if GRAIN {
        let grain = textureSample(grain_map, tile_sampler, in.fine.xy);
        slope += (grain.xy - FLAT) * (3.0 * mask.g);
        furrow = grain.z * mask.g;
        pore = grain.w * texel.a;
    }
    let floors = 2.0 * (mask.a - FLAT);
    let floor = max(floors, 0.0) * in.fine.z - min(floors, 0.0) * in.fine.w;

    // Slopes lie across and up the chart, which the face's normal is near enough square to.
    let up = frame.bodies[1][1].xyz;
    let across = vec3(in.normal.z, 0.0, -in.normal.x);

    var out: Surface;
    out.normal = normalize(in.normal.xyz - across * slope.x - up * slope.y);
    // In a fold light bounces from skin to skin and comes out redder.
    let kept = 1.0 - floor * vec3(0.25, 0.36, 0.40) - pore * vec3(0.24, 0.36, 0.40) - furrow * vec3(0.03, 0.05, 0.06);
    out.albedo = texel.rgb * texel.rgb * kept;
    out.gloss = mask.r;
    out.open = (1.0 - 0.65 * pore) * (1.0 - 0.25 * furrow) * (1.0 - 0.6 * floor);
    out.through = mask.b;
    out.red = eased(in.shares.x * (1.0 + 0.35 * slope.x) * 2.13 - 0.32);
    return out;
}

// Share of the key light that reaches a pixel: its shadow, softened near the terminator where light wraps round, and
// nothing in nostrils and between lips. x: the shadow alone, y: all.
fn key_reaching(in: SkinFragment) -> vec2<f32> {
    let cosine = dot(in.normal.xyz, frame.key_dir.xyz);
    let visible = mix(1.0, key_visible(vec3(in.places.zw, in.soft.w)), eased(cosine * 2.94 + 0.353));
    return vec2(visible, visible * eased(in.shares.z * 2.5 - 0.125));
}
