//! Hair on the head: a cap on the scalp, locks combed over it, and what hangs down.
//!
//! A person's scalp and skin flow in, triangles flow out, in three ranges: what lies underneath,
//! the locks, and those among them that catch the light, so that each can have its own tone. From
//! near, locks are ribbons out of which a [`Cutout`] leaves single strands, and so is a seam over the
//! cap's border; at coarser levels of detail they are fewer and wider, and pointed, and the coarsest
//! has the cap alone. Colours are not decided here.
//!
//! | file | what it does |
//! |---|---|
//! | `cap` | what lies on the scalp under the locks, and its border |
//! | `scalp` | the grid of roots, and the head's own coordinates |
//! | `near` | distance to skin and clothes |
//! | `strand` | combs a line over them and makes a ribbon or a tube of it |
//! | `style` | the table of styles |
//! | `gathered` | ponytails, knots and braids |
//! | `hanging` | what of it moves by its own weight |

mod cap;
mod gathered;
mod hanging;
pub(super) mod near;
pub(super) mod scalp;
pub(super) mod strand;
mod style;

use std::ops::Range;

use glam::Vec3;

use self::hanging::FIRST;
pub(super) use self::hanging::reach_m;
use self::near::Near;
use self::scalp::{COLUMNS, Root, Scalp};
use self::strand::{Comb, Dice, End, Path, Ribbon, UV_PER_M, push};
use self::style::{Form, Length, Locks, Tail};
use super::body::RestBody;
use super::garment::step;
use super::tress::Tresses;
use crate::base::hash::Hasher;
use crate::library::figure::Figure;
use crate::library::mesh::{Cutout, Mesh, SkinVertex, Triangle};
use crate::scene::{HairStyle, HeadwearKind, OuterKind, Outfit, Person, TopKind};

/// Locks by level of detail: share of the finest count, width, and share of the points.
const LEVELS: [(f32, f32, f32); 3] = [(0.7, 1.4, 1.3), (0.22, 1.9, 0.6), (0.1, 2.6, 0.5)];
/// Width of a strand of a cutout at the finest level of detail, metres; at coarser ones it would be a
/// quarter of a pixel, and there is none.
const STRAND_M: f32 = 0.0011;
/// What a hood that is not worn adds to that behind the neck.
const HOOD_M: f32 = 0.026;
/// The sheet of hair under the locks is torn where it would be wider than this between two of its
/// columns.
const PARTS_M: f32 = 0.05;
/// Roots start a little under the skin.
const SUNK_M: f32 = 0.0014;

/// A person's head while it is dressed.
pub(super) struct Head {
    pub scalp: Scalp,
    pub near: Near,
    /// Level of detail.
    pub lod: usize,
    /// Whatever is random about the hair follows from it.
    pub seed: u64,
    /// What is worn: hair under it lies flat.
    pub headwear: HeadwearKind,
    joints: [u8; 3],
}

impl Head {
    /// `skin` are the positions of the skin's vertices at this level.
    pub fn new(
        figure: &Figure,
        person: &Person,
        rest: &RestBody,
        lod: usize,
        skin: &[Vec3],
    ) -> Self {
        let scalp = Scalp::new(figure, rest);
        let clothes_m = |p: Vec3| clothes_m(&person.outfit, p);
        let near = Near::new(figure, &scalp.frame, lod, skin, above_y(person), &clothes_m);
        let joint = |name: &str| {
            let names = figure.joint_names();
            names.iter().position(|n| n == name).unwrap_or(0) as u8
        };
        Self {
            near,
            lod,
            seed: seed(person),
            headwear: person.look.headwear.kind,
            joints: [joint("Head"), joint("Neck"), joint("Spine2")],
            scalp,
        }
    }

    /// Weights of what is fixed to the head.
    pub fn on_head(&self) -> SkinVertex {
        SkinVertex { joints: [self.joints[0], 0, 0, 0], weights: [255, 0, 0, 0] }
    }

    /// Weights of what hangs from it: the lower, the more it follows neck and upper back.
    pub fn hanging(&self, p: Vec3) -> SkinVertex {
        let at = self.scalp.frame.local(p);
        // Beside the face it keeps to the face for longer.
        let top = 0.68 + 0.10 * step(0.08, 0.0, at.z);
        let low = 1.0 - step(top - 0.14, top, at.y);
        let back = low * (1.0 - step(0.50, 0.64, at.y));
        let (neck, back) = ((210.0 * (low - back)) as u8, (225.0 * back) as u8);
        SkinVertex {
            joints: [self.joints[0], self.joints[1], self.joints[2], 0],
            weights: [255 - neck - back, neck, back, 0],
        }
    }

