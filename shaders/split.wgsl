// Depth of field, first: divides the light of pixels between what lies before the focus and beyond.
//
// Reads light; writes the layers, and the widest disk of each square of texels (the largest of
// numbers, so that order does not matter). One invocation a texel.

@group(0) @binding(1) var<storage, read> light: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read_write> layers: array<array<u32, 5>>;
@group(0) @binding(3) var<storage, read_write> widest: array<array<atomic<u32>, 2>>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = layer_size();
    if any(id.xy >= size) {
        return;
    }
    let side = 1u << frame.blur_halvings;
    let per_unit = 1.0 / f32(side);
    var near = vec4<f32>(0.0);
    var far = vec4<f32>(0.0);
    var radii = vec2<f32>(0.0);
    var count = 0.0;
    let end = min((id.xy + 1u) * side, frame.size);
    for (var y = id.y * side; y < end.y; y++) {
        for (var x = id.x * side; x < end.x; x++) {
            let pixel = unpacked_light(light[y * frame.size.x + x]);
            let blurred = blurred_share(pixel.w * per_unit);
            var before = 0.0;
            var beyond = max(blurred, SHARP_SHARE);
            if pixel.w < 0.0 {
                before = blurred;
                beyond = (1.0 - blurred) * SHARP_SHARE;
            }
            near += vec4<f32>(pixel.xyz, 1.0) * before;
            far += vec4<f32>(pixel.xyz, 1.0) * beyond;
            radii += vec2<f32>(-pixel.w * before, max(pixel.w, 0.0) * beyond);
            count += 1.0;
        }
    }
    var radius = vec2<f32>(0.0);
    if near.w > 0.0 {
        radius.x = radii.x / near.w * per_unit;
    }
    if far.w > 0.0 {
        radius.y = radii.y / far.w * per_unit;
    }
    near *= 1.0 / count;
    far *= 1.0 / count;
    let at = id.y * size.x + id.x;
    layers[at][0] = pack2x16float(near.xy);
    layers[at][1] = pack2x16float(near.zw);
    layers[at][2] = pack2x16float(far.xy);
    layers[at][3] = pack2x16float(far.zw);
    layers[at][4] = pack2x16float(radius);
    let square = id.y / SQUARE * squares_across() + id.x / SQUARE;
    // Bits of numbers that are not negative are in their order.
    let kept = bitcast<vec2<u32>>(unpack2x16float(pack2x16float(radius)));
    atomicMax(&widest[square][0], kept.x);
    atomicMax(&widest[square][1], kept.y);
}
