// Disks of light out of focus. As core/src/engine/cpu/optics/defocus.rs, which says what they do.

const SQUARE: u32 = 16u;
// What light in focus has of its texel beyond the focus; less than the second is nothing.
const SHARP_SHARE: f32 = 0.001;
const LEAST_SHARE: f32 = 1e-7;

// How much of light with a radius counts as out of focus.
fn blurred_share(radius: f32) -> f32 {
    return clamp(abs(radius) - 0.5, 0.0, 1.0);
}

// Over the sum of a disk over all texels.
fn per_area(radius: f32) -> f32 {
    let disk = 3.1415927 * (radius * radius + 1.0 / 12.0);
    return 1.0 / max(disk, radius + 0.5);
}

// How much of a texel at a distance a disk covers.
fn cover(radius: f32, distance: f32) -> f32 {
    return clamp(radius + (0.5 - distance), 0.0, 1.0);
}

// Texels of the layers.
fn layer_size() -> vec2<u32> {
    return (frame.size + (1u << frame.blur_halvings) - 1u) >> vec2<u32>(frame.blur_halvings);
}

fn squares_across() -> u32 {
    return (layer_size().x + SQUARE - 1u) / SQUARE;
}
