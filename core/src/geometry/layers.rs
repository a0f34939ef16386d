//! The surfaces of garments: the shell's vertices moved out.
//!
//! Each layer is pushed out along the shell's normals, bridges its hollows, and hangs from the
//! chest, the shoulders and the hips as tubes do. Layers lie in order: trousers and shoes, skirts
//! and tops, what is worn over tops; each keeps off the one below. Where the pieces end is decided
//! in [`super::garment`].

use glam::Vec3;

use super::drape::Tube;
use super::garment::{Cuts, Fields, Piece, Place, step};
use super::over_seat::span;
use super::shell::{Shell, TUBE};
use super::skeleton::{Limb, Side};
use crate::library::figure::{ARM_M, Figure, GroupId};
use crate::scene::{BottomKind, TopKind};

/// Cloth that lies over another keeps this distance.
const LAYER_M: f32 = 0.005;
/// The same over a skirt, which follows the legs in another way.
const OVER_SKIRT_M: f32 = 0.013;
/// What a shirt's collar takes up under a jacket.
const UNDER_COLLAR_M: f32 = 0.004;
/// How far shoes stand off the foot.
const SHOE_M: f32 = 0.009;

/// How far a layer's cloth falls back towards the body below what it hangs from, metres a metre.
#[derive(Clone, Copy)]
struct Falls {
    trunk: f32,
    limb: f32,
}

/// Shoes and what stands on the ground.
pub(super) struct Footwear {
    pub shoes: Vec<Vec3>,
    pub soles: Vec<Vec3>,
    /// Nothing if none are worn.
    pub socks: Vec<Vec3>,
}

/// Shoes round the feet, with flat soles on the ground.
pub(super) fn footwear(shell: &Shell<'_>, cuts: &Cuts) -> Footwear {
    let off: Vec<f32> = shell
        .bridge
        .iter()
        .zip(shell.places)
        .map(|(b, at)| {
            // A shaft stands off the shin.
            let shaft = 0.006 * step(0.90, 0.78, at.leg);
            SHOE_M.max(b + 0.006).min(0.022) + shaft
        })
        .collect();
    let mut shoes = shell.pushed(&off);
    flatten_soles(shell.figure, &mut shoes);
    let outwards = |n: &Vec3| Vec3::new(n.x, 0.0, n.z).normalize_or_zero() * 0.003;
    let soles = shoes.iter().zip(shell.normals).map(|(p, n)| *p + outwards(n)).collect();
    let socks = if cuts.wears(Piece::Socks) {
        shell.pushed(&shell.heights(|_| 0.0018))
    } else {
        Vec::new()
    };
    Footwear { shoes, soles, socks }
}

/// Trousers, over the shoes where they reach them.
pub(super) fn bottom(
    shell: &Shell<'_>,
    (cuts, fields): (&Cuts, &Fields),
    shoes: &[Vec3],
) -> Vec<Vec3> {
    let tight = cuts.bottom == BottomKind::Leggings;
    let base = |i: usize| {
        let at = &shell.places[i];
        let waist = step(0.0, 0.10, super::garment::WAIST_Y - at.p.y);
        0.002 + cuts.bottom_m * (0.35 + 0.65 * waist)
    };
    let heights = if tight { vec![0.0025; shell.positions.len()] } else { shell.heights(base) };
    let mut layer = shell.pushed(&heights);
    if !tight {
        let loose = step(0.003, 0.016, cuts.bottom_m);
        let falls = match cuts.bottom {
            BottomKind::Jeans => Falls { trunk: 0.4, limb: 0.085 - 0.03 * loose },
            BottomKind::Shorts => Falls { trunk: 0.3, limb: 0.04 - 0.06 * loose },
            _ => Falls { trunk: 0.3, limb: 0.075 - 0.045 * loose },
        };
        drape_trousers(shell, cuts, &mut layer, falls);
    }
    let rests = !tight && cuts.leg_end > 0.9;
    shell.settle(&mut layer, shell.positions, 2, |i| {
        let over_shoe = step(-0.02, -0.005, fields.shoes[i]) * f32::from(rests);
        let shoe = (shoes[i] - shell.positions[i]).dot(shell.normals[i]) + LAYER_M;
        (0.85 * heights[i]).max(0.0022).max(over_shoe * shoe)
    });
    if !tight {
        crease(shell, &mut layer, 0.0012 + 0.25 * cuts.bottom_m);
    }
    part_legs(shell.places, &mut layer);
    layer
}

