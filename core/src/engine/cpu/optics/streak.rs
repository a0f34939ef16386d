//! Motion blur: light drawn out along the ways of what moves while the shutter is open.
//!
//! A pixel is given, first, what lies before it and passes over it: light along the longest way
//! around, as far as its own way reaches the pixel, which it hides for the share of the time that it is
//! there. The rest of the time shows the pixel's own surface as it passes by: light along its own way,
//! of what lies as deep, and of what is farther where that surface has gone. Longest ways of tiles and
//! of those around are those of McGuire, Hennessy, Bukowski and Osman, "A reconstruction filter for
//! plausible motion blur" (I3D 2012), the second direction that of Guertin, McGuire and Nowrouzezahrai
//! (HPG 2014). The formulas stand in `shaders/streak.wgsl` as well.

use std::ops::Range;

use rayon::prelude::*;

use super::{Planes, ROWS};
use crate::draw::abi::Shutter;
use crate::engine::cpu::simd::{F32x8, LANES, Level, Vec3x8, kernel, transposed};
use crate::engine::cpu::ways::cut;
use crate::engine::optics::{MOST_TAPS, way_tile};

/// In this share of the distance what is nearer comes to lie before what is farther.
const PER_STEP: f32 = 50.0;
/// A way of this length or less stays within its pixel.
const STILL_PX: f32 = Shutter::STILL_PX as f32;
/// Less than this share of the time is nothing.
const LEAST_SHARE: f32 = 1e-4;

/// What is known of the pixels and tiles of a picture, and what is made.
#[derive(Default)]
pub(super) struct Buffers {
    picture: Picture,
    /// Of each tile, then of it and those around.
    tiles: [Vec<Tile>; 2],
    drawn_out: Planes<3>,
}

/// Light, way and depth of each pixel together, as they are looked up together.
#[derive(Default)]
pub(in crate::engine::cpu) struct Picture {
    size: [usize; 2],
    pixels: Vec<[f32; LANES]>,
}

/// What tiles know of their pixels.
#[derive(Clone, Copy, Default)]
pub(in crate::engine::cpu) struct Tile {
    longest: [f32; 2],
    /// Depth of what is nearest.
    nearest: f32,
}

impl Tile {
    /// Of both; of equal ways the first.
    fn join(self, other: Self) -> Self {
        let square = |[x, y]: [f32; 2]| x * x + y * y;
        let longer = square(other.longest) > square(self.longest);
        Self {
            longest: if longer { other.longest } else { self.longest },
            nearest: self.nearest.max(other.nearest),
        }
    }

    /// Whether ways reach out of their pixels.
    fn moves(&self) -> bool {
        let [x, y] = self.longest;
        (x * x + y * y).sqrt() > STILL_PX
    }
}

impl Buffers {
    /// Draws a picture's light out.
    pub(super) fn draw_out(
        &mut self,
        level: Level,
        shutter: &Shutter,
        light: &mut Planes<3>,
        ways: &Planes<3>,
    ) {
        let side = way_tile(shutter) as usize;
        let ([width, height], stride) = (light.size, light.stride);
        let tiles = light.size.map(|size| size.div_ceil(side));
        let [own, around] = &mut self.tiles;
        self.picture.fill(light, ways, shutter);
        *own = tiles_of(ways, side, tiles[0]);
        *around = (0..tiles[1])
            .flat_map(|y| (0..tiles[0]).map(move |x| [x, y]))
            .map(|tile| {
                let tile = joined_around(own, tile, tiles);
                Tile { longest: cut(tile.longest, shutter.longest_px), ..tile }
            })
            .collect();
        self.drawn_out.resize([width as u32, height as u32]);
        let picture = &self.picture;
        self.drawn_out.chunks_mut(ROWS).into_par_iter().enumerate().for_each(
            |(chunk, mut rows)| {
                for row in 0..rows[0].len() / stride {
                    let y = chunk * ROWS + row;
                    for (tile, first) in (0..width).step_by(side).enumerate() {
                        let tile = &around[y / side * tiles[0] + tile];
                        // Eight at a time, into the padding of the row.
                        let span = first..(first + side).min(width.next_multiple_of(LANES));
                        let mut out =
                            rows.each_mut().map(|r| &mut r[row * stride..][span.start..span.end]);
                        if tile.moves() {
                            draw_out_row(level, picture, [first, y], tile, out);
                            continue;
                        }
                        for (to, from) in out.iter_mut().zip(light.row(y)) {
                            to.copy_from_slice(&from[span.clone()]);
                        }
                    }
                }
            },
        );
        std::mem::swap(light, &mut self.drawn_out);
    }
}

