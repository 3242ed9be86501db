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
    // Pixels of the frame that a texel becomes.
    let scale = max(frame.picture.x / size.x, frame.picture.y / size.y);
    let at = (clip.xy - frame.picture.xy * 0.5) / (size * scale) + 0.5;
    let texel = textureSample(picture_map, picture_sampler, at);
    return vec4(shown(texel.rgb).rgb, texel.a);
}
