// What every shader knows of the frame. Keep in step with gpu_data.rs.
// Frames: rest (mm, as the head file has it), world (the trunk's frame), head (the skull's frame).

struct Frame {
    clip_from_world: mat4x4<f32>,
    shadow_from_world: mat4x4<f32>,
    head_from_world: mat4x4<f32>,
    // World from rest, by body: trunk, skull, mandible, eye left, eye right, tongue body, tongue tip.
    bodies: array<mat4x4<f32>, 8>,
    // Camera in the world; w: exposure.
    eye: vec4<f32>,
    // Directions towards the lights in the world, unit length; w: half the angle the light fills.
    key_dir: vec4<f32>,
    fill_dir: vec4<f32>,
    rim_dir: vec4<f32>,
    // Light that a white matte surface facing the lamp returns, linear.
    key_colour: vec4<f32>,
    fill_colour: vec4<f32>,
    rim_colour: vec4<f32>,
    // Ambient light from direction n is dot(row, vec4(n, 1)), one row a channel.
    ambient: array<vec4<f32>, 3>,
    // Middle of the opening between the lips in the head's frame; w: half its width.
    mouth: vec4<f32>,
    // x: half the height of that opening, mm.
    mouth_height: vec4<f32>,
    // Eyeballs in the head's frame; w: radius. Left, right.
    eyeballs: array<vec4<f32>, 2>,
    // Lid margins over the ball in units of its radius: y = x + y*X + z*X^2. Left upper, left lower,
    // right upper, right lower; w of the upper ones: how far the lids are open, 0..1.
    lids: array<vec4<f32>, 4>,
    // Backdrop in the middle and in the corners, linear; w of the first: width over height.
    backdrop: array<vec4<f32>, 2>,
    // Size of the picture in pixels, share of its height that the flash square takes, unused.
    picture: vec4<f32>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// 1 where the target does not encode sRGB by itself.
override ENCODE_SRGB: bool = false;

const PI: f32 = 3.14159265;

fn saturate3(v: vec3<f32>) -> vec3<f32> {
    return clamp(v, vec3(0.0), vec3(1.0));
}

// A film's response (Narkowicz's fit of the ACES curve): a toe, a straight middle, a shoulder.
fn filmic(light: vec3<f32>) -> vec3<f32> {
    let x = light * frame.eye.w;
    return saturate3((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14));
}

fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let low = linear * 12.92;
    let high = 1.055 * pow(max(linear, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055;
    return select(high, low, linear <= vec3(0.0031308));
}

// Linear light as the target wants it.
fn encoded(linear: vec3<f32>) -> vec4<f32> {
    if ENCODE_SRGB {
        return vec4(srgb(linear), 1.0);
    }
    return vec4(linear, 1.0);
}

// Light as a finished pixel.
fn developed(light: vec3<f32>) -> vec4<f32> {
    return encoded(filmic(light));
}