impl Picture {
    /// Takes a picture's light and ways, which are cut to the longest that is drawn out.
    fn fill(&mut self, light: &Planes<3>, ways: &Planes<3>, shutter: &Shutter) {
        self.size = light.size;
        let [width, height] = light.size;
        self.pixels.resize(width * height, [0.0; LANES]);
        self.pixels.par_chunks_mut(width * ROWS).enumerate().for_each(|(chunk, rows)| {
            for (y, row) in (chunk * ROWS..).zip(rows.chunks_mut(width)) {
                let ([r, g, b], [xs, ys, depth]) = (light.row(y), ways.row(y));
                for (x, pixel) in row.iter_mut().enumerate() {
                    let [way_x, way_y] = cut([xs[x], ys[x]], shutter.longest_px);
                    *pixel = [r[x], g[x], b[x], way_x, way_y, depth[x], 0.0, 0.0];
                }
            }
        });
    }
}

/// Tiles of ways as they were before they are cut: cut ones are alike in length, and one of them would
/// be chosen by chance.
fn tiles_of(ways: &Planes<3>, side: usize, across: usize) -> Vec<Tile> {
    let [width, height] = ways.size;
    let of_row = |tile_y: usize| {
        let mut tiles = vec![Tile::default(); across];
        for y in tile_y * side..((tile_y + 1) * side).min(height) {
            let [xs, ys, depth] = ways.row(y);
            for x in 0..width {
                let tile = &mut tiles[x / side];
                *tile = tile.join(Tile { longest: [xs[x], ys[x]], nearest: depth[x] });
            }
        }
        tiles
    };
    (0..height.div_ceil(side)).into_par_iter().flat_map_iter(of_row).collect()
}

fn joined_around(tiles: &[Tile], [x, y]: [usize; 2], size: [usize; 2]) -> Tile {
    let rows = y.saturating_sub(1)..(y + 2).min(size[1]);
    let columns = x.saturating_sub(1)..(x + 2).min(size[0]);
    let around = rows.flat_map(|y| columns.clone().map(move |x| y * size[0] + x));
    around.fold(Tile::default(), |all, tile| all.join(tiles[tile]))
}

/// Eight pixels.
#[derive(Clone, Copy)]
struct Pixels<const AVX2: bool> {
    light: Vec3x8<AVX2>,
    way: [F32x8<AVX2>; 2],
    depth: F32x8<AVX2>,
}

/// Ways of eight pixels as places along them: whole pixels apart along the axis that they are nearer
/// to, in between along the other.
#[derive(Clone, Copy)]
struct Places<const AVX2: bool> {
    along: [F32x8<AVX2>; 2],
    /// From place to place.
    step: [F32x8<AVX2>; 2],
    /// Places to either side.
    count: F32x8<AVX2>,
    /// Length of a step.
    apart: F32x8<AVX2>,
}

#[inline(always)]
fn ceiling<const AVX2: bool>(v: F32x8<AVX2>) -> F32x8<AVX2> {
    -(-v).floor()
}

#[inline(always)]
fn absolute<const AVX2: bool>(v: F32x8<AVX2>) -> F32x8<AVX2> {
    v.max(-v)
}

