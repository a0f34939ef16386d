//! A clip's frame or a stance and a person's own joints -> where each joint of that person goes.
//!
//! The clip turns thirteen bodies of a figure that stands upright with hanging arms; a person at
//! rest stands with arms and legs apart, each a little differently. Per person, align rotations
//! take the limbs at rest to the source's rest; the joints between the source's bodies share
//! their turn; bones keep their length. All in model space, so no convention about the axes of
//! single bones is needed.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::hand;
use super::skeleton::{JOINT_COUNT, Limb, PARENTS, Side, trunk};
use super::stance::{BallJoint, Stance, euler_xzy, set_ball, turn};
use crate::library::clip::{ClipFrame, SourceBody};
use crate::library::mesh::SkinVertex;
use crate::library::pose::Foot;
use crate::library::pose::angle::{Angles, Limb as Angle, SIDE};
use crate::scene::HandShape;

/// A leg is not stretched farther than this share of its length.
const STRETCHED: f64 = 0.9995;

/// A person's joints, posed.
#[derive(Clone, Debug, PartialEq)]
pub struct PosedSkeleton {
    /// By joint: model space posed from model space at rest, rigid, metres.
    pub model_from_rest: [DAffine3; JOINT_COUNT],
}

impl PosedSkeleton {
    /// The rest pose.
    pub const REST: Self = Self { model_from_rest: [DAffine3::IDENTITY; JOINT_COUNT] };

    /// The pose of a clip's frame on the person whose joints stand at `rest_joints_m` at rest
    /// (model space), with relaxed hands. The hips keep their place over the ground and their
    /// height; [`Self::ground`] settles the height. `mirrored` exchanges left and right of the
    /// clip before it meets the person.
    #[must_use]
    pub fn new(rest_joints_m: &[DVec3; JOINT_COUNT], frame: &ClipFrame, mirrored: bool) -> Self {
        Self::of_clip(rest_joints_m, frame, [HandShape::Relaxed; 2], mirrored)
    }

    /// The same with other hands, left and right; they change places too when mirrored.
    #[must_use]
    pub fn of_clip(
        rest_joints_m: &[DVec3; JOINT_COUNT],
        frame: &ClipFrame,
        hands: [HandShape; 2],
        mirrored: bool,
    ) -> Self {
        let [left, right] = hands;
        let (frame, hands) =
            if mirrored { (frame.mirrored(), [right, left]) } else { (*frame, hands) };
        Self::rotated(rest_joints_m, &clip_rotations(rest_joints_m, &frame, hands))
    }

    /// A stance of the person whose joints stand at `rest_joints_m` at rest, as for clips.
    #[must_use]
    pub fn of_stance(rest_joints_m: &[DVec3; JOINT_COUNT], stance: &Stance) -> Self {
        Self::rotated(rest_joints_m, &stance_rotations(rest_joints_m, stance))
    }

    /// Joints turned away from rest, model space.
    fn rotated(rest_joints_m: &[DVec3; JOINT_COUNT], rotations: &[DQuat; JOINT_COUNT]) -> Self {
        let mut posed_m = [DVec3::ZERO; JOINT_COUNT];
        let mut model_from_rest = [DAffine3::IDENTITY; JOINT_COUNT];
        for joint in 0..JOINT_COUNT {
            let parent = usize::from(PARENTS[joint]);
            let offset = rest_joints_m[joint] - rest_joints_m[parent];
            posed_m[joint] = if joint == trunk::HIPS {
                rest_joints_m[joint]
            } else {
                posed_m[parent] + rotations[parent] * offset
            };
            let rotation = DMat3::from_quat(rotations[joint]);
            model_from_rest[joint] = DAffine3::from_mat3_translation(
                rotation,
                posed_m[joint] - rotation * rest_joints_m[joint],
            );
        }
        Self { model_from_rest }
    }

