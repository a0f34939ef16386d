//! The joint angles that poses are written in, and how far human joints go.
//!
//! All in degrees, zero in the anatomical zero position: upright, arms hanging, palms to the
//! thighs, feet forward. Each angle is positive in the sense of its name; `rotation` is positive
//! inwards, `lean` and `twist` to the person's left. Angles of a limb read alike on both sides.
//! The angles of the shoulder and the hip are those of the arm against the chest and of the thigh
//! against the pelvis, whatever collar bone and lumbar spine add to them; they are taken in the
//! order rotation, abduction, flexion about fixed axes.

/// How far an angle goes, degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Name in pose files; those of limbs go without their side.
    pub name: &'static str,
    /// Lowest and highest that a pose may have.
    pub limits_deg: [f64; 2],
    /// Standard deviation at full variation of a pose.
    pub spread_deg: f64,
}

const fn reach(name: &'static str, low: f64, high: f64, spread_deg: f64) -> Reach {
    Reach { name, limits_deg: [low, high], spread_deg }
}

/// Angles of the trunk, by their place in [`TRUNK`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Trunk {
    SpineFlexion,
    SpineLean,
    SpineTwist,
    HeadFlexion,
    HeadLean,
    HeadTwist,
}

/// Angles of a side, by their place in [`SIDE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Limb {
    ClavicleElevation,
    ClavicleProtraction,
    ShoulderFlexion,
    ShoulderAbduction,
    ShoulderRotation,
    ElbowFlexion,
    ForearmPronation,
    WristFlexion,
    WristDeviation,
    HipFlexion,
    HipAbduction,
    HipRotation,
    KneeFlexion,
    AnkleFlexion,
    AnkleInversion,
    AnkleRotation,
    ToeExtension,
}

/// Number of angles of the trunk.
pub const TRUNK_COUNT: usize = 6;
/// Number of angles of a side.
pub const SIDE_COUNT: usize = 17;

/// Reach of the spine from pelvis to chest and of the head against the chest.
///
/// After American Academy of Orthopaedic Surgeons, "Joint Motion: Method of Measuring and
/// Recording" (1965), and Norkin and White, "Measurement of Joint Motion" (5th ed., 2016), whose
/// means are 80 to 85 forward and 25 back, 35 aside and 45 round for the spine, and 45, 45, 45 and
/// 60 for the neck; about ten degrees beyond, as people differ.
pub const TRUNK: [Reach; TRUNK_COUNT] = [
    reach("spine_flexion", -35.0, 90.0, 5.0),
    reach("spine_lean", -40.0, 40.0, 4.0),
    reach("spine_twist", -50.0, 50.0, 5.0),
    reach("head_flexion", -55.0, 55.0, 8.0),
    reach("head_lean", -45.0, 45.0, 6.0),
    reach("head_twist", -75.0, 75.0, 14.0),
];

/// Reach of a side's joints; sources as for [`TRUNK`], who give for shoulders 180 and -60 of
/// flexion, 180 of abduction, 45 across the chest, 70 to 90 each way of rotation; elbow 0 to 150;
/// forearm 80 each way; wrist 80 and -70, 20 and 30 aside; hip 120 and -30, 45 and -30, 45 each
/// way; knee 0 to 135 or, kneeling, 150; ankle 20, 40 under load, and -50; foot 35 and -20; toes 70.
///
/// A limb reaches farther where joints beyond it help: the shoulder blade lets the arm cross the
/// chest, the pelvis tilts with a thigh that is pulled up and turns with one that is turned out.
pub const SIDE: [Reach; SIDE_COUNT] = [
    reach("clavicle_elevation", -10.0, 45.0, 3.0),
    reach("clavicle_protraction", -25.0, 35.0, 3.0),
    reach("shoulder_flexion", -65.0, 185.0, 10.0),
    reach("shoulder_abduction", -60.0, 185.0, 8.0),
    reach("shoulder_rotation", -100.0, 100.0, 10.0),
    reach("elbow_flexion", -5.0, 155.0, 14.0),
    reach("forearm_pronation", -90.0, 90.0, 12.0),
    reach("wrist_flexion", -80.0, 85.0, 10.0),
    reach("wrist_deviation", -25.0, 40.0, 5.0),
    reach("hip_flexion", -35.0, 135.0, 7.0),
    reach("hip_abduction", -35.0, 65.0, 4.0),
    reach("hip_rotation", -75.0, 55.0, 5.0),
    reach("knee_flexion", -5.0, 160.0, 8.0),
    reach("ankle_flexion", -60.0, 42.0, 5.0),
    reach("ankle_inversion", -25.0, 40.0, 3.0),
    reach("ankle_rotation", -25.0, 25.0, 2.0),
    reach("toe_extension", -40.0, 75.0, 4.0),
];

/// Names of the sides in front of an angle's name; the left comes first everywhere.
pub const SIDE_NAMES: [&str; 2] = ["left", "right"];

