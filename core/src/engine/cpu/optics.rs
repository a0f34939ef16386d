//! Optics: what happens to exposed light that leaves its pixel, and what is developed after it.
//!
//! | step | file | in -> out |
//! |---|---|---|
//! | depth of field | `defocus` | light, how far out of focus it is -> light |
//! | motion blur | `streak` | light, how far it goes -> light |
//! | bloom | `bloom` | light -> scattered light |
//! | display | here | both -> the 8-bit picture |
//!
//! Runs over whole pictures, after all tiles. A frame that has none of them keeps no light: its tiles
//! develop their fragments at once. Here pixels are developed instead, so fragments are summed up as
//! `light / (1 + brightest channel)`, which a bright edge leaves as smooth, and the sum is turned back.
//! The formulas stand in `shaders/` under the same names as well.

mod bloom;
mod defocus;
mod streak;

use rayon::prelude::*;

use super::develop::Develop;
use super::display;
use super::samples::TILE;
use super::shade::TileColor;
use super::simd::{F32x8, LANES, Level, Vec3x8, kernel};
use super::ways::TileWays;
use crate::draw::DrawList;
use crate::draw::abi::{Bloom, Grade};
use crate::engine::noise;
use crate::engine::optics::{blurs, moves, scatters};
use crate::plan::{PassPlan, StageTimes};

/// Rows that a thread takes at a time.
const ROWS: usize = 16;

/// Numbers of the pixels of a picture, row by row, in planes of one kind each.
pub(super) struct Planes<const N: usize> {
    size: [usize; 2],
    /// From row to row: the width, rounded up to eight.
    stride: usize,
    values: [Vec<f32>; N],
}

impl<const N: usize> Default for Planes<N> {
    fn default() -> Self {
        Self { size: [0; 2], stride: 0, values: std::array::from_fn(|_| Vec::new()) }
    }
}

impl<const N: usize> Planes<N> {
    /// Makes it one of so many pixels; what it holds is left as it is.
    fn resize(&mut self, size: [u32; 2]) {
        self.size = size.map(|side| side as usize);
        self.stride = self.size[0].next_multiple_of(LANES);
        let len = self.stride * self.size[1];
        self.values.iter_mut().for_each(|plane| plane.resize(len, 0.0));
    }

    /// A row of each plane.
    fn row(&self, y: usize) -> [&[f32]; N] {
        let start = y * self.stride;
        self.values.each_ref().map(|plane| &plane[start..start + self.stride])
    }

    /// Some rows of each plane at a time, from the top.
    fn chunks_mut(&mut self, rows: usize) -> Vec<[&mut [f32]; N]> {
        let len = (rows * self.stride).max(1);
        let mut chunks = self.values.each_mut().map(|plane| plane.chunks_mut(len));
        let count = self.size[1].div_ceil(rows);
        (0..count).map(|_| chunks.each_mut().map(|c| c.next().unwrap_or_default())).collect()
    }
}

/// Buffers of pictures whose light is kept.
#[derive(Default)]
pub(super) struct Optics {
    /// Exposed light.
    light: Planes<3>,
    /// How far out of focus it is: radius in pixels, negative before the focus.
    blur: Planes<1>,
    /// How far what it shows goes, and how near that is; see [`super::ways`].
    ways: Planes<3>,
    defocus: defocus::Buffers,
    streak: streak::Buffers,
    bloom: bloom::Pyramid,
}

