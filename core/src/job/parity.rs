//! Parity: how far two engines are apart over the same scenes.

use std::ops::Range;

use super::{FrameError, Studio};
use crate::label::{self, Annotations};
use crate::plan::{Frame, Output, Outputs, StageTimes};

/// Most that two engines may differ by: steps of 255 on average, and in one pixel away from edges.
pub const COLOR_MEAN: f64 = 0.5;
/// See [`COLOR_MEAN`].
pub const COLOR_MOST: u8 = 8;
/// Share of the pixels that may show another object: samples within a thousandth of a pixel of an
/// edge, on which rounding decides.
pub const IDS: f64 = 1e-4;
/// Relative error of a distance, away from edges and beyond what a surface's slope makes of a
/// thousandth of a pixel.
pub const DEPTH: f64 = 1e-5;

/// Steps of 255 by which neighbours differ where there is an edge of light or of a texture, which
/// a thousandth of a pixel may move over a texel's border.
const EDGE_STEPS: u8 = 40;
/// Share of the change of depth to the next pixel that rounding of a sample's place may make.
const SLOPE_SHARE: f64 = 2e-4;

/// How two engines' frames of the same scenes differ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Pixels that were compared.
    pub pixels: usize,
    /// Pixels with another object.
    pub ids: usize,
    /// Pixels away from edges.
    pub inner: usize,
    /// Largest relative error of a distance away from edges, slope apart.
    pub depth: f64,
    /// Mean over all channels, steps of 255.
    pub color_mean: f64,
    /// Largest away from edges, steps of 255.
    pub color_most: u8,
    /// People that were compared.
    pub people: usize,
    /// People with another box or other keypoints.
    pub labels: usize,
}

impl Difference {
    /// Of two frames of one draw list, with everything that both have got.
    #[must_use]
    pub fn of(reference: &Frame, other: &Frame) -> Self {
        let pixels = reference.width as usize * reference.height as usize;
        let mut found = Self { pixels, ..Self::default() };
        let (Some(a), Some(b)) = (&reference.object_ids, &other.object_ids) else { return found };
        found.ids = a.iter().zip(b).filter(|(a, b)| a != b).count();
        if let (Some(a), Some(b)) = (&reference.picture, &other.picture) {
            let sum: u64 = a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
            found.color_mean = sum as f64 / a.len().max(1) as f64;
        }
        for pixel in 0..pixels {
            found.add_pixel(pixel, reference, other);
        }
        found
    }

    fn add_pixel(&mut self, own: usize, reference: &Frame, other: &Frame) {
        let (Some(ids), Some(others)) = (&reference.object_ids, &other.object_ids) else { return };
        let near = || neighbours(own, reference);
        if near().any(|i| ids[i] != ids[own] || others[i] != ids[own]) {
            return;
        }
        if let (Some(a), Some(b)) = (&reference.depth_m, &other.depth_m) {
            let from = f64::from(a[own]);
            let slope = near().map(|i| (f64::from(a[i]) - from).abs()).fold(0.0, f64::max);
            let error = (f64::from(b[own]) - from).abs() - SLOPE_SHARE * slope;
            self.depth = self.depth.max(error / from.max(1e-9));
        }
        let (Some(a), Some(b)) = (&reference.picture, &other.picture) else { return };
        let spread = |c: usize| {
            let values = || near().map(|i| a[i * 3 + c]);
            values().max().unwrap_or(0) - values().min().unwrap_or(0)
        };
        if (0..3).all(|c| spread(c) <= EDGE_STEPS) {
            self.inner += 1;
            for c in 0..3 {
                self.color_most = self.color_most.max(a[own * 3 + c].abs_diff(b[own * 3 + c]));
            }
        }
    }

    /// Counts people whose labels differ.
    fn add_labels(&mut self, reference: &Annotations, other: &Annotations) {
        let (a, b) = (&reference.people, &other.people);
        self.people += a.len();
        let differ = a.iter().zip(b).filter(|(a, b)| {
            (a.instance, &a.bbox, &a.keypoints) != (b.instance, &b.bbox, &b.keypoints)
        });
        self.labels += differ.count() + a.len().abs_diff(b.len());
    }

