//! Skirts: rings of cloth round both legs, from the waist downwards.
//!
//! Each ring is the convex hull of what it goes round, so no leg is outside at rest. It moves with
//! the legs: beside a leg with that leg, between the legs with the one that is ahead in front and
//! with the other one behind, which is how cloth spans them in a stride. It hangs on a net
//! ([`super::hang`]) that starts so. Tops and trousers are not known here.

use glam::Vec3;

use super::cut::{Builder, Rim, Surface, smooth_normals};
use super::drape::Tube;
use super::hang::{self, Hang};
use super::shell::Shell;
use super::skeleton::{Limb, Side};
use super::sway::{self, CLOTH_JOINT_COUNT};
use super::trunk::Trunk;
use crate::library::figure::{CLOTH_REPEAT, GroupId, SKIRT};
use crate::library::mesh::SkinVertex;

/// Rows and columns by level of detail.
const GRID: [(usize, usize); 5] = [(16, 60), (11, 44), (7, 28), (5, 18), (3, 12)];

/// Share of the way from between the legs to the middle of one from which the cloth goes with that
/// leg alone.
const BETWEEN: f32 = 0.8;

/// How much farther a skirt stands off at its hem than at its upper edge: legs bend in it.
const LOWER_EASE_M: f32 = 0.018;

/// What a skirt is like.
pub(super) struct Cut {
    /// Upper edge, on the template.
    pub top_y: f32,
    /// Lower edge along the leg.
    pub leg_end: f32,
    /// 0 it hangs straight .. 1 wide.
    pub flare: f32,
    /// Gap between what it goes round and its cloth, metres.
    pub ease_m: f32,
    /// Half of the width of the gap in front; nothing for a closed skirt.
    pub gap_m: Option<f32>,
}

/// A ring after ring of vertices.
pub(super) struct Skirt {
    pub positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    skin: Vec<SkinVertex>,
    render: Vec<u16>,
    uvs: Vec<f32>,
    triangles: Vec<u16>,
    /// Metres inside the hem and the front edges, by vertex.
    field: Vec<f32>,
    columns: usize,
    /// What it goes round, by vertices of a coarse level of the shell.
    under: Vec<Vec3>,
}

/// The finest level of the shell that clearances are taken from.
const UNDER_LOD: usize = 2;

impl Skirt {
    /// A skirt round the points of a layer of the shell.
    pub fn new(shell: &Shell<'_>, cut: &Cut, under: &[Vec3]) -> Option<Self> {
        let (rows, columns) = GRID[shell.lod];
        let heights = Heights::find(shell, cut)?;
        let (positions, field) = rings(shell, cut, under, &heights, (rows, columns))?;
        let mut skirt = Self {
            skin: weights(shell, &positions, columns),
            normals: Vec::new(),
            render: Vec::new(),
            uvs: Vec::new(),
            triangles: Vec::new(),
            positions,
            field,
            columns,
            under: under[..coarse(shell)].to_vec(),
        };
        skirt.weave(rows, columns);
        skirt.normals = smooth_normals(&skirt.positions, &skirt.render, &skirt.triangles);
        Some(skirt)
    }

    /// The net that can move it, its joints numbered from a first one on.
    pub fn net(&self, shell: &Shell<'_>, under: (&Trunk, Option<f32>), first: usize) -> Hang {
        let rows = self.positions.len() / self.columns;
        let at = |row: f32, column: f32| {
            let (r, k) = ((row as usize).min(rows - 2), column as usize);
            let (t, s) = (row - r as f32, column - k as f32);
            let p = |r: usize, k: usize| self.positions[r * self.columns + k % self.columns];
            p(r, k).lerp(p(r, k + 1), s).lerp(p(r + 1, k).lerp(p(r + 1, k + 1), s), t)
        };
        let (down, round) = (
            (rows - 1) as f32 / (hang::ROWS - 1) as f32,
            self.columns as f32 / hang::COLUMNS as f32,
        );
        let points: Vec<Vec3> = (0..hang::ROWS * hang::COLUMNS)
            .map(|i| ((i / hang::COLUMNS) as f32 * down, (i % hang::COLUMNS) as f32 * round))
            .map(|(row, column)| at(row, column))
            .collect();
        let gaps_m = self.gaps_m(shell, &points);
        Hang::new(&points, &gaps_m, weights(shell, &points, hang::COLUMNS), under, first)
    }

