//! Keeps arms out of trunks.
//!
//! Poses and clips know one body; on a heavier one their arms would sink into it. The trunk at rest
//! is measured as slices with an elliptic outline, each moving with a joint of the spine, and so are
//! the thighs, each moving with its hip; arms are chains of spheres. An arm that is inside is turned
//! out about its shoulder, as little as that takes.

use glam::{DAffine3, DVec3};

use super::pose::PosedSkeleton;
use super::skeleton::{JOINT_COUNT, Limb, Side, trunk};
use super::stance::turn;
use crate::library::mesh::SkinVertex;

/// Slices from hips to shoulders, and along a thigh.
const SLICES: usize = 12;
/// Free space between arm and trunk, for clothes and for what an ellipse leaves out, metres.
const FREE_M: f64 = 0.008;
/// A vertex belongs to what has so much of its weight, of 255: half, so that none of the hips belongs
/// to nothing.
const MOSTLY: u32 = 128;
/// An arm is turned by no more than this at a time and in all, degrees.
const STEP_DEG: f64 = 12.0;
const STEPS: usize = 20;

/// A level cut through a trunk at rest, model space, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Slice {
    half_width_m: f64,
    half_depth_m: f64,
    center_x_m: f64,
    center_z_m: f64,
}

impl Slice {
    /// Whether nothing was met at its height.
    const fn is_empty(&self) -> bool {
        self.half_width_m <= 0.0
    }
}

/// Slices of a trunk or a thigh at rest, evenly from a height to another.
#[derive(Clone, Debug, PartialEq)]
struct Outline {
    low_m: f64,
    high_m: f64,
    slices: [Slice; SLICES],
}

/// A trunk at rest, from the hips to the shoulders, and both thighs.
#[derive(Clone, Debug, PartialEq)]
pub struct Trunk {
    trunk: Outline,
    /// Left and right.
    thighs: [Outline; 2],
    /// Left and right, from ankle to knee.
    shins: [Outline; 2],
    /// Hips and knees at rest, left and right, with the radii of what is round them.
    balls: [[(DVec3, f64); 2]; 2],
    /// Of elbow and wrist, metres.
    arm_radius_m: [f64; 2],
}

impl Outline {
    /// Measures what moves mostly with some joints between two heights.
    fn new(
        [low_m, high_m]: [f64; 2],
        skin: impl Iterator<Item = (DVec3, SkinVertex)>,
        belongs: impl Fn(usize) -> bool,
    ) -> Self {
        let (mut low, mut high) = ([DVec3::MAX; SLICES], [DVec3::MIN; SLICES]);
        for (p, skin) in skin {
            let weights = skin.joints.iter().zip(&skin.weights);
            let own = weights.filter(|w| belongs(usize::from(*w.0)));
            // The halves of the slices next to a vertex count it, so that none stays empty.
            let place = (p.y - low_m) / (high_m - low_m) * (SLICES - 1) as f64;
            if place < -1.0
                || place > SLICES as f64
                || own.map(|w| u32::from(*w.1)).sum::<u32>() < MOSTLY
            {
                continue;
            }
            for slice in [place.floor(), place.floor() + 1.0] {
                if (0.0..SLICES as f64).contains(&slice) {
                    let i = slice as usize;
                    (low[i], high[i]) = (low[i].min(p), high[i].max(p));
                }
            }
        }
        let slice = |i: usize| {
            if low[i].x > high[i].x {
                return Slice::default();
            }
            let (half, center) = (0.5 * (high[i] - low[i]), 0.5 * (high[i] + low[i]));
            Slice {
                half_width_m: half.x,
                half_depth_m: half.z,
                center_x_m: center.x,
                center_z_m: center.z,
            }
        };
        Self { low_m, high_m, slices: std::array::from_fn(slice) }
    }

    /// The outline at a height, between two slices; nothing above and below.
    fn at(&self, y_m: f64) -> Option<Slice> {
        let place = (y_m - self.low_m) / (self.high_m - self.low_m) * (SLICES - 1) as f64;
        if !(0.0..(SLICES - 1) as f64).contains(&place) {
            return None;
        }
        let (i, t) = (place as usize, place.fract());
        let (a, b) = match (self.slices[i], self.slices[i + 1]) {
            (a, b) if a.is_empty() && b.is_empty() => return None,
            (a, b) if a.is_empty() => (b, b),
            (a, b) if b.is_empty() => (a, a),
            both => both,
        };
        let mix = |a: f64, b: f64| a + (b - a) * t;
        Some(Slice {
            half_width_m: mix(a.half_width_m, b.half_width_m),
            half_depth_m: mix(a.half_depth_m, b.half_depth_m),
            center_x_m: mix(a.center_x_m, b.center_x_m),
            center_z_m: mix(a.center_z_m, b.center_z_m),
        })
    }

