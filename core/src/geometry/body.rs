//! A body at rest: joints, keypoints, contact points and measures, without any mesh.
//!
//! Cheap enough to be done for people that may turn out to be hidden: only the few vertices on
//! which these depend are evaluated. Model space, metres: +Y up, +Z forward, +X the person's left,
//! the soles of the shoes at y = 0. The pose is the figure's own: arms about 50 degrees below the
//! horizontal. Poses are not known here.

use glam::DVec3;

use super::phenotype::{Shape, evaluate};
use super::solve::{mass_kg, solve_shape};
use super::trunk::Trunk;
use crate::library::figure::data::KEYPOINT_VERTICES;
use crate::library::figure::{Figure, FigureError, GroupId, JOINT_COUNT, LOD_COUNT, VOLUME_LOD};
use crate::library::mesh::SkinVertex;
use crate::scene::Body;

/// Thickness of the soles of shoes, metres.
pub const SOLE_M: f32 = 0.012;
/// Clothes and the difference of the levels of detail, for bounds.
const COVER_M: f64 = 0.05;
/// Of the keypoints, COCO's order.
const LEFT_ELBOW: usize = 7;
const LEFT_WRIST: usize = 9;
/// Hair and hats, likewise.
const HAIR_M: f64 = 0.15;

/// A point that moves with the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinPoint {
    /// At rest.
    pub rest_m: DVec3,
    /// Joints and weights.
    pub skin: SkinVertex,
}

/// A keypoint: a weighted mean of posed points.
#[derive(Clone, Debug, PartialEq)]
pub struct KeypointRegressor {
    /// Points of the skin.
    pub points: [SkinPoint; KEYPOINT_VERTICES],
    /// Their weights, summing to 1; a few are slightly negative.
    pub weights: [f64; KEYPOINT_VERTICES],
    /// Mean distance to the skin all round, metres.
    pub radius_m: f64,
}

/// A body at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct RestBody {
    /// Weights that give the mesh.
    pub shape: Shape,
    /// Joint positions.
    pub heads_m: [DVec3; JOINT_COUNT],
    /// Far ends of the joints' bones.
    pub tails_m: [DVec3; JOINT_COUNT],
    /// Regressors in the figure's order, COCO's seventeen first.
    pub keypoints: Vec<KeypointRegressor>,
    /// Points that can touch the ground, the soles of the shoes among them.
    pub ground: Vec<SkinPoint>,
    /// No posed, dressed vertex that a joint moves is farther from its head.
    pub reach_m: [f64; JOINT_COUNT],
    /// What arms stay out of.
    pub trunk: Trunk,
    /// Standing height without shoes.
    pub stature_m: f64,
    /// From the body's volume.
    pub mass_kg: f64,
    /// Size of the head against the template's.
    pub head_scale: f64,
}

impl RestBody {
    /// Bytes that it occupies, about.
    #[must_use]
    pub const fn size_bytes(&self) -> usize {
        size_of::<Self>()
            + self.keypoints.capacity() * size_of::<KeypointRegressor>()
            + self.ground.capacity() * size_of::<SkinPoint>()
            + (self.shape.macros.capacity() + self.shape.locals.capacity()) * 16
    }
}

impl RestBody {
    /// The same body without shoes: it stands lower by the thickness of their soles.
    #[must_use]
    pub fn barefoot(mut self) -> Self {
        let down = f64::from(SOLE_M);
        self.shape.lift_m -= SOLE_M;
        let joints = self.heads_m.iter_mut().chain(&mut self.tails_m);
        let points = self.keypoints.iter_mut().flat_map(|k| &mut k.points).map(|p| &mut p.rest_m);
        joints.chain(points).for_each(|p| p.y -= down);
        // Points of the soles already stand on the ground.
        self.ground.iter_mut().for_each(|p| p.rest_m.y = (p.rest_m.y - down).max(0.0));
        self
    }
}

