// Bloom, on the way down: a level of scattered light from what is twice as large.
//
// Reads the light of pixels, or the larger level; writes the smaller one. One invocation
// for two by two texels of it, which share most of what they read.

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

// Two texels of the smaller level, before they are smoothed along the other axis.
struct Two {
    left: vec3<f32>,
    right: vec3<f32>,
}

fn row(x: i32, y: i32) -> Two {
    let c = larger(vec2<i32>(x + 1, y));
    let d = larger(vec2<i32>(x + 2, y));
    return Two(
        smoothed(larger(vec2<i32>(x - 1, y)), larger(vec2<i32>(x, y)), c, d),
        smoothed(c, d, larger(vec2<i32>(x + 3, y)), larger(vec2<i32>(x + 4, y))),
    );
}

fn put(at: vec2<u32>, sum: vec3<f32>) {
    if all(at < step.smaller_size) {
        let place = step.smaller_first + at.y * step.smaller_size.x + at.x;
        scattered[place] = packed_light(vec4<f32>(sum, 0.0));
    }
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = id.xy * 2u;
    if any(at >= step.smaller_size) {
        return;
    }
    let x = i32(at.x) * 2;
    let y = i32(at.y) * 2;
    let a = row(x, y - 1);
    let b = row(x, y);
    let c = row(x, y + 1);
    let d = row(x, y + 2);
    let e = row(x, y + 3);
    let f = row(x, y + 4);
    put(at, smoothed(a.left, b.left, c.left, d.left));
    put(at + vec2<u32>(1u, 0u), smoothed(a.right, b.right, c.right, d.right));
    put(at + vec2<u32>(0u, 1u), smoothed(c.left, d.left, e.left, f.left));
    put(at + 1u, smoothed(c.right, d.right, e.right, f.right));
}
