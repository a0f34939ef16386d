//! Gathered hair: the ponytail, the knot and the braids.

use std::f32::consts::TAU;

use glam::Vec3;

use super::scalp::Root;
use super::strand::{Comb, Dice, Path, Ribbon, sin_cos_turns, tube};
use super::style::{self, Tail};
use super::{Grower, LEVELS};
use crate::library::mesh::Mesh;

/// Length of a turn of a braid, and how far its strands lie from its middle sideways and in depth.
const BRAID_TURN_M: f32 = 0.052;
const BRAID_M: (f32, f32) = (0.0085, 0.0055);

/// The bodies of tails and knots, under their locks.
pub(super) fn add_cores(grower: &Grower<'_>, mesh: &mut Mesh) {
    let s = grower.scale();
    let sides = [8, 6, 5, 4, 3][grower.head.lod];
    let points = [16, 10, 7, 5, 4][grower.head.lod];
    match grower.form.tail {
        Tail::None => {}
        Tail::Ponytail => {
            let path = ponytail(grower).resampled(points);
            let moves = grower.moves(&path.points);
            tube(mesh, &path, sides, |t| s * ponytail_radius(t), &moves);
        }
        Tail::Bun => {
            let (root, center) = bun(grower);
            let axis = root.n;
            let path = Path {
                points: (0..points)
                    .map(|i| center + axis * (s * 0.034 * (2.0 * turn(i, points) - 1.0)))
                    .collect(),
                outward: vec![Vec3::Y; points],
            };
            let radius = |t: f32| {
                let x = 2.0 * t - 1.0;
                s * 0.034 * (1.0 - x * x).max(0.0).sqrt()
            };
            tube(mesh, &path, sides + 2, radius, &|_| grower.head.on_head());
        }
        Tail::Braids => {
            for side in [1.0, -1.0] {
                braid(grower, mesh, side, sides);
            }
        }
    }
}

fn turn(i: usize, count: usize) -> f32 {
    i as f32 / (count - 1) as f32
}

/// Locks over those bodies, of one of two tones.
pub(super) fn add_locks(grower: &Grower<'_>, mesh: &mut Mesh, tone: usize) {
    match grower.form.tail {
        Tail::Ponytail => ponytail_locks(grower, mesh, tone),
        Tail::Bun => bun_locks(grower, mesh, tone),
        Tail::None | Tail::Braids => {}
    }
}

/// The middle line of the tail: off the head, then down the back.
pub(super) fn ponytail(grower: &Grower<'_>) -> Path {
    let head = grower.head;
    let s = grower.scale();
    let root = head.scalp.at(style::TIE_HIGH.0, style::TIE_HIGH.1);
    let flow = |l: Vec3, root: &Root| {
        let out = super::step(0.735, 0.775, l.y);
        root.n * (1.6 * out) + Vec3::new(0.0, -1.0, -0.1)
    };
    let comb = Comb {
        near: &head.near,
        frame: &head.scalp.frame,
        flow: &flow,
        yields: 0.45,
        clings: 0.0,
        hugs_y: 2.0,
    };
    let clear = |way: f32| s * (0.012 + 0.014 * super::step(0.0, 0.04 * s, way));
    comb.line(&root, (0.012 * s, 0.014 * s), |_, l| l.y < 0.515, clear)
}

fn ponytail_radius(t: f32) -> f32 {
    let swell = 0.010 + 0.013 * super::step(0.02, 0.22, t);
    swell * (1.0 - 0.65 * super::step(0.35, 0.92, t)) * (1.0 - 0.9 * super::step(0.88, 1.0, t))
}

fn ponytail_locks(grower: &Grower<'_>, mesh: &mut Mesh, tone: usize) {
    let (share, wide, fine) = LEVELS[grower.head.lod];
    let s = grower.scale();
    let middle = ponytail(grower).resampled(24);
    let count = (90.0 * share) as usize;
    let points = (12.0 * fine) as usize;
    for i in 0..count {
        let mut dice = Dice::new(grower.head.seed, 4000 + i as u64);
        if usize::from(dice.unit() < 0.35) != tone {
            continue;
        }
        let around = (i as f32 + dice.unit()) / count as f32;
        let (from, to) = (dice.range(0.0, 0.35), dice.range(0.80, 1.0));
        let stand = dice.range(0.95, 1.15);
        let twist = dice.range(-0.12, 0.12);
        let mut path = Path::default();
        for k in 0..24 {
            let t = turn(k, 24);
            let along = middle.along(k);
            let side = along.cross(middle.outward[k]).normalize_or(Vec3::X);
            let up = side.cross(along);
            let (sin, cos) = sin_cos_turns(around + twist * t);
            let out = side * cos + up * sin;
            let r = s * (ponytail_radius(t) * stand + 0.003 * t);
            path.points.push(middle.points[k] + out * r);
            path.outward.push(out);
        }
        let piece = Path {
            points: path.points[(23.0 * from) as usize..=(23.0 * to) as usize].to_vec(),
            outward: path.outward[(23.0 * from) as usize..=(23.0 * to) as usize].to_vec(),
        };
        let ribbon = Ribbon {
            width_m: 0.013 * s * wide * dice.range(0.7, 1.3),
            root: 0.5,
            tilt: dice.range(-0.4, 0.4),
            round: 0.55,
            u: dice.unit() * 4.0,
            end: grower.end(false),
        };
        ribbon.add(mesh, &piece.resampled(points), &grower.moves(&middle.points));
    }
}

