// Value noise without a texture, for the few small surfaces that need grain.

fn hash2(p: vec2<f32>) -> f32 {
    // Integer hash: the same on every adapter.
    let q = vec2<u32>(vec2<i32>(floor(p)));
    var h = q.x * 0x9E3779B1u ^ q.y * 0x85EBCA77u;
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    h = h ^ (h >> 13u);
    return f32(h & 0xFFFFu) / 65535.0;
}

fn value_noise(p: vec2<f32>) -> f32 {
    let i = floor(p);
    let f = p - i;
    let u = f * f * (3.0 - 2.0 * f);
    let low = mix(hash2(i), hash2(i + vec2(1.0, 0.0)), u.x);
    let high = mix(hash2(i + vec2(0.0, 1.0)), hash2(i + vec2(1.0, 1.0)), u.x);
    return mix(low, high, u.y);
}
