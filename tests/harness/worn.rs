//! What shows through the clothes of a dressed, posed person, measured in the engine's samples.
//!
//! A triangle of the skin or of a garment is *covered* by another garment if at rest one meets
//! that garment's inner side on the way outwards from it. A pixel shows a flaw where it shows a
//! covered triangle although the outer side of the same garment at the same place of the body
//! follows close behind: there the view enters the body before it enters the cloth. Looking into
//! a sleeve, a collar or under a hem is no flaw: from there the next outer side is that of another
//! limb, or far off. Nor are the edges of cloth an outer side, since nothing lies under them.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use figurant_core::draw::DrawList;
use figurant_core::draw::abi::{Draw, DrawObject, Material, View};
use figurant_core::engine::Engine;
use figurant_core::geometry::person::{Dressed, PartKind};
use figurant_core::geometry::skeleton::JOINT_NAMES;
use figurant_core::library::mesh::{Mesh, Triangle};
use figurant_core::plan::{Frame, Output, Outputs, PassPlan, SceneFacts, StageTimes};
use figurant_core::scene::{BottomKind, OuterKind, Outfit, TopKind};
use glam::Vec3;

/// A covered triangle may lie this far outside the garment at rest, metres.
const OUTSIDE_M: f32 = 0.02;
/// How far off a garment may be that covers something, metres.
const COVERS_M: f32 = 0.06;
/// The same for skirts and coats, which hang from the waist.
const HANGS_M: f32 = 0.5;
/// What pokes out of a garment stands at its edges at most this far before it, metres.
const BEFORE_M: f32 = 0.05;
/// Edge of a cell of the grid in which triangles are looked up, metres.
const CELL_M: f32 = 0.06;
/// Over an edge of cloth the normal turns by more than this: cosine.
const EDGE_COS: f32 = 0.4;
/// Edge of a cell of the body at rest; neighbouring ones are the same place.
const PLACE_M: f32 = 0.08;

/// What lies over what, from the skin outwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Layer {
    /// Bare skin.
    Skin,
    /// Socks.
    Socks,
    /// Shoes with their soles.
    Shoes,
    /// Trousers or a skirt.
    Bottom,
    /// A top or a dress.
    Top,
    /// A jacket or a coat.
    Outer,
}

impl Layer {
    /// Those that can be over another.
    const GARMENTS: [Self; 5] = [Self::Socks, Self::Shoes, Self::Bottom, Self::Top, Self::Outer];

    /// Eyes, hair and glasses belong to none.
    const fn of(kind: PartKind) -> Option<Self> {
        match kind {
            PartKind::Skin | PartKind::Underwear => Some(Self::Skin),
            PartKind::Socks => Some(Self::Socks),
            PartKind::Shoes | PartKind::Soles => Some(Self::Shoes),
            PartKind::Bottom => Some(Self::Bottom),
            PartKind::Top => Some(Self::Top),
            PartKind::Outer => Some(Self::Outer),
            _ => None,
        }
    }

    /// Whether the wearer means to have it over another.
    fn is_over(self, other: Self, outfit: &Outfit) -> bool {
        let bottom = outfit.bottom.kind;
        let wide = matches!(outfit.top.kind, TopKind::Hoodie | TopKind::Sweater);
        match (other, self) {
            // Leggings go into boots; trousers that reach the ankle fall over shoes.
            (Self::Bottom, Self::Shoes) => bottom == BottomKind::Leggings,
            (Self::Shoes, Self::Bottom) => {
                bottom.is_skirt() || bottom != BottomKind::Leggings && outfit.bottom.length > 0.9
            }
            // Tops are tucked into skirts.
            (Self::Bottom, Self::Top) => wide || !bottom.is_skirt(),
            (Self::Top, Self::Bottom) => !wide && bottom.is_skirt(),
            _ => self > other,
        }
    }
}

