//! A lens over a picture: whether it can be drawn, how far the pinhole's plane reaches, and the way
//! back at the nodes of a grid, from which that of any point is close.

use glam::DVec2;

use super::{Lens, LensError, MAX_ANGLE, Polynomial};

/// Largest distance between nodes, pixels.
const SPACING_PX: u32 = 8;
/// Intervals that the longer side has at least, down to a pixel each.
const INTERVALS: u32 = 64;

/// The way back from the picture of a lens, on a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct LensGrid {
    lens: Lens,
    focal_px: DVec2,
    center_px: DVec2,
    size_px: [u32; 2],
    /// log2 of the distance between nodes, but for the last of a row or column, which stands on the
    /// border.
    spacing_log2: u32,
    /// Nodes in a row.
    columns: usize,
    /// The polynomial's v, row by row.
    nodes: Vec<DVec2>,
    low: DVec2,
    high: DVec2,
    magnification: f64,
}

impl LensGrid {
    /// A picture of so many pixels through a lens with `K = [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]`.
    ///
    /// # Errors
    /// When the picture folds over, or a fisheye sees more than 80 degrees off the axis.
    pub fn new(
        lens: Lens,
        focal_px: DVec2,
        center_px: DVec2,
        size_px: [u32; 2],
    ) -> Result<Self, LensError> {
        let longer = size_px[0].max(size_px[1]);
        let spacing_log2 = (longer / INTERVALS).clamp(1, SPACING_PX).ilog2();
        let mut grid = Self {
            lens,
            focal_px,
            center_px,
            size_px,
            spacing_log2,
            columns: size_px[0].div_ceil(1 << spacing_log2) as usize + 1,
            nodes: Vec::new(),
            low: DVec2::INFINITY,
            high: DVec2::NEG_INFINITY,
            magnification: 0.0,
        };
        grid.solve_nodes()?;
        grid.measure()?;
        Ok(grid)
    }

    /// The lens.
    #[must_use]
    pub const fn lens(&self) -> &Lens {
        &self.lens
    }

    /// Width and height of the picture, pixels.
    #[must_use]
    pub const fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// Least and largest position, normalised, at which a pinhole would show what the picture does.
    #[must_use]
    pub const fn extent(&self) -> [DVec2; 2] {
        [self.low, self.high]
    }

    /// Largest factor by which the lens enlarges what a pinhole would show; at least 1.
    #[must_use]
    pub const fn magnification(&self) -> f64 {
        self.magnification
    }

    /// Where between which nodes a pixel lies: the first node's place and the shares of the way to
    /// the next ones to the right and down.
    #[must_use]
    #[inline]
    fn between(&self, x: f64, y: f64) -> (usize, DVec2) {
        let cell = |v: f64, size: u32| {
            let first = (v as u32).min(size - 1) >> self.spacing_log2;
            let start = first << self.spacing_log2;
            let width = (size - start).min(1 << self.spacing_log2);
            (first as usize, (v - f64::from(start)) / f64::from(width))
        };
        let ((column, tx), (row, ty)) = (cell(x, self.size_px[0]), cell(y, self.size_px[1]));
        (row * self.columns + column, DVec2::new(tx, ty))
    }

    /// The polynomial's v at a pixel, but for what the grid's bilinear interpolation leaves out: a
    /// start for Newton's method.
    #[must_use]
    #[inline]
    pub fn near(&self, x: f64, y: f64) -> DVec2 {
        let (first, t) = self.between(x, y);
        let row = |at: usize| self.nodes[at] + (self.nodes[at + 1] - self.nodes[at]) * t.x;
        let (above, below) = (row(first), row(first + self.columns));
        above + (below - above) * t.y
    }

    fn node_px(&self, column: usize, row: usize) -> DVec2 {
        let at = |i: usize, size: u32| f64::from(((i as u32) << self.spacing_log2).min(size));
        DVec2::new(at(column, self.size_px[0]), at(row, self.size_px[1]))
    }

    fn normalised(&self, px: DVec2) -> DVec2 {
        (px - self.center_px) / self.focal_px
    }

    /// From the node nearest to the middle of the lens along its row, then row by row up and down,
    /// each node from its neighbour.
    fn solve_nodes(&mut self) -> Result<(), LensError> {
        let p = self.lens.polynomial();
        let (columns, rows) =
            (self.columns, self.size_px[1].div_ceil(1 << self.spacing_log2) as usize + 1);
        let mut nodes = vec![DVec2::ZERO; columns * rows];
        let nearest = |center: f64, count: usize| {
            let at = (center / f64::from(1 << self.spacing_log2)).round();
            (at.max(0.0) as usize).min(count - 1)
        };
        let (c0, r0) = (nearest(self.center_px.x, columns), nearest(self.center_px.y, rows));
        let middle = self.node_px(c0, r0);
        nodes[r0 * columns + c0] = drawable(&p, p.solve(self.normalised(middle)), middle)?;
        let mut walk = |at: [usize; 2], from: [usize; 2]| {
            let px = self.node_px(at[0], at[1]);
            let found = p.solve_from(self.normalised(px), nodes[from[1] * columns + from[0]]);
            nodes[at[1] * columns + at[0]] = drawable(&p, found, px)?;
            Ok(())
        };
        (0..c0).rev().try_for_each(|c| walk([c, r0], [c + 1, r0]))?;
        (c0 + 1..columns).try_for_each(|c| walk([c, r0], [c - 1, r0]))?;
        for r in (0..r0).rev() {
            (0..columns).try_for_each(|c| walk([c, r], [c, r + 1]))?;
        }
        for r in r0 + 1..rows {
            (0..columns).try_for_each(|c| walk([c, r], [c, r - 1]))?;
        }
        self.nodes = nodes;
        Ok(())
    }

    /// Extent, by a walk round the border, and magnification.
    fn measure(&mut self) -> Result<(), LensError> {
        let p = self.lens.polynomial();
        let [width, height] = self.size_px;
        let across = (0..=width).flat_map(|x| [(x, 0), (x, height)]);
        let down = (0..=height).flat_map(|y| [(0, y), (width, y)]);
        for (x, y) in across.chain(down) {
            let px = DVec2::new(x.into(), y.into());
            let found = p.solve_from(self.normalised(px), self.near(px.x, px.y));
            let u = p.to_undistorted(drawable(&p, found, px)?);
            (self.low, self.high) = (self.low.min(u), self.high.max(u));
        }
        self.magnification = self.nodes.iter().map(|v| p.magnification(*v)).fold(1.0, f64::max);
        Ok(())
    }
}

/// What was found for a pixel, if a picture may hold it.
fn drawable(p: &Polynomial, found: Option<DVec2>, px: DVec2) -> Result<DVec2, LensError> {
    let [x, y] = px.to_array();
    match found {
        Some(v) if p.may_be_drawn(v) => Ok(v),
        Some(v) if p.of_angle && v.length() > MAX_ANGLE => {
            Err(LensError::TooWide { angle_deg: v.length().to_degrees(), x, y })
        }
        _ => Err(LensError::Folds { x, y }),
    }
}
