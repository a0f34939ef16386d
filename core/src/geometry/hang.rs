//! Cloth that hangs round both legs: skirts.
//!
//! No fixed weights of a leg's joints let a skirt hang. So its vertices are moved by joints of its
//! own, a net of points over the cloth. For every pose the points start where the legs' joints would
//! take them, and a few steps of position-based dynamics (Müller, Heidelberger, Hennix and Ratcliff,
//! "Position based dynamics", Journal of Visual Communication and Image Representation 18, 2007)
//! let them sink, keep the cloth's lengths, and push them out of trunk and legs. Each joint turns as
//! the net does round its point. Rest and posed skeletons flow in, transforms flow out; the cloth's
//! cut is not known here.

use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::body::RestBody;
use super::pose::PosedSkeleton;
use super::seat::SeatBlock;
use super::skeleton::{JOINT_COUNT, Limb, Side, trunk as spine};
use super::sway::CLOTH_JOINT_COUNT;
use super::tress::TRESS_JOINT_COUNT;
use super::trunk::Trunk;
use crate::library::mesh::SkinVertex;

/// Rows of the net from the upper edge to the hem, and columns round the legs.
pub(super) const ROWS: usize = 7;
pub(super) const COLUMNS: usize = 24;
/// Joints are numbered in eight bits.
const _: () = assert!(CLOTH_JOINT_COUNT + TRESS_JOINT_COUNT + ROWS * COLUMNS <= 256);

/// Steps, and how far the points sink in the first of them, metres.
const STEPS: usize = 18;
const SINK_M: f64 = 0.035;
/// Cloth is stretched and pressed together by no more than this round the legs, and downwards.
const ROUND: [f64; 2] = [0.95, 1.03];
const DOWN: [f64; 2] = [0.92, 1.01];
/// How much of its neighbours' way each point goes at each step: cloth does not crumple.
const SMOOTH: f64 = 0.35;
/// Cloth that touches skin goes so much less far at each step.
const FRICTION: f64 = 0.75;
/// Cloth comes no nearer than this to what is under it, metres.
const NEAR_M: f64 = 0.026;
/// How much farther out than it started it goes for that, metres: with straight hips, and more where
/// they are bent by a right angle.
const OUT_M: [f64; 2] = [0.008, 0.016];
/// Least and most distance from the outlines of trunk and legs, metres; between them it is that of
/// what is under the cloth at rest.
const CLEAR_M: [f64; 2] = [0.004, 0.05];
/// The same over the ground.
const FLOOR_M: f64 = 0.012;
/// The same over a seat.
const SEAT_M: f64 = 0.008;
/// How much more where hips are bent by a right angle, for what outlines leave out of them.
const BENT_M: f64 = 0.010;
/// No point goes farther than this at a step, which is less than a leg is thick.
const FARTHEST_M: f64 = 0.035;
/// Steps out of trunk and legs before anything sinks.
const FIRST_STEPS: usize = 2;
/// Cloth that is stretched so many times, and more than it was before it sank, is torn and stays
/// where it started. Of the poses looked at those that are whole came to 3.3 at most, the torn ones
/// to 4.9 and more.
const TORN: f64 = 3.6;
/// So far below its upper edge the cloth goes its own way, metres, after going with the body down to
/// [`FIXED_M`] or to so far below where other cloth lies over it.
const LOOSENS_M: f32 = 0.10;
const FIXED_M: f32 = 0.14;
const UNDER_M: f32 = 0.03;

/// A net over cloth at rest, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Hang {
    /// Number of its first joint.
    first: usize,
    /// Model space.
    points_m: Vec<DVec3>,
    /// What would move the points if the cloth had no weight: the skeleton's joints and those
    /// of [`super::sway`].
    start: Vec<SkinVertex>,
    /// How far below its upper edge the cloth goes with the body, metres.
    fixed_m: f32,
    /// 0 where it does, 1 where it hangs.
    free: Vec<f64>,
    /// Wanted distance from the outlines of trunk and legs.
    clear_m: Vec<f64>,
    /// How far the cloth may sink inwards from where it starts until it meets what is under it;
    /// negative where it is too near.
    deep_m: Vec<f64>,
}

