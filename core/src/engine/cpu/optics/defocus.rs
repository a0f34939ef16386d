//! Depth of field: light out of focus, spread over disks.
//!
//! Light lies in two layers, before the focus and beyond, each at a size at which no disk is wider
//! than a few texels. Before the focus every texel spreads over its own disk, and covers what is
//! behind by as much of it as is there. Beyond it, what is sharper is in front, so that a texel takes
//! light from no further than its own disk reaches. Where light before the focus hides what is behind
//! it, what is seen of that at its edge is taken from around. Disks and layers are those of Jimenez,
//! "Next generation post processing in Call of Duty" (SIGGRAPH 2014).

use rayon::prelude::*;

use super::{Planes, ROWS};
use crate::draw::abi::Defocus;
use crate::engine::cpu::simd::{F32x8, LANES, Level, kernel};
use crate::engine::optics::{blur_level, level_size};

/// Texels round the layers that repeat their border: more than disks reach.
const BORDER: usize = 8;
/// What light in focus has of its texel beyond the focus: next to nothing, so that what is sharp does
/// not colour what is blurred beside it, but enough where there is nothing else.
const SHARP_SHARE: f32 = 0.001;
/// Less than this is nothing.
const LEAST_SHARE: f32 = 1e-7;
/// Side of the squares of texels that know the widest disk in them.
const SQUARE: usize = 16;

/// Layers and what is gathered of them.
#[derive(Default)]
pub(super) struct Buffers {
    layers: Layers,
    spread: Planes<7>,
}

/// Planes of one layer.
#[derive(Default)]
struct Layer {
    /// Light times the share of the texel that is in this layer, and that share.
    light: [Vec<f32>; 4],
    /// Radius, texels.
    radius: Vec<f32>,
    /// Over the area of the disk, texels.
    per_area: Vec<f32>,
    /// The widest disk of each square.
    widest: Vec<f32>,
}

/// What lies before the focus and beyond, with a border.
#[derive(Default)]
pub(in crate::engine::cpu) struct Layers {
    size: [usize; 2],
    stride: usize,
    squares: usize,
    near: Layer,
    far: Layer,
}

/// Radius of what lies at a reciprocal distance, pixels; negative before the focus.
pub(super) fn radius_px(defocus: &Defocus, per_m: f32) -> f32 {
    let radius_px = defocus.at_infinity_px * (1.0 - defocus.focus_m * per_m);
    radius_px.clamp(-defocus.largest_px, defocus.largest_px)
}

/// How much of light with a radius counts as out of focus: none up to half a texel, all from one and
/// a half on.
#[inline(always)]
fn blurred_share(radius: f32) -> f32 {
    (radius.abs() - 0.5).clamp(0.0, 1.0)
}

/// Over the sum of [`cover`] over all texels, within 3 %.
#[inline(always)]
fn per_area(radius: f32) -> f32 {
    let disk = std::f32::consts::PI * (radius * radius + 1.0 / 12.0);
    1.0 / disk.max(radius + 0.5)
}

impl Buffers {
    /// Spreads a picture's light by the radii of its pixels.
    pub(super) fn spread(
        &mut self,
        level: Level,
        defocus: &Defocus,
        light: &mut Planes<3>,
        blur: &Planes<1>,
    ) {
        let halvings = blur_level(defocus);
        let size = level_size([light.size[0] as u32, light.size[1] as u32], halvings);
        self.layers.fill(light, blur, halvings, size);
        self.spread.resize(size);
        let (layers, width) = (&self.layers, size[0] as usize);
        let stride = self.spread.stride;
        self.spread.chunks_mut(ROWS).into_par_iter().enumerate().for_each(|(chunk, mut rows)| {
            let tall = rows[0].len() / stride;
            for (row, first) in
                (0..tall).flat_map(|y| (0..width).step_by(SQUARE).map(move |x| (y, x)))
            {
                let y = chunk * ROWS + row;
                let reach = layers.reach([first, y]);
                for x in (first..(first + SQUARE).min(width)).step_by(LANES) {
                    let out = rows.each_mut().map(|r| &mut r[row * stride + x..][..LANES]);
                    gather(level, layers, [x, y], reach, out);
                }
            }
        });
        let spread = &self.spread;
        light.chunks_mut(ROWS).into_par_iter().enumerate().for_each(|(chunk, rows)| {
            compose(spread, blur, halvings, chunk * ROWS, rows);
        });
    }
}

impl Layer {
    fn resize(&mut self, len: usize, squares: usize) {
        self.light.iter_mut().for_each(|plane| plane.resize(len, 0.0));
        self.radius.resize(len, 0.0);
        self.per_area.resize(len, 0.0);
        self.widest.clear();
        self.widest.resize(squares, 0.0);
    }

