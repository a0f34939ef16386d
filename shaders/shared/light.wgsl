// Light on surfaces: Lambert plus GGX (Walter et al. 2007) with the Smith height-correlated
// visibility in Hammon's approximation (GDC 2017) and Schlick's Fresnel; surrounding light with
// Karis' fit of the split sum ("Physically based shading on mobile", 2014). The formulas stand in
// core/src/engine/cpu/shade/light.rs.

// How much further off the surface wrapped light looks up shadows, metres per unit of wrap.
const WRAP_OFFSET_M: f32 = 0.04;
// f0 of what is not metal.
const DIELECTRIC: f32 = 0.04;

// What the reflectance needs of a fragment, whatever the light.
struct Reflector {
    position: vec3<f32>,
    normal: vec3<f32>,
    to_viewer: vec3<f32>,
    n_dot_v: f32,
    f0: vec3<f32>,
    // Lambert term over irradiance.
    diffuse: vec3<f32>,
    // `a^2 - 1` and `a^2 / (2 pi)`.
    lobe: f32,
    peak: f32,
    // Factor on `n.l` and offset that give `mix(2 n.l n.v, n.l + n.v, a)`.
    visibility: vec2<f32>,
    // How far light goes round the terminator, and what keeps its energy.
    wrap: f32,
    wrap_scale: f32,
}

fn reflector(position: vec3<f32>, look: Look, metallic: f32, wrap: f32) -> Reflector {
    let to_viewer = normalized(-position);
    let n_dot_v = clamp(dot(look.normal, to_viewer), 1e-3, 1.0);
    let a = look.roughness * look.roughness;
    let a2 = a * a;
    let both = n_dot_v + n_dot_v;
    return Reflector(
        position,
        look.normal,
        to_viewer,
        n_dot_v,
        vec3<f32>(DIELECTRIC) + (look.albedo - DIELECTRIC) * metallic,
        look.albedo * ((1.0 - metallic) / PI),
        a2 - 1.0,
        a2 * (0.5 / PI),
        vec2<f32>(both + (1.0 - both) * a, n_dot_v * a),
        wrap,
        1.0 / ((1.0 + wrap) * (1.0 + wrap)),
    );
}

// Light sent to the viewer, given the cosines between light, normal and viewer, and the
// illuminance of a surface that faces the light.
fn reflect_light(r: Reflector, cosine: f32, l_dot_v: f32, light: vec3<f32>) -> vec3<f32> {
    let n_dot_l = max(cosine, 0.0);
    // |l + v|^2 = 2 + 2 l.v; n.h and v.h follow from it.
    let halfway2 = max(2.0 + l_dot_v + l_dot_v, 1e-4);
    let n_dot_sum = cosine + r.n_dot_v;
    // A normal that leans away from the viewer must not push n.h over 1, to the lobe's pole.
    let lobe = min(n_dot_sum * n_dot_sum, halfway2) * r.lobe + halfway2;
    let visibility = n_dot_l * r.visibility.x + r.visibility.y;
    let mirror =
        r.peak * halfway2 * halfway2 / max(lobe * lobe * visibility, 1e-30) * n_dot_l;
    let grazing = max(1.0 - sqrt(halfway2) * 0.5, 0.0);
    let grazing2 = grazing * grazing;
    let fresnel = grazing2 * grazing2 * grazing;
    let mirrored = (r.f0 + (1.0 - r.f0) * fresnel) * mirror;
    var lambert = n_dot_l;
    if r.wrap > 0.0 {
        lambert = max(cosine + r.wrap, 0.0) * r.wrap_scale;
    }
    return (r.diffuse * lambert + mirrored) * light;
}

// Irradiance of surfaces that face so far upwards, -1..1.
fn hemisphere(upwards: f32) -> vec3<f32> {
    let share = clamp(upwards * 0.5 + 0.5, 0.0, 1.0);
    return frame.ground + (frame.sky - frame.ground) * share;
}

