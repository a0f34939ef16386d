//! Locks of hair: a line combed over the head, and the ribbon or tube along it.

use glam::Vec3;

use super::near::Near;
use super::scalp::{Frame, Root};
use crate::geometry::garment::step;
use crate::library::mesh::{Mesh, SkinVertex, Triangle};

/// Repeats of the hair's texture over a metre across and along the strands, before the surface's
/// own repeats.
pub(in crate::geometry) const UV_PER_M: [f32; 2] = [7.0, 4.0];

/// Random numbers of one person's hair: SplitMix64 (Steele, Lea and Flood, "Fast splittable
/// pseudorandom number generators", 2014).
#[derive(Clone, Copy, Debug)]
pub(in crate::geometry) struct Dice(u64);

impl Dice {
    /// The numbers of one lock: they do not depend on those of the others.
    pub const fn new(seed: u64, lock: u64) -> Self {
        Self(seed ^ lock.wrapping_mul(0xd6e8_feb8_6659_fd93))
    }

    /// 0..1.
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / 16_777_216.0
    }

    /// `low..high`.
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }
}

/// A line of points with the direction that is outwards at each.
#[derive(Clone, Debug, Default)]
pub(in crate::geometry) struct Path {
    pub points: Vec<Vec3>,
    pub outward: Vec<Vec3>,
}

impl Path {
    /// An empty line with room for so many points.
    fn with_room(points: usize) -> Self {
        Self { points: Vec::with_capacity(points), outward: Vec::with_capacity(points) }
    }

    fn push(&mut self, p: Vec3, n: Vec3) {
        self.points.push(p);
        self.outward.push(n);
    }

    /// Length of the line, metres.
    pub fn length(&self) -> f32 {
        self.points.windows(2).map(|w| (w[1] - w[0]).length()).sum()
    }

    /// The same line by so many points, closer together where it bends: straight pieces between few
    /// points would run through the head.
    pub fn resampled(&self, count: usize) -> Self {
        let mut out = Self::with_room(count);
        let total = (0..self.points.len() - 1).map(|i| self.piece(i)).sum::<f32>();
        let (mut i, mut before) = (0, 0.0);
        for k in 0..count {
            let wanted = total * k as f32 / (count - 1) as f32;
            let mut piece = self.piece(i);
            while i + 2 < self.points.len() && before + piece < wanted {
                before += piece;
                i += 1;
                piece = self.piece(i);
            }
            let j = (i + 1).min(self.points.len() - 1);
            let t = ((wanted - before) / piece.max(1e-6)).clamp(0.0, 1.0);
            let n = self.outward[i].lerp(self.outward[j], t).normalize_or(self.outward[i]);
            out.push(self.points[i].lerp(self.points[j], t), n);
        }
        out
    }

    /// Length of a piece and how much its ends bend, each radian as so many metres.
    fn piece(&self, i: usize) -> f32 {
        const BEND_M: f32 = 0.05;
        let j = (i + 1).min(self.points.len() - 1);
        let bend = (self.along(j) - self.along(i)).length();
        (self.points[j] - self.points[i]).length() + BEND_M * bend
    }

    /// Unit direction along the line at a point.
    pub fn along(&self, i: usize) -> Vec3 {
        let (a, b) = (i.saturating_sub(1), (i + 1).min(self.points.len() - 1));
        (self.points[b] - self.points[a]).normalize_or(Vec3::NEG_Y)
    }

    /// Bends the line into curls: radius and length of a turn in metres, and where in the turn it
    /// begins. Roots stay where they are; curls bulge outwards rather than inwards.
    pub fn curl(&mut self, radius_m: f32, turn_m: f32, phase: f32) {
        let mut way = 0.0;
        let before = self.clone();
        for i in 0..self.points.len() {
            if i > 0 {
                way += (before.points[i] - before.points[i - 1]).length();
            }
            let along = before.along(i);
            let side = along.cross(before.outward[i]).normalize_or(Vec3::X);
            let out = side.cross(along);
            let angle = std::f32::consts::TAU * (way / turn_m + phase);
            let radius = radius_m * step(0.0, 1.5 * turn_m, way);
            let (s, c) = (libm::sinf(angle), libm::cosf(angle));
            // Long waves lie flat.
            let deep = (0.035 / turn_m).min(1.0);
            self.points[i] += (side * c + out * ((0.6 + s) * deep)) * radius;
            let lean = (3.0 * radius_m / turn_m).min(0.8);
            self.outward[i] = (before.outward[i] + (side * c + out * s) * lean).normalize_or(out);
        }
    }
}

