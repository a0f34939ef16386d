//! Reduce: count and extent of each object's visible samples.
//!
//! Sums, smallest and largest of whole numbers, so that it does not matter which thread saw what.

use super::resolve::SampleObjects;
use super::samples::{BLOCK, Layout};
use crate::plan::ObjectSamples;

/// Adds the samples of a tile.
pub(super) fn reduce<const S: usize>(
    objects: &SampleObjects,
    origin_px: [u32; 2],
    sums: &mut [ObjectSamples],
) {
    let blocks = objects.of_sample.chunks_exact(BLOCK).zip(&objects.uniform);
    for (block, (samples, uniform)) in blocks.enumerate() {
        let xy = Layout::<S>::SLOT_XY[block * BLOCK / S];
        let corner: [i32; 2] =
            std::array::from_fn(|i| (origin_px[i] + u32::from(xy[i])) as i32 * 16);
        if *uniform {
            if samples[0] != 0 {
                let [low, high] = Layout::<S>::EXTENT;
                let last_px = (Layout::<S>::BLOCK_PX - 1) * 16;
                let sum = &mut sums[usize::from(samples[0]) - 1];
                sum.count += BLOCK as u64;
                extend(sum, corner, low, high.map(|v| v + last_px));
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