/// Evaluates a body with its face targets.
///
/// # Errors
/// [`FigureError::UnknownFaceTarget`] if `face` names one that the figure has not.
pub fn rest_body(
    figure: &Figure,
    body: &Body,
    face: &[(String, f64)],
) -> Result<RestBody, FigureError> {
    let (shape, head_scale) = solve_shape(figure, body, face)?;
    let skin_lod = &figure.group(GroupId::Skin).lods[VOLUME_LOD];
    let needed = Needed::evaluate(figure, &shape, skin_lod.vertices);
    let mean = |v: &[u16]| v.iter().map(|&i| needed.at(i)).sum::<DVec3>() / v.len() as f64;
    let data = figure.data();
    let mut heads_m = [DVec3::ZERO; JOINT_COUNT];
    let mut tails_m = heads_m;
    for (j, (h, t)) in data.joint_heads.chunks(8).zip(data.joint_tails.chunks(8)).enumerate() {
        (heads_m[j], tails_m[j]) = (mean(h), mean(t));
    }
    let ground = ground(figure, &needed);
    let keypoints: Vec<_> =
        (0..figure.keypoint_names().len()).map(|k| keypoint(figure, &needed, k)).collect();
    let vertices = needed.parts[0].1.iter().zip(&needed.skin);
    let trunk = Trunk::new(
        &heads_m,
        vertices.map(|(p, skin)| (DVec3::from_array(p.map(f64::from)), *skin)),
        [LEFT_ELBOW, LEFT_WRIST].map(|k| keypoints[k].radius_m),
    );
    Ok(RestBody {
        keypoints,
        trunk,
        ground,
        reach_m: reach(figure, &needed, &heads_m),
        stature_m: body.stature_m,
        mass_kg: mass_kg(figure, &needed.parts[0].1),
        head_scale,
        heads_m,
        tails_m,
        shape,
    })
}

/// Positions of the vertices that every body needs.
struct Needed {
    /// First vertex and positions, ascending.
    parts: [(usize, Vec<[f32; 3]>); 4],
    skin: Vec<SkinVertex>,
}

impl Needed {
    fn evaluate(figure: &Figure, shape: &Shape, skin_vertices: u32) -> Self {
        let coarsest = |id: GroupId| figure.group(id).lods[LOD_COUNT - 1].vertices;
        let part = |id, count| {
            let range = figure.vertices(id, count);
            (range.start, evaluate(figure, shape, range))
        };
        let parts = [
            part(GroupId::Skin, skin_vertices),
            part(GroupId::Shell, coarsest(GroupId::Shell)),
            part(GroupId::Eyes, coarsest(GroupId::Eyes)),
            part(GroupId::Joints, coarsest(GroupId::Joints)),
        ];
        let skin = parts
            .iter()
            .flat_map(|(first, p)| figure.skin()[*first..first + p.len()].iter().copied())
            .collect();
        Self { parts, skin }
    }

    fn at(&self, vertex: u16) -> DVec3 {
        self.point(vertex).rest_m
    }

    fn point(&self, vertex: u16) -> SkinPoint {
        let v = usize::from(vertex);
        let mut before = 0;
        for (first, p) in &self.parts {
            if let Some(p) = v.checked_sub(*first).and_then(|i| p.get(i)) {
                let skin = self.skin[before + v - first];
                return SkinPoint { rest_m: DVec3::from_array(p.map(f64::from)), skin };
            }
            before += p.len();
        }
        unreachable!("loading a figure checks that its tables name only vertices of these prefixes")
    }
}

fn keypoint(figure: &Figure, needed: &Needed, k: usize) -> KeypointRegressor {
    let d = figure.data();
    let range = k * KEYPOINT_VERTICES..(k + 1) * KEYPOINT_VERTICES;
    let point = |i| needed.point(d.keypoint_vertices[range.start + i]);
    let points: [SkinPoint; KEYPOINT_VERTICES] = std::array::from_fn(point);
    let weights = std::array::from_fn(|i| f64::from(d.keypoint_weights[range.start + i]));
    let at: DVec3 = points.iter().zip(weights).map(|(p, w): (_, f64)| p.rest_m * w).sum();
    let ring = &d.keypoint_ring[range];
    let radius_m =
        ring.iter().map(|&v| (needed.at(v) - at).length()).sum::<f64>() / ring.len() as f64;
    KeypointRegressor { points, weights, radius_m }
}

