// Shadow: the sun's depth map, by primitives larger than those that sun_setup.wgsl rastered.
//
// Eight invocations take primitives in turn, and of each the blocks of 8x8 texels that it may touch;
// one invocation a column. Depth is 0 where nothing casts.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> counters: Counters;
@group(0) @binding(4) var<storage, read_write> shadow_map: array<atomic<u32>>;

// Rasters eight texels of a column, but for those below the last row.
fn raster_column(p: Primitive, top: vec2<i32>, last_row: i32) {
    let origin = (top << vec2<u32>(10u)) + 512;
    let x = p.x - origin.x;
    let y = p.y - origin.y;
    let a = y - y.yzx;
    let b = x.yzx - x;
    let bias = edge_bias(a, b);
    let e0 = edge_start(a.x, b.x, x.x, y.x, bias.x, 10u);
    let e1 = edge_start(a.y, b.y, x.y, y.y, bias.y, 10u);
    let e2 = edge_start(a.z, b.z, x.z, y.z, bias.z, 10u);
    var edges = vec3<i32>(e0.grid, e1.grid, e2.grid);
    let across = vec2<f32>(p.depth.y - p.depth.x, p.depth.z - p.depth.x) * p.inverse_area;
    let first = p.depth.x + (e2.value * across.x + e0.value * across.y);
    let fall = (f32(b.z) * across.x + f32(b.x) * across.y) * 1024.0;
    let rows = min(8, last_row - top.y + 1);
    for (var row = 0; row < rows; row++) {
        if (edges.x | edges.y | edges.z) >= 0 {
            let depth = first + fall * f32(row);
            let word = HEADER + u32(top.y + row) * raster_target.width + u32(top.x);
            atomicMax(&shadow_map[word], bitcast<u32>(depth));
        }
        edges += b;
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
    for (var slot = group.x * 8u + (lane >> 3u); slot < end; slot += groups.x * 8u) {
        // Read once for all blocks, which no compiler may do where another buffer is written.
        let p = primitives[slot];
        let low = max(vec2<i32>(least(p.x), least(p.y)) >> vec2<u32>(10u), vec2<i32>(0));
        let high = min(vec2<i32>(most(p.x), most(p.y)) >> vec2<u32>(10u), last);
        for (var y = low.y; y <= high.y; y += 8) {
            for (var x = low.x + i32(lane & 7u); x <= high.x; x += 8) {
                raster_column(p, vec2<i32>(x, y), high.y);
            }
        }
    }
}
