//! What a body is to do: the turn of its pelvis and the angles of all its joints.
//!
//! Poses say it in angles; frames of clips are taken apart into them. In that form stances blend,
//! vary and turn their heads without leaving what joints can do. Where a person's joints then go
//! is decided in [`super::pose`].

use glam::{DMat3, DQuat, DVec3};

use super::skeleton::Side;
use crate::library::clip::{ClipFrame, SourceBody};
use crate::library::pose::angle::{Angle, Angles, Limb, Reach, SIDE, TRUNK, Trunk};
use crate::library::pose::{Foot, Freedom, Pose};
use crate::scene::HandShape;

/// Up to here an arm rises without its collar bone, degrees from hanging; beyond, the collar bone
/// takes this share (the rhythm of Inman, Saunders and Abbott, "Observations on the function of
/// the shoulder joint", 1944, of which about half falls to the collar bone).
const COLLAR_FROM_DEG: f64 = 30.0;
const COLLAR_SHARE: f64 = 0.17;

/// The turn of a pelvis, the angles of all joints, hands and feet.
#[derive(Clone, Debug, PartialEq)]
pub struct Stance {
    /// Of the pelvis, model space from upright, a unit quaternion.
    pub root: DQuat,
    /// Of the joints.
    pub angles: Angles,
    /// Left and right.
    pub hands: [HandShape; 2],
    /// Left and right.
    pub feet: [Foot; 2],
    /// Whether the body tilts until it rests on the ground.
    pub rests: bool,
    freedom: Freedom,
}

impl Stance {
    /// Of a pose.
    #[must_use]
    pub fn of_pose(pose: &Pose) -> Self {
        let root = pose.root_deg;
        let root =
            turn(DVec3::Y, root.turn) * turn(DVec3::X, root.pitch) * turn(DVec3::NEG_Z, root.roll);
        let mut angles = pose.angles;
        for side in 0..2 {
            let arm = ball(BallJoint::Shoulder(side), &angles) * DVec3::NEG_Y;
            let raised_deg = libm::acos(-arm.y.clamp(-1.0, 1.0)).to_degrees();
            let collar = Limb::ClavicleElevation as usize;
            let [low, high] = SIDE[collar].limits_deg;
            let lifted = (raised_deg - COLLAR_FROM_DEG).max(0.0) * COLLAR_SHARE;
            let angle = &mut angles.side_deg[side][collar];
            *angle = (*angle + lifted).clamp(low, high);
        }
        let (hands, feet, freedom) = (pose.hands, pose.feet, pose.freedom);
        Self { root: root.normalize(), angles, hands, feet, rests: pose.rests, freedom }
    }

    /// Of a frame of a clip, whose collar bones, wrists and toes stay at rest.
    #[must_use]
    pub fn of_clip(frame: &ClipFrame) -> Self {
        use SourceBody as B;
        let mut angles = Angles::default();
        let root = frame.get(B::Root);
        let from = |parent: B, child: B| frame.get(parent).inverse() * frame.get(child);
        set_ball(BallJoint::Spine, &mut angles, part(from(B::Root, B::Chest), 1.0 / 3.0));
        set_ball(BallJoint::Head, &mut angles, part(from(B::Chest, B::Neck), 0.5));
        for (side, bodies) in [
            [B::LeftShoulder, B::LeftElbow, B::LeftHip, B::LeftKnee, B::LeftAnkle],
            [B::RightShoulder, B::RightElbow, B::RightHip, B::RightKnee, B::RightAnkle],
        ]
        .into_iter()
        .enumerate()
        {
            let [shoulder, elbow, hip, knee, ankle] = bodies;
            set_ball(BallJoint::Shoulder(side), &mut angles, from(B::Chest, shoulder));
            set_ball(BallJoint::Hip(side), &mut angles, from(B::Root, hip));
            set_ball(BallJoint::Ankle(side), &mut angles, from(knee, ankle));
            let hinge = |parent, child| euler_xzy(from(parent, child))[0].to_degrees();
            angles.side_deg[side][Limb::ElbowFlexion as usize] = -hinge(shoulder, elbow);
            angles.side_deg[side][Limb::KneeFlexion as usize] = hinge(hip, knee);
        }
        Self {
            root,
            angles,
            hands: [HandShape::Relaxed; 2],
            feet: [Foot::Free; 2],
            rests: false,
            freedom: Freedom::default(),
        }
    }

