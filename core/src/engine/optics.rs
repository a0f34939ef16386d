//! What both engines know of light that leaves its pixel: whether a frame has any, and at which size
//! it is spread. How it is spread is each engine's own.

use crate::draw::DrawList;
use crate::draw::abi::{Bloom, Defocus, Shutter};
use crate::plan::{Pass, PassPlan};

/// Largest radius over which light out of focus is gathered, texels.
const MOST_TEXELS: f32 = 8.0;
/// Levels of the pyramid of scattered light at most.
const MOST_LEVELS: usize = 12;
/// Places that light is taken from on either side of a pixel, along a way.
pub(super) const MOST_TAPS: u32 = 16;
/// Ways are kept in whole parts of a pixel, so many of them.
pub(super) const WAY_PER_PX: f32 = 64.0;
/// Longest way that is kept, pixels, so that it fits 16 bits.
pub(super) const MOST_WAY_PX: f32 = 500.0;
/// Sides of the tiles that know their longest way are multiples of this.
const LEAST_TILE: u32 = 8;
/// Texels of the larger side that a level has at least.
const LEAST_SIDE: u32 = 4;

/// Light out of focus, where a frame's plan spreads it.
pub(super) fn blurs(list: &DrawList, plan: &PassPlan) -> Option<Defocus> {
    list.defocus.filter(|_| plan.runs(Pass::Defocus))
}

/// Scattered light, where a frame's plan scatters it.
pub(super) fn scatters(list: &DrawList, plan: &PassPlan) -> Option<Bloom> {
    list.grade.bloom.filter(|_| plan.runs(Pass::Bloom))
}

/// What moves while the shutter is open, where a frame's plan draws it out.
pub(super) fn moves(list: &DrawList, plan: &PassPlan) -> Option<Shutter> {
    list.shutter.filter(|_| plan.runs(Pass::MotionBlur))
}

/// Side of the tiles that know their longest way, pixels: no way is longer.
pub(super) fn way_tile(shutter: &Shutter) -> u32 {
    (shutter.longest_px.ceil() as u32).next_multiple_of(LEAST_TILE)
}

/// Whether a frame's light is kept, to be developed by the pixel once all of it is known.
pub(super) fn keeps_light(list: &DrawList, plan: &PassPlan) -> bool {
    let spreads = blurs(list, plan).is_some()
        || moves(list, plan).is_some()
        || scatters(list, plan).is_some();
    plan.runs(Pass::Display) && spreads
}

/// How often the picture is halved before light out of focus is gathered, so that no disk is wider
/// than what is looked at.
pub(super) fn blur_level(defocus: &Defocus) -> u32 {
    (0..16).find(|l| defocus.largest_px <= MOST_TEXELS * (1 << l) as f32).unwrap_or(16)
}

/// Texels of a level of a picture; what does not fill a texel has one as well.
pub(super) const fn level_size([width, height]: [u32; 2], level: u32) -> [u32; 2] {
    [width.div_ceil(1 << level), height.div_ceil(1 << level)]
}

/// Sizes of the levels of scattered light, from half the picture's on.
pub(super) fn bloom_levels(size: [u32; 2]) -> Vec<[u32; 2]> {
    let halved = |[w, h]: &[u32; 2]| Some([w.div_ceil(2), h.div_ceil(2)]);
    let levels = std::iter::successors(halved(&size), halved).take(MOST_LEVELS);
    let large = |size: &[u32; 2]| size[0].max(size[1]) >= LEAST_SIDE;
    let (first, rest) = (halved(&size), levels.skip(1).take_while(large));
    first.into_iter().chain(rest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn disks_fit_what_is_looked_at() {
        for (largest_px, level) in [(0.6, 0), (8.0, 0), (8.1, 1), (32.0, 2), (400.0, 6)] {
            let defocus = Defocus { focus_m: 1.0, at_infinity_px: largest_px, largest_px };
            assert_eq!(blur_level(&defocus), level, "{largest_px}");
        }
    }

    #[test]
    fn levels_halve_down_to_a_few_texels() {
        let sizes = bloom_levels([640, 480]);
        assert_eq!(sizes[0], [320, 240]);
        assert_eq!(sizes.last(), Some(&[5, 4]));
        assert_eq!(bloom_levels([1, 1]), [[1, 1]]);
        assert_eq!(bloom_levels([8192, 1]).len(), 11);
        assert_eq!(level_size([13, 8], 3), [2, 1]);
    }
}
