// A level of scattered light as large as the next larger one.

// The texel of a level that starts at a place, of so many texels; the nearest within beyond its border.
fn scattered_at(at: vec2<i32>, first: u32, size: vec2<u32>) -> vec3<f32> {
    let inside = vec2<u32>(clamp(at, vec2<i32>(0), vec2<i32>(size) - 1));
    return unpacked_light(scattered[first + inside.y * size.x + inside.x]).xyz;
}

// What a level has at a texel of the larger one: three parts of the nearer texel and one of the other
// along each axis.
fn drawn_out(at: vec2<u32>, first: u32, size: vec2<u32>) -> vec3<f32> {
    let near = vec2<i32>(at / 2u);
    let far = near + select(vec2<i32>(1), vec2<i32>(-1), (at & vec2<u32>(1u)) == vec2<u32>(0u));
    let same = scattered_at(near, first, size) * 0.75
        + scattered_at(vec2<i32>(near.x, far.y), first, size) * 0.25;
    let beside = scattered_at(vec2<i32>(far.x, near.y), first, size) * 0.75
        + scattered_at(far, first, size) * 0.25;
    return same * 0.75 + beside * 0.25;
}
