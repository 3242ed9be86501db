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
    // Half-way between the key light and the camera as seen from the head; w: what the glossy lobe is
    // divided by beyond its shape, at the angle between the two.
    half_key: vec4<f32>,
    // Light that a white matte surface facing the lamp returns, linear.
    key_colour: vec4<f32>,
    fill_colour: vec4<f32>,
    rim_colour: vec4<f32>,
    // Ambient light on a surface that faces n, spherical harmonics of order 2: see ambient_from in light.wgsl.
    ambient: array<vec4<f32>, 7>,
    // Middle of the opening between the lips in the head's frame; w: half its width.
    mouth: vec4<f32>,
    // x: half the height of that opening, mm.
    mouth_height: vec4<f32>,
    // Eyeballs in the head's frame; w: radius. Left, right.
    eyeballs: array<vec4<f32>, 2>,
    // Lid margins over the ball in units of its radius: y = x + y*X + z*X^2. Left upper, left lower,
    // right upper, right lower; w of the upper ones: how far the lids are open, 0..1.
    lids: array<vec4<f32>, 4>,
    // The same of the head at rest.
    lids_at_rest: array<vec4<f32>, 4>,
    // Backdrop in the middle and in the corners, or above and below, sRGB; w of the first: width over height;
    // w of the second: 1 where it runs from above to below.
    backdrop: array<vec4<f32>, 2>,
    // Size of the screen in pixels, share of its height that the flash square takes, how much the backdrop
    // covers: 1, or 0 where there is none.
    picture: vec4<f32>,
    // How far the zones of wrinkles are wrinkled (see maps/zones.rs): first layer left, right, second left, right.
    wrinkled: array<vec4<f32>, 4>,
    // Direction from the head towards the camera, unit length.
    toward_camera: vec4<f32>,
    // x: radius of the pupils in iris radii.
    pupil: vec4<f32>,
    // Cosine and sine of the picture's turn on the screen, clockwise; how far it is moved, pixels to the right and down.
    placing: vec4<f32>,
    // x: how far it is ever moved, pixels.
    reach: vec4<f32>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// A place of the upright picture on the screen, both -1..1 with y up.
fn turned(p: vec2<f32>) -> vec2<f32> {
    let turn = frame.placing.xy;
    return vec2(p.x * turn.x + p.y * turn.y, p.y * turn.x - p.x * turn.y);
}

// True where the target encodes sRGB by itself: then what is given to it must be decoded first.
override DECODE_SRGB: bool = false;

const PI: f32 = 3.14159265;

// A film's response with sRGB's curve in it (Hejl and Burgess-Dawson's fit): toe, straight middle,
// shoulder, ready to be shown. One division instead of powers: software rendering feels it.
fn filmic(light: vec3<f32>) -> vec3<f32> {
    let x = max(light * frame.eye.w - 0.004, vec3(0.0));
    return (x * (6.2 * x + 0.5)) / (x * (6.2 * x + 1.7) + 0.06);
}

// An sRGB value as the target wants it.
fn shown(srgb: vec3<f32>) -> vec4<f32> {
    if DECODE_SRGB {
        let low = srgb / 12.92;
        let high = pow((srgb + 0.055) / 1.055, vec3(2.4));
        return vec4(select(high, low, srgb <= vec3(0.04045)), 1.0);
    }
    return vec4(srgb, 1.0);
}

// Light as a finished pixel.
fn developed(light: vec3<f32>) -> vec4<f32> {
    return shown(filmic(light));
}
