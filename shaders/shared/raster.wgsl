// Raster: depth, and which primitive, of the samples of one tile.
//
// Coverage by exact integer edge functions with the top-left rule; the nearest sample wins, of
// equals the earlier drawn, so that the order of the lists does not matter. An invocation owns
// PIXELS pixels of the tile of 64. Needs raster_target, primitives, tiles, lists and counters.

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

fn keep(at: u32, depth: f32, order: u32, slot: u32) {
    if IDS {
        let wins = depth > best_depth[at] || (depth == best_depth[at] && order < best_order[at]);
        if wins && depth > 0.0 {
            best_depth[at] = depth;
            best_order[at] = order;
            best_slot[at] = slot;
        }
    } else {
        best_depth[at] = max(best_depth[at], depth);
    }
}

// An edge function at the tile's origin: in grid steps, rounded so that its sign holds at every
// sample, and its value.
struct EdgeStart {
    grid: i32,
    value: f32,
}

fn edge_start(a: i32, b: i32, x: i32, y: i32, bias: i32, shift: u32) -> EdgeStart {
    let value = negate_wide(add_wide(multiply_wide(a, x), multiply_wide(b, y)));
    let biased = add_wide(value, Wide(bitcast<u32>(bias), bias));
    return EdgeStart(shift_wide(biased, shift), float_wide(value));
}

fn raster_large(slot: u32, lane: u32, x: vec3<i32>, y: vec3<i32>) {
    let a = y - y.yzx;
    let b = x.yzx - x;
    let top_left = (a > vec3<i32>(0)) | ((a == vec3<i32>(0)) & (b > vec3<i32>(0)));
    let bias = select(vec3<i32>(-1), vec3<i32>(0), top_left);
    // Values of edges over some 4096 pixels long are too large with fine steps; they can do
    // without the last digits, as what is lost over a tile is a millionth of a step.
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
    if any(start + across + down < vec3<i32>(0)) {
        return;
    }
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
            if (inside.x | inside.y | inside.z) >= 0 {
                keep(k * SAMPLES + s, depth + dot(slope, vec2<f32>(at)), order, slot);
            }
        }
    }
}

fn raster_small(slot: u32, lane: u32, x: vec3<i32>, y: vec3<i32>) {
    let a = y - y.yzx;
    let b = x.yzx - x;
    let top_left = (a > vec3<i32>(0)) | ((a == vec3<i32>(0)) & (b > vec3<i32>(0)));
    let bias = select(vec3<i32>(-1), vec3<i32>(0), top_left);
    let start = -(a * x + b * y);
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
                keep(k * SAMPLES + s, depth, order, slot);
            }
        }
    }
}

fn raster_primitive(slot: u32, lane: u32, origin: vec2<i32>) {
    // From the first sample of a grid that goes on over the tile.
    let x = primitives[slot].x - vec3<i32>(origin.x + GRID_CORNER.x * 64);
    let y = primitives[slot].y - vec3<i32>(origin.y + GRID_CORNER.y * 64);
    if (primitives[slot].flags & SMALL) != 0u {
        raster_small(slot, lane, x, y);
    } else {
        raster_large(slot, lane, x, y);
    }
}

// Rasters everything that touches a tile.
fn raster_tile(tile: vec2<u32>, lane: u32) {
    for (var i = 0u; i < KEPT; i++) {
        best_depth[i] = 0.0;
        best_order[i] = NOTHING;
        best_slot[i] = NOTHING;
    }
    let corner = vec2<i32>(tile << vec2<u32>(TILE_LOG2)) + vec2<i32>(0, i32(raster_target.first_y));
    let origin = corner << vec2<u32>(10u);
    let large = min(counters.large, LARGE_ROOM);
    for (var i = 0u; i < large; i++) {
        let slot = lists[i];
        let x = primitives[slot].x;
        let y = primitives[slot].y;
        let low = vec2<i32>(min(min(x.x, x.y), x.z), min(min(y.x, y.y), y.z)) - origin;
        let high = vec2<i32>(max(max(x.x, x.y), x.z), max(max(y.x, y.y), y.z)) - origin;
        if all(low < vec2<i32>(8 << 10u)) && all(high >= vec2<i32>(0)) {
            raster_primitive(slot, lane, origin);
        }
    }
    let place = tiles[tile.y * raster_target.tiles.x + tile.x];
    for (var i = place.end - place.count; i < place.end; i++) {
        raster_primitive(lists[i], lane, origin);
    }
}
