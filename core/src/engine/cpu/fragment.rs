//! Fragments: what of a tile is shaded, how often, and with which weight.
//!
//! The samples of a pixel that show the same smooth stretch of one draw share a fragment, all
//! others get one for each triangle; its weight is its share of the samples. Fragments are ordered
//! by draw, so that eight at a time share material and textures.

use std::ops::Range;

use super::chunk::{Chunk, Face, NOTHING, split_id};
use super::samples::{BLOCK, Layout, TILE};
use super::simd::LANES;

/// Cosine of the angle between faces, in 1/127 squared, below which an edge counts as a crease
/// that must not be shaded as one: 37 degrees.
const CREASE: i32 = (0.8 * 127.0 * 127.0) as i32;
/// Steps in depth larger than this many pixel widths separate surfaces.
const STEP_PX: f32 = 8.0;

/// The fragments of one draw.
#[derive(Clone, Debug)]
pub(super) struct Bucket {
    /// Index in the draw list.
    pub(super) draw: u32,
    /// First of its fragments in the ordered arrays, a multiple of eight.
    pub(super) start: usize,
    /// How many there are; up to the next multiple of eight the last is repeated, with weight 0.
    pub(super) len: usize,
}

/// One thing to shade.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fragment {
    /// Id of the triangle.
    pub(super) id: u32,
    /// Where to shade it: mean position of its samples, pixels of the picture.
    pub(super) x: f32,
    /// See `x`.
    pub(super) y: f32,
    /// Share of the pixel's samples.
    pub(super) weight: f32,
    /// Pixel slot in the tile.
    pub(super) slot: u16,
    bucket: u16,
}

/// The fragments of a tile.
#[derive(Default)]
pub(super) struct Fragments {
    found: Vec<Fragment>,
    /// Ordered by draw.
    pub(super) ordered: Vec<Fragment>,
    pub(super) buckets: Vec<Bucket>,
    /// Bucket of each draw, or none.
    bucket_of_draw: Vec<u16>,
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

impl Fragments {
    /// Finds the fragments of a tile.
    pub(super) fn gather<const S: usize>(&mut self, draws: usize, tile: &Visible<'_>) {
        self.found.clear();
        self.buckets.clear();
        self.background.resize(TILE * TILE, 0.0);
        if self.bucket_of_draw.len() != draws {
            self.bucket_of_draw.clear();
            self.bucket_of_draw.resize(draws, NO_BUCKET);
        }
        for (block, ids) in tile.ids.as_chunks::<BLOCK>().0.iter().enumerate() {
            let slots = block * BLOCK / S..(block + 1) * BLOCK / S;
            if equal(ids) {
                self.whole_pixels::<S>(tile, slots, ids[0]);
                continue;
            }
            for slot in slots {
                let ids = &tile.ids[slot * S..(slot + 1) * S];
                if equal(ids) {
                    self.whole_pixels::<S>(tile, slot..slot + 1, ids[0]);
                } else {
                    self.background[slot] = self.group::<S>(tile, slot);
                }
            }
        }
        self.order();
        for bucket in &self.buckets {
            self.bucket_of_draw[bucket.draw as usize] = NO_BUCKET;
        }
    }

    /// Adds pixels that one triangle, or nothing, covers.
    #[inline(always)]
    fn whole_pixels<const S: usize>(&mut self, tile: &Visible<'_>, slots: Range<usize>, id: u32) {
        if id == NOTHING {
            self.background[slots].fill(1.0);
            return;
        }
        let bucket = self.bucket(tile.chunks[split_id(id).0].draw);
        self.buckets[usize::from(bucket)].len += slots.len();
        self.background[slots.clone()].fill(0.0);
        for slot in slots {
            let [x, y] = Self::center::<S>(tile, slot, [8.0, 8.0]);
            self.found.push(Fragment { id, x, y, weight: 1.0, slot: slot as u16, bucket });
        }
    }

    /// The bucket of a draw.
    #[inline(always)]
    fn bucket(&mut self, draw: u32) -> u16 {
        let known = &mut self.bucket_of_draw[draw as usize];
        if *known == NO_BUCKET {
            *known = self.buckets.len() as u16;
            self.buckets.push(Bucket { draw, start: 0, len: 0 });
        }
        *known
    }

    /// Picture position of a point of a pixel, given in 1/16 pixel.
    #[inline(always)]
    fn center<const S: usize>(tile: &Visible<'_>, slot: usize, at_16th: [f32; 2]) -> [f32; 2] {
        let xy = Layout::<S>::SLOT_XY[slot];
        std::array::from_fn(|i| {
            (tile.origin_px[i] + u32::from(xy[i])) as f32 + at_16th[i] * (1.0 / 16.0)
        })
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
                            && tile.chunks[split_id(other).0].draw == chunk.draw
                            && tile.connected(first + i, first + j)));
                if together {
                    rest &= !(1 << j);
                    count += 1;
                    let p = Layout::<S>::POSITIONS[j];
                    sum = [sum[0] + p[0], sum[1] + p[1]];
                }
            }
            let mean = sum.map(|s| s as f32 / count as f32);
            let [x, y] = Self::center::<S>(tile, slot, mean);
            let weight = count as f32 / S as f32;
            let bucket = self.bucket(chunk.draw);
            self.buckets[usize::from(bucket)].len += 1;
            self.found.push(Fragment { id, x, y, weight, slot: slot as u16, bucket });
        }
        nothing as f32 / S as f32
    }

    /// Sorts by bucket, keeping the order within each.
    fn order(&mut self) {
        let mut end = 0;
        for bucket in &mut self.buckets {
            bucket.start = end;
            end += bucket.len.next_multiple_of(LANES);
            bucket.len = 0;
        }
        self.ordered.resize(end, Fragment::default());
        for fragment in &self.found {
            let bucket = &mut self.buckets[usize::from(fragment.bucket)];
            self.ordered[bucket.start + bucket.len] = *fragment;
            bucket.len += 1;
        }
        for bucket in &self.buckets {
            let end = bucket.start + bucket.len;
            let pad = Fragment { weight: 0.0, ..self.ordered[end - 1] };
            self.ordered[end..end.next_multiple_of(LANES)].fill(pad);
        }
    }
}