    /// Distance of a point from the outline at rest, negative inside, and the unit way out.
    fn distance(&self, point_m: DVec3) -> Option<(f64, DVec3)> {
        let slice = self.at(point_m.y)?;
        let (a, b) = (slice.half_width_m, slice.half_depth_m);
        let (x, z) = (point_m.x - slice.center_x_m, point_m.z - slice.center_z_m);
        let out = DVec3::new(x / (a * a), 0.0, z / (b * b));
        let length = out.length();
        if length < 1e-6 {
            return None;
        }
        // As below.
        let root = ((x / a) * (x / a) + (z / b) * (z / b)).sqrt();
        Some(((root - 1.0) * root / length, out / length))
    }

    /// A ball in the outline at a height.
    fn ball(&self, joint_m: DVec3, y_m: f64) -> (DVec3, f64) {
        self.at(y_m).map_or((joint_m, 0.0), |slice| {
            let center_m = DVec3::new(slice.center_x_m, joint_m.y, slice.center_z_m);
            (center_m, slice.half_width_m.min(slice.half_depth_m))
        })
    }

    /// How far a sphere is inside at rest, and the way out; model space, metres.
    fn depth(&self, center_m: DVec3, radius_m: f64) -> Option<(f64, DVec3)> {
        let slice = self.at(center_m.y)?;
        let (a, b) = (slice.half_width_m + radius_m, slice.half_depth_m + radius_m);
        let (x, z) = (center_m.x - slice.center_x_m, center_m.z - slice.center_z_m);
        let inside = (x / a) * (x / a) + (z / b) * (z / b);
        if inside >= 1.0 || a <= 0.0 || b <= 0.0 {
            return None;
        }
        let out = DVec3::new(x / (a * a), 0.0, z / (b * b));
        if out.length_squared() < 1e-12 {
            return None;
        }
        // To first order the distance to an ellipse is (1 - f) / |grad f|, with f the root of the
        // quadratic form.
        let root = inside.sqrt();
        let depth_m = (1.0 - root) * root / out.length();
        Some((depth_m, out.normalize()))
    }
}

impl Trunk {
    /// Measures a trunk by its skin's vertices at rest.
    pub(super) fn new(
        heads_m: &[DVec3; JOINT_COUNT],
        skin: impl Iterator<Item = (DVec3, SkinVertex)> + Clone,
        arm_radius_m: [f64; 2],
    ) -> Self {
        let hip_m = heads_m[Side::Left.joint(Limb::UpLeg)].y;
        let armpit_m = heads_m[Side::Left.joint(Limb::Arm)].y;
        let heights = [hip_m, hip_m + 1.05 * (armpit_m - hip_m)];
        let thigh = |side: Side| {
            let (hip, knee) = (side.joint(Limb::UpLeg), side.joint(Limb::Leg));
            let (hip_m, knee_m) = (heads_m[hip].y, heads_m[knee].y);
            let heights = [knee_m + 0.15 * (hip_m - knee_m), hip_m];
            Outline::new(heights, skin.clone(), |joint| joint == hip)
        };
        let shin = |side: Side| {
            let (knee, ankle) = (side.joint(Limb::Leg), side.joint(Limb::Foot));
            Outline::new([heads_m[ankle].y, heads_m[knee].y], skin.clone(), |joint| joint == knee)
        };
        let (thighs, shins) = (Side::BOTH.map(thigh), Side::BOTH.map(shin));
        let balls = Side::BOTH.map(|side| {
            let thigh = &thighs[side as usize];
            let [hip_m, knee_m] = [Limb::UpLeg, Limb::Leg].map(|limb| heads_m[side.joint(limb)]);
            [
                thigh.ball(hip_m, thigh.high_m - 0.05 * (thigh.high_m - thigh.low_m)),
                thigh.ball(knee_m, thigh.low_m),
            ]
        });
        Self {
            thighs,
            shins,
            balls,
            // Above their joints the thighs are the widest part of the hips.
            trunk: Outline::new(heights, skin, |joint| {
                joint <= trunk::SPINE2 || Side::BOTH.iter().any(|s| s.joint(Limb::UpLeg) == joint)
            }),
            arm_radius_m,
        }
    }