    /// Where a joint stands, given where it stands at rest.
    #[must_use]
    pub fn joint_m(&self, joint: usize, rest_joint_m: DVec3) -> DVec3 {
        self.model_from_rest[joint].transform_point3(rest_joint_m)
    }

    /// Lowest y of the posed vertices, metres; infinite without vertices.
    #[must_use]
    pub fn lowest_m(&self, vertices: impl Iterator<Item = (DVec3, SkinVertex)>) -> f64 {
        // Only the y rows of the matrices are needed.
        let rows = self.model_from_rest.map(|m| (m.matrix3.row(1), m.translation.y));
        vertices.fold(f64::INFINITY, |lowest, (rest_m, skin)| {
            let mut y = 0.0;
            for (&joint, &weight) in skin.joints.iter().zip(&skin.weights) {
                let (row, offset) = rows[usize::from(joint)];
                y += (row.dot(rest_m) + offset) * (f64::from(weight) / 255.0);
            }
            lowest.min(y)
        })
    }

    /// Moves the whole person up or down so that the lowest posed vertex touches y = 0, and
    /// returns by how much, metres. Without vertices nothing moves.
    pub fn ground(&mut self, vertices: impl Iterator<Item = (DVec3, SkinVertex)>) -> f64 {
        let lowest = self.lowest_m(vertices);
        if !lowest.is_finite() {
            return 0.0;
        }
        for m in &mut self.model_from_rest {
            m.translation.y -= lowest;
        }
        -lowest
    }
}

/// Model-space rotation of each joint away from rest.
fn clip_rotations(
    rest_m: &[DVec3; JOINT_COUNT],
    frame: &ClipFrame,
    hands: [HandShape; 2],
) -> [DQuat; JOINT_COUNT] {
    use SourceBody as B;
    let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
    let (root, chest, neck) = (frame.get(B::Root), frame.get(B::Chest), frame.get(B::Neck));
    rotations[trunk::HIPS] = root;
    rotations[trunk::SPINE] = between(root, chest, 1.0 / 3.0);
    rotations[trunk::SPINE1] = between(root, chest, 2.0 / 3.0);
    rotations[trunk::SPINE2] = chest;
    rotations[trunk::NECK] = between(chest, neck, 0.5);
    rotations[trunk::HEAD] = neck;
    for side in Side::BOTH {
        let [hip, knee, ankle, shoulder, elbow] = match side {
            Side::Left => [B::LeftHip, B::LeftKnee, B::LeftAnkle, B::LeftShoulder, B::LeftElbow],
            Side::Right => {
                [B::RightHip, B::RightKnee, B::RightAnkle, B::RightShoulder, B::RightElbow]
            }
        }
        .map(|body| frame.get(body));
        let align = LimbAlign::new(rest_m, side);
        let mut set = |limb: Limb, rotation: DQuat| {
            rotations[side.joint(limb)] = rotation.normalize();
        };
        set(Limb::UpLeg, hip * align.up_leg);
        set(Limb::Leg, knee * align.leg);
        set(Limb::Foot, ankle * align.foot);
        set(Limb::ToeBase, ankle * align.foot);
        set(Limb::Shoulder, chest);
        set(Limb::Arm, shoulder * align.arm);
        set(Limb::ForeArm, elbow * align.fore_arm);
        set(Limb::Hand, elbow * align.fore_arm);
        hand::bend(rest_m, side, hands[side as usize], &mut rotations);
    }
    rotations
}

