// From view space to fixed-point picture coordinates, as the rows of a Target say.

// Vertices up to this far outside the picture are rastered as they are, pixels.
const GUARD_PX: f32 = 4096.0;
const ROW_X: u32 = 0u;
const ROW_Y: u32 = 1u;
const ROW_W: u32 = 2u;
const ROW_DEPTH: u32 = 3u;

struct Point {
    x: Double,
    y: Double,
    z: Double,
}

fn exact_point(p: vec3<f32>) -> Point {
    return Point(double(p.x), double(p.y), double(p.z));
}

// An affine function of a point.
fn affine(row: u32, p: Point) -> Double {
    let hi = raster_target.rows[row];
    let lo = raster_target.rows[row + 4u];
    let xy = add_double(
        multiply_double(Double(hi.x, lo.x), p.x),
        multiply_double(Double(hi.y, lo.y), p.y),
    );
    let z = multiply_double(Double(hi.z, lo.z), p.z);
    return add_double(add_double(xy, z), Double(hi.w, lo.w));
}

fn to_fixed(px: Double) -> i32 {
    return round_double(Double(px.hi * 65536.0, px.lo * 65536.0));
}

// A point that lies in the guard band and behind the near plane.
fn project_inside(p: Point) -> ScreenVertex {
    let w = affine(ROW_W, p);
    let x = to_fixed(divide_double(affine(ROW_X, p), w));
    let y = to_fixed(divide_double(affine(ROW_Y, p), w));
    let depth = divide_double(affine(ROW_DEPTH, p), w);
    return ScreenVertex(x, y, depth.hi, 0u);
}

fn project(position: vec3<f32>) -> ScreenVertex {
    let p = exact_point(position);
    let w = affine(ROW_W, p);
    if !(w.hi >= raster_target.near_w) {
        return ScreenVertex(OUTSIDE, 0, 0.0, 0u);
    }
    let x = divide_double(affine(ROW_X, p), w);
    let y = divide_double(affine(ROW_Y, p), w);
    let end = vec2<f32>(f32(raster_target.width), f32(raster_target.height)) + GUARD_PX;
    let inside = x.hi >= -GUARD_PX && x.hi <= end.x && y.hi >= -GUARD_PX && y.hi <= end.y;
    if !inside {
        return ScreenVertex(OUTSIDE, 0, 0.0, 0u);
    }
    let depth = divide_double(affine(ROW_DEPTH, p), w);
    return ScreenVertex(to_fixed(x), to_fixed(y), depth.hi, 0u);
}