impl Hang {
    /// A net of points with what would move them, and how far each is from what is under it, metres;
    /// other cloth lies over it down to a height. Its joints are numbered from `first` on.
    pub(super) fn new(
        points: &[Vec3],
        gaps_m: &[f32],
        start: Vec<SkinVertex>,
        (trunk, covered_y): (&Trunk, Option<f32>),
        first: usize,
    ) -> Self {
        let rest = trunk.solids(&PosedSkeleton::REST);
        let points_m: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
        let [least, most] = CLEAR_M;
        let clear = |(p, gap_m): (&DVec3, &f32)| {
            (rest.distance_m(*p) - f64::from(*gap_m) + NEAR_M).clamp(least, most)
        };
        let clear_m = points_m.iter().zip(gaps_m).map(clear).collect();
        let fixed_m = covered_y.map_or(FIXED_M, |y| FIXED_M.max(points[0].y - y + UNDER_M));
        let free = |i: usize| {
            let below_m = points[i % COLUMNS].y - points[i].y;
            f64::from(((below_m - fixed_m) / LOOSENS_M).clamp(0.0, 1.0))
        };
        let free: Vec<f64> = (0..points.len()).map(free).collect();
        let deep_m = gaps_m.iter().map(|gap_m| f64::from(*gap_m) - NEAR_M).collect();
        Self { first, fixed_m, free, points_m, start, clear_m, deep_m }
    }

    /// Whether a place in a column is so high that the cloth lies on the hips there.
    pub(super) fn is_fixed(&self, p: Vec3, turn: f32) -> bool {
        let column = (turn.rem_euclid(1.0) * COLUMNS as f32 + 0.5) as usize % COLUMNS;
        self.points_m[column].y - f64::from(p.y) < f64::from(self.fixed_m)
    }

    /// Joints and weights of a point of cloth near the net.
    pub(super) fn weights(&self, p: Vec3, turn: f32) -> SkinVertex {
        let column = turn.rem_euclid(1.0) * COLUMNS as f32;
        let (k, s) = (column as usize % COLUMNS, f64::from(column.fract()));
        let next = (k + 1) % COLUMNS;
        let height = |row: usize| {
            let at = |k: usize| self.points_m[row * COLUMNS + k].y;
            at(k) + (at(next) - at(k)) * s
        };
        let y = f64::from(p.y);
        let row = (0..ROWS - 2).find(|row| height(row + 1) <= y).unwrap_or(ROWS - 2);
        let (upper, lower) = (height(row), height(row + 1));
        let t = ((upper - y) / (upper - lower).max(1e-6)).clamp(0.0, 1.0);
        let (a, b) = (row * COLUMNS, (row + 1) * COLUMNS);
        let joints = [a + k, a + next, b + k, b + next].map(|i| (self.first + i) as u8);
        let shares = [(1.0 - t) * (1.0 - s), (1.0 - t) * s, t * (1.0 - s), t * s];
        SkinVertex::of_shares(joints, shares)
    }

