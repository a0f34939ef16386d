// What the surface is like where a fragment is shaded. Barycentric coordinates come from the ray
// through the point and the unclipped triangle (Moeller and Trumbore 1997), clamped to the
// triangle, so that points just off it at a silhouette stay on the surface.

struct SurfacePoint {
    // View space.
    position: vec3<f32>,
    // Unit shading normal, turned to the viewer where surfaces are double-sided.
    normal: vec3<f32>,
    uv: vec2<f32>,
    // Change over a pixel to the right and down.
    d_dx: vec2<f32>,
    d_dy: vec2<f32>,
    // Directions in which u and v grow, any length.
    tangent: vec3<f32>,
    bitangent: vec3<f32>,
}

fn normalized(v: vec3<f32>) -> vec3<f32> {
    return v * (1.0 / sqrt(max(dot(v, v), 1e-30)));
}

// Weights of the second and third corner, such that those of all three are not negative.
fn clamp_to_triangle(raw: vec2<f32>) -> vec2<f32> {
    let w = max(raw, vec2<f32>(0.0));
    let w0 = max(1.0 - w.x - w.y, 0.0);
    return w * (1.0 / (w0 + w.x + w.y));
}

fn surface_point(corners: vec3<u32>, at: vec2<f32>, flags: u32) -> SurfacePoint {
    let through = ray_through(at);
    let ray = vec3<f32>(through.xy, -1.0);
    let a = vertices[corners.x];
    let b = vertices[corners.y];
    let c = vertices[corners.z];
    let edge1 = b.position - a.position;
    let edge2 = c.position - a.position;
    // From the first corner to where the ray is as deep as it: short, so that little cancels.
    let to_ray = vec3<f32>(
        -a.position.z * ray.x - a.position.x,
        -a.position.z * ray.y - a.position.y,
        0.0,
    );
    let across = cross(ray, edge2);
    let determinant = dot(edge1, across);
    let inverse = determinant / max(determinant * determinant, 1e-36);
    let raw = vec2<f32>(dot(to_ray, across), dot(ray, cross(to_ray, edge1))) * inverse;
    let w = clamp_to_triangle(raw);

    let uv1 = b.uv - a.uv;
    let uv2 = c.uv - a.uv;
    // Numerators and determinant of the weights are linear in the ray.
    let base = cross(edge2, edge1);
    let change1 = over_pixel(through, (cross(a.position, edge2).xy - raw.x * base.xy) * inverse);
    let change2 = over_pixel(through, (cross(edge1, a.position).xy - raw.y * base.xy) * inverse);
    // Solves edge_k = u_k tangent + v_k bitangent but for the length.
    let sign = select(-1.0, 1.0, uv1.x * uv2.y - uv1.y * uv2.x >= 0.0);

    var out: SurfacePoint;
    out.position = a.position + edge1 * w.x + edge2 * w.y;
    let normal = normalized(direction(a.normal));
    let normal1 = normalized(direction(b.normal)) - normal;
    let normal2 = normalized(direction(c.normal)) - normal;
    out.normal = normalized(normal + normal1 * w.x + normal2 * w.y);
    out.uv = a.uv + uv1 * w.x + uv2 * w.y;
    out.d_dx = change1.x * uv1 + change2.x * uv2;
    out.d_dy = change1.y * uv1 + change2.y * uv2;
    out.tangent = (edge1 * uv2.y - edge2 * uv1.y) * sign;
    out.bitangent = (edge2 * uv1.x - edge1 * uv2.x) * sign;
    let back = (determinant < 0.0) != ((flags & MIRRORED) != 0u);
    if (flags & DOUBLE_SIDED) != 0u && back {
        out.normal = -out.normal;
    }
    return out;
}
