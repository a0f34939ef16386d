// Resolve: the object that most samples of each pixel show, and its distance.
//
// Reads samples, writes object plus one (0 for nothing) and bits of the distance along the view
// axis in metres. One invocation a pixel.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> surfaces: array<Surface>;
@group(0) @binding(4) var<storage, read> samples: array<vec2<u32>>;
@group(0) @binding(5) var<storage, read_write> resolved: array<vec2<u32>>;

fn object_of(slot: u32) -> u32 {
    if slot == NOTHING {
        return 0u;
    }
    return (surfaces[primitives[slot].draw].flags >> 16u) + 1u;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= raster_target.width || id.y >= raster_target.band_height {
        return;
    }
    let pixel = id.y * raster_target.width + id.x;
    var objects: array<u32, SAMPLES>;
    for (var i = 0u; i < SAMPLES; i++) {
        objects[i] = object_of(samples[pixel * SAMPLES + i].x);
    }
    // Most samples win, of equals the nearest; nothing comes last.
    var winner = 0u;
    var votes = 0u;
    var nearest = 0.0;
    for (var i = 0u; i < SAMPLES; i++) {
        var count = 0u;
        var closest = 0.0;
        for (var j = 0u; j < SAMPLES; j++) {
            if objects[j] == objects[i] {
                count += 1u;
                closest = max(closest, bitcast<f32>(samples[pixel * SAMPLES + j].y));
            }
        }
        if count > votes || (count == votes && closest > nearest) {
            winner = objects[i];
            votes = count;
            nearest = closest;
        }
    }
    var distance = 0.0;
    if winner != 0u && nearest > 0.0 {
        distance = frame.near_m / nearest;
    }
    resolved[pixel] = vec2<u32>(winner, bitcast<u32>(distance));
}