    /// On the way from this to another one, 0..1. Joints that turn about several axes go the
    /// shorter way, and none farther than its limits or, where a clip has left them, than that.
    #[must_use]
    pub fn blended(&self, other: &Self, share: f64) -> Self {
        let (a, b) = (&self.angles, &other.angles);
        let mut angles = Angles::default();
        for angle in Angle::all() {
            *angles.get_mut(angle) = a.get(angle) + (b.get(angle) - a.get(angle)) * share;
        }
        for joint in BallJoint::ALL {
            set_ball(joint, &mut angles, ball(joint, a).slerp(ball(joint, b), share).normalize());
        }
        for angle in Angle::all() {
            let (low, high) = (a.get(angle).min(b.get(angle)), a.get(angle).max(b.get(angle)));
            stop(angles.get_mut(angle), angle.reach(), low, high);
        }
        let nearer = if share < 0.5 { self } else { other };
        let feet = [0, 1].map(|side| {
            if self.feet[side] == other.feet[side] { self.feet[side] } else { Foot::Free }
        });
        Self {
            root: self.root.slerp(other.root, share).normalize(),
            angles,
            hands: nearer.hands,
            feet,
            rests: self.rests && other.rests,
            freedom: nearer.freedom,
        }
    }

    /// The same with degrees added to some angles by name, as far as the pose is free and the
    /// joints go. Unknown names are passed over.
    #[must_use]
    pub fn varied(mut self, by_deg: &[(String, f64)]) -> Self {
        for (name, deg) in by_deg {
            if let Some(angle) = Angle::by_name(name) {
                let share = match angle.place() {
                    (0, _) => self.freedom.trunk,
                    (_, limb) if limb < Limb::HipFlexion as usize => self.freedom.arms,
                    _ => self.freedom.legs,
                };
                self.add(angle, deg * share);
            }
        }
        self
    }

    /// The same with the head turned to the left and up, degrees, as far as it goes.
    #[must_use]
    pub fn looking(mut self, [left_deg, up_deg]: [f64; 2]) -> Self {
        for (angle, deg) in [(Trunk::HeadTwist, left_deg), (Trunk::HeadFlexion, -up_deg)] {
            let place = angle as usize;
            let from = self.angles.trunk_deg[place];
            let to = &mut self.angles.trunk_deg[place];
            *to += deg;
            stop(to, &TRUNK[place], from, from);
        }
        self
    }

    fn add(&mut self, angle: Angle, deg: f64) {
        let from = self.angles.get(angle);
        let to = self.angles.get_mut(angle);
        *to += deg;
        stop(to, angle.reach(), from, from);
    }

    /// In a mirror: left and right change places.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let q = self.root;
        let ([left, right], [left_foot, right_foot]) = (self.hands, self.feet);
        Self {
            root: DQuat::from_xyzw(q.x, -q.y, -q.z, q.w),
            angles: self.angles.mirrored(),
            hands: [right, left],
            feet: [right_foot, left_foot],
            rests: self.rests,
            freedom: self.freedom,
        }
    }

    /// Rotation of a joint against the body before it.
    #[must_use]
    pub fn joint(&self, joint: BallJoint) -> DQuat {
        ball(joint, &self.angles)
    }

    /// An angle of one side, degrees.
    #[must_use]
    pub const fn limb(&self, side: Side, angle: Limb) -> f64 {
        self.angles.limb(side as usize, angle)
    }
}

/// Keeps an angle within its limits, or where it was before if that is beyond them.
const fn stop(angle: &mut f64, reach: &Reach, low: f64, high: f64) {
    *angle = angle.clamp(reach.limits_deg[0].min(low), reach.limits_deg[1].max(high));
}

