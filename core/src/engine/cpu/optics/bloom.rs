//! Bloom: light that the lens scatters; see [`Bloom`].

use rayon::prelude::*;

use super::{Planes, ROWS};
use crate::draw::abi::Bloom;
use crate::engine::cpu::simd::{Level, kernel};
use crate::engine::optics::bloom_levels;

/// The levels of scattered light, the first half as large as the picture.
#[derive(Default)]
pub(super) struct Pyramid {
    levels: Vec<Planes<3>>,
}

impl Pyramid {
    /// Makes the levels of a picture.
    pub(super) fn scatter(&mut self, level: Level, bloom: Bloom, light: &Planes<3>) {
        let sizes = bloom_levels([light.size[0] as u32, light.size[1] as u32]);
        self.levels.resize_with(sizes.len(), Planes::default);
        for (index, size) in sizes.iter().enumerate() {
            let (larger, smaller) = self.levels.split_at_mut(index);
            let smaller = &mut smaller[0];
            smaller.resize(*size);
            halve(level, larger.last().unwrap_or(light), smaller);
        }
        for index in (1..self.levels.len()).rev() {
            let (larger, smaller) = self.levels.split_at_mut(index);
            add_smaller(level, bloom.spread, &smaller[0], &mut larger[index - 1]);
        }
    }

    /// A row of the picture's scattered light.
    pub(super) fn row(&self, level: Level, y: usize, out: &mut [Vec<f32>; 3]) {
        let first = &self.levels[0];
        let rows = neighbours(y, first.size[1]).map(|y| first.row(y));
        for (channel, out) in out.iter_mut().enumerate() {
            drawn_out(level, rows.map(|row| row[channel]), first.size[0], out);
        }
    }
}

/// The rows of the smaller level that a row lies between, the nearer one first.
fn neighbours(y: usize, height: usize) -> [usize; 2] {
    let near = y / 2;
    let far = if y.is_multiple_of(2) { near.saturating_sub(1) } else { near + 1 };
    [near.min(height - 1), far.min(height - 1)]
}

/// Makes a level from the one that is twice as large.
fn halve(level: Level, larger: &Planes<3>, smaller: &mut Planes<3>) {
    let ([width, height], [_, bottom]) = (smaller.size, larger.size);
    let stride = smaller.stride;
    smaller.chunks_mut(ROWS).into_par_iter().enumerate().for_each(|(chunk, mut rows)| {
        let mut smoothed = vec![0.0; larger.stride];
        for y in 0..ROWS.min(height - chunk * ROWS) {
            let middle = 2 * (chunk * ROWS + y);
            let four = [middle.saturating_sub(1), middle, middle + 1, middle + 2];
            let four = four.map(|y| larger.row(y.min(bottom - 1)));
            for (channel, plane) in rows.iter_mut().enumerate() {
                let four = four.map(|row| row[channel]);
                let out = &mut plane[y * stride..][..width];
                halved_row(level, four, larger.size[0], &mut smoothed, out);
            }
        }
    });
}

/// `larger + spread (smaller, drawn out - larger)`.
fn add_smaller(level: Level, spread: f32, smaller: &Planes<3>, larger: &mut Planes<3>) {
    let ([_, height], stride) = (larger.size, larger.stride);
    larger.chunks_mut(ROWS).into_par_iter().enumerate().for_each(|(chunk, mut rows)| {
        let mut wide = vec![0.0; stride];
        for y in 0..ROWS.min(height - chunk * ROWS) {
            let two = neighbours(chunk * ROWS + y, smaller.size[1]).map(|y| smaller.row(y));
            for (channel, plane) in rows.iter_mut().enumerate() {
                drawn_out(level, two.map(|row| row[channel]), smaller.size[0], &mut wide);
                mix_row(level, spread, &wide, &mut plane[y * stride..][..stride]);
            }
        }
    });
}

kernel! {
    /// A row half as wide, from four rows of which `width` texels are there.
    fn halved_row(
        four: [&[f32]; 4],
        width: usize,
        smoothed: &mut [f32],
        out: &mut [f32],
    ) = halved_row_body
}

#[inline(always)]
fn halved_row_body<const AVX2: bool>(
    [a, b, c, d]: [&[f32]; 4],
    width: usize,
    smoothed: &mut [f32],
    out: &mut [f32],
) {
    for ((((to, a), b), c), d) in smoothed.iter_mut().zip(a).zip(b).zip(c).zip(d) {
        *to = ((a + d) + (b + c) * 3.0) * 0.125;
    }
    let smoothed = &smoothed[..width];
    let weighed = |a: f32, b: f32, c: f32, d: f32| ((a + d) + (b + c) * 3.0) * 0.125;
    let of = |x: usize| smoothed[x.min(width - 1)];
    out[0] = weighed(of(0), of(0), of(1), of(2));
    let inner = smoothed.get(1..).unwrap_or_default();
    let whole = inner.len().saturating_sub(2) / 2;
    let twos = inner.as_chunks::<2>().0;
    for (to, pairs) in out[1..].iter_mut().zip(twos.windows(2)) {
        let ([a, b], [c, d]) = (pairs[0], pairs[1]);
        *to = weighed(a, b, c, d);
    }
    for x in 1 + whole..out.len() {
        out[x] = weighed(of(2 * x - 1), of(2 * x), of(2 * x + 1), of(2 * x + 2));
    }
}

kernel! {
    /// A row twice as wide, three parts of the first row and one of the second; `width` texels of
    /// them are there.
    fn drawn_out(two: [&[f32]; 2], width: usize, out: &mut [f32]) = drawn_out_body
}

#[inline(always)]
fn drawn_out_body<const AVX2: bool>([near, far]: [&[f32]; 2], width: usize, out: &mut [f32]) {
    let of = |x: usize| near[x] * 0.75 + far[x] * 0.25;
    let (near, far) = (&near[..width], &far[..width]);
    let between = |a: f32, b: f32| a * 0.75 + b * 0.25;
    let last = width - 1;
    let mut left = of(0);
    let mut middle = left;
    let mut pairs = out.chunks_mut(2);
    for (x, pair) in pairs.by_ref().take(width).enumerate() {
        let right = if x < last { near[x + 1] * 0.75 + far[x + 1] * 0.25 } else { middle };
        pair[0] = between(middle, left);
        if let Some(second) = pair.get_mut(1) {
            *second = between(middle, right);
        }
        (left, middle) = (middle, right);
    }
    pairs.for_each(|pair| pair.fill(0.0));
}

kernel! {
    /// Moves a row towards another by a share.
    fn mix_row(share: f32, other: &[f32], row: &mut [f32]) = mix_row_body
}

#[inline(always)]
fn mix_row_body<const AVX2: bool>(share: f32, other: &[f32], row: &mut [f32]) {
    for (to, other) in row.iter_mut().zip(other) {
        *to += (other - *to) * share;
    }
}
