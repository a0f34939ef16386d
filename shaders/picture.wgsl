// Picture: the window's pane with the picture in it.
//
// Reads the picture's texture, which holds sRGB; writes every pixel of the pane once. A window's own shader would do
// it as well, but is several times as slow on adapters of software.

struct Part {
    // Upper left and lower right corner of the pane, shares of the picture.
    low: vec2<f32>,
    high: vec2<f32>,
    // Around the picture, sRGB.
    around: vec4<f32>,
}

struct Corner {
    @builtin(position) at: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

// Whether the window turns linear light into sRGB by itself.
override LINEAR: bool = false;

@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var picture: texture_2d<f32>;
@group(0) @binding(2) var filtering: sampler;

@vertex
fn corner(@builtin(vertex_index) index: u32) -> Corner {
    let share = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    let at = vec2<f32>(share.x * 2.0 - 1.0, 1.0 - share.y * 2.0);
    return Corner(vec4<f32>(at, 0.0, 1.0), mix(part.low, part.high, share));
}

@fragment
fn pixel(corner: Corner) -> @location(0) vec4<f32> {
    // There is one level; saying so spares the derivatives.
    var color = textureSampleLevel(picture, filtering, corner.uv, 0.0).rgb;
    if any(corner.uv < vec2<f32>(0.0)) || any(corner.uv > vec2<f32>(1.0)) {
        color = part.around.rgb;
    }
    if LINEAR {
        let low = color / 12.92;
        let high = pow((color + 0.055) / 1.055, vec3<f32>(2.4));
        color = select(high, low, color <= vec3<f32>(0.04045));
    }
    return vec4<f32>(color, 1.0);
}
