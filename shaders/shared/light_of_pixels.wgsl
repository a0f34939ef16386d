// The light of pixels, where it is kept: three channels and how far out of focus it is, as halves.

// Light over one more than its brightest channel, so that sums of it are smooth where one is much
// brighter than the others; as core/src/engine/cpu/develop.rs.
fn compressed(light: vec3<f32>) -> vec3<f32> {
    let within = clamp(light, vec3<f32>(0.0), vec3<f32>(1e4));
    return within * (1.0 / (1.0 + max(max(within.x, within.y), within.z)));
}

// The light of a sum of compressed light.
fn turned_back(sum: vec3<f32>) -> vec3<f32> {
    return sum * (1.0 / max(1.0 - max(max(sum.x, sum.y), sum.z), 1e-5));
}

fn packed_light(light: vec4<f32>) -> vec2<u32> {
    return vec2<u32>(pack2x16float(light.xy), pack2x16float(light.zw));
}

fn unpacked_light(words: vec2<u32>) -> vec4<f32> {
    return vec4<f32>(unpack2x16float(words.x), unpack2x16float(words.y));
}

// Radius of what lies at a reciprocal depth, pixels; negative before the focus.
fn blur_radius_px(depth: f32) -> f32 {
    let radius_px = frame.blur_px * (1.0 - frame.focus_m * (depth / frame.near_m));
    return clamp(radius_px, -frame.blur_limit_px, frame.blur_limit_px);
}