    /// Sets a texel: sums of light times share, of shares, and of radii times share, over pixels.
    fn set(&mut self, at: usize, sums: &[f32; 5], per_pixel: f32, per_unit: f32) -> f32 {
        for (plane, sum) in self.light.iter_mut().zip(sums) {
            plane[at] = sum * per_pixel;
        }
        let radius = if sums[3] > 0.0 { sums[4] / sums[3] * per_unit } else { 0.0 };
        self.radius[at] = radius;
        self.per_area[at] = per_area(radius);
        radius
    }

    fn planes(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        self.light.iter_mut().chain([&mut self.radius, &mut self.per_area])
    }
}

impl Layers {
    /// Divides light between the layers.
    fn fill(&mut self, light: &Planes<3>, blur: &Planes<1>, halvings: u32, size: [u32; 2]) {
        let [width, height] = size.map(|side| side as usize);
        self.size = [width, height];
        self.stride = width.next_multiple_of(LANES) + 2 * BORDER;
        self.squares = width.div_ceil(SQUARE);
        let len = self.stride * (height + 2 * BORDER);
        let squares = self.squares * height.div_ceil(SQUARE);
        self.near.resize(len, squares);
        self.far.resize(len, squares);
        let side = 1 << halvings;
        let per_unit = 1.0 / side as f32;
        for y in 0..height {
            for x in 0..width {
                let (mut near, mut far, mut count) = ([0.0; 5], [0.0; 5], 0.0);
                for py in y * side..((y + 1) * side).min(light.size[1]) {
                    let (light_row, [blur_row]) = (light.row(py), blur.row(py));
                    for px in x * side..((x + 1) * side).min(light.size[0]) {
                        let radius_px = blur_row[px];
                        let out = blurred_share(radius_px * per_unit);
                        let color = light_row.map(|plane| plane[px]);
                        let (before, beyond) = if radius_px < 0.0 {
                            (out, (1.0 - out) * SHARP_SHARE)
                        } else {
                            (0.0, out.max(SHARP_SHARE))
                        };
                        add(&mut near, color, before, -radius_px);
                        add(&mut far, color, beyond, radius_px.max(0.0));
                        count += 1.0;
                    }
                }
                let at = self.at([x, y]);
                let square = y / SQUARE * self.squares + x / SQUARE;
                for (layer, sums) in [(&mut self.near, near), (&mut self.far, far)] {
                    let radius = layer.set(at, &sums, 1.0 / count, per_unit);
                    layer.widest[square] = layer.widest[square].max(radius);
                }
            }
        }
        self.repeat_border();
    }

    /// Place of a texel in the planes.
    fn at(&self, [x, y]: [usize; 2]) -> usize {
        (y + BORDER) * self.stride + x + BORDER
    }

    fn repeat_border(&mut self) {
        let ([width, height], stride) = (self.size, self.stride);
        for plane in self.near.planes().chain(self.far.planes()) {
            for row in plane.chunks_mut(stride).skip(BORDER).take(height) {
                let (first, last) = (row[BORDER], row[BORDER + width - 1]);
                row[..BORDER].fill(first);
                row[BORDER + width..].fill(last);
            }
            for y in 0..BORDER {
                let (top, bottom) = (BORDER * stride, (BORDER + height - 1) * stride);
                plane.copy_within(top..top + stride, y * stride);
                plane.copy_within(bottom..bottom + stride, (BORDER + height + y) * stride);
            }
        }
    }

    /// How far disks reach to the texels of a square's row: those before the focus of the squares
    /// around, those beyond of its own.
    fn reach(&self, [x, y]: [usize; 2]) -> [i32; 2] {
        let (column, row) = (x / SQUARE, y / SQUARE);
        let rows = self.near.widest.len() / self.squares;
        let mut near = 0.0_f32;
        for r in row.saturating_sub(1)..(row + 2).min(rows) {
            for c in column.saturating_sub(1)..(column + 2).min(self.squares) {
                near = near.max(self.near.widest[r * self.squares + c]);
            }
        }
        let own = row * self.squares + column;
        let far = self.far.widest[own].max(self.near.widest[own]);
        // Nothing is covered from half a texel beyond the radius on.
        [near, far].map(|radius| (radius + 0.5).ceil() as i32 - 1)
    }
}

fn add(sums: &mut [f32; 5], color: [f32; 3], share: f32, radius: f32) {
    for (sum, v) in sums.iter_mut().zip(color) {
        *sum += v * share;
    }
    sums[3] += share;
    sums[4] += radius * share;
}

/// How much of a texel at a distance a disk covers.
#[inline(always)]
fn cover<const AVX2: bool>(radius: F32x8<AVX2>, distance: f32) -> F32x8<AVX2> {
    (radius + F32x8::splat(0.5 - distance)).clamp(0.0, 1.0)
}

