// Depth of field, third: puts what disks bring in place of the light that is out of focus.
//
// Reads what was gathered; changes the light of pixels. One invocation a pixel.

@group(0) @binding(1) var<storage, read> gathered: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read_write> light: array<vec2<u32>>;

struct Gathered {
    // Light beyond the focus, and how much that before it covers.
    beyond: vec4<f32>,
    before: vec3<f32>,
}

fn gathered_at(at: vec2<u32>, width: u32) -> Gathered {
    let words = gathered[at.y * width + at.x];
    let beyond = vec4<f32>(unpack2x16float(words.x), unpack2x16float(words.y));
    return Gathered(beyond, vec3<f32>(unpack2x16float(words.z), unpack2x16float(words.w).x));
}

fn mixed_of(a: Gathered, b: Gathered, t: f32) -> Gathered {
    return Gathered(a.beyond + (b.beyond - a.beyond) * t, a.before + (b.before - a.before) * t);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= frame.size) {
        return;
    }
    let size = layer_size();
    let per_unit = 1.0 / f32(1u << frame.blur_halvings);
    let at = (vec2<f32>(id.xy) + 0.5) * per_unit - 0.5;
    let low = floor(at);
    let t = at - low;
    let first = min(vec2<u32>(max(low, vec2<f32>(0.0))), size - 1u);
    let second = min(vec2<u32>(max(low + 1.0, vec2<f32>(0.0))), size - 1u);
    let above = mixed_of(
        gathered_at(first, size.x), gathered_at(vec2<u32>(second.x, first.y), size.x), t.x);
    let below = mixed_of(
        gathered_at(vec2<u32>(first.x, second.y), size.x), gathered_at(second, size.x), t.x);
    let around = mixed_of(above, below, t.y);
    let pixel = id.y * frame.size.x + id.x;
    let own = unpacked_light(light[pixel]);
    let behind = own.xyz + (around.beyond.xyz - own.xyz) * blurred_share(own.w * per_unit);
    let composed = behind * (1.0 - around.beyond.w) + around.before;
    light[pixel] = packed_light(vec4<f32>(composed, own.w));
}
