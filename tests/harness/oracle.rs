//! The brute-force reference for engines: rays against all triangles, in `f64`.
//!
//! Nothing is shared with an engine but the draw list's types. There is no projection, clipping or
//! culling: a ray through a sample either hits a triangle or not. What rounding may decide either
//! way is reported as doubt: an edge within [`EDGE_PX`] of the sample, or two surfaces at nearly
//! the same depth.

use figurant_core::base::lens::Lens;
use figurant_core::draw::DrawList;
use figurant_core::draw::abi::{Blocker, DrawObject, Material, Surroundings, View};
use figurant_core::library::environment::map::LEVELS;
use figurant_core::library::mesh::Cutout;
use glam::{DMat3, DVec2, DVec3};

/// Edges closer to a sample than this leave it in doubt, pixels.
pub const EDGE_PX: f64 = 1e-3;
/// The same behind a lens, where samples are rounded as vertices are.
pub const LENS_EDGE_PX: f64 = 2e-3;
/// Surfaces closer to each other than this, relative to their depth, leave a sample in doubt.
const SAME_DEPTH: f64 = 2e-5;

/// One triangle in view space.
#[derive(Clone, Debug)]
struct Triangle {
    object: usize,
    draw: usize,
    p: [DVec3; 3],
    n: [DVec3; 3],
    uv: [DVec2; 3],
    double_sided: bool,
    cutout: Option<Cutout>,
}

/// Where a ray first meets a surface.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Index in the draw list.
    pub object: usize,
    /// Index in the draw list.
    pub draw: usize,
    /// Index of the triangle in [`Oracle`]'s order.
    pub triangle: usize,
    /// `near / distance`.
    pub depth: f64,
    /// How much `depth` changes per pixel at most.
    pub slope_per_px: f64,
    /// View space, metres.
    pub position: DVec3,
    /// Unit shading normal, towards the viewer's side where double-sided.
    pub normal: DVec3,
    /// Weights of the corners.
    pub barycentric: [f64; 3],
    /// Texture coordinates.
    pub uv: DVec2,
}

/// What a sample shows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    /// The nearest surface.
    pub hit: Option<Hit>,
    /// Whether rounding may decide otherwise.
    pub doubt: bool,
}

/// A draw list as triangles in view space.
pub struct Oracle {
    view: View,
    lens: Option<Lens>,
    edge_px: f64,
    triangles: Vec<Triangle>,
}

fn point(v: [f32; 3]) -> DVec3 {
    DVec3::from_array(v.map(f64::from))
}

/// Linear part and translation of three rows of four.
fn transform(rows: &[[f32; 4]; 3]) -> (DMat3, DVec3) {
    let r = rows.map(|r| r.map(f64::from));
    let linear = DMat3::from_cols_array(&[
        r[0][0], r[1][0], r[2][0], r[0][1], r[1][1], r[2][1], r[0][2], r[1][2], r[2][2],
    ]);
    (linear, DVec3::new(r[0][3], r[1][3], r[2][3]))
}

/// Position and unit normal of a vertex in view space.
#[must_use]
pub fn place(list: &DrawList, object: &DrawObject, vertex: usize) -> (DVec3, DVec3) {
    let mesh = &object.mesh;
    let (p, n) = (point(mesh.positions[vertex]), point(mesh.normals[vertex].unit()));
    if mesh.skin.is_empty() {
        let (linear, translation) = transform(&object.view_from_model);
        return (linear * p + translation, (linear.inverse().transpose() * n).normalize());
    }
    let skin = mesh.skin[vertex];
    let (mut linear, mut translation) = (DMat3::ZERO, DVec3::ZERO);
    for (joint, weight) in skin.joints.iter().zip(skin.weights) {
        let (l, t) = transform(&list.palette[object.palette.start as usize + usize::from(*joint)]);
        linear += l * (f64::from(weight) / 255.0);
        translation += t * (f64::from(weight) / 255.0);
    }
    (linear * p + translation, (linear * n).normalize())
}

