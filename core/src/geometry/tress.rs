//! Hair that hangs.
//!
//! Hair that follows the head stands off it in everybody who bends over or lies, and goes through
//! shoulders that rise. So hanging hair is moved by joints of its own: chains of links, each a row
//! of points from the head down. For every pose the links turn with the head and then, step by step,
//! to where weight takes them, out of head, trunk, legs and arms: position-based dynamics (Müller,
//! Heidelberger, Hennix and Ratcliff, "Position based dynamics", Journal of Visual Communication and
//! Image Representation 18, 2007). Standing straight they are as at rest. Rest and posed skeletons
//! flow in, transforms flow out; styles are not known here.

use glam::{DAffine3, DQuat, DVec3, Vec3};

use super::body::RestBody;
use super::pose::PosedSkeleton;
use super::skeleton::{Limb, Side, trunk};
use super::sway::CLOTH_JOINT_COUNT;
use crate::library::mesh::SkinVertex;

/// Links of a chain.
pub(super) const LINKS: usize = 4;
/// Most chains that hang from a head.
pub(super) const CHAINS: usize = 8;
/// Most joints of somebody's hair. They are numbered after those of [`super::sway`].
pub(super) const TRESS_JOINT_COUNT: usize = LINKS * CHAINS;

/// Steps, and the share of the way to where weight takes it that a link turns at each.
const STEPS: usize = 14;
const PULL: f64 = 0.3;
/// Hair keeps the distance from each part of the body that it has at rest, but no more than this,
/// metres: from the trunk, which clothes are over, from the head, from neck and shoulders, and from
/// arms.
const TRUNK_CLEAR_M: f64 = 0.06;
const HEAD_CLEAR_M: f64 = 0.04;
const NECK_CLEAR_M: f64 = 0.035;
const ARM_CLEAR_M: f64 = 0.015;
/// Cosines of the tilt of head or chest up to which hair is aslant as at rest, and from which on it
/// hangs plumb.
const PLUMB: [f64; 2] = [0.94, 0.60];
/// How much of where it would go with the head is left even so: nape hair does not fall over the
/// forehead.
const STIFF: f64 = 0.25;
/// Of the way that it slides on the trunk, so much is added to that distance, and at most so much,
/// metres.
const SLID: f64 = 0.3;
const SLID_M: f64 = 0.02;
/// The same where it does not hang down but lies on the back.
const LIES_M: f64 = 0.014;
/// The same over the ground.
const FLOOR_M: f64 = 0.01;
/// What is beside a link turns with it by no more than this, beyond what weight turns it, radians.
const FARTHEST_RAD: f64 = 0.9;
/// How far weight turns each link from where it would go with the head: it is stiff at its root.
const YIELDS: [f64; LINKS] = [0.55, 0.85, 0.95, 1.0];
/// How far a link goes with the chest's direction rather than with the head's.
const CHEST: [f64; LINKS] = [0.0, 0.15, 0.4, 0.6];

/// A part of the body, as a sphere that is swept along a line from one radius to another: its two
/// ends at rest, each with the joint that moves it.
type Part = [(DVec3, usize, f64); 2];
const PARTS: usize = 11;
/// First come those of the upper back, then of the head, then neck and shoulders, then the arms.
const BACK: usize = 2;
const HEAD: usize = 4;
const ARMS: usize = 7;

/// The points of a chain, the first of which goes with the head.
type Points<T> = [T; LINKS + 1];

/// Chains of links over hair at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Tresses {
    /// Model space, metres; from the person's left over the back to the right.
    chains: Vec<Points<DVec3>>,
    /// Distance that each point keeps from trunk and legs, and from each part.
    clear_m: Vec<Points<(f64, [f64; PARTS])>>,
    parts: [Part; PARTS],
    /// How far it yields to weight: 1 all the way, 0 not at all.
    yields: f64,
}

