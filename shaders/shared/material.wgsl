// Materials: maps, hue and masked layers, down to albedo, roughness and normal.

struct Look {
    // Linear.
    albedo: vec3<f32>,
    // Perceptual.
    roughness: f32,
    // Unit, view space.
    normal: vec3<f32>,
}

// `clamp(min(k, 4 - k), 0, 1)` of a number modulo 6.
fn hue_share(v: f32) -> f32 {
    let k = v - floor(v * (1.0 / 6.0)) * 6.0;
    return clamp(min(k, 4.0 - k), 0.0, 1.0);
}

// Rotates the hue in HSV by sixths of a turn in 0..6; saturation and value stay. Value V and
// chroma C give back each channel as `V - C clamp(min(k, 4 - k), 0, 1)` with
// `k = (n + hue) mod 6` and n = 5, 3, 1 for red, green and blue.
fn rotate_hue(c: vec3<f32>, turn: f32) -> vec3<f32> {
    let value = max(max(c.x, c.y), c.z);
    let chroma = value - min(min(c.x, c.y), c.z);
    let inverse = 1.0 / max(chroma, 1e-12);
    let of_red = (c.y - c.z) * inverse;
    let of_green = (c.z - c.x) * inverse + 2.0;
    let of_blue = (c.x - c.y) * inverse + 4.0;
    let hue = turn + select(select(of_blue, of_green, c.y >= value), of_red, c.x >= value);
    return vec3<f32>(
        value - chroma * hue_share(hue + 5.0),
        value - chroma * hue_share(hue + 3.0),
        value - chroma * hue_share(hue + 1.0),
    );
}

// The unit direction within the surface that is nearest to a direction.
fn onto_surface(d: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return normalized(d - normal * dot(d, normal));
}

// A normal turned by a tangent-space one: x along growing u, y up the picture (against v).
fn bent(normal: vec3<f32>, by: vec3<f32>, point: SurfacePoint) -> vec3<f32> {
    let tangent = onto_surface(point.tangent, normal);
    let bitangent = onto_surface(point.bitangent, normal);
    return normalized(tangent * by.x - bitangent * by.y + normal * max(by.z, 0.05));
}

fn has_map(draw: u32, map: u32) -> bool {
    return (surfaces[draw].map_info[map] & MAP_PRESENT) != 0u;
}

fn map_at(draw: u32, map: u32, uv: vec2<f32>, footprint: f32) -> vec4<f32> {
    return look_up(surfaces[draw].map_first[map], surfaces[draw].map_info[map], uv, footprint);
}

fn look_at(draw: u32, point: SurfacePoint) -> Look {
    var look = Look(surfaces[draw].base_color, surfaces[draw].roughness, point.normal);
    let repeat = surfaces[draw].uv_repeat;
    let uv = point.uv * repeat;
    let footprint = footprint_of(point.d_dx * repeat, point.d_dy * repeat);
    if has_map(draw, ALBEDO_MAP) {
        look.albedo *= map_at(draw, ALBEDO_MAP, uv, footprint).xyz;
    }
    if surfaces[draw].hue_turn >= 0.0 {
        look.albedo = rotate_hue(look.albedo, surfaces[draw].hue_turn);
    }
    if has_map(draw, DETAIL_MAP) {
        let r = map_at(draw, DETAIL_MAP, uv, footprint).x;
        look.albedo *= max(1.0 + surfaces[draw].detail_strength * (r + r - 1.0), 0.0);
    }
    if has_map(draw, NORMAL_MAP) {
        let n = map_at(draw, NORMAL_MAP, uv, footprint).xyz * 2.0 - 1.0;
        let by = vec3<f32>(n.xy * surfaces[draw].normal_strength, n.z);
        look.normal = bent(look.normal, by, point);
    }
    if has_map(draw, MASK_MAP) {
        let mask = map_at(draw, MASK_MAP, point.uv, footprint_of(point.d_dx, point.d_dy));
        for (var k = 0u; k < 4u; k++) {
            let layer = surfaces[draw].layers[k];
            look.albedo += (layer.xyz - look.albedo) * mask[k];
            look.roughness += (layer.w - look.roughness) * mask[k];
        }
        look.roughness = clamp(look.roughness, 0.04, 1.0);
    }
    return look;
}