/// How a lock is combed.
pub(in crate::geometry) struct Comb<'a> {
    pub near: &'a Near,
    pub frame: &'a Frame,
    /// Direction in local coordinates, any length: from the local place and the root.
    pub flow: &'a dyn Fn(Vec3, &Root) -> Vec3,
    /// How strongly the line follows the flow at each step rather than going on, 0..1.
    pub yields: f32,
    /// How strongly it keeps to its distance from the skin instead of standing off, 0..1.
    pub clings: f32,
    /// Above this local height it keeps to it fully.
    pub hugs_y: f32,
}

impl Comb<'_> {
    /// A line from a place over the scalp, in steps. `until` ends it: by the way gone in metres and
    /// the local place; `clear` is the distance from the skin, metres, by the way gone.
    pub fn line(
        &self,
        root: &Root,
        (start_m, step_m): (f32, f32),
        until: impl Fn(f32, Vec3) -> bool,
        clear: impl Fn(f32) -> f32,
    ) -> Path {
        const MOST: usize = 48;
        let mut path = Path::with_room(MOST + 1);
        let (mut p, mut n) = (root.p + root.n * start_m, root.n);
        path.push(p, n);
        let mut near = Some((start_m, root.n));
        let (mut ahead, mut way) = (Vec3::ZERO, 0.0);
        for _ in 0..MOST {
            let local = self.frame.local(p);
            let clings = self.clings.max(step(self.hugs_y - 0.02, self.hugs_y + 0.02, local.y));
            let mut wish = (self.flow)(local, root).normalize_or(Vec3::NEG_Y);
            if let Some((d, normal)) = near
                && d < 2.0 * clear(way) + 0.01
            {
                // Along the surface while it is near.
                let off = wish.dot(normal);
                let along = wish - normal * if off < 0.0 { off } else { off * clings };
                wish = along.normalize_or(wish);
            }
            ahead =
                if way == 0.0 { wish } else { ahead.lerp(wish, self.yields).normalize_or(wish) };
            p += ahead * step_m;
            way += step_m;
            near = self.near.surface(p);
            if let Some((d, normal)) = near {
                let gap = clear(way) - d;
                let pulled = d < 0.04 * self.frame.scale;
                if gap > 0.0 {
                    p += normal * gap;
                } else if pulled {
                    p += normal * (gap * clings);
                }
                n = n.lerp(normal, 0.7).normalize_or(normal);
            }
            path.push(p, n);
            if until(way, self.frame.local(p)) {
                break;
            }
        }
        path
    }
}

/// Shape of a ribbon.
#[derive(Clone, Copy, Debug)]
pub(in crate::geometry) struct Ribbon {
    /// Where it is widest, metres.
    pub width_m: f32,
    /// Share of the width at the root.
    pub root: f32,
    /// Turn about its own line, radians.
    pub tilt: f32,
    /// How far its edges' normals lean outwards, 0..1: a ribbon that is shaded like a lock.
    pub round: f32,
    /// Where it begins in the texture across.
    pub u: f32,
    /// How it ends.
    pub end: End,
}

/// How a ribbon ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::geometry) enum End {
    /// In a point.
    Point,
    /// In three points of unequal length.
    Tuft,
    /// Nearly as wide as it is: for a cutout, which leaves single strands of it.
    Cut,
}

impl Ribbon {
    /// Half the width along the line: full at a third, at the end narrower or a point.
    fn half(&self, t: f32) -> f32 {
        let grow = self.root + (1.0 - self.root) * step(0.0, 0.35, t);
        let narrow = match self.end {
            End::Cut => 1.0 - 0.45 * t * t,
            End::Point | End::Tuft => ((1.0 - t) * (1.0 + t * (1.0 + t))).max(0.0).sqrt(),
        };
        0.5 * self.width_m * grow * narrow
    }

