// Which tiles of a band a primitive may touch behind a lens. Needs raster_target.

// Sixteen pairs of words: where each level of cells starts and its columns, the coarsest again up to
// the last, which is the plane's size in pixels. Then the cells: first and last column, then row of
// tiles of the picture in halves of words.
@group(0) @binding(6) var<storage, read> squares: array<vec2<u32>>;

// Where the cells start.
const CELLS: u32 = 16u;
// log2 of the finest cells' side in pixels of the plane.
const CELL_LOG2: u32 = 4u;
const NO_TILE = vec4<i32>(1, 0, 1, 0);

// First and last column, then row of tiles of a cell.
fn cell_at(first: u32, across: u32, cell: vec2<u32>) -> vec4<i32> {
    let words = squares[CELLS + first + cell.y * across + cell.x];
    return vec4<i32>(vec4<u32>(words & vec2<u32>(0xffffu), words >> vec2<u32>(16u)).xzyw);
}

fn joined(a: vec4<i32>, b: vec4<i32>) -> vec4<i32> {
    let low = min(a, b);
    let high = max(a, b);
    return vec4<i32>(low.x, high.y, low.z, high.w);
}

// First and last column, then row of tiles; first > last where none is touched.
fn touched(x: vec3<i32>, y: vec3<i32>) -> vec4<i32> {
    let end = vec2<i32>(squares[CELLS - 1u]) - 1;
    let low = max(vec2<i32>(least(x), least(y)) >> vec2<u32>(10u), vec2<i32>(0));
    let high = min(vec2<i32>(most(x), most(y)) >> vec2<u32>(10u), end);
    if any(low > high) {
        return NO_TILE;
    }
    let start = vec2<u32>(low) >> vec2<u32>(CELL_LOG2);
    let stop = vec2<u32>(high) >> vec2<u32>(CELL_LOG2);
    // The level where the ends are the same or neighbours.
    let apart = max(stop.x - start.x, stop.y - start.y);
    var level = select(0u, firstLeadingBit(apart), apart > 0u);
    if any((stop >> vec2<u32>(level)) - (start >> vec2<u32>(level)) > vec2<u32>(1u)) {
        level += 1u;
    }
    let a = start >> vec2<u32>(level);
    let b = stop >> vec2<u32>(level);
    let first = squares[level].x;
    let across = squares[level].y;
    let above = joined(cell_at(first, across, a), cell_at(first, across, vec2<u32>(b.x, a.y)));
    let below = joined(cell_at(first, across, vec2<u32>(a.x, b.y)), cell_at(first, across, b));
    let t = joined(above, below);
    let first_row = i32(raster_target.first_y >> TILE_LOG2);
    let last = vec2<i32>(raster_target.tiles) - 1;
    let rows = vec2<i32>(max(t.z - first_row, 0), min(t.w - first_row, last.y));
    if t.x > t.y || rows.x > rows.y {
        return NO_TILE;
    }
    return vec4<i32>(t.x, min(t.y, last.x), rows.x, rows.y);
}