// Factor on f0 and offset of the surrounding's mirror term.
fn split_sum(roughness: f32, n_dot_v: f32) -> vec2<f32> {
    let x = 1.0 - roughness;
    let y = 0.0425 - roughness * 0.0275;
    let grazing = 1.0 - n_dot_v;
    let cubed = grazing * grazing * grazing;
    let a = min(x * x, cubed * cubed) * x + y;
    return vec2<f32>(1.04 - roughness * 0.572 - 1.04 * a, 1.04 * a + (roughness * 0.022 - 0.04));
}

// Light from all around; core/src/engine/cpu/shade/light.rs has the formulas.
fn surrounding(r: Reflector, roughness: f32) -> vec3<f32> {
    let both_ways = r.n_dot_v + r.n_dot_v;
    var irradiance: vec3<f32>;
    var mirrored: vec3<f32>;
    if HAS_ENVIRONMENT {
        irradiance = environment_irradiance(r.normal);
        mirrored = environment_mirrored(r.normal * both_ways - r.to_viewer, roughness);
    } else {
        let upwards = dot(r.normal, frame.up);
        irradiance = hemisphere(upwards);
        mirrored = hemisphere(both_ways * upwards - dot(r.to_viewer, frame.up)) * (1.0 / PI);
    }
    let s = split_sum(roughness, r.n_dot_v);
    let single = r.f0 * s.x + s.y;
    let lost = max(1.0 - (s.x + s.y), 0.0);
    let mean = r.f0 + (1.0 - r.f0) * (1.0 / 21.0);
    let again = single * mean * lost / (1.0 - mean * lost);
    let matt = r.diffuse * (1.0 - single - again) + again * (1.0 / PI);
    return mirrored * single + irradiance * matt;
}

// Light of a lamp; nothing beyond its range or behind the surface.
fn lamp(r: Reflector, light: Light) -> vec3<f32> {
    let to_light = light.position - r.position;
    let distance2 = max(dot(to_light, to_light), 1e-12);
    let in_range = distance2 * light.per_range_m2;
    if in_range >= 1.0 {
        return vec3<f32>(0.0);
    }
    let inverse = 1.0 / sqrt(distance2);
    let cosine = dot(r.normal, to_light) * inverse;
    if cosine <= -r.wrap {
        return vec3<f32>(0.0);
    }
    let share = min(inverse, light.per_radius_m) * (1.0 - in_range * in_range);
    let l_dot_v = dot(to_light, r.to_viewer) * inverse;
    return reflect_light(r, cosine, l_dot_v, light.color_cd * (share * share));
}

// Light that a fragment sends to the camera, times the exposure.
fn reflected(
    point: SurfacePoint,
    look: Look,
    metallic: f32,
    wrap: f32,
    own_blockers: vec2<u32>,
) -> vec3<f32> {
    let r = reflector(point.position, look, metallic, wrap);
    var sum = surrounding(r, look.roughness);
    if HAS_BLOCKERS {
        sum *= unblocked(r.position, r.normal, own_blockers);
    }
    if HAS_SUN {
        let cosine = dot(r.normal, frame.to_sun);
        if cosine > -wrap {
            let shadow_cosine = dot(point.normal, frame.to_sun);
            let lit = sunlit(point.position, point.normal, shadow_cosine, wrap * WRAP_OFFSET_M);
            if lit > 0.0 {
                let l_dot_v = dot(frame.to_sun, r.to_viewer);
                sum += reflect_light(r, cosine, l_dot_v, frame.sun_color * lit);
            }
        }
    }
    // Where it is known which lamp comes next, all invocations share one load.
    for (var i = 0u; i < KNOWN_LAMPS; i++) {
        if i < frame.light_count {
            sum += lamp(r, lamps[i]);
        }
    }
    for (var i = KNOWN_LAMPS; i < frame.light_count; i++) {
        sum += lamp(r, lamps[i]);
    }
    return sum;
}
