//! Maps of skin and clothes: masks, tints, furrows, painted texel by texel from fields over the
//! template.
//!
//! The figure's own mask and mesh flow in, textures flow out, each painted when it is first asked
//! for. The head has texture coordinates of its own, stretched from its place in the figure's
//! layout over a whole texture: so its maps are sharp where people look, and small. What is
//! painted stands in [`super::complexion`], [`super::whiskers`] and [`super::seams`].

use std::ops::Range;
use std::sync::Arc;

use super::data::{FigureData, Group, LIMB_UNIT};
use super::seams::{self, Sewn};
use super::whiskers::{self, ScalpShade, Whiskers};
use super::{GroupId, complexion, with_mips};
use crate::library::texture::{Encoding, Texture, color_from_linear};

/// Where the head lies in the figure's layout: least u and v, and its size.
const HEAD: [f32; 4] = [0.640, 0.175, 0.360, 0.683];
/// No other part of the layout within that rectangle is above this height on the template.
const HEAD_FROM_Y: f32 = 0.55;
const HEAD_LOG2: u32 = 9;
const SHELL_LOG2: u32 = 10;
/// A tint of this much light leaves the skin as it is, so that there can be lighter places.
pub const NEUTRAL_TINT: f32 = 0.8;
/// Depth of a furrow, metres, at which its ground is darkest.
const DARK_AT_M: f32 = 7e-4;

/// How many freckles a face has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freckles {
    /// None.
    None,
    /// On nose and cheeks.
    Some,
    /// All over the face.
    Many,
}

impl Freckles {
    /// All, in order.
    pub const ALL: [Self; 3] = [Self::None, Self::Some, Self::Many];

    const fn share(self) -> f32 {
        match self {
            Self::None => 0.0,
            Self::Some => 0.5,
            Self::Many => 1.0,
        }
    }
}

/// The skin's texture coordinates with the head's stretched over a texture of its own, and which
/// render vertices are the head's. No triangle has some that are and some that are not.
pub(super) fn layout(data: &FigureData) -> (Vec<f32>, Vec<bool>) {
    let group = &data.groups[GroupId::Skin as usize];
    let y = &data.positions[data.vertex_count()..];
    let mut uvs = group.uvs.clone();
    let mut on_head = Vec::with_capacity(group.render.len());
    for (uv, &v) in uvs.chunks_exact_mut(2).zip(&group.render) {
        let [u, v_down] = [(uv[0] - HEAD[0]) / HEAD[2], (uv[1] - HEAD[1]) / HEAD[3]];
        let within = (0.0..1.0).contains(&u) && (0.0..1.0).contains(&v_down);
        let head = within && y[group.first as usize + usize::from(v)] > HEAD_FROM_Y;
        if head {
            uv.copy_from_slice(&[u, v_down]);
        }
        on_head.push(head);
    }
    (uvs, on_head)
}

/// The head's masks with all of the scalp and no beard: red lips, green brows, blue flushed
/// places, alpha scalp.
pub(super) fn head_mask(data: &FigureData) -> Arc<Texture> {
    let side = 1usize << HEAD_LOG2;
    let whole = data.mask.len() / 4;
    let mut top: Vec<u32> = (0..side * side)
        .map(|i| {
            let at = |k: usize, p: usize| HEAD[k] + HEAD[k + 2] * (p as f32 + 0.5) / side as f32;
            let place = [at(0, i % side), at(1, i / side)];
            (0..4).map(|c| blended(&data.mask[c * whole..(c + 1) * whole], place) << (8 * c)).sum()
        })
        .collect();
    each_texel(data, true, side, |i, at, _| {
        top[i] = top[i] & 0xff00_ffff | byte(complexion::flush(at)) << 16;
    });
    Arc::new(with_mips(HEAD_LOG2, top))
}

/// The same with another scalp, and with a beard.
pub(super) fn head_mask_with(
    data: &FigureData,
    plain: &Texture,
    scalp: ScalpShade,
    beard: Whiskers,
) -> Arc<Texture> {
    let side = 1usize << HEAD_LOG2;
    let mut top = plain.texels[..side * side].to_vec();
    each_texel(data, true, side, |i, at, _| {
        let alpha = whiskers::shade((top[i] >> 24) as f32 / 255.0, scalp, beard, at);
        top[i] = top[i] & 0x00ff_ffff | byte(alpha) << 24;
    });
    Arc::new(with_mips(HEAD_LOG2, top))
}

