// Raster behind a lens: as raster.wgsl, but each sample stands in the pinhole's plane where a table
// says, and its edge functions are computed on their own. Needs raster_target, primitives, tiles,
// lists and counters.

// x and y of the band's samples in the plane, raster units, row by row and those of a pixel side by
// side.
@group(0) @binding(8) var<storage, read> places: array<vec2<i32>>;

// Those of the invocation's samples, and the smallest and largest of them.
var<private> own: array<vec2<i32>, KEPT>;
var<private> own_low: vec2<i32>;
var<private> own_high: vec2<i32>;

// Pixels beyond the band's border take what stands on it; nobody reads what they show.
fn load_places(tile: vec2<u32>, lane: u32) {
    let last = vec2<u32>(raster_target.width, raster_target.band_height) - 1u;
    own_low = vec2<i32>(0x7fffffff);
    own_high = vec2<i32>(-0x7fffffff);
    for (var k = 0u; k < PIXELS; k++) {
        let pixel = min((tile << vec2<u32>(TILE_LOG2)) + vec2<u32>(pixel_of(lane, k)), last);
        let first = (pixel.y * raster_target.width + pixel.x) * SAMPLES;
        for (var s = 0u; s < SAMPLES; s++) {
            let at = places[first + s];
            own[k * SAMPLES + s] = at;
            own_low = min(own_low, at);
            own_high = max(own_high, at);
        }
    }
}

fn raster_one(slot: u32) {
    let x = primitives[slot].x;
    let y = primitives[slot].y;
    let low = vec2<i32>(least(x), least(y));
    let high = vec2<i32>(most(x), most(y));
    if any(own_high < low) || any(own_low > high) {
        return;
    }
    take_cutout(slot);
    let a = y - y.yzx;
    let b = x.yzx - x;
    let bias = edge_bias(a, b);
    let small = (primitives[slot].flags & SMALL) != 0u;
    let z = primitives[slot].depth;
    let order = primitives[slot].order;
    let rise = vec2<f32>(z.y - z.x, z.z - z.x) * primitives[slot].inverse_area;
    for (var i = 0u; i < KEPT; i++) {
        let at = own[i];
        // Within the triangle's rectangle, products are as small as the triangle is.
        if any(at < low) || any(at > high) {
            continue;
        }
        var covered: bool;
        var weights: vec2<f32>;
        if small {
            let value = a * (at.x - x) + b * (at.y - y);
            let inside = value + bias;
            covered = (inside.x | inside.y | inside.z) >= 0;
            weights = vec2<f32>(f32(value.z), f32(value.x));
        } else {
            let e0 = edge_start(a.x, b.x, x.x - at.x, y.x - at.y, bias.x, 1u);
            let e1 = edge_start(a.y, b.y, x.y - at.x, y.y - at.y, bias.y, 1u);
            let e2 = edge_start(a.z, b.z, x.z - at.x, y.z - at.y, bias.z, 1u);
            covered = (e0.grid | e1.grid | e2.grid) >= 0;
            weights = vec2<f32>(e2.value, e0.value);
        }
        if covered {
            keep(i, z.x + (weights.x * rise.x + weights.y * rise.y), order, slot, at);
        }
    }
}

// Rasters everything that touches a tile: small primitives, then those of its list of others and
// those that all tiles look at.
fn raster_tile(tile: vec2<u32>, lane: u32) {
    forget();
    load_places(tile, lane);
    let index = tile.y * raster_target.tiles.x + tile.x;
    let small = tiles[index];
    for (var i = small.end - small.count; i < small.end; i++) {
        raster_one(lists[i]);
    }
    let large = min(counters.large, LARGE_ROOM);
    let others = tiles[index + raster_target.tiles.x * raster_target.tiles.y];
    for (var i = 0u; i < large + others.count; i++) {
        raster_one(lists[select(others.end - others.count + i - large, i, i < large)]);
    }
}