impl Oracle {
    /// Places all triangles that the camera may see.
    pub fn new(list: &DrawList) -> Self {
        let mut triangles = Vec::new();
        for (draw_index, draw) in list.draws.iter().enumerate() {
            let object = &list.objects[draw.object as usize];
            if !object.in_view {
                continue;
            }
            for t in draw.triangles.clone() {
                let corners = object.mesh.triangles[t as usize].get().map(|v| v as usize);
                let placed = corners.map(|v| place(list, object, v));
                let mirrored = object.mesh.skin.is_empty()
                    && transform(&object.view_from_model).0.determinant() < 0.0;
                // A mirror turns triangles inside out; their front stays the front.
                let order = if mirrored { [0, 2, 1] } else { [0, 1, 2] };
                triangles.push(Triangle {
                    object: draw.object as usize,
                    draw: draw_index,
                    p: order.map(|k| placed[k].0),
                    n: order.map(|k| placed[k].1),
                    uv: order
                        .map(|k| DVec2::from_array(object.mesh.uvs[corners[k]].map(f64::from))),
                    double_sided: draw.double_sided,
                    cutout: draw.cutout,
                });
            }
        }
        let lens = list.lens.as_ref().map(|grid| *grid.lens());
        let edge_px = if lens.is_some() { LENS_EDGE_PX } else { EDGE_PX };
        Self { view: list.view, lens, edge_px, triangles }
    }

    /// The ray through a point of the picture, with z = -1.
    fn ray(&self, x: f64, y: f64) -> DVec3 {
        let v = &self.view;
        let right = (x - f64::from(v.cx)) / f64::from(v.fx);
        let down = (y - f64::from(v.cy)) / f64::from(v.fy);
        match self.lens {
            None => DVec3::new(right, -down, -1.0),
            Some(lens) => {
                let p = undistorted(lens, DVec2::new(right, down));
                DVec3::new(p.x, -p.y, -1.0)
            }
        }
    }

    /// How far inside each edge of a triangle a point lies, pixels; the smallest of the three.
    fn margin_px(&self, t: &Triangle, ray: DVec3, front: f64) -> f64 {
        let mut least = f64::INFINITY;
        for k in 0..3 {
            // The plane through the eye and the edge; its trace in the picture is the edge.
            let plane = t.p[k].cross(t.p[(k + 1) % 3]) * -front;
            let per_px =
                DVec2::new(plane.x / f64::from(self.view.fx), plane.y / f64::from(self.view.fy))
                    .length();
            least = least.min(plane.dot(ray) / per_px.max(1e-300));
        }
        least
    }

    /// What a point of the picture shows.
    pub fn sample(&self, x: f64, y: f64) -> Sample {
        let ray = self.ray(x, y);
        let near = f64::from(self.view.near_m);
        let (mut best, mut second): (Option<(usize, f64)>, f64) = (None, 0.0);
        let mut doubtful = 0.0f64;
        for (index, t) in self.triangles.iter().enumerate() {
            let normal = (t.p[1] - t.p[0]).cross(t.p[2] - t.p[0]);
            let (facing, offset) = (normal.dot(ray), normal.dot(t.p[0]));
            if facing == 0.0 || (offset >= 0.0 && !t.double_sided) {
                continue;
            }
            let distance = offset / facing;
            if distance < near * (1.0 - 1e-6) {
                continue;
            }
            let depth = near / distance;
            let margin = self.margin_px(t, ray, if offset < 0.0 { 1.0 } else { -1.0 });
            // The near plane cuts the triangle along an edge of its own.
            let at_near_plane =
                (depth - 1.0).abs() < 1e-6 + self.edge_px * self.slope_per_px(normal, offset);
            let there = self.there(t, ray);
            if there == Some(false) {
                continue;
            }
            if margin > self.edge_px && !at_near_plane && there.is_some() {
                if best.is_none_or(|(_, d)| depth > d) {
                    second = best.map_or(second, |(_, d)| d.max(second));
                    best = Some((index, depth));
                } else {
                    second = second.max(depth);
                }
            } else if margin > -self.edge_px {
                doubtful = doubtful.max(depth);
            }
        }
        let nearest = best.map_or(0.0, |(_, d)| d) * (1.0 - SAME_DEPTH);
        let hit = best.map(|(index, depth)| self.hit(index, ray, depth));
        let steep = hit.map_or(0.0, |h| h.slope_per_px) * self.edge_px;
        let doubt = doubtful > nearest - steep || (hit.is_some() && second > nearest - steep);
        Sample { hit, doubt: doubt && (doubtful > 0.0 || second > 0.0) }
    }

