// The backdrop: a lit wall, or one colour, behind everything.

#include "frame"

@vertex
fn backdrop_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    // One triangle over the whole picture, at the far end of depth.
    let corner = vec2(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4(corner, 1.0, 1.0);
}

// Fixed grain of half a step, so that the slow gradient does not band once it has 8 bits.
fn dither(pixel: vec2<f32>) -> f32 {
    let m = fract(52.9829189 * fract(dot(floor(pixel), vec2(0.06711056, 0.00583715))));
    return (m - 0.5) / 255.0;
}

@fragment
fn backdrop(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let p = (at.xy / frame.picture.xy - vec2(0.5, 0.45)) * vec2(min(frame.backdrop[0].w, 1.6), 1.0);
    let share = smoothstep(0.05, 0.95, length(p));
    let colour = mix(frame.backdrop[0].rgb, frame.backdrop[1].rgb, share);
    return encoded(max(colour + dither(at.xy) * colour * 3.0, vec3(0.0)));
}
