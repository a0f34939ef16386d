//! Behind a lens: the tables that the shaders read, by band of the picture.
//!
//! Made once for a lens, a size and a number of samples; brought to the device when the band or the
//! lens changes.

use rayon::prelude::*;

use crate::draw::DrawList;
use crate::draw::abi::View;
use crate::engine::lens::{EIGHT, LensPlane, SQUARE};
use crate::engine::pattern;
use crate::engine::squares::Squares;

/// Pairs of words in front of the cells; see `shaders/shared/lens_tiles.wgsl`.
const HEADER: usize = 16;
/// Bytes of a ray.
pub const RAY_BYTES: u64 = 24;

/// A picture behind a lens.
pub struct Lens {
    plane: LensPlane,
    samples: u32,
    /// Header and cells.
    pub squares: Vec<[u32; 2]>,
    /// The band that was made last: first row and rows.
    band: [u32; 2],
    /// Where its samples lie, raster units of the plane.
    pub places: Vec<[i32; 2]>,
    /// Rays through its pixels.
    pub rays: Vec<[f32; 6]>,
}

impl Lens {
    /// Behind the lens of a draw list, a picture of bands of so many rows, a multiple of
    /// [`SQUARE`]; nothing where there is no lens.
    pub fn new(list: &DrawList, band_rows: u32) -> Option<Self> {
        let plane = LensPlane::new(list)?;
        let mut lens = Self {
            plane,
            samples: list.samples,
            squares: Vec::new(),
            band: [0; 2],
            places: Vec::new(),
            rays: Vec::new(),
        };
        let View { width, height, .. } = list.view;
        let mut rects = Vec::new();
        for first in (0..height).step_by(band_rows as usize) {
            rects.extend(lens.make_band(width, [first, band_rows.min(height - first)]));
        }
        let plane_px = [lens.plane.plane.width, lens.plane.plane.height];
        let squares = Squares::new(plane_px, width.div_ceil(SQUARE) as usize, &rects);
        lens.squares = vec![[0; 2]; HEADER];
        let levels = &squares.levels;
        for (k, entry) in lens.squares[..HEADER - 1].iter_mut().enumerate() {
            *entry = levels[k.min(levels.len() - 1)];
        }
        lens.squares[HEADER - 1] = plane_px;
        let halves = |low: u16, high: u16| u32::from(low) | u32::from(high) << 16;
        lens.squares
            .extend(squares.cells.iter().map(|&[x0, x1, y0, y1]| [halves(x0, x1), halves(y0, y1)]));
        Some(lens)
    }

    /// Whether it is that of another draw list as well.
    pub fn serves(&self, list: &DrawList) -> bool {
        self.samples == list.samples && self.plane.serves(list)
    }

    /// The pinhole's plane as a picture of its own.
    pub const fn plane(&self) -> &View {
        &self.plane.plane
    }

    /// Makes the tables of a band unless they are there; whether it did so.
    pub fn take_band(&mut self, width: u32, band: [u32; 2]) -> bool {
        let new = self.band != band;
        if new {
            self.make_band(width, band);
        }
        new
    }

    /// Makes the tables of a band; bounds of the samples of its squares.
    fn make_band(&mut self, width: u32, [first, rows]: [u32; 2]) -> Vec<[i32; 4]> {
        let samples = pattern::positions(self.samples);
        let pixels = (width * rows) as usize;
        self.band = [first, rows];
        self.places.resize(pixels * samples.len(), [0; 2]);
        self.rays.resize(pixels, [0.0; 6]);
        let strip = width as usize * SQUARE as usize;
        let plane = &self.plane;
        let places = self.places.par_chunks_mut(strip * samples.len());
        let strips = places.zip(self.rays.par_chunks_mut(strip)).enumerate();
        let bounded = strips.map(|(index, (places, rays))| {
            make_strip(plane, width, first + index as u32 * SQUARE, samples, places, rays)
        });
        bounded.flatten_iter().collect()
    }
}

/// Fills rows of pixels; bounds of the samples of each square.
fn make_strip(
    plane: &LensPlane,
    width: u32,
    first_row: u32,
    samples: &[[i32; 2]],
    places: &mut [[i32; 2]],
    rays: &mut [[f32; 6]],
) -> Vec<[i32; 4]> {
    let empty = [i32::MAX, i32::MAX, i32::MIN, i32::MIN];
    let mut bounds = vec![empty; width.div_ceil(SQUARE) as usize];
    let n = samples.len();
    let lines = places.chunks_mut(width as usize * n).zip(rays.chunks_mut(width as usize));
    for (row, (places, rays)) in (first_row..).zip(lines) {
        for column in (0..width).step_by(EIGHT) {
            let eight = std::array::from_fn(|i| column + i as u32);
            let pixels = plane.pixels(eight, [row; EIGHT]);
            let count = EIGHT.min((width - column) as usize);
            let bound = &mut bounds[(column / SQUARE) as usize];
            for (k, position) in samples.iter().enumerate() {
                let [x, y] = plane.samples(&pixels, *position);
                for i in 0..count {
                    places[(column as usize + i) * n + k] = [x[i], y[i]];
                    let [left, top, right, bottom] = *bound;
                    *bound = [left.min(x[i]), top.min(y[i]), right.max(x[i]), bottom.max(y[i])];
                }
            }
            let through = plane.rays(&pixels);
            for i in 0..count {
                let [a, b, c, d] = through.change.map(|v| v[i]);
                rays[column as usize + i] = [through.x[i], through.y[i], a, b, c, d];
            }
        }
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_of_pixels_is_what_eight_of_them_fill() {
        assert_eq!(SQUARE as usize, EIGHT);
        assert_eq!(SQUARE, crate::engine::gpu::abi::TILE);
    }
}
