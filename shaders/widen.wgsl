// Bloom, on the way up: moves a level of scattered light towards the smaller one.
//
// Reads the smaller level; changes the larger. One invocation a texel of it.

@group(0) @binding(1) var<uniform> step: Step;
@group(0) @binding(2) var<storage, read_write> scattered: array<vec2<u32>>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= step.larger_size) {
        return;
    }
    let place = step.larger_first + id.y * step.larger_size.x + id.x;
    let own = unpacked_light(scattered[place]).xyz;
    let wide = drawn_out(id.xy, step.smaller_first, step.smaller_size);
    let sum = own + (wide - own) * frame.bloom_spread;
    scattered[place] = packed_light(vec4<f32>(sum, 0.0));
}
