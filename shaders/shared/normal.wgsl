// Directions in one word: the octahedron |x| + |y| + |z| = 1 unfolded onto a square, each side in
// units of 1/32767 (Meyer et al., "On floating-point normal vectors", EGSR 2010).

// A vector of the direction, 0.57 to 1 long.
fn direction(packed: u32) -> vec3<f32> {
    let units = vec2<i32>(bitcast<i32>(packed << 16u) >> 16u, bitcast<i32>(packed) >> 16u);
    let flat = vec2<f32>(units) * (1.0 / 32767.0);
    let z = 1.0 - abs(flat.x) - abs(flat.y);
    let fold = max(-z, 0.0);
    return vec3<f32>(select(flat - fold, flat + fold, flat < vec2<f32>(0.0)), z);
}

// The nearest word to a direction of any length; within 0.004 degrees.
fn packed_direction(v: vec3<f32>) -> u32 {
    let size = abs(v);
    let scale = 1.0 / max(size.x + size.y + size.z, 1e-30);
    let upper = v.xy * scale;
    // The lower half is folded outwards over the upper half's edges.
    let outwards = 1.0 - abs(upper.yx);
    let lower = select(outwards, -outwards, upper < vec2<f32>(0.0));
    let units = vec2<i32>(round(select(upper, lower, v.z < 0.0) * 32767.0));
    return (bitcast<u32>(units.x) & 0xffffu) | (bitcast<u32>(units.y) << 16u);
}
