// Edge functions: not negative on the inner side of a triangle that turns clockwise on screen. One
// raster unit to the right adds a, one down adds b.

// -1 for the edges whose own samples belong to the triangle's neighbour: samples right on an edge
// belong to the triangle below or to the right of it.
fn edge_bias(a: vec3<i32>, b: vec3<i32>) -> vec3<i32> {
    let top_left = (a > vec3<i32>(0)) | ((a == vec3<i32>(0)) & (b > vec3<i32>(0)));
    return select(vec3<i32>(-1), vec3<i32>(0), top_left);
}

// An edge function at the tile's origin: in grid steps, rounded so that its sign holds at every
// sample, and its value.
struct EdgeStart {
    grid: i32,
    value: f32,
}

fn edge_start(a: i32, b: i32, x: i32, y: i32, bias: i32, shift: u32) -> EdgeStart {
    let value = negate_wide(add_wide(multiply_wide(a, x), multiply_wide(b, y)));
    let biased = add_wide(value, Wide(bitcast<u32>(bias), bias));
    return EdgeStart(shift_wide(biased, shift), float_wide(value));
}

fn least(v: vec3<i32>) -> i32 {
    return min(min(v.x, v.y), v.z);
}

fn most(v: vec3<i32>) -> i32 {
    return max(max(v.x, v.y), v.z);
}
