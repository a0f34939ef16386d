// Fit: lays the sun's map over where what is seen and the shadows that can fall on it meet, with
// texels no finer than a pixel.
//
// Reads the boxes, writes the map's view and its raster target, and marks the objects whose shadow can be seen. One invocation does it all.

@group(0) @binding(1) var<storage, read_write> bounds: array<Bounds>;
@group(0) @binding(2) var<storage, read_write> raster_target: Target;
@group(0) @binding(3) var<storage, read_write> sun_view: SunView;

// Texels left free around what the map is fitted to.
const MARGIN: f32 = 2.0;
// Texels that a side is a multiple of.
const STEP: u32 = 64u;

struct Box {
    low: vec3<f32>,
    high: vec3<f32>,
    empty: bool,
}

fn box_at(i: u32) -> Box {
    let b = bounds[i];
    return Box(
        vec3<f32>(from_ordered(~b.low[0]), from_ordered(~b.low[1]), from_ordered(~b.low[2])),
        vec3<f32>(from_ordered(b.high[0]), from_ordered(b.high[1]), from_ordered(b.high[2])),
        b.nearest == 0u,
    );
}

// Texels of a side and the scale in texels a metre.
struct Side {
    texels: u32,
    scale: Double,
    extent_m: Double,
}

fn side(low: f32, high: f32, pixel_m: f32) -> Side {
    var extent = add_double(double(high), double(-low));
    if extent.hi < 1e-3 {
        extent = double(1e-3);
    }
    let wanted = add_double(divide_double(extent, double(pixel_m)), double(2.0 * MARGIN));
    var texels = frame.shadow_map_size;
    if wanted.hi < f32(frame.shadow_map_size) {
        let below = floor(wanted.hi);
        texels = u32(below) + select(0u, 1u, (wanted.hi - below) + wanted.lo > 0.0);
        texels = min((texels + STEP - 1u) / STEP * STEP, frame.shadow_map_size);
    }
    let scale = divide_double(double(f32(texels) - 2.0 * MARGIN), extent);
    return Side(texels, scale, extent);
}

fn set_row(row: u32, axis: vec3<f32>, scale: Double, offset: Double) {
    let x = multiply_double(double(axis.x), scale);
    let y = multiply_double(double(axis.y), scale);
    let z = multiply_double(double(axis.z), scale);
    raster_target.rows[row] = vec4<f32>(x.hi, y.hi, z.hi, offset.hi);
    raster_target.rows[row + 4u] = vec4<f32>(x.lo, y.lo, z.lo, offset.lo);
}

@compute @workgroup_size(1)
fn main() {
    sun_view.present = 0u;
    raster_target.width = 0u;
    raster_target.height = 0u;
    let receivers = box_at(0u);
    var casters = Box(vec3<f32>(0.0), vec3<f32>(0.0), true);
    for (var i = 1u; i <= frame.object_count; i++) {
        let caster = box_at(i);
        let beside = any(caster.high.xy < receivers.low.xy) || any(caster.low.xy > receivers.high.xy);
        // Deeper than anything seen, it is in others' shadow and shades nothing.
        let reaches =
            !caster.empty && !receivers.empty && !beside && caster.high.z >= receivers.low.z;
        bounds[i].reaches = select(0u, 1u, reaches);
        if reaches && casters.empty {
            casters = caster;
        } else if reaches {
            casters.low = min(casters.low, caster.low);
            casters.high = max(casters.high, caster.high);
        }
    }
    let low = max(casters.low, receivers.low);
    let high = min(casters.high, receivers.high);
    if casters.empty || receivers.empty || any(high.xy < low.xy) {
        return;
    }
    let pixel_m = from_ordered(~bounds[0].nearest) / max(frame.focal.x, frame.focal.y);
    let across = side(low.x, high.x, pixel_m);
    let down = side(low.y, high.y, pixel_m);
    let far = min(casters.low.z, receivers.low.z);
    let near = max(casters.high.z, receivers.high.z);
    // Depth stays above 0, which means that nothing casts.
    var extent = add_double(double(near), double(-far));
    if extent.hi < 1e-3 {
        extent = double(1e-3);
    }
    let depth = divide_double(double(0.998), extent);
    let from_x = negated(multiply_double(double(low.x), across.scale));
    let from_y = multiply_double(double(low.y), down.scale);
    let from_depth = negated(multiply_double(double(far), depth));
    set_row(0u, frame.sun_axes[0].xyz, across.scale, add_double(double(MARGIN), from_x));
    // Rows run down, against the second axis, so that front faces turn as in a picture.
    let last_row = add_double(double(f32(down.texels) - MARGIN), from_y);
    set_row(1u, frame.sun_axes[1].xyz, negated(down.scale), last_row);
    raster_target.rows[2] = vec4<f32>(0.0, 0.0, 0.0, 1.0);
    raster_target.rows[6] = vec4<f32>(0.0);
    set_row(3u, frame.sun_axes[2].xyz, depth, add_double(double(0.001), from_depth));
    raster_target.width = across.texels;
    raster_target.height = down.texels;
    raster_target.band_height = down.texels;
    sun_view.rows[0] = raster_target.rows[0];
    sun_view.rows[1] = raster_target.rows[1];
    sun_view.rows[2] = raster_target.rows[3];
    sun_view.size = vec2<u32>(across.texels, down.texels);
    sun_view.texel_m = 1.0 / min(across.scale.hi, down.scale.hi);
    sun_view.depth_per_m = depth.hi;
    sun_view.present = 1u;
}
