// Set-up: from projected vertices to the triangles that may cover a sample.
//
// Drops back faces, triangles outside the picture, and those between the rows or columns of
// samples; cuts those that reach behind the near plane or far outside the picture. Reads meshes
// and vertices, appends primitives in any order; where the camera's picture is set up, grows the
// box of what is seen by the triangles that reach over its border. One workgroup takes a batch,
// one invocation one triangle. Built with `SUN` for the sun's map.

@group(0) @binding(1) var<storage, read> raster_target: Target;
@group(0) @binding(2) var<storage, read> batches: array<TriangleBatch>;
@group(0) @binding(3) var<storage, read> meshes: array<u32>;
@group(0) @binding(4) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(5) var<storage, read> screen: array<ScreenVertex>;
@group(0) @binding(6) var<storage, read_write> primitives: array<Primitive>;
@group(0) @binding(7) var<storage, read_write> counters: array<atomic<u32>, 4>;
@group(0) @binding(8) var<storage, read_write> bounds: array<array<atomic<u32>, 8>>;

// Binary digits that the raster has fewer than the screen.
const SNAP_BITS: u32 = 6u;
const HALF: i32 = 32;
// Triangles up to this size have edge functions below 2^31 all over a tile, raster units: with
// extent E and tile side T in pixels the largest is 2 E (E + T) 2^20.
const SMALL_UNITS: i32 = 28 * 1024;
// Below this thickness, screen units, depth is level across a triangle's longest edge: its slope
// would be made of rounding.
const SLIVER: f32 = 128.0;
// The near plane and the four sides of the picture.
const PLANES: u32 = 5u;

// What stays the same for all parts of a triangle.
struct Source {
    corners: vec3<u32>,
    order: u32,
    draw: u32,
    mirrored: bool,
    double_sided: bool,
}

// Twice the area of a triangle, clockwise positive where y runs down.
fn area_of(x: vec3<i32>, y: vec3<i32>) -> Wide {
    let first = multiply_wide(x.y - x.x, y.z - y.x);
    let second = multiply_wide(y.y - y.x, x.z - x.x);
    return add_wide(first, negate_wide(second));
}

fn least(v: vec3<i32>) -> i32 {
    return min(min(v.x, v.y), v.z);
}

