// Ways: how far what a pixel shows goes in the picture until the shutter closes.
//
// Of the nearest sample of each pixel, on the ray through the pixel's middle: the point of its triangle
// there, that point's place when the shutter closes, and the way between them in the picture.
// Reads samples; writes the whole picture's ways. One invocation a pixel.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(4) var<storage, read> samples: array<vec2<u32>>;
@group(0) @binding(5) var<storage, read_write> ways: array<vec2<u32>>;

// Shares of the second and third corner in the point that a ray from the origin meets, no farther off
// than the triangle reaches (Moeller and Trumbore 1997).
fn shares(a: vec3<f32>, u: vec3<f32>, v: vec3<f32>, ray: vec3<f32>) -> vec2<f32> {
    let p = cross(ray, v);
    let q = cross(u, a);
    let det = dot(u, p);
    if det == 0.0 {
        return vec2<f32>(0.0);
    }
    let second = clamp(-dot(a, p) / det, 0.0, 1.0);
    let third = clamp(dot(ray, q) / det, 0.0, 1.0 - second);
    return vec2<f32>(second, third);
}

fn way_of(slot: u32, ray: Ray) -> vec2<f32> {
    var start = vec3<f32>(ray.xy, -1.0);
    var end = vec3<f32>(0.0);
    if slot == NOTHING {
        for (var row = 0u; row < 3u; row++) {
            end[row] = dot(frame.end_from_view[row].xyz, start);
        }
    } else {
        let corners = primitives[slot].corners;
        let a = vertices[corners.x];
        let b = vertices[corners.y];
        let c = vertices[corners.z];
        let w = shares(a.position, b.position - a.position, c.position - a.position, start);
        let first = 1.0 - w.x - w.y;
        start = a.position * first + b.position * w.x + c.position * w.y;
        end = start + way_in_view(a.way) * first + way_in_view(b.way) * w.x
            + way_in_view(c.way) * w.y;
    }
    let near = min(frame.near_m, -start.z);
    let change = end.xy / max(-end.z, near) - start.xy / max(-start.z, near);
    return in_picture(ray, change);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= raster_target.width || id.y >= raster_target.band_height {
        return;
    }
    let first = (id.y * raster_target.width + id.x) * SAMPLES;
    var slot = NOTHING;
    var nearest = 0.0;
    for (var i = 0u; i < SAMPLES; i++) {
        let own = samples[first + i];
        if own.x != NOTHING && bitcast<f32>(own.y) > nearest {
            slot = own.x;
            nearest = bitcast<f32>(own.y);
        }
    }
    let place = vec2<u32>(id.x, id.y + raster_target.first_y);
    let way = cut(way_of(slot, ray_through(vec2<f32>(place) + 0.5)), MOST_PX);
    ways[place.y * raster_target.width + place.x] = packed_way(way, nearest);
}
