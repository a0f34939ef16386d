// Clip: triangles that reach behind the near plane or far outside the picture are cut and
// appended; where a sun's map will be fitted, the box of what is seen grows by the visible part of
// those that reach over the picture's border.
//
// Reads the list that the set-up made. One invocation takes triangles in turn.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> batches: array<TriangleBatch>;
@group(0) @binding(3) var<storage, read> meshes: array<u32>;
@group(0) @binding(4) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(5) var<storage, read_write> primitives: array<Primitive>;
@group(0) @binding(6) var<storage, read_write> counters: array<atomic<u32>, 8>;
@group(0) @binding(7) var<storage, read> crossing_list: array<u32>;
@group(0) @binding(8) var<storage, read_write> bounds: array<array<atomic<u32>, 8>>;

// The near plane and the four sides of the picture.
const PLANES: u32 = 5u;

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
        let part = shape(source, first, before, next);
        if part.shows {
            append(part.primitive);
        }
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
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let end = atomicLoad(&counters[4]);
    for (var i = id.x; i < end; i += 64u * groups.x) {
        let item = crossing_list[i];
        let place = item / 4u;
        let source = source_of(batches[place / 64u], place % 64u);
        if (item & CUT) != 0u {
            add_crossing(source);
        }
        if (item & BOUND) != 0u {
            bound_border(source.corners);
        }
    }
}
