//! The joints of every person: their names, order and parents.
//!
//! Joint numbers are the same in the figure library's skin weights, in posed skeletons and in the
//! draw list's palettes. The names are Mixamo's, without a prefix. Where a joint stands differs
//! from person to person and is not known here.

/// Number of joints.
pub const JOINT_COUNT: usize = 52;

/// Joints of one side; the left ones come first.
const SIDE: usize = 23;
/// First joint of the left side.
const LEFT: usize = 6;

/// Names by joint number.
pub const JOINT_NAMES: [&str; JOINT_COUNT] = [
    "Hips",
    "Spine",
    "Spine1",
    "Spine2",
    "Neck",
    "Head",
    "LeftShoulder",
    "LeftArm",
    "LeftForeArm",
    "LeftHand",
    "LeftHandThumb1",
    "LeftHandThumb2",
    "LeftHandThumb3",
    "LeftHandIndex1",
    "LeftHandIndex2",
    "LeftHandIndex3",
    "LeftHandMiddle1",
    "LeftHandMiddle2",
    "LeftHandMiddle3",
    "LeftHandRing1",
    "LeftHandRing2",
    "LeftHandRing3",
    "LeftHandPinky1",
    "LeftHandPinky2",
    "LeftHandPinky3",
    "LeftUpLeg",
    "LeftLeg",
    "LeftFoot",
    "LeftToeBase",
    "RightShoulder",
    "RightArm",
    "RightForeArm",
    "RightHand",
    "RightHandThumb1",
    "RightHandThumb2",
    "RightHandThumb3",
    "RightHandIndex1",
    "RightHandIndex2",
    "RightHandIndex3",
    "RightHandMiddle1",
    "RightHandMiddle2",
    "RightHandMiddle3",
    "RightHandRing1",
    "RightHandRing2",
    "RightHandRing3",
    "RightHandPinky1",
    "RightHandPinky2",
    "RightHandPinky3",
    "RightUpLeg",
    "RightLeg",
    "RightFoot",
    "RightToeBase",
];

/// Joints of the trunk, by number.
pub mod trunk {
    #![expect(missing_docs, reason = "the names say it")]
    pub const HIPS: usize = 0;
    pub const SPINE: usize = 1;
    pub const SPINE1: usize = 2;
    pub const SPINE2: usize = 3;
    pub const NECK: usize = 4;
    pub const HEAD: usize = 5;
}

/// A joint that is there on both sides, as its number within a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Limb {
    Shoulder = 0,
    Arm = 1,
    ForeArm = 2,
    Hand = 3,
    Thumb1 = 4,
    Index1 = 7,
    Middle1 = 10,
    Ring1 = 13,
    Pinky1 = 16,
    UpLeg = 19,
    Leg = 20,
    Foot = 21,
    ToeBase = 22,
}

/// Left or right of the person.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Side {
    Left,
    Right,
}

impl Side {
    /// Both sides.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// 1 for the left, which is towards +X, and -1 for the right.
    #[must_use]
    pub const fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// Number of a joint on this side.
    #[must_use]
    pub const fn joint(self, limb: Limb) -> usize {
        let first = match self {
            Self::Left => LEFT,
            Self::Right => LEFT + SIDE,
        };
        first + limb as usize
    }
}

/// Parent of each joint; every parent stands before its children, the hips are their own.
pub const PARENTS: [u8; JOINT_COUNT] = {
    let mut parents = [0u8; JOINT_COUNT];
    let mut joint = 1;
    while joint < JOINT_COUNT {
        parents[joint] = if joint < LEFT {
            joint as u8 - 1
        } else {
            let side = joint - (joint - LEFT) % SIDE;
            match (joint - LEFT) % SIDE {
                0 => trunk::SPINE2 as u8,
                // The first segment of each finger.
                4 | 7 | 10 | 13 | 16 => (side + Limb::Hand as usize) as u8,
                19 => trunk::HIPS as u8,
                _ => joint as u8 - 1,
            }
        };
        joint += 1;
    }
    parents
};

/// The same joint on the other side; those in the middle are their own.
#[must_use]
pub const fn mirrored(joint: usize) -> usize {
    if joint < LEFT {
        joint
    } else if joint < LEFT + SIDE {
        joint + SIDE
    } else {
        joint - SIDE
    }
}

/// Number of a joint by name.
#[must_use]
pub fn joint_by_name(name: &str) -> Option<usize> {
    JOINT_NAMES.iter().position(|&n| n == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_come_first_and_are_those_of_the_human_body() {
        assert!((1..JOINT_COUNT).all(|j| usize::from(PARENTS[j]) < j));
        let parent = |name: &str| JOINT_NAMES[usize::from(PARENTS[joint_by_name(name).unwrap()])];
        for (child, expected) in [
            ("Head", "Neck"),
            ("Neck", "Spine2"),
            ("Spine", "Hips"),
            ("LeftShoulder", "Spine2"),
            ("RightShoulder", "Spine2"),
            ("RightForeArm", "RightArm"),
            ("LeftHandThumb1", "LeftHand"),
            ("RightHandPinky1", "RightHand"),
            ("RightHandPinky3", "RightHandPinky2"),
            ("LeftUpLeg", "Hips"),
            ("RightUpLeg", "Hips"),
            ("LeftToeBase", "LeftFoot"),
        ] {
            assert_eq!(parent(child), expected, "{child}");
        }
    }

    #[test]
    fn mirroring_swaps_names_and_keeps_parents() {
        for (joint, name) in JOINT_NAMES.iter().enumerate() {
            let expected = name.strip_prefix("Left").map_or_else(
                || name.strip_prefix("Right").map_or((*name).to_owned(), |n| format!("Left{n}")),
                |n| format!("Right{n}"),
            );
            assert_eq!(JOINT_NAMES[mirrored(joint)], expected);
            assert_eq!(mirrored(mirrored(joint)), joint);
            assert_eq!(
                usize::from(PARENTS[mirrored(joint)]),
                mirrored(usize::from(PARENTS[joint]))
            );
        }
    }

    #[test]
    fn limbs_are_where_their_names_are() {
        for (limb, name) in [
            (Limb::Shoulder, "Shoulder"),
            (Limb::Arm, "Arm"),
            (Limb::ForeArm, "ForeArm"),
            (Limb::Hand, "Hand"),
            (Limb::Thumb1, "HandThumb1"),
            (Limb::Index1, "HandIndex1"),
            (Limb::Middle1, "HandMiddle1"),
            (Limb::Ring1, "HandRing1"),
            (Limb::Pinky1, "HandPinky1"),
            (Limb::UpLeg, "UpLeg"),
            (Limb::Leg, "Leg"),
            (Limb::Foot, "Foot"),
            (Limb::ToeBase, "ToeBase"),
        ] {
            assert_eq!(JOINT_NAMES[Side::Left.joint(limb)], format!("Left{name}"));
            assert_eq!(JOINT_NAMES[Side::Right.joint(limb)], format!("Right{name}"));
        }
    }
}