    /// Distances of points from what the skirt goes round: from the nearest vertex's tangent plane, or
    /// from the vertex where that is far.
    fn gaps_m(&self, shell: &Shell<'_>, points: &[Vec3]) -> Vec<f32> {
        const FAR_M: f32 = 0.06;
        let near =
            Cloud::new(&self.under, (0..self.under.len()).filter(|i| shell.places[*i].arm < 0.02));
        let gap_m = |p: &Vec3| {
            let Some(i) = near.nearest(*p) else { return FAR_M };
            let way = *p - self.under[i];
            let length = way.length();
            if length > FAR_M { length } else { way.dot(shell.normals[i]).max(0.0) }
        };
        points.iter().map(gap_m).collect()
    }

    /// Hangs it on a net, but for what lies on the hips, which moves as the body does.
    pub fn hang_on(&mut self, shell: &Shell<'_>, net: &Hang) {
        let turn = |i: usize| (i % self.columns) as f32 / self.columns as f32;
        let is_fixed = |i: usize| net.is_fixed(self.positions[i], turn(i));
        let rows = self.positions.len() / self.columns;
        let fixed = |row: &usize| (row * self.columns..(row + 1) * self.columns).any(is_fixed);
        let upper = (0..rows).filter(fixed).max().map_or(0, |row| row + 1) * self.columns;
        let body = weights(shell, &self.positions[..upper], self.columns);
        let skin = self.positions.iter().enumerate().map(|(i, p)| match body.get(i) {
            Some(body) if is_fixed(i) => *body,
            _ => net.weights(*p, turn(i)),
        });
        self.skin = skin.collect();
    }

    /// Triangles and texture coordinates; the last column stands twice, so that the cloth's
    /// pattern closes.
    fn weave(&mut self, rows: usize, columns: usize) {
        const REPEAT_M: f32 = 0.3;
        let first = self.positions[0].y;
        for row in 0..rows {
            for k in 0..=columns {
                let v = row * columns + k % columns;
                self.render.push(v as u16);
                let u = 4.0 * k as f32 / columns as f32;
                let down = (first - self.positions[v].y) / REPEAT_M;
                self.uvs.extend([(SKIRT[0] + u) / CLOTH_REPEAT, (SKIRT[1] + down) / CLOTH_REPEAT]);
            }
        }
        let wide = columns + 1;
        for row in 1..rows {
            for k in 0..columns {
                let (a, b) = ((row - 1) * wide + k, row * wide + k);
                let [a, b, c, d] = [a, a + 1, b, b + 1].map(|v| v as u16);
                self.triangles.extend([a, b, c, b, d, c]);
            }
        }
    }

    /// Its triangles, by corners.
    #[cfg(test)]
    pub fn triangles(&self) -> Vec<[Vec3; 3]> {
        let corner = |r: u16| self.positions[usize::from(self.render[usize::from(r)])];
        self.triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(corner)).collect()
    }

    /// Lowest point of its hem, metres.
    pub fn hem_m(&self) -> f32 {
        self.positions
            .iter()
            .zip(&self.field)
            .filter(|(_, f)| **f >= 0.0)
            .map(|(q, _)| q.y)
            .fold(f32::MAX, f32::min)
    }

    /// Takes away what lies under another garment: what is higher than `end`, but for a gap in
    /// front of half the width `gap_m`.
    pub fn hide(&mut self, end: Level, gap_m: f32) {
        let middle_z =
            self.positions.iter().map(|q| q.z).sum::<f32>() / self.positions.len() as f32;
        for (q, f) in self.positions.iter().zip(&mut self.field) {
            let in_gap = if q.z > middle_z { gap_m - q.x.abs() } else { f32::MIN };
            *f = f.min((end.at(q.z) - q.y).max(in_gap));
        }
    }

    /// Adds it to a mesh, with a rim at its edges.
    pub fn add(&self, builder: &mut Builder, rim: Option<Rim>) -> std::ops::Range<u32> {
        let surface = Surface {
            render: &self.render,
            uvs: &self.uvs,
            triangles: &self.triangles,
            positions: &self.positions,
            normals: &self.normals,
            skin: &self.skin,
        };
        builder.add_cut(&surface, &self.field, rim)
    }
}