    /// Where its joints go, as [`PosedSkeleton::model_from_rest`] has it for the others and `cloth` for
    /// those of [`super::sway`]; `down` is the unit direction of weight in model space, and `seat`
    /// what the person sits on.
    #[must_use]
    pub fn joints(
        &self,
        skeleton: &PosedSkeleton,
        (body, cloth): (&RestBody, &[DAffine3; 4]),
        (down, seat): (DVec3, Option<&SeatBlock>),
    ) -> Vec<DAffine3> {
        let solids = body.trunk.solids(skeleton);
        let start_m = self.started(skeleton, cloth);
        let outwards: Vec<Option<DVec3>> =
            (0..start_m.len()).map(|i| frame(&start_m, i).map(|f| f.y_axis)).collect();
        let mut points_m = start_m.clone();
        let bend = bend(skeleton);
        let (more_m, out_m) = (BENT_M * bend, OUT_M[0] + OUT_M[1] * bend);
        let push_out = |points_m: &mut [DVec3], last_m: &[DVec3]| {
            for (i, p) in points_m.iter_mut().enumerate().skip(COLUMNS) {
                let clear_m = self.clear_m[i] + more_m;
                if solids.way_out_m(*p, clear_m) != DVec3::ZERO {
                    *p += (last_m[i] - *p) * FRICTION;
                    *p += solids.way_out_m(*p, clear_m) * (2.0 * self.free[i]).min(1.0);
                }
            }
        };
        let mut last_m = points_m.clone();
        for _ in 0..FIRST_STEPS {
            push_out(&mut points_m, &last_m);
            last_m.copy_from_slice(&points_m);
        }
        let before_m = points_m.clone();
        for step in 0..STEPS {
            last_m.copy_from_slice(&points_m);
            let sink = down * (SINK_M * (1.0 - step as f64 / STEPS as f64));
            self.smooth(&mut points_m, &before_m, sink);
            self.keep_round(&mut points_m);
            self.keep_down(&mut points_m);
            for (p, last_m) in points_m.iter_mut().zip(&last_m) {
                *p = *last_m + (*p - *last_m).clamp_length_max(FARTHEST_M);
            }
            push_out(&mut points_m, &last_m);
            // What was under the cloth where it started is there still.
            for (i, p) in points_m.iter_mut().enumerate() {
                if let Some(out) = outwards[i] {
                    let deep_m = self.deep_m[i].max(-out_m * self.free[i]);
                    *p += out * (-deep_m - (*p - start_m[i]).dot(out)).max(0.0);
                }
            }
            if let Some(seat) = seat {
                for (p, free) in points_m.iter_mut().zip(&self.free) {
                    *p += seat.way_out_m(*p, SEAT_M) * *free;
                }
            }
            // Whoever stands or lies does so on the plane y = 0.
            if down.y < -0.9 {
                points_m.iter_mut().for_each(|p| p.y = p.y.max(FLOOR_M));
            }
        }
        // Whoever hugs the knees holds cloth that these steps let slip off both sides of them.
        let stretch = self.stretch(&points_m);
        if stretch > TORN && stretch > self.stretch(&start_m) {
            points_m = start_m;
        }
        self.turned(&points_m, skeleton)
    }

    /// Where skinning would take the points.
    fn started(&self, skeleton: &PosedSkeleton, cloth: &[DAffine3; 4]) -> Vec<DVec3> {
        let mut all = [DAffine3::IDENTITY; CLOTH_JOINT_COUNT];
        all[..JOINT_COUNT].copy_from_slice(&skeleton.model_from_rest);
        all[JOINT_COUNT..].copy_from_slice(cloth);
        let moved = |(p, s): (&DVec3, &SkinVertex)| {
            let shares = s.joints.iter().zip(&s.weights).filter(|w| *w.1 > 0);
            let by = |(joint, weight): (&u8, &u8)| {
                all[usize::from(*joint)].transform_point3(*p) * (f64::from(*weight) / 255.0)
            };
            shares.map(by).sum()
        };
        self.points_m.iter().zip(&self.start).map(moved).collect()
    }

    /// Lets the points sink, and evens out how far neighbours went since `before_m`.
    fn smooth(&self, points_m: &mut [DVec3], before_m: &[DVec3], sink: DVec3) {
        let gone: Vec<DVec3> = points_m.iter().zip(before_m).map(|(p, b)| *p - *b).collect();
        for row in 0..ROWS {
            for k in 0..COLUMNS {
                let at = |row: usize, k: usize| gone[row * COLUMNS + k % COLUMNS];
                let (up, low) = (row.saturating_sub(1), (row + 1).min(ROWS - 1));
                let four = at(row, k + 1) + at(row, k + COLUMNS - 1) + at(up, k) + at(low, k);
                let i = row * COLUMNS + k;
                points_m[i] += ((four * 0.25 - gone[i]) * SMOOTH + sink) * self.free[i];
            }
        }
    }