/// The rows of a row of tiles.
#[derive(Default)]
pub(super) struct LightRow<'a> {
    light: [&'a mut [f32]; 3],
    /// Empty where nothing is out of focus.
    blur: &'a mut [f32],
    /// Empty where nothing moves.
    ways: [&'a mut [f32]; 3],
    stride: usize,
}

impl Optics {
    /// Makes room for a frame; hands out what each row of tiles fills.
    pub(super) fn begin(&mut self, list: &DrawList, plan: &PassPlan) -> Vec<LightRow<'_>> {
        let size = [list.view.width, list.view.height];
        self.light.resize(size);
        self.blur.resize(if blurs(list, plan).is_some() { size } else { [0; 2] });
        self.ways.resize(if moves(list, plan).is_some() { size } else { [0; 2] });
        let stride = self.light.stride;
        let mut ways = self.ways.chunks_mut(TILE).into_iter();
        let mut blur = self.blur.chunks_mut(TILE).into_iter();
        let rows = self.light.chunks_mut(TILE).into_iter();
        rows.map(|light| {
            let [blur] = blur.next().unwrap_or_default();
            LightRow { light, blur, ways: ways.next().unwrap_or_default(), stride }
        })
        .collect()
    }

    /// Makes the picture of the light that the tiles left.
    pub(super) fn finish(
        &mut self,
        level: Level,
        list: &DrawList,
        plan: &PassPlan,
        picture: &mut [u8],
        times: &mut StageTimes,
    ) {
        if let Some(defocus) = blurs(list, plan) {
            times.measure("depth of field", || {
                self.defocus.spread(level, &defocus, &mut self.light, &self.blur);
            });
        }
        if let Some(shutter) = moves(list, plan) {
            times.measure("motion blur", || {
                self.streak.draw_out(level, &shutter, &mut self.light, &self.ways);
            });
        }
        let bloom = scatters(list, plan);
        if let Some(bloom) = bloom {
            times.measure("bloom", || self.bloom.scatter(level, bloom, &self.light));
        }
        let develop = Develop::new(list);
        times.measure("display", || {
            let width = self.light.size[0];
            picture.par_chunks_mut(width * 3 * ROWS).enumerate().for_each(|(chunk, lines)| {
                let mut scattered = [0; 3].map(|_| vec![0.0; self.light.stride]);
                for (y, line) in (chunk * ROWS..).zip(lines.chunks_mut(width * 3)) {
                    let bloom = bloom.map(|bloom| {
                        self.bloom.row(level, y, &mut scattered);
                        (bloom, scattered.each_ref().map(|plane| &plane[..]))
                    });
                    let light = self.light.row(y);
                    develop_row(level, (&develop, &list.grade), light, bloom, y as u32, line);
                }
            });
        });
    }
}

impl LightRow<'_> {
    /// Takes a tile's light, summed up as [`super::develop::Develop::keep`] has it, and how far out of
    /// focus its nearest samples are.
    pub(super) fn take<const S: usize>(
        &mut self,
        level: Level,
        list: &DrawList,
        (tile, size): ([u32; 2], [usize; 2]),
        depth: &[f32],
        color: &mut TileColor,
    ) {
        turn_back(level, color);
        let width = self.stride as u32;
        for (row, slots) in self.light.iter_mut().zip(&*color) {
            super::tile::copy_out::<S, f32, 1>(tile, size, width, row, singles(slots));
        }
        if let Some(defocus) = list.defocus.filter(|_| !self.blur.is_empty()) {
            let mut radius_px = [0.0; TILE * TILE];
            for (radius_px, depth) in radius_px.iter_mut().zip(depth.as_chunks::<S>().0) {
                let nearest = depth.iter().fold(0.0_f32, |a, b| a.max(*b));
                *radius_px = defocus::radius_px(&defocus, nearest / list.view.near_m);
            }
            super::tile::copy_out::<S, f32, 1>(tile, size, width, self.blur, singles(&radius_px));
        }
    }
}

impl LightRow<'_> {
    /// Whether it takes ways.
    pub(super) fn takes_ways(&self) -> bool {
        !self.ways[0].is_empty()
    }

    /// Takes the ways of a tile's pixels.
    pub(super) fn take_ways<const S: usize>(
        &mut self,
        (tile, size): ([u32; 2], [usize; 2]),
        ways: &TileWays,
    ) {
        for (row, slots) in self.ways.iter_mut().zip(ways) {
            super::tile::copy_out::<S, f32, 1>(tile, size, self.stride as u32, row, singles(slots));
        }
    }
}

fn singles(slots: &[f32; TILE * TILE]) -> &[[f32; 1]; TILE * TILE] {
    slots.as_chunks().0.first_chunk().expect("as many")
}