fn ground(figure: &Figure, needed: &Needed) -> Vec<SkinPoint> {
    let d = figure.data();
    let soles = d.sole.iter().map(|&v| {
        let p = needed.point(v);
        SkinPoint { rest_m: DVec3::new(p.rest_m.x, 0.0, p.rest_m.z), ..p }
    });
    d.ground.iter().map(|&v| needed.point(v)).chain(soles).collect()
}

/// Largest distance from each joint's head of any vertex that it moves. Linear blend skinning
/// keeps a vertex within the hull of the spheres of its joints.
fn reach(figure: &Figure, needed: &Needed, heads: &[DVec3; JOINT_COUNT]) -> [f64; JOINT_COUNT] {
    let mut out = [0.0_f64; JOINT_COUNT];
    let skin = &needed.parts[0].1;
    for (p, s) in skin.iter().zip(&needed.skin) {
        let p = DVec3::from_array(p.map(f64::from));
        for (&j, &w) in s.joints.iter().zip(&s.weights) {
            if w > 0 {
                let j = usize::from(j);
                out[j] = out[j].max((p - heads[j]).length());
            }
        }
    }
    for (j, reach) in out.iter_mut().enumerate() {
        let name = figure.joint_names()[j].as_str();
        let hair = matches!(name, "Head" | "Neck" | "Spine2");
        // The margin is the template's; half as much again covers other proportions.
        let margin = figure.reach_margin_m()[j] * 1.5;
        *reach += margin + COVER_M + if hair { HAIR_M } else { 0.0 };
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::phenotype::tests::average;
    use crate::scene::Sex;

    fn bodies() -> Vec<Body> {
        let mut out = Vec::new();
        for (i, age_years) in [1.0, 5.0, 12.0, 30.0, 60.0, 90.0].into_iter().enumerate() {
            for sex in [Sex::Male, Sex::Female] {
                let x = i as f64 / 5.0;
                out.push(Body {
                    age_years,
                    stature_m: 0.8 + 0.22 * i as f64,
                    muscle: x,
                    bmi_kg_m2: 16.0 + 18.0 * (1.0 - x),
                    ancestry: [x, 0.2, 1.0 - x],
                    ..average(sex)
                });
            }
        }
        out
    }

    #[test]
    fn the_wanted_stature_is_met() {
        let figure = Figure::built_in().unwrap();
        for body in bodies() {
            let rest = rest_body(&figure, &body, &[]).unwrap();
            let range = figure.vertices(GroupId::Skin, figure.group(GroupId::Skin).count);
            let all = evaluate(&figure, &rest.shape, range);
            let top = all.iter().map(|p| p[1]).fold(f32::MIN, f32::max);
            let low = all.iter().map(|p| p[1]).fold(f32::MAX, f32::min);
            assert!((f64::from(top - low) - body.stature_m).abs() < 5e-4, "{body:?} {}", top - low);
            assert!((low - SOLE_M).abs() < 1e-5);
        }
    }

    #[test]
    fn without_shoes_the_feet_stand_on_the_ground() {
        let figure = Figure::built_in().unwrap();
        let rest = rest_body(&figure, &bodies()[6], &[]).unwrap();
        let bare = rest.clone().barefoot();
        let range = figure.vertices(GroupId::Skin, figure.group(GroupId::Skin).count);
        let skin = evaluate(&figure, &bare.shape, range);
        assert!(skin.iter().map(|p| p[1]).fold(f32::MAX, f32::min).abs() < 1e-5);
        let lowest = |b: &RestBody| b.ground.iter().map(|p| p.rest_m.y).fold(f64::MAX, f64::min);
        assert!(lowest(&bare).abs() < 1e-9);
        let gap = rest.heads_m[7] - bare.heads_m[7];
        assert!((gap - DVec3::Y * f64::from(SOLE_M)).length() < 1e-12);
    }

    #[test]
    fn the_coarse_volume_agrees_with_the_fine_one() {
        let figure = Figure::built_in().unwrap();
        for body in bodies() {
            let rest = rest_body(&figure, &body, &[]).unwrap();
            let group = figure.group(GroupId::Skin);
            let all = evaluate(&figure, &rest.shape, figure.vertices(GroupId::Skin, group.count));
            let at = |r: u16| {
                DVec3::from_array(all[usize::from(group.render[usize::from(r)])].map(f64::from))
            };
            let litres: f64 = group.lods[0]
                .triangles
                .chunks_exact(3)
                .map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0 * 1000.0)
                .sum();
            let ratio = rest.mass_kg / (litres * 0.98);
            assert!((ratio - 1.0).abs() < 0.03, "{body:?} {ratio}");
        }
    }

    #[test]
    fn left_and_right_mirror_each_other() {
        let figure = Figure::built_in().unwrap();
        let rest = rest_body(&figure, &bodies()[7], &[]).unwrap();
        let flip = DVec3::new(-1.0, 1.0, 1.0);
        let names = figure.joint_names();
        for (j, name) in names.iter().enumerate() {
            let other = name.replacen("Left", "Right", 1);
            let k = names.iter().position(|n| *n == other).unwrap();
            assert!((rest.heads_m[j] * flip - rest.heads_m[k]).length() < 3e-5 || j == k, "{name}");
        }
        let place = |k: &KeypointRegressor| -> DVec3 {
            k.points.iter().zip(k.weights).map(|(p, w)| p.rest_m * w).sum()
        };
        let names = figure.keypoint_names();
        for (k, name) in names.iter().enumerate().filter(|n| n.1.starts_with("left_")) {
            let other = name.replacen("left_", "right_", 1);
            let m = names.iter().position(|n| *n == other).unwrap();
            assert_eq!(rest.keypoints[k].weights, rest.keypoints[m].weights);
            let gap = place(&rest.keypoints[k]) * flip - place(&rest.keypoints[m]);
            assert!(gap.length() < 1e-4, "{name} {gap}");
        }
        assert!(place(&rest.keypoints[0]).x.abs() < 1e-4);
    }

    #[test]
    fn keypoint_radii_are_those_of_limbs() {
        let figure = Figure::built_in().unwrap();
        let rest = rest_body(&figure, &average(Sex::Male), &[]).unwrap();
        let radius = |name: &str| {
            let k = figure.keypoint_names().iter().position(|n| n == name).unwrap();
            rest.keypoints[k].radius_m
        };
        assert!((0.02..0.06).contains(&radius("left_wrist")), "{}", radius("left_wrist"));
        assert!((0.03..0.09).contains(&radius("left_knee")), "{}", radius("left_knee"));
        assert!((0.05..0.18).contains(&radius("left_hip")), "{}", radius("left_hip"));
        assert!(radius("nose") < 0.02, "{}", radius("nose"));
    }

    #[test]
    fn an_unknown_face_target_is_named_with_its_nearest() {
        let figure = Figure::built_in().unwrap();
        let face = vec![("nose-hump-inc".to_owned(), 0.5)];
        let e = rest_body(&figure, &average(Sex::Male), &face).unwrap_err();
        assert!(e.to_string().contains("nose-hump-incr"), "{e}");
    }

    #[test]
    fn reach_bounds_the_whole_skin() {
        let figure = Figure::built_in().unwrap();
        for body in bodies() {
            let rest = rest_body(&figure, &body, &[]).unwrap();
            let group = figure.group(GroupId::Skin);
            let all = evaluate(&figure, &rest.shape, figure.vertices(GroupId::Skin, group.count));
            for (p, s) in all.iter().zip(figure.skin()) {
                for (&j, _) in s.joints.iter().zip(&s.weights).filter(|w| *w.1 > 0) {
                    let j = usize::from(j);
                    let d = (DVec3::from_array(p.map(f64::from)) - rest.heads_m[j]).length();
                    assert!(
                        d <= rest.reach_m[j] - 0.02,
                        "{} {d} {}",
                        figure.joint_names()[j],
                        rest.reach_m[j]
                    );
                }
            }
        }
    }
}