impl Tresses {
    /// Chains over hair that yields to weight by a share; `scale` is that of the head, and `head` its
    /// places from template coordinates.
    pub(super) fn new(
        chains: &[Points<Vec3>],
        body: &RestBody,
        (head, scale): (&dyn Fn(Vec3) -> Vec3, f32),
        yields: f64,
    ) -> Self {
        let parts = parts(body, head, f64::from(scale));
        let solids = body.trunk.upper_solids(&PosedSkeleton::REST);
        let posed = posed(&parts, &PosedSkeleton::REST);
        let clear = |p: &DVec3| {
            let most = |i: usize| match i {
                0..BACK => TRUNK_CLEAR_M,
                BACK..HEAD => HEAD_CLEAR_M,
                HEAD..ARMS => NECK_CLEAR_M,
                _ => ARM_CLEAR_M,
            };
            let own = std::array::from_fn(|i| distance(&posed[i], *p).0.min(most(i)));
            (solids.distance_m(*p).min(TRUNK_CLEAR_M), own)
        };
        let chains: Vec<Points<DVec3>> =
            chains.iter().map(|chain| chain.map(|p| p.as_dvec3())).collect();
        let clear_m = chains.iter().map(|chain| chain.each_ref().map(clear)).collect();
        Self { chains, clear_m, parts, yields }
    }

    /// How many joints they add.
    pub(super) fn joint_count(&self) -> usize {
        LINKS * self.chains.len()
    }