    /// Keeps the lengths round the legs.
    fn keep_round(&self, points_m: &mut [DVec3]) {
        for row in 1..ROWS {
            for k in 0..COLUMNS {
                let (i, j) = (row * COLUMNS + k, row * COLUMNS + (k + 1) % COLUMNS);
                let rest_m = self.points_m[i].distance(self.points_m[j]);
                let way = points_m[j] - points_m[i];
                let length = way.length();
                let wanted = length.clamp(rest_m * ROUND[0], rest_m * ROUND[1]);
                let (a, b) = (self.free[i], self.free[j]);
                if wanted != length && length > 1e-9 && a + b > 0.0 {
                    let more = way * ((wanted - length) / (length * (a + b)));
                    points_m[i] -= more * a;
                    points_m[j] += more * b;
                }
            }
        }
    }

    /// Keeps the lengths downwards: each point follows the one above.
    fn keep_down(&self, points_m: &mut [DVec3]) {
        for i in COLUMNS..points_m.len() {
            let above = i - COLUMNS;
            let rest_m = self.points_m[i].distance(self.points_m[above]);
            let way = points_m[i] - points_m[above];
            let length = way.length().max(1e-9);
            let wanted = length.clamp(rest_m * DOWN[0], rest_m * DOWN[1]);
            points_m[i] += way * ((wanted - length) / length * self.free[i]);
        }
    }

    /// How many times longer than at rest the most stretched way between neighbours is.
    fn stretch(&self, points_m: &[DVec3]) -> f64 {
        let ways = (0..points_m.len()).flat_map(|i| {
            let round = i / COLUMNS * COLUMNS + (i + 1) % COLUMNS;
            [round, (i + COLUMNS).min(points_m.len() - 1)].map(|j| (i, j))
        });
        let times = |(i, j): (usize, usize)| {
            points_m[i].distance(points_m[j])
                / self.points_m[i].distance(self.points_m[j]).max(1e-3)
        };
        ways.map(times).fold(0.0, f64::max)
    }

    /// Transforms that take each point of the net with the net's directions round it.
    fn turned(&self, points_m: &[DVec3], skeleton: &PosedSkeleton) -> Vec<DAffine3> {
        let hips = skeleton.model_from_rest[spine::HIPS].matrix3;
        let joint = |i: usize| {
            let turn = match (frame(&self.points_m, i), frame(points_m, i)) {
                (Some(rest), Some(posed)) => posed * rest.transpose(),
                _ => hips,
            };
            DAffine3::from_mat3_translation(turn, points_m[i] - turn * self.points_m[i])
        };
        (0..points_m.len()).map(joint).collect()
    }
}

/// How far the more bent hip is: 0 straight .. 1 a right angle or more.
fn bend(skeleton: &PosedSkeleton) -> f64 {
    let bones = &skeleton.model_from_rest;
    let hips_from_model = bones[spine::HIPS].matrix3.transpose();
    let of = |side: Side| {
        let thigh = hips_from_model * bones[side.joint(Limb::UpLeg)].matrix3;
        (1.0 - thigh.y_axis.y).clamp(0.0, 1.0)
    };
    Side::BOTH.map(of).into_iter().fold(0.0, f64::max)
}