fn drape_trousers(shell: &Shell<'_>, cuts: &Cuts, layer: &mut [Vec3], falls: Falls) {
    if let Some(tube) = shell.trunk_tube(layer, (-0.10, 0.10), &[]) {
        let hips = |i: usize| 0.8 * step(0.14, 0.02, shell.places[i].leg);
        shell.spread(layer, &tube, hips, |_, _| 1.0);
    }
    let end = cuts.leg_end.min(0.94) + 0.04;
    for side in Side::BOTH {
        let on_leg = move |at: &Place| at.leg > 0.08 && at.leg < end && at.arm < 0.0;
        let Some(mut tube) = shell.limb_tube(layer, (side, Limb::UpLeg, Limb::Foot), on_leg) else {
            continue;
        };
        let sign = if side == Side::Left { 1.0 } else { -1.0 };
        // Between the thighs there is no room.
        tube.hang(|out| if out.x * sign < -0.3 { falls.limb + 0.05 } else { falls.limb });
        let own = |i: usize| {
            let at = &shell.places[i];
            f32::from((at.p.x > 0.0) == (sign > 0.0)) * step(0.08, 0.22, at.leg)
        };
        shell.spread(layer, &tube, own, |i, out| {
            let upper = step(0.45, 0.25, shell.places[i].leg);
            1.0 - 0.8 * step(0.0, -0.7, out.x * sign) * upper
        });
    }
}

/// A top, over trousers and over `skirt`, of which the points are given.
pub(super) fn top(
    shell: &Shell<'_>,
    (cuts, fields): (&Cuts, &Fields),
    bottom: Option<&[Vec3]>,
    skirt: &[Vec3],
) -> Vec<Vec3> {
    let gathered = matches!(cuts.top, TopKind::Hoodie | TopKind::Sweater);
    let base = |i: usize| {
        let (at, n) = (&shell.places[i], shell.normals[i]);
        let collar = 0.25 + 0.75 * step(0.0, 0.12, cuts.neck(at.p));
        0.0025 + cuts.top_m * collar * off_shoulders(at, n)
    };
    let heights = shell.heights(base);
    let mut layer = shell.pushed(&heights);
    let loose = step(0.002, 0.016, cuts.top_m);
    let falls = Falls { trunk: 0.75 - 0.62 * loose, limb: 0.5 - 0.38 * loose };
    drape_top(shell, &mut layer, skirt, falls, |at| {
        // Ribbed hems and the cuffs of long sleeves lie close.
        let long = gathered || cuts.sleeve > 0.9;
        if at.arm > 0.1 {
            if long { step(0.0, 0.05, (cuts.sleeve - at.arm) * ARM_M) } else { 1.0 }
        } else if gathered {
            0.35 + 0.65 * step(0.0, 0.05, at.p.y - 0.01)
        } else {
            1.0
        }
    });
    shell.settle(&mut layer, shell.positions, 2, |i| {
        let over = bottom.filter(|_| fields.bottom[i] > -0.03);
        let trousers =
            over.map_or(0.0, |b| (b[i] - shell.positions[i]).dot(shell.normals[i]) + LAYER_M);
        (0.85 * heights[i]).max(0.003).max(trousers)
    });
    crease(shell, &mut layer, 0.0010 + 0.22 * cuts.top_m);
    part_legs(shell.places, &mut layer);
    span(shell, &mut layer);
    keep_over_skirt(shell, &mut layer, skirt);
    layer
}

/// What is worn over the top, and over the skirt's points.
pub(super) fn outer(
    shell: &Shell<'_>,
    (cuts, fields): (&Cuts, &Fields),
    bottom: Option<&[Vec3]>,
    top: &[Vec3],
    skirt: &[Vec3],
) -> Vec<Vec3> {
    let under: Vec<Vec3> = (0..top.len())
        .map(|i| {
            let (p, n) = (shell.positions[i], shell.normals[i]);
            let over = bottom.filter(|_| fields.bottom[i] > -0.03);
            let trousers = over.map_or(p, |b| b[i]);
            let worn = fields.top[i] > -0.03;
            if worn && (top[i] - p).dot(n) > (trousers - p).dot(n) { top[i] } else { trousers }
        })
        .collect();
    let heights = shell.heights(|i| {
        let (at, n) = (&shell.places[i], shell.normals[i]);
        LAYER_M + cuts.outer_m * off_shoulders(at, n)
    });
    let mut layer: Vec<Vec3> = under
        .iter()
        .zip(shell.normals)
        .zip(&heights)
        .map(|((p, n), h)| *p + *n * h.min(LAYER_M + cuts.outer_m))
        .collect();
    let falls = Falls { trunk: 0.10, limb: 0.24 };
    drape_top(shell, &mut layer, skirt, falls, |_| 1.0);
    shell.settle(&mut layer, &under, 2, |i| {
        let collar = step(-0.02, 0.0, cuts.field(Piece::Collar, shell.places[i]));
        LAYER_M + UNDER_COLLAR_M * collar
    });
    // What is over another layer's creases must not be under them.
    crease(shell, &mut layer, 0.0012 + 0.22 * cuts.outer_m.max(cuts.top_m));
    part_legs(shell.places, &mut layer);
    span(shell, &mut layer);
    keep_over_skirt(shell, &mut layer, skirt);
    layer
}

