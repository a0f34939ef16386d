// Display: linear display light to the 8-bit picture, with grain.

// Linear display light to sRGB (IEC 61966-2-1): the toe, and above it a polynomial of the fourth
// root that is within 0.01 of a step of 255.
fn srgb(x: vec3<f32>) -> vec3<f32> {
    let root = sqrt(sqrt(x));
    let curve = (((root * 0.08133736 - 0.33552042) * root + 1.1226989) * root + 0.19612922) * root
        - 0.06461064;
    return select(x * 12.92, curve, x > vec3<f32>(0.0031308));
}

// A well mixed number: PCG (Jarzynski and Olano, 2020).
fn mixed(v: u32) -> u32 {
    let state = v * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn sum_of_bytes(v: u32) -> u32 {
    return (v & 255u) + ((v >> 8u) & 255u) + ((v >> 16u) & 255u) + (v >> 24u);
}

// Grain of a pixel, sRGB: the sum of four bytes of a hash.
fn grain(pixel: vec2<u32>) -> f32 {
    let sum = sum_of_bytes(mixed(pixel.x + mixed(pixel.y + frame.grain_key)));
    return f32(i32(sum) - 510) * frame.grain;
}

// Linear display light of a pixel to bytes, red lowest.
fn encode(color: vec3<f32>, pixel: vec2<u32>) -> u32 {
    var v = srgb(clamp(color, vec3<f32>(0.0), vec3<f32>(1.0)));
    if frame.grain > 0.0 {
        v += grain(pixel);
    }
    return pack4x8unorm(vec4<f32>(v, 0.0));
}
