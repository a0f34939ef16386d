//! Beards: a thin shell over the skin where a beard grows, and short locks on it.
//!
//! The shell is cut from the skin along the beard's field on the template, so it follows every
//! face and expression. Stubble is a shade of the skin, see [`super::surface`].

use std::ops::Range;

use glam::Vec3;

use super::cut::{Builder, Surface};
use super::garment::step;
use super::hair::Head;
use super::hair::strand::{Dice, End, Path, Ribbon};
use super::hair::{is_cut, strands};
use crate::library::figure::{self, Figure, GroupId, Whiskers};
use crate::library::mesh::{Cutout, SkinVertex};
use crate::scene::BeardStyle;

/// What of the figure's fields a style is.
pub(super) const fn whiskers(style: BeardStyle) -> Whiskers {
    match style {
        BeardStyle::None => Whiskers::None,
        BeardStyle::Stubble => Whiskers::Stubble,
        BeardStyle::Moustache => Whiskers::Moustache,
        BeardStyle::Goatee => Whiskers::Goatee,
        BeardStyle::Full => Whiskers::Full,
    }
}

/// Thickness of the shell, length of the locks from least to most, and locks per square metre.
const fn form(style: BeardStyle) -> (f32, f32, f32, f32) {
    match style {
        BeardStyle::Moustache => (0.0022, 0.008, 0.014, 90_000.0),
        BeardStyle::Goatee => (0.0030, 0.010, 0.020, 70_000.0),
        _ => (0.0045, 0.012, 0.026, 42_000.0),
    }
}

/// What is cut out of the locks at a level of detail.
pub(super) fn cutout(style: BeardStyle, lod: usize) -> Option<Cutout> {
    let (_, _, high, _) = form(style);
    strands(lod, 0.5 * high)
}

/// Adds a beard: the ranges of the shell and of its locks.
pub(super) fn add(
    builder: &mut Builder,
    figure: &Figure,
    head: &Head,
    style: BeardStyle,
    face: &Surface<'_>,
) -> [Range<u32>; 2] {
    let s = head.scalp.frame.scale;
    let template = figure.template();
    let first = figure.group(GroupId::Skin).first as usize;
    let at = |v: usize| [template.x[first + v], template.y[first + v], template.z[first + v]];
    let whiskers = whiskers(style);
    let field: Vec<f32> =
        (0..face.positions.len()).map(|v| figure::beard(whiskers, at(v))).collect();
    let (thick, low, high, density) = form(style);
    let pushed: Vec<Vec3> = face
        .positions
        .iter()
        .zip(face.normals)
        .zip(&field)
        .map(|((p, n), f)| *p + *n * (s * (thick * step(0.0, 0.010, *f) + 0.0004)))
        .collect();
    let shell = Surface { positions: &pushed, ..*face };
    // Where there are locks, they end the beard, not the shell.
    let inwards_m = if is_cut(head.lod) { 0.0035 } else { 0.0 };
    let inner: Vec<f32> = field.iter().map(|f| f - inwards_m).collect();
    let base = builder.add_cut(&shell, &inner, None);
    let start = base.end;
    if head.lod < 3 {
        let wide = [1.0, 1.6, 2.4][head.lod];
        let law = Law { s, low, high, width_m: 0.0042 * wide, per_m2: density / (wide * wide) };
        add_locks(builder, head, &shell, &field, &law);
    }
    [base, start..builder.mesh.triangles.len() as u32]
}

struct Law {
    s: f32,
    low: f32,
    high: f32,
    width_m: f32,
    per_m2: f32,
}

/// Locks rooted on the shell's triangles, hanging down and a little forwards.
fn add_locks(builder: &mut Builder, head: &Head, shell: &Surface<'_>, field: &[f32], law: &Law) {
    let points = [4, 3, 3][head.lod.min(2)];
    let (mut owed, mut lock) = (0.5f32, 0);
    for t in shell.triangles.chunks_exact(3) {
        let v = [t[0], t[1], t[2]].map(|r| usize::from(shell.render[usize::from(r)]));
        if v.iter().all(|&v| field[v] < 0.0) {
            continue;
        }
        let [a, b, c] = v.map(|v| shell.positions[v]);
        owed += 0.5 * (b - a).cross(c - a).length() * law.per_m2 / (law.s * law.s);
        while owed >= 1.0 {
            owed -= 1.0;
            lock += 1;
            let mut dice = Dice::new(head.seed, 7000 + lock);
            let (x, y) = (dice.unit(), dice.unit());
            let (x, y) = if x + y > 1.0 { (1.0 - x, 1.0 - y) } else { (x, y) };
            let blend =
                |f: &dyn Fn(usize) -> f32| f(v[0]) * (1.0 - x - y) + f(v[1]) * x + f(v[2]) * y;
            let inside = blend(&|v| field[v]);
            if inside < 0.0 {
                continue;
            }
            let p = a * (1.0 - x - y) + b * x + c * y;
            let n = (shell.normals[v[0]] + shell.normals[v[1]] + shell.normals[v[2]])
                .normalize_or(Vec3::Z);
            let skin: SkinVertex = shell.skin[v[0]];
            let length =
                law.s * dice.range(law.low, law.high) * (0.45 + 0.55 * step(0.0, 0.012, inside));
            let aside = Vec3::new(p.x.signum() * 0.25, 0.0, 0.10);
            let stray = Vec3::new(dice.range(-0.25, 0.25), 0.0, dice.range(-0.2, 0.2));
            let down = Vec3::NEG_Y + aside + stray;
            let down = (down - n * down.dot(n) * 0.85).normalize_or(Vec3::NEG_Y);
            let rise = dice.range(0.05, 0.26);
            let mut path = Path::default();
            for i in 0..points {
                let t = i as f32 / (points - 1) as f32;
                let off = n * (rise * length * t * (1.4 - 0.4 * t));
                path.points.push(p - n * (0.001 * law.s) + down * (length * t) + off);
                path.outward.push(n);
            }
            let ribbon = Ribbon {
                width_m: law.width_m * law.s * dice.range(0.7, 1.3),
                root: 0.7,
                tilt: dice.range(-0.4, 0.4),
                round: 0.5,
                u: dice.unit() * 4.0,
                end: if is_cut(head.lod) { End::Cut } else { End::Point },
            };
            ribbon.add(&mut builder.mesh, &path, &|_| skin);
        }
    }
}