    /// Takes another comparison in.
    pub fn add(&mut self, other: &Self) {
        let pixels = (self.pixels + other.pixels).max(1) as f64;
        self.color_mean = (self.color_mean * self.pixels as f64
            + other.color_mean * other.pixels as f64)
            / pixels;
        self.pixels += other.pixels;
        self.ids += other.ids;
        self.inner += other.inner;
        self.depth = self.depth.max(other.depth);
        self.color_most = self.color_most.max(other.color_most);
        self.people += other.people;
        self.labels += other.labels;
    }

    /// Whether all pictures and ids are as near as promised. Labels follow the ids: a sample that
    /// rounding moved over an edge may move a box.
    #[must_use]
    pub fn is_parity(&self) -> bool {
        self.color_mean <= COLOR_MEAN
            && self.color_most <= COLOR_MOST
            && self.depth <= DEPTH
            && self.ids as f64 <= IDS * self.pixels as f64
    }
}

/// Pixels round a pixel, itself among them.
fn neighbours(own: usize, frame: &Frame) -> impl Iterator<Item = usize> + Clone {
    let (width, height) = (frame.width as usize, frame.height as usize);
    let (x, y) = (own % width, own / width);
    (y.saturating_sub(1)..(y + 2).min(height))
        .flat_map(move |y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| y * width + x))
}

/// Renders frames of a document by two studios that have it, and compares all outputs.
///
/// # Errors
/// When one of them cannot render a frame.
pub fn compare(
    reference: &mut Studio,
    other: &mut Studio,
    frames: Range<u32>,
) -> Result<Difference, FrameError> {
    let outputs = Outputs::from(Output::ALL);
    let mut all = Difference::default();
    for frame in frames {
        let scene = reference.scene(frame);
        let by = |studio: &mut Studio| {
            let (drawn, frame) = studio.render_scene(&scene, &mut StageTimes::default())?;
            let labels = label::annotate(&scene, &drawn, &frame, &outputs);
            Ok::<_, FrameError>((frame, labels))
        };
        let (a, b) = (by(reference)?, by(other)?);
        let mut one = Difference::of(&a.0, &b.0);
        one.add_labels(&a.1, &b.1);
        all.add(&one);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grey picture of one object at 2 m.
    fn plain(side: u32) -> Frame {
        let pixels = (side * side) as usize;
        Frame {
            width: side,
            height: side,
            picture: Some(vec![100; pixels * 3]),
            object_ids: Some(vec![1; pixels]),
            depth_m: Some(vec![2.0; pixels]),
            ..Frame::default()
        }
    }

    #[test]
    fn a_frame_is_as_itself() {
        let frame = plain(5);
        let found = Difference::of(&frame, &frame);
        assert_eq!(found, Difference { pixels: 25, inner: 25, ..Difference::default() });
        assert!(found.is_parity());
    }

    #[test]
    fn each_difference_is_found_where_it_counts() {
        let frame = plain(9);
        let mut other = plain(9);
        other.picture.as_mut().unwrap()[3 * 40 + 1] = 112;
        let found = Difference::of(&frame, &other);
        assert_eq!(found.color_most, 12);
        assert!((found.color_mean - 12.0 / 243.0).abs() < 1e-12);
        assert!(!found.is_parity());

        let mut other = plain(9);
        other.depth_m.as_mut().unwrap()[40] = 2.001;
        let found = Difference::of(&frame, &other);
        assert!((found.depth - 5e-4).abs() < 1e-6 && !found.is_parity());

        // A pixel of another object is counted, and so are no colours beside it.
        let mut other = plain(9);
        other.object_ids.as_mut().unwrap()[40] = 2;
        other.picture.as_mut().unwrap()[3 * 31] = 255;
        let found = Difference::of(&frame, &other);
        assert_eq!((found.ids, found.inner, found.color_most), (1, 72, 0));
        assert!(!found.is_parity());
    }

    #[test]
    fn sums_are_means_and_extremes() {
        let one = Difference { pixels: 100, color_mean: 0.5, color_most: 3, ..Default::default() };
        let two = Difference { pixels: 300, color_mean: 0.1, depth: 1e-6, ..Default::default() };
        let mut all = one;
        all.add(&two);
        assert!((all.color_mean - 0.2).abs() < 1e-12);
        assert_eq!((all.pixels, all.color_most, all.depth), (400, 3, 1e-6));
    }
}
