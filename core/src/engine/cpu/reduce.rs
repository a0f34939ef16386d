//! Reduce: count and extent of each object's visible samples.
//!
//! Sums, smallest and largest of whole numbers, so that it does not matter which thread saw what.

use super::resolve::SampleObjects;
use super::samples::{BLOCK, Layout};
use super::simd::kernel;
use crate::plan::ObjectSamples;

kernel! {
    /// Adds the samples of a tile.
    fn reduce[const S: usize](
        objects: &SampleObjects,
        origin_px: [u32; 2],
        sums: &mut [ObjectSamples],
    ) = reduce_body
}

#[inline(always)]
fn reduce_body<const AVX2: bool, const S: usize>(
    objects: &SampleObjects,
    origin_px: [u32; 2],
    sums: &mut [ObjectSamples],
) {
    let blocks = objects.of_sample.chunks_exact(BLOCK).zip(&objects.uniform);
    for (block, (samples, uniform)) in blocks.enumerate() {
        let xy = Layout::<S>::SLOT_XY[block * BLOCK / S];
        let corner = [origin_px[0] + u32::from(xy[0]), origin_px[1] + u32::from(xy[1])];
        let corner = [corner[0] as i32 * 16, corner[1] as i32 * 16];
        if *uniform {
            if samples[0] != 0 {
                let [low, high] = Layout::<S>::EXTENT;
                let last_px = (Layout::<S>::BLOCK_PX - 1) * 16;
                let sum = &mut sums[usize::from(samples[0]) - 1];
                sum.count += BLOCK as u64;
                extend(sum, corner, low, [high[0] + last_px, high[1] + last_px]);
            }
            continue;
        }
        for (sample, object) in samples.iter().enumerate() {
            if *object != 0 {
                let sum = &mut sums[usize::from(*object) - 1];
                let at = Layout::<S>::BLOCK_16TH[sample];
                sum.count += 1;
                extend(sum, corner, at, at);
            }
        }
    }
}

/// Grows an extent to a box given from a corner.
#[inline(always)]
fn extend(sum: &mut ObjectSamples, corner: [i32; 2], low: [i32; 2], high: [i32; 2]) {
    for axis in 0..2 {
        sum.min_16th[axis] = sum.min_16th[axis].min(corner[axis] + low[axis]);
        sum.max_16th[axis] = sum.max_16th[axis].max(corner[axis] + high[axis]);
    }
}

/// Adds one set of sums to another.
pub(super) fn merge(into: &mut [ObjectSamples], from: &[ObjectSamples]) {
    for (a, b) in into.iter_mut().zip(from) {
        a.count += b.count;
        for axis in 0..2 {
            a.min_16th[axis] = a.min_16th[axis].min(b.min_16th[axis]);
            a.max_16th[axis] = a.max_16th[axis].max(b.max_16th[axis]);
        }
    }
}
