//! Clothes: where the garment shell is cut, and how far it stands off the body.
//!
//! Every garment is a field over the template (metres inside its edge, negative outside), so the
//! same cut fits every body, and skin can be asked whether it lies underneath. The shell is pushed
//! out along its normals; hollows between the push and a smoothed shell are bridged as cloth does.
//! Poses and colours are not known here.

use glam::Vec3;

use crate::library::figure::data::LIMB_UNIT;
use crate::library::figure::{Figure, GroupId, LOD_COUNT};
use crate::scene::{BottomKind, Outfit};

/// Lower edge of tops on the template, metres above its origin.
const HEM_Y: f32 = 0.012;
/// Upper edge of trousers, under the top.
const WAIST_Y: f32 = 0.070;
/// How far shoes stand off the foot.
const SHOE_M: f32 = 0.009;
/// Cloth that lies over another keeps this distance.
const LAYER_M: f32 = 0.005;
/// Depth under a garment from which skin is never seen, by level of detail: less where skin and
/// cloth follow each other less closely.
const HIDDEN_M: [f32; LOD_COUNT] = [0.016, 0.016, 0.012, 0.006, 0.002];
/// How far skin under cloth is drawn inwards, by level of detail.
const TUCK_M: [f32; LOD_COUNT] = [0.004, 0.004, 0.006, 0.010, 0.016];
/// Lengths of arm and leg on the template.
const ARM_M: f32 = 0.42;
const LEG_M: f32 = 0.80;

/// Values of every garment's field at one vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fields {
    pub top: f32,
    pub bottom: f32,
    pub shoes: f32,
    /// How far from any opening: not to be seen from there is also what lies under two garments.
    pub depth: f32,
}

/// Place of a vertex on the template.
#[derive(Clone, Copy)]
struct Place {
    p: Vec3,
    arm: f32,
    leg: f32,
}

/// Cuts of one person's clothes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cuts {
    sleeve: f32,
    neckline: f32,
    top_m: f32,
    leg_end: f32,
    bottom_m: f32,
    trousers: bool,
}

impl Cuts {
    pub fn new(outfit: &Outfit) -> Self {
        let trousers = outfit.bottom.kind == BottomKind::Trousers;
        let (least, most) = if trousers { (0.5, 1.0) } else { (0.18, 0.62) };
        let length = (outfit.bottom.length as f32).clamp(least, most);
        Self {
            sleeve: (outfit.top.sleeve as f32).clamp(0.12, 0.97),
            neckline: (outfit.top.neckline as f32).clamp(0.0, 1.0),
            top_m: (outfit.top.looseness_m as f32).clamp(0.0, 0.06),
            // Trousers that reach the ankle rest on the shoes.
            leg_end: length + 0.03 * step(0.9, 1.0, length),
            bottom_m: (outfit.bottom.looseness_m as f32).clamp(0.0, 0.05),
            trousers,
        }
    }

    fn fields(&self, at: Place) -> Fields {
        let Place { p, arm, leg } = at;
        let on_arm = step(0.02, 0.10, arm);
        let hem = p.y - HEM_Y + on_arm;
        let sleeve = (self.sleeve - arm) * ARM_M;
        let cuff = (self.leg_end - leg) * LEG_M;
        let neck = self.neck(p);
        let waist = WAIST_Y - p.y - on_arm;
        let shoes = -0.732 - 0.15 * p.z.clamp(-0.05, 0.07) - p.y;
        // Top and trousers close each other's opening at the waist; wide ones can be looked into.
        let in_top = (hem + 0.03).min(sleeve - 2.0 * self.top_m).min(neck - self.top_m);
        let deep = if self.trousers { 2.5 } else { 8.0 } * self.bottom_m;
        let in_bottom = (waist + 0.03).min(cuff - deep).min(p.y + 0.775);
        Fields {
            top: hem.min(sleeve).min(neck),
            bottom: waist.min(cuff).min(p.y + 0.775),
            shoes,
            depth: in_top.max(in_bottom).max(shoes),
        }
    }