/// A plane round the trunk that leans forwards or backwards as the person's waist does.
#[derive(Clone, Copy, Debug)]
pub(super) struct Level {
    /// Height at z = 0, metres.
    y: f32,
    /// Its rise along z.
    rise: f32,
}

impl Level {
    /// A straight line through the heights of the vertices near the template's ring.
    pub fn find(shell: &Shell<'_>, template_y: f32) -> Option<Self> {
        let (mut n, mut sz, mut sy, mut szz, mut szy) = (0.0f32, 0.0f32, 0.0f32, 0.0f32, 0.0f32);
        let scale = shell.heads_m[0].y as f32 / 0.9;
        for (p, at) in shell.positions.iter().zip(shell.places) {
            let above = at.p.y - template_y;
            if at.arm > 0.0 || above.abs() > 0.035 {
                continue;
            }
            let (z, y) = (p.z, p.y - above * scale);
            (n, sz, sy, szz, szy) = (n + 1.0, sz + z, sy + y, szz + z * z, szy + z * y);
        }
        if n < 4.0 {
            return None;
        }
        let spread = (n * szz - sz * sz).max(1e-9);
        let rise = ((n * szy - sz * sy) / spread).clamp(-0.6, 0.6);
        Some(Self { y: (sy - rise * sz) / n, rise })
    }

    /// One that is level.
    pub const fn flat(y: f32) -> Self {
        Self { y, rise: 0.0 }
    }

    /// Height, metres.
    pub fn at(&self, z: f32) -> f32 {
        self.y + self.rise * z
    }
}

/// Where a skirt begins and ends on a person.
struct Heights {
    top: Level,
    hem_y: f32,
}

impl Heights {
    fn find(shell: &Shell<'_>, cut: &Cut) -> Option<Self> {
        let top = Level::find(shell, cut.top_y)?;
        let leg = |joint| shell.heads_m[Side::Left.joint(joint)].y as f32;
        let (hip, ankle) = (leg(Limb::UpLeg), leg(Limb::Foot));
        Some(Self { top, hem_y: hip + (ankle - hip) * cut.leg_end })
    }

    fn top_y(&self, z: f32) -> f32 {
        self.top.at(z)
    }
}