    /// The middle of the chest at the height of the armpits at rest, and half its depth, metres.
    pub(super) fn chest_m(&self) -> (DVec3, f64) {
        let Outline { high_m, slices, .. } = &self.trunk;
        let top = slices.iter().rev().find(|slice| !slice.is_empty()).copied().unwrap_or_default();
        (DVec3::new(0.0, *high_m, top.center_z_m), top.half_depth_m)
    }

    /// Trunk and legs of a posed skeleton, for what hangs round the hips.
    #[must_use]
    pub fn solids(&self, skeleton: &PosedSkeleton) -> Solids<'_> {
        self.solids_with(skeleton, &[trunk::HIPS, trunk::SPINE1])
    }

    /// The same for what hangs over the chest.
    #[must_use]
    pub fn upper_solids(&self, skeleton: &PosedSkeleton) -> Solids<'_> {
        self.solids_with(skeleton, &[trunk::SPINE2])
    }

    /// The trunk stands once for each of some joints of the spine.
    fn solids_with(&self, skeleton: &PosedSkeleton, spine: &[usize]) -> Solids<'_> {
        let bones = &skeleton.model_from_rest;
        let outline = |outline, joint: usize| (outline, bones[joint], bones[joint].inverse());
        let of = |side: Side, limb: Limb| side.joint(limb);
        let [left, right] = Side::BOTH;
        let legs = [
            outline(&self.thighs[0], of(left, Limb::UpLeg)),
            outline(&self.thighs[1], of(right, Limb::UpLeg)),
            outline(&self.shins[0], of(left, Limb::Leg)),
            outline(&self.shins[1], of(right, Limb::Leg)),
        ];
        let trunks = spine.iter().map(|joint| outline(&self.trunk, *joint));
        let outlines = legs.into_iter().chain(trunks).collect();
        let balls = Side::BOTH.map(|side| {
            let [hip, knee] = self.balls[side as usize];
            let thigh = bones[of(side, Limb::UpLeg)];
            // Between the trunk and the thigh, and between thigh and shin.
            let middle = |p: DVec3, other: DAffine3| {
                (thigh.transform_point3(p) + other.transform_point3(p)) * 0.5
            };
            [
                (middle(hip.0, bones[trunk::HIPS]), hip.1),
                (middle(knee.0, bones[of(side, Limb::Leg)]), knee.1),
            ]
        });
        Solids { outlines, balls }
    }

    /// Turns both arms of a posed skeleton out of the trunk.
    pub fn push_arms_out(&self, heads_m: &[DVec3; JOINT_COUNT], skeleton: &mut PosedSkeleton) {
        for side in Side::BOTH {
            for _ in 0..STEPS {
                let Some((depth_m, at_m, out)) = self.deepest(heads_m, skeleton, side) else {
                    break;
                };
                let shoulder_m =
                    skeleton.joint_m(side.joint(Limb::Arm), heads_m[side.joint(Limb::Arm)]);
                let lever = at_m - shoulder_m;
                let axis = lever.cross(out);
                let arm_m = axis.length();
                if arm_m < 1e-6 {
                    break;
                }
                let deg = libm::atan2(depth_m, arm_m).to_degrees().min(STEP_DEG);
                let turn = turn(axis / arm_m, deg);
                let about = DAffine3::from_translation(shoulder_m)
                    * DAffine3::from_quat(turn)
                    * DAffine3::from_translation(-shoulder_m);
                for joint in side.joint(Limb::Arm)..side.joint(Limb::UpLeg) {
                    skeleton.model_from_rest[joint] = about * skeleton.model_from_rest[joint];
                }
            }
        }
    }

    /// The sphere of an arm that is deepest inside: how deep, where, and the way out.
    fn deepest(
        &self,
        heads_m: &[DVec3; JOINT_COUNT],
        skeleton: &PosedSkeleton,
        side: Side,
    ) -> Option<(f64, DVec3, DVec3)> {
        let at = |limb: Limb| {
            let joint = side.joint(limb);
            skeleton.joint_m(joint, heads_m[joint])
        };
        let [elbow_m, wrist_m, knuckle_m] = [Limb::ForeArm, Limb::Hand, Limb::Middle1].map(at);
        let [elbow_r, wrist_r] = self.arm_radius_m;
        let fingers = [Limb::Thumb1, Limb::Index1, Limb::Middle1, Limb::Ring1, Limb::Pinky1];
        let mut spheres = [(DVec3::ZERO, 0.0); 6 + 5];
        for (i, sphere) in spheres.iter_mut().enumerate() {
            let t = i as f64 / 4.0;
            *sphere = match i {
                0..=4 => (elbow_m.lerp(wrist_m, t), elbow_r + (wrist_r - elbow_r) * t),
                // The hand is as thick as a third of the wrist's width.
                5 => (wrist_m.lerp(knuckle_m, 0.8), wrist_r * 0.6),
                _ => {
                    // The last segment of a finger is about as long as the one before.
                    let last = side.joint(fingers[i - 6]) + 2;
                    let of = |joint: usize| skeleton.joint_m(joint, heads_m[joint]);
                    (of(last) * 2.0 - of(last - 1), wrist_r * 0.3)
                }
            };
        }
        let mut worst: Option<(f64, DVec3, DVec3)> = None;
        for (center_m, radius_m) in spheres {
            let thighs = Side::BOTH.into_iter().zip(&self.thighs);
            let solids = thighs
                .map(|(side, thigh)| (side.joint(Limb::UpLeg), thigh))
                .chain([(self.nearest(heads_m, skeleton, center_m), &self.trunk)]);
            for (joint, outline) in solids {
                let model_from_rest = &skeleton.model_from_rest[joint];
                let in_rest = model_from_rest.inverse().transform_point3(center_m);
                let Some((depth_m, out)) = outline.depth(in_rest, radius_m + FREE_M) else {
                    continue;
                };
                if depth_m > 1e-4 && worst.is_none_or(|w| depth_m > w.0) {
                    worst = Some((depth_m, center_m, model_from_rest.transform_vector3(out)));
                }
            }
        }
        worst
    }

    /// The joint of the trunk that moves the slice next to a point.
    fn nearest(
        &self,
        heads_m: &[DVec3; JOINT_COUNT],
        skeleton: &PosedSkeleton,
        point_m: DVec3,
    ) -> usize {
        let middle = |joint: usize| {
            let next = if joint == trunk::SPINE2 { trunk::NECK } else { joint + 1 };
            let rest_m = (heads_m[joint] + heads_m[next]) * 0.5;
            skeleton.joint_m(joint, rest_m).distance_squared(point_m)
        };
        let mut best = trunk::HIPS;
        for joint in trunk::SPINE..=trunk::SPINE2 {
            if middle(joint) < middle(best) {
                best = joint;
            }
        }
        best
    }
}

