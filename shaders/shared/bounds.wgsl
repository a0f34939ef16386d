// Boxes along the sun's axes that many invocations grow at once. A coordinate is kept as a whole
// number that rises with it; smallest ones as its complement, so that 0 stands for nothing.

fn ordered(v: f32) -> u32 {
    let bits = bitcast<u32>(v);
    return select(bits | 0x80000000u, ~bits, (bits >> 31u) == 1u);
}

fn from_ordered(key: u32) -> f32 {
    return bitcast<f32>(select(~key, key & 0x7fffffffu, (key >> 31u) == 1u));
}

// A point's coordinates along the sun's axes, metres.
fn along_sun(p: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(frame.sun_axes[0].xyz, p),
        dot(frame.sun_axes[1].xyz, p),
        dot(frame.sun_axes[2].xyz, p),
    );
}
