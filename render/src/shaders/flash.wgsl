// A white square in the upper left corner, for tests that record the screen.

#include "frame"

@vertex
fn flash_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    // Two triangles: corners 0 1 2 and 1 2 3.
    let i = select(index, index - 2u, index > 2u);
    let corner = vec2(f32(i & 1u), f32(i >> 1u));
    let side = frame.picture.z * vec2(1.0 / frame.backdrop[0].w, 1.0);
    return vec4(turned(vec2(-1.0, 1.0) + corner * 2.0 * side * vec2(1.0, -1.0)), 0.0, 1.0);
}

@fragment
fn flash() -> @location(0) vec4<f32> {
    return vec4(1.0);
}