fn most(v: vec3<i32>) -> i32 {
    return max(max(v.x, v.y), v.z);
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

// Appends a triangle whose corners were projected if it may cover a sample; says whether it may.
fn add_triangle(source: Source, a: ScreenVertex, b: ScreenVertex, c: ScreenVertex) -> bool {
    let fixed_x = vec3<i32>(a.x, b.x, c.x);
    let fixed_y = vec3<i32>(a.y, b.y, c.y);
    var x = (fixed_x + HALF) >> vec3<u32>(SNAP_BITS);
    var y = (fixed_y + HALF) >> vec3<u32>(SNAP_BITS);
    let area = area_of(x, y);
    let turned = area.hi < 0;
    if (area.hi == 0 && area.lo == 0u) || (turned == source.mirrored && !source.double_sided) {
        return false;
    }
    let low = vec2<i32>(least(x), least(y));
    let high = vec2<i32>(most(x), most(y));
    if misses_rows(low.x, high.x) || misses_rows(low.y, high.y) {
        return false;
    }
    let size = vec2<i32>(i32(raster_target.width), i32(raster_target.height));
    if any((high >> vec2<u32>(10u)) < vec2<i32>(0)) || any((low >> vec2<u32>(10u)) >= size) {
        return false;
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
    let slot = atomicAdd(&counters[0], 1u);
    if slot < arrayLength(&primitives) {
        primitives[slot] = Primitive(
            x,
            1.0 / abs(float_wide(area)),
            y,
            source.order,
            depth,
            select(0u, SMALL, small),
            source.corners,
            source.draw,
        );
    }
    return true;
}

// A convex polygon: a triangle cut by up to five planes.
struct Polygon {
    points: array<Point, 8>,
    count: u32,
}

// How far inside one of the planes, moved outwards by a margin, a point lies.
fn inside_by(plane: u32, margin_px: f32, p: Point) -> Double {
    let w = affine(ROW_W, p);
    if plane == 0u {
        return add_double(w, double(-raster_target.near_w));
    }
    let row = select(ROW_X, ROW_Y, plane > 2u);
    let far = plane == 2u || plane == 4u;
    let size = select(raster_target.width, raster_target.height, plane > 2u);
    let limit = select(-margin_px, f32(size) + margin_px, far);
    let distance = add_double(affine(row, p), negated(multiply_double(double(limit), w)));
    if far {
        return negated(distance);
    }
    return distance;
}

// Where an edge meets a plane, from the inner end.
fn crossing(inner: Point, d_inner: Double, outer: Point, d_outer: Double) -> Point {
    let t = divide_double(d_inner, add_double(d_inner, negated(d_outer)));
    return Point(
        between_doubles(inner.x, outer.x, t),
        between_doubles(inner.y, outer.y, t),
        between_doubles(inner.z, outer.z, t),
    );
}

fn add_point(polygon: ptr<function, Polygon>, p: Point) {
    // Rounding can make a polygon cross a plane once too often.
    if (*polygon).count < 8u {
        (*polygon).points[(*polygon).count] = p;
        (*polygon).count += 1u;
    }
}

// Keeps the part within the planes, moved outwards by a margin.
fn cut(polygon: ptr<function, Polygon>, margin_px: f32) {
    for (var plane = 0u; plane < PLANES; plane++) {
        var kept: Polygon;
        kept.count = 0u;
        let count = (*polygon).count;
        for (var i = 0u; i < count; i++) {
            let a = (*polygon).points[i];
            let b = (*polygon).points[select(i + 1u, 0u, i + 1u == count)];
            let da = inside_by(plane, margin_px, a);
            let db = inside_by(plane, margin_px, b);
            if da.hi >= 0.0 {
                add_point(&kept, a);
            }
            if da.hi >= 0.0 && db.hi < 0.0 {
                add_point(&kept, crossing(a, da, b, db));
            }
            if da.hi < 0.0 && db.hi >= 0.0 {
                add_point(&kept, crossing(b, db, a, da));
            }
        }
        *polygon = kept;
    }
}

fn triangle(corners: vec3<u32>) -> Polygon {
    var polygon: Polygon;
    polygon.points[0] = exact_point(vertices[corners.x].position);
    polygon.points[1] = exact_point(vertices[corners.y].position);
    polygon.points[2] = exact_point(vertices[corners.z].position);
    polygon.count = 3u;
    return polygon;
}

// Whether a triangle lies outside one of the picture's planes.
fn misses_picture(polygon: Polygon) -> bool {
    for (var plane = 0u; plane < PLANES; plane++) {
        var outside = true;
        for (var i = 0u; i < 3u; i++) {
            outside = outside && inside_by(plane, 0.0, polygon.points[i]).hi < 0.0;
        }
        if outside {
            return true;
        }
    }
    return false;
}

// Cuts a triangle that could not be projected and appends what is left of it.
fn add_crossing(source: Source) {
    var polygon = triangle(source.corners);
    if misses_picture(polygon) {
        return;
    }
    // Inside the guard band by a pixel, so that rounding does not leave it.
    cut(&polygon, GUARD_PX - 1.0);
    if polygon.count < 3u {
        return;
    }
    let first = project_inside(polygon.points[0]);
    var before = project_inside(polygon.points[1]);
    for (var i = 2u; i < polygon.count; i++) {
        let next = project_inside(polygon.points[i]);
        add_triangle(source, first, before, next);
        before = next;
    }
}

// Grows the box of what is seen by the visible part of a triangle.
fn bound_border(corners: vec3<u32>) {
    var polygon = triangle(corners);
    cut(&polygon, 0.0);
    for (var i = 0u; i < polygon.count; i++) {
        let point = polygon.points[i];
        let position = vec3<f32>(point.x.hi, point.y.hi, point.z.hi);
        let p = along_sun(position);
        for (var axis = 0u; axis < 3u; axis++) {
            atomicMax(&bounds[0][axis], ~ordered(p[axis]));
            atomicMax(&bounds[0][axis + 3u], ordered(p[axis]));
        }
        atomicMax(&bounds[0][6], ~ordered(-position.z));
    }
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.x + group.y * BATCHES_ACROSS;
    if index >= raster_target.batch_count {
        return;
    }
    let batch = batches[index];
    if lane >= batch.count || (SUN && atomicLoad(&bounds[batch.object + 1u][7]) == 0u) {
        return;
    }
    let word = batch.source + 3u * lane;
    let corners =
        vec3<u32>(meshes[word], meshes[word + 1u], meshes[word + 2u]) + vec3<u32>(batch.vertices);
    let source = Source(
        corners,
        batch.order + lane,
        batch.draw,
        batch.mirrored != 0u,
        batch.double_sided != 0u,
    );
    let a = screen[corners.x];
    let b = screen[corners.y];
    let c = screen[corners.z];
    let x = vec3<i32>(a.x, b.x, c.x);
    let y = vec3<i32>(a.y, b.y, c.y);
    let crosses = any(x == vec3<i32>(OUTSIDE));
    var shows = true;
    if crosses {
        add_crossing(source);
    } else {
        shows = add_triangle(source, a, b, c);
    }
    if !SUN && frame.has_shadow != 0u {
        let end = vec2<i32>(frame.size) << vec2<u32>(16u);
        let over = least(x) < 0 || least(y) < 0 || most(x) > end.x || most(y) > end.y;
        if shows && (crosses || over) {
            bound_border(corners);
        }
    }
}