fn bun(grower: &Grower<'_>) -> (Root, Vec3) {
    let root = grower.head.scalp.at(style::TIE_HIGH.0, style::TIE_HIGH.1);
    (root, root.p + root.n * (0.034 * grower.scale()))
}

/// Strands wound round the knot.
fn bun_locks(grower: &Grower<'_>, mesh: &mut Mesh, tone: usize) {
    let (share, wide, fine) = LEVELS[grower.head.lod];
    let s = grower.scale();
    let (root, center) = bun(grower);
    let axis = root.n;
    let across = axis.cross(Vec3::X).normalize_or(Vec3::Y);
    let side = across.cross(axis);
    let count = (46.0 * share) as usize;
    let points = (11.0 * fine) as usize;
    for i in 0..count {
        let mut dice = Dice::new(grower.head.seed, 5000 + i as u64);
        if usize::from(dice.unit() < 0.35) != tone {
            continue;
        }
        // Height on the knot, -1 at the head .. 1 outside.
        let height = -0.55 + 1.5 * (i as f32 + dice.unit()) / count as f32;
        let (begin, sweep) = (dice.unit(), dice.range(0.35, 0.6));
        let drift = dice.range(-0.12, 0.22);
        let stand = dice.range(1.0, 1.10);
        let mut path = Path::default();
        for k in 0..points {
            let t = turn(k, points);
            let h = (height + drift * t).clamp(-0.98, 0.98);
            let (sin, cos) = sin_cos_turns(begin + sweep * t);
            let out = (side * cos + across * sin) * (1.0 - h * h).sqrt() + axis * h;
            path.points.push(center + out * (0.0345 * s * stand));
            path.outward.push(out);
        }
        let ribbon = Ribbon {
            width_m: 0.014 * s * wide * dice.range(0.7, 1.2),
            root: 0.5,
            tilt: dice.range(-0.25, 0.25),
            round: 0.6,
            u: dice.unit() * 4.0,
            end: grower.end(false),
        };
        ribbon.add(mesh, &path, &|_| grower.head.on_head());
    }
}

/// The middle line of a braid: from behind an ear over the front of the shoulder.
pub(super) fn braid_line(grower: &Grower<'_>, side: f32) -> Path {
    let head = grower.head;
    let s = grower.scale();
    let frame = &head.scalp.frame;
    let tie = grower.side_tie(side);
    let p = frame.world(tie);
    let n = head.near.surface(p).map_or(Vec3::X * side, |found| found.1);
    let root = Root { p, n, local: tie, depth: 0.0, column: 0.0 };
    let flow = |l: Vec3, _: &Root| {
        // Forwards over the shoulder, then straight down.
        let neck = super::step(0.55, 0.58, l.y) * super::step(0.655, 0.635, l.y);
        Vec3::new(0.05 * side * neck, -1.0, 1.1 * neck + 0.25 * super::step(0.50, 0.56, l.y))
    };
    let comb = Comb { near: &head.near, frame, flow: &flow, yields: 0.4, clings: 0.0, hugs_y: 2.0 };
    comb.line(&root, (0.0, 0.012 * s), |_, l| l.y < 0.44, |_| 0.013 * s)
}

/// Three strands plaited along that line.
fn braid(grower: &Grower<'_>, mesh: &mut Mesh, side: f32, sides: usize) {
    let head = grower.head;
    let s = grower.scale();
    let points = [30, 16, 9, 5, 4][head.lod];
    let middle = braid_line(grower, side).resampled(points);
    let length = middle.length();
    let hanging = grower.moves(&middle.points);
    if head.lod > 2 {
        tube(mesh, &middle, sides, |t| s * 0.013 * (1.0 - 0.5 * t), &hanging);
        return;
    }
    for strand in 0..3 {
        let mut path = Path::default();
        for i in 0..points {
            let t = turn(i, points);
            let phase = TAU * (t * length / (BRAID_TURN_M * s) + strand as f32 / 3.0);
            let along = middle.along(i);
            let flat = along.cross(middle.outward[i]).normalize_or(Vec3::X);
            let up = flat.cross(along);
            let slim = 1.0 - 0.35 * t;
            let (sin, deep) = (libm::sinf(phase), libm::sinf(2.0 * phase));
            // Mirrored on the other side.
            let off = flat * (sin * BRAID_M.0 * side) + up * (deep * BRAID_M.1);
            path.points.push(middle.points[i] + off * (s * slim));
            path.outward.push(middle.outward[i]);
        }
        let radius = |t: f32| {
            // Open ends below the band.
            let slim = (1.0 - 0.35 * t) * (1.0 - 0.8 * super::step(0.93, 1.0, t));
            s * 0.0078 * slim
        };
        tube(mesh, &path, sides, radius, &hanging);
    }
    let end = middle.points.len() - 1;
    for i in 0..(10.0 * LEVELS[head.lod].0) as usize {
        let mut dice = Dice::new(head.seed, 6000 + i as u64);
        let along = middle.along(end);
        let flat = along.cross(middle.outward[end]).normalize_or(Vec3::X);
        let spread = flat * (dice.range(-0.012, 0.012) * side) * s;
        let tip = along * (s * dice.range(0.025, 0.045)) + spread;
        let lift = middle.outward[end] * (s * 0.003);
        let path = Path {
            points: (0..4).map(|k| middle.points[end] + lift + tip * turn(k, 4)).collect(),
            outward: vec![middle.outward[end]; 4],
        };
        let ribbon = Ribbon {
            width_m: 0.009 * s,
            root: 0.7,
            tilt: 0.0,
            round: 0.5,
            u: dice.unit() * 4.0,
            end: grower.end(false),
        };
        ribbon.add(mesh, &path, &hanging);
    }
}