    /// About the distance from the neckline, a closed curve round the neck that dips in front.
    /// Outwards and downwards count alike, so that the cut crosses the skin at a right angle both
    /// on the neck's steep sides and on the flat shoulders.
    fn neck(&self, p: Vec3) -> f32 {
        let t = self.neckline;
        let (x, z) = (p.x, p.z - 0.020);
        let radius = (x * x + z * z).sqrt();
        let ahead = z / radius.max(1e-4);
        let (side_r, side_y) = (0.066 + 0.020 * t, 0.573 - 0.004 * t);
        let (r, y) =
            if ahead > 0.0 { (0.070 + 0.042 * t, 0.538 - 0.085 * t) } else { (0.064, 0.556) };
        // Flat at the front and at the back, so that deep necklines are round.
        let across = 1.0 - ahead * ahead;
        let w = 1.0 - across * across;
        let (r, y) = (side_r + (r - side_r) * w, side_y + (y - side_y) * w);
        0.6 * (radius - r) + 0.8 * (y - p.y)
    }
}

/// Fields at the first `count` vertices of the skin or the shell.
pub(super) fn fields(figure: &Figure, cuts: &Cuts, id: GroupId, count: u32) -> Vec<Fields> {
    places(figure, id, count).map(|at| cuts.fields(at)).collect()
}

fn places(figure: &Figure, id: GroupId, count: u32) -> impl Iterator<Item = Place> + '_ {
    figure.vertices(id, count).map(|v| place(figure, v))
}

fn place(figure: &Figure, v: usize) -> Place {
    let (d, t) = (figure.data(), figure.template());
    Place {
        p: Vec3::new(t.x[v], t.y[v], t.z[v]),
        arm: f32::from(d.arm[v]) * LIMB_UNIT,
        leg: f32::from(d.leg[v]) * LIMB_UNIT,
    }
}

/// The fields half way between two vertices of the shell.
pub(super) fn fields_between(figure: &Figure, cuts: &Cuts, a: usize, b: usize) -> Fields {
    let [a, b] = [a, b].map(|i| place(figure, figure.group(GroupId::Shell).first as usize + i));
    cuts.fields(Place {
        p: (a.p + b.p) * 0.5,
        arm: (a.arm + b.arm) * 0.5,
        leg: (a.leg + b.leg) * 0.5,
    })
}

/// Which of the first `count` skin vertices can never be seen.
pub(super) fn hidden(figure: &Figure, fields: &[Fields], lod: usize) -> Vec<bool> {
    fields
        .iter()
        .zip(&figure.data().covered)
        .map(|(f, &covered)| covered != 0 && f.depth > HIDDEN_M[lod])
        .collect()
}

/// Draws covered skin near a hem a little inwards, so that it never shows through the cloth.
pub(super) fn tuck(
    figure: &Figure,
    fields: &[Fields],
    lod: usize,
    skin: &mut [Vec3],
    normals: &[Vec3],
) {
    for (((p, n), f), &covered) in
        skin.iter_mut().zip(normals).zip(fields).zip(&figure.data().covered)
    {
        let depth = f.top.max(f.bottom).max(f.shoes);
        if covered != 0 && depth > -0.002 {
            *p -= *n * (TUCK_M[lod] * step(-0.002, 0.010, depth));
        }
    }
}

/// The three garments' surfaces: the shell's vertices moved out.
pub(super) struct Layers {
    pub top: Vec<Vec3>,
    pub bottom: Vec<Vec3>,
    pub shoes: Vec<Vec3>,
    pub soles: Vec<Vec3>,
}