/// The same for a stance: angles are applied to the source's rest, and align rotations come last.
fn stance_rotations(rest_m: &[DVec3; JOINT_COUNT], stance: &Stance) -> [DQuat; JOINT_COUNT] {
    let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
    rotations[trunk::HIPS] = stance.root;
    for (joint, part) in [
        (trunk::SPINE, BallJoint::Spine),
        (trunk::SPINE1, BallJoint::Spine),
        (trunk::SPINE2, BallJoint::Spine),
        (trunk::NECK, BallJoint::Head),
        (trunk::HEAD, BallJoint::Head),
    ] {
        rotations[joint] = (rotations[joint - 1] * stance.joint(part)).normalize();
    }
    let legs = legs(rest_m, stance);
    for side in Side::BOTH {
        let align = LimbAlign::new(rest_m, side);
        bend_arm(rest_m, stance, side, &align, &mut rotations);
        let Leg { thigh, shank, .. } = legs[side as usize];
        let foot = foot(stance, side, shank);
        let toe = foot * turn(DVec3::NEG_X, stance.limb(side, Angle::ToeExtension));
        let mut set = |limb: Limb, rotation: DQuat| {
            rotations[side.joint(limb)] = rotation.normalize();
        };
        set(Limb::UpLeg, thigh * align.up_leg);
        set(Limb::Leg, shank * align.leg);
        set(Limb::Foot, foot * align.foot);
        set(Limb::ToeBase, toe * align.foot);
    }
    rotations
}

/// Sets the joints from the collar bone to the fingers; the chest is set already.
fn bend_arm(
    rest_m: &[DVec3; JOINT_COUNT],
    stance: &Stance,
    side: Side,
    align: &LimbAlign,
    rotations: &mut [DQuat; JOINT_COUNT],
) {
    let out = side.sign();
    let deg = |angle| stance.limb(side, angle);
    let chest = rotations[trunk::SPINE2];
    let collar = turn(DVec3::Z, out * deg(Angle::ClavicleElevation))
        * turn(DVec3::Y, -out * deg(Angle::ClavicleProtraction));
    let shoulder = chest * stance.joint(BallJoint::Shoulder(side as usize));
    let elbow = shoulder * turn(DVec3::NEG_X, deg(Angle::ElbowFlexion));
    // There is no joint between elbow and wrist: each takes half of the forearm's turn.
    let half = turn(DVec3::Y, -0.5 * out * deg(Angle::ForearmPronation));
    let fore_arm = elbow * half;
    let hand = fore_arm
        * half
        * turn(DVec3::Z, -out * deg(Angle::WristFlexion))
        * turn(DVec3::X, deg(Angle::WristDeviation));
    let mut set = |limb: Limb, rotation: DQuat| {
        rotations[side.joint(limb)] = rotation.normalize();
    };
    set(Limb::Shoulder, chest * collar);
    set(Limb::Arm, shoulder * align.arm);
    set(Limb::ForeArm, fore_arm * align.fore_arm);
    set(Limb::Hand, hand * align.fore_arm);
    hand::bend(rest_m, side, stance.hands[side as usize], rotations);
}

/// A leg in model space, as if it hung straight down at rest.
#[derive(Clone, Copy, Debug)]
struct Leg {
    hip_m: DVec3,
    thigh: DQuat,
    shank: DQuat,
    thigh_m: f64,
    shank_m: f64,
}

impl Leg {
    fn new(rest_m: &[DVec3; JOINT_COUNT], stance: &Stance, side: Side) -> Self {
        let at = |limb: Limb| rest_m[side.joint(limb)];
        let thigh = stance.root * stance.joint(BallJoint::Hip(side as usize));
        Self {
            hip_m: stance.root * (at(Limb::UpLeg) - rest_m[trunk::HIPS]),
            thigh,
            shank: thigh * turn(DVec3::X, stance.limb(side, Angle::KneeFlexion)),
            thigh_m: at(Limb::UpLeg).distance(at(Limb::Leg)),
            shank_m: at(Limb::Leg).distance(at(Limb::Foot)),
        }
    }

    fn ankle_m(&self) -> DVec3 {
        self.hip_m
            + self.thigh * (DVec3::NEG_Y * self.thigh_m)
            + self.shank * (DVec3::NEG_Y * self.shank_m)
    }

