// Display, where light was kept: develops the light of pixels, with what is scattered over them.
//
// Reads light and scattered light; writes the picture. One invocation a pixel.

@group(0) @binding(1) var<storage, read> light: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> scattered: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read_write> picture: array<u32>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= frame.size) {
        return;
    }
    let pixel = id.y * frame.size.x + id.x;
    var own = unpacked_light(light[pixel]).xyz;
    if frame.bloom_share > 0.0 {
        let wide = drawn_out(id.xy, 0u, (frame.size + 1u) / 2u);
        own += (wide - own) * frame.bloom_share;
    }
    let color = developed(own, vec2<f32>(id.xy) + 0.5, id.xy);
    picture[pixel] = encode(color, id.xy);
}