    /// Local height above which a place is under the headwear; nothing if none presses the hair.
    pub fn brim_y(&self, l: Vec3) -> Option<f32> {
        super::headwear::edge_y(self.headwear, l.z)
    }
}

/// Height on the template above which a person's hair or headwear may lie on the skin.
pub(super) fn above_y(person: &Person) -> f32 {
    let form = style::form(person.look.hair);
    let hangs = form.is_some_and(|f| f.sheet_y.is_some() || f.tail != Tail::None)
        || person.look.headwear.kind == HeadwearKind::Headscarf;
    if hangs { 0.36 } else { 0.56 }
}

/// How far clothes reach off the skin at a place on the template, about, metres.
fn clothes_m(outfit: &Outfit, p: Vec3) -> f32 {
    let loose = |looseness_m: f64| (looseness_m as f32).clamp(0.0, 0.06);
    let bare = outfit.outer.kind == OuterKind::None;
    let over = if bare { 0.0 } else { 0.006 + loose(outfit.outer.looseness_m) };
    let worn = (0.014 + loose(outfit.top.looseness_m) + over) * step(0.60, 0.56, p.y);
    let hood = bare && outfit.top.kind == TopKind::Hoodie;
    let behind = step(0.05, -0.03, p.z) * step(0.63, 0.59, p.y) * step(0.40, 0.45, p.y);
    worn + if hood { HOOD_M * behind } else { 0.0 }
}

/// A number of the person's own: the same whatever the person wears.
fn seed(person: &Person) -> u64 {
    let b = &person.body;
    let mut hasher = Hasher::new();
    let sizes = [b.age_years, b.stature_m, b.bmi_kg_m2, b.muscle, b.proportions, b.cup, b.firmness];
    sizes.iter().chain(&b.ancestry).for_each(|v| hasher.number(*v));
    for (name, amount) in &person.look.face {
        hasher.bytes(name.as_bytes());
        hasher.number(*amount);
    }
    hasher.finish().iter().take(8).fold(0, |all, byte| all << 8 | u64::from(*byte))
}

/// Whether locks have a cutout at a level of detail.
pub(super) const fn is_cut(lod: usize) -> bool {
    lod == 0
}

/// The cutout of locks at a level of detail, their strands ending over such a length.
pub(super) fn strands(lod: usize, frayed_m: f32) -> Option<Cutout> {
    is_cut(lod).then_some(Cutout {
        strands_per_u: (1.0 / (UV_PER_M[0] * STRAND_M)) as u16,
        frayed_1024ths: (1024.0 * UV_PER_M[1] * frayed_m) as u16,
    })
}

/// What is cut out of the locks of a style at a level of detail.
pub(super) fn cutout(style: HairStyle, lod: usize) -> Option<Cutout> {
    let locks = style::form(style)?.locks?;
    strands(lod, locks.length.frayed_m())
}

/// What was added to a mesh.
pub(super) struct Added {
    /// Triangles of what lies underneath, of the locks, and of the light ones.
    pub ranges: [Range<u32>; 3],
    /// What moves those that hang.
    pub tresses: Option<Tresses>,
}

/// Adds a person's hair.
pub(super) fn add(mesh: &mut Mesh, body: &RestBody, head: &Head, style: HairStyle) -> Added {
    let start = mesh.triangles.len() as u32;
    let mut ends = [start; 3];
    let mut tresses = None;
    let covered = head.headwear == HeadwearKind::Headscarf;
    if let Some(form) = style::form(style).filter(|_| !covered) {
        let mut grower = Grower { head, form: &form, style, tresses: None };
        grower.tresses = grower.hang(body);
        grower.cap(mesh);
        if let Some(y) = form.sheet_y {
            grower.sheet(mesh, y);
        }
        gathered::add_cores(&grower, mesh);
        ends[0] = mesh.triangles.len() as u32;
        let locks = form.locks.as_ref().filter(|_| !grower.alone());
        let areas = locks.map(|_| head.scalp.areas(|root| grower.density(root)));
        for (tone, end) in [(0, 1), (1, 2)] {
            if let (Some(locks), Some(areas)) = (locks, &areas) {
                if tone == 0 && is_cut(head.lod) {
                    grower.hairline(mesh, locks.length.frayed_m());
                }
                grower.locks(mesh, locks, tone, areas);
                gathered::add_locks(&grower, mesh, tone);
            }
            ends[end] = mesh.triangles.len() as u32;
        }
        tresses = grower.tresses;
    }
    Added { ranges: [start..ends[0], ends[0]..ends[1], ends[1]..ends[2]], tresses }
}