impl<const AVX2: bool> Places<AVX2> {
    /// Of ways that are not nothing; of others, none.
    #[inline(always)]
    fn on(way: [F32x8<AVX2>; 2]) -> Self {
        let length = (way[0] * way[0] + way[1] * way[1]).sqrt().max(F32x8::splat(1e-6));
        let along = [way[0] / length, way[1] / length];
        let longer_axis = absolute(way[0]).max(absolute(way[1])).max(F32x8::splat(1e-6));
        let stride = ceiling(longer_axis * F32x8::splat(1.0 / MOST_TAPS as f32)).max(F32x8::ONE);
        let largest = absolute(along[0]).max(absolute(along[1])).max(F32x8::splat(1e-6));
        Self {
            along,
            step: [way[0] / longer_axis * stride, way[1] / longer_axis * stride],
            count: ceiling(longer_axis / stride),
            apart: stride / largest,
        }
    }

    /// Twice the indices of places, once for either pixel that they lie between.
    #[inline(always)]
    fn taps(&self) -> Range<i32> {
        let most = self.count.largest() as i32;
        -2 * most..2 * most + 2
    }
}

/// What lies at a place along ways.
struct Tap<const AVX2: bool> {
    pixels: Pixels<AVX2>,
    distance: F32x8<AVX2>,
    part: F32x8<AVX2>,
}

/// How much of one depth lies before another.
#[inline(always)]
fn before<const AVX2: bool>(nearer: F32x8<AVX2>, farther: F32x8<AVX2>) -> F32x8<AVX2> {
    let step = (nearer - farther) / nearer.max(farther).max(F32x8::splat(1e-20));
    (step * F32x8::splat(PER_STEP)).clamp(0.0, 1.0)
}

/// The share of the time that what has a way spends at a distance along it.
#[inline(always)]
fn share_at<const AVX2: bool>(reach: F32x8<AVX2>, distance: F32x8<AVX2>) -> F32x8<AVX2> {
    let reach = reach.max(F32x8::splat(STILL_PX));
    (reach + F32x8::splat(0.5) - distance).clamp(0.0, 1.0) / (reach + reach)
}

impl<const AVX2: bool> Pixels<AVX2> {
    /// How far ways reach in a direction, and how much of them goes there.
    #[inline(always)]
    fn reach(&self, along: [F32x8<AVX2>; 2]) -> (F32x8<AVX2>, F32x8<AVX2>) {
        let reach = self.way[0] * along[0] + self.way[1] * along[1];
        let square = self.way[0] * self.way[0] + self.way[1] * self.way[1];
        // What stays within its pixel goes to no side more than to others.
        let still = F32x8::splat(STILL_PX * STILL_PX);
        (absolute(reach), (reach * reach + still) / (square + still))
    }
}

kernel! {
    /// Draws light out over a row of a tile, whose surroundings are known.
    fn draw_out_row(
        picture: &Picture,
        first: [usize; 2],
        around: &Tile,
        out: [&mut [f32]; 3],
    ) = draw_out_row_body
}

#[inline(always)]
fn draw_out_row_body<const AVX2: bool>(
    picture: &Picture,
    [first, y]: [usize; 2],
    around: &Tile,
    [r, g, b]: [&mut [f32]; 3],
) {
    let longest = around.longest.map(F32x8::<AVX2>::splat);
    let nearest = F32x8::splat(around.nearest);
    for start in (0..r.len()).step_by(LANES) {
        let from = [
            F32x8(std::array::from_fn(|lane| (first + start + lane) as f32)),
            F32x8::splat(y as f32),
        ];
        let own = picture.at(from);
        let mut light = picture.passed_by(from, &own);
        if before(nearest, own.depth).gt(F32x8::ZERO).any() {
            let (passing, hidden) = picture.passing(from, own.depth, longest);
            let factor = F32x8::ONE / hidden.max(F32x8::ONE);
            let left = F32x8::ONE - hidden.min(F32x8::ONE);
            light = passing.scale(factor) + light.scale(left);
        }
        light.x.store(&mut r[start..]);
        light.y.store(&mut g[start..]);
        light.z.store(&mut b[start..]);
    }
}

