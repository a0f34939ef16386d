//! The garment shell of one person: the surface out of which clothes are made.
//!
//! Positions and normals of a level of detail flow in; the shell moved out, softened, or drawn to
//! tubes round trunk and limbs flows out. Which garments there are is not known here.

use glam::{DVec3, Vec3, Vec4};

use super::drape::Tube;
use super::garment::{Place, step};
use super::skeleton::{JOINT_COUNT, Limb, Side};
use crate::library::figure::{Figure, GroupId, Neighbour, Net};

/// Columns and rows of a tube, by level of detail.
pub(super) const TUBE: [(usize, usize); 5] = [(28, 32), (22, 24), (14, 16), (10, 12), (7, 8)];

/// The shell of one person at one level of detail.
pub(super) struct Shell<'a> {
    pub figure: &'a Figure,
    pub lod: usize,
    pub positions: &'a [Vec3],
    pub normals: &'a [Vec3],
    pub places: &'a [Place],
    /// Joints at rest.
    pub heads_m: &'a [DVec3; JOINT_COUNT],
    pub net: &'a Net,
    /// How far the smoothed shell lies outside the shell itself: hollows that cloth bridges.
    pub bridge: Vec<f32>,
}

impl<'a> Shell<'a> {
    pub fn new(
        figure: &'a Figure,
        lod: usize,
        (positions, normals): (&'a [Vec3], &'a [Vec3]),
        places: &'a [Place],
        heads_m: &'a [DVec3; JOINT_COUNT],
    ) -> Self {
        let rounds = [7, 5, 3, 2, 1][lod];
        let net = figure.net(GroupId::Shell, lod);
        let mut smooth = positions.to_vec();
        blend(net, &mut smooth, rounds);
        let bridge = positions
            .iter()
            .zip(&smooth)
            .zip(normals)
            .map(|((p, s), n)| (*s - *p).dot(*n))
            .collect();
        Self { figure, lod, positions, normals, places, heads_m, net, bridge }
    }

    /// Where a joint stands at rest.
    pub fn head(&self, joint: usize) -> Vec3 {
        self.heads_m[joint].as_vec3()
    }

    /// The shell pushed out by a height a vertex.
    pub fn pushed(&self, by: &[f32]) -> Vec<Vec3> {
        self.positions.iter().zip(self.normals).zip(by).map(|((p, n), h)| *p + *n * *h).collect()
    }

    /// Heights that bridge hollows, softened.
    pub fn heights(&self, base: impl Fn(usize) -> f32) -> Vec<f32> {
        let mut heights: Vec<f32> = (0..self.positions.len())
            .map(|i| {
                let base = base(i);
                // The shoulders carry the cloth: it stands off nowhere above them.
                let most = if self.places[i].p.y > 0.46 { 0.008 } else { 0.03 };
                base.max(self.bridge[i] + 0.4 * base).min(base + most)
            })
            .collect();
        soften(self.net, &mut heights, 2);
        heights
    }

    /// Moves a layer's points out to a tube, by a share that depends on the vertex and one that
    /// depends on the direction as well.
    pub fn spread(
        &self,
        layer: &mut [Vec3],
        tube: &Tube,
        share: impl Fn(usize) -> f32,
        towards: impl Fn(usize, Vec3) -> f32,
    ) {
        for (i, q) in layer.iter_mut().enumerate() {
            let share = share(i);
            if share <= 0.0 {
                continue;
            }
            let spot = tube.spot(*q);
            let facing = step(0.15, 0.6, self.normals[i].dot(spot.out));
            let more = (spot.radius - spot.own).max(0.0) * facing;
            if more > 0.0 {
                *q += spot.out * (more * share * towards(i, spot.out));
            }
        }
    }

    /// Smooths how a layer stands off, and keeps it off what it covers by at least `gap`.
    pub fn settle(
        &self,
        layer: &mut [Vec3],
        under: &[Vec3],
        rounds: usize,
        gap: impl Fn(usize) -> f32,
    ) {
        let mut offsets: Vec<Vec3> = layer.iter().zip(under).map(|(q, u)| *q - *u).collect();
        blend(self.net, &mut offsets, rounds);
        for (i, (q, offset)) in layer.iter_mut().zip(&offsets).enumerate() {
            let low = gap(i) - offset.dot(self.normals[i]);
            *q = under[i] + *offset + self.normals[i] * low.max(0.0);
        }
    }

    fn points<'b>(
        &'b self,
        layer: &'b [Vec3],
        holds: impl Fn(&Place) -> bool + Clone + 'b,
    ) -> impl Iterator<Item = Vec3> + Clone + 'b {
        let places = self.places.iter();
        layer.iter().zip(places).filter(move |(_, at)| holds(at)).map(|(q, _)| *q)
    }

    /// A tube round the trunk between two heights on the template, open to further points.
    pub fn trunk_tube(
        &self,
        layer: &[Vec3],
        (low, high): (f32, f32),
        more: &[Vec3],
    ) -> Option<Tube> {
        let (rows, columns) = TUBE[self.lod];
        let trunk = move |at: &Place| at.arm < 0.04 && at.p.y > low && at.p.y < high;
        let points = self.points(layer, trunk).chain(more.iter().copied());
        Tube::new((self.head(0), Vec3::NEG_Y), Vec3::Z, (rows, columns), points)
    }

    /// A tube round an arm or a leg of one side.
    pub fn limb_tube(
        &self,
        layer: &[Vec3],
        (side, from, to): (Side, Limb, Limb),
        holds: impl Fn(&Place) -> bool + Clone,
    ) -> Option<Tube> {
        let (rows, columns) = TUBE[self.lod];
        let (a, b) = (self.head(side.joint(from)), self.head(side.joint(to)));
        let left = side == Side::Left;
        let points = self.points(layer, move |at| holds(at) && (at.p.x > 0.0) == left);
        Tube::new((a, b - a), Vec3::Z, (rows, columns), points)
    }
}

/// Means of neighbours, half way, `rounds` times.
fn blend(net: &Net, points: &mut [Vec3], rounds: usize) {
    // Four numbers a point are moved at once.
    let mut before: Vec<Vec4> = points.iter().map(|p| p.extend(0.0)).collect();
    let mut after = before.clone();
    for _ in 0..rounds {
        for (v, p) in after.iter_mut().enumerate() {
            let around = net.around(v);
            if !around.is_empty() {
                let mean = |sum, n: &Neighbour| sum + before[n.vertex as usize] * n.share;
                *p = (before[v] + around.iter().fold(Vec4::ZERO, mean)) * 0.5;
            }
        }
        std::mem::swap(&mut before, &mut after);
    }
    for (p, q) in points.iter_mut().zip(before) {
        *p = q.truncate();
    }
}

/// The same for numbers.
fn soften(net: &Net, values: &mut [f32], rounds: usize) {
    let mut after = values.to_vec();
    for _ in 0..rounds {
        for (v, value) in after.iter_mut().enumerate() {
            let around = net.around(v);
            if !around.is_empty() {
                let mean = |sum, n: &Neighbour| sum + values[n.vertex as usize] * n.share;
                *value = (values[v] + around.iter().fold(0.0, mean)) * 0.5;
            }
        }
        values.copy_from_slice(&after);
    }
}
