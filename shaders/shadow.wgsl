// Shadow: the sun's depth map, by primitives larger than those that sun_setup.wgsl rastered.
//
// One workgroup takes primitives in turn, and of each the blocks of 8x8 texels that it may touch;
// one invocation a texel. Depth is 0 where nothing casts.

@group(0) @binding(1) var<storage, read> raster_target: Target;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> counters: Counters;
@group(0) @binding(4) var<storage, read_write> shadow_map: array<atomic<u32>>;

fn raster_block(slot: u32, corner: vec2<i32>, lane: u32) {
    let texel = corner + vec2<i32>(i32(lane & 7u), i32(lane >> 3u));
    let origin = (texel << vec2<u32>(10u)) + 512;
    let x = primitives[slot].x - origin.x;
    let y = primitives[slot].y - origin.y;
    let a = y - y.yzx;
    let b = x.yzx - x;
    let bias = edge_bias(a, b);
    let e0 = edge_start(a.x, b.x, x.x, y.x, bias.x, 10u);
    let e1 = edge_start(a.y, b.y, x.y, y.y, bias.y, 10u);
    let e2 = edge_start(a.z, b.z, x.z, y.z, bias.z, 10u);
    let size = vec2<i32>(i32(raster_target.width), i32(raster_target.height));
    if (e0.grid | e1.grid | e2.grid) >= 0 && all(texel < size) {
        let z = primitives[slot].depth;
        let rise = e2.value * (z.y - z.x) + e0.value * (z.z - z.x);
        let depth = z.x + rise * primitives[slot].inverse_area;
        let place = HEADER + u32(texel.y) * raster_target.width + u32(texel.x);
        atomicMax(&shadow_map[place], bitcast<u32>(depth));
    }
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let end = min(counters.primitives, arrayLength(&primitives));
    let last = vec2<i32>(i32(raster_target.width), i32(raster_target.height)) - 1;
    for (var slot = group.x; slot < end; slot += groups.x) {
        let x = primitives[slot].x;
        let y = primitives[slot].y;
        let least = vec2<i32>(min(min(x.x, x.y), x.z), min(min(y.x, y.y), y.z));
        let most = vec2<i32>(max(max(x.x, x.y), x.z), max(max(y.x, y.y), y.z));
        let low = max(least >> vec2<u32>(10u), vec2<i32>(0));
        let high = min(most >> vec2<u32>(10u), last);
        let blocks = (max(high - low, vec2<i32>(-1)) + 8) / 8;
        for (var block = 0; block < blocks.x * blocks.y; block++) {
            raster_block(slot, low + vec2<i32>(block % blocks.x, block / blocks.x) * 8, lane);
        }
    }
}
