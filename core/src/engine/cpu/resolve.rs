//! Resolve: the object that most samples of each pixel show, and its distance.

use super::chunk::{Chunk, NOTHING, same_chunk, split_id};
use super::samples::{BLOCK, TILE};
use super::simd::{F32x8, LANES, kernel};

/// Object of each sample of a tile, plus one; 0 for nothing.
#[derive(Default)]
pub(super) struct SampleObjects {
    pub(super) of_sample: Vec<u16>,
    /// Whether all samples of a block show the same object.
    pub(super) uniform: Vec<bool>,
}

impl SampleObjects {
    /// Looks up the objects of a tile's ids.
    pub(super) fn fill(&mut self, chunks: &[Chunk], ids: &[u32]) {
        self.of_sample.resize(ids.len(), 0);
        self.uniform.resize(ids.len() / BLOCK, false);
        let object = |id: u32| {
            if id == NOTHING { 0 } else { chunks[split_id(id).0].object as u16 + 1 }
        };
        let blocks = ids.chunks_exact(BLOCK).zip(self.of_sample.chunks_exact_mut(BLOCK));
        for ((ids, objects), uniform) in blocks.zip(&mut self.uniform) {
            // Without branches, so that a block is compared at once.
            let differ = ids.iter().fold(0, |differ, id| differ | (id ^ ids[0]));
            if same_chunk(differ, 0) {
                objects.fill(object(ids[0]));
                *uniform = true;
                continue;
            }
            for (object_of, id) in objects.iter_mut().zip(ids) {
                *object_of = object(*id);
            }
            *uniform = objects.iter().all(|o| *o == objects[0]);
        }
    }
}

/// Object and distance of each pixel slot of a tile.
pub(super) struct Resolved {
    /// As in [`crate::plan::Frame::object_ids`].
    pub(super) object: [[u16; 1]; TILE * TILE],
    /// As in [`crate::plan::Frame::depth_m`].
    pub(super) distance_m: [[f32; 1]; TILE * TILE],
}

impl Default for Resolved {
    fn default() -> Self {
        Self { object: [[0]; TILE * TILE], distance_m: [[0.0]; TILE * TILE] }
    }
}

kernel! {
    /// Picks the object of each pixel slot.
    fn resolve[const S: usize](
        objects: &[u16],
        uniform: &[bool],
        depth: &[f32],
        near_m: f32,
        out: &mut Resolved,
    ) = resolve_body
}

#[inline(always)]
fn resolve_body<const AVX2: bool, const S: usize>(
    objects: &[u16],
    uniform: &[bool],
    depth: &[f32],
    near_m: f32,
    out: &mut Resolved,
) {
    let blocks = objects.as_chunks::<BLOCK>().0.iter().zip(depth.as_chunks::<BLOCK>().0);
    for (block, (objects, depth)) in blocks.enumerate() {
        let first = block * (BLOCK / S);
        let pixels = first..first + BLOCK / S;
        let object = out.object[pixels.clone()].iter_mut();
        let places = object.zip(&mut out.distance_m[pixels]);
        let samples = objects.chunks_exact(S).zip(depth.chunks_exact(S));
        if uniform[block] {
            for ((object, distance), (objects, depth)) in places.zip(samples) {
                *object = [objects[0]];
                *distance = [depth.iter().fold(0.0, |a: f32, z| if *z > a { *z } else { a })];
            }
        } else {
            for ((object, distance), (objects, depth)) in places.zip(samples) {
                let (winner, nearest) = vote::<S>(objects, depth);
                (*object, *distance) = ([winner], [nearest]);
            }
        }
    }
    for eight in out.distance_m.as_flattened_mut().chunks_exact_mut(LANES) {
        let depth = F32x8::<AVX2>::load(eight);
        let seen = depth.gt(F32x8::ZERO);
        let distance = F32x8::splat(near_m) / seen.select(depth, F32x8::ONE);
        seen.select(distance, F32x8::ZERO).store(eight);
    }
}

/// The object with most samples and its largest depth; of equals the nearest, nothing last.
#[inline(always)]
fn vote<const S: usize>(objects: &[u16], depth: &[f32]) -> (u16, f32) {
    let (mut winner, mut votes, mut nearest) = (0, 0, 0.0);
    for i in 0..S {
        let object = objects[i];
        let (mut count, mut closest) = (0, 0.0);
        for j in 0..S {
            if objects[j] == object {
                count += 1;
                closest = if depth[j] > closest { depth[j] } else { closest };
            }
        }
        if count > votes || (count == votes && closest > nearest) {
            (winner, votes, nearest) = (object, count, closest);
        }
    }
    (winner, if winner == 0 { 0.0 } else { nearest })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn most_samples_win_then_the_nearest_and_nothing_comes_last() {
        assert_eq!(vote::<4>(&[1, 2, 2, 0], &[0.9, 0.1, 0.2, 0.0]), (2, 0.2));
        assert_eq!(vote::<4>(&[1, 2, 2, 1], &[0.9, 0.1, 0.2, 0.3]), (1, 0.9));
        assert_eq!(vote::<4>(&[0, 0, 3, 3], &[0.0, 0.0, 0.1, 0.2]), (3, 0.2));
        assert_eq!(vote::<4>(&[0, 0, 3, 4], &[0.0, 0.0, 0.1, 0.2]), (0, 0.0));
    }
}
