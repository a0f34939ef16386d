// Cutouts: which samples of a primitive lie on a strand of it; library::mesh::Cutout has the formula.
// Needs raster_target, primitives and vertices.

// Texture coordinates on a primitive where the ray through a place in the picture meets it, raster
// units (Moeller and Trumbore 1997).
fn uv_at(corners: vec3<u32>, at: vec2<i32>) -> vec2<f32> {
    let a = vertices[corners.x];
    let b = vertices[corners.y];
    let c = vertices[corners.z];
    let focal = vec2<f32>(raster_target.rows[0].x, raster_target.rows[1].y);
    let center = vec2<f32>(raster_target.rows[0].z, raster_target.rows[1].z);
    let ray = vec3<f32>((vec2<f32>(at) / 1024.0 + center) / focal, -1.0);
    let edge1 = b.position - a.position;
    let edge2 = c.position - a.position;
    // From the first corner to where the ray is as deep as it: short, so that little cancels.
    let to_ray = vec3<f32>(-a.position.z * ray.xy - a.position.xy, 0.0);
    let across = cross(ray, edge2);
    let w = vec2<f32>(dot(to_ray, across), dot(ray, cross(to_ray, edge1))) / dot(edge1, across);
    return vec2<f32>(
        a.u + (b.u - a.u) * w.x + (c.u - a.u) * w.y,
        a.v + (b.v - a.v) * w.x + (c.v - a.v) * w.y,
    );
}

// Whether there is anything of a primitive at a sample.
fn leaves(slot: u32, at: vec2<i32>) -> bool {
    if !HAS_CUTOUTS {
        return true;
    }
    let flags = primitives[slot].flags;
    let strands = f32((flags >> CUTOUT_SHIFT) & 1023u);
    if strands == 0.0 {
        return true;
    }
    let uv = uv_at(primitives[slot].corners, at);
    let strand = uv.x * strands;
    let left = floor(strand);
    let dice = bitcast<u32>(i32(left)) * 0x9e3779b1u;
    let end = f32((dice >> 16u) & 255u) * (0.75 / 256.0);
    let half = 0.30 + f32(dice >> 24u) * (0.32 / 256.0);
    let frayed = f32(flags >> (CUTOUT_SHIFT + 10u)) / 1024.0;
    let whole = 1.0 - end;
    return abs(strand - left - 0.5) * whole < half * min(whole, uv.y / frayed - end);
}
