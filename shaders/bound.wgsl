// Bound: boxes along the sun's axes round each object that casts shadows, and round what is seen.
//
// Reads placed and projected vertices, grows the boxes: that of object i stands at i + 1, what
// is seen at 0. One workgroup takes a batch, one invocation eight vertices of it.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> batches: array<VertexBatch>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(4) var<storage, read> screen: array<ScreenVertex>;
@group(0) @binding(5) var<storage, read_write> bounds: array<array<atomic<u32>, 8>>;

struct Keys {
    low: vec3<u32>,
    high: vec3<u32>,
    nearest: u32,
}

fn grown(keys: Keys, position: vec3<f32>) -> Keys {
    let p = along_sun(position);
    let key = vec3<u32>(ordered(p.x), ordered(p.y), ordered(p.z));
    return Keys(max(keys.low, ~key), max(keys.high, key), max(keys.nearest, ~ordered(-position.z)));
}

fn keep(at: u32, keys: Keys) {
    if keys.nearest == 0u {
        return;
    }
    for (var axis = 0u; axis < 3u; axis++) {
        atomicMax(&bounds[at][axis], keys.low[axis]);
        atomicMax(&bounds[at][axis + 3u], keys.high[axis]);
    }
    atomicMax(&bounds[at][6], keys.nearest);
}

@compute @workgroup_size(32)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.x + group.y * BATCHES_ACROSS;
    if index >= raster_target.vertex_batch_count {
        return;
    }
    let batch = batches[index];
    let none = vec3<u32>(0u);
    var every = Keys(none, none, 0u);
    var seen = every;
    let size = vec2<u32>(raster_target.width, raster_target.height);
    let end = vec2<i32>(size) << vec2<u32>(16u);
    for (var i = lane; i < batch.count; i += 32u) {
        let position = vertices[batch.first + i].position;
        let at = vec2<i32>(screen[batch.first + i].x, screen[batch.first + i].y);
        every = grown(every, position);
        if all(at >= vec2<i32>(0)) && all(at <= end) {
            seen = grown(seen, position);
        }
    }
    if batch.casts != 0u {
        keep(batch.object + 1u, every);
    }
    if batch.in_view != 0u {
        keep(0u, seen);
    }
}