/// A joint that turns about three axes; the side is 0 for the left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BallJoint {
    /// A third of the spine.
    Spine,
    /// Half of the neck.
    Head,
    /// The arm against the chest.
    Shoulder(usize),
    /// The thigh against the pelvis.
    Hip(usize),
    /// The foot against the shank.
    Ankle(usize),
}

impl BallJoint {
    /// All.
    pub const ALL: [Self; 8] = [
        Self::Spine,
        Self::Head,
        Self::Shoulder(0),
        Self::Shoulder(1),
        Self::Hip(0),
        Self::Hip(1),
        Self::Ankle(0),
        Self::Ankle(1),
    ];

    /// The joint's angles about x, z and y with their sense and how many such joints share them.
    fn angles(self) -> ([Angle; 3], [f64; 3]) {
        use Limb as L;
        let trunk =
            |all: [Trunk; 3], parts: f64| (all.map(Angle::of_trunk), [parts, -parts, parts]);
        let limb = |side: usize, all: [L; 3], forward: f64| {
            let out = if side == 0 { 1.0 } else { -1.0 };
            (all.map(|l| Angle::of_side(side, l)), [forward, out, -out])
        };
        match self {
            Self::Spine => trunk([Trunk::SpineFlexion, Trunk::SpineLean, Trunk::SpineTwist], 3.0),
            Self::Head => trunk([Trunk::HeadFlexion, Trunk::HeadLean, Trunk::HeadTwist], 2.0),
            Self::Shoulder(side) => {
                limb(side, [L::ShoulderFlexion, L::ShoulderAbduction, L::ShoulderRotation], -1.0)
            }
            Self::Hip(side) => limb(side, [L::HipFlexion, L::HipAbduction, L::HipRotation], -1.0),
            Self::Ankle(side) => {
                let (angles, [x, z, y]) =
                    limb(side, [L::AnkleFlexion, L::AnkleInversion, L::AnkleRotation], -1.0);
                (angles, [x, -z, y])
            }
        }
    }
}

/// Rotation of a joint: its rotation first, then its abduction, then its flexion.
fn ball(joint: BallJoint, angles: &Angles) -> DQuat {
    let (names, parts) = joint.angles();
    let [x, z, y] = [0, 1, 2].map(|i| angles.get(names[i]) / parts[i]);
    (turn(DVec3::X, x) * turn(DVec3::Z, z) * turn(DVec3::Y, y)).normalize()
}

/// Sets a joint's angles to those of a rotation; of the two triples that give it, to the one that
/// is less beyond the joint's limits, or smaller.
pub(super) fn set_ball(joint: BallJoint, angles: &mut Angles, rotation: DQuat) {
    let (names, parts) = joint.angles();
    let [x, z, y] = euler_xzy(rotation).map(f64::to_degrees);
    let triples = [[x, z, y], [x + 180.0, 180.0 - z, y + 180.0]].map(|triple| {
        [0, 1, 2].map(|i| {
            // Of all turns the one nearest to the middle of the limits.
            let [low, high] = names[i].reach().limits_deg;
            let middle = 0.5 * (low + high);
            let whole = 360.0 * parts[i].abs();
            let deg = triple[i] * parts[i];
            deg - whole * ((deg - middle) / whole).round()
        })
    });
    let beyond = |triple: &[f64; 3]| -> f64 {
        let excess = |(deg, name): (&f64, &Angle)| {
            let [low, high] = name.reach().limits_deg;
            (low - deg).max(deg - high).max(0.0)
        };
        triple.iter().zip(&names).map(excess).sum()
    };
    let size = |triple: &[f64; 3]| triple.iter().map(|deg| deg.abs()).sum::<f64>();
    let [first, second] = triples;
    let better = (beyond(&second), size(&second)) < (beyond(&first), size(&first));
    let best = if better { second } else { first };
    for (name, deg) in names.into_iter().zip(best) {
        *angles.get_mut(name) = deg;
    }
}

