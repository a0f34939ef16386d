//! What cloth round both legs would do if it had no weight.
//!
//! A skirt's front goes with the leg that is ahead and its back with the one that stays behind,
//! whichever they are: no fixed mixture of the two legs' joints does that. So there are four joints
//! beyond the skeleton's, two of the thighs and two of the shins, each of which follows the leg
//! that is farther ahead or farther behind. Rest and posed joints flow in, transforms flow out;
//! which points start with them is decided in [`super::skirt`], where weight takes them in
//! [`super::hang`].

use glam::{DAffine3, DMat3, DVec3};

use super::pose::PosedSkeleton;
use super::skeleton::{JOINT_COUNT, Limb, Side, trunk};

/// Joints that a net of cloth starts with: the skeleton's, then these.
pub const CLOTH_JOINT_COUNT: usize = JOINT_COUNT + 4;

/// The legs share a joint while one is ahead of the other by less than this, metres.
const EVEN_M: f64 = 0.05;

/// Number of the joint beside a leg's own one, in front of the legs or behind them; other joints
/// have none.
#[must_use]
pub fn beside(joint: usize, front: bool) -> usize {
    let is = |limb: Limb| Side::BOTH.iter().any(|side| side.joint(limb) == joint);
    let first = if is(Limb::UpLeg) {
        JOINT_COUNT
    } else if is(Limb::Leg) || is(Limb::Foot) || is(Limb::ToeBase) {
        JOINT_COUNT + 2
    } else {
        return joint;
    };
    first + usize::from(!front)
}

/// Where the four joints go, as [`PosedSkeleton::model_from_rest`] has it for the others: in front
/// of the thighs, behind them, in front of the shins, behind them.
#[must_use]
pub fn joints(skeleton: &PosedSkeleton, heads_m: &[DVec3; JOINT_COUNT]) -> [DAffine3; 4] {
    let hips_from_model = skeleton.model_from_rest[trunk::HIPS].inverse();
    let ahead_m = |side: Side, limb: Limb| {
        let joint = side.joint(limb);
        hips_from_model.transform_point3(skeleton.joint_m(joint, heads_m[joint])).z
    };
    let mixed = |moved: Limb, ends: &[Limb]| {
        let [left, right] = Side::BOTH.map(|side| {
            let sum: f64 = ends.iter().map(|end| ahead_m(side, *end)).sum();
            (sum / ends.len() as f64, skeleton.model_from_rest[side.joint(moved)])
        });
        let share = (0.5 + 0.5 * (left.0 - right.0) / EVEN_M).clamp(0.0, 1.0);
        [share, 1.0 - share].map(|share| between(&right.1, &left.1, share))
    };
    let [thigh_front, thigh_back] = mixed(Limb::UpLeg, &[Limb::Leg]);
    let [shin_front, shin_back] = mixed(Limb::Leg, &[Limb::Leg, Limb::Foot]);
    [thigh_front, thigh_back, shin_front, shin_back]
}

/// The mixture of two transforms as skinning mixes them, entry by entry.
fn between(a: &DAffine3, b: &DAffine3, share: f64) -> DAffine3 {
    let mix = |a: DVec3, b: DVec3| a + (b - a) * share;
    let (m, n) = (&a.matrix3, &b.matrix3);
    DAffine3::from_mat3_translation(
        DMat3::from_cols(mix(m.x_axis, n.x_axis), mix(m.y_axis, n.y_axis), mix(m.z_axis, n.z_axis)),
        mix(a.translation, b.translation),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::pose::tests::adult;

    #[test]
    fn the_front_goes_with_the_leg_that_is_ahead_and_the_back_with_the_other() {
        let heads_m = adult();
        let mut skeleton = PosedSkeleton::REST;
        for side in Side::BOTH {
            let hip = side.joint(Limb::UpLeg);
            let turn = DMat3::from_rotation_x(-0.5 * side.sign());
            let swing = DAffine3::from_mat3_translation(turn, heads_m[hip] - turn * heads_m[hip]);
            for limb in [Limb::UpLeg, Limb::Leg, Limb::Foot, Limb::ToeBase] {
                skeleton.model_from_rest[side.joint(limb)] = swing;
            }
        }
        let [left, right] = Side::BOTH.map(|s| skeleton.model_from_rest[s.joint(Limb::UpLeg)]);
        assert_eq!(joints(&skeleton, &heads_m), [left, right, left, right]);
        assert_eq!(joints(&PosedSkeleton::REST, &heads_m), [DAffine3::IDENTITY; 4]);
    }
}