/// Keeps what is worn over a skirt outside it, down to the hips.
fn keep_over_skirt(shell: &Shell<'_>, layer: &mut [Vec3], skirt: &[Vec3]) {
    const REACH_M: f32 = 0.16;
    let low = shell.head(0).y - REACH_M;
    let upper = skirt.iter().filter(|q| q.y > low).copied();
    let (rows, columns) = TUBE[shell.lod];
    let line = (shell.head(0), Vec3::NEG_Y);
    let Some(tube) = Tube::new(line, Vec3::Z, (rows / 2, columns), upper.clone()) else { return };
    let top = upper.map(|q| q.y).fold(f32::MIN, f32::max);
    for (q, at) in layer.iter_mut().zip(shell.places) {
        // Between the legs there is no outside.
        if at.arm > 0.02 || at.p.y < -0.04 || q.y > top + 0.02 || q.y < low {
            continue;
        }
        let spot = tube.spot(*q);
        *q += spot.out * (spot.radius + OVER_SKIRT_M - spot.own).max(0.0);
    }
}

/// Share of its looseness by which cloth stands off: it rests on the shoulders and on what is
/// outermost of the upper arms.
fn off_shoulders(at: &Place, n: Vec3) -> f32 {
    let beside = step(0.04, 0.08, at.p.x.abs());
    let above = step(0.1, 0.6, n.y) * step(0.40, 0.46, at.p.y) * beside;
    let outside = step(0.3, 0.8, n.x * at.p.x.signum()) * step(0.34, 0.44, at.p.y);
    1.0 - 0.8 * above.max(outside)
}

/// Raises folds where limbs bend and where cloth piles up: at elbows, knees, ankles and waist.
fn crease(shell: &Shell<'_>, layer: &mut [Vec3], most_m: f32) {
    // Coarse levels cannot show them.
    if shell.lod > 1 {
        return;
    }
    for ((q, n), fold) in layer.iter_mut().zip(shell.normals).zip(shell.figure.creases()) {
        *q += *n * (most_m * fold);
    }
}

/// Lets a layer hang from the chest and down the arms; `share` fades it.
fn drape_top(
    shell: &Shell<'_>,
    layer: &mut [Vec3],
    skirt: &[Vec3],
    falls: Falls,
    share: impl Fn(&Place) -> f32,
) {
    if let Some(mut tube) = shell.trunk_tube(layer, (-0.05, 0.44), skirt) {
        // Arms hang where the cloth at the sides would.
        tube.hang(|out| falls.trunk + 0.25 * out.x * out.x);
        let on_trunk = |i: usize| {
            let at = &shell.places[i];
            let trunk = step(0.45, 0.36, at.p.y) * step(0.05, 0.0, at.arm);
            trunk * step(0.16, 0.04, at.leg) * share(at)
        };
        shell.spread(layer, &tube, on_trunk, |_, _| 1.0);
    }
    for side in Side::BOTH {
        let on_arm = |at: &Place| at.arm > 0.20;
        let Some(mut tube) = shell.limb_tube(layer, (side, Limb::Arm, Limb::Hand), on_arm) else {
            continue;
        };
        tube.hang(|_| falls.limb);
        let left = side == Side::Left;
        let own = |i: usize| {
            let at = &shell.places[i];
            f32::from((at.p.x > 0.0) == left) * step(0.20, 0.36, at.arm) * share(at)
        };
        shell.spread(layer, &tube, own, |_, _| 1.0);
    }
}

/// Pieces that lie on a layer: moved along its normals and upwards, metres.
pub(super) fn raised(
    layer: &[Vec3],
    normals: &[Vec3],
    places: &[Place],
    rise: impl Fn(Place) -> [f32; 2],
) -> Vec<Vec3> {
    let raise = |((q, n), at): ((&Vec3, &Vec3), &Place)| {
        let [off, up] = rise(*at);
        *q + *n * off + Vec3::Y * up
    };
    layer.iter().zip(normals).zip(places).map(raise).collect()
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