/// The body's masks: red the mouth's inside, blue flushed places, alpha nails.
pub(super) fn body_mask(data: &FigureData) -> Arc<Texture> {
    /// The source paints nails into the flushed places, stronger than anything else beside them.
    const NAIL: u32 = 40;
    let whole = data.mask.len() / 4;
    let side = whole.isqrt();
    let mut top: Vec<u32> = (0..whole)
        .map(|i| u32::from(data.mask[i]) | u32::from(data.mask[2 * whole + i]) << 16)
        .collect();
    each_texel(data, false, side, |i, at, _| {
        let limb = at[0].abs() > 0.35 || at[1] < -0.70;
        if limb && top[i] >> 16 > NAIL {
            top[i] = top[i] & 0xff | 255 << 24;
        }
    });
    Arc::new(with_mips(side.ilog2(), top))
}

/// What light the head's skin gives back against its colour, times [`NEUTRAL_TINT`]: hollows,
/// grain, freckles and the line of the lashes.
pub(super) fn head_tint(data: &FigureData, freckles: Freckles) -> Arc<Texture> {
    let side = 1usize << HEAD_LOG2;
    let hollow = hollows(data);
    let texel = |light: [f32; 3]| color_from_linear(light.map(|v| v * NEUTRAL_TINT));
    let mut top = vec![texel([1.0; 3]); side * side];
    each_texel(data, true, side, |i, at, corners| {
        let deep: f32 = corners.iter().map(|&(v, w)| hollow[v] * w).sum();
        // Nothing may part the neck from the body, which has no such map.
        let face = complexion::step(0.625, 0.650, at[1]);
        let even = (1.0 - 0.38 * face * complexion::step(0.03, 0.24, deep))
            * (1.0 + 0.055 * face * complexion::grain(at))
            * (1.0 - 0.80 * complexion::lash_line(at));
        let dotted = complexion::freckles(at, freckles.share());
        top[i] = texel([0.36, 0.54, 0.66].map(|dark| even * (1.0 - dark * dotted)));
    });
    Arc::new(Texture::from_level0(HEAD_LOG2, Encoding::Color, top))
}

/// What age does to a face: how dark furrows and spots are, grey that is darker below 0.5; and
/// their normals.
pub(super) fn head_age(data: &FigureData) -> [Arc<Texture>; 2] {
    let side = 1usize << HEAD_LOG2;
    let mut dark = vec![0x0080_8080; side * side];
    let mut heights = vec![0.0f32; side * side];
    let mut places: Vec<Option<[f32; 3]>> = vec![None; side * side];
    each_texel(data, true, side, |i, at, _| {
        let height = complexion::relief_m(at);
        let furrow = (-height / DARK_AT_M).clamp(0.0, 1.0);
        let dim = furrow.max(0.75 * complexion::spots(at));
        dark[i] = byte(0.5 - 0.5 * dim) * 0x0001_0101;
        heights[i] = height;
        places[i] = Some(at);
    });
    let mut normals = vec![0x00ff_8080; side * side];
    for y in 1..side - 1 {
        for x in 1..side - 1 {
            let i = y * side + x;
            let slope = |a: usize, b: usize| -> f32 {
                let (Some(p), Some(q)) = (places[a], places[b]) else { return 0.0 };
                let way: f32 = (0..3).map(|k| (q[k] - p[k]) * (q[k] - p[k])).sum();
                // Texels that neighbour across a fold are far from each other on the face.
                if way > 1e-9 && way < 2.5e-5 {
                    (heights[b] - heights[a]) / way.sqrt()
                } else {
                    0.0
                }
            };
            let n = [-slope(i - 1, i + 1), slope(i - side, i + side), 1.0];
            let length = (n[0] * n[0] + n[1] * n[1] + 1.0).sqrt();
            let [r, g, b] = n.map(|v| byte(0.5 + 0.5 * v / length));
            normals[i] = r | g << 8 | b << 16;
        }
    }
    [dark, normals].map(|top| Arc::new(with_mips(HEAD_LOG2, top)))
}