    /// Whether a cutout leaves anything where a ray meets the triangle's plane; nothing where places
    /// an edge's width away differ.
    fn there(&self, t: &Triangle, ray: DVec3) -> Option<bool> {
        let Some(cutout) = t.cutout else { return Some(true) };
        let step = self.edge_px / f64::from(self.view.fx.min(self.view.fy));
        let around = [DVec3::ZERO, DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y];
        let all = around.map(|way| on_strand(cutout, uv_along(t, ray + way * step)));
        all.iter().all(|here| *here == all[0]).then_some(all[0])
    }

    /// The largest change of depth over a pixel on the plane `normal . p = offset`.
    fn slope_per_px(&self, normal: DVec3, offset: f64) -> f64 {
        let v = &self.view;
        let slope = DVec2::new(normal.x / f64::from(v.fx), normal.y / f64::from(v.fy));
        f64::from(v.near_m) * slope.length() / offset.abs()
    }

    fn hit(&self, index: usize, ray: DVec3, depth: f64) -> Hit {
        let t = &self.triangles[index];
        let near = f64::from(self.view.near_m);
        let position = ray * (near / depth);
        let normal = (t.p[1] - t.p[0]).cross(t.p[2] - t.p[0]);
        let whole = normal.length_squared();
        let part =
            |a: usize, b: usize| (t.p[a] - position).cross(t.p[b] - position).dot(normal) / whole;
        let w = [part(1, 2), part(2, 0), part(0, 1)];
        let offset = normal.dot(t.p[0]);
        let turned = if offset > 0.0 { -1.0 } else { 1.0 };
        Hit {
            object: t.object,
            draw: t.draw,
            triangle: index,
            depth,
            slope_per_px: self.slope_per_px(normal, offset),
            position,
            normal: (t.n[0] * w[0] + t.n[1] * w[1] + t.n[2] * w[2]).normalize() * turned,
            barycentric: w,
            uv: t.uv[0] * w[0] + t.uv[1] * w[1] + t.uv[2] * w[2],
        }
    }
}

/// Texture coordinates where a ray meets a triangle's plane.
fn uv_along(t: &Triangle, ray: DVec3) -> DVec2 {
    let normal = (t.p[1] - t.p[0]).cross(t.p[2] - t.p[0]);
    let position = ray * (normal.dot(t.p[0]) / normal.dot(ray));
    let part = |a: usize, b: usize| {
        (t.p[a] - position).cross(t.p[b] - position).dot(normal) / normal.length_squared()
    };
    t.uv[0] * part(1, 2) + t.uv[1] * part(2, 0) + t.uv[2] * part(0, 1)
}

/// The formula that a cutout states.
fn on_strand(cutout: Cutout, uv: DVec2) -> bool {
    let along = f64::from(cutout.strands_per_u) * uv.x;
    let strand = along.floor();
    let hash = (strand as i64 as u32).wrapping_mul(0x9e37_79b1).to_be_bytes();
    let [width, end] = [hash[0], hash[1]].map(|byte| f64::from(byte) / 256.0);
    let (half, end) = (0.30 + 0.32 * width, 0.75 * end);
    let way = uv.y * 1024.0 / f64::from(cutout.frayed_1024ths);
    (along - strand - 0.5).abs() < half * ((way - end) / (1.0 - end)).min(1.0)
}

