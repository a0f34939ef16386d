//! Fragments: what of a tile is shaded, how often, and with which weight.
//!
//! The samples of a pixel that show the same smooth stretch of one draw share a fragment, all
//! others get one for each triangle; its weight is its share of the samples. Fragments are listed
//! by draw, so that eight at a time share material and textures.

use super::chunk::{Chunk, Face, NOTHING, same_chunk, split_id};
use super::samples::{BLOCK, Layout, TILE};
use super::simd::{LANES, kernel};

/// Cosine of the angle between faces, in 1/127 squared, below which an edge counts as a crease
/// that must not be shaded as one: 37 degrees.
const CREASE: i32 = (0.8 * 127.0 * 127.0) as i32;
/// Steps in depth larger than this many pixel widths separate surfaces.
const STEP_PX: f32 = 8.0;

/// The fragments of one draw, one list for each of their properties.
#[derive(Clone, Debug, Default)]
pub(super) struct Bucket {
    /// Index in the draw list.
    pub(super) draw: u32,
    /// Id of the triangle.
    pub(super) id: Vec<u32>,
    /// Where to shade it: mean position of its samples, pixels of the picture.
    pub(super) x: Vec<f32>,
    /// See `x`.
    pub(super) y: Vec<f32>,
    /// Share of the pixel's samples.
    pub(super) weight: Vec<f32>,
    /// Pixel slot in the tile.
    pub(super) slot: Vec<u16>,
}

impl Bucket {
    fn restart(&mut self, draw: u32) {
        self.draw = draw;
        self.id.clear();
        self.x.clear();
        self.y.clear();
        self.weight.clear();
        self.slot.clear();
    }

    /// Repeats the last fragment, without weight, up to a multiple of eight.
    fn pad(&mut self) {
        let len = self.id.len().next_multiple_of(LANES);
        let last = self.id.len() - 1;
        self.id.resize(len, self.id[last]);
        self.x.resize(len, self.x[last]);
        self.y.resize(len, self.y[last]);
        self.weight.resize(len, 0.0);
        self.slot.resize(len, self.slot[last]);
    }
}

/// The fragments of a tile.
#[derive(Default)]
pub(super) struct Fragments {
    /// Those in use come first; the others keep their memory for later tiles.
    buckets: Vec<Bucket>,
    used: usize,
    /// Bucket of each draw, or none.
    bucket_of_draw: Vec<u16>,
    /// An id of the chunk that was seen last, and its bucket.
    latest: (u32, usize),
    /// Share of each pixel slot that shows nothing.
    pub(super) background: Vec<f32>,
}

const NO_BUCKET: u16 = u16::MAX;

/// Whether all ids are the same.
#[inline(always)]
fn equal(ids: &[u32]) -> bool {
    ids.iter().fold(0, |differ, id| differ | (id ^ ids[0])) == 0
}

/// A tile's visibility and where it stands.
#[derive(Clone, Copy)]
pub(super) struct Visible<'a> {
    pub(super) chunks: &'a [Chunk],
    pub(super) ids: &'a [u32],
    pub(super) depth: &'a [f32],
    pub(super) origin_px: [u32; 2],
    /// Larger focal length, pixels.
    pub(super) focal_px: f32,
}

impl Visible<'_> {
    #[inline(always)]
    fn face(&self, id: u32) -> &Face {
        let (chunk, triangle) = split_id(id);
        &self.chunks[chunk].faces[triangle]
    }

    /// Whether two samples of one smooth draw lie on one smooth stretch of surface.
    #[inline(always)]
    fn connected(&self, i: usize, j: usize) -> bool {
        let (zi, zj) = (self.depth[i], self.depth[j]);
        if (zi - zj).abs() * self.focal_px > STEP_PX * zi.min(zj) {
            return false;
        }
        let (a, b) = (self.face(self.ids[i]).normal, self.face(self.ids[j]).normal);
        let dot: i32 = (0..3).map(|k| i32::from(a[k]) * i32::from(b[k])).sum();
        dot >= CREASE
    }
}

kernel! {
    /// Finds the fragments of a tile.
    fn gather[const S: usize](
        fragments: &mut Fragments,
        draws: usize,
        tile: &Visible<'_>,
    ) = gather_body
}

#[inline(always)]
fn gather_body<const AVX2: bool, const S: usize>(
    fragments: &mut Fragments,
    draws: usize,
    tile: &Visible<'_>,
) {
    fragments.gather::<S>(draws, tile);
}

impl Fragments {
    /// What was found, draw by draw: a multiple of eight fragments each, of which the last may be
    /// repeated without weight.
    pub(super) fn buckets(&self) -> &[Bucket] {
        &self.buckets[..self.used]
    }

