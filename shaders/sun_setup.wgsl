// Set-up of the sun's map: triangles of a few texels are rastered at once, larger ones appended
// for shadow.wgsl, and those that must be cut left to clip.wgsl.
//
// The nearest depth of each texel is its largest, which does not depend on the order. One workgroup
// takes a batch, one invocation one triangle.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> batches: array<TriangleBatch>;
@group(0) @binding(3) var<storage, read> meshes: array<u32>;
@group(0) @binding(4) var<storage, read> screen: array<ScreenVertex>;
@group(0) @binding(5) var<storage, read_write> primitives: array<Primitive>;
@group(0) @binding(6) var<storage, read_write> counters: array<atomic<u32>, 8>;
@group(0) @binding(7) var<storage, read_write> crossing_list: array<u32>;
@group(0) @binding(8) var<storage, read_write> shadow_map: array<atomic<u32>>;

// Largest side of a triangle that is rastered at once, raster units.
const AT_ONCE: i32 = 8 * 1024;

// Rasters a triangle whose sides are at most AT_ONCE.
fn raster_at_once(p: Primitive) {
    let end = vec2<i32>(i32(raster_target.width), i32(raster_target.height)) - 1;
    let low = max(vec2<i32>(least(p.x), least(p.y)) >> vec2<u32>(10u), vec2<i32>(0));
    let high = min(vec2<i32>(most(p.x), most(p.y)) >> vec2<u32>(10u), end);
    let size = high - low + 1;
    let a = p.y - p.y.yzx;
    let b = p.x.yzx - p.x;
    let bias = edge_bias(a, b);
    let rise = vec2<f32>(p.depth.y - p.depth.x, p.depth.z - p.depth.x) * p.inverse_area;
    let count = size.x * size.y;
    var texel = low;
    for (var k = 0; k < count; k++) {
        let at = texel * 1024 + 512;
        let value = a * (at.x - p.x) + b * (at.y - p.y);
        let inside = value + bias;
        if (inside.x | inside.y | inside.z) >= 0 {
            let depth = p.depth.x + (f32(value.z) * rise.x + f32(value.x) * rise.y);
            let place = HEADER + u32(texel.y) * raster_target.width + u32(texel.x);
            atomicMax(&shadow_map[place], bitcast<u32>(depth));
        }
        texel.x += 1;
        if texel.x > high.x {
            texel = vec2<i32>(low.x, texel.y + 1);
        }
    }
}

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
    if any(x == vec3<i32>(LEFT_OUT)) {
        return;
    }
    let crosses = any(x == vec3<i32>(OUTSIDE));
    if crosses {
        crossing_list[atomicAdd(&counters[4], 1u)] = (index * 64u + lane) * 4u + CUT;
        return;
    }
    let whole = shape(source, a, b, c);
    if !whole.shows {
        return;
    }
    let p = whole.primitive;
    let side = max(most(p.x) - least(p.x), most(p.y) - least(p.y));
    if side > AT_ONCE {
        append(p);
        return;
    }
    raster_at_once(p);
}
