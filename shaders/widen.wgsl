// Bloom, on the way up: moves a level of scattered light towards the smaller one.
//
// Reads the smaller level; changes the larger. One invocation for two by two texels of it.

@group(0) @binding(1) var<uniform> step: Step;
@group(0) @binding(2) var<storage, read_write> scattered: array<vec2<u32>>;

fn widen(at: vec2<u32>, wide: vec3<f32>) {
    if any(at >= step.larger_size) {
        return;
    }
    let place = step.larger_first + at.y * step.larger_size.x + at.x;
    let own = unpacked_light(scattered[place]).xyz;
    let sum = own + (wide - own) * frame.bloom_spread;
    scattered[place] = packed_light(vec4<f32>(sum, 0.0));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = id.xy * 2u;
    if any(at >= step.larger_size) {
        return;
    }
    let wide = drawn_out(id.xy, step.smaller_first, step.smaller_size);
    widen(at, wide.upper.left);
    widen(at + vec2<u32>(1u, 0u), wide.upper.right);
    widen(at + vec2<u32>(0u, 1u), wide.lower.left);
    widen(at + 1u, wide.lower.right);
}
