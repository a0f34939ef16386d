// Project: placed vertices into the sun's map; objects whose shadow cannot be seen are left out.
//
// Reads placed vertices, writes projected ones over the camera's, which nobody needs any more.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> batches: array<VertexBatch>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(4) var<storage, read_write> screen: array<ScreenVertex>;
@group(0) @binding(5) var<storage, read> bounds: array<Bounds>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.x + group.y * BATCHES_ACROSS;
    if index >= raster_target.vertex_batch_count {
        return;
    }
    let batch = batches[index];
    let reaches = bounds[batch.object + 1u].reaches != 0u;
    for (var i = lane; i < batch.count; i += 64u) {
        var projected = project(vertices[batch.first + i].position);
        if !reaches {
            projected.x = LEFT_OUT;
        }
        screen[batch.first + i] = projected;
    }
}