/// A limb, or the rest of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Limb {
    /// Trunk and head.
    Trunk,
    /// With the hand.
    LeftArm,
    /// With the hand.
    RightArm,
    /// With the foot.
    LeftLeg,
    /// With the foot.
    RightLeg,
}

impl Limb {
    fn of_joint(joint: usize) -> Self {
        let Some(name) = JOINT_NAMES.get(joint) else { return Self::Trunk };
        let has = |names: &[&str]| names.iter().any(|n| name.ends_with(n) || name.contains("Hand"));
        let leg = name.contains("Leg") || name.contains("Foot") || name.contains("Toe");
        match (name.starts_with("Left"), name.starts_with("Right")) {
            (true, _) if leg => Self::LeftLeg,
            (_, true) if leg => Self::RightLeg,
            (true, _) if has(&["Arm"]) => Self::LeftArm,
            (_, true) if has(&["Arm"]) => Self::RightArm,
            _ => Self::Trunk,
        }
    }

    const fn is_arm(self) -> bool {
        matches!(self, Self::LeftArm | Self::RightArm)
    }
}

/// Something that shows through something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flaw {
    /// What is seen.
    pub under: Layer,
    /// What should cover it.
    pub over: Layer,
    /// Where.
    pub limb: Limb,
    /// How many connected pixels.
    pub pixels: usize,
    /// One of them.
    pub at: [usize; 2],
}

/// What the triangles of one object have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Patch {
    layer: Option<Layer>,
    limb: Limb,
    /// A bit for each of [`Layer::GARMENTS`] that covers them.
    covered: u8,
    /// Something that it should cover lies under it.
    covers: bool,
    /// Where it is at rest, in cells of [`PLACE_M`].
    place: [i32; 3],
    double_sided: bool,
}

impl Patch {
    /// Whether another is at the same place of the body.
    fn is_beside(&self, other: &Self) -> bool {
        let near = self.place.iter().zip(&other.place).all(|(a, b)| (a - b).abs() <= 1);
        let trunk = self.limb == Limb::Trunk || other.limb == Limb::Trunk;
        near && (trunk || self.limb == other.limb)
    }
}

/// A garment at rest.
struct Cloth {
    triangles: Vec<[Vec3; 3]>,
    cells: HashMap<[i32; 3], Vec<usize>>,
    hangs: bool,
}

impl Cloth {
    fn new(triangles: Vec<[Vec3; 3]>, hangs: bool) -> Self {
        let mut cells: HashMap<[i32; 3], Vec<usize>> = HashMap::new();
        for (i, [a, b, c]) in triangles.iter().enumerate() {
            for cell in cells_of(a.min(*b).min(*c), a.max(*b).max(*c)) {
                cells.entry(cell).or_default().push(i);
            }
        }
        Self { triangles, cells, hangs }
    }

    /// Whether a way, whose length is that of `along`, leaves the garment (sign -1) or enters it.
    fn is_crossed(&self, sign: f32, from: Vec3, along: Vec3) -> bool {
        let to = from + along;
        let mut near = cells_of(from.min(to), from.max(to)).filter_map(|c| self.cells.get(&c));
        near.any(|own| {
            own.iter().any(|&i| {
                let [a, b, c] = self.triangles[i];
                let (e1, e2) = (b - a, c - a);
                let h = along.cross(e2);
                let det = e1.dot(h);
                let s = (from - a) / det;
                let q = s.cross(e1);
                let (u, v, t) = (s.dot(h), along.dot(q), e2.dot(q));
                // The determinant is negative where the way goes with the triangle's normal.
                sign * det > 1e-12
                    && u >= 0.0
                    && v >= 0.0
                    && u + v <= 1.0
                    && (0.0..=1.0).contains(&t)
            })
        })
    }