    /// Between which chains a lock hangs: where, of its points, the one next to the middle of the
    /// chains is.
    pub(super) fn column(&self, lock: &[Vec3]) -> f32 {
        const MIDDLE: usize = LINKS / 2;
        let chain = |k: usize| self.chains[k][MIDDLE].as_vec3();
        let near = |p: Vec3| {
            let between = |k: usize| {
                let (a, b) = (chain(k), chain((k + 1).min(self.chains.len() - 1)));
                let way = b - a;
                let t = ((p - a).dot(way) / way.length_squared().max(1e-9)).clamp(0.0, 1.0);
                ((a + way * t).distance_squared(p), k as f32 + t)
            };
            (0..self.chains.len()).map(between).min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let found = lock.iter().filter_map(|p| near(*p)).min_by(|a, b| a.0.total_cmp(&b.0));
        found.map_or(0.0, |found| found.1)
    }

    /// Joints and weights of a place on a lock.
    pub(super) fn weights(&self, column: f32, p: Vec3) -> SkinVertex {
        let last = self.chains.len() - 1;
        let k = (column as usize).min(last);
        let next = (k + 1).min(last);
        let s = f64::from((column - k as f32).clamp(0.0, 1.0));
        let height = |row: usize| {
            let [a, b] = [k, next].map(|k| self.chains[k][row].y);
            a + (b - a) * s
        };
        let y = f64::from(p.y);
        let row = (0..LINKS - 1).find(|row| height(row + 1) <= y).unwrap_or(LINKS - 1);
        let (upper, lower) = (height(row), height(row + 1));
        let t = ((upper - y) / (upper - lower).max(1e-6)).clamp(0.0, 1.0);
        let joint = |k: usize, row: usize| match row {
            0 => trunk::HEAD as u8,
            row => (CLOTH_JOINT_COUNT + k * LINKS + row - 1) as u8,
        };
        let joints = [joint(k, row), joint(next, row), joint(k, row + 1), joint(next, row + 1)];
        let shares = [(1.0 - t) * (1.0 - s), (1.0 - t) * s, t * (1.0 - s), t * s];
        SkinVertex::of_shares(joints, shares)
    }

    /// Where their joints go, as [`PosedSkeleton::model_from_rest`] has it for the others; `down` is
    /// the unit direction of weight in model space.
    #[must_use]
    pub fn joints(&self, skeleton: &PosedSkeleton, body: &RestBody, down: DVec3) -> Vec<DAffine3> {
        let solids = body.trunk.upper_solids(skeleton);
        let parts = posed(&self.parts, skeleton);
        let [head, chest] =
            [trunk::HEAD, trunk::SPINE2].map(|joint| skeleton.model_from_rest[joint]);
        let chest_from_model = chest.inverse();
        let yields = YIELDS.map(|share| share * self.yields);
        let (turns, plumb) = (turns(skeleton, down, &yields), plumb(skeleton, down) * self.yields);
        let mut out = Vec::with_capacity(self.joint_count());
        for (rest_m, clear_m) in self.chains.iter().zip(&self.clear_m) {
            let ways: [DVec3; LINKS] = std::array::from_fn(|i| {
                let way = turns[i] * (rest_m[i + 1] - rest_m[i]);
                let length = way.length();
                let stiff = head.transform_vector3(rest_m[i + 1] - rest_m[i]);
                let hung = way.lerp(down * length, plumb * yields[i]) + stiff * (STIFF * plumb);
                hung.try_normalize().map_or(way, |hung| hung * length)
            });
            let mut points_m = rest_m.map(|p| head.transform_point3(p));
            for _ in 0..STEPS {
                for i in 1..=LINKS {
                    let (of_trunk_m, of_parts_m) = &clear_m[i];
                    let way = points_m[i] - points_m[i - 1];
                    let mut p = points_m[i - 1] + way.lerp(ways[i - 1], PULL);
                    // Where it has slid to, its distance at rest tells less.
                    let slid_m = chest_from_model.transform_point3(p).distance(rest_m[i]);
                    let more_m = (SLID * slid_m).min(SLID_M) + LIES_M * plumb;
                    p += solids.way_out_m(p, of_trunk_m + more_m);
                    for (part, (ends, clear_m)) in parts.iter().zip(of_parts_m).enumerate() {
                        let (distance_m, out) = distance(ends, p);
                        let clear_m = clear_m + if part < BACK { LIES_M * plumb } else { 0.0 };
                        if distance_m < clear_m {
                            let inwards = -chest_from_model.transform_point3(p).x.signum();
                            // It gathers between the arms rather than on them.
                            let aside = if part < ARMS {
                                DVec3::ZERO
                            } else {
                                chest.matrix3.x_axis * inwards
                            };
                            p += (out + aside).normalize_or(out) * (clear_m - distance_m);
                        }
                    }
                    // Whoever stands or lies does so on the plane y = 0.
                    if down.y < -0.9 {
                        p.y = p.y.max(FLOOR_M);
                    }
                    let way = (p - points_m[i - 1]).try_normalize();
                    let way = way.map_or(ways[i - 1], |way| way * ways[i - 1].length());
                    points_m[i] = points_m[i - 1] + way;
                }
            }
            out.extend((1..=LINKS).map(|i| {
                let from = turns[i - 1] * (rest_m[i] - rest_m[i - 1]);
                let way = points_m[i] - points_m[i - 1];
                // Locks lie beside their chain: they would be flung out by a link that is bent back.
                let angle = from.angle_between(way).min(FARTHEST_RAD);
                let axis = from.cross(way).try_normalize().unwrap_or(DVec3::X);
                let turn = DQuat::from_axis_angle(axis, angle) * turns[i - 1];
                DAffine3::from_rotation_translation(turn, points_m[i] - turn * rest_m[i])
            }));
        }
        out
    }
}

/// How each link turns from rest if nothing is in its way.
fn turns(skeleton: &PosedSkeleton, down: DVec3, yields: &[f64; LINKS]) -> [DQuat; LINKS] {
    let turn = |joint: usize| DQuat::from_mat3(&skeleton.model_from_rest[joint].matrix3);
    let [head, chest] = [trunk::HEAD, trunk::SPINE2].map(turn);
    std::array::from_fn(|i| {
        let hangs = |turn: DQuat| upright(turn, down, yields[i]) * turn;
        hangs(head).slerp(hangs(chest), CHEST[i] * yields[i])
    })
}

/// How far links hang plumb rather than aslant as at rest, where they lie on shoulders and back that
/// are no longer there: 0 while head and chest are upright .. 1 where one of them is not.
fn plumb(skeleton: &PosedSkeleton, down: DVec3) -> f64 {
    let cosine = |joint: usize| -skeleton.model_from_rest[joint].matrix3.y_axis.dot(down);
    let tilt = [trunk::HEAD, trunk::SPINE2].map(cosine).into_iter().fold(1.0, f64::min);
    let [upright, tilted] = PLUMB;
    ((upright - tilt) / (upright - tilted)).clamp(0.0, 1.0)
}

/// What takes the downward direction of something turned so far to that of weight, or a share of the
/// way there.
fn upright(turn: DQuat, down: DVec3, share: f64) -> DQuat {
    let own = turn * DVec3::NEG_Y;
    let angle = own.angle_between(down);
    // Whoever stands on the hands: as if nodding.
    let axis = own.cross(down).try_normalize().filter(|_| angle < 3.1);
    DQuat::from_axis_angle(axis.unwrap_or(turn * DVec3::X), angle * share)
}

/// What hair lies on beside trunk and legs: upper back, skull, jaw, neck, shoulders and arms.
fn parts(body: &RestBody, head: &dyn Fn(Vec3) -> Vec3, scale: f64) -> [Part; PARTS] {
    /// Places on the template and radii.
    const SKULL: [(Vec3, f64); 2] =
        [(Vec3::new(0.0, 0.775, -0.022), 0.076), (Vec3::new(0.0, 0.775, 0.040), 0.072)];
    const JAW: [(Vec3, f64); 2] =
        [(Vec3::new(0.0, 0.735, 0.050), 0.062), (Vec3::new(0.0, 0.685, 0.055), 0.048)];
    const NECK_M: f64 = 0.054;
    const TRAPEZIUS_M: f64 = 0.040;
    /// How far from the middle a shoulder blade lies, below and above.
    const BLADE_X: [f64; 2] = [0.060, 0.035];
    /// Of COCO's keypoints.
    const SHOULDER: usize = 5;
    let of_head =
        |ends: [(Vec3, f64); 2]| ends.map(|(p, r)| (head(p).as_dvec3(), trunk::HEAD, r * scale));
    let at = |joint: usize, radius_m: f64| (body.heads_m[joint], joint, radius_m);
    let radius_m = |keypoint: usize| body.keypoints.get(keypoint).map_or(0.04, |k| k.radius_m);
    let [shoulder_m, elbow_m, wrist_m] = [SHOULDER, SHOULDER + 2, SHOULDER + 4].map(radius_m);
    let neck = at(trunk::NECK, NECK_M * scale);
    // From the armpits to the neck, where outlines of the trunk end.
    let (chest_m, depth_m) = body.trunk.chest_m();
    let back = Side::BOTH.map(|side| {
        let aside = |x: f64| DVec3::X * (side.sign() * x * scale);
        let low = (chest_m + aside(BLADE_X[0]), trunk::SPINE2, 0.9 * depth_m);
        [low, (neck.0 + aside(BLADE_X[1]), trunk::SPINE2, NECK_M * scale)]
    });
    let [left, right] = Side::BOTH.map(|side| {
        let arm = at(side.joint(Limb::Arm), shoulder_m.min(0.065));
        let fore = at(side.joint(Limb::ForeArm), elbow_m);
        let shoulder = (arm.0, side.joint(Limb::Shoulder), TRAPEZIUS_M * scale);
        let root = (neck.0, trunk::SPINE2, TRAPEZIUS_M * scale);
        [[root, shoulder], [arm, fore], [fore, at(side.joint(Limb::Hand), wrist_m)]]
    });
    let neck = [neck, at(trunk::HEAD, NECK_M * scale)];
    let [a, b, c] = left;
    let [d, e, f] = right;
    [back[0], back[1], of_head(SKULL), of_head(JAW), neck, a, d, b, c, e, f]
}

/// Ends and radii of the parts in a pose.
fn posed(parts: &[Part; PARTS], skeleton: &PosedSkeleton) -> [[(DVec3, f64); 2]; PARTS] {
    let end = |(p, joint, radius_m): (DVec3, usize, f64)| (skeleton.joint_m(joint, p), radius_m);
    parts.map(|part| part.map(end))
}

/// Distance of a point from a part, negative inside, and the unit way out.
fn distance([(a, a_m), (b, b_m)]: &[(DVec3, f64); 2], p: DVec3) -> (f64, DVec3) {
    let way = *b - *a;
    let t = ((p - *a).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
    let out = p - (*a + way * t);
    let length = out.length().max(1e-9);
    (length - (a_m + (b_m - a_m) * t), out / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::body::rest_body;
    use crate::geometry::phenotype::tests::average;
    use crate::geometry::stance::Stance;
    use crate::library::figure::Figure;
    use crate::library::pose::Poses;
    use crate::scene::Sex;

    /// Three chains down the back and one before each shoulder.
    fn hair(body: &RestBody) -> Tresses {
        let head = body.heads_m[trunk::HEAD].as_vec3();
        let chain = |x: f32, z: f32| {
            std::array::from_fn(|i| head + Vec3::new(x, 0.03 - 0.08 * i as f32, z))
        };
        let chains = [
            chain(0.08, 0.10),
            chain(0.06, -0.14),
            chain(0.0, -0.15),
            chain(-0.06, -0.14),
            chain(-0.08, 0.10),
        ];
        Tresses::new(&chains, body, (&|p| p, 1.0), 1.0)
    }

    fn body() -> RestBody {
        let figure = Figure::built_in().unwrap();
        rest_body(&figure, &average(Sex::Female), &[]).unwrap()
    }

    fn ends_m(hair: &Tresses, joints: &[DAffine3]) -> Vec<DVec3> {
        let end = |k: usize| joints[k * LINKS + LINKS - 1].transform_point3(hair.chains[k][LINKS]);
        (0..hair.chains.len()).map(end).collect()
    }

    #[test]
    fn standing_straight_it_is_as_at_rest() {
        let body = body();
        let hair = hair(&body);
        let joints = hair.joints(&PosedSkeleton::REST, &body, DVec3::NEG_Y);
        assert_eq!(joints.len(), hair.joint_count());
        for joint in joints {
            assert!(joint.abs_diff_eq(DAffine3::IDENTITY, 1e-9), "{joint}");
        }
    }

    #[test]
    fn it_hangs_down_keeps_its_length_and_stays_out_of_the_body() {
        let body = body();
        let hair = hair(&body);
        let poses = [
            ("bending_down", true),
            ("stretching_overhead", false),
            ("plank", true),
            ("handstand", true),
        ];
        for (pose, bends) in poses {
            let pose = format!("pose/{pose}");
            let stance = Stance::of_pose(Poses::built_in().get(&pose).unwrap());
            let skeleton = PosedSkeleton::of_stance(&body.heads_m, &stance);
            let joints = hair.joints(&skeleton, &body, DVec3::NEG_Y);
            let head = skeleton.model_from_rest[trunk::HEAD];
            let parts = posed(&hair.parts, &skeleton);
            let mut sunk_m = 0.0_f64;
            for (k, end) in ends_m(&hair, &joints).into_iter().enumerate() {
                let stiff = head.transform_point3(hair.chains[k][LINKS]);
                // What lies on the back keeps its distance.
                assert!(end.y < stiff.y + 0.08, "{pose} {k}: {end} {stiff}");
                sunk_m = sunk_m.max(stiff.y - end.y);
                for i in 1..=LINKS {
                    let at = |i: usize| match i {
                        0 => head.transform_point3(hair.chains[k][0]),
                        i => joints[k * LINKS + i - 1].transform_point3(hair.chains[k][i]),
                    };
                    let rest_m = hair.chains[k][i].distance(hair.chains[k][i - 1]);
                    assert!((at(i).distance(at(i - 1)) - rest_m).abs() < 1e-9, "{pose} {k} {i}");
                    for (part, clear_m) in parts.iter().zip(hair.clear_m[k][i].1) {
                        let deep_m = clear_m.min(0.0) - distance(part, at(i)).0;
                        assert!(deep_m < 0.02, "{pose} {k} {i}: {deep_m}");
                    }
                }
            }
            assert!(bends == (sunk_m > 0.1), "{pose}: {sunk_m}");
        }
    }

    #[test]
    fn weights_are_of_the_links_round_a_place_and_sum_up() {
        let body = body();
        let hair = hair(&body);
        for (k, i) in [(0, 1), (2, 3), (4, LINKS)] {
            let p = hair.chains[k][i].as_vec3();
            let lock = hair.chains[k].map(|p| p.as_vec3());
            assert!((hair.column(&lock) - k as f32).abs() < 1e-3);
            let skin = hair.weights(k as f32, p);
            assert_eq!(skin.weights.iter().map(|w| u32::from(*w)).sum::<u32>(), 255);
            let own = CLOTH_JOINT_COUNT + k * LINKS + i - 1;
            let found = skin.joints.iter().zip(skin.weights).find(|j| usize::from(*j.0) == own);
            assert!(found.is_some_and(|j| j.1 > 250), "{k} {i} {skin:?}");
        }
        let above = hair.chains[2][0].as_vec3() + Vec3::Y * 0.1;
        let skin = hair.weights(2.0, above);
        assert_eq!((usize::from(skin.joints[0]), skin.weights[0]), (trunk::HEAD, 255));
    }
}
