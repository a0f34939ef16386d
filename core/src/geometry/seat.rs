//! What a sitting person sits on.
//!
//! A block that stands on the ground and ends under thighs and buttocks. It reaches from behind the
//! pelvis to in front of the calves, so that whoever draws the feet back sits on less. Rest and
//! posed bodies flow in, a place and a size flow out; forms and colours are not known here.

use glam::{DQuat, DVec3};

use super::body::RestBody;
use super::points::pose_vertex;
use super::pose::PosedSkeleton;
use super::skeleton::{Limb, Side, trunk};
use super::stance::turn;
use crate::library::mesh::SkinVertex;

/// Of a thigh's length: how far a seat reaches behind the hips, beside them at least, and how short it
/// may be.
const BEHIND: f64 = 0.40;
const BESIDE: f64 = 0.50;
const SHORTEST: f64 = 0.5;
/// Of a thigh's length: free space in front, to the middle of knees and ankles.
const CALF: f64 = 0.26;
/// The same to hands that hang so far below the hips.
const HAND: f64 = 0.2;
const HANGING: f64 = 0.3;
/// Flesh and cloth give way by so much, metres.
const GIVE_M: f64 = 0.014;
/// Whoever comes lower than this sits on the ground, metres.
const LOWEST_M: f64 = 0.1;
/// Of 255: what belongs mostly to the pelvis and the thighs.
const MOSTLY: u32 = 128;

/// A block in the model space of the person on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeatBlock {
    /// Its middle, metres.
    pub middle_m: DVec3,
    /// About the vertical; z is forward.
    pub rotation: DQuat,
    /// Whole width, height and depth, metres.
    pub size_m: DVec3,
}

impl SeatBlock {
    /// How a point in the block or near it has to move to be so far off its top or its sides.
    #[must_use]
    pub fn way_out_m(&self, point_m: DVec3, clear_m: f64) -> DVec3 {
        let in_block = self.rotation.inverse() * (point_m - self.middle_m);
        let half_m = self.size_m * 0.5 + clear_m;
        let sign = DVec3::new(in_block.x, 1.0, in_block.z).signum();
        let ways_m = half_m - in_block * sign;
        let least_m = ways_m.min_element();
        if least_m <= 0.0 {
            return DVec3::ZERO;
        }
        let axis = match least_m {
            way if way == ways_m.y => DVec3::Y,
            way if way == ways_m.x => DVec3::X,
            _ => DVec3::Z,
        };
        self.rotation * (axis * sign * least_m)
    }
}

