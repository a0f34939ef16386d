// What the samples of one tile show so far: the nearest wins, of equals the earlier drawn, so that the
// order of the lists does not matter. An invocation owns PIXELS pixels of the tile of 64, so that a
// primitive is read by few of them.

// Invocations of a tile.
const LANES: u32 = 64u / PIXELS;
const KEPT: u32 = PIXELS * SAMPLES;

var<private> best_depth: array<f32, KEPT>;
var<private> best_order: array<u32, KEPT>;
var<private> best_slot: array<u32, KEPT>;

// A pixel of an invocation, from the tile's corner.
fn pixel_of(lane: u32, k: u32) -> vec2<i32> {
    let index = lane + k * LANES;
    return vec2<i32>(i32(index & 7u), i32(index >> 3u));
}

// Takes a primitive for a sample, which stands at a place in the picture, raster units.
fn keep(at: u32, depth: f32, order: u32, slot: u32, place: vec2<i32>) {
    let wins = depth > best_depth[at] || (depth == best_depth[at] && order < best_order[at]);
    if wins && depth > 0.0 && leaves(place) {
        best_depth[at] = depth;
        best_order[at] = order;
        best_slot[at] = slot;
    }
}

fn forget() {
    for (var i = 0u; i < KEPT; i++) {
        best_depth[i] = 0.0;
        best_order[i] = NOTHING;
        best_slot[i] = NOTHING;
    }
}