    /// Height of the lowest point right below or above the ankle that the leg can reach.
    fn lowest_m(&self) -> f64 {
        let aside = self.ankle_m() - self.hip_m;
        let length = (self.thigh_m + self.shank_m) * STRETCHED;
        let down = length * length - aside.x * aside.x - aside.z * aside.z;
        self.hip_m.y - down.max(0.0).sqrt()
    }

    /// The same leg with its ankle at another height: the knee bends, and the whole leg turns the
    /// shortest way.
    fn with_ankle_at(&self, y_m: f64) -> Self {
        let ankle_m = self.ankle_m();
        let target = DVec3::new(ankle_m.x, y_m, ankle_m.z) - self.hip_m;
        let (a, b) = (self.thigh_m, self.shank_m);
        let cos = (target.length_squared() - a * a - b * b) / (2.0 * a * b);
        let knee = libm::acos(cos.clamp(-1.0, 1.0)).to_degrees();
        let shank = self.thigh * turn(DVec3::X, knee);
        let bent = Self { shank, ..*self };
        let way = shortest_arc(bent.ankle_m() - self.hip_m, target.normalize_or_zero());
        Self { thigh: (way * self.thigh).normalize(), shank: (way * shank).normalize(), ..*self }
    }

    /// Whether hip and knee are within their limits, given a pelvis.
    fn is_human(&self, root: DQuat, side: Side) -> bool {
        let mut angles = Angles::default();
        set_ball(BallJoint::Hip(side as usize), &mut angles, root.inverse() * self.thigh);
        let knee = euler_xzy(self.thigh.inverse() * self.shank)[0].to_degrees();
        angles.side_deg[side as usize][Angle::KneeFlexion as usize] = knee;
        angles.side_deg[side as usize]
            .iter()
            .zip(&SIDE)
            .all(|(deg, reach)| (reach.limits_deg[0]..=reach.limits_deg[1]).contains(deg))
    }
}

/// Both legs. Where both feet are planted, they stand on one ground: that of the lower one, or of
/// the lowest that the other can reach.
fn legs(rest_m: &[DVec3; JOINT_COUNT], stance: &Stance) -> [Leg; 2] {
    let legs = Side::BOTH.map(|side| Leg::new(rest_m, stance, side));
    if stance.feet != [Foot::Planted; 2] {
        return legs;
    }
    let lower = legs[0].ankle_m().y.min(legs[1].ankle_m().y);
    let ground = lower.max(legs[0].lowest_m()).max(legs[1].lowest_m());
    let planted = legs.map(|leg| leg.with_ankle_at(ground));
    let human = Side::BOTH.iter().all(|s| planted[*s as usize].is_human(stance.root, *s));
    if human { planted } else { legs }
}

/// Model-space rotation of a foot, given its shank's.
fn foot(stance: &Stance, side: Side, shank: DQuat) -> DQuat {
    let joint = BallJoint::Ankle(side as usize);
    if stance.feet[side as usize] == Foot::Free {
        return shank * stance.joint(joint);
    }
    // Level, with the axis of the ankle's hinge above that of the shank.
    let aside = shank * DVec3::X;
    let heading = shortest_arc(DVec3::new(aside.x, 0.0, aside.z), DVec3::X).inverse();
    let mut level = stance.clone();
    set_ball(joint, &mut level.angles, shank.inverse() * heading);
    for (deg, reach) in level.angles.side_deg[side as usize].iter_mut().zip(&SIDE) {
        *deg = deg.clamp(reach.limits_deg[0], reach.limits_deg[1]);
    }
    shank * level.joint(joint)
}

/// Rotations that take one side's limbs from the person's rest to the source's rest.
struct LimbAlign {
    up_leg: DQuat,
    leg: DQuat,
    foot: DQuat,
    arm: DQuat,
    fore_arm: DQuat,
}

