// A level of scattered light as large as the next larger one.

// The texel of a level that starts at a place, of so many texels; the nearest within beyond its border.
fn scattered_at(at: vec2<i32>, first: u32, size: vec2<u32>) -> vec3<f32> {
    let inside = vec2<u32>(clamp(at, vec2<i32>(0), vec2<i32>(size) - 1));
    return unpacked_light(scattered[first + inside.y * size.x + inside.x]).xyz;
}

// Two numbers in a row of the larger level.
struct Two {
    left: vec3<f32>,
    right: vec3<f32>,
}

// Four texels of the larger level, which a texel covers.
struct Four {
    upper: Two,
    lower: Two,
}

fn three_to_one(near: vec3<f32>, far: vec3<f32>) -> vec3<f32> {
    return near * 0.75 + far * 0.25;
}

fn row_drawn_out(at: vec2<i32>, first: u32, size: vec2<u32>) -> Two {
    let middle = scattered_at(at, first, size);
    return Two(
        three_to_one(middle, scattered_at(at - vec2<i32>(1, 0), first, size)),
        three_to_one(middle, scattered_at(at + vec2<i32>(1, 0), first, size)),
    );
}

// What a level has at the four texels of the larger one that its texel covers: three parts of the nearer
// texel and one of the other along each axis. All four at once, as they share what they read.
fn drawn_out(at: vec2<u32>, first: u32, size: vec2<u32>) -> Four {
    let place = vec2<i32>(at);
    let above = row_drawn_out(place - vec2<i32>(0, 1), first, size);
    let same = row_drawn_out(place, first, size);
    let below = row_drawn_out(place + vec2<i32>(0, 1), first, size);
    return Four(
        Two(three_to_one(same.left, above.left), three_to_one(same.right, above.right)),
        Two(three_to_one(same.left, below.left), three_to_one(same.right, below.right)),
    );
}
