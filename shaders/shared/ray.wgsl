// The ray through a point of the picture of a pinhole.

struct Ray {
    // View space, at z = -1.
    xy: vec2<f32>,
    // Change of x over a pixel to the right and of y over a pixel down.
    step: vec2<f32>,
}

fn ray_through(at: vec2<f32>) -> Ray {
    let step = vec2<f32>(1.0, -1.0) / frame.focal;
    return Ray((at - frame.center) * step, step);
}

// Change over a pixel to the right and down of what changes so with a ray's x and y.
fn over_pixel(ray: Ray, change: vec2<f32>) -> vec2<f32> {
    return change * ray.step;
}

// A change of a ray's x and y, pixels.
fn in_picture(ray: Ray, change: vec2<f32>) -> vec2<f32> {
    return change / ray.step;
}
