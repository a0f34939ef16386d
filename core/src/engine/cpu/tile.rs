//! One tile of the picture, from raster to finished pixels.
//!
//! A thread takes a row of tiles and walks it with its own [`Scratch`]; nothing but the rows of
//! the result is shared, so that the result does not depend on who took which.

use std::time::{Duration, Instant};

use super::bin::ChunksByTile;
use super::chunk::{Chunk, NOTHING};
use super::fragment::{Fragments, Visible, gather};
use super::lens::{Lens, LensTile};
use super::lens_raster::raster_lens_tile;
use super::optics::LightRow;
use super::raster::raster_tile;
use super::reduce;
use super::resolve::{Resolved, SampleObjects, objects_of_samples, resolve};
use super::samples::{BLOCK, Layout, TILE};
use super::shade::{DrawnSurface, Reaching, Stage, Surface, TileColor, shade};
use super::simd::{F32x8, LANES, Level, kernel};
use super::ways::{TileWays, ways_of_tile};
use super::{develop, display, skin};
use crate::draw::DrawList;
use crate::draw::abi::Shutter;
use crate::plan::{ObjectSamples, StageTimes};

/// Steps whose time is kept apart.
#[derive(Clone, Copy)]
enum Step {
    Raster,
    Fragments,
    Shade,
    Ways,
    Display,
    Resolve,
    Reduce,
}

impl Step {
    const NAMES: [&'static str; 7] =
        ["raster", "fragments", "shade", "ways", "display", "resolve", "reduce"];
}

/// What a thread works in; lives on from frame to frame.
pub(super) struct Scratch {
    depth: Vec<f32>,
    ids: Vec<u32>,
    farthest: Vec<f32>,
    /// The lens's tile where those are not kept.
    lens: LensTile,
    fragments: Fragments,
    reaching: Reaching,
    color: Box<TileColor>,
    ways: Box<TileWays>,
    /// Grain by pixel slot, 1/255.
    noise: Box<[f32; TILE * TILE]>,
    /// The sensor's noise by channel and pixel slot.
    sensor: Box<TileColor>,
    bytes: Box<[[u8; 3]; TILE * TILE]>,
    objects: SampleObjects,
    resolved: Box<Resolved>,
    /// Sums over the tiles that this thread walked.
    pub(super) sums: Vec<ObjectSamples>,
    times: [Duration; Step::NAMES.len()],
}

impl Default for Scratch {
    fn default() -> Self {
        Self {
            depth: Vec::new(),
            ids: Vec::new(),
            farthest: Vec::new(),
            lens: LensTile::default(),
            fragments: Fragments::default(),
            reaching: Reaching::default(),
            color: Box::new([[0.0; TILE * TILE]; 3]),
            ways: Box::new([[0.0; TILE * TILE]; 3]),
            noise: Box::new([0.0; TILE * TILE]),
            sensor: Box::new([[0.0; TILE * TILE]; 3]),
            bytes: Box::new([[0; 3]; TILE * TILE]),
            objects: SampleObjects::default(),
            resolved: Box::default(),
            sums: Vec::new(),
            times: [Duration::ZERO; Step::NAMES.len()],
        }
    }
}

impl Scratch {
    /// Makes it ready for a frame.
    pub(super) fn prepare(&mut self, samples: usize, objects: usize) {
        let n = TILE * TILE * samples;
        self.depth.resize(n, 0.0);
        self.ids.resize(n, NOTHING);
        self.farthest.resize(n / BLOCK, 0.0);
        self.sums.clear();
        self.sums.resize(objects, ObjectSamples::default());
        self.times = [Duration::ZERO; Step::NAMES.len()];
    }

    /// Adds the time spent to the frame's.
    pub(super) fn report(&self, times: &mut StageTimes) {
        for (name, time) in Step::NAMES.into_iter().zip(self.times) {
            if time > Duration::ZERO {
                times.add(name, time);
            }
        }
    }

    fn measure<T>(&mut self, step: Step, f: impl FnOnce(&mut Self) -> T) -> T {
        let start = Instant::now();
        let value = f(self);
        self.times[step as usize] += start.elapsed();
        value
    }
}

/// Everything that the tiles of a frame have in common.
pub(super) struct TilePass<'a> {
    pub(super) level: Level,
    pub(super) list: &'a DrawList,
    pub(super) placed: &'a skin::Placed,
    pub(super) lens: Option<&'a Lens>,
    pub(super) chunks: &'a [Chunk],
    pub(super) by_tile: &'a ChunksByTile,
    /// Present when the picture is wanted.
    pub(super) shading: Option<Shading<'a>>,
    /// Present where what moves is drawn out.
    pub(super) shutter: Option<Shutter>,
    pub(super) resolves: bool,
    pub(super) reduces: bool,
}

/// What turns fragments into colours.
pub(super) struct Shading<'a> {
    pub(super) stage: Stage<'a>,
    pub(super) surfaces: Vec<Surface<'a>>,
    pub(super) backdrop: develop::Backdrop,
}