/// The rings' points, and how far each is inside the skirt's edges.
fn rings(
    shell: &Shell<'_>,
    cut: &Cut,
    under: &[Vec3],
    heights: &Heights,
    (rows, columns): (usize, usize),
) -> Option<(Vec<Vec3>, Vec<f32>)> {
    let middle_z = shell.heads_m[0].z as f32;
    let reach = heights.top_y(middle_z) - heights.hem_y;
    let tilt = 0.15 * heights.top.rise.abs() + 0.02;
    let (low, high) = (heights.hem_y - 0.1 * reach, heights.top_y(middle_z) + tilt);
    let points = under
        .iter()
        .zip(shell.places)
        .filter(|(q, at)| at.arm < 0.02 && q.y > low && q.y < high)
        .map(|(q, _)| *q);
    let origin = Vec3::new(0.0, high, middle_z);
    let mut tube = Tube::new((origin, Vec3::NEG_Y), Vec3::Z, (rows * 2, columns), points)?;
    tube.hang(|_| 0.15 - 0.36 * cut.flare);
    let folds = (columns / 6).min(9) as f32;
    // Straight pieces between few columns run inside the hull, and coarse legs are rough.
    let chord = 1.0 / libm::cosf(std::f32::consts::PI / columns as f32);
    let ease_m = cut.ease_m + [0.0, 0.001, 0.003, 0.005, 0.009][shell.lod];
    let mut positions = Vec::with_capacity(rows * columns);
    let mut field = Vec::with_capacity(rows * columns);
    for row in 0..rows {
        // One ring more below the hem: the cut gives the hem its rim.
        let share = row as f32 / (rows as f32 - 1.6);
        let down = share * reach;
        let fold_m = (0.003 + 0.022 * cut.flare) * share.min(1.0) * (down / 0.35).min(1.0);
        for k in 0..columns {
            let turn = std::f32::consts::TAU * k as f32 / columns as f32;
            let (sin, cos) = (libm::sinf(turn), libm::cosf(turn));
            let near = Vec3::new(cos, 0.0, sin) * 0.05 + Vec3::Z * middle_z;
            let at = |z: f32| {
                let top_y = heights.top_y(z);
                near.with_y(top_y + (heights.hem_y - top_y) * share)
            };
            // The edge's height depends on how far out it is, which depends little on its height.
            let first = tube.spot(at(middle_z));
            let probe = at(middle_z + (near.z - middle_z) * (first.radius / first.own.max(0.01)));
            let spot = tube.spot(probe);
            let wave = 0.5 + 0.5 * libm::cosf(folds * turn + 1.3 * libm::sinf(2.0 * turn));
            // Between rings the cloth is straight, and hips are round.
            let half = Vec3::Y * (0.5 * reach / (rows as f32 - 1.6));
            let radius = tube.spot(probe + half).radius.max(tube.spot(probe - half).radius);
            let radius = radius.max(spot.radius);
            let more = radius * chord - spot.own + ease_m + fold_m * wave;
            let q = probe + spot.out * (more + LOWER_EASE_M * share);
            let front = cut.gap_m.map_or(f32::MAX, |gap| {
                let apart = gap * (1.0 + 0.6 * share);
                q.x.abs() - apart + if sin > 0.0 { 0.0 } else { 1.0 }
            });
            positions.push(q);
            field.push((reach * (1.0 - share)).min(front));
        }
    }
    Some((positions, field))
}

/// How many vertices the shell has at [`UNDER_LOD`], or at the level in hand if that is coarser.
fn coarse(shell: &Shell<'_>) -> usize {
    let lods = &shell.figure.group(GroupId::Shell).lods;
    lods[UNDER_LOD.max(shell.lod)].vertices as usize
}

/// Joints and weights: those of the nearest places of the shell on the left and on the right, in
/// proportion to how far the point is on either side between the legs; the rest goes to the joints
/// that follow the leg ahead or the leg behind.
fn weights(shell: &Shell<'_>, positions: &[Vec3], columns: usize) -> Vec<SkinVertex> {
    let skin =
        &shell.figure.skin()[shell.figure.vertices(GroupId::Shell, shell.positions.len() as u32)];
    let hip = shell.heads_m[Side::Left.joint(Limb::UpLeg)].as_vec3();
    let ankle = shell.heads_m[Side::Left.joint(Limb::Foot)].as_vec3();
    let mut dense = Vec::with_capacity(positions.len());
    for ring in positions.chunks(columns) {
        let y = ring[0].y;
        let beside = |side: f32| {
            let near = |i: &usize| {
                let p = shell.positions[*i];
                (p.y - y).abs() < 0.05 && shell.places[*i].arm < 0.02 && p.x * side > -0.002
            };
            Cloud::new(shell.positions, (0..shell.positions.len()).filter(near))
        };
        let near = [beside(1.0), beside(-1.0)];
        let t = ((hip.y - y) / (hip.y - ankle.y)).clamp(0.0, 1.0);
        let leg_x = (hip.x + (ankle.x - hip.x) * t).abs().max(0.02);
        for q in ring {
            let beside = (q.x / (BETWEEN * leg_x)).clamp(-1.0, 1.0);
            let front = q.z > hip.z + (ankle.z - hip.z) * t;
            let mut sum = [0.0f32; CLOTH_JOINT_COUNT];
            for (side, near) in [1.0f32, -1.0].into_iter().zip(&near) {
                let (own_share, shared) = ((beside * side).max(0.0), 0.5 - 0.5 * beside.abs());
                if let Some(i) = near.nearest(*q) {
                    for (&j, &w) in skin[i].joints.iter().zip(&skin[i].weights) {
                        let (j, w) = (usize::from(j), f32::from(w));
                        sum[j] += own_share * w;
                        sum[sway::beside(j, front)] += shared * w;
                    }
                } else {
                    sum[0] += (own_share + shared) * 255.0;
                }
            }
            dense.push(sum);
        }
    }
    soften(&mut dense, columns);
    dense.iter().map(four_largest).collect()
}

