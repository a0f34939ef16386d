// Motion blur, first: the longest way of each tile (of equals, that of the first pixel) before all ways
// are cut to the longest that is drawn out. Cut ones are alike in length, and one of them would be chosen
// by chance.
//
// Cuts the ways of pixels; writes those of tiles. One workgroup a tile.

@group(0) @binding(1) var<storage, read_write> ways: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read_write> longest: array<vec2<f32>>;

struct Found {
    way: vec2<f32>,
    place: u32,
}

var<workgroup> of_lanes: array<Found, 64>;

fn better(a: Found, b: Found) -> Found {
    let la = dot(a.way, a.way);
    let lb = dot(b.way, b.way);
    if lb > la || (lb == la && b.place < a.place) {
        return b;
    }
    return a;
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) tile: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let first = tile.xy * frame.way_tile;
    let size = min(vec2<u32>(frame.way_tile), frame.size - first);
    var own = Found(vec2<f32>(0.0), NOTHING);
    for (var i = lane; i < size.x * size.y; i += 64u) {
        let at = first + vec2<u32>(i % size.x, i / size.x);
        let place = at.y * frame.size.x + at.x;
        let way = unpacked_way(ways[place]);
        own = better(own, Found(way.xy, i));
        ways[place] = packed_way(cut(way.xy, frame.longest_px), way.z);
    }
    of_lanes[lane] = own;
    workgroupBarrier();
    for (var half = 32u; half > 0u; half >>= 1u) {
        if lane < half {
            of_lanes[lane] = better(of_lanes[lane], of_lanes[lane + half]);
        }
        workgroupBarrier();
    }
    if lane == 0u {
        let across = (frame.size.x + frame.way_tile - 1u) / frame.way_tile;
        longest[tile.y * across + tile.x] = of_lanes[0].way;
    }
}
