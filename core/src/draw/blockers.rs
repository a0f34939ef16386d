//! Bodies as a few spheres: what keeps the light of the surroundings from places near it.
//!
//! Ambient occlusion by spheres along the bones, as thick as the body is there (after Iwanicki,
//! "Lighting technology of The Last of Us", SIGGRAPH 2013, who takes ellipsoids). They lie a little
//! inside the skin. What they do to light is written down at [`abi::Blocker`].

use glam::DVec3;

use super::abi::{Blocker, MAX_BLOCKERS};

/// Smaller on the picture than this, in pixels, nobody's are worth it: a person's stature.
const SMALLEST_PX: f64 = 24.0;
/// Spheres of a person.
const PER_PERSON: usize = 25;

/// What the spheres of a person follow from, view space, metres.
pub struct Figure<'a> {
    /// COCO's keypoints.
    pub keypoints: &'a [DVec3; 17],
    /// Mean distance from each of them to the skin round it.
    pub radii_m: [f64; 17],
    /// Left and right.
    pub toes: [DVec3; 2],
    /// Where it is nearest, pixels that a metre spans.
    pub px_per_m: f64,
    /// Stature times scale.
    pub stature_m: f64,
}

/// Adds a person's spheres where they matter and there is room; gives their range.
pub fn add(blockers: &mut Vec<Blocker>, figure: &Figure) -> std::ops::Range<u32> {
    let first = blockers.len();
    let small = figure.stature_m * figure.px_per_m < SMALLEST_PX;
    if !small && first + PER_PERSON <= MAX_BLOCKERS {
        blockers.extend(spheres(figure).map(|(center, radius_m)| Blocker {
            center: center.as_vec3().to_array(),
            radius_m: radius_m as f32,
        }));
    }
    first as u32..blockers.len() as u32
}

fn spheres(figure: &Figure) -> [(DVec3, f64); PER_PERSON] {
    let Figure { keypoints: p, radii_m: r, toes, .. } = figure;
    let between = |a: usize, b: usize, t: f64, thick: f64| {
        (p[a].lerp(p[b], t), thick * (r[a] + (r[b] - r[a]) * t))
    };
    let across_m = p[5].distance(p[6]);
    let mut all = [(DVec3::ZERO, 0.0); PER_PERSON];
    let mut rest = all.iter_mut();
    let mut push = |sphere: (DVec3, f64)| {
        if let Some(place) = rest.next() {
            *place = sphere;
        }
    };
    for (side, toe) in toes.iter().enumerate() {
        let [shoulder, elbow, wrist, hip, knee, ankle] =
            [5, 7, 9, 11, 13, 15].map(|left| left + side);
        push(between(shoulder, elbow, 0.55, 0.9));
        push(between(elbow, wrist, 0.5, 0.9));
        push((p[wrist] + (p[wrist] - p[elbow]) * 0.25, r[wrist]));
        push(between(hip, knee, 0.30, 0.9));
        push(between(hip, knee, 0.75, 0.95));
        push(between(knee, ankle, 0.30, 0.95));
        push(between(knee, ankle, 0.75, 0.95));
        push((p[ankle], r[ankle]));
        push((*toe, 0.75 * r[ankle]));
        // Two columns of the trunk, closer together than hips and shoulders are.
        for t in [0.15, 0.5, 0.85] {
            let [own, other] = [(hip, shoulder), (23 - hip, 11 - shoulder)]
                .map(|(low, high)| p[low].lerp(p[high], t));
            push((own.lerp(other, 0.25), 0.27 * across_m));
        }
    }
    let ears_m = p[3].distance(p[4]);
    push(((p[3] + p[4]) * 0.5, 0.52 * ears_m));
    all
}
