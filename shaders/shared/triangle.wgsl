// Set-up of triangles: from projected vertices to the primitives that may cover a sample. Needs
// raster_target, meshes, primitives and counters.

// Binary digits that the raster has fewer than the screen.
const SNAP_BITS: u32 = 6u;
const HALF: i32 = 32;
// Triangles up to this size have edge functions below 2^31 all over a tile, raster units: with
// extent E and tile side T in pixels the largest is 2 E (E + T) 2^20.
const SMALL_UNITS: i32 = 28 * 1024;
// Below this thickness, screen units, depth is level across a triangle's longest edge: its slope
// would be made of rounding.
const SLIVER: f32 = 128.0;
// What clip.wgsl does with a triangle: entries of its list are four times its place among the
// batches, and these.
const CUT: u32 = 1u;
const BOUND: u32 = 2u;

// What stays the same for all parts of a triangle.
struct Source {
    corners: vec3<u32>,
    order: u32,
    draw: u32,
    mirrored: bool,
    double_sided: bool,
    cutout: u32,
}

// Twice the area of a triangle, clockwise positive where y runs down.
fn area_of(x: vec3<i32>, y: vec3<i32>) -> Wide {
    let first = multiply_wide(x.y - x.x, y.z - y.x);
    let second = multiply_wide(y.y - y.x, x.z - x.x);
    return add_wide(first, negate_wide(second));
}

// Whether no row of samples lies between two coordinates.
fn misses_rows(low: i32, high: i32) -> bool {
    let log2 = raster_target.row_step_log2;
    let step = (1i << log2) - 1;
    return ((low - raster_target.first_row + step) >> log2)
        > ((high - raster_target.first_row) >> log2);
}

// Change of depth per screen unit to the right and down.
fn slope_of(x: vec3<i32>, y: vec3<i32>, depth: vec3<f32>) -> vec2<f32> {
    let u = vec3<f32>(f32(x.y - x.x), f32(y.y - y.x), depth.y - depth.x);
    let w = vec3<f32>(f32(x.z - x.x), f32(y.z - y.x), depth.z - depth.x);
    let area = float_wide(area_of(x, y));
    let reach = max(max(abs(u.x), abs(u.y)), max(abs(w.x), abs(w.y)));
    if abs(area) < SLIVER * reach {
        return along_longest_edge(u, w);
    }
    return vec2<f32>(u.z * w.y - w.z * u.y, w.z * u.x - u.z * w.x) / area;
}

fn along_longest_edge(u: vec3<f32>, w: vec3<f32>) -> vec2<f32> {
    let v = w - u;
    var longest = u;
    if dot(w.xy, w.xy) > dot(longest.xy, longest.xy) {
        longest = w;
    }
    if dot(v.xy, v.xy) > dot(longest.xy, longest.xy) {
        longest = v;
    }
    return longest.xy * (longest.z / max(dot(longest.xy, longest.xy), 1.0));
}

// A triangle as a primitive, if it may cover a sample.
struct Shape {
    primitive: Primitive,
    shows: bool,
}

// Sets up a triangle whose corners were projected.
fn shape(source: Source, a: ScreenVertex, b: ScreenVertex, c: ScreenVertex) -> Shape {
    var out: Shape;
    out.shows = false;
    let fixed_x = vec3<i32>(a.x, b.x, c.x);
    let fixed_y = vec3<i32>(a.y, b.y, c.y);
    var x = (fixed_x + HALF) >> vec3<u32>(SNAP_BITS);
    var y = (fixed_y + HALF) >> vec3<u32>(SNAP_BITS);
    let area = area_of(x, y);
    let turned = area.hi < 0;
    if (area.hi == 0 && area.lo == 0u) || (turned == source.mirrored && !source.double_sided) {
        return out;
    }
    let low = vec2<i32>(least(x), least(y));
    let high = vec2<i32>(most(x), most(y));
    if misses_rows(low.x, high.x) || misses_rows(low.y, high.y) {
        return out;
    }
    let size = vec2<i32>(i32(raster_target.width), i32(raster_target.height));
    if any((high >> vec2<u32>(10u)) < vec2<i32>(0)) || any((low >> vec2<u32>(10u)) >= size) {
        return out;
    }
    // Depth where the corners were snapped to.
    let slope = slope_of(fixed_x, fixed_y, vec3<f32>(a.depth, b.depth, c.depth));
    let moved_x = vec3<f32>((x << vec3<u32>(SNAP_BITS)) - fixed_x);
    let moved_y = vec3<f32>((y << vec3<u32>(SNAP_BITS)) - fixed_y);
    var depth = vec3<f32>(a.depth, b.depth, c.depth) + moved_x * slope.x + moved_y * slope.y;
    if turned {
        x = x.xzy;
        y = y.xzy;
        depth = depth.xzy;
    }
    // The farthest corner first: what the others add is never negative, so that nothing cancels.
    if depth.y < depth.x && depth.y <= depth.z {
        x = x.yzx;
        y = y.yzx;
        depth = depth.yzx;
    } else if depth.z < depth.x {
        x = x.zxy;
        y = y.zxy;
        depth = depth.zxy;
    }
    let small = all(high - low <= vec2<i32>(SMALL_UNITS));
    out.primitive = Primitive(
        x,
        1.0 / abs(float_wide(area)),
        y,
        source.order,
        depth,
        select(0u, SMALL, small) | source.cutout,
        source.corners,
        source.draw,
    );
    out.shows = true;
    return out;
}

// Keeps a primitive, in any order.
fn append(primitive: Primitive) {
    let slot = atomicAdd(&counters[0], 1u);
    if slot < arrayLength(&primitives) {
        primitives[slot] = primitive;
    }
}

// A triangle of a batch.
fn source_of(batch: TriangleBatch, lane: u32) -> Source {
    let word = batch.source + 3u * lane;
    let corners =
        vec3<u32>(meshes[word], meshes[word + 1u], meshes[word + 2u]) + vec3<u32>(batch.vertices);
    return Source(
        corners,
        batch.order + lane,
        batch.draw,
        batch.mirrored != 0u,
        batch.double_sided != 0u,
        batch.cutout,
    );
}