/// One of all angles: the trunk's, then the left's, then the right's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Angle(usize);

impl Angle {
    /// All.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..TRUNK_COUNT + 2 * SIDE_COUNT).map(Self)
    }

    /// One of the trunk.
    #[must_use]
    pub const fn of_trunk(angle: Trunk) -> Self {
        Self(angle as usize)
    }

    /// One of a side, 0 left, 1 right.
    #[must_use]
    pub const fn of_side(side: usize, angle: Limb) -> Self {
        Self(TRUNK_COUNT + side * SIDE_COUNT + angle as usize)
    }

    /// 0 for the trunk, 1 left, 2 right; and the place there.
    #[must_use]
    pub const fn place(self) -> (usize, usize) {
        match self.0.checked_sub(TRUNK_COUNT) {
            None => (0, self.0),
            Some(i) => (1 + i / SIDE_COUNT, i % SIDE_COUNT),
        }
    }

    /// How far it goes.
    #[must_use]
    pub const fn reach(self) -> &'static Reach {
        match self.place() {
            (0, i) => &TRUNK[i],
            (_, i) => &SIDE[i],
        }
    }

    /// Its name, with its side: `left_knee_flexion`.
    #[must_use]
    pub fn name(self) -> String {
        match self.place() {
            (0, i) => TRUNK[i].name.to_owned(),
            (side, i) => format!("{}_{}", SIDE_NAMES[side - 1], SIDE[i].name),
        }
    }

    /// The angle of a name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        let (first, names, rest) = match name.split_once('_') {
            Some(("left", rest)) => (TRUNK_COUNT, &SIDE[..], rest),
            Some(("right", rest)) => (TRUNK_COUNT + SIDE_COUNT, &SIDE[..], rest),
            _ => (0, &TRUNK[..], name),
        };
        names.iter().position(|r| r.name == rest).map(|i| Self(first + i))
    }
}

/// A value for each angle, degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Angles {
    /// By [`Trunk`].
    pub trunk_deg: [f64; TRUNK_COUNT],
    /// Left and right, by [`Limb`].
    pub side_deg: [[f64; SIDE_COUNT]; 2],
}

impl Angles {
    /// One of the trunk.
    #[must_use]
    pub const fn trunk(&self, angle: Trunk) -> f64 {
        self.trunk_deg[angle as usize]
    }

    /// One of a side, 0 left, 1 right.
    #[must_use]
    pub const fn limb(&self, side: usize, angle: Limb) -> f64 {
        self.side_deg[side][angle as usize]
    }

    /// Any.
    #[must_use]
    pub const fn get(&self, angle: Angle) -> f64 {
        match angle.place() {
            (0, i) => self.trunk_deg[i],
            (side, i) => self.side_deg[side - 1][i],
        }
    }

    /// Any.
    pub const fn get_mut(&mut self, angle: Angle) -> &mut f64 {
        match angle.place() {
            (0, i) => &mut self.trunk_deg[i],
            (side, i) => &mut self.side_deg[side - 1][i],
        }
    }

    /// In a mirror: left and right change places.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let [left, right] = self.side_deg;
        let mut trunk_deg = self.trunk_deg;
        for angle in [Trunk::SpineLean, Trunk::SpineTwist, Trunk::HeadLean, Trunk::HeadTwist] {
            trunk_deg[angle as usize] *= -1.0;
        }
        Self { trunk_deg, side_deg: [right, left] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_angle_is_found_by_its_name() {
        for angle in Angle::all() {
            assert_eq!(Angle::by_name(&angle.name()), Some(angle), "{}", angle.name());
        }
        for name in ["knee_flexion", "left_spine_flexion", "left", "", "Left_knee_flexion"] {
            assert_eq!(Angle::by_name(name), None, "{name}");
        }
        assert_eq!(Angle::of_side(0, Limb::HipFlexion).name(), "left_hip_flexion");
        assert_eq!(Angle::of_side(1, Limb::ToeExtension).name(), "right_toe_extension");
        assert_eq!(TRUNK[Trunk::HeadTwist as usize].name, "head_twist");
    }

    #[test]
    fn reaches_hold_the_zero_position_and_mirroring_stays_within() {
        for angle in Angle::all() {
            let Reach { limits_deg: [low, high], spread_deg, .. } = *angle.reach();
            assert!(low < 0.0 && high > 0.0 && spread_deg > 0.0, "{}", angle.name());
            assert!(spread_deg < 0.5 * (high - low));
        }
        for (i, reach) in TRUNK.iter().enumerate() {
            let mut angles = Angles::default();
            angles.trunk_deg[i] = reach.limits_deg[0];
            let there = angles.mirrored().trunk_deg[i];
            assert!((reach.limits_deg[0]..=reach.limits_deg[1]).contains(&there));
            assert_eq!(angles.mirrored().mirrored(), angles);
        }
    }
}
