// The ray through a point of the picture of a lens. Needs raster_target and rays.

struct Ray {
    // View space, at z = -1.
    xy: vec2<f32>,
    // Change over a pixel to the right and down.
    right: vec2<f32>,
    down: vec2<f32>,
}

fn ray_through(at: vec2<f32>) -> Ray {
    let pixel = floor(at);
    let place = vec2<u32>(pixel) - vec2<u32>(0u, raster_target.first_y);
    let middle = rays[place.y * raster_target.width + place.x];
    let right = vec2<f32>(middle[2], middle[4]);
    let down = vec2<f32>(middle[3], middle[5]);
    let off = at - pixel - 0.5;
    return Ray(vec2<f32>(middle[0], middle[1]) + right * off.x + down * off.y, right, down);
}

// Change over a pixel to the right and down of what changes so with a ray's x and y.
fn over_pixel(ray: Ray, change: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(dot(change, ray.right), dot(change, ray.down));
}

// A change of a ray's x and y, pixels.
fn in_picture(ray: Ray, change: vec2<f32>) -> vec2<f32> {
    let det = ray.right.x * ray.down.y - ray.down.x * ray.right.y;
    let x = change.x * ray.down.y - change.y * ray.down.x;
    let y = change.y * ray.right.x - change.x * ray.right.y;
    return vec2<f32>(x, y) / det;
}
