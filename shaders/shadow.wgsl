// Shadow: the sun's depth map.
//
// Reads primitives by tile, writes texels row by row; 0 where nothing casts. One workgroup a tile.

@group(0) @binding(1) var<storage, read> raster_target: Target;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> counters: Counters;
@group(0) @binding(4) var<storage, read> tiles: array<Tile>;
@group(0) @binding(5) var<storage, read> lists: array<u32>;
@group(0) @binding(6) var<storage, read_write> shadow_map: array<f32>;

// Words in front of the texels: the SunView.
const HEADER: u32 = 20u;

@compute @workgroup_size(LANES)
fn main(@builtin(workgroup_id) tile: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    raster_tile(tile.xy, lane);
    for (var k = 0u; k < PIXELS; k++) {
        let texel = (tile.xy << vec2<u32>(TILE_LOG2)) + vec2<u32>(pixel_of(lane, k));
        shadow_map[HEADER + texel.y * raster_target.width + texel.x] = best_depth[k];
    }
}