    /// Adds the ribbon along a path, its front outwards; v of its texture coordinates is 0 at the end.
    pub fn add(&self, mesh: &mut Mesh, path: &Path, skin: &dyn Fn(Vec3) -> SkinVertex) {
        let last = path.points.len() - 1;
        let (mut left_m, mut before) = (path.length(), [0u32; 2]);
        let (sin, cos) = (libm::sinf(self.tilt), libm::cosf(self.tilt));
        for i in 0..=last {
            let (p, along) = (path.points[i], path.along(i));
            if i > 0 {
                left_m = (left_m - (p - path.points[i - 1]).length()).max(0.0);
            }
            let flat = along.cross(path.outward[i]).normalize_or(Vec3::X);
            let up = flat.cross(along);
            let (side, up) = (flat * cos + up * sin, up * cos - flat * sin);
            let uv = |x: f32| [self.u + x * UV_PER_M[0], left_m * UV_PER_M[1]];
            let joints = skin(p);
            if i == last && self.end == End::Tuft {
                let half = self.half((last - 1) as f32 / last as f32);
                let back = p - path.points[last - 1];
                self.add_tips(mesh, before, (p, back, side * half), up);
                return;
            }
            if i == last && self.end == End::Point {
                let tip = push(mesh, p, up, uv(0.0), joints);
                mesh.triangles.push(Triangle::new([before[0], before[1], tip]));
                return;
            }
            let half = self.half(i as f32 / last as f32);
            let pair = [-1.0, 1.0].map(|s: f32| {
                let n = (up + side * (s * self.round)).normalize_or(up);
                push(mesh, p + side * (s * half), n, uv(s * half), joints)
            });
            if i > 0 {
                mesh.triangles.push(Triangle::new([before[0], before[1], pair[1]]));
                mesh.triangles.push(Triangle::new([before[0], pair[1], pair[0]]));
            }
            before = pair;
        }
    }

    /// Three points of unequal length side by side, from the ribbon's last two vertices on: `end` of
    /// its line, the way there from those vertices, and half the width.
    fn add_tips(
        &self,
        mesh: &mut Mesh,
        [left, right]: [u32; 2],
        (end, way, half): (Vec3, Vec3, Vec3),
        up: Vec3,
    ) {
        let at = |mesh: &Mesh, v: u32| Vec3::from_array(mesh.positions[v as usize]);
        let (a, b) = (at(mesh, left), at(mesh, right));
        let (uv, joints) = (mesh.uvs[left as usize], mesh.skin[left as usize]);
        let [c, d] = [1.0 / 3.0, 2.0 / 3.0]
            .map(|t| push(mesh, a.lerp(b, t), up, [uv[0] + t * 0.04, uv[1]], joints));
        // Which of them is the longest follows from where the ribbon lies in the texture.
        let longest = (self.u * 7.0) as usize;
        let roots = [[left, c], [c, d], [d, right]];
        for (k, root) in roots.into_iter().enumerate() {
            let short = [0.0, 0.30, 0.16][(k + longest) % 3];
            let tip = end + half * (0.9 * (k as f32 - 1.0)) - way * short;
            let along = short * way.length() * UV_PER_M[1];
            let tip = push(mesh, tip, up, [uv[0] + k as f32 * 0.02, along], joints);
            mesh.triangles.push(Triangle::new([root[0], root[1], tip]));
        }
    }
}

/// Adds a vertex.
pub(in crate::geometry) fn push(
    mesh: &mut Mesh,
    p: Vec3,
    n: Vec3,
    uv: [f32; 2],
    skin: SkinVertex,
) -> u32 {
    mesh.skin.push(skin);
    mesh.push(p.to_array(), n.to_array(), uv)
}

/// Adds a tube round a path, its ends drawn together; radius by the share of the way, metres.
pub(in crate::geometry) fn tube(
    mesh: &mut Mesh,
    path: &Path,
    sides: usize,
    radius: impl Fn(f32) -> f32,
    skin: &dyn Fn(Vec3) -> SkinVertex,
) {
    let first = mesh.positions.len() as u32;
    let last = path.points.len() - 1;
    let mut way = 0.0;
    for i in 0..=last {
        let (p, along) = (path.points[i], path.along(i));
        if i > 0 {
            way += (p - path.points[i - 1]).length();
        }
        let side = along.cross(path.outward[i]).normalize_or(Vec3::X);
        let up = side.cross(along);
        let r = radius(i as f32 / last as f32);
        for k in 0..=sides {
            let turn = k as f32 / sides as f32;
            let (s, c) = sin_cos_turns(turn);
            let out = side * c - up * s;
            let uv = [turn * (0.5 + sides as f32 * r * 2.0), way * UV_PER_M[1]];
            push(mesh, p + out * r, out, uv, skin(p));
        }
    }
    let at = |i: usize, k: usize| first + (i * (sides + 1) + k) as u32;
    for i in 0..last {
        for k in 0..sides {
            let [a, b, c, d] = [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)];
            mesh.triangles.extend([[a, b, c], [a, c, d]].map(Triangle::new));
        }
    }
}

/// Sine and cosine of an angle in turns; exact at the quarters, so that rings close.
pub(in crate::geometry) fn sin_cos_turns(turn: f32) -> (f32, f32) {
    let quarter = (turn * 4.0).rem_euclid(4.0);
    let (k, rest) = (quarter as u32, (quarter - quarter.floor()) * std::f32::consts::FRAC_PI_2);
    let (s, c) = (libm::sinf(rest), libm::cosf(rest));
    match k {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}
