// Reduce: count and extent of each object's visible samples.
//
// Reads samples, adds to the sums. One invocation walks a strip of a row and adds where the
// object changes. Sums, smallest and largest of whole numbers, so that order does not matter.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> surfaces: array<Surface>;
@group(0) @binding(4) var<storage, read> samples: array<vec2<u32>>;
@group(0) @binding(5) var<storage, read_write> sums: array<array<atomic<u32>, 5>>;

// Pixels of a strip.
const STRIP: u32 = 32u;

// The object of a sample, NOTHING for none.
fn object_at(index: u32) -> u32 {
    let slot = samples[index].x;
    if slot == NOTHING {
        return NOTHING;
    }
    return surfaces[primitives[slot].draw].flags >> 16u;
}

@compute @workgroup_size(2, 32)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.y >= raster_target.band_height {
        return;
    }
    let row = id.y * raster_target.width * SAMPLES;
    let end = min((id.x + 1u) * STRIP, raster_target.width) * SAMPLES;
    var i = id.x * STRIP * SAMPLES;
    while i < end {
        // A run of samples of one object.
        let object = object_at(row + i);
        var count = 0u;
        var low = vec2<u32>(NOTHING);
        var high = vec2<u32>(0u);
        while i < end && object_at(row + i) == object {
            let corner = vec2<u32>(i / SAMPLES, id.y + raster_target.first_y) * 16u;
            let at = corner + vec2<u32>(POSITIONS[i % SAMPLES]);
            count += 1u;
            low = min(low, at);
            high = max(high, at);
            i += 1u;
        }
        if object != NOTHING {
            atomicAdd(&sums[object][0], count);
            atomicMax(&sums[object][1], NOTHING - low.x);
            atomicMax(&sums[object][2], NOTHING - low.y);
            atomicMax(&sums[object][3], high.x);
            atomicMax(&sums[object][4], high.y);
        }
    }
}
