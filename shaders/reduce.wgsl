// Reduce: count and extent of each object's visible samples.
//
// Reads samples, adds to the sums. One invocation walks a strip of a row and adds where the
// object changes. Sums, smallest and largest of whole numbers, so that order does not matter.

@group(0) @binding(1) var<storage, read> raster_target: Target;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> surfaces: array<Surface>;
@group(0) @binding(4) var<storage, read> samples: array<vec2<u32>>;
@group(0) @binding(5) var<storage, read_write> sums: array<array<atomic<u32>, 5>>;

// Pixels of a strip.
const STRIP: u32 = 32u;

var<private> object: u32 = NOTHING;
var<private> count: u32;
var<private> low: vec2<u32>;
var<private> high: vec2<u32>;

// Adds what was gathered of one object.
fn flush() {
    if object != NOTHING && count > 0u {
        atomicAdd(&sums[object][0], count);
        atomicMax(&sums[object][1], NOTHING - low.x);
        atomicMax(&sums[object][2], NOTHING - low.y);
        atomicMax(&sums[object][3], high.x);
        atomicMax(&sums[object][4], high.y);
    }
    count = 0u;
    low = vec2<u32>(NOTHING);
    high = vec2<u32>(0u);
}

@compute @workgroup_size(2, 32)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.y >= raster_target.band_height {
        return;
    }
    flush();
    var slot = NOTHING;
    let end = min((id.x + 1u) * STRIP, raster_target.width);
    for (var x = id.x * STRIP; x < end; x++) {
        let first = (id.y * raster_target.width + x) * SAMPLES;
        let corner = vec2<u32>(x, id.y + raster_target.first_y) * 16u;
        for (var s = 0u; s < SAMPLES; s++) {
            let own = samples[first + s].x;
            if own != slot {
                slot = own;
                var next = NOTHING;
                if slot != NOTHING {
                    next = surfaces[primitives[slot].draw].object;
                }
                if next != object {
                    flush();
                    object = next;
                }
            }
            let at = corner + vec2<u32>(POSITIONS[s]);
            count += 1u;
            low = min(low, at);
            high = max(high, at);
        }
    }
    flush();
}