kernel! {
    /// What disks bring to eight texels: light beyond the focus, then before it, and how much that
    /// covers.
    fn gather(
        layers: &Layers,
        texel: [usize; 2],
        reach: [i32; 2],
        out: [&mut [f32]; 7],
    ) = gather_body
}

#[inline(always)]
fn gather_body<const AVX2: bool>(
    layers: &Layers,
    texel: [usize; 2],
    [near_reach, far_reach]: [i32; 2],
    out: [&mut [f32]; 7],
) {
    let at = layers.at(texel);
    let (near, far, stride) = (&layers.near, &layers.far, layers.stride as isize);
    let load = |plane: &[f32], at: usize| F32x8::<AVX2>::load(&plane[at..]);
    let (own, hidden) = (load(&far.radius, at), load(&near.radius, at));
    let (own_area, hidden_area) = (load(&far.per_area, at), load(&near.per_area, at));
    let mut beyond = [F32x8::<AVX2>::ZERO; 4];
    for dy in -far_reach..=far_reach {
        for dx in -far_reach..=far_reach {
            let distance = ((dx * dx + dy * dy) as f32).sqrt();
            let at = (at as isize + dy as isize * stride + dx as isize) as usize;
            let radius = load(&far.radius, at).min(own).max(hidden);
            let area = load(&far.per_area, at).max(own_area).min(hidden_area);
            let weight = cover(radius, distance) * area;
            for (sum, plane) in beyond.iter_mut().zip(&far.light) {
                *sum = *sum + weight * load(plane, at);
            }
        }
    }
    let mut before = [F32x8::<AVX2>::ZERO; 4];
    for dy in -near_reach..=near_reach {
        for dx in -near_reach..=near_reach {
            let distance = ((dx * dx + dy * dy) as f32).sqrt();
            let at = (at as isize + dy as isize * stride + dx as isize) as usize;
            let weight = cover(load(&near.radius, at), distance) * load(&near.per_area, at);
            for (sum, plane) in before.iter_mut().zip(&near.light) {
                *sum = *sum + weight * load(plane, at);
            }
        }
    }
    let [r, g, b, covered, rest @ ..] = out;
    let there = beyond[3].gt(F32x8::splat(LEAST_SHARE));
    let per_share = F32x8::ONE / beyond[3].max(F32x8::splat(LEAST_SHARE));
    for (channel, to) in [r, g, b].into_iter().enumerate() {
        let sharp = load(&far.light[channel], at) + load(&near.light[channel], at);
        there.select(beyond[channel] * per_share, sharp).store(to);
    }
    let most = F32x8::ONE / before[3].max(F32x8::ONE);
    (before[3] * most).store(covered);
    for (sum, to) in before.into_iter().zip(rest) {
        (sum * most).store(to);
    }
}

/// Puts what disks bring in place of the light of some rows, as far as it is out of focus.
fn compose(
    spread: &Planes<7>,
    blur: &Planes<1>,
    halvings: u32,
    first_y: usize,
    mut light: [&mut [f32]; 3],
) {
    let stride = blur.stride;
    let per_unit = 1.0 / (1 << halvings) as f32;
    // Between two rows of texels.
    let mut around: [Vec<f32>; 7] = std::array::from_fn(|_| vec![0.0; spread.stride]);
    for row in 0..light[0].len() / stride {
        let y = first_y + row;
        let (top, bottom, down) = between(y, per_unit, spread.size[1]);
        for ((to, top), bottom) in around.iter_mut().zip(spread.row(top)).zip(spread.row(bottom)) {
            for ((to, above), below) in to.iter_mut().zip(top).zip(bottom) {
                *to = above + (below - above) * down;
            }
        }
        let [radii_px] = blur.row(y);
        for (x, radius_px) in radii_px[..blur.size[0]].iter().enumerate() {
            let (left, right, along) = between(x, per_unit, spread.size[0]);
            let of = |plane: usize| {
                let plane = &around[plane];
                plane[left] + (plane[right] - plane[left]) * along
            };
            let (out, covered) = (blurred_share(radius_px * per_unit), of(3));
            if out == 0.0 && covered == 0.0 {
                continue;
            }
            for (channel, plane) in light.iter_mut().enumerate() {
                let sharp = &mut plane[row * stride + x];
                let behind = *sharp + (of(channel) - *sharp) * out;
                *sharp = behind * (1.0 - covered) + of(4 + channel);
            }
        }
    }
}

/// The texels that a pixel's middle lies between, and how far it is towards the second.
fn between(pixel: usize, per_unit: f32, len: usize) -> (usize, usize, f32) {
    let at = (pixel as f32 + 0.5) * per_unit - 0.5;
    let low = at.floor();
    let texel = |v: f32| (v.max(0.0) as usize).min(len - 1);
    (texel(low), texel(low + 1.0), at - low)
}
