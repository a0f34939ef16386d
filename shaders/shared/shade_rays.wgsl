// Rays through the middle of the band's pixels, view space at z = -1: x, y, the change of x over a
// pixel to the right and down, and that of y.
@group(0) @binding(12) var<storage, read> rays: array<array<f32, 6>>;