/// A share of a rotation.
fn part(rotation: DQuat, share: f64) -> DQuat {
    DQuat::IDENTITY.slerp(rotation, share).normalize()
}

/// Rotation about a unit axis, degrees.
pub(super) fn turn(axis: DVec3, deg: f64) -> DQuat {
    let half = deg.to_radians() * 0.5;
    let (sin, cos) = (libm::sin(half), libm::cos(half));
    DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
}

/// Angles x, z, y in radians with `R = Rx * Rz * Ry`, z within a quarter turn.
pub(super) fn euler_xzy(rotation: DQuat) -> [f64; 3] {
    let m = DMat3::from_quat(rotation);
    let z = libm::asin((-m.y_axis.x).clamp(-1.0, 1.0));
    if m.y_axis.x.abs() > 1.0 - 1e-12 {
        // Only the sum of the other two is known: all of it goes to the first.
        return [libm::atan2(-m.z_axis.y, m.z_axis.z), z, 0.0];
    }
    [libm::atan2(m.y_axis.z, m.y_axis.y), z, libm::atan2(m.z_axis.x, m.x_axis.x)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Draws, Key};
    use crate::geometry::pose::PosedSkeleton;
    use crate::geometry::pose::tests::{adult, flip};
    use crate::geometry::skeleton::{JOINT_COUNT, JOINT_NAMES, PARENTS, mirrored};
    use crate::library::clip::Clips;
    use crate::library::pose::Poses;

    fn poses() -> impl Iterator<Item = (&'static Pose, Stance)> {
        Poses::built_in().all().iter().map(|p| (p, Stance::of_pose(p)))
    }

    /// Degrees by which the worst angle lies beyond its limits.
    fn excess_deg(angles: &Angles) -> f64 {
        let beyond = |angle: Angle| {
            let [low, high] = angle.reach().limits_deg;
            (low - angles.get(angle)).max(angles.get(angle) - high)
        };
        Angle::all().map(beyond).fold(0.0, f64::max)
    }

    /// Up to three times as far as the sampler goes.
    fn offsets(draw: u32) -> Vec<(String, f64)> {
        let uniform = |i: usize| {
            Draws::new(5, draw).of(Key::new("offset"), 0).lane(i as u16).uniform() * 2.0 - 1.0
        };
        let one = |(i, a): (usize, Angle)| (a.name(), uniform(i) * 7.5 * a.reach().spread_deg);
        Angle::all().enumerate().map(one).collect()
    }

    #[test]
    fn every_pose_is_rigid_and_whole_on_every_side() {
        let rest = adult();
        for (pose, stance) in poses() {
            assert!(excess_deg(&stance.angles) <= 0.0, "{}", pose.id);
            for stance in [stance.mirrored(), stance] {
                let skeleton = PosedSkeleton::of_stance(&rest, &stance);
                for (joint, m) in skeleton.model_from_rest.iter().enumerate() {
                    let gram = m.matrix3.transpose() * m.matrix3;
                    assert!(gram.abs_diff_eq(DMat3::IDENTITY, 1e-12), "{}", JOINT_NAMES[joint]);
                    assert!((m.matrix3.determinant() - 1.0).abs() < 1e-12);
                    let parent = usize::from(PARENTS[joint]);
                    let by_parent = skeleton.joint_m(parent, rest[joint]);
                    let gap = by_parent.distance(skeleton.joint_m(joint, rest[joint]));
                    assert!(gap < 1e-12, "{} {}", pose.id, JOINT_NAMES[joint]);
                }
            }
        }
    }

    #[test]
    fn mirrored_poses_are_reflections() {
        let rest = adult();
        for (pose, stance) in poses() {
            let stance = stance.varied(&offsets(3)).looking([20.0, 5.0]);
            let plain = PosedSkeleton::of_stance(&rest, &stance);
            let mirror = PosedSkeleton::of_stance(&rest, &stance.mirrored());
            for joint in 0..JOINT_COUNT {
                let there = mirror.joint_m(joint, rest[joint]);
                let other = mirrored(joint);
                let gap = there.distance(flip(plain.joint_m(other, rest[other])));
                assert!(gap < 1e-9, "{} {} {gap}", pose.id, JOINT_NAMES[joint]);
            }
            assert_eq!(stance.mirrored().mirrored(), stance);
        }
    }

    #[test]
    fn variation_and_gaze_stay_within_human_reach() {
        let all: Vec<Stance> = poses().map(|p| p.1).collect();
        let mut moved = 0;
        for draw in 0..1000 {
            let stance = &all[draw as usize % all.len()];
            let varied = stance.clone().varied(&offsets(draw)).looking([300.0, -200.0]);
            assert!(excess_deg(&varied.angles) <= 0.0, "{draw}");
            moved += usize::from(varied.angles != stance.angles);
            assert_eq!(varied.angles.trunk(Trunk::HeadTwist), 75.0);
            assert_eq!(varied.angles.trunk(Trunk::HeadFlexion), 55.0);
        }
        assert_eq!(moved, 1000);
        // Of a clip that leaves the limits itself no angle goes farther out.
        for clip in Clips::built_in().all() {
            for (i, frame) in clip.frames().iter().enumerate().step_by(5) {
                let stance = Stance::of_clip(frame);
                let varied = stance.clone().varied(&offsets(i as u32));
                assert!(excess_deg(&varied.angles) <= excess_deg(&stance.angles), "{}", clip.id);
            }
        }
    }

    #[test]
    fn freedom_bounds_the_variation_of_a_part() {
        let mut stance = poses().next().unwrap().1;
        stance.angles = Angles::default();
        stance.freedom = Freedom { trunk: 0.0, arms: 0.5, legs: 1.0 };
        let by = ["head_twist", "left_elbow_flexion", "right_knee_flexion", "tail"];
        let by: Vec<_> = by.map(|name| (name.to_owned(), 8.0)).to_vec();
        let varied = stance.varied(&by);
        assert_eq!(varied.angles.trunk(Trunk::HeadTwist), 0.0);
        assert_eq!(varied.angles.limb(0, Limb::ElbowFlexion), 4.0);
        assert_eq!(varied.angles.limb(1, Limb::KneeFlexion), 8.0);
    }

    #[test]
    fn blending_begins_with_one_ends_with_the_other_and_breaks_no_joint() {
        let all: Vec<(&Pose, Stance)> = poses().collect();
        // Different angles may be the same rotation.
        let close = |a: &Angles, b: &Angles| {
            let near = |joint: &BallJoint| ball(*joint, a).dot(ball(*joint, b)).abs() > 1.0 - 1e-12;
            let knee =
                |side| (a.limb(side, Limb::KneeFlexion) - b.limb(side, Limb::KneeFlexion)).abs();
            BallJoint::ALL.iter().all(near) && knee(0) < 1e-9 && knee(1) < 1e-9
        };
        for (i, (pose, a)) in all.iter().enumerate() {
            let b = &all[(i * 7 + 3) % all.len()].1;
            for share in [0.1, 0.5, 0.77] {
                assert!(excess_deg(&a.blended(b, share).angles) <= 0.0, "{} {share}", pose.id);
            }
            assert!(close(&a.blended(b, 0.0).angles, &a.angles), "{}", pose.id);
            assert!(close(&a.blended(b, 1.0).angles, &b.angles), "{}", pose.id);
        }
    }

    #[test]
    fn a_clip_taken_apart_is_the_clip() {
        let rest = adult();
        let mut worst: (f64, &str, usize) = (0.0, "", 0);
        for clip in Clips::built_in().all() {
            for frame in clip.frames() {
                let plain = PosedSkeleton::new(&rest, frame, false);
                let again = PosedSkeleton::of_stance(&rest, &Stance::of_clip(frame));
                for (joint, &at_m) in rest.iter().enumerate() {
                    let gap = plain.joint_m(joint, at_m).distance(again.joint_m(joint, at_m));
                    if gap > worst.0 {
                        worst = (gap, &clip.id, joint);
                    }
                }
            }
        }
        // Elbows and knees of the clips turn a little about other axes than the hinge.
        assert!(worst.0 < 0.01, "{worst:?} {}", JOINT_NAMES[worst.2]);
    }

    #[test]
    fn planted_feet_share_one_ground_and_are_level_however_the_body_varies() {
        let rest = adult();
        let mut uneven = 0;
        let planted: Vec<_> = poses().filter(|(p, _)| p.feet == [Foot::Planted; 2]).collect();
        for draw in 0..500 {
            let (pose, stance) = &planted[draw as usize % planted.len()];
            let by: Vec<_> = offsets(draw).into_iter().map(|(n, d)| (n, d / 7.5)).collect();
            let skeleton = PosedSkeleton::of_stance(&rest, &stance.clone().varied(&by));
            let y = |joint: usize| skeleton.joint_m(joint, rest[joint]).y;
            let [left, right] =
                Side::BOTH.map(|s| y(s.joint(crate::geometry::skeleton::Limb::Foot)));
            let same = (left - right).abs() < 0.002;
            uneven += usize::from(!same);
            assert!((left - right).abs() < 0.12, "{} {left} {right}", pose.id);
        }
        // A leg that would leave its limits stays where it is.
        assert!(uneven <= 25, "{uneven} of 500");
    }

    #[test]
    fn angles_turn_limbs_the_way_their_names_say() {
        let rest = adult();
        let joints = |name: &str, deg: f64| {
            let mut stance = poses().next().unwrap().1;
            (stance.root, stance.angles) = (DQuat::IDENTITY, Angles::default());
            stance.feet = [Foot::Free; 2];
            *stance.angles.get_mut(Angle::by_name(name).unwrap()) = deg;
            let skeleton = PosedSkeleton::of_stance(&rest, &stance);
            move |joint: &str| {
                let joint = JOINT_NAMES.iter().position(|n| *n == joint).unwrap();
                skeleton.joint_m(joint, adult()[joint])
            }
        };
        // What moves, and where to: x is to the left, y up, z forward.
        for (name, joint, way) in [
            ("spine_flexion", "Head", DVec3::Z),
            ("spine_lean", "Head", DVec3::X),
            ("head_lean", "Head", DVec3::X),
            ("left_shoulder_flexion", "LeftHand", DVec3::Z),
            ("left_shoulder_abduction", "LeftHand", DVec3::X),
            ("right_shoulder_abduction", "RightHand", DVec3::NEG_X),
            ("left_elbow_flexion", "LeftHand", DVec3::Z),
            ("left_wrist_flexion", "LeftHandMiddle2", DVec3::NEG_X),
            ("right_wrist_flexion", "RightHandMiddle2", DVec3::X),
            ("left_clavicle_elevation", "LeftArm", DVec3::Y),
            ("right_clavicle_protraction", "RightArm", DVec3::Z),
            ("left_hip_flexion", "LeftFoot", DVec3::Z),
            ("right_hip_abduction", "RightFoot", DVec3::NEG_X),
            ("right_knee_flexion", "RightFoot", DVec3::NEG_Z),
            ("left_ankle_flexion", "LeftToeBase", DVec3::Y),
            ("left_hip_rotation", "LeftToeBase", DVec3::NEG_X),
            ("right_hip_rotation", "RightToeBase", DVec3::X),
            ("right_ankle_rotation", "RightToeBase", DVec3::X),
            ("spine_twist", "RightArm", DVec3::Z),
            ("left_forearm_pronation", "LeftHandThumb2", DVec3::NEG_X),
            ("right_shoulder_rotation", "RightHandThumb2", DVec3::X),
        ] {
            let moved = joints(name, 20.0)(joint) - joints(name, 0.0)(joint);
            assert!(
                moved.dot(way) > 0.5 * moved.length() && moved.length() > 0.002,
                "{name} {moved}"
            );
        }
    }
}
