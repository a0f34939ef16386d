// Raster: primitive and depth of every sample of a band of the picture.
//
// Reads primitives by tile, writes samples, those of a pixel side by side. A workgroup takes as many
// tiles, side by side, as have 64 invocations.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> counters: Counters;
@group(0) @binding(4) var<storage, read> tiles: array<Tile>;
@group(0) @binding(5) var<storage, read> lists: array<u32>;
// Primitive and bits of the depth.
@group(0) @binding(6) var<storage, read_write> samples: array<vec2<u32>>;
@group(0) @binding(7) var<storage, read> vertices: array<Vertex>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index: u32) {
    let tile = vec2<u32>(group.x * (64u / LANES) + index / LANES, group.y);
    if tile.x >= raster_target.tiles.x {
        return;
    }
    let lane = index % LANES;
    raster_tile(tile, lane);
    for (var k = 0u; k < PIXELS; k++) {
        let pixel = (tile << vec2<u32>(TILE_LOG2)) + vec2<u32>(pixel_of(lane, k));
        if pixel.x < raster_target.width && pixel.y < raster_target.band_height {
            let first = (pixel.y * raster_target.width + pixel.x) * SAMPLES;
            for (var s = 0u; s < SAMPLES; s++) {
                let at = k * SAMPLES + s;
                samples[first + s] = vec2<u32>(best_slot[at], bitcast<u32>(best_depth[at]));
            }
        }
    }
}
