// Shade and display: the picture of a band.
//
// The samples of a pixel that show the same smooth stretch of one draw share a fragment, all
// others get one for each triangle; its weight is its share of the samples. Developing comes
// before the sum over a pixel's fragments, so that a bright edge stays smooth; the sum is made in
// linear display light. Where light is kept, pixels are developed later (finish.wgsl), and the sum is
// made of compressed light. One invocation a pixel.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read> surfaces: array<Surface>;
@group(0) @binding(4) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(5) var<storage, read> samples: array<vec2<u32>>;
@group(0) @binding(6) var<storage, read> texels: array<u32>;
@group(0) @binding(7) var<uniform> lamps: array<Light, MAX_LAMPS>;
@group(0) @binding(8) var<uniform> sun_view: SunView;
@group(0) @binding(9) var<storage, read> shadow_map: array<f32>;
@group(0) @binding(10) var<storage, read_write> picture: array<u32>;
@group(0) @binding(11) var<uniform> blockers: array<Blocker, MAX_BLOCKERS>;

// Cosine of the angle between faces, in 1/127 squared, below which an edge counts as a crease
// that must not be shaded as one: 37 degrees.
const CREASE: i32 = 12903;
// Steps in depth larger than this many pixel widths separate surfaces.
const STEP_PX: f32 = 8.0;

// Direction of a triangle's plane in 1/127, away from the camera.
fn facing(slot: u32) -> vec3<i32> {
    let corners = primitives[slot].corners;
    let a = vertices[corners.x].position;
    let n = cross(vertices[corners.y].position - a, vertices[corners.z].position - a);
    let away = select(-n, n, dot(n, a) > 0.0);
    return vec3<i32>(away * (127.0 / sqrt(max(dot(n, n), 1e-30))));
}

// Whether two samples of one smooth draw lie on one smooth stretch of surface.
fn connected(a: vec2<u32>, b: vec2<u32>) -> bool {
    let za = bitcast<f32>(a.y);
    let zb = bitcast<f32>(b.y);
    if abs(za - zb) * max(frame.focal.x, frame.focal.y) > STEP_PX * min(za, zb) {
        return false;
    }
    let fa = facing(a.x);
    let fb = facing(b.x);
    return fa.x * fb.x + fa.y * fb.y + fa.z * fb.z >= CREASE;
}

// What the sum over a pixel's fragments is made of: display light, or compressed light where that is
// kept.
fn summand(light: vec3<f32>, at: vec2<f32>, pixel: vec2<u32>) -> vec3<f32> {
    if KEEPS_LIGHT {
        return compressed(light);
    }
    return developed(light, at, pixel);
}

// How far out of focus the nearest sample of a pixel is, pixels.
fn blur_of(first: u32) -> f32 {
    var nearest = 0.0;
    for (var i = 0u; i < SAMPLES; i++) {
        let own = samples[first + i];
        nearest = max(nearest, select(bitcast<f32>(own.y), 0.0, own.x == NOTHING));
    }
    return blur_radius_px(nearest);
}

// What a fragment adds to its pixel.
fn fragment(slot: u32, at: vec2<f32>, pixel: vec2<u32>) -> vec3<f32> {
    let draw = primitives[slot].draw;
    let point = surface_point(primitives[slot].corners, at, surfaces[draw].flags);
    let look = look_at(draw, point);
    let metallic_wrap = unpack2x16float(surfaces[draw].metallic_wrap);
    var own = vec2<u32>(0u);
    if HAS_BLOCKERS {
        own = surfaces[draw].own_blockers;
    }
    let light = reflected(point, look, metallic_wrap.x, metallic_wrap.y, own);
    return summand(light, at, pixel);
}

// The sum over a pixel whose samples start at `first`.
fn pixel_color(first: u32, corner: vec2<f32>) -> vec3<f32> {
    let pixel = vec2<u32>(corner);
    if SAMPLES == 1u {
        let own = samples[first];
        if own.x == NOTHING {
            return summand(backdrop(corner + 0.5), corner + 0.5, pixel);
        }
        return fragment(own.x, corner + vec2<f32>(POSITIONS[0]) * (1.0 / 16.0), pixel);
    }
    var color = vec3<f32>(0.0);
    var nothing = 0u;
    var rest = (1u << SAMPLES) - 1u;
    for (var i = 0u; i < SAMPLES; i++) {
        if ((rest >> i) & 1u) == 0u {
            continue;
        }
        let own = samples[first + i];
        if own.x == NOTHING {
            nothing += 1u;
            continue;
        }
        let draw = primitives[own.x].draw;
        let is_smooth = (surfaces[draw].flags & SMOOTH) != 0u;
        var count = 0u;
        var sum = vec2<i32>(0);
        for (var j = i; j < SAMPLES; j++) {
            let other = samples[first + j];
            if ((rest >> j) & 1u) == 0u || other.x == NOTHING {
                continue;
            }
            var together = other.x == own.x;
            if !together && is_smooth && primitives[other.x].draw == draw {
                together = connected(own, other);
            }
            if together {
                rest &= ~(1u << j);
                count += 1u;
                sum += POSITIONS[j];
            }
        }
        let at = corner + vec2<f32>(sum) * (1.0 / f32(count)) * (1.0 / 16.0);
        color += fragment(own.x, at, pixel) * (f32(count) / f32(SAMPLES));
    }
    if nothing > 0u {
        let light = summand(backdrop(corner + 0.5), corner + 0.5, pixel);
        color += light * (f32(nothing) / f32(SAMPLES));
    }
    return color;
}

@compute @workgroup_size(8, 8)
fn main(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let inside = id.x < raster_target.width && id.y < raster_target.band_height;
    let pixel = id.y * raster_target.width + id.x;
    let corner = vec2<f32>(f32(id.x), f32(id.y + raster_target.first_y));
    if HAS_BLOCKERS {
        var ray = vec2<f32>(0.0);
        if inside {
            ray = ray_through(corner + 0.5).xy;
        }
        find_blockers(index, inside, pixel * SAMPLES, ray);
    }
    if !inside {
        return;
    }
    let color = pixel_color(pixel * SAMPLES, corner);
    let place = vec2<u32>(id.x, id.y + raster_target.first_y);
    if KEEPS_LIGHT {
        // Of the whole picture, as what comes next looks beyond bands.
        let at = (place.y * raster_target.width + place.x) * 2u;
        let words = packed_light(vec4<f32>(turned_back(color), blur_of(pixel * SAMPLES)));
        picture[at] = words.x;
        picture[at + 1u] = words.y;
        return;
    }
    picture[pixel] = encode(color, place);
}
