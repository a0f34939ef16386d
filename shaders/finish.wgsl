// Display, where light was kept: develops the light of pixels, with what is scattered over them.
//
// Reads light and scattered light; writes the picture. One invocation for two by two pixels.

@group(0) @binding(1) var<storage, read> light: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> scattered: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read_write> picture: array<u32>;

fn finish(at: vec2<u32>, wide: vec3<f32>) {
    if any(at >= frame.size) {
        return;
    }
    let pixel = at.y * frame.size.x + at.x;
    var own = unpacked_light(light[pixel]).xyz;
    own += (wide - own) * frame.bloom_share;
    picture[pixel] = encode(developed(own, vec2<f32>(at) + 0.5, at), at);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = id.xy * 2u;
    if any(at >= frame.size) {
        return;
    }
    var wide: Four;
    if frame.bloom_share > 0.0 {
        wide = drawn_out(id.xy, 0u, (frame.size + 1u) / 2u);
    }
    finish(at, wide.upper.left);
    finish(at + vec2<u32>(1u, 0u), wide.upper.right);
    finish(at + vec2<u32>(0u, 1u), wide.lower.left);
    finish(at + 1u, wide.lower.right);
}