impl Picture {
    /// The pixels at whole places, or the nearest to them in the picture.
    #[inline(always)]
    fn at<const AVX2: bool>(&self, [x, y]: [F32x8<AVX2>; 2]) -> Pixels<AVX2> {
        let [width, height] = self.size;
        let x = x.clamp(0.0, (width - 1) as f32).round_i32();
        let y = y.clamp(0.0, (height - 1) as f32).round_i32();
        let mut rows = [[0.0; LANES]; LANES];
        for lane in 0..LANES {
            rows[lane] = self.pixels[y.0[lane] as usize * width + x.0[lane] as usize];
        }
        let [r, g, b, way_x, way_y, depth, ..] = transposed::<AVX2>(rows);
        Pixels { light: Vec3x8::new(r, g, b), way: [way_x, way_y], depth }
    }

    /// The pixels at a place along ways, with their distance and how much of the place they are: first
    /// those before it, then those beyond.
    #[inline(always)]
    fn tap<const AVX2: bool>(
        &self,
        from: [F32x8<AVX2>; 2],
        places: &Places<AVX2>,
        index: i32,
    ) -> Tap<AVX2> {
        let steps = F32x8::splat((index >> 1) as f32);
        let there = places.count.ge(absolute(steps)).select(F32x8::ONE, F32x8::ZERO);
        let distance = absolute(steps) * places.apart;
        let off = [places.step[0] * steps, places.step[1] * steps];
        let low = [off[0].floor(), off[1].floor()];
        let part = [off[0] - low[0], off[1] - low[1]];
        let second = part[0].max(part[1]);
        let mut at = [from[0] + low[0], from[1] + low[1]];
        let mut share = (F32x8::ONE - second) * there;
        if index & 1 == 1 {
            at = [at[0] + ceiling(part[0]), at[1] + ceiling(part[1])];
            share = second * there;
        }
        Tap { pixels: self.at(at), distance, part: share }
    }

    /// Light of what lies before pixels and passes over them, and the share of the time that it does.
    #[inline(always)]
    fn passing<const AVX2: bool>(
        &self,
        from: [F32x8<AVX2>; 2],
        depth: F32x8<AVX2>,
        longest: [F32x8<AVX2>; 2],
    ) -> (Vec3x8<AVX2>, F32x8<AVX2>) {
        let places = Places::on(longest);
        let (mut sum, mut hidden) = (Vec3x8::ZERO, F32x8::ZERO);
        for index in places.taps() {
            let Tap { pixels: other, distance, part } = self.tap(from, &places, index);
            let (reach, aligned) = other.reach(places.along);
            let share = share_at(reach, distance)
                * places.apart
                * before(other.depth, depth)
                * aligned
                * part;
            sum = sum + other.light.scale(share);
            hidden = hidden + share;
        }
        (sum, hidden)
    }

    /// Light of the pixels' own surface as it passes by, and of what it leaves free.
    #[inline(always)]
    fn passed_by<const AVX2: bool>(
        &self,
        from: [F32x8<AVX2>; 2],
        own: &Pixels<AVX2>,
    ) -> Vec3x8<AVX2> {
        let own_reach = (own.way[0] * own.way[0] + own.way[1] * own.way[1]).sqrt();
        let moves = own_reach.gt(F32x8::splat(STILL_PX));
        if !moves.any() {
            return own.light;
        }
        let places = Places::on([
            moves.select(own.way[0], F32x8::ZERO),
            moves.select(own.way[1], F32x8::ZERO),
        ]);
        let (mut sum, mut shares) = (Vec3x8::ZERO, F32x8::ZERO);
        for index in places.taps() {
            let Tap { pixels: other, distance, part } = self.tap(from, &places, index);
            let farther = before(own.depth, other.depth);
            let same = F32x8::ONE - farther - before(other.depth, own.depth);
            let (reach, aligned) = other.reach(places.along);
            let passes = share_at(reach, distance) * aligned * same;
            let share = (passes + share_at(own_reach, distance) * farther) * part;
            sum = sum + other.light.scale(share);
            shares = shares + share;
        }
        let moves = own_reach.gt(F32x8::splat(STILL_PX));
        let found = F32x8::ONE / shares.max(F32x8::splat(LEAST_SHARE));
        Vec3x8::new(
            moves.select(sum.x * found, own.light.x),
            moves.select(sum.y * found, own.light.y),
            moves.select(sum.z * found, own.light.z),
        )
    }
}
