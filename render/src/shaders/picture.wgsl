// A user's picture as the backdrop: as large as fills the frame, in its middle. Its texels hold sRGB values
// multiplied with their alpha.

#include "frame"

@group(1) @binding(0) var picture_sampler: sampler;
@group(1) @binding(1) var picture_map: texture_2d<f32>;
@group(1) @binding(2) var unused_map: texture_2d<f32>;

@vertex
fn picture_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    // One triangle that covers the frame.
    return vec4(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 1.0, 1.0);
}

@fragment
fn picture(@builtin(position) clip: vec4<f32>) -> @location(0) vec4<f32> {
    let size = vec2<f32>(textureDimensions(picture_map));
    // From the middle of the upright picture, pixels to the right and down.
    let turn = frame.placing.xy;
    let p = clip.xy - frame.picture.xy * 0.5;
    let from_middle = vec2(p.x * turn.x + p.y * turn.y, p.y * turn.x - p.x * turn.y) - frame.placing.zw;
    // What it must fill, and how many of those pixels a texel becomes.
    let whole = select(frame.picture.xy, frame.picture.yx, turn.y != 0.0) + 2.0 * frame.reach.x;
    let scale = max(whole.x / size.x, whole.y / size.y);
    let at = from_middle / (size * scale) + 0.5;
    let texel = textureSample(picture_map, picture_sampler, at);
    return vec4(shown(texel.rgb).rgb, texel.a);
}
