// Display: exposed light to the 8-bit picture.

// Exposed light to linear display light, 0..1 (Narkowicz, "ACES filmic tone mapping curve", 2015).
fn tone_map(v: vec3<f32>) -> vec3<f32> {
    let x = clamp(v, vec3<f32>(0.0), vec3<f32>(1e4));
    let y = (x * (x * 2.51 + 0.03)) / (x * (x * 2.43 + 0.59) + 0.14);
    return clamp(y, vec3<f32>(0.0), vec3<f32>(1.0));
}

// Linear display light to sRGB (IEC 61966-2-1): the toe, and above it a polynomial of the fourth
// root that is within 0.01 of a step of 255.
fn srgb(x: vec3<f32>) -> vec3<f32> {
    let root = sqrt(sqrt(x));
    let curve = (((root * 0.08133736 - 0.33552042) * root + 1.1226989) * root + 0.19612922) * root
        - 0.06461064;
    return select(x * 12.92, curve, x > vec3<f32>(0.0031308));
}

// Linear display light to bytes, red lowest.
fn encode(color: vec3<f32>) -> u32 {
    return pack4x8unorm(vec4<f32>(srgb(clamp(color, vec3<f32>(0.0), vec3<f32>(1.0))), 0.0));
}