impl LimbAlign {
    fn new(rest_m: &[DVec3; JOINT_COUNT], side: Side) -> Self {
        let bone = |from: Limb, to: Limb| rest_m[side.joint(to)] - rest_m[side.joint(from)];
        let down = |direction: DVec3| shortest_arc(direction, DVec3::NEG_Y);
        let arm = down(bone(Limb::Arm, Limb::ForeArm));
        // The forearm goes along with the arm first: the elbow keeps its sense.
        let fore_arm = (down(arm * bone(Limb::ForeArm, Limb::Hand)) * arm).normalize();
        // Feet turn about the vertical only and keep the slope that they have at rest.
        let foot = bone(Limb::Foot, Limb::ToeBase);
        Self {
            up_leg: down(bone(Limb::UpLeg, Limb::Leg)),
            leg: down(bone(Limb::Leg, Limb::Foot)),
            foot: shortest_arc(DVec3::new(foot.x, 0.0, foot.z), DVec3::Z),
            arm,
            fore_arm,
        }
    }
}

/// The rotation at `t` of the way from one to another, 0..1, by the shorter way.
fn between(a: DQuat, b: DQuat, t: f64) -> DQuat {
    a.slerp(b, t).normalize()
}

/// The smallest rotation that takes the direction of `from` to the unit vector `to`: the identity
/// where there is no direction, a half turn about some axis across where it is the opposite.
fn shortest_arc(from: DVec3, to: DVec3) -> DQuat {
    let from = from.normalize_or_zero();
    if from == DVec3::ZERO {
        return DQuat::IDENTITY;
    }
    // 1 + cos loses its digits near a half turn; |from + to|^2 = 2 (1 + cos) does not.
    let sum = from + to;
    if sum.length_squared() < 1e-14 {
        let axis = to.any_orthonormal_vector();
        return DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.0);
    }
    let axis = from.cross(to);
    DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.5 * sum.length_squared()).normalize()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::geometry::points::pose_vertex;
    use crate::geometry::skeleton::{JOINT_NAMES, joint_by_name, mirrored};
    use crate::library::clip::Clips;

    /// Rest joints of an average adult in centimetres: the trunk, then the left side.
    const ADULT_CM: [[f64; 3]; 29] = [
        [0.00, 7.27, 1.44],
        [0.00, 11.87, -0.96],
        [0.00, 18.67, 1.49],
        [0.00, 27.97, 2.59],
        [0.00, 58.90, 0.68],
        [0.00, 69.75, 1.61],
        [2.66, 51.91, 6.94],
        [16.77, 52.46, 1.46],
        [31.29, 34.93, 1.32],
        [43.12, 24.52, 17.57],
        [41.95, 23.06, 21.34],
        [40.95, 22.56, 23.73],
        [39.84, 21.10, 26.82],
        [44.96, 20.30, 26.44],
        [45.32, 18.95, 28.54],
        [45.34, 17.45, 30.24],
        [46.08, 18.86, 24.79],
        [47.12, 16.72, 26.91],
        [47.47, 14.88, 28.56],
        [46.96, 18.25, 23.09],
        [48.11, 16.17, 24.61],
        [48.59, 14.26, 25.92],
        [47.45, 17.64, 21.24],
        [48.07, 15.82, 22.21],
        [48.30, 14.55, 22.81],
        [11.04, 4.86, 1.23],
        [15.81, -36.95, 3.20],
        [21.96, -74.48, -0.09],
        [21.99, -81.02, 12.08],
    ];

    pub(in crate::geometry) fn adult() -> [DVec3; JOINT_COUNT] {
        std::array::from_fn(|joint| {
            let left = if joint < ADULT_CM.len() { joint } else { mirrored(joint) };
            let p = DVec3::from_array(ADULT_CM[left]) * 0.01;
            if left == joint { p } else { flip(p) }
        })
    }

    pub(in crate::geometry) fn flip(p: DVec3) -> DVec3 {
        DVec3::new(-p.x, p.y, p.z)
    }

    fn posed(frame: &ClipFrame, mirrored: bool) -> [DVec3; JOINT_COUNT] {
        let rest = adult();
        let skeleton = PosedSkeleton::new(&rest, frame, mirrored);
        std::array::from_fn(|j| skeleton.joint_m(j, rest[j]))
    }

    fn bone(joints: &[DVec3; JOINT_COUNT], from: &str, to: &str) -> DVec3 {
        (joints[joint_by_name(to).unwrap()] - joints[joint_by_name(from).unwrap()]).normalize()
    }

    #[test]
    fn the_source_s_rest_is_standing_with_hanging_arms() {
        let joints = posed(&ClipFrame::REST, false);
        for side in ["Left", "Right"] {
            let down = |from: &str, to: &str| {
                bone(&joints, &format!("{side}{from}"), &format!("{side}{to}")).dot(DVec3::NEG_Y)
            };
            for (from, to) in
                [("UpLeg", "Leg"), ("Leg", "Foot"), ("Arm", "ForeArm"), ("ForeArm", "Hand")]
            {
                assert!(down(from, to) > 1.0 - 1e-12, "{side}{from}");
            }
            let foot = bone(&joints, &format!("{side}Foot"), &format!("{side}ToeBase"));
            assert!(foot.x.abs() < 1e-12 && foot.z > 0.8, "{foot}");
        }
        assert!(bone(&joints, "Neck", "Head").y > 0.9);
    }

    #[test]
    fn relaxed_fingers_close_towards_the_thigh_and_hold_nothing_back() {
        let joints = posed(&ClipFrame::REST, false);
        for (side, inward) in [("Left", DVec3::NEG_X), ("Right", DVec3::X)] {
            for finger in ["Index", "Middle", "Ring", "Pinky"] {
                let name = |i: u32| format!("{side}Hand{finger}{i}");
                let first = bone(&joints, &name(1), &name(2));
                let second = bone(&joints, &name(2), &name(3));
                assert!(second.dot(inward) > first.dot(inward) + 0.2, "{side} {finger}");
                assert!(second.dot(inward) > 0.5, "{side} {finger} {second}");
            }
        }
    }

    #[test]
    fn every_frame_of_every_clip_is_rigid_and_keeps_bone_lengths() {
        let rest = adult();
        for clip in Clips::built_in().all() {
            for frame in clip.frames() {
                for mirrored in [false, true] {
                    let skeleton = PosedSkeleton::new(&rest, frame, mirrored);
                    for (joint, m) in skeleton.model_from_rest.iter().enumerate() {
                        assert!(m.is_finite(), "{} {}", clip.id, JOINT_NAMES[joint]);
                        let gram = m.matrix3.transpose() * m.matrix3;
                        assert!(gram.abs_diff_eq(DMat3::IDENTITY, 1e-12));
                        assert!((m.matrix3.determinant() - 1.0).abs() < 1e-12);
                        let parent = usize::from(PARENTS[joint]);
                        let length = |a: DVec3, b: DVec3| (a - b).length();
                        let now = length(
                            skeleton.joint_m(joint, rest[joint]),
                            skeleton.joint_m(parent, rest[parent]),
                        );
                        assert!((now - length(rest[joint], rest[parent])).abs() < 1e-12);
                        // A joint belongs to its parent as well: the two must not come apart.
                        let by_parent = skeleton.joint_m(parent, rest[joint]);
                        assert!(length(by_parent, skeleton.joint_m(joint, rest[joint])) < 1e-12);
                    }
                }
            }
        }
    }

    #[test]
    fn mirroring_reflects_a_symmetric_person() {
        for (clip, phase) in [("cartwheel", 0.3), ("kick", 0.71), ("dance_b", 0.55)] {
            let frame = Clips::built_in().get(clip).unwrap().sample(phase);
            let (plain, mirror) = (posed(&frame, false), posed(&frame, true));
            for joint in 0..JOINT_COUNT {
                let expected = flip(plain[mirrored(joint)]);
                assert!((mirror[joint] - expected).length() < 1e-12, "{}", JOINT_NAMES[joint]);
            }
            assert_eq!(posed(&frame.mirrored(), true), plain);
        }
    }

    #[test]
    fn a_walker_s_feet_point_forward_and_stand_below_the_hips() {
        for frame in Clips::built_in().get("walk").unwrap().frames() {
            let joints = posed(frame, false);
            for side in ["Left", "Right"] {
                let (foot, toe) = (format!("{side}Foot"), format!("{side}ToeBase"));
                let direction = bone(&joints, &foot, &toe);
                // A foot that pushes off points down; one that is near the ground points forward.
                assert!(direction.x.abs() < 0.5 && direction.z > -0.4, "{direction}");
                assert!(direction.y < -0.8 || direction.z > 0.55, "{direction}");
                assert!(bone(&joints, "Hips", &foot).y < -0.7);
            }
        }
    }

    #[test]
    fn limbs_that_point_the_wrong_way_at_rest_are_turned_by_half() {
        let mut rest = adult();
        for name in ["LeftLeg", "LeftFoot", "LeftToeBase"] {
            let j = joint_by_name(name).unwrap();
            rest[j] = rest[joint_by_name("LeftUpLeg").unwrap()]
                + DVec3::Y * 0.4 * (j - joint_by_name("LeftUpLeg").unwrap()) as f64;
        }
        let skeleton = PosedSkeleton::new(&rest, &ClipFrame::REST, false);
        let joints = std::array::from_fn(|j| skeleton.joint_m(j, rest[j]));
        assert!(bone(&joints, "LeftUpLeg", "LeftLeg").dot(DVec3::NEG_Y) > 1.0 - 1e-12);
        assert!(bone(&joints, "LeftLeg", "LeftFoot").dot(DVec3::NEG_Y) > 1.0 - 1e-12);
        for tilt in [1e-3, 1e-6, 1e-7, 1e-8, 1e-12, 0.0] {
            let q = shortest_arc(DVec3::new(tilt, 1.0, 0.0), DVec3::NEG_Y);
            assert!((q.length() - 1.0).abs() < 1e-12);
            let turned = q * DVec3::new(tilt, 1.0, 0.0).normalize();
            assert!((turned - DVec3::NEG_Y).length() < 1e-6, "{tilt}: {turned}");
        }
        assert_eq!(shortest_arc(DVec3::ZERO, DVec3::Z), DQuat::IDENTITY);
    }

    #[test]
    fn grounding_puts_the_lowest_vertex_on_the_floor_and_moves_nothing_sideways() {
        let rest = adult();
        let vertices: Vec<_> = (0..JOINT_COUNT)
            .map(|j| {
                let weights = [200, 55, 0, 0];
                (
                    rest[j] + DVec3::splat(0.01),
                    SkinVertex { joints: [j as u8, PARENTS[j], 0, 0], weights },
                )
            })
            .collect();
        let frame = Clips::built_in().get("roll").unwrap().sample(0.4);
        let mut skeleton = PosedSkeleton::new(&rest, &frame, false);
        let before = skeleton.clone();
        let shift = skeleton.ground(vertices.iter().copied());
        let lowest = vertices
            .iter()
            .map(|&(p, s)| pose_vertex(&skeleton.model_from_rest, p, s).y)
            .fold(f64::INFINITY, f64::min);
        assert!(lowest.abs() < 1e-14, "{lowest}");
        for (a, b) in before.model_from_rest.iter().zip(&skeleton.model_from_rest) {
            assert_eq!(a.matrix3, b.matrix3);
            assert_eq!(
                b.translation - a.translation,
                DVec3::new(0.0, b.translation.y - a.translation.y, 0.0)
            );
            assert!((b.translation.y - a.translation.y - shift).abs() < 1e-14);
        }
        assert_eq!(skeleton.ground(std::iter::empty()), 0.0);
    }
}