/// Unit directions of the net round a point: down, outwards, and round; nothing where it is folded.
fn frame(points_m: &[DVec3], i: usize) -> Option<DMat3> {
    let (row, k) = (i / COLUMNS, i % COLUMNS);
    let at = |row: usize, k: usize| points_m[row * COLUMNS + k % COLUMNS];
    let down = at((row + 1).min(ROWS - 1), k) - at(row.saturating_sub(1), k);
    let round = at(row, k + 1) - at(row, k + COLUMNS - 1);
    let down = down.try_normalize()?;
    let out = round.cross(down).try_normalize()?;
    Some(DMat3::from_cols(down, out, out.cross(down)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::body::rest_body;
    use crate::geometry::phenotype::tests::average;
    use crate::geometry::stance::Stance;
    use crate::geometry::sway;
    use crate::library::figure::Figure;
    use crate::library::pose::Poses;
    use crate::scene::Sex;

    /// A wide tube from the hips to below the knees that moves with the hips.
    fn tube(trunk: &Trunk, heads_m: &[DVec3; JOINT_COUNT]) -> Hang {
        let leg = |limb: Limb| heads_m[Side::Left.joint(limb)].y;
        let (top, end) = (heads_m[0].y + 0.05, leg(Limb::Leg) - 0.1);
        let points: Vec<Vec3> = (0..ROWS * COLUMNS)
            .map(|i| {
                let turn = std::f64::consts::TAU * (i % COLUMNS) as f64 / COLUMNS as f64;
                let t = (i / COLUMNS) as f64 / (ROWS - 1) as f64;
                let (x, z) = (0.24 * libm::cos(turn), 0.2 * libm::sin(turn));
                DVec3::new(x, top + (end - top) * t, z + heads_m[0].z).as_vec3()
            })
            .collect();
        let hips = SkinVertex { joints: [0; 4], weights: [255, 0, 0, 0] };
        Hang::new(&points, &vec![0.05; points.len()], vec![hips; points.len()], (trunk, None), 60)
    }

    fn posed(pose: &str) -> (Hang, Vec<DVec3>, PosedSkeleton, RestBody) {
        let figure = Figure::built_in().unwrap();
        let body = rest_body(&figure, &average(Sex::Female), &[]).unwrap();
        let stance = Stance::of_pose(Poses::built_in().get(pose).unwrap());
        let mut skeleton = PosedSkeleton::of_stance(&body.heads_m, &stance);
        skeleton.ground(body.ground.iter().map(|p| (p.rest_m, p.skin)));
        let hang = tube(&body.trunk, &body.heads_m);
        let cloth = sway::joints(&skeleton, &body.heads_m);
        let joints = hang.joints(&skeleton, (&body, &cloth), (DVec3::NEG_Y, None));
        let moved = hang.points_m.iter().zip(joints).map(|(p, j)| j.transform_point3(*p));
        (hang.clone(), moved.collect(), skeleton, body)
    }

    #[test]
    fn cloth_sinks_keeps_its_lengths_and_stays_out_of_the_legs() {
        for pose in ["pose/standing_at_ease", "pose/squatting", "pose/half_squat"] {
            let (hang, moved, skeleton, body) = posed(pose);
            let solids = body.trunk.solids(&skeleton);
            let (mut long, mut deep) = (0.0_f64, 0.0_f64);
            for i in 2 * COLUMNS..moved.len() {
                let rest_m = hang.points_m[i].distance(hang.points_m[i - COLUMNS]);
                long = long.max(moved[i].distance(moved[i - COLUMNS]) / rest_m);
                deep = deep.max(-solids.distance_m(moved[i]));
            }
            assert!(long < 1.6, "{pose}: {long}");
            assert!(deep < 0.01, "{pose}: {deep}");
        }
    }

    #[test]
    fn a_net_at_rest_stays_as_it_is_but_for_its_weight() {
        let figure = Figure::built_in().unwrap();
        let body = rest_body(&figure, &average(Sex::Female), &[]).unwrap();
        let hang = tube(&body.trunk, &body.heads_m);
        let rest = [DAffine3::IDENTITY; 4];
        let joints = hang.joints(&PosedSkeleton::REST, (&body, &rest), (DVec3::NEG_Y, None));
        for (p, joint) in hang.points_m.iter().zip(joints) {
            assert!(joint.transform_point3(*p).distance(*p) < 0.03, "{p}");
        }
    }

    #[test]
    fn weights_are_of_the_four_joints_round_a_place_and_sum_up() {
        let figure = Figure::built_in().unwrap();
        let body = rest_body(&figure, &average(Sex::Female), &[]).unwrap();
        let hang = tube(&body.trunk, &body.heads_m);
        for i in [0, 30, 77, 150] {
            let s = hang.weights(hang.points_m[i].as_vec3(), (i % COLUMNS) as f32 / COLUMNS as f32);
            assert_eq!(s.weights.iter().map(|w| u32::from(*w)).sum::<u32>(), 255);
            let own = s.joints.iter().zip(s.weights).find(|j| usize::from(*j.0) == hang.first + i);
            assert!(own.is_some_and(|j| j.1 > 250), "{i} {s:?}");
        }
    }
}