/// Moves the shell's vertices out for each garment.
pub(super) fn layers(
    figure: &Figure,
    cuts: &Cuts,
    fields: &[Fields],
    lod: usize,
    shell: &[Vec3],
    normals: &[Vec3],
) -> Layers {
    let rounds = [7, 5, 3, 2, 1][lod];
    let group = figure.group(GroupId::Shell);
    let net = Net { render: &group.render, triangles: &group.lods[lod].triangles };
    let smooth = net.smoothed(shell, rounds);
    // How far the smoothed shell lies outside the shell itself: hollows that cloth bridges.
    let bridge: Vec<f32> =
        shell.iter().zip(&smooth).zip(normals).map(|((p, s), n)| (*s - *p).dot(*n)).collect();
    let places: Vec<Place> = places(figure, GroupId::Shell, shell.len() as u32).collect();

    let shoes: Vec<f32> = bridge.iter().map(|b| SHOE_M.max(b + 0.006).min(0.022)).collect();
    let mut bottom: Vec<f32> = (0..shell.len())
        .map(|i| {
            let base = bottom_push(cuts, &places[i], &fields[i]);
            let bridged = base.max(bridge[i] + 0.4 * base).min(base + 0.03);
            let over_shoe = step(-0.02, -0.005, fields[i].shoes) * f32::from(cuts.trousers);
            bridged.max(over_shoe * (shoes[i] + LAYER_M))
        })
        .collect();
    net.soften(&mut bottom, 2);
    let mut top: Vec<f32> = (0..shell.len())
        .map(|i| {
            let base = top_push(cuts, &places[i], &fields[i]);
            base.max(bridge[i] + 0.4 * base).min(base + 0.03)
        })
        .collect();
    net.soften(&mut top, 2);
    for i in 0..top.len() {
        if fields[i].bottom > -0.03 {
            top[i] = top[i].max(bottom[i] + LAYER_M);
        }
    }
    let pushed = |by: &[f32]| -> Vec<Vec3> {
        shell.iter().zip(normals).zip(by).map(|((p, n), h)| *p + *n * *h).collect()
    };
    let mut layers = Layers {
        top: pushed(&top),
        bottom: pushed(&bottom),
        shoes: pushed(&shoes),
        soles: Vec::new(),
    };
    part_legs(&places, &mut layers.bottom);
    part_legs(&places, &mut layers.top);
    flatten_soles(figure, &mut layers.shoes);
    layers.soles = layers
        .shoes
        .iter()
        .zip(normals)
        .map(|(p, n)| *p + Vec3::new(n.x, 0.0, n.z).normalize_or_zero() * 0.003)
        .collect();
    layers
}

/// How far trousers stand off before hollows are bridged: close at the waist, straight down the
/// leg although the calf narrows.
fn bottom_push(cuts: &Cuts, at: &Place, f: &Fields) -> f32 {
    let waist = step(0.0, 0.10, WAIST_Y - at.p.y);
    let straight =
        if cuts.trousers { 0.9 * step(0.62, 1.0, at.leg) } else { 0.7 * step(0.1, 0.5, at.leg) };
    let loose = cuts.bottom_m * (0.25 + 0.75 * waist) * (1.0 + straight);
    (0.002 + loose).max(if f.bottom > -0.02 { 0.002 } else { 0.0 })
}

/// How far a top stands off: close round the neck, loose at the sleeve's end and over the belly.
fn top_push(cuts: &Cuts, at: &Place, f: &Fields) -> f32 {
    let collar = 0.25 + 0.75 * step(0.0, 0.12, cuts.neck(at.p));
    let on_arm = step(0.05, 0.2, at.arm);
    let sleeve_end = on_arm * 0.35 * step(0.10, 0.0, f.top);
    0.0025 + cuts.top_m * collar * (1.0 + sleeve_end - 0.25 * on_arm)
}

/// Keeps the two legs' cloth on its own side of the middle.
fn part_legs(places: &[Place], layer: &mut [Vec3]) {
    const GAP_M: f32 = 0.0012;
    for (q, at) in layer.iter_mut().zip(places) {
        let side = at.p.x.signum();
        if at.leg > -0.05 && at.p.x.abs() > 0.001 && at.p.y < 0.02 && q.x * side < GAP_M {
            q.x = GAP_M * side;
        }
    }
}

/// The lowest parts of the shoes form a plane on the ground, with a crisp edge.
fn flatten_soles(figure: &Figure, shoes: &mut [Vec3]) {
    const FLAT_M: f32 = 0.010;
    const BLEND_M: f32 = 0.034;
    for q in shoes.iter_mut().filter(|q| q.y < BLEND_M) {
        q.y = ((q.y - FLAT_M) * (BLEND_M / (BLEND_M - FLAT_M))).max(0.0);
    }
    let first = figure.group(GroupId::Shell).first as usize;
    for &v in &figure.data().sole {
        if let Some(q) = shoes.get_mut(usize::from(v) - first) {
            q.y = 0.0;
        }
    }
}