    fn covers(&self, at: Vec3, normal: Vec3, limb: Limb) -> bool {
        let reach =
            |out: Vec3, m: f32| self.is_crossed(-1.0, at - out * OUTSIDE_M, out * (m + OUTSIDE_M));
        let outwards = Vec3::new(at.x, 0.0, at.z).normalize_or(Vec3::Z);
        reach(normal, COVERS_M) || self.hangs && !limb.is_arm() && reach(outwards, HANGS_M)
    }
}

fn cell_of(p: Vec3, edge_m: f32) -> [i32; 3] {
    [0, 1, 2].map(|k| (p[k] / edge_m).floor() as i32)
}

fn cells_of(low: Vec3, high: Vec3) -> impl Iterator<Item = [i32; 3]> {
    let (low, high) = (cell_of(low, CELL_M), cell_of(high, CELL_M));
    let spans = [0, 1, 2].map(|k| low[k]..=high[k]);
    let [x, y, z] = spans;
    x.flat_map(move |x| {
        let (y, z) = (y.clone(), z.clone());
        y.flat_map(move |y| z.clone().map(move |z| [x, y, z]))
    })
}

/// What of a person is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shown {
    All,
    Outsides,
    OutsideOf(Layer),
}

/// A person whose triangles are sorted into patches.
pub struct Sorted {
    patches: Vec<(Patch, Arc<Mesh>)>,
    /// Which of [`Layer::GARMENTS`] hang round both legs.
    hangs: [bool; 5],
}