/// The block under a posed body on its ground, y = 0; nothing under who sits on the ground itself or
/// does not sit.
#[must_use]
pub fn seat_block(skeleton: &PosedSkeleton, body: &RestBody) -> Option<SeatBlock> {
    let at = |joint: usize| skeleton.joint_m(joint, body.heads_m[joint]);
    let facing = skeleton.model_from_rest[trunk::HIPS].matrix3.z_axis;
    let forward = facing.with_y(0.0).try_normalize()?;
    let rotation = turn(DVec3::Y, libm::atan2(forward.x, forward.z).to_degrees());
    let hips_m = Side::BOTH.map(|s| at(s.joint(Limb::UpLeg)));
    let middle_m = (hips_m[0] + hips_m[1]) * 0.5;
    let head_m = |joint: usize| body.heads_m[joint];
    let thigh_m =
        head_m(Side::Left.joint(Limb::UpLeg)).distance(head_m(Side::Left.joint(Limb::Leg)));

    let ahead_m = |p: DVec3| (p - middle_m).dot(forward);
    let back_m = -BEHIND * thigh_m;
    let legs = [Limb::Leg, Limb::Foot].map(|limb| Side::BOTH.map(|s| at(s.joint(limb))));
    // A leg that lies on the other one bounds nothing.
    let below = legs.as_flattened().iter().filter(|p| p.y < middle_m.y);
    let calves_m = below.map(|p| ahead_m(*p)).fold(thigh_m, f64::min);
    // Neither are hands that hang down between the knees in it.
    let hands = [Limb::Hand, Limb::Middle1].map(|limb| Side::BOTH.map(|s| at(s.joint(limb))));
    let hanging = hands.as_flattened().iter().filter(|p| p.y < middle_m.y - HANGING * thigh_m);
    let hands_m = hanging.map(|p| ahead_m(*p)).filter(|m| *m > 0.0).fold(thigh_m, f64::min);
    let ends_m = (calves_m - CALF * thigh_m).min(hands_m - HAND * thigh_m);
    let front_m = ends_m.max(back_m + SHORTEST * thigh_m);

    let sits = |skin: &SkinVertex| {
        let own = [trunk::HIPS, Side::Left.joint(Limb::UpLeg), Side::Right.joint(Limb::UpLeg)];
        let weights = skin.joints.iter().zip(&skin.weights);
        let sum: u32 =
            weights.filter(|w| own.contains(&usize::from(*w.0))).map(|w| u32::from(*w.1)).sum();
        sum >= MOSTLY
    };
    let left = DVec3::Y.cross(forward);
    let (mut lowest_m, mut beside_m) = (f64::MAX, BESIDE * thigh_m);
    for p in body.ground.iter().filter(|p| sits(&p.skin)) {
        let p = pose_vertex(&skeleton.model_from_rest, p.rest_m, p.skin);
        if p.y < LOWEST_M {
            return None;
        }
        if (back_m..front_m).contains(&ahead_m(p)) {
            lowest_m = lowest_m.min(p.y);
            beside_m = beside_m.max((p - middle_m).dot(left).abs());
        }
    }
    let top_m = lowest_m + GIVE_M;
    if top_m >= middle_m.y {
        return None;
    }
    let across = middle_m.with_y(0.5 * top_m) + forward * (0.5 * (front_m + back_m));
    let size_m = DVec3::new(2.0 * beside_m, top_m, front_m - back_m);
    Some(SeatBlock { middle_m: across, rotation, size_m })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_out_of_a_block_is_the_shortest_but_never_downwards() {
        let rotation = DQuat::from_rotation_y(0.5);
        let block = SeatBlock {
            middle_m: DVec3::new(0.0, 0.2, 0.1),
            rotation,
            size_m: DVec3::new(0.4, 0.4, 0.5),
        };
        let at = |p: DVec3| block.middle_m + rotation * p;
        for (inside, way) in [
            (DVec3::new(0.0, 0.15, 0.0), DVec3::new(0.0, 0.06, 0.0)),
            (DVec3::new(-0.18, -0.1, 0.1), DVec3::new(-0.03, 0.0, 0.0)),
            (DVec3::new(0.1, 0.0, 0.22), DVec3::new(0.0, 0.0, 0.04)),
            (DVec3::new(0.0, -0.19, 0.0), DVec3::new(0.21, 0.0, 0.0)),
            (DVec3::new(0.0, 0.22, 0.0), DVec3::ZERO),
            (DVec3::new(0.0, 0.0, -0.3), DVec3::ZERO),
        ] {
            let found = block.way_out_m(at(inside), 0.01);
            assert!((found - rotation * way).length() < 1e-12, "{inside}: {found}");
        }
    }

    use crate::geometry::body::rest_body;
    use crate::geometry::phenotype::tests::average;
    use crate::geometry::stance::Stance;
    use crate::library::figure::Figure;
    use crate::library::pose::{Pose, Poses};
    use crate::scene::{Body, Sex};

    fn bodies() -> Vec<RestBody> {
        let figure = Figure::built_in().unwrap();
        let child =
            Body { age_years: 6.0, stature_m: 1.15, bmi_kg_m2: 15.5, ..average(Sex::Female) };
        let heavy = Body { stature_m: 1.85, bmi_kg_m2: 36.0, ..average(Sex::Male) };
        let all = [average(Sex::Male), average(Sex::Female), child, heavy];
        all.iter().map(|body| rest_body(&figure, body, &[]).unwrap()).collect()
    }

    fn posed(pose: &Pose, body: &RestBody) -> PosedSkeleton {
        let mut skeleton = PosedSkeleton::of_stance(&body.heads_m, &Stance::of_pose(pose));
        body.trunk.push_arms_out(&body.heads_m, &mut skeleton);
        skeleton.ground(body.ground.iter().map(|p| (p.rest_m, p.skin)));
        skeleton
    }

    #[test]
    fn seats_carry_the_hips_and_leave_the_feet_alone() {
        for body in bodies() {
            for pose in Poses::built_in().all().iter().filter(|p| p.seated) {
                let skeleton = posed(pose, &body);
                let block = seat_block(&skeleton, &body).unwrap_or_else(|| panic!("{}", pose.id));
                let half_m = block.size_m * 0.5;
                let own = |p: DVec3| block.rotation.inverse() * (p - block.middle_m);
                let inside = |p: DVec3| (half_m - own(p).abs()).min_element();
                assert!((block.middle_m.y - half_m.y).abs() < 1e-12, "it stands on the ground");
                let mut deepest = (0.0_f64, DVec3::ZERO, [0; 4]);
                for p in &body.ground {
                    let at = pose_vertex(&skeleton.model_from_rest, p.rest_m, p.skin);
                    if inside(at) > deepest.0 {
                        deepest = (inside(at), own(at), p.skin.joints);
                    }
                }
                // It touches, and no more of the feet and calves is in it than of the flesh.
                let touches = deepest.0 > 0.5 * GIVE_M && deepest.0 < 2.5 * GIVE_M;
                assert!(touches, "{} {deepest:?} {block:?}", pose.id);
                for side in Side::BOTH {
                    let hip = side.joint(Limb::UpLeg);
                    let at = own(skeleton.joint_m(hip, body.heads_m[hip]));
                    assert!(at.x.abs() < half_m.x && at.z.abs() < half_m.z, "{}", pose.id);
                    for limb in [Limb::Leg, Limb::Foot, Limb::ToeBase] {
                        let joint = side.joint(limb);
                        assert!(inside(skeleton.joint_m(joint, body.heads_m[joint])) < 0.0);
                    }
                }
            }
        }
    }

    #[test]
    fn there_is_no_seat_under_who_sits_on_the_ground() {
        for body in bodies() {
            let pose = Poses::built_in().get("pose/sitting_on_floor").unwrap();
            let mut skeleton = posed(pose, &body);
            let contacts = || body.ground.iter().map(|p| (p.rest_m, p.skin));
            skeleton.settle(&body.heads_m, contacts());
            skeleton.ground(contacts());
            assert_eq!(seat_block(&skeleton, &body), None);
        }
    }
}
