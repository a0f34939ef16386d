// Which tiles of a band a primitive may touch. Needs raster_target.

// First and last column, then row of tiles; first > last where none is touched.
fn touched(x: vec3<i32>, y: vec3<i32>) -> vec4<i32> {
    let first_y = i32(raster_target.first_y);
    let low = vec2<i32>(min(min(x.x, x.y), x.z), min(min(y.x, y.y), y.z)) >> vec2<u32>(10u);
    let high = vec2<i32>(max(max(x.x, x.y), x.z), max(max(y.x, y.y), y.z)) >> vec2<u32>(10u);
    let end = vec2<i32>(i32(raster_target.width), i32(raster_target.band_height)) - 1;
    let start = max(low - vec2<i32>(0, first_y), vec2<i32>(0));
    let to = min(high - vec2<i32>(0, first_y), end);
    if any(start > to) {
        return vec4<i32>(1, 0, 1, 0);
    }
    let first = start >> vec2<u32>(TILE_LOG2);
    let last = to >> vec2<u32>(TILE_LOG2);
    return vec4<i32>(first.x, last.x, first.y, last.y);
}
