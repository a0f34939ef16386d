// Develop: exposed light to linear display light. As core/src/engine/cpu/develop.rs, which names
// the sources of the curves.

fn times(rows: array<vec4<f32>, 3>, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(rows[0].xyz, v), dot(rows[1].xyz, v), dot(rows[2].xyz, v));
}

// Share of the light that is left at a position in the picture.
fn vignette(at: vec2<f32>) -> f32 {
    let d = at * (frame.vignette / vec2<f32>(frame.size)) - 0.5 * frame.vignette;
    let d2 = min(d * d, vec2<f32>(1.0));
    return max(1.0 - (d2.x + d2.y), 0.0);
}

fn graded(light: vec3<f32>) -> vec3<f32> {
    let v = times(frame.grade_before, light);
    if frame.contrast == 1.0 {
        return v;
    }
    let steps = log2(clamp(v, vec3<f32>(1e-9), vec3<f32>(1e9))) * frame.contrast;
    return times(frame.grade_after, exp2(steps));
}

fn aces(v: vec3<f32>) -> vec3<f32> {
    let x = clamp(v, vec3<f32>(0.0), vec3<f32>(1e4));
    let y = (x * (x * 2.51 + 0.03)) / (x * (x * 2.43 + 0.59) + 0.14);
    return clamp(y, vec3<f32>(0.0), vec3<f32>(1.0));
}

const AGX_DARKEST: f32 = -12.47393;
const AGX_BRIGHTEST: f32 = 4.026069;
// By columns.
const AGX_INSET: mat3x3<f32> = mat3x3<f32>(
    vec3<f32>(0.84247906, 0.04232824, 0.042375654),
    vec3<f32>(0.0784336, 0.87846864, 0.0784336),
    vec3<f32>(0.079223745, 0.07916613, 0.879143),
);
const AGX_OUTSET: mat3x3<f32> = mat3x3<f32>(
    vec3<f32>(1.196879, -0.05289685, -0.052971635),
    vec3<f32>(-0.09802088, 1.1519031, -0.098043450),
    vec3<f32>(-0.09902974, -0.09896118, 1.1510737),
);

fn agx(light: vec3<f32>) -> vec3<f32> {
    let v = clamp(AGX_INSET * light, vec3<f32>(1e-9), vec3<f32>(1e9));
    let x = clamp(
        (log2(v) - AGX_DARKEST) * (1.0 / (AGX_BRIGHTEST - AGX_DARKEST)),
        vec3<f32>(0.0),
        vec3<f32>(1.0),
    );
    let x2 = x * x;
    let x4 = x2 * x2;
    let curve = x4 * x2 * 15.5 - x4 * x * 40.14 + x4 * 31.96 - x2 * x * 6.868 + x2 * 0.4298
        + x * 0.1191 - 0.00232;
    let encoded = clamp(AGX_OUTSET * curve, vec3<f32>(1e-9), vec3<f32>(1.0));
    return exp2(log2(encoded) * 2.2);
}

// Noise of a pixel's channels, standard deviation 1; core/src/engine/noise.rs has the same.
fn sensor_noise(pixel: vec2<u32>) -> vec3<f32> {
    let own = mixed(pixel.x + mixed(pixel.y + frame.sensor_key));
    var unit: vec3<f32>;
    for (var channel = 0u; channel < 3u; channel++) {
        unit[channel] = f32(i32(sum_of_bytes(mixed(own ^ (channel + 1u)))) - 510) / 147.80031;
    }
    return unit;
}

// Linear display light, 0..1, of exposed light at a position in the picture, which lies in a pixel.
fn developed(exposed: vec3<f32>, at: vec2<f32>, pixel: vec2<u32>) -> vec3<f32> {
    var light = exposed;
    if frame.vignette > 0.0 {
        light *= vignette(at);
    }
    if HAS_NOISE {
        let variance = max(light, vec3<f32>(0.0)) * frame.shot_noise + frame.read_variance;
        light += sqrt(variance) * sensor_noise(pixel);
    }
    if frame.contrast > 0.0 {
        light = graded(light);
    }
    if TONE_CURVE == 0u {
        return aces(light);
    }
    if TONE_CURVE == 1u {
        return agx(light);
    }
    return clamp(light, vec3<f32>(0.0), vec3<f32>(1.0));
}
