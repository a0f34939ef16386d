// Skin: model space to view space, by linear blend skinning or one rigid transform, and the
// projection into the camera.
//
// Reads the mesh pool and the palette, writes placed and projected vertices. One workgroup takes
// a batch of up to 256 vertices of one object, one invocation four of them.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> batches: array<VertexBatch>;
@group(0) @binding(3) var<storage, read> meshes: array<u32>;
@group(0) @binding(4) var<storage, read> palette: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> vertices: array<Vertex>;
@group(0) @binding(6) var<storage, read_write> screen: array<ScreenVertex>;
@group(0) @binding(7) var<storage, read_write> bad_object: array<atomic<u32>, 8>;

// Words of a vertex in the pool: position, packed normal, u, v, four joints, four weights.
const VERTEX_WORDS: u32 = 8u;

// Longest way of a vertex along an axis, so that it is a half.
const FARTHEST_M: f32 = 60000.0;

struct Rows {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
}

fn rows_at(first: u32) -> Rows {
    return Rows(palette[first], palette[first + 1u], palette[first + 2u]);
}

fn row_times(row: vec4<f32>, p: vec3<f32>, w: f32) -> f32 {
    return row.x * p.x + row.y * p.y + row.z * p.z + row.w * w;
}

fn transform(m: Rows, p: vec3<f32>, w: f32) -> vec3<f32> {
    return vec3<f32>(row_times(m.x, p, w), row_times(m.y, p, w), row_times(m.z, p, w));
}

// The weighted mean of up to four transforms.
fn blend(first: u32, joints: u32, weights: u32) -> Rows {
    var sum = Rows(vec4<f32>(0.0), vec4<f32>(0.0), vec4<f32>(0.0));
    for (var k = 0u; k < 4u; k++) {
        if (weights >> (8u * k)) == 0u {
            break;
        }
        let weight = f32((weights >> (8u * k)) & 255u) / 255.0;
        let m = rows_at(first + 3u * ((joints >> (8u * k)) & 255u));
        sum.x += m.x * weight;
        sum.y += m.y * weight;
        sum.z += m.z * weight;
    }
    return sum;
}

fn vector_at(word: u32) -> vec3<f32> {
    return vec3<f32>(
        bitcast<f32>(meshes[word]),
        bitcast<f32>(meshes[word + 1u]),
        bitcast<f32>(meshes[word + 2u]),
    );
}

fn is_finite(v: vec3<f32>) -> bool {
    let exponents = bitcast<vec3<u32>>(v) & vec3<u32>(0x7f800000u);
    return all(exponents != vec3<u32>(0x7f800000u));
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.x + group.y * BATCHES_ACROSS;
    if index >= raster_target.vertex_batch_count {
        return;
    }
    let batch = batches[index];
    for (var i = lane; i < batch.count; i += 64u) {
        let word = batch.source + i * VERTEX_WORDS;
        var points: Rows;
        var normals: Rows;
        if batch.rigid != 0u {
            points = rows_at(batch.palette);
            normals = rows_at(batch.palette + 3u);
        } else {
            points = blend(batch.palette, meshes[word + 6u], meshes[word + 7u]);
            normals = points;
        }
        let position = transform(points, vector_at(word), 1.0);
        let bent = transform(normals, direction(meshes[word + 3u]), 0.0);
        if !(is_finite(position) && is_finite(bent)) {
            atomicMax(&bad_object[3], NOTHING - batch.object);
        }
        var way = vec3<f32>(0.0);
        if batch.end != NOTHING {
            var ends: Rows;
            if batch.rigid != 0u {
                ends = rows_at(batch.end);
            } else {
                ends = blend(batch.end, meshes[word + 6u], meshes[word + 7u]);
            }
            way = transform(ends, vector_at(word), 1.0) - position;
            if !is_finite(way) {
                atomicMax(&bad_object[3], NOTHING - batch.object);
            }
            way = clamp(way, vec3<f32>(-FARTHEST_M), vec3<f32>(FARTHEST_M));
        }
        let uv = vec2<f32>(bitcast<f32>(meshes[word + 4u]), bitcast<f32>(meshes[word + 5u]));
        vertices[batch.first + i].position = position;
        vertices[batch.first + i].normal = packed_direction(bent);
        vertices[batch.first + i].uv = uv;
        vertices[batch.first + i].way =
            vec2<u32>(pack2x16float(way.xy), pack2x16float(vec2<f32>(way.z, 0.0)));
        screen[batch.first + i] = project(position);
    }
}
