// How much of the sun's light reaches a point. Look-ups filter four texels bilinearly
// (percentage-closer filtering, Reeves et al. 1987) and are moved off the surface along its
// normal (Holbert, "Saying goodbye to shadow acne", GDC 2011).

// 1 where nothing in the map is nearer to the sun.
fn lit_at(x: u32, y: u32, depth: f32) -> f32 {
    return select(1.0, 0.0, shadow_map[HEADER + y * sun_view.size.x + x] > depth);
}

// The share of the sun's light, 0..1, that reaches a point with this normal. The offset covers
// the change of depth over the filter's width on a plane of any slope.
fn sunlit(p: vec3<f32>, n: vec3<f32>, n_dot_l: f32, extra_m: f32) -> f32 {
    if !HAS_SHADOW || sun_view.present == 0u {
        return 1.0;
    }
    let texel_m = sun_view.texel_m;
    let sine = sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0));
    let q = vec4<f32>(p + n * (sine * (1.5 * texel_m) + (0.25 * texel_m + extra_m)), 1.0);
    let place = vec2<f32>(dot(sun_view.rows[0], q), dot(sun_view.rows[1], q)) - 0.5;
    let depth = dot(sun_view.rows[2], q) + 0.5 * texel_m * sun_view.depth_per_m;
    let last = vec2<f32>(sun_view.size) - 1.0;
    if !(all(place >= vec2<f32>(0.0)) && all(place < last)) {
        return 1.0;
    }
    let corner = floor(place);
    let w = place - corner;
    let x = u32(corner.x);
    let y = u32(corner.y);
    let upper = mix(lit_at(x, y, depth), lit_at(x + 1u, y, depth), w.x);
    let lower = mix(lit_at(x, y + 1u, depth), lit_at(x + 1u, y + 1u, depth), w.x);
    return mix(upper, lower, w.y);
}
