// Motion blur, second: draws light out along the ways of what moves while the shutter is open.
//
// What lies before a pixel and passes over it is taken along the longest way around; what the pixel
// shows the rest of the time, along its own; see core/src/engine/cpu/optics/streak.rs.
// Reads light, ways, and the longest of tiles; writes light. One invocation a pixel.

@group(0) @binding(1) var<storage, read> light: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> ways: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> longest: array<vec2<f32>>;
@group(0) @binding(4) var<storage, read_write> drawn_out: array<vec2<u32>>;

// In this share of the distance what is nearer comes to lie before what is farther.
const PER_STEP: f32 = 50.0;
// A way of this length or less stays within its pixel.
const STILL_PX: f32 = 0.5;
// Places that light is taken from on either side of a pixel, along a way.
const MOST_TAPS: f32 = 16.0;

struct Pixel {
    light: vec3<f32>,
    // As unpacked_way.
    way: vec3<f32>,
}

// A way as places along it: whole pixels apart along the axis that it is nearer to, in between along
// the other.
struct Places {
    along: vec2<f32>,
    // From place to place, and its length.
    step: vec2<f32>,
    apart: f32,
    // Places to either side.
    count: i32,
}

// The two pixels that a place lies between, and how much of it is the second.
struct Between {
    first: Pixel,
    second: Pixel,
    part: f32,
}

struct Passing {
    light: vec3<f32>,
    hidden: f32,
}

fn longest_around(pixel: vec2<u32>) -> vec2<f32> {
    let tiles = (frame.size + frame.way_tile - 1u) / frame.way_tile;
    let tile = pixel / frame.way_tile;
    let end = min(tile + 2u, tiles);
    var most = vec2<f32>(0.0);
    for (var y = max(tile.y, 1u) - 1u; y < end.y; y++) {
        for (var x = max(tile.x, 1u) - 1u; x < end.x; x++) {
            most = longer(most, longest[y * tiles.x + x]);
        }
    }
    return most;
}

fn places_on(way: vec2<f32>) -> Places {
    let along = way / sqrt(dot(way, way));
    let longer_axis = max(abs(way.x), abs(way.y));
    let stride = max(ceil(longer_axis / MOST_TAPS), 1.0);
    let apart = stride / max(abs(along.x), abs(along.y));
    return Places(along, way / longer_axis * stride, apart, i32(ceil(longer_axis / stride)));
}

// How much of one depth lies before another.
fn before(nearer: f32, farther: f32) -> f32 {
    let step = (nearer - farther) / max(max(nearer, farther), 1e-20);
    return clamp(step * PER_STEP, 0.0, 1.0);
}

// The share of the time that what has a way spends at a distance along it.
fn share_at(way: f32, distance: f32) -> f32 {
    let reach = max(way, STILL_PX);
    return clamp(reach + 0.5 - distance, 0.0, 1.0) / (2.0 * reach);
}

// How far a way reaches in a direction, and how much of it goes there.
fn reach(way: vec2<f32>, along: vec2<f32>) -> vec2<f32> {
    let reach = dot(way, along);
    let square = dot(way, way);
    // What stays within its pixel goes to no side more than to others.
    let still = STILL_PX * STILL_PX;
    return vec2<f32>(abs(reach), (reach * reach + still) / (square + still));
}

// The pixel so far from another, or the nearest to it in the picture.
fn pixel_at(pixel: vec2<u32>, off: vec2<f32>) -> Pixel {
    let at = vec2<i32>(pixel) + vec2<i32>(off);
    let inside = vec2<u32>(clamp(at, vec2<i32>(0), vec2<i32>(frame.size) - 1));
    let place = inside.y * frame.size.x + inside.x;
    return Pixel(unpacked_light(light[place]).xyz, unpacked_way(ways[place]));
}

fn pixels_at(pixel: vec2<u32>, places: Places, index: i32) -> Between {
    let off = places.step * f32(index);
    let low = floor(off);
    let part = off - low;
    return Between(pixel_at(pixel, low), pixel_at(pixel, low + ceil(part)), max(part.x, part.y));
}

// How much of a pixel that lies before another passes over it.
fn passes(other: Pixel, depth: f32, places: Places, distance: f32) -> f32 {
    let reaches = reach(other.way.xy, places.along);
    return share_at(reaches.x, distance) * places.apart * before(other.way.z, depth) * reaches.y;
}

// Light of what lies before a pixel and passes over it, and the share of the time that it does.
fn passing(pixel: vec2<u32>, depth: f32, way: vec2<f32>) -> Passing {
    let places = places_on(way);
    var sum = Passing(vec3<f32>(0.0), 0.0);
    for (var index = -places.count; index <= places.count; index++) {
        let distance = f32(abs(index)) * places.apart;
        let two = pixels_at(pixel, places, index);
        let first = passes(two.first, depth, places, distance) * (1.0 - two.part);
        let second = passes(two.second, depth, places, distance) * two.part;
        sum.light += two.first.light * first + two.second.light * second;
        sum.hidden += first + second;
    }
    return sum;
}

// How much of a pixel is part of another's surface, or left free by it, as it passes by.
fn follows(other: Pixel, own: Pixel, own_reach: f32, along: vec2<f32>, distance: f32) -> f32 {
    let farther = before(own.way.z, other.way.z);
    let same = 1.0 - farther - before(other.way.z, own.way.z);
    let reaches = reach(other.way.xy, along);
    return share_at(reaches.x, distance) * reaches.y * same
        + share_at(own_reach, distance) * farther;
}

// Light of a pixel's own surface as it passes by, and of what it leaves free.
fn passed_by(pixel: vec2<u32>, own: Pixel) -> vec3<f32> {
    let own_reach = sqrt(dot(own.way.xy, own.way.xy));
    if own_reach <= STILL_PX {
        return own.light;
    }
    let places = places_on(own.way.xy);
    var sum = vec3<f32>(0.0);
    var shares = 0.0;
    for (var index = -places.count; index <= places.count; index++) {
        let distance = f32(abs(index)) * places.apart;
        let two = pixels_at(pixel, places, index);
        let first = follows(two.first, own, own_reach, places.along, distance) * (1.0 - two.part);
        let second = follows(two.second, own, own_reach, places.along, distance) * two.part;
        sum += two.first.light * first + two.second.light * second;
        shares += first + second;
    }
    if shares > 1e-4 {
        return sum / shares;
    }
    return own.light;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = id.xy;
    if any(pixel >= frame.size) {
        return;
    }
    let place = pixel.y * frame.size.x + pixel.x;
    let way = cut(longest_around(pixel), frame.longest_px);
    if sqrt(dot(way, way)) <= STILL_PX {
        drawn_out[place] = light[place];
        return;
    }
    let own = pixel_at(pixel, vec2<f32>(0.0));
    let over = passing(pixel, own.way.z, way);
    let factor = 1.0 / max(over.hidden, 1.0);
    let hidden = min(over.hidden, 1.0);
    let sum = over.light * factor + passed_by(pixel, own) * (1.0 - hidden);
    drawn_out[place] = packed_light(vec4<f32>(sum, 0.0));
}