/// 0..1 as a byte.
fn byte(v: f32) -> u32 {
    (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u32
}

/// The mean of the four texels of a square plane round a place.
fn blended(plane: &[u8], [u, v]: [f32; 2]) -> u32 {
    let side = plane.len().isqrt();
    let (x, y) = (u * side as f32 - 0.5, v * side as f32 - 0.5);
    let (left, top) = (x.max(0.0) as usize, y.max(0.0) as usize);
    let (s, t) = ((x - left as f32).clamp(0.0, 1.0), (y - top as f32).clamp(0.0, 1.0));
    let at = |dx: usize, dy: usize| {
        f32::from(plane[(top + dy).min(side - 1) * side + (left + dx).min(side - 1)])
    };
    let upper = at(0, 0) + (at(1, 0) - at(0, 0)) * s;
    let lower = at(0, 1) + (at(1, 1) - at(0, 1)) * s;
    (upper + (lower - upper) * t + 0.5) as u32
}

/// How hollow the template's skin is at its vertices: how far the neighbours' mean lies off it,
/// against their distance; smoothed once.
fn hollows(data: &FigureData) -> Vec<f32> {
    let group = &data.groups[GroupId::Skin as usize];
    let count = group.count as usize;
    let at = |v: usize| corner(data, group, v);
    let sub = |a: [f32; 3], b: [f32; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut normal = vec![[0.0f32; 3]; count];
    // Sums over neighbours: offsets, lengths, how many.
    let mut round = vec![([0.0f32; 3], 0.0f32, 0.0f32); count];
    let triangles = || group.lods[0].triangles.chunks_exact(3);
    let corners = |t: &[u16]| [t[0], t[1], t[2]].map(|r| usize::from(group.render[usize::from(r)]));
    for t in triangles() {
        let v = corners(t);
        let p = v.map(at);
        let (e, f) = (sub(p[1], p[0]), sub(p[2], p[0]));
        let cross =
            [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
        for k in 0..3 {
            for next in [(k + 1) % 3, (k + 2) % 3] {
                let d = sub(p[next], p[k]);
                let sum = &mut round[v[k]];
                (0..3).for_each(|i| sum.0[i] += d[i]);
                sum.1 += dot(d, d).sqrt();
                sum.2 += 1.0;
            }
            (0..3).for_each(|i| normal[v[k]][i] += cross[i]);
        }
    }
    let sharp: Vec<f32> = normal
        .iter()
        .zip(&round)
        .map(|(n, (d, length, _))| dot(*d, *n) / (dot(*n, *n).sqrt() * length).max(1e-12))
        .collect();
    let mut smooth: Vec<(f32, f32)> = sharp.iter().map(|s| (*s, 1.0)).collect();
    for t in triangles() {
        let v = corners(t);
        for k in 0..3 {
            smooth[v[k]].0 += sharp[v[(k + 1) % 3]];
            smooth[v[k]].1 += 1.0;
        }
    }
    smooth.iter().map(|(sum, n)| sum / n).collect()
}

/// Template position of a vertex of a group.
fn corner(data: &FigureData, group: &Group, v: usize) -> [f32; 3] {
    let (n, v) = (data.vertex_count(), group.first as usize + v);
    [data.positions[v], data.positions[n + v], data.positions[2 * n + v]]
}

/// Calls `f` once with every texel of the head's or the body's skin, its place on the template,
/// and the vertices round it with their shares.
fn each_texel(
    data: &FigureData,
    head: bool,
    side: usize,
    mut f: impl FnMut(usize, [f32; 3], [(usize, f32); 3]),
) {
    let group = &data.groups[GroupId::Skin as usize];
    let (uvs, on_head) = layout(data);
    raster(
        group,
        &uvs,
        side,
        |r| on_head[r] == head,
        |i, round| f(i, mean(data, group, round), round),
    );
}

/// The place on the template between three vertices of a group.
fn mean(data: &FigureData, group: &Group, round: [(usize, f32); 3]) -> [f32; 3] {
    let mut at = [0.0; 3];
    for (v, w) in round {
        let p = corner(data, group, v);
        (0..3).for_each(|k| at[k] += p[k] * w);
    }
    at
}

/// Calls `f` once with every texel that a group's triangles cover, or that lies beside such a texel
/// within [`BESIDE`] others, and the vertices round it with their shares; of the triangles that
/// begin with a wanted render vertex.
fn raster(
    group: &Group,
    uvs: &[f32],
    side: usize,
    wanted: impl Fn(usize) -> bool,
    mut f: impl FnMut(usize, [(usize, f32); 3]),
) {
    // Triangle of each texel, from 1; 0 for none.
    let mut owner = vec![0u32; side * side];
    let triangles = group.lods[0].triangles.as_chunks::<3>().0;
    let corners = |t: &[u16; 3]| t.map(|r| usize::from(group.render[usize::from(r)]));
    let shares_of = |t: &[u16; 3]| {
        let [a, b, c] = t.map(|r| [0, 1].map(|k| uvs[2 * usize::from(r) + k] * side as f32));
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let shares = [(b, c), (c, a), (a, b)].map(|(p, q)| Share::new(p, q, area));
        (area.abs() >= 1e-9).then_some((shares, [a, b, c]))
    };
    for (number, t) in (1..).zip(triangles) {
        if !wanted(usize::from(t[0])) {
            continue;
        }
        let Some((shares, [a, b, c])) = shares_of(t) else { continue };
        let v = corners(t);
        // A margin of about a texel round each triangle, which whoever comes later leaves alone.
        let range = |k: usize| {
            let low = a[k].min(b[k]).min(c[k]).floor() - 1.0;
            let high = a[k].max(b[k]).max(c[k]).ceil() + 1.0;
            low.max(0.0) as usize..(high.max(0.0) as usize).min(side)
        };
        let columns = range(0);
        for y in range(1) {
            let at_y = y as f32 + 0.5;
            for x in shares.iter().fold(columns.clone(), |span, share| share.span(at_y, span)) {
                let w = shares.map(|share| share.at(x as f32 + 0.5, at_y));
                let i = y * side + x;
                if owner[i] == 0 && w.iter().all(|&w| w >= -MARGIN) {
                    owner[i] = number;
                    f(i, [(v[0], w[0]), (v[1], w[1]), (v[2], w[2])]);
                }
            }
        }
    }
    // Filters look beyond the borders of the layout, and find there what goes on inside.
    for (i, number) in beside(&mut owner, side) {
        let t = &triangles[number as usize - 1];
        let Some((shares, _)) = shares_of(t) else { continue };
        let at = [i % side, i / side].map(|k| k as f32 + 0.5);
        let w = shares.map(|share| share.at(at[0], at[1]).clamp(-2.0, 3.0));
        let (v, sum) = (corners(t), w.iter().sum::<f32>());
        // Slivers say nothing of what is far from them.
        if sum > 0.5 {
            f(i, std::array::from_fn(|k| (v[k], w[k] / sum)));
        }
    }
}

/// Gives the texels beside those that have an owner the owner of a neighbour; which, and whose.
fn beside(owner: &mut [u32], side: usize) -> Vec<(usize, u32)> {
    let neighbours = |i: usize| {
        let (x, y) = (i % side, i / side);
        let left = (x > 0).then(|| i - 1);
        let right = (x + 1 < side).then(|| i + 1);
        let up = (y > 0).then(|| i - side);
        let down = (y + 1 < side).then(|| i + side);
        [left, right, up, down].into_iter().flatten()
    };
    let mut all = Vec::new();
    let mut edge: Vec<usize> = (0..owner.len()).filter(|i| owner[*i] > 0).collect();
    for _ in 0..BESIDE {
        let first = all.len();
        for i in edge {
            for j in neighbours(i) {
                if owner[j] == 0 {
                    owner[j] = owner[i];
                    all.push((j, owner[i]));
                }
            }
        }
        edge = all[first..].iter().map(|texel| texel.0).collect();
    }
    all
}

/// Texels beyond the borders of the layout.
const BESIDE: usize = 4;

/// How far outside a triangle its texels reach, as a share of its height.
const MARGIN: f32 = 0.05;

/// A corner's share at a place: 1 at the corner, 0 on the edge from `p` to `q`.
#[derive(Clone, Copy)]
struct Share {
    p: [f32; 2],
    /// What a texel to the right and a texel down add.
    by: [f32; 2],
}

impl Share {
    fn new(p: [f32; 2], q: [f32; 2], area: f32) -> Self {
        Self { p, by: [(p[1] - q[1]) / area, (q[0] - p[0]) / area] }
    }

    fn at(&self, x: f32, y: f32) -> f32 {
        self.by[0] * (x - self.p[0]) + self.by[1] * (y - self.p[1])
    }

    /// The columns of a row in which the share may be large enough, one more at either end.
    fn span(&self, y: f32, columns: Range<usize>) -> Range<usize> {
        let [right, down] = self.by;
        if right.abs() < 1e-6 {
            return columns;
        }
        let end = self.p[0] - (MARGIN + down * (y - self.p[1])) / right - 0.5;
        if right > 0.0 {
            columns.start.max((end - 1.0).max(0.0) as usize)..columns.end
        } else {
            columns.start..columns.end.min((end + 2.0).max(0.0) as usize)
        }
    }
}

/// Repeats of a cloth's pattern over the shell's layout.
pub const CLOTH_REPEAT: f32 = 8.0;
/// Where the cloth's coordinates, which are in repeats, begin in the layout: torso, legs, arms, and
/// skirts in the legs' place. Whole numbers: so patterns are not moved.
const TORSO: [f32; 2] = [2.0, 3.0];
const LEGS: [[f32; 2]; 2] = [[6.0, 0.0], [6.0, 4.0]];
const ARMS: [[f32; 2]; 2] = [[1.0, 4.0], [3.0, 4.0]];
/// Likewise for skirts.
pub const SKIRT: [f32; 2] = [4.0, 0.0];

/// The garment shell's texture coordinates, its five tubes side by side: the same texel is the same
/// place, however often a pattern repeats.
pub(super) fn shell_layout(data: &FigureData) -> Vec<f32> {
    let group = &data.groups[GroupId::Shell as usize];
    let tubes = tubes(group);
    // By tube: the mean place of its vertices.
    let mut means = vec![([0.0f32; 3], 0.0f32); tubes.len()];
    for (r, &tube) in tubes.iter().enumerate() {
        let p = corner(data, group, usize::from(group.render[r]));
        (0..3).for_each(|k| means[tube].0[k] += p[k]);
        means[tube].1 += 1.0;
    }
    let begin = |tube: usize| {
        let (sum, n) = means[tube];
        let [x, y, _] = sum.map(|v| v / n);
        let right = usize::from(x < 0.0);
        if x.abs() < 0.02 {
            TORSO
        } else if y < 0.0 {
            LEGS[right]
        } else {
            ARMS[right]
        }
    };
    let place = |(r, uv): (usize, &[f32])| {
        let [u, v] = begin(tubes[r]);
        [(uv[0] + u) / CLOTH_REPEAT, (uv[1] + v) / CLOTH_REPEAT]
    };
    group.uvs.chunks_exact(2).enumerate().flat_map(place).collect()
}

/// For each render vertex the first of those that triangles join it to.
fn tubes(group: &Group) -> Vec<usize> {
    let mut first: Vec<usize> = (0..group.render.len()).collect();
    loop {
        let mut changed = false;
        for t in group.lods[0].triangles.chunks_exact(3) {
            let r = [t[0], t[1], t[2]].map(usize::from);
            let least = r.map(|r| first[r]).into_iter().fold(usize::MAX, usize::min);
            for r in r {
                changed |= first[r] != least;
                first[r] = least;
            }
        }
        if !changed {
            return first;
        }
    }
}

/// Masks over the garment shell: red seams, green what is sewn on, blue darker parts, alpha
/// hollows.
pub(super) fn sewn_mask(data: &FigureData, kind: Sewn) -> Arc<Texture> {
    let side = 1usize << SHELL_LOG2;
    let group = &data.groups[GroupId::Shell as usize];
    let uvs = shell_layout(data);
    let first = group.first as usize;
    let along = |of: &[i16], round: &[(usize, f32); 3]| -> f32 {
        round.iter().map(|&(v, w)| f32::from(of[first + v]) * LIMB_UNIT * w).sum()
    };
    let mut top = vec![0u32; side * side];
    raster(
        group,
        &uvs,
        side,
        |_| true,
        |i, round| {
            let at = seams::Place {
                p: mean(data, group, round),
                arm: along(&data.arm, &round),
                leg: along(&data.leg, &round),
            };
            let masks = seams::masks(kind, at);
            top[i] = (0..4).map(|c| byte(masks[c]) << (8 * c)).sum();
        },
    );
    Arc::new(with_mips(SHELL_LOG2, top))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::figure::Figure;

    fn texels(t: &Texture) -> &[u32] {
        &t.texels[..1 << (2 * t.log2_size)]
    }

    #[test]
    fn head_and_body_part_between_triangles() {
        let figure = Figure::built_in().unwrap();
        let group = figure.group(GroupId::Skin);
        let heads = |t: &[u16]| t.iter().filter(|r| figure.on_head()[usize::from(**r)]).count();
        for lod in &group.lods {
            let counts: Vec<usize> = lod.triangles.chunks_exact(3).map(heads).collect();
            assert!(counts.iter().all(|n| n % 3 == 0));
            assert!(counts.iter().filter(|n| **n == 3).count() * 6 > counts.len());
        }
        assert!(figure.skin_uvs().iter().all(|uv| (0.0..=1.0).contains(uv)));
    }

    #[test]
    fn every_place_of_the_shell_has_its_own_texel_and_patterns_stay() {
        let figure = Figure::built_in().unwrap();
        let group = figure.group(GroupId::Shell);
        let uvs = figure.shell_uvs();
        assert!(uvs.iter().all(|uv| (0.0..1.0).contains(uv)));
        for (new, old) in uvs.iter().zip(&group.uvs) {
            let moved = new * CLOTH_REPEAT - old;
            assert!((moved - moved.round()).abs() < 1e-5, "{moved}");
        }
        // The boxes of the five tubes do not meet, nor do torso and arms meet a skirt's.
        let tubes = tubes(group);
        let names: std::collections::BTreeSet<usize> = tubes.iter().copied().collect();
        assert_eq!(names.len(), 5);
        let range = |tube: usize, k: usize| {
            let own = (0..tubes.len()).filter(|r| tubes[*r] == tube).map(|r| uvs[2 * r + k]);
            own.fold((1.0f32, 0.0f32), |(low, high), v| (low.min(v), high.max(v)))
        };
        let apart = |a: (f32, f32), b: (f32, f32)| a.1 < b.0 || b.1 < a.0;
        let boxes: Vec<_> = names.iter().map(|t| [range(*t, 0), range(*t, 1)]).collect();
        for (i, a) in boxes.iter().enumerate() {
            for b in &boxes[..i] {
                assert!(apart(a[0], b[0]) || apart(a[1], b[1]), "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn age_furrows_the_face_alone() {
        let figure = Figure::built_in().unwrap();
        let [dark, normals] = figure.head_age();
        let bent = texels(normals).iter().filter(|n| **n & 0xffff != 0x8080).count();
        let dim = texels(dark).iter().filter(|d| **d & 255 < 100).count();
        assert!(bent > 5000 && dim > 1500, "{bent} {dim}");
        assert!(bent < texels(normals).len() / 2, "{bent}");
        for n in texels(normals) {
            let [x, y, z, _] = n.to_le_bytes().map(|v| f64::from(v) / 127.5 - 1.0);
            assert!(z > 0.5 && ((x * x + y * y + z * z).sqrt() - 1.0).abs() < 0.02);
        }
    }

    #[test]
    fn freckles_only_darken_and_more_of_them_more() {
        let figure = Figure::built_in().unwrap();
        let sum = |f: Freckles| -> u64 {
            texels(figure.head_tint(f)).iter().map(|t| u64::from(t >> 20)).sum()
        };
        let [none, some, many] = Freckles::ALL.map(sum);
        assert!(none > some + 80_000 && some > many + 80_000, "{none} {some} {many}");
    }

    #[test]
    fn twenty_nails_and_what_is_sewn() {
        let figure = Figure::built_in().unwrap();
        let nails = texels(figure.body_mask()).iter().filter(|t| **t >> 24 > 0).count();
        assert!((200..4000).contains(&nails), "{nails}");
        let amount = |kind: Sewn, c: u32| -> u64 {
            let all = texels(figure.sewn_mask(kind)).iter();
            all.map(|t| u64::from(t >> (8 * c) & 255)).sum::<u64>() / 255
        };
        for kind in Sewn::ALL {
            assert!(amount(kind, 0) > 1500, "{kind:?}: {}", amount(kind, 0));
        }
        let buttons = [Sewn::Shirt, Sewn::Polo].map(|kind| amount(kind, 1));
        assert!(buttons[0] > buttons[1] && buttons[1] > 10, "{buttons:?}");
        assert_eq!(amount(Sewn::Knit, 1), 0);
    }
}