/// The way back through a lens, by other means than the engines': OpenCV's fixed-point iteration for
/// Brown's model, bisection for the fisheye's angle.
fn undistorted(lens: Lens, distorted: DVec2) -> DVec2 {
    match lens {
        Lens::Brown { k1, k2, p1, p2, k3 } => {
            let mut p = distorted;
            for _ in 0..400 {
                let r2 = p.length_squared();
                let radial = 1.0 + k1 * r2 + k2 * r2.powi(2) + k3 * r2.powi(3);
                let tangential = DVec2::new(
                    2.0 * p1 * p.x * p.y + p2 * (r2 + 2.0 * p.x * p.x),
                    p1 * (r2 + 2.0 * p.y * p.y) + 2.0 * p2 * p.x * p.y,
                );
                let next = (distorted - tangential) / radial;
                if next.distance(p) < 1e-13 {
                    return next;
                }
                // Half of the way, which swings about the end less.
                p = (p + next) * 0.5;
            }
            panic!("no way back from {distorted} through {lens:?}");
        }
        Lens::Fisheye { k1, k2, k3, k4 } => {
            let radius = distorted.length();
            if radius == 0.0 {
                return distorted;
            }
            let (mut low, mut high) = (0.0, 1.5);
            for _ in 0..80 {
                let angle: f64 = 0.5 * (low + high);
                let a2 = angle * angle;
                let shown = angle * (1.0 + a2 * (k1 + a2 * (k2 + a2 * (k3 + a2 * k4))));
                if shown < radius { low = angle } else { high = angle }
            }
            distorted * (f64::tan(low) / radius)
        }
    }
}

/// Where the samples of a pixel lie, in 1/16 pixel.
pub fn sample_positions(samples: u32) -> Vec<[i32; 2]> {
    match samples {
        1 => vec![[8, 8]],
        4 => vec![[6, 2], [14, 6], [2, 10], [10, 14]],
        16 => {
            let x = [9, 7, 5, 12, 3, 10, 13, 11, 6, 8, 4, 2, 0, 15, 14, 1];
            let y = [9, 5, 10, 7, 6, 13, 11, 3, 14, 1, 2, 12, 8, 4, 15, 0];
            x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
        }
        _ => panic!("1, 4 or 16 samples"),
    }
}

/// Light that a surface sends to the camera, nits, by the reflectance model that the draw list's
/// engines state: Lambert and GGX under sun, point lights and surroundings, without shadows.
pub fn radiance(list: &DrawList, material: &Material, albedo: DVec3, hit: &Hit) -> DVec3 {
    let n = hit.normal;
    let v = -hit.position.normalize();
    let lights = &list.lights;
    let metallic = f64::from(material.metallic);
    let roughness = f64::from(material.roughness);
    let f0 = DVec3::splat(0.04).lerp(albedo, metallic);
    let up = DVec3::from_array(list.view.view_from_world.map(|row| f64::from(row[1])));
    let (sky, ground) = (point(lights.sky_lux), point(lights.ground_lux));
    let irradiance = |d: DVec3| match &lights.surroundings {
        Some(surroundings) => surrounding_irradiance(surroundings, d),
        None => ground.lerp(sky, 0.5 + 0.5 * d.dot(up)),
    };

    let diffuse = albedo * (1.0 - metallic) / std::f64::consts::PI;
    let n_dot_v = n.dot(v).clamp(1e-3, 1.0);
    let mirrored = n * 2.0 * n_dot_v - v;
    let r = [
        1.0 - roughness,
        0.0425 - 0.0275 * roughness,
        1.04 - 0.572 * roughness,
        0.022 * roughness - 0.04,
    ];
    let a = f64::min(r[0] * r[0], (1.0 - n_dot_v).powi(6)) * r[0] + r[1];
    let [scale, bias] = [r[2] - 1.04 * a, r[3] + 1.04 * a];
    let mirror = f0 * scale + DVec3::splat(bias);
    // What leaves after several reflections; white in white must vanish.
    let lost = (1.0 - scale - bias).max(0.0);
    let mean = f0 + (DVec3::ONE - f0) / 21.0;
    let again = mirror * mean * lost / (DVec3::ONE - mean * lost);
    let seen = match &lights.surroundings {
        Some(surroundings) => surrounding_light(surroundings, mirrored, roughness),
        None => irradiance(mirrored) / std::f64::consts::PI,
    };
    let matt = diffuse * (DVec3::ONE - mirror - again) + again / std::f64::consts::PI;
    let mut sum = (mirror * seen + matt * irradiance(n)) * unblocked(list, hit);

    let mut add = |to_light: DVec3, illuminance: DVec3| {
        let cosine = n.dot(to_light);
        let wrap = f64::from(material.wrap);
        let lambert = (cosine + wrap).max(0.0) / (1.0 + wrap).powi(2);
        sum += diffuse * illuminance * lambert;
        if cosine > 0.0 {
            sum += specular(n, v, to_light, n_dot_v, f0, roughness) * illuminance * cosine;
        }
    };
    if let Some(sun) = &lights.sun {
        add(point(sun.direction_to_sun).normalize(), point(sun.color_lux));
    }
    for light in &lights.points {
        let to_light = point(light.position) - hit.position;
        let distance = to_light.length();
        let window = (1.0 - (distance / f64::from(light.range_m)).powi(4)).clamp(0.0, 1.0);
        let near = distance.max(f64::from(light.radius_m));
        add(to_light / distance, point(light.color_cd) / (near * near) * window * window);
    }
    sum
}