kernel! {
    /// From sums of compressed light to light.
    fn turn_back(color: &mut TileColor) = turn_back_body
}

#[inline(always)]
fn turn_back_body<const AVX2: bool>(color: &mut TileColor) {
    let [r, g, b] = color;
    for first in (0..TILE * TILE).step_by(LANES) {
        let v = [&*r, &*g, &*b].map(|c| F32x8::<AVX2>::load(&c[first..]));
        let brightest = v[0].max(v[1]).max(v[2]);
        let factor = F32x8::ONE / (F32x8::ONE - brightest).max(F32x8::splat(1e-5));
        for (to, v) in [&mut *r, &mut *g, &mut *b].into_iter().zip(v) {
            (v * factor).store(&mut to[first..]);
        }
    }
}

kernel! {
    /// Develops a row of light, with what is scattered over it, to the picture's bytes.
    fn develop_row(
        grade: (&Develop, &Grade),
        light: [&[f32]; 3],
        bloom: Option<(Bloom, [&[f32]; 3])>,
        y: u32,
        line: &mut [u8],
    ) = develop_row_body
}

#[inline(always)]
fn develop_row_body<const AVX2: bool>(
    (develop, grade): (&Develop, &Grade),
    light: [&[f32]; 3],
    bloom: Option<(Bloom, [&[f32]; 3])>,
    y: u32,
    line: &mut [u8],
) {
    let load = |planes: &[&[f32]; 3], x: usize| {
        let [r, g, b] = planes.map(|plane| F32x8::<AVX2>::load(&plane[x..]));
        Vec3x8::new(r, g, b)
    };
    let noisy = Develop::is_noisy(grade);
    let (sensor_key, grain_key) =
        (noise::sensor_key(grade.grain_key), noise::mixed(grade.grain_key));
    let mut x = 0;
    for eight in line.chunks_mut(3 * LANES) {
        let mut light = load(&light, x);
        if let Some((bloom, scattered)) = &bloom {
            light = light.mix(load(scattered, x), F32x8::splat(bloom.share));
        }
        let (mut unit, mut grain, mut middle) = ([[0.0; LANES]; 3], [0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let pixel = [(x + lane) as u32, y];
            middle[lane] = pixel[0] as f32 + 0.5;
            if noisy {
                let [r, g, b] = noise::sensor_noise(sensor_key, pixel);
                (unit[0][lane], unit[1][lane], unit[2][lane]) = (r, g, b);
            }
            if grade.grain > 0.0 {
                grain[lane] = display::grain_of_pixel(grade.grain, grain_key, pixel);
            }
        }
        let at = [F32x8(middle), F32x8::splat(y as f32 + 0.5)];
        let [r, g, b] = unit.map(F32x8);
        let color = develop.display(light, at, Vec3x8::new(r, g, b));
        let bytes = display::bytes(color, F32x8(grain));
        eight.copy_from_slice(&bytes.as_flattened()[..eight.len()]);
        x += LANES;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::cpu::develop::compressed;

    #[test]
    fn light_survives_being_summed_up() {
        let mut color = Box::new([[0.0; TILE * TILE]; 3]);
        let lights = [[0.0, 0.0, 0.0], [0.1, 0.02, 0.5], [3.0, 900.0, 20.0], [1e6, 0.0, 1.0]];
        for (slot, light) in lights.iter().enumerate() {
            let v = compressed(Vec3x8::<false>::splat(*light));
            for (plane, v) in color.iter_mut().zip([v.x, v.y, v.z]) {
                plane[slot] = v.0[0];
            }
        }
        turn_back(Level::BASELINE, &mut color);
        for (slot, light) in lights.iter().enumerate().take(3) {
            for (plane, wanted) in color.iter().zip(light) {
                let error = (plane[slot] - wanted).abs();
                assert!(error <= 1e-4 * wanted.max(1.0), "{light:?}: {}", plane[slot]);
            }
        }
        assert!(color.iter().all(|plane| plane[3].is_finite()));
    }
}