    #[inline(always)]
    fn gather<const S: usize>(&mut self, draws: usize, tile: &Visible<'_>) {
        self.used = 0;
        self.latest = (NOTHING, 0);
        self.background.resize(TILE * TILE, 0.0);
        if self.bucket_of_draw.len() != draws {
            self.bucket_of_draw.clear();
            self.bucket_of_draw.resize(draws, NO_BUCKET);
        }
        for (block, ids) in tile.ids.as_chunks::<BLOCK>().0.iter().enumerate() {
            let first = block * BLOCK / S;
            if equal(ids) {
                match S {
                    1 => self.whole_pixels::<S, 16>(tile, first, ids[0]),
                    4 => self.whole_pixels::<S, 4>(tile, first, ids[0]),
                    _ => self.whole_pixels::<S, 1>(tile, first, ids[0]),
                }
                continue;
            }
            for slot in first..first + BLOCK / S {
                let ids = &tile.ids[slot * S..(slot + 1) * S];
                if equal(ids) {
                    self.whole_pixels::<S, 1>(tile, slot, ids[0]);
                } else {
                    self.background[slot] = self.group::<S>(tile, slot);
                }
            }
        }
        for bucket in &mut self.buckets[..self.used] {
            bucket.pad();
            self.bucket_of_draw[bucket.draw as usize] = NO_BUCKET;
        }
    }

    /// Adds `N` pixels that one triangle, or nothing, covers.
    #[inline(always)]
    fn whole_pixels<const S: usize, const N: usize>(
        &mut self,
        tile: &Visible<'_>,
        first: usize,
        id: u32,
    ) {
        let background = &mut self.background[first..first + N];
        if id == NOTHING {
            background.fill(1.0);
            return;
        }
        background.fill(0.0);
        let (mut x, mut y, mut slots) = ([0.0; N], [0.0; N], [0; N]);
        let places = &Layout::<S>::SLOT_XY[first..first + N];
        for i in 0..N {
            x[i] = (tile.origin_px[0] + u32::from(places[i][0])) as f32 + 0.5;
            y[i] = (tile.origin_px[1] + u32::from(places[i][1])) as f32 + 0.5;
            slots[i] = (first + i) as u16;
        }
        let bucket = self.bucket(tile, id);
        bucket.id.extend_from_slice(&[id; N]);
        bucket.x.extend_from_slice(&x);
        bucket.y.extend_from_slice(&y);
        bucket.weight.extend_from_slice(&[1.0; N]);
        bucket.slot.extend_from_slice(&slots);
    }

    /// The bucket of an id's draw.
    #[inline(always)]
    fn bucket(&mut self, tile: &Visible<'_>, id: u32) -> &mut Bucket {
        if !same_chunk(id, self.latest.0) {
            self.latest = (id, self.bucket_of(tile.chunks[split_id(id).0].draw));
        }
        &mut self.buckets[self.latest.1]
    }

    /// Place of a draw's bucket.
    fn bucket_of(&mut self, draw: u32) -> usize {
        let known = &mut self.bucket_of_draw[draw as usize];
        if *known == NO_BUCKET {
            *known = self.used as u16;
            if self.used == self.buckets.len() {
                self.buckets.push(Bucket::default());
            }
            self.buckets[self.used].restart(draw);
            self.used += 1;
        }
        usize::from(*known)
    }

    /// Divides the samples of a pixel that shows several triangles; returns the share of the
    /// samples that show nothing.
    #[inline(always)]
    fn group<const S: usize>(&mut self, tile: &Visible<'_>, slot: usize) -> f32 {
        let first = slot * S;
        let mut rest: u32 = (1 << S) - 1;
        let mut nothing = 0;
        for i in 0..S {
            if rest >> i & 1 == 0 {
                continue;
            }
            let id = tile.ids[first + i];
            if id == NOTHING {
                nothing += 1;
                continue;
            }
            let chunk = &tile.chunks[split_id(id).0];
            let (mut count, mut sum) = (0, [0; 2]);
            for j in i..S {
                let other = tile.ids[first + j];
                let free = rest >> j & 1 == 1 && other != NOTHING;
                let together = free
                    && (other == id
                        || (chunk.smooth
                            && (same_chunk(other, id)
                                || tile.chunks[split_id(other).0].draw == chunk.draw)
                            && tile.connected(first + i, first + j)));
                if together {
                    rest &= !(1 << j);
                    count += 1;
                    let p = Layout::<S>::POSITIONS[j];
                    sum = [sum[0] + p[0], sum[1] + p[1]];
                }
            }
            let share = 1.0 / count as f32;
            let xy = Layout::<S>::SLOT_XY[slot];
            let at = |axis: usize| {
                let corner = (tile.origin_px[axis] + u32::from(xy[axis])) as f32;
                corner + sum[axis] as f32 * share * (1.0 / 16.0)
            };
            let bucket = self.bucket(tile, id);
            bucket.id.push(id);
            bucket.x.push(at(0));
            bucket.y.push(at(1));
            bucket.weight.push(count as f32 / S as f32);
            bucket.slot.push(slot as u16);
        }
        nothing as f32 / S as f32
    }
}