/// Trunk and legs of a posed body.
pub struct Solids<'a> {
    /// With the joint that moves each, and its inverse.
    outlines: Vec<(&'a Outline, DAffine3, DAffine3)>,
    /// Centre and radius of hips and knees, left and right.
    balls: [[(DVec3, f64); 2]; 2],
}

impl Solids<'_> {
    /// Distance of a point from the nearest of them, negative inside; model space, metres.
    #[must_use]
    pub fn distance_m(&self, point_m: DVec3) -> f64 {
        self.nearest(point_m).map_or(f64::MAX, |n| n.0)
    }

    /// How a point has to move for a distance; model space, metres.
    #[must_use]
    pub fn way_out_m(&self, point_m: DVec3, clear_m: f64) -> DVec3 {
        match self.nearest(point_m) {
            Some((distance_m, out)) if distance_m < clear_m => out * (clear_m - distance_m),
            _ => DVec3::ZERO,
        }
    }

    fn nearest(&self, point_m: DVec3) -> Option<(f64, DVec3)> {
        let outlines = self.outlines.iter().filter_map(|(outline, model_from_rest, inverse)| {
            let (distance_m, out) = outline.distance(inverse.transform_point3(point_m))?;
            Some((distance_m, model_from_rest.transform_vector3(out)))
        });
        let balls = self.balls.iter().flatten().filter(|ball| ball.1 > 0.0).map(|ball| {
            let way = point_m - ball.0;
            let length = way.length().max(1e-9);
            (length - ball.1, way / length)
        });
        outlines.chain(balls).min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::pose::tests::{adult, flip};
    use crate::geometry::skeleton::{PARENTS, mirrored};
    use crate::geometry::stance::Stance;
    use crate::library::pose::Poses;

    /// An upright elliptic cylinder in place of a trunk.
    fn cylinder(half_width_m: f64, half_depth_m: f64) -> Trunk {
        let skin = SkinVertex { joints: [0, 2, 3, 0], weights: [55, 100, 100, 0] };
        let points = (0..6000).map(|i| {
            let (phi, y) = (f64::from(i % 60) * 0.1047, f64::from(i / 60) * 0.007 - 0.1);
            let (sin, cos) = (libm::sin(phi), libm::cos(phi));
            (DVec3::new(half_width_m * sin, y, 0.02 + half_depth_m * cos), skin)
        });
        Trunk::new(&adult(), points, [0.05, 0.03])
    }

    fn posed(pose: &str) -> PosedSkeleton {
        let pose = Poses::built_in().get(pose).unwrap();
        PosedSkeleton::of_stance(&adult(), &Stance::of_pose(pose))
    }

    fn deepest_m(trunk: &Trunk, skeleton: &PosedSkeleton) -> f64 {
        let depth = |side| trunk.deepest(&adult(), skeleton, side).map_or(0.0, |d| d.0);
        Side::BOTH.map(depth).into_iter().fold(0.0, f64::max)
    }

    #[test]
    fn the_distance_to_the_outline_is_right_along_the_axes() {
        let trunk = cylinder(0.2, 0.15);
        for (at, depth_m) in [
            (DVec3::new(0.21, 0.2, 0.02), 0.02),
            (DVec3::new(0.0, 0.2, 0.02 + 0.15), 0.03),
            (DVec3::new(0.0, 0.2, 0.02 - 0.15), 0.03),
        ] {
            let (found_m, out) = trunk.trunk.depth(at, 0.03).unwrap();
            assert!((found_m - depth_m).abs() < 0.003, "{at} {found_m}");
            assert!(out.dot(at - DVec3::new(0.0, 0.2, 0.02)) > 0.0);
        }
        assert!(trunk.trunk.depth(DVec3::new(0.24, 0.2, 0.02), 0.03).is_none());
        assert!(trunk.trunk.depth(DVec3::new(0.0, 0.9, 0.0), 0.03).is_none());
    }

    #[test]
    fn arms_leave_a_heavy_trunk_and_stay_where_they_are_on_a_slim_one() {
        let rest = adult();
        for pose in ["pose/standing_at_ease", "pose/standing_hands_clasped", "pose/arms_crossed"] {
            let before = posed(pose);
            let mut slim = before.clone();
            cylinder(0.08, 0.05).push_arms_out(&rest, &mut slim);
            assert_eq!(slim, before, "{pose}");

            let heavy = cylinder(0.21, 0.2);
            let mut pushed = before.clone();
            heavy.push_arms_out(&rest, &mut pushed);
            let (was_m, is_m) = (deepest_m(&heavy, &before), deepest_m(&heavy, &pushed));
            assert!(was_m > 0.015 && is_m < 0.004, "{pose} {was_m} {is_m}");
            for joint in 0..JOINT_COUNT {
                let parent = usize::from(PARENTS[joint]);
                let gap = pushed
                    .joint_m(parent, rest[joint])
                    .distance(pushed.joint_m(joint, rest[joint]));
                assert!(gap < 1e-12, "{pose} {joint}");
            }
        }
    }

    #[test]
    fn left_and_right_are_pushed_alike() {
        let (rest, trunk) = (adult(), cylinder(0.21, 0.18));
        let mut skeleton = posed("pose/standing_at_ease");
        trunk.push_arms_out(&rest, &mut skeleton);
        for joint in 0..JOINT_COUNT {
            let other = mirrored(joint);
            let gap = skeleton
                .joint_m(joint, rest[joint])
                .distance(flip(skeleton.joint_m(other, rest[other])));
            // Of two spheres that are as deep rounding chooses one, and the ways out differ a little.
            assert!(gap < 1e-6, "{joint} {gap}");
        }
    }
}