/// Grows one person's hair.
struct Grower<'a> {
    head: &'a Head,
    form: &'a Form,
    style: HairStyle,
    /// What moves the hair that hangs.
    tresses: Option<Tresses>,
}

impl Grower<'_> {
    fn scale(&self) -> f32 {
        self.head.scalp.frame.scale
    }

    /// Whether the level is so coarse that there are no locks.
    fn alone(&self) -> bool {
        self.head.lod >= LEVELS.len()
    }

    /// Where the parting runs, local.
    fn part_x(&self) -> f32 {
        match self.style {
            HairStyle::Braids => 0.0,
            HairStyle::Bob | HairStyle::LongStraight | HairStyle::LongWavy => {
                Dice::new(self.head.seed, 1).range(-0.030, 0.030)
            }
            _ => 0.030,
        }
    }

    /// How the person wears the style: long hair lies in front of a shoulder or behind it.
    fn worn(&self) -> style::Worn {
        let long = matches!(self.style, HairStyle::LongStraight | HairStyle::LongWavy);
        let front_z = [2, 3].map(|side| match long {
            true if Dice::new(self.head.seed, side).unit() < 0.3 => 0.035,
            true => f32::MAX,
            false => 0.060,
        });
        style::Worn { part_x: self.part_x(), front_z }
    }

    fn comb<'a>(&'a self, locks: &Locks, flow: &'a dyn Fn(Vec3, &Root) -> Vec3) -> Comb<'a> {
        Comb {
            near: &self.head.near,
            frame: &self.head.scalp.frame,
            flow,
            yields: locks.yields,
            clings: locks.clings,
            hugs_y: if locks.flow == style::Flow::Fall { 0.75 } else { 2.0 },
        }
    }

    fn tie(&self) -> Vec3 {
        let root = self.head.scalp.at(style::TIE_HIGH.0, style::TIE_HIGH.1);
        self.head.scalp.frame.local(root.p + root.n * (0.012 * self.scale()))
    }

    /// Tie behind an ear, local.
    fn side_tie(&self, side: f32) -> Vec3 {
        let frame = &self.head.scalp.frame;
        let p = frame.world(style::side_tie(side));
        let off = |(d, n): (f32, Vec3)| p + n * (0.010 * frame.scale - d);
        frame.local(self.head.near.surface(p).map_or(p, off))
    }

    /// The line of one lock.
    fn line(&self, locks: &Locks, root: &Root, dice: &mut Dice) -> Path {
        let s = self.scale();
        let worn = self.worn();
        let tie = if self.form.tail == Tail::Braids {
            self.side_tie(if root.local.x > worn.part_x { 1.0 } else { -1.0 })
        } else {
            self.tie()
        };
        let stray = Vec3::new(dice.range(-1.0, 1.0), dice.range(-1.0, 1.0), dice.range(-1.0, 1.0));
        let stray = stray * if locks.clings > 0.9 { 0.02 } else { 0.16 };
        let flow = |l: Vec3, root: &Root| {
            let d = style::direction(locks.flow, l, root, &worn, tie);
            d.normalize_or(Vec3::NEG_Y) + stray
        };
        let comb = self.comb(locks, &flow);
        let lift = dice.unit();
        let higher = (root.depth / 0.10).min(1.0);
        let cap = self.cap_m(root);
        let end_m = s * (locks.clear_m.0 + (locks.clear_m.1 - locks.clear_m.0) * lift)
            + s * locks.layer_m * higher;
        let pressed = self.head.brim_y(root.local).is_some();
        let end_m = if pressed { end_m.min(0.012 * s) } else { end_m };
        // Long locks come out at once, or the cap would show bare along the hairline.
        let sunk = if matches!(locks.length, Length::Between(..)) { 0.002 } else { 0.0 };
        let start = (cap - sunk * s).max(0.0);
        match locks.length {
            Length::Between(low, high) => {
                // Cut shorter at the nape.
                let nape = 0.45 + 0.55 * step(0.68, 0.775, root.local.y);
                let length = s * dice.range(low, high) * nape;
                let steps = if length > 0.08 * s { 10.0 } else { 5.0 };
                let clear = |way: f32| {
                    let t = (way / length).min(1.0);
                    (start + 0.3 * cap * t) * (1.0 - t * t) + end_m * t
                };
                comb.line(root, (start, length / steps), |way, _| way > 0.98 * length, clear)
            }
            Length::Down(y, spread) => {
                let y = y + spread * dice.range(-1.0, 1.0);
                let clear = |way: f32| start + (end_m - start) * step(0.0, 0.028 * s, way);
                comb.line(root, (start, 0.018 * s), |_, l| l.y < y, clear)
            }
            Length::ToTie => {
                let near = |l: Vec3| (l - tie).length() < 0.016;
                let clear = |way: f32| start + (end_m - start) * step(0.0, 0.022 * s, way);
                comb.line(root, (start, 0.012 * s), |_, l| near(l), clear)
            }
        }
    }

    /// Locks of one of two tones: most of them, and the few light ones.
    fn locks(&self, mesh: &mut Mesh, locks: &Locks, tone: usize, areas: &[f32]) {
        let (share, wide, fine) = LEVELS[self.head.lod];
        let count = (locks.count as f32 * share) as usize;
        let points = ((locks.points as f32 * fine) as usize).max(3);
        for i in 0..count {
            let mut dice = Dice::new(self.head.seed, 16 + i as u64);
            if usize::from(dice.unit() < 0.35) != tone {
                continue;
            }
            let share = (i as f32 + dice.unit()) / count as f32;
            let root = self.head.scalp.drawn(areas, share, [dice.unit(), dice.unit()]);
            let mut path = self.line(locks, &root, &mut dice).resampled(points);
            let s = self.scale();
            if let Some((radius, turn)) = locks.curl {
                let radius = radius * s * dice.range(0.7, 1.3);
                // Neighbours wave together where waves are long.
                let apart = (0.02 / turn).min(1.0);
                let phase = 3.0 * root.column / COLUMNS as f32 + apart * dice.unit();
                path.curl(radius, turn * s * (1.0 + apart * dice.range(-0.2, 0.25)), phase);
            }
            // Hair that is drawn tight lies flat from its roots on.
            let (at_root, tilt) = if locks.clings > 0.9 { (0.25, 0.12) } else { (0.6, 0.35) };
            let ribbon = Ribbon {
                width_m: locks.width_m * s * wide * dice.range(0.65, 1.35),
                root: at_root,
                tilt: dice.range(-tilt, tilt),
                round: 0.55,
                u: dice.unit() * 4.0,
                end: self.end(locks.tuft),
            };
            ribbon.add(mesh, &path, &self.moves(&path.points));
        }
    }

    /// How ribbons end that are tufts or not.
    fn end(&self, tuft: bool) -> End {
        match (is_cut(self.head.lod), tuft) {
            (true, _) => End::Cut,
            (false, true) => End::Tuft,
            (false, false) => End::Point,
        }
    }

    fn density(&self, root: &Root) -> f32 {
        if let Some(edge) = self.head.brim_y(root.local)
            && root.local.y > edge - 0.006
        {
            return 0.0;
        }
        match self.style {
            HairStyle::Balding => step(0.0, 0.7, style::wreath(root.local)),
            // So short that ends beyond the border would be specks.
            HairStyle::Cropped | HairStyle::CrewCut => step(0.003, 0.009, root.depth),
            // Ends at the hairline frame the face.
            HairStyle::Short
            | HairStyle::Pixie
            | HairStyle::SideParting
            | HairStyle::Ponytail
            | HairStyle::Bun
            | HairStyle::Braids
            | HairStyle::Bob
            | HairStyle::LongStraight
            | HairStyle::LongWavy => 1.0 + 0.9 * (1.0 - step(0.0, 0.03, root.depth)),
            _ => 1.0,
        }
    }

    /// A sheet of hair from temple round the back to temple, under the locks.
    fn sheet(&self, mesh: &mut Mesh, end_y: f32) {
        let Some(locks) = &self.form.locks else { return };
        let (every, rows) = [(2, 12), (2, 9), (3, 6), (6, 5), (6, 4)][self.head.lod];
        let straight = Locks { curl: None, clings: 0.5, ..*locks };
        let worn = self.worn();
        let flow =
            |l: Vec3, root: &Root| style::direction(style::Flow::Fall, l, root, &worn, self.tie());
        let comb = self.comb(&straight, &flow);
        let s = self.scale();
        let columns: Vec<usize> = (FIRST..=COLUMNS - FIRST).step_by(every).collect();
        let (mut points, mut uvs) = (Vec::new(), Vec::new());
        for &column in &columns {
            let root = self.head.scalp.at(10.5, column as f32);
            let start = (self.cap_m(&root) - 0.003 * s).max(0.001);
            let uneven = lump(Vec3::new(column as f32 * 0.7, 0.0, 3.0), self.head.seed);
            let end = end_y + 0.02 * uneven;
            // Without locks over it the sheet stands for them.
            let off = if self.alone() { locks.clear_m.1 + locks.layer_m } else { locks.clear_m.0 };
            let clear = |_: f32| off * s;
            let path = comb.line(&root, (start, 0.014 * s), |_, l| l.y < end, clear);
            let path = path.resampled(rows);
            let mut way = 0.0;
            for (i, p) in path.points.iter().enumerate() {
                way += if i > 0 { (*p - path.points[i - 1]).length() } else { 0.0 };
                points.push(*p);
                uvs.push([column as f32 * 4.0 / COLUMNS as f32, 0.5 + way * UV_PER_M[1]]);
            }
        }
        let moves: Vec<_> = points.chunks(rows).map(|line| self.moves(line)).collect();
        let skin = |i: usize| moves[i / rows](points[i]);
        let (first, start) = (mesh.positions.len() as u32, mesh.triangles.len());
        add_grid(mesh, &points, &uvs, rows, false, &skin);
        // It parts over the shoulders, where some of it falls in front and some behind.
        let added = mesh.triangles.split_off(start);
        let parts = |t: &Triangle| {
            let p = t.get().map(|v| points[(v - first) as usize]);
            (0..3).any(|i| (p[i] - p[(i + 1) % 3]).length() > PARTS_M * s)
        };
        mesh.triangles.extend(added.into_iter().filter(|t| !parts(t)));
    }
}