/// Points among which the nearest is looked for, axis by axis: eight are compared at a time.
struct Cloud {
    which: Vec<usize>,
    /// Padded with points that are far from everything.
    axes: [Vec<f32>; 3],
}

const LANES: usize = 8;

impl Cloud {
    fn new(positions: &[Vec3], which: impl Iterator<Item = usize>) -> Self {
        let which: Vec<usize> = which.collect();
        let axes = [0, 1, 2].map(|axis| {
            let own = which.iter().map(|&i| positions[i][axis]);
            let padding = which.len().next_multiple_of(LANES) - which.len();
            own.chain(std::iter::repeat_n(1e9, padding)).collect()
        });
        Self { which, axes }
    }

    /// The nearest point, of equally near ones the first.
    fn nearest(&self, q: Vec3) -> Option<usize> {
        let (mut best, mut block) = ([f32::MAX; LANES], [0u32; LANES]);
        let [x, y, z] = &self.axes;
        let eights = x.as_chunks::<LANES>().0.iter().zip(y.as_chunks::<LANES>().0);
        for (k, ((x, y), z)) in eights.zip(z.as_chunks::<LANES>().0).enumerate() {
            for i in 0..LANES {
                let (dx, dy, dz) = (x[i] - q.x, y[i] - q.y, z[i] - q.z);
                let d = dx * dx + dy * dy + dz * dz;
                let nearer = d < best[i];
                best[i] = if nearer { d } else { best[i] };
                block[i] = if nearer { k as u32 } else { block[i] };
            }
        }
        let place = |i: usize| block[i] as usize * LANES + i;
        let order =
            |a: &usize, b: &usize| best[*a].total_cmp(&best[*b]).then(place(*a).cmp(&place(*b)));
        (0..LANES).min_by(order).and_then(|i| self.which.get(place(i)).copied())
    }
}

/// Means over neighbours on the rings and between them.
fn soften(dense: &mut [[f32; CLOTH_JOINT_COUNT]], columns: usize) {
    let rows = dense.len() / columns;
    // Once: the cloth must bend where the knees do.
    let before = dense.to_vec();
    for row in 0..rows {
        let (up, down) = (row.saturating_sub(1), (row + 1).min(rows - 1));
        for k in 0..columns {
            let at = |r: usize, k: usize| &before[r * columns + k % columns];
            let five =
                [at(row, k), at(row, k + 1), at(row, k + columns - 1), at(up, k), at(down, k)];
            for j in 0..CLOTH_JOINT_COUNT {
                let sum: f32 = five.iter().map(|w| w[j]).sum();
                dense[row * columns + k][j] = sum * 0.2;
            }
        }
    }
}

fn four_largest(dense: &[f32; CLOTH_JOINT_COUNT]) -> SkinVertex {
    let mut order: Vec<usize> = (0..CLOTH_JOINT_COUNT).filter(|&j| dense[j] > 0.0).collect();
    order.sort_by(|&a, &b| dense[b].total_cmp(&dense[a]).then(a.cmp(&b)));
    order.truncate(4);
    let sum: f32 = order.iter().map(|&j| dense[j]).sum();
    let mut out = SkinVertex::default();
    let mut left = 255u8;
    for (i, &j) in order.iter().enumerate().rev() {
        let units = if i == 0 { left } else { ((dense[j] / sum * 255.0 + 0.5) as u8).min(left) };
        (out.joints[i], out.weights[i]) = (j as u8, units);
        left -= units;
    }
    out
}