/// Share of surrounding light that the draw list's spheres let through.
fn unblocked(list: &DrawList, hit: &Hit) -> f64 {
    let own = &list.objects[hit.object].blockers;
    let passes = |(i, blocker): (u32, &Blocker)| {
        let way = point(blocker.center) - hit.position;
        let radii = way.length() / f64::from(blocker.radius_m);
        let bias = if own.contains(&i) { 0.25 } else { 0.0 };
        let faces = (hit.normal.dot(way.normalize()) - bias).max(0.0) / (1.0 - bias);
        let ends = (1.0 - (radii / 4.0).powi(4)).max(0.0).powi(2);
        1.0 - faces * (1.0 / (radii * radii)).min(1.0) * ends
    };
    (0..).zip(&list.blockers).map(passes).product()
}

/// Irradiance that a picture of all directions gives a surface, view space.
fn surrounding_irradiance(surroundings: &Surroundings, normal: DVec3) -> DVec3 {
    let n = map_direction(surroundings, normal);
    DVec3::from_array(surroundings.map.irradiance.of(n)) * f64::from(surroundings.nits_per_unit)
}

/// What a mirror of a roughness sees of it in a direction, view space.
fn surrounding_light(surroundings: &Surroundings, direction: DVec3, roughness: f64) -> DVec3 {
    let d = map_direction(surroundings, direction).as_vec3();
    let level = roughness * (LEVELS - 1) as f64;
    let lower = level as usize;
    let light = |k: usize| surroundings.map.light(d, k.min(LEVELS - 1)).as_dvec3();
    light(lower).lerp(light(lower + 1), level - lower as f64)
        * f64::from(surroundings.nits_per_unit)
}

fn map_direction(surroundings: &Surroundings, direction: DVec3) -> DVec3 {
    let row = |r: usize| DVec3::from_array(surroundings.map_from_view[r].map(f64::from));
    DVec3::new(row(0).dot(direction), row(1).dot(direction), row(2).dot(direction))
}

/// GGX, Smith's visibility after Hammon, Schlick's Fresnel.
fn specular(n: DVec3, v: DVec3, l: DVec3, n_dot_v: f64, f0: DVec3, roughness: f64) -> DVec3 {
    let h = (l + v).normalize();
    let a = roughness * roughness;
    let n_dot_l = n.dot(l);
    // The half vector's cosine with the clamped cosine to the viewer.
    let n_dot_h = ((n_dot_l + n_dot_v) / (l + v).length()).min(1.0);
    let d = a * a / (std::f64::consts::PI * (n_dot_h * n_dot_h * (a * a - 1.0) + 1.0).powi(2));
    let visibility = 0.5 / ((1.0 - a) * 2.0 * n_dot_l * n_dot_v + a * (n_dot_l + n_dot_v));
    let fresnel = f0 + (DVec3::ONE - f0) * (1.0 - v.dot(h)).powi(5);
    fresnel * d * visibility
}

/// Exposed light to an 8-bit value of the picture, not rounded.
pub fn display(nits: f64, exposure: f64) -> f64 {
    let x = nits * exposure;
    let y = ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0);
    255.0 * if y <= 0.003_130_8 { 12.92 * y } else { 1.055 * y.powf(1.0 / 2.4) - 0.055 }
}

/// The inverse of [`display`] for one value.
pub fn nits(value: f64, exposure: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1e6);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if display(middle, exposure) < value { low = middle } else { high = middle }
    }
    low
}
