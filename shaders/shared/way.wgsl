// Ways as they are kept: of vertices, as halves; of pixels, in 64ths, with the depth of what goes.

const PER_PX: f32 = 64.0;
// Longest way that is kept, pixels.
const MOST_PX: f32 = 500.0;

// How far a vertex goes until the shutter closes, view space.
fn way_in_view(way: vec2<u32>) -> vec3<f32> {
    return vec3<f32>(unpack2x16float(way.x), unpack2x16float(way.y).x);
}

fn packed_way(way: vec2<f32>, depth: f32) -> vec2<u32> {
    let whole = vec2<u32>(vec2<i32>(floor(way * PER_PX + 0.5))) & vec2<u32>(0xffffu);
    return vec2<u32>(whole.x | (whole.y << 16u), bitcast<u32>(depth));
}

// The way, pixels, and the depth.
fn unpacked_way(words: vec2<u32>) -> vec3<f32> {
    let whole = vec2<i32>(vec2<u32>(words.x << 16u, words.x)) >> vec2<u32>(16u);
    return vec3<f32>(vec2<f32>(whole) * (1.0 / PER_PX), bitcast<f32>(words.y));
}

// A way that is no longer than so; what is not a number is nothing.
fn cut(way: vec2<f32>, longest_px: f32) -> vec2<f32> {
    let length_px = sqrt(dot(way, way));
    if !(length_px < 3.0e38) {
        return vec2<f32>(0.0);
    }
    return way * (longest_px / max(length_px, longest_px));
}

// The longer of two ways; of equals the first.
fn longer(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return select(a, b, dot(b, b) > dot(a, a));
}
