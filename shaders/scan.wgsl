// Scan: where each tile's list starts, from how long it is.
//
// Reads the counts of a band's tiles, writes the starts of their lists as ends, which the scatter
// moves on, and the room that all need. One workgroup; each invocation takes a run of tiles.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read_write> tiles: array<Tile>;
@group(0) @binding(3) var<storage, read_write> counters: Counters;

const LANES: u32 = 256u;
var<workgroup> sums: array<u32, LANES>;

@compute @workgroup_size(LANES)
fn main(@builtin(local_invocation_index) lane: u32) {
    let count = 2u * raster_target.tiles.x * raster_target.tiles.y;
    let run = (count + LANES - 1u) / LANES;
    let first = min(lane * run, count);
    let to = min(first + run, count);
    var sum = 0u;
    for (var i = first; i < to; i++) {
        sum += tiles[i].count;
    }
    sums[lane] = sum;
    workgroupBarrier();
    // Hillis and Steele, "Data parallel algorithms" (1986).
    for (var step = 1u; step < LANES; step *= 2u) {
        var before = 0u;
        if lane >= step {
            before = sums[lane - step];
        }
        workgroupBarrier();
        sums[lane] += before;
        workgroupBarrier();
    }
    var at = LARGE_ROOM + sums[lane] - sum;
    for (var i = first; i < to; i++) {
        tiles[i].end = at;
        at += tiles[i].count;
    }
    if lane == LANES - 1u {
        counters.entries = max(counters.entries, at);
    }
}
