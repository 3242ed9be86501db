// The backdrop: a lit wall, a gradient, one colour or nothing, behind everything. A grid of cells, coloured at its
// corners: the wall changes slowly, and most of a picture is wall. Where there is none the picture's alpha, which all
// else has set to one, falls to nothing.

#include "frame"

struct WallFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) colour: vec3<f32>,
}

// Cells across and down. Keep in step with renderer.rs.
const CELLS: vec2<u32> = vec2(8u, 6u);

@vertex
fn backdrop_vertex(@builtin(vertex_index) index: u32) -> WallFragment {
    let cell = index / 6u;
    // Two triangles: corners 0 1 2 and 1 2 3.
    let i = index % 6u;
    let k = select(i, i - 2u, i > 2u);
    let corner = vec2(cell % CELLS.x + (k & 1u), cell / CELLS.x + (k >> 1u));
    let at = vec2<f32>(corner) / vec2<f32>(CELLS);
    let p = (at - vec2(0.5, 0.45)) * vec2(min(frame.backdrop[0].w, 1.6), 1.0);
    let share = select(smoothstep(0.05, 0.95, length(p)), at.y, frame.backdrop[1].w > 0.5);
    var out: WallFragment;
    out.clip = vec4(turned(at * vec2(2.0, -2.0) + vec2(-1.0, 1.0)), 1.0, 1.0);
    out.colour = mix(frame.backdrop[0].rgb, frame.backdrop[1].rgb, share);
    return out;
}

@fragment
fn backdrop(in: WallFragment) -> @location(0) vec4<f32> {
    // Fixed grain of a step, so that the slow gradient does not band once it has 8 bits.
    // (Interleaved gradient noise, Jimenez 2014: a few multiplications, which software rendering likes.)
    let grain = fract(52.9829189 * fract(dot(in.clip.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    let varies = any(frame.backdrop[0].rgb != frame.backdrop[1].rgb);
    return shown(in.colour + select(0.0, grain / 255.0, varies)) * frame.picture.w;
}