/// The part of the frame's buffers that a row of tiles fills; empty where not wanted.
pub(super) struct Row<'a> {
    pub(super) picture: &'a mut [u8],
    pub(super) object_ids: &'a mut [u16],
    pub(super) depth_m: &'a mut [f32],
    pub(super) light: LightRow<'a>,
}

impl TilePass<'_> {
    /// Renders the tiles of a row.
    pub(super) fn row<const S: usize>(&self, y: u32, mut row: Row<'_>, scratch: &mut Scratch) {
        for x in 0..self.list.view.width.div_ceil(TILE as u32) {
            self.tile::<S>([x, y], &mut row, scratch);
        }
    }

    fn tile<const S: usize>(&self, tile: [u32; 2], row: &mut Row<'_>, scratch: &mut Scratch) {
        let view = &self.list.view;
        let origin_px = tile.map(|t| t * TILE as u32);
        let size = [view.width - origin_px[0], view.height - origin_px[1]]
            .map(|rest| rest.min(TILE as u32) as usize);
        let mut own = std::mem::take(&mut scratch.lens);
        let lens = scratch.measure(Step::Raster, |s| {
            let lens = self.lens.map(|lens| lens.tile::<S>(self.level, tile, &mut own));
            self.raster::<S>(tile, lens, s);
            clear_outside::<S>(size, &mut s.depth, &mut s.ids);
            lens
        });
        if let Some(shading) = &self.shading {
            self.shade::<S>(shading, origin_px, lens, scratch);
            if let Some(shutter) = self.shutter.as_ref().filter(|_| row.light.takes_ways()) {
                scratch.measure(Step::Ways, |s| {
                    let samples = (&s.ids[..], &s.depth[..]);
                    ways_of_tile::<S>(self, shutter, origin_px, lens, samples, &mut s.ways);
                    row.light.take_ways::<S>((tile, size), &s.ways);
                });
            }
            let grade = &self.list.grade;
            scratch.measure(Step::Display, |s| {
                if shading.stage.develop.keeps() {
                    let place = (tile, size);
                    row.light.take::<S>(self.level, self.list, place, &s.depth, &mut s.color);
                    return;
                }
                let grainy = grade.grain > 0.0;
                if grainy {
                    display::grain::<S>(grade.grain, grade.grain_key, origin_px, &mut s.noise);
                }
                let noise = if grainy { &s.noise[..] } else { &[] };
                display::encode(self.level, &s.color, noise, &mut s.bytes);
                copy_out::<S, u8, 3>(tile, size, view.width, row.picture, &s.bytes);
            });
        }
        if self.resolves || self.reduces {
            scratch.measure(Step::Resolve, |s| {
                objects_of_samples(self.level, self.chunks, &s.ids, &mut s.objects);
            });
        }
        if self.resolves {
            scratch.measure(Step::Resolve, |s| {
                let objects = &s.objects;
                resolve::<S>(
                    self.level,
                    &objects.of_sample,
                    &objects.uniform,
                    &s.depth,
                    view.near_m,
                    &mut s.resolved,
                );
                let resolved = &s.resolved;
                copy_out::<S, u16, 1>(tile, size, view.width, row.object_ids, &resolved.object);
                copy_out::<S, f32, 1>(tile, size, view.width, row.depth_m, &resolved.distance_m);
            });
        }
        if self.reduces {
            scratch.measure(Step::Reduce, |s| {
                reduce::reduce::<S>(self.level, &s.objects, origin_px, &mut s.sums)
            });
        }
        scratch.lens = own;
    }

    fn raster<const S: usize>(&self, tile: [u32; 2], lens: Option<&LensTile>, s: &mut Scratch) {
        let (level, chunks, touching) = (self.level, self.chunks, self.by_tile.of(tile));
        let (depth, ids, farthest) = (&mut s.depth[..], &mut s.ids[..], &mut s.farthest[..]);
        match lens {
            Some(lens) => {
                let samples = (depth, ids, farthest);
                raster_lens_tile::<S>(level, chunks, touching, tile, lens, samples);
            }
            None => {
                raster_tile::<S, true, TILE>(level, chunks, touching, tile, depth, ids, farthest)
            }
        }
    }

    fn shade<const S: usize>(
        &self,
        shading: &Shading<'_>,
        origin_px: [u32; 2],
        lens: Option<&LensTile>,
        scratch: &mut Scratch,
    ) {
        let (view, grade) = (&self.list.view, &self.list.grade);
        let noisy = develop::Develop::is_noisy(grade) && !shading.stage.develop.keeps();
        if noisy {
            scratch.measure(Step::Display, |s| {
                display::sensor_noise::<S>(grade.grain_key, origin_px, &mut s.sensor);
            });
        }
        scratch.measure(Step::Fragments, |s| {
            let visible = Visible {
                chunks: self.chunks,
                ids: &s.ids,
                depth: &s.depth,
                origin_px,
                focal_px: view.fx.max(view.fy),
            };
            gather::<S>(self.level, &mut s.fragments, self.list.draws.len(), &visible);
            develop::start_with_background::<S>(
                self.level,
                &shading.stage,
                shading.backdrop,
                lens.map(|lens| &*lens.rays),
                origin_px,
                (&s.fragments.background, noisy.then_some(&*s.sensor)),
                &mut s.color,
            );
        });
        scratch.measure(Step::Shade, |s| {
            if let Some((low, high)) = self.tile_box(origin_px, lens, &s.depth) {
                shading.stage.lighting.reaching(low, high, &mut s.reaching);
            }
            for bucket in s.fragments.buckets() {
                let draw = &self.list.draws[bucket.draw as usize];
                let drawn = DrawnSurface {
                    surface: &shading.surfaces[draw.material as usize],
                    double_sided: draw.double_sided,
                    mirrored: self.placed.mirrored[draw.object as usize],
                    blockers: &self.list.objects[draw.object as usize].blockers,
                };
                let (level, stage) = (self.level, &shading.stage);
                let reaching = (&s.reaching, noisy.then_some(&*s.sensor));
                let (color, rays) = (&mut s.color, lens.map(|lens| &*lens.rays));
                match rays {
                    Some(_) => shade::<true>(level, stage, drawn, rays, reaching, bucket, color),
                    None => shade::<false>(level, stage, drawn, rays, reaching, bucket, color),
                }
            }
        });
    }

    /// A view-space box round everything that a tile shows; nothing if it shows nothing.
    fn tile_box(
        &self,
        origin_px: [u32; 2],
        lens: Option<&LensTile>,
        depth: &[f32],
    ) -> Option<([f32; 3], [f32; 3])> {
        let view = &self.list.view;
        let [near, far] = depth_range(self.level, depth);
        if near <= 0.0 {
            return None;
        }
        let distance = [view.near_m / near * 0.9999, view.near_m / far * 1.0001];
        let px = |i: usize, end: u32| (origin_px[i] + end) as f32;
        let mut x = [0, TILE as u32].map(|end| (px(0, end) - view.cx) / view.fx);
        let mut y = [TILE as u32, 0].map(|end| (view.cy - px(1, end)) / view.fy);
        if let Some((lens, tile)) = self.lens.zip(lens) {
            let [left, bottom, right, top] = tile.ray_box(&lens.plane);
            (x, y) = ([left, right], [bottom, top]);
        }
        let low = |v: f32| (v * distance[0]).min(v * distance[1]);
        let high = |v: f32| (v * distance[0]).max(v * distance[1]);
        Some(([low(x[0]), low(y[0]), -distance[1]], [high(x[1]), high(y[1]), -distance[0]]))
    }
}