impl Sorted {
    /// Finds out what covers what.
    #[must_use]
    pub fn new(dressed: &Dressed, outfit: &Outfit) -> Self {
        let mesh = &dressed.mesh;
        let corner = |t: u32| {
            mesh.triangles[t as usize].get().map(|v| Vec3::from_array(mesh.positions[v as usize]))
        };
        let of_layer = |layer: Layer| {
            let parts = dressed.parts.iter().filter(move |p| Layer::of(p.kind) == Some(layer));
            let triangles = parts.flat_map(|p| p.triangles.clone());
            triangles.filter(|t| !is_edge(mesh, *t)).map(corner).collect::<Vec<_>>()
        };
        let hangs = Layer::GARMENTS.map(|layer| match layer {
            Layer::Bottom => outfit.bottom.kind.is_skirt(),
            Layer::Top => outfit.bottom.kind.is_dress(),
            Layer::Outer => outfit.outer.kind == OuterKind::Coat,
            _ => false,
        });
        let cloth = [0, 1, 2, 3, 4].map(|k| Cloth::new(of_layer(Layer::GARMENTS[k]), hangs[k]));
        let limbs: Vec<Limb> = (0..JOINT_NAMES.len()).map(Limb::of_joint).collect();
        let skin = Cloth::new(of_layer(Layer::Skin), false);
        let layers = || cloth.iter().zip(Layer::GARMENTS).chain([(&skin, Layer::Skin)]);
        let patch = |t: u32, kind: PartKind, double_sided: bool| {
            let limb = limb_of(mesh, t, &limbs);
            let layer = Layer::of(kind);
            let cloth_of = layer.filter(|_| !is_edge(mesh, t));
            let [a, b, c] = corner(t);
            let (middle, normal) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize_or_zero());
            let covers = |k: &usize| {
                let over = Layer::GARMENTS[*k];
                cloth_of.is_some_and(|l| over != l && over.is_over(l, outfit))
                    && cloth[*k].covers(middle, normal, limb)
            };
            let covered = (0..5).filter(covers).fold(0, |bits, k| bits | 1 << k);
            let (from, along) = (middle + normal * OUTSIDE_M, -normal * (COVERS_M + OUTSIDE_M));
            let is_under =
                |under: Layer| cloth_of.is_some_and(|l| l != under && l.is_over(under, outfit));
            let hangs =
                cloth_of.is_some_and(|l| (0..5).any(|k| hangs[k] && Layer::GARMENTS[k] == l));
            let covers = hangs
                || layers().any(|(c, under)| is_under(under) && c.is_crossed(1.0, from, along));
            let place = if covered != 0 || covers { cell_of(middle, PLACE_M) } else { [0; 3] };
            Patch { layer, limb, covered, covers, place, double_sided }
        };
        let all = dressed
            .parts
            .iter()
            .flat_map(|p| p.triangles.clone().map(move |t| (t, p.kind, p.double_sided)));
        let mut sorted: Vec<(Patch, u32)> = all.map(|(t, k, d)| (patch(t, k, d), t)).collect();
        sorted.sort_unstable();
        let runs = sorted.chunk_by(|a, b| a.0 == b.0);
        let patches = runs.map(|run| (run[0].0, Arc::new(piece(mesh, run.iter().map(|r| r.1)))));
        Self { patches: patches.collect(), hangs }
    }

    /// What shows through, seen with a palette (`view_from_rest` of every joint); smaller spots
    /// than `least` pixels do not count.
    pub fn flaws(
        &self,
        engine: &mut dyn Engine,
        view: View,
        palette: &[[[f32; 4]; 3]],
        least: usize,
    ) -> Vec<Flaw> {
        let mut render = |list: &DrawList| {
            let plan = PassPlan::new(&Outputs::from([Output::Instance]), SceneFacts::default());
            engine.render(list, &plan, &mut StageTimes::default()).expect("a sound draw list")
        };
        let seen = render(&self.list(view, palette, Shown::All));
        // Whoever sees the inside of a garment looks into an opening.
        let outsides = render(&self.list(view, palette, Shown::Outsides));
        let patch = |frame: &Frame, i: usize| {
            let id = frame.object_ids.as_ref().map_or(0, |ids| ids[i]);
            (id > 0).then(|| self.patches[usize::from(id) - 1].0)
        };
        let depth = |frame: &Frame, i: usize| frame.depth_m.as_ref().map_or(0.0, |d| d[i]);
        let mut all = Vec::new();
        for (k, over) in Layer::GARMENTS.into_iter().enumerate() {
            if !self.patches.iter().any(|(p, _)| p.covered & 1 << k != 0) {
                continue;
            }
            let outside = render(&self.list(view, palette, Shown::OutsideOf(over)));
            let pixels = (view.width * view.height) as usize;
            let shows = |i: usize| {
                let (under, cloth) = (patch(&seen, i)?, patch(&outside, i)?);
                // A skirt is round both legs; out of a coat, which is open in front, they may step.
                let closed = self.hangs[k] && over != Layer::Outer;
                let legs = closed && !under.limb.is_arm() && !cloth.limb.is_arm();
                let near = cloth.covers && (legs || under.is_beside(&cloth));
                let before = depth(&outside, i) - depth(&seen, i);
                let pokes =
                    before > 0.0 && before < BEFORE_M && depth(&outsides, i) == depth(&seen, i);
                let flaw = under.covered & 1 << k != 0 && near && pokes;
                flaw.then_some(under).and_then(|u| Some((u.layer?, u.limb)))
            };
            let marks: Vec<_> = (0..pixels).map(shows).collect();
            all.extend(
                regions(&marks, view.width as usize)
                    .into_iter()
                    .filter(|r| r.1 >= least)
                    .map(|((under, limb), pixels, at)| Flaw { under, over, limb, pixels, at }),
            );
        }
        all.sort_by_key(|f| std::cmp::Reverse(f.pixels));
        all
    }

    /// Patches keep their numbers, whichever are shown.
    fn list(&self, view: View, palette: &[[[f32; 4]; 3]], show: Shown) -> DrawList {
        let mut list = DrawList {
            view,
            samples: 1,
            palette: palette.to_vec(),
            materials: vec![Material::default()],
            ..DrawList::default()
        };
        for (object, (patch, mesh)) in self.patches.iter().enumerate() {
            let shown = match show {
                Shown::All | Shown::Outsides => true,
                Shown::OutsideOf(layer) => patch.layer == Some(layer),
            };
            let triangles: Range<u32> = 0..if shown { mesh.triangles.len() as u32 } else { 0 };
            list.objects.push(DrawObject {
                mesh: Arc::clone(mesh),
                view_from_model: [[0.0; 4]; 3],
                palette: 0..palette.len() as u32,
                end: None,
                in_view: shown,
                casts_shadow: false,
                smooth: true,
                blockers: 0..0,
            });
            if shown {
                list.draws.push(Draw {
                    object: object as u32,
                    triangles,
                    material: 0,
                    double_sided: patch.double_sided && show == Shown::All,
                    cutout: None,
                });
            }
        }
        list
    }
}

