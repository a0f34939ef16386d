// Raster: primitive and depth of every sample of a band of the picture.
//
// Reads primitives by tile, writes samples, those of a pixel side by side. One workgroup a tile.

@group(0) @binding(1) var<storage, read> raster_target: Target;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> counters: Counters;
@group(0) @binding(4) var<storage, read> tiles: array<Tile>;
@group(0) @binding(5) var<storage, read> lists: array<u32>;
// Primitive and bits of the depth.
@group(0) @binding(6) var<storage, read_write> samples: array<vec2<u32>>;

@compute @workgroup_size(LANES)
fn main(@builtin(workgroup_id) tile: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    raster_tile(tile.xy, lane);
    for (var k = 0u; k < PIXELS; k++) {
        let pixel = (tile.xy << vec2<u32>(TILE_LOG2)) + vec2<u32>(pixel_of(lane, k));
        if pixel.x < raster_target.width && pixel.y < raster_target.band_height {
            let first = (pixel.y * raster_target.width + pixel.x) * SAMPLES;
            for (var s = 0u; s < SAMPLES; s++) {
                let at = k * SAMPLES + s;
                samples[first + s] = vec2<u32>(best_slot[at], bitcast<u32>(best_depth[at]));
            }
        }
    }
}