kernel! {
    /// Largest and smallest depth of the samples that show anything; 0 first if none does.
    fn depth_range(depth: &[f32]) -> [f32; 2] = depth_range_body
}

#[inline(always)]
fn depth_range_body<const AVX2: bool>(depth: &[f32]) -> [f32; 2] {
    let (mut near, mut far) = (F32x8::<AVX2>::ZERO, F32x8::splat(f32::MAX));
    for eight in depth.chunks_exact(LANES) {
        let z = F32x8::load(eight);
        near = near.max(z);
        far = far.min(z.gt(F32x8::ZERO).select(z, far));
    }
    [near.largest(), far.smallest()]
}

/// Empties the samples beyond the picture's right and lower border.
fn clear_outside<const S: usize>(size: [usize; 2], depth: &mut [f32], ids: &mut [u32]) {
    if size == [TILE; 2] {
        return;
    }
    for (slot, xy) in Layout::<S>::SLOT_XY.iter().enumerate() {
        if usize::from(xy[0]) >= size[0] || usize::from(xy[1]) >= size[1] {
            depth[slot * S..(slot + 1) * S].fill(0.0);
            ids[slot * S..(slot + 1) * S].fill(NOTHING);
        }
    }
}

/// Copies the pixel slots of a tile to their places in a row of tiles.
pub(super) fn copy_out<const S: usize, T: Copy, const N: usize>(
    tile: [u32; 2],
    size: [usize; 2],
    width: u32,
    row: &mut [T],
    slots: &[[T; N]; TILE * TILE],
) {
    let left = tile[0] as usize * TILE;
    let side = Layout::<S>::BLOCK_PX as usize;
    for y in 0..size[1] {
        let start = (y * width as usize + left) * N;
        let (line, _) = row[start..start + size[0] * N].as_chunks_mut::<N>();
        // The pixels of a block's row are neighbours in both.
        let mut slot = Layout::<S>::slot(0, y);
        let mut blocks = line.chunks_exact_mut(side);
        for pixels in &mut blocks {
            pixels.copy_from_slice(&slots[slot..slot + side]);
            slot += side * side;
        }
        let rest = blocks.into_remainder();
        let len = rest.len();
        rest.copy_from_slice(&slots[slot.min(TILE * TILE - len)..][..len]);
    }
}
