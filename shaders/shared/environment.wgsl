// Light from all around, out of a picture of all directions in the pool of textures. As
// core/src/engine/cpu/shade/environment.rs; core/src/library/environment/equirect.rs says where
// directions stand.

const PI: f32 = 3.14159265358979;
// Levels of the picture: level k is what a mirror of roughness k / 5 sees.
const ENVIRONMENT_LEVELS: u32 = 6u;

// Arc tangent on 0..1.
fn arc_tangent(t: f32) -> f32 {
    let t2 = t * t;
    var sum = -0.004054058;
    sum = sum * t2 + 0.02186123;
    sum = sum * t2 - 0.055909886;
    sum = sum * t2 + 0.096420044;
    sum = sum * t2 - 0.13908533;
    sum = sum * t2 + 0.19946536;
    sum = sum * t2 - 0.33329856;
    return (sum * t2 + 0.9999993) * t;
}

// Angle of the vector (x, y), -pi..pi.
fn angle_of(y: f32, x: f32) -> f32 {
    let ax = abs(x);
    let ay = abs(y);
    var angle = arc_tangent(min(ax, ay) / max(max(ax, ay), 1.17549435e-38));
    angle = select(angle, 0.5 * PI - angle, ay > ax);
    angle = select(angle, PI - angle, x < 0.0);
    return select(angle, -angle, y < 0.0);
}

// Where a direction in view space stands in the picture, 0..1.
fn environment_uv(direction: vec3<f32>) -> vec2<f32> {
    let rows = frame.environment_from_view;
    let d = vec3<f32>(
        dot(rows[0].xyz, direction),
        dot(rows[1].xyz, direction),
        dot(rows[2].xyz, direction),
    );
    let level = sqrt(d.x * d.x + d.z * d.z);
    return vec2<f32>(0.5 + angle_of(d.x, -d.z) * (0.5 / PI), angle_of(level, d.y) * (1.0 / PI));
}

fn environment_texel(at: u32) -> vec3<f32> {
    let texel = texels[at];
    let unit = bitcast<f32>(((texel >> 27u) + 103u) << 23u);
    let channels = (vec3<u32>(texel) >> vec3<u32>(0u, 9u, 18u)) & vec3<u32>(511u);
    return vec3<f32>(channels) * unit;
}

// The mean of the four texels round a place of one level.
fn environment_bilinear(uv: vec2<f32>, level: u32) -> vec3<f32> {
    let both = frame.environment_levels[level / 2u];
    let place = select(both.xy, both.zw, (level & 1u) == 1u);
    let width = 1u << place.y;
    let last_row = (width >> 1u) - 1u;
    let x = uv.x * f32(width) - 0.5;
    let y = clamp(uv.y * f32(last_row + 1u) - 0.5, 0.0, f32(last_row));
    let left = floor(x);
    let top = floor(y);
    let columns = vec2<u32>(vec2<i32>(i32(left), i32(left) + 1)) & vec2<u32>(width - 1u);
    let row = u32(top);
    let upper = place.x + row * width;
    let lower = place.x + min(row + 1u, last_row) * width;
    let ul = environment_texel(upper + columns.x);
    let ur = environment_texel(upper + columns.y);
    let ll = environment_texel(lower + columns.x);
    let lr = environment_texel(lower + columns.y);
    let above = ul + (ur - ul) * (x - left);
    let below = ll + (lr - ll) * (x - left);
    return above + (below - above) * (y - top);
}

// Irradiance of a surface with a unit normal in view space.
fn environment_irradiance(n: vec3<f32>) -> vec3<f32> {
    let e = &frame.environment_irradiance;
    var sum = (*e)[0].rgb;
    sum += (*e)[1].rgb * n.x;
    sum += (*e)[2].rgb * n.y;
    sum += (*e)[3].rgb * n.z;
    sum += (*e)[4].rgb * (n.x * n.x);
    sum += (*e)[5].rgb * (n.y * n.y);
    sum += (*e)[6].rgb * (n.z * n.z);
    sum += (*e)[7].rgb * (n.x * n.y);
    sum += (*e)[8].rgb * (n.y * n.z);
    sum += (*e)[9].rgb * (n.z * n.x);
    // Three orders can undershoot where a sun is alone.
    return max(sum, vec3<f32>(0.0));
}

// Light from a direction in view space of any length, as a mirror of a perceptual roughness sees it.
fn environment_mirrored(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    let top = f32(ENVIRONMENT_LEVELS - 1u);
    let level = clamp(roughness * top, 0.0, top);
    let lower = u32(level);
    let upper = min(lower + 1u, ENVIRONMENT_LEVELS - 1u);
    let uv = environment_uv(direction);
    let sharper = environment_bilinear(uv, lower);
    let blurred = environment_bilinear(uv, upper);
    return (sharper + (blurred - sharper) * (level - f32(lower))) * frame.environment_unit;
}

// Exposed light where nothing stands, at a position in the picture.
fn backdrop(at: vec2<f32>) -> vec3<f32> {
    if !HAS_ENVIRONMENT {
        return frame.background;
    }
    let direction = vec3<f32>(ray_through(at).xy, -1.0);
    return environment_bilinear(environment_uv(direction), 0u) * frame.environment_unit;
}
