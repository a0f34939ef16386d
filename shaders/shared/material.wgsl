// Materials: maps, hue and masked layers, down to albedo, roughness and normal.

// Roughness of cloth of full gloss.
const GLOSSY: f32 = 0.25;

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

// Red, green, blue and roughness, or the like, of two pairs of halves.
fn four_halves(pairs: vec2<u32>) -> vec4<f32> {
    return vec4<f32>(unpack2x16float(pairs.x), unpack2x16float(pairs.y));
}

// The maps that there are, a bit each.
fn maps_of(info: u32) -> u32 {
    let present = info & (MAP_PRESENT * 0x01010101u);
    return ((present >> 6u) | (present >> 13u) | (present >> 20u) | (present >> 27u)) & 15u;
}

// Looks up one map after the other, so that invocations without maps do not pay for those of
// their neighbours more than once.
fn look_at(draw: u32, point: SurfacePoint) -> Look {
    let base = four_halves(surfaces[draw].base);
    var look = Look(base.xyz, base.w, point.normal);
    var detail = 1.0;
    var tilt = vec3<f32>(0.0, 0.0, 1.0);
    var mask = vec4<f32>(0.0);
    let infos = surfaces[draw].map_info;
    let own_repeat = surfaces[draw].uv_repeat;
    let finish_info = surfaces[draw].finish_info;
    let has_finish = (finish_info & MAP_PRESENT) != 0u;
    let maps = maps_of(infos) | select(0u, 1u << FINISH_MAP, has_finish);
    // Share of the hue's rotation, and gloss.
    var finish = vec2<f32>(1.0, 0.0);
    var rest = maps;
    while rest != 0u {
        let map = firstTrailingBit(rest);
        rest &= rest - 1u;
        // The mask is not repeated.
        let repeat = select(own_repeat, vec2<f32>(1.0), map == MASK_MAP);
        let footprint = footprint_of(point.d_dx * repeat, point.d_dy * repeat);
        let is_finish = map == FINISH_MAP;
        let info = select((infos >> (8u * (map & 3u))) & 255u, finish_info, is_finish);
        let of_four = surfaces[draw].map_first[map & 3u];
        let first = select(of_four, surfaces[draw].finish_first, is_finish);
        let texel = look_up(first, info, point.uv * repeat, footprint);
        if map == ALBEDO_MAP {
            look.albedo *= texel.xyz;
        } else if map == DETAIL_MAP {
            let strength = surfaces[draw].detail_strength;
            detail = max(1.0 + strength * (texel.x + texel.x - 1.0), 0.0);
        } else if map == NORMAL_MAP {
            let n = texel.xyz * 2.0 - 1.0;
            tilt = vec3<f32>(n.xy * surfaces[draw].normal_strength, n.z);
        } else if is_finish {
            finish = texel.xy;
        } else {
            mask = texel;
        }
    }
    let turn = surfaces[draw].hue_turn;
    if turn >= 0.0 {
        look.albedo += (rotate_hue(look.albedo, turn) - look.albedo) * finish.x;
    }
    look.roughness += (GLOSSY - look.roughness) * finish.y;
    look.albedo *= detail;
    if (maps & (1u << NORMAL_MAP)) != 0u {
        look.normal = bent(look.normal, tilt, point);
    }
    let layers = select(0u, 4u, (maps & (1u << MASK_MAP)) != 0u);
    for (var k = 0u; k < layers; k++) {
        let layer = four_halves(surfaces[draw].layers[k]);
        look.albedo += (layer.xyz - look.albedo) * mask[k];
        look.roughness += (layer.w - look.roughness) * mask[k];
    }
    look.roughness = clamp(look.roughness, 0.04, 1.0);
    return look;
}
