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

kernel! {
    /// Looks up the objects of a tile's ids.
    fn objects_of_samples(chunks: &[Chunk], ids: &[u32], out: &mut SampleObjects) = objects_body
}

#[inline(always)]
fn objects_body<const AVX2: bool>(chunks: &[Chunk], ids: &[u32], out: &mut SampleObjects) {
    out.of_sample.resize(ids.len(), 0);
    out.uniform.resize(ids.len() / BLOCK, false);
    let blocks = ids.as_chunks::<BLOCK>().0.iter().zip(out.of_sample.as_chunks_mut::<BLOCK>().0);
    for ((ids, objects), uniform) in blocks.zip(&mut out.uniform) {
        // Without branches, so that a block is compared at once.
        let mut differ = 0;
        for id in ids {
            differ |= id ^ ids[0];
        }
        if same_chunk(differ, 0) {
            *objects = [object_of(chunks, ids[0]); BLOCK];
            *uniform = true;
            continue;
        }
        let mut differ = 0;
        for (object, id) in objects.iter_mut().zip(ids) {
            *object = object_of(chunks, *id);
        }
        for object in &*objects {
            differ |= object ^ objects[0];
        }
        *uniform = differ == 0;
    }
}

/// Object of an id plus one; 0 for nothing.
#[inline(always)]
fn object_of(chunks: &[Chunk], id: u32) -> u16 {
    if id == NOTHING { 0 } else { chunks[split_id(id).0].object as u16 + 1 }
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
                *distance = [nearest(depth)];
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

/// The largest of some depths.
#[inline(always)]
fn nearest(depth: &[f32]) -> f32 {
    let mut nearest = 0.0;
    for z in depth {
        nearest = if *z > nearest { *z } else { nearest };
    }
    nearest
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
