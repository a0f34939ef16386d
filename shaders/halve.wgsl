// Bloom, on the way down: a level of scattered light from what is twice as large.
//
// Reads the light of pixels, or the larger level; writes the smaller one. One invocation a texel of it.

@group(0) @binding(1) var<uniform> step: Step;
@group(0) @binding(2) var<storage, read> light: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read_write> scattered: array<vec2<u32>>;

fn larger(at: vec2<i32>) -> vec3<f32> {
    let inside = vec2<u32>(clamp(at, vec2<i32>(0), vec2<i32>(step.larger_size) - 1));
    let place = inside.y * step.larger_size.x + inside.x;
    if step.larger_first == NOTHING {
        return unpacked_light(light[place]).xyz;
    }
    return unpacked_light(scattered[step.larger_first + place]).xyz;
}

// The binomial 1 3 3 1 of four.
fn smoothed(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, d: vec3<f32>) -> vec3<f32> {
    return ((a + d) + (b + c) * 3.0) * 0.125;
}

fn column(x: i32, y: i32) -> vec3<f32> {
    return smoothed(
        larger(vec2<i32>(x, y - 1)),
        larger(vec2<i32>(x, y)),
        larger(vec2<i32>(x, y + 1)),
        larger(vec2<i32>(x, y + 2)),
    );
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= step.smaller_size) {
        return;
    }
    let at = vec2<i32>(id.xy) * 2;
    let sum = smoothed(
        column(at.x - 1, at.y), column(at.x, at.y), column(at.x + 1, at.y), column(at.x + 2, at.y));
    let place = step.smaller_first + id.y * step.smaller_size.x + id.x;
    scattered[place] = packed_light(vec4<f32>(sum, 0.0));
}
