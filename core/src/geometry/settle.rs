//! Lays bodies down: whoever lies, sits on the floor or props himself up touches the ground at both
//! ends, whatever the shape of the body.
//!
//! A rigid body rests on the edge of its hull that is below its centre of mass. That is found in
//! the upright plane along the body and in the one across it, and the body is tilted until the
//! edge is level.

use glam::{DAffine3, DVec3};

use super::pose::PosedSkeleton;
use super::skeleton::{JOINT_COUNT, Limb, Side, trunk};
use super::stance::turn;
use crate::library::mesh::SkinVertex;

/// Rounds of tilting; each leaves a small fraction of the tilt.
const ROUNDS: usize = 4;
/// No more tilt than this, degrees: what needs more was not meant to lie.
const MOST_DEG: f64 = 30.0;
/// A body whose head and feet are closer over the ground lies in no direction, metres.
const SHORT_M: f64 = 0.25;
/// Edges shorter than this do not tell a tilt, metres.
const EDGE_M: f64 = 0.08;

impl PosedSkeleton {
    /// Tilts the whole person until the vertices rest on level ground. Heights are not settled.
    pub fn settle(
        &mut self,
        heads_m: &[DVec3; JOINT_COUNT],
        vertices: impl Iterator<Item = (DVec3, SkinVertex)> + Clone,
    ) {
        for _ in 0..ROUNDS {
            let along = self.direction(heads_m);
            for way in [along, DVec3::Y.cross(along)] {
                let center_m = self.center_of_mass(heads_m);
                let points = vertices.clone().map(|(rest_m, skin)| {
                    let p = super::points::pose_vertex(&self.model_from_rest, rest_m, skin);
                    [p.dot(way), p.y]
                });
                let tilt_deg = slope_deg(points.collect(), center_m.dot(way));
                if tilt_deg.abs() > MOST_DEG {
                    continue;
                }
                let about = DAffine3::from_translation(center_m)
                    * DAffine3::from_quat(turn(DVec3::Y.cross(way), tilt_deg))
                    * DAffine3::from_translation(-center_m);
                for m in &mut self.model_from_rest {
                    *m = about * *m;
                }
            }
        }
    }

    /// The level direction from the feet to the head; forward for who stands or sits upright.
    fn direction(&self, heads_m: &[DVec3; JOINT_COUNT]) -> DVec3 {
        let at = |joint: usize| self.joint_m(joint, heads_m[joint]);
        let feet = Side::BOTH.map(|s| at(s.joint(Limb::Foot)));
        let body = at(trunk::HEAD) - (feet[0] + feet[1]) * 0.5;
        let level = DVec3::new(body.x, 0.0, body.z);
        if level.length() > SHORT_M { level.normalize() } else { DVec3::Z }
    }

    /// By the segments' shares of the body's mass (de Leva, "Adjustments to Zatsiorsky-Seluyanov's
    /// segment inertia parameters", 1996, men), each in the middle of its bone.
    fn center_of_mass(&self, heads_m: &[DVec3; JOINT_COUNT]) -> DVec3 {
        let at = |joint: usize| self.joint_m(joint, heads_m[joint]);
        let mut sum = (at(trunk::HIPS) + at(trunk::NECK)) * (0.5 * 0.435) + at(trunk::HEAD) * 0.069;
        for side in Side::BOTH {
            let at = |limb: Limb| at(side.joint(limb));
            for (from, to, share) in [
                (Limb::Arm, Limb::ForeArm, 0.027),
                (Limb::ForeArm, Limb::Hand, 0.016),
                (Limb::Hand, Limb::Middle1, 0.006),
                (Limb::UpLeg, Limb::Leg, 0.142),
                (Limb::Leg, Limb::Foot, 0.043),
                (Limb::Foot, Limb::ToeBase, 0.014),
            ] {
                sum += (at(from) + at(to)) * (0.5 * share);
            }
        }
        sum
    }
}

/// Slope of the lower hull's edge below a place, degrees; 0 where there is none.
fn slope_deg(mut points: Vec<[f64; 2]>, place: f64) -> f64 {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    // Andrew's monotone chain (1979), its lower half.
    let mut hull: Vec<[f64; 2]> = Vec::new();
    for p in points {
        while let [.., a, b] = hull[..] {
            let turn = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            if turn > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(p);
    }
    let edge = hull.windows(2).find(|e| (e[0][0]..e[1][0]).contains(&place));
    match edge {
        Some([a, b]) if b[0] - a[0] > EDGE_M => libm::atan2(b[1] - a[1], b[0] - a[0]).to_degrees(),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::pose::tests::adult;

    #[test]
    fn the_edge_below_a_place_is_found() {
        let points = vec![[0.0, 0.0], [1.0, 0.1], [0.5, 2.0], [2.0, 1.1], [1.2, 5.0]];
        let degrees = |dy: f64, dx: f64| libm::atan2(dy, dx).to_degrees();
        assert!((slope_deg(points.clone(), 0.4) - degrees(0.1, 1.0)).abs() < 1e-12);
        assert!((slope_deg(points.clone(), 1.5) - degrees(1.0, 1.0)).abs() < 1e-12);
        assert_eq!(slope_deg(points.clone(), -1.0), 0.0);
        assert_eq!(slope_deg(points, 2.5), 0.0);
        assert_eq!(slope_deg(Vec::new(), 0.0), 0.0);
    }

    #[test]
    fn a_tilted_body_comes_to_rest_on_both_ends() {
        let rest = adult();
        // A slab round the body, each joint in its middle.
        let slab = |joint: usize| {
            let skin = SkinVertex { joints: [joint as u8, 0, 0, 0], weights: [255, 0, 0, 0] };
            [-0.1, 0.1].map(|z| (DVec3::new(rest[joint].x, rest[joint].y, z), skin))
        };
        let vertices: Vec<_> = (0..JOINT_COUNT).flat_map(slab).collect();
        for (pitch, roll) in [(-80.0, 0.0), (-97.0, 8.0), (75.0, -6.0), (90.0, 0.0)] {
            let mut skeleton = PosedSkeleton::REST;
            let lie = turn(DVec3::X, pitch) * turn(DVec3::Y, roll);
            skeleton.model_from_rest = [DAffine3::from_quat(lie); JOINT_COUNT];
            skeleton.settle(&rest, vertices.iter().copied());
            let height = |joint: usize| skeleton.model_from_rest[0].transform_point3(rest[joint]).y;
            let [head, foot, other] =
                [trunk::HEAD, Side::Left.joint(Limb::Foot), Side::Right.joint(Limb::Foot)]
                    .map(height);
            assert!((head - foot).abs() < 0.03, "{pitch} {head} {foot}");
            assert!((foot - other).abs() < 0.01, "{roll} {foot} {other}");
        }
    }
}