/// Adds a grid of points, `across` in a row, with smooth normals. Its front is where columns run
/// to the right and rows down; where it is a ring, the first and the last column meet. `skin` gives
/// the joints of a point by its number.
pub(super) fn add_grid(
    mesh: &mut Mesh,
    points: &[Vec3],
    uvs: &[[f32; 2]],
    across: usize,
    ring: bool,
    skin: &dyn Fn(usize) -> SkinVertex,
) {
    let rows = points.len() / across;
    let first = mesh.positions.len() as u32;
    for row in 0..rows {
        for column in 0..across {
            let at = |r: usize, c: usize| points[r * across + c];
            let wrap = |c: usize, step: isize| match (ring, c as isize + step) {
                (true, -1) => across - 2,
                (true, n) if n as usize == across => 1,
                (_, n) => (n.max(0) as usize).min(across - 1),
            };
            let (up, down) = (row.saturating_sub(1), (row + 1).min(rows - 1));
            let right = at(row, wrap(column, 1)) - at(row, wrap(column, -1));
            let below = at(down, column) - at(up, column);
            let mut n = below.cross(right);
            if n.length_squared() < 1e-16 {
                // Where a row is one point: from the next.
                let next = (row + 1).min(rows - 1);
                let right = at(next, across / 2) - at(next, 0);
                let back = at(next, across / 4) - at(next, 3 * across / 4);
                n = back.cross(right);
                n = if n.y < 0.0 { -n } else { n };
            }
            let i = row * across + column;
            push(mesh, points[i], n.normalize_or(Vec3::Y), uvs[i], skin(i));
        }
    }
    for row in 1..rows {
        for column in 1..across {
            let v = |r: usize, c: usize| first + (r * across + c) as u32;
            let [a, b] = [v(row - 1, column - 1), v(row - 1, column)];
            let [d, c] = [v(row, column - 1), v(row, column)];
            mesh.triangles.push(Triangle::new([a, d, c]));
            if points[(row - 1) * across + column - 1] != points[(row - 1) * across + column] {
                mesh.triangles.push(Triangle::new([a, c, b]));
            }
        }
    }
}

/// Unevenness in -1..1 that differs from person to person, smooth over a distance of about 1.
pub(super) fn lump(p: Vec3, seed: u64) -> f32 {
    let mut dice = Dice::new(seed, 7);
    let mut wave = |a: f32, b: f32, c: f32| {
        let phase = dice.range(0.0, std::f32::consts::TAU);
        libm::sinf(p.x * a + p.y * b + p.z * c + phase)
    };
    (wave(1.9, 1.2, -0.8) + wave(-1.0, 2.3, 1.7) + wave(2.7, -0.6, 2.2) + wave(0.4, 1.3, -2.6))
        / 3.0
}
