// Cutouts: which samples of a primitive lie on a strand of it; library::mesh::Cutout has the formula.
// Needs raster_target, primitives and vertices.

// Of the primitive at hand: strands to 1 of u, 0 where nothing is cut out, and its frayed v.
var<private> strands: f32;
var<private> frayed: f32;
// The ray through its first corner at z = -1, and the texture coordinates there.
var<private> corner_ray: vec2<f32>;
var<private> corner_uv: vec2<f32>;
// What u, v and their common divisor change by along the ray's x and y, and the divisor at the corner.
var<private> u_change: vec2<f32>;
var<private> v_change: vec2<f32>;
var<private> weight_change: vec2<f32>;
var<private> corner_weight: f32;

// Takes a primitive at hand. For a ray r its corners' weights are r.(b x c), r.(c x a) and r.(a x b), so
// that texture coordinates are ratios of linear functions; measured from the first corner, where two of
// them are 0, little cancels.
fn take_cutout(slot: u32) {
    strands = 0.0;
    if !HAS_CUTOUTS {
        return;
    }
    let flags = primitives[slot].flags;
    strands = f32((flags >> CUTOUT_SHIFT) & 1023u);
    if strands == 0.0 {
        return;
    }
    frayed = f32(flags >> (CUTOUT_SHIFT + 10u)) / 1024.0;
    let corners = primitives[slot].corners;
    let a = vertices[corners.x];
    let b = vertices[corners.y];
    let c = vertices[corners.z];
    let to_b = b.position - a.position;
    let to_c = c.position - a.position;
    let of_b = cross(to_c, a.position).xy;
    let of_c = cross(a.position, to_b).xy;
    let normal = cross(to_b, to_c);
    corner_ray = a.position.xy / -a.position.z;
    corner_uv = a.uv;
    u_change = (b.uv.x - a.uv.x) * of_b + (c.uv.x - a.uv.x) * of_c;
    v_change = (b.uv.y - a.uv.y) * of_b + (c.uv.y - a.uv.y) * of_c;
    weight_change = normal.xy;
    corner_weight = dot(normal, vec3<f32>(corner_ray, -1.0));
}

// Whether there is anything of the primitive at hand at a place in the picture, raster units.
fn leaves(at: vec2<i32>) -> bool {
    if !HAS_CUTOUTS {
        return true;
    }
    if strands == 0.0 {
        return true;
    }
    let focal = vec2<f32>(raster_target.rows[0].x, raster_target.rows[1].y);
    let center = vec2<f32>(raster_target.rows[0].z, raster_target.rows[1].z);
    let way = (vec2<f32>(at) / 1024.0 + center) / focal - corner_ray;
    let weight = corner_weight + dot(way, weight_change);
    let uv = corner_uv + vec2<f32>(dot(way, u_change), dot(way, v_change)) / weight;
    let strand = uv.x * strands;
    let left = floor(strand);
    let dice = bitcast<u32>(i32(left)) * 0x9e3779b1u;
    let end = f32((dice >> 16u) & 255u) * (0.75 / 256.0);
    let half = 0.30 + f32(dice >> 24u) * (0.32 / 256.0);
    let whole = 1.0 - end;
    return abs(strand - left - 0.5) * whole < half * min(whole, uv.y / frayed - end);
}