/// The shell's triangles as a net of neighbours.
struct Net<'a> {
    render: &'a [u16],
    triangles: &'a [u16],
}

impl Net<'_> {
    fn each(&self, mut f: impl FnMut([usize; 3])) {
        for t in self.triangles.chunks_exact(3) {
            f([t[0], t[1], t[2]].map(|r| usize::from(self.render[usize::from(r)])));
        }
    }

    /// Means of neighbours, half way, `rounds` times.
    fn smoothed(&self, points: &[Vec3], rounds: usize) -> Vec<Vec3> {
        let mut out = points.to_vec();
        for _ in 0..rounds {
            let mut sums = vec![(Vec3::ZERO, 0.0f32); out.len()];
            self.each(|[a, b, c]| {
                for (v, x, y) in [(a, b, c), (b, c, a), (c, a, b)] {
                    sums[v].0 += out[x] + out[y];
                    sums[v].1 += 2.0;
                }
            });
            for (p, (sum, n)) in out.iter_mut().zip(sums) {
                if n > 0.0 {
                    *p = (*p + sum / n) * 0.5;
                }
            }
        }
        out
    }

    /// The same for numbers.
    fn soften(&self, values: &mut [f32], rounds: usize) {
        for _ in 0..rounds {
            let mut sums = vec![(0.0f32, 0.0f32); values.len()];
            self.each(|[a, b, c]| {
                for (v, x, y) in [(a, b, c), (b, c, a), (c, a, b)] {
                    sums[v].0 += values[x] + values[y];
                    sums[v].1 += 2.0;
                }
            });
            for (v, (sum, n)) in values.iter_mut().zip(sums) {
                if n > 0.0 {
                    *v = (*v + sum / n) * 0.5;
                }
            }
        }
    }
}

/// 0 below a, 1 above b, smooth between; falling where a > b.
pub(super) fn step(a: f32, b: f32, x: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cuts(neckline: f32) -> Cuts {
        Cuts { sleeve: 0.4, neckline, top_m: 0.01, leg_end: 1.0, bottom_m: 0.01, trousers: true }
    }

    #[test]
    fn necklines_are_round_and_deepen_in_front_only() {
        let crew = cuts(0.0);
        let deep = cuts(1.0);
        let throat = Vec3::new(0.0, 0.56, 0.075);
        let chest = Vec3::new(0.0, 0.47, 0.119);
        let back = Vec3::new(0.0, 0.50, -0.053);
        let above = Vec3::new(0.04, 0.61, 0.03);
        assert!(crew.neck(throat) < 0.0 && deep.neck(throat) < 0.0);
        assert!(crew.neck(above) < 0.0 && deep.neck(above) < 0.0);
        assert!(crew.neck(chest) > 0.02 && deep.neck(chest) < 0.0);
        assert!(crew.neck(back) > 0.0 && deep.neck(back) > 0.0);
        assert_eq!(crew.neck(chest), crew.neck(chest * Vec3::new(-1.0, 1.0, 1.0)));
    }

    #[test]
    fn a_top_covers_the_chest_and_trousers_the_legs() {
        let c = cuts(0.2);
        let chest = c.fields(Place { p: Vec3::new(0.0, 0.3, 0.15), arm: -0.2, leg: -0.5 });
        assert!(chest.top > 0.1 && chest.bottom < 0.0 && chest.shoes < 0.0);
        let knee = c.fields(Place { p: Vec3::new(0.15, -0.37, 0.05), arm: -0.2, leg: 0.5 });
        assert!(knee.bottom > 0.1 && knee.top < 0.0);
        let toe = c.fields(Place { p: Vec3::new(0.22, -0.80, 0.15), arm: -0.2, leg: 1.1 });
        assert!(toe.shoes > 0.0 && toe.bottom < 0.0);
    }
}
