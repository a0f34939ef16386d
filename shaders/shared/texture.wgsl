// Trilinear filtering of the pooled textures. Texels are decoded before they are mixed, so that
// colours are filtered in linear light.

// Surface.map_info: log2 of the side in the low bits.
const MAP_LOG2: u32 = 31u;
const MAP_COLOR: u32 = 32u;
const MAP_PRESENT: u32 = 64u;

const ALBEDO_MAP: u32 = 0u;
const DETAIL_MAP: u32 = 1u;
const NORMAL_MAP: u32 = 2u;
const MASK_MAP: u32 = 3u;
const FINISH_MAP: u32 = 4u;

// A texel of plain numbers, 0..1.
fn decode_plain(texel: u32) -> vec4<f32> {
    let bytes = (vec4<u32>(texel) >> vec4<u32>(0u, 8u, 16u, 24u)) & vec4<u32>(255u);
    return vec4<f32>(bytes) * (1.0 / 255.0);
}

// A texel of colour to linear light: its three numbers are square roots.
fn decode_color(texel: u32) -> vec4<f32> {
    let units = (vec3<u32>(texel) >> vec3<u32>(0u, 10u, 20u)) & vec3<u32>(1023u);
    let roots = vec3<f32>(units) * (1.0 / 1023.0);
    return vec4<f32>(roots * roots, 1.0);
}

fn texel_at(at: u32, info: u32) -> vec4<f32> {
    let texel = texels[at];
    if (info & MAP_COLOR) != 0u {
        return decode_color(texel);
    }
    return decode_plain(texel);
}

// The mean of the four texels round a point of one level.
fn bilinear(first: u32, info: u32, log2_side: u32, uv: vec2<f32>) -> vec4<f32> {
    let log2_size = info & MAP_LOG2;
    // Sum of the sizes of the levels in front of it.
    let start = first + ((4u << (2u * log2_size)) - (4u << (2u * log2_side))) / 3u;
    let side = 1u << log2_side;
    let place = uv * f32(side) - 0.5;
    let corner = floor(place);
    let share = place - corner;
    let last = side - 1u;
    let left_top = bitcast<vec2<u32>>(vec2<i32>(corner)) & vec2<u32>(last);
    let right_low = (left_top + 1u) & vec2<u32>(last);
    let upper = start + (left_top.y << log2_side);
    let lower = start + (right_low.y << log2_side);
    let right = share.x * share.y;
    let upper_right = share.x - right;
    let lower_left = share.y - right;
    return texel_at(upper + left_top.x, info) * (1.0 - share.x - lower_left)
        + texel_at(upper + right_low.x, info) * upper_right
        + texel_at(lower + left_top.x, info) * lower_left
        + texel_at(lower + right_low.x, info) * right;
}

// Looks a texture up at coordinates that wrap; footprint is log2 of a pixel's size in them.
fn look_up(first: u32, info: u32, uv: vec2<f32>, footprint: f32) -> vec4<f32> {
    let wrapped = uv - floor(uv);
    let log2_size = info & MAP_LOG2;
    let top = f32(log2_size);
    let level = clamp(footprint + top, 0.0, top);
    let lower = floor(level);
    let between = level - lower;
    let log2_side = log2_size - u32(lower);
    var value = bilinear(first, info, log2_side, wrapped);
    if between > 0.0 {
        value = value * (1.0 - between) + bilinear(first, info, log2_side - 1u, wrapped) * between;
    }
    return value;
}

// log2 of a pixel's size in texture coordinates: the longer of its two sides.
fn footprint_of(d_dx: vec2<f32>, d_dy: vec2<f32>) -> f32 {
    return log2_near(clamp(max(dot(d_dx, d_dx), dot(d_dy, d_dy)), 1e-20, 1e20)) * 0.5;
}

// log2 of positive numbers, to within 0.01: the exponent, and a parabola for the mantissa.
fn log2_near(v: f32) -> f32 {
    let bits = bitcast<u32>(v);
    let exponent = f32(i32(bits >> 23u) - 127);
    let mantissa = f32(bits & 0x7fffffu) * (1.0 / 8388608.0);
    return exponent + mantissa + 0.344 * mantissa * (1.0 - mantissa);
}
