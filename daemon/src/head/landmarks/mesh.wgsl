// A scan or a head under one lamp that goes with the camera: shape first, colour as far as it is wanted.
// Drawn by mesh.rs into a picture that holds finished sRGB values.

struct Look {
    clip_from_world: mat4x4<f32>,
    // Directions of length one in the mesh's frame, towards the lamp and towards the eye.
    lamp: vec4<f32>,
    eye: vec4<f32>,
    // x: 1 with the mesh's own colour, 0 without.
    colour: vec4<f32>,
}

@group(0) @binding(0) var<uniform> look: Look;
@group(1) @binding(0) var picture: texture_2d<f32>;
@group(1) @binding(1) var smooth_repeat: sampler;

struct Vertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) colour: vec4<f32>,
}

struct Fragment {
    @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) uv: vec2<f32>,
    @location(2) colour: vec4<f32>,
}

@vertex
fn vertex(in: Vertex) -> Fragment {
    var out: Fragment;
    out.position = look.clip_from_world * vec4(in.position, 1.0);
    out.normal = in.normal;
    out.uv = in.uv;
    out.colour = in.colour;
    return out;
}

const CLAY = vec3(0.80, 0.745, 0.70);

@fragment
fn fragment(in: Fragment) -> @location(0) vec4<f32> {
    let texel = textureSample(picture, smooth_repeat, in.uv).rgb;
    let own = mix(in.colour.rgb, texel, in.colour.a);
    let albedo = pow(mix(CLAY, own, look.colour.x), vec3(2.2));
    // Scans may face inwards, and one looks into them through holes.
    var normal = normalize(in.normal);
    normal = select(-normal, normal, dot(normal, look.eye.xyz) >= 0.0);
    let lamp = max(dot(normal, look.lamp.xyz), 0.0);
    let sky = 0.5 + 0.5 * dot(normal, look.eye.xyz);
    let lit = albedo * (0.16 + 0.24 * sky + 0.85 * lamp);
    return vec4(pow(min(lit, vec3(1.0)), vec3(1.0 / 2.2)), 1.0);
}
