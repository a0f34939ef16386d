// Raster: depth, and which primitive, of the samples of one tile, by exact integer edge functions with
// the top-left rule. Needs raster_target, primitives, tiles, lists and counters.

// By how much edge functions without their last digits are too small at most: a unit for each of
// 127 steps to the right and down, and one for the start.
const CUT_DIGITS: i32 = 255;

// The tile's first sample, raster units.
var<private> tile_origin: vec2<i32>;

// Whether a sample, raster units from the tile's origin, lies in a triangle.
fn covers(x: vec3<i32>, y: vec3<i32>, bias: vec3<i32>, at: vec2<i32>) -> bool {
    let a = y - y.yzx;
    let b = x.yzx - x;
    for (var i = 0u; i < 3u; i++) {
        let edge = edge_start(a[i], b[i], x[i] - at.x, y[i] - at.y, bias[i], 1u);
        if edge.grid < 0 {
            return false;
        }
    }
    return true;
}

fn raster_large(slot: u32, lane: u32, x: vec3<i32>, y: vec3<i32>) {
    let a = y - y.yzx;
    let b = x.yzx - x;
    let bias = edge_bias(a, b);
    // Values of edges over some 4096 pixels long are too large with fine steps. They go without the
    // last digits, and samples that these decide about are looked at again: else neither of two
    // neighbours might take a sample on the edge between them.
    let steep = max(max(abs(a.x) + abs(b.x), abs(a.y) + abs(b.y)), abs(a.z) + abs(b.z));
    let extra = select(0u, 3u, SAMPLES > 1u && steep >= (1 << 22u));
    let shift = GRID_LOG2 + extra;
    let e0 = edge_start(a.x, b.x, x.x, y.x, bias.x, shift);
    let e1 = edge_start(a.y, b.y, x.y, y.y, bias.y, shift);
    let e2 = edge_start(a.z, b.z, x.z, y.z, bias.z, shift);
    let start = vec3<i32>(e0.grid, e1.grid, e2.grid);
    let step_x = a >> vec3<u32>(extra);
    let step_y = b >> vec3<u32>(extra);
    let across = select(vec3<i32>(0), step_x * (8 * GRID_PER_PX), step_x > vec3<i32>(0));
    let down = select(vec3<i32>(0), step_y * (8 * GRID_PER_PX), step_y > vec3<i32>(0));
    let doubt = select(0, -CUT_DIGITS, extra > 0u);
    if any(start + across + down < vec3<i32>(doubt)) {
        return;
    }
    take_cutout(slot);
    let z = primitives[slot].depth;
    let order = primitives[slot].order;
    let inverse_area = primitives[slot].inverse_area;
    let unit = f32(1u << GRID_LOG2);
    let slope = (vec2<f32>(f32(a.z), f32(b.z)) * (z.y - z.x)
        + vec2<f32>(f32(a.x), f32(b.x)) * (z.z - z.x)) * (inverse_area * unit);
    let depth = z.x + (e2.value * (z.y - z.x) + e0.value * (z.z - z.x)) * inverse_area;
    for (var k = 0u; k < PIXELS; k++) {
        let pixel = pixel_of(lane, k) * GRID_PER_PX;
        for (var s = 0u; s < SAMPLES; s++) {
            let at = pixel + (POSITIONS[s] - GRID_CORNER) * GRID_PER_PX / 16;
            let inside = start + step_x * at.x + step_y * at.y;
            let lowest = least(inside);
            if lowest < doubt {
                continue;
            }
            if lowest >= 0 || covers(x, y, bias, at << vec2<u32>(GRID_LOG2)) {
                let place = tile_origin + (at << vec2<u32>(GRID_LOG2));
                keep(k * SAMPLES + s, depth + dot(slope, vec2<f32>(at)), order, slot, place);
            }
        }
    }
}

fn raster_small(slot: u32, lane: u32, x: vec3<i32>, y: vec3<i32>) {
    let a = y - y.yzx;
    let b = x.yzx - x;
    let bias = edge_bias(a, b);
    let start = -(a * x + b * y);
    take_cutout(slot);
    let z = primitives[slot].depth;
    let order = primitives[slot].order;
    let rise = vec2<f32>(z.y - z.x, z.z - z.x) * primitives[slot].inverse_area;
    for (var k = 0u; k < PIXELS; k++) {
        let pixel = pixel_of(lane, k) * 1024;
        for (var s = 0u; s < SAMPLES; s++) {
            let at = pixel + (POSITIONS[s] - GRID_CORNER) * 64;
            let value = start + a * at.x + b * at.y;
            let inside = value + bias;
            if (inside.x | inside.y | inside.z) >= 0 {
                let depth = z.x + (f32(value.z) * rise.x + f32(value.x) * rise.y);
                keep(k * SAMPLES + s, depth, order, slot, tile_origin + at);
            }
        }
    }
}

// Rasters everything that touches a tile: small primitives, then those of its list of others and
// those that all tiles look at.
fn raster_tile(tile: vec2<u32>, lane: u32) {
    forget();
    let corner = vec2<i32>(tile << vec2<u32>(TILE_LOG2)) + vec2<i32>(0, i32(raster_target.first_y));
    // The first sample of a grid that goes on over the tile, raster units.
    let origin = (corner << vec2<u32>(10u)) + GRID_CORNER * 64;
    tile_origin = origin;
    let index = tile.y * raster_target.tiles.x + tile.x;
    let small = tiles[index];
    for (var i = small.end - small.count; i < small.end; i++) {
        let slot = lists[i];
        raster_small(slot, lane, primitives[slot].x - origin.x, primitives[slot].y - origin.y);
    }
    let large = min(counters.large, LARGE_ROOM);
    let others = tiles[index + raster_target.tiles.x * raster_target.tiles.y];
    for (var i = 0u; i < large + others.count; i++) {
        let slot = lists[select(others.end - others.count + i - large, i, i < large)];
        raster_large(slot, lane, primitives[slot].x - origin.x, primitives[slot].y - origin.y);
    }
}