/// The limb that moves a triangle most.
fn limb_of(mesh: &Mesh, t: u32, limbs: &[Limb]) -> Limb {
    let mut sums = [0u32; 5];
    for v in mesh.triangles[t as usize].get() {
        let skin = &mesh.skin[v as usize];
        for (&joint, &weight) in skin.joints.iter().zip(&skin.weights) {
            // Beyond the skeleton's joints there are those of skirts.
            let limb = limbs.get(usize::from(joint)).copied().unwrap_or(Limb::Trunk);
            sums[limb as usize] += u32::from(weight);
        }
    }
    let all = [Limb::Trunk, Limb::LeftArm, Limb::RightArm, Limb::LeftLeg, Limb::RightLeg];
    all.into_iter().max_by_key(|l| sums[*l as usize]).unwrap_or(Limb::Trunk)
}

/// Whether a triangle belongs to the thickness of a hem, which has no inner or outer side.
fn is_edge(mesh: &Mesh, t: u32) -> bool {
    let [a, b, c] =
        mesh.triangles[t as usize].get().map(|v| Vec3::from_array(mesh.normals[v as usize].unit()));
    a.dot(b).min(b.dot(c)).min(c.dot(a)) < EDGE_COS
}

/// Some triangles of a mesh with their own vertices.
fn piece(mesh: &Mesh, triangles: impl Iterator<Item = u32>) -> Mesh {
    let mut own: HashMap<u32, u32> = HashMap::new();
    let mut out = Mesh { center: mesh.center, radius_m: mesh.radius_m, ..Mesh::default() };
    for t in triangles {
        let corners = mesh.triangles[t as usize].get().map(|v| {
            *own.entry(v).or_insert_with(|| {
                let i = v as usize;
                out.positions.push(mesh.positions[i]);
                out.normals.push(mesh.normals[i]);
                out.uvs.push(mesh.uvs[i]);
                out.skin.push(mesh.skin[i]);
                out.positions.len() as u32 - 1
            })
        });
        out.triangles.push(Triangle::new(corners));
    }
    out
}

/// Connected pixels, diagonals included, of one layer: what and where they are first met, how
/// many, and one of them.
fn regions<T: Copy, L: Copy + PartialEq>(
    marks: &[Option<(L, T)>],
    width: usize,
) -> Vec<((L, T), usize, [usize; 2])> {
    let height = marks.len() / width;
    let mut done = vec![false; marks.len()];
    let mut found = Vec::new();
    for start in 0..marks.len() {
        let Some(what) = marks[start].filter(|_| !done[start]) else { continue };
        done[start] = true;
        let (mut open, mut count) = (vec![start], 0);
        while let Some(i) = open.pop() {
            count += 1;
            let (x, y) = (i % width, i / width);
            for near_y in y.saturating_sub(1)..(y + 2).min(height) {
                for near_x in x.saturating_sub(1)..(x + 2).min(width) {
                    let j = near_y * width + near_x;
                    if !done[j] && marks[j].is_some_and(|m| m.0 == what.0) {
                        done[j] = true;
                        open.push(j);
                    }
                }
            }
        }
        found.push((what, count, [start % width, start / width]));
    }
    found
}
