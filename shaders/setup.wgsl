// Set-up: from projected vertices to the triangles that may cover a sample.
//
// Drops back faces, triangles outside the picture, and those between the rows or columns of
// samples; leaves those that must be cut or bounded to clip.wgsl. Reads meshes and projected
// vertices, appends primitives in any order. One workgroup takes a batch, one invocation one
// triangle.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> batches: array<TriangleBatch>;
@group(0) @binding(3) var<storage, read> meshes: array<u32>;
@group(0) @binding(4) var<storage, read> screen: array<ScreenVertex>;
@group(0) @binding(5) var<storage, read_write> primitives: array<Primitive>;
@group(0) @binding(6) var<storage, read_write> counters: array<atomic<u32>, 8>;
@group(0) @binding(7) var<storage, read_write> crossing_list: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.x + group.y * BATCHES_ACROSS;
    if index >= raster_target.batch_count {
        return;
    }
    let batch = batches[index];
    if lane >= batch.count {
        return;
    }
    let source = source_of(batch, lane);
    let a = screen[source.corners.x];
    let b = screen[source.corners.y];
    let c = screen[source.corners.z];
    let x = vec3<i32>(a.x, b.x, c.x);
    let y = vec3<i32>(a.y, b.y, c.y);
    let crosses = any(x == vec3<i32>(OUTSIDE));
    let whole = shape(source, a, b, c);
    if whole.shows && !crosses {
        append(whole.primitive);
    }
    let size = vec2<u32>(raster_target.width, raster_target.height);
    let end = vec2<i32>(size) << vec2<u32>(16u);
    let over = least(x) < 0 || least(y) < 0 || most(x) > end.x || most(y) > end.y;
    let bounds_receivers = frame.has_shadow != 0u && (crosses || (over && whole.shows));
    if crosses || bounds_receivers {
        let kind = select(0u, CUT, crosses) | select(0u, BOUND, bounds_receivers);
        crossing_list[atomicAdd(&counters[4], 1u)] = (index * 64u + lane) * 4u + kind;
    }
}
