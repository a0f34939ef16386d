//! The visible box: tight around the samples that show a person, and around their mask.
//!
//! Units are pixels in image coordinates ([`crate::base::space`]). With n samples a pixel, each
//! sample stands for a cell one n-th of a pixel wide and high (the sample patterns have one sample
//! in each such row and column), so a side is right to half a cell. The mask is made of whole
//! pixels, and a box must hold it: where a mask pixel reaches further than the samples in it, the
//! side moves out to the pixel's edge. Single samples far from the mask, such as of a leg that shows
//! through a gap thinner than a pixel, move a side by one pixel at most. The box therefore contains
//! the mask and exceeds it by no more than a pixel.

use super::mask::Extent;
use crate::plan::ObjectSamples;

/// `[x, y, w, h]` of the visible box.
///
/// `samples` is the number of samples a pixel, 1, 4 or 16; the extent is that of the person's mask.
#[must_use]
pub fn visible_box(seen: &ObjectSamples, mask: &Extent, samples: u32) -> [f64; 4] {
    let half_cell = 0.5 / f64::from(samples);
    let low = |axis: usize| {
        let sample = f64::from(seen.min_16th[axis]) / 16.0 - half_cell;
        let edge = f64::from(mask.min[axis]);
        sample.clamp(edge - 1.0, edge)
    };
    let high = |axis: usize| {
        let sample = f64::from(seen.max_16th[axis]) / 16.0 + half_cell;
        let edge = f64::from(mask.max[axis]) + 1.0;
        sample.clamp(edge, edge + 1.0)
    };
    let (x, y) = (low(0), low(1));
    [x, y, high(0) - x, high(1) - y]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_one_sample_it_is_the_mask_s_own_box() {
        let seen =
            ObjectSamples { count: 6, min_16th: [16 * 3 + 8, 8], max_16th: [16 * 5 + 8, 24] };
        let mask = Extent { pixels: 6, min: [3, 0], max: [5, 1] };
        assert_eq!(visible_box(&seen, &mask, 1), [3.0, 0.0, 3.0, 2.0]);
    }

    #[test]
    fn a_part_thinner_than_a_pixel_widens_it_by_sample_cells() {
        // One of four samples of the column right of the mask is seen, in that pixel's first cell.
        let seen = ObjectSamples { count: 5, min_16th: [2, 2], max_16th: [16 + 2, 14] };
        let mask = Extent { pixels: 1, min: [0, 0], max: [0, 0] };
        assert_eq!(visible_box(&seen, &mask, 4), [0.0, 0.0, 1.25, 1.0]);
    }

    #[test]
    fn what_shows_far_from_the_mask_widens_it_by_a_pixel() {
        let seen = ObjectSamples { count: 5, min_16th: [2, 2], max_16th: [16 * 30 + 2, 14] };
        let mask = Extent { pixels: 1, min: [0, 0], max: [0, 0] };
        assert_eq!(visible_box(&seen, &mask, 4), [0.0, 0.0, 2.0, 1.0]);
    }

    #[test]
    fn it_never_cuts_a_mask_pixel() {
        let seen = ObjectSamples { count: 2, min_16th: [14, 6], max_16th: [14, 14] };
        let mask = Extent { pixels: 1, min: [0, 0], max: [0, 0] };
        assert_eq!(visible_box(&seen, &mask, 4), [0.0, 0.0, 1.0, 1.0]);
    }
}
