//! The cap on the scalp under the locks, and the seam of strands over its border.

use glam::Vec3;

use super::scalp::{COLUMNS, ROWS, Root};
use super::strand::UV_PER_M;
use super::{Grower, SUNK_M, add_grid, lump, style};
use crate::geometry::garment::step;
use crate::library::mesh::{Mesh, Triangle};
use crate::scene::HairStyle;

impl Grower<'_> {
    /// Distance of the cap from the skin at a root, metres.
    pub(super) fn cap_m(&self, root: &Root) -> f32 {
        let cap = &self.form.cap;
        let left = 1.0 - (root.depth / cap.taper_m).min(1.0);
        let top = cap.side + (1.0 - cap.side) * root.n.y.max(0.0);
        let (amount, size) = cap.lump;
        let lump = lump(root.local / size, self.head.seed);
        let mut thick = cap.thick_m * (1.0 - left * left) * top * (1.0 + amount * lump);
        if let (true, Some(locks)) = (self.alone(), &self.form.locks) {
            thick += 0.5 * (locks.clear_m.0 + locks.layer_m) * (1.0 - left * left);
        }
        if matches!(self.style, HairStyle::SideParting | HairStyle::Braids | HairStyle::Bob) {
            // A furrow along the parting.
            let off = (root.local.x - self.part_x()).abs();
            let on_top = step(0.80, 0.82, root.local.y) * step(-0.02, 0.02, root.local.z);
            thick *= 1.0 - 0.55 * on_top * (1.0 - step(0.0, 0.009, off));
        }
        if self.style == HairStyle::Balding {
            let here = style::wreath(root.local);
            thick = thick * here * here - 0.0030 * (1.0 - here);
        }
        if let Some(edge) = self.head.brim_y(root.local) {
            // Pressed flat under a hat, and bulging less just below it.
            let under = step(edge - 0.035, edge, root.local.y);
            thick = thick.min(0.004 + 0.030 * (1.0 - under) * (1.0 - under));
        }
        self.scale() * thick
    }

    /// The outer surface of the cap.
    pub(super) fn cap(&self, mesh: &mut Mesh) {
        let skip = [1, 1, 2, 2, 4][self.head.lod];
        let rows: Vec<usize> =
            (0..=ROWS).filter(|r| (ROWS - r).is_multiple_of(skip) || *r == 0).collect();
        let mut points = Vec::with_capacity(rows.len() * COLUMNS);
        let mut uvs = Vec::with_capacity(points.capacity());
        let wander: Vec<f32> = (0..=COLUMNS).step_by(skip).map(|c| self.wander(c)).collect();
        for &row in &rows {
            for (column, wander) in (0..=COLUMNS).step_by(skip).zip(&wander) {
                let root = self.ragged(row, column, *wander);
                points.push(root.p + root.n * (self.cap_m(&root) - SUNK_M * self.scale()));
                let along = (root.local.y - 0.85).abs() * UV_PER_M[1] * 1.3;
                uvs.push([column as f32 * 4.0 / COLUMNS as f32, along]);
            }
        }
        let first = mesh.positions.len();
        let start = mesh.triangles.len();
        add_grid(mesh, &points, &uvs, COLUMNS / skip + 1, true, &|_| self.head.on_head());
        if self.style == HairStyle::Balding {
            // The bald crown lies under the skin.
            let local = |v: u32| self.head.scalp.frame.local(points[v as usize - first]);
            let tail = mesh.triangles.split_off(start);
            let grows = |t: &Triangle| t.get().iter().any(|&v| style::wreath(local(v)) > 0.0);
            mesh.triangles.extend(tail.into_iter().filter(grows));
        }
    }

    /// How far a column's end is moved inwards, 0..1.
    fn wander(&self, column: usize) -> f32 {
        0.5 + 0.5 * lump(self.head.scalp.root(ROWS, column).local / 0.011, self.head.seed)
    }

    /// A root of the grid; near the hairline it is moved inwards, more here and less there.
    fn ragged(&self, row: usize, column: usize, wander: f32) -> Root {
        let near = (row as f32 / ROWS as f32).powi(4);
        self.head.scalp.at(row as f32 - self.form.cap.ragged * 1.6 * wander * near, column as f32)
    }

    /// A seam over the cap's border out of which strands are cut: hair begins here and there, not
    /// along a line. Its strands end around the border whatever the length of the locks'.
    pub(super) fn hairline(&self, mesh: &mut Mesh, frayed_m: f32) {
        const ROWS_OF_SEAM: [f32; 3] = [12.4, 13.7, 15.0];
        const BEYOND_M: f32 = 0.0045;
        const FRAYED_M: f32 = 0.012;
        let s = self.scale();
        let (mut points, mut uvs, mut bare) = (Vec::<Vec3>::new(), Vec::new(), Vec::new());
        let mut u = 0.0;
        for column in 0..=COLUMNS {
            let roots = ROWS_OF_SEAM.map(|row| self.head.scalp.at(row, column as f32));
            let mut line = roots.map(|r| r.p + r.n * (self.cap_m(&r) + 0.0008 * s)).to_vec();
            let border = &roots[2];
            let ahead = (border.p - roots[1].p).normalize_or(Vec3::NEG_Y);
            let mut end = border.p + ahead * (BEYOND_M * s);
            if let Some((d, n)) = self.head.near.surface(end) {
                end += n * (0.0008 * s - d);
            }
            line.push(end);
            if let Some(before) = points.len().checked_sub(2) {
                u += (line[2] - points[before]).length() * UV_PER_M[0];
            }
            let mut left_m = 0.0;
            let mut v = [0.0; 4];
            for i in (0..3).rev() {
                left_m += (line[i + 1] - line[i]).length();
                v[i] = left_m / (FRAYED_M * s) * frayed_m * UV_PER_M[1];
            }
            points.extend(line);
            uvs.extend(v.map(|v| [u, v]));
            bare.push(self.density(border) <= 0.0);
        }
        let start = mesh.triangles.len();
        let first = mesh.positions.len() as u32;
        add_grid(mesh, &points, &uvs, ROWS_OF_SEAM.len() + 1, false, &|_| self.head.on_head());
        let column = |v: u32| (v - first) as usize / (ROWS_OF_SEAM.len() + 1);
        let added = mesh.triangles.split_off(start);
        mesh.triangles
            .extend(added.into_iter().filter(|t| !t.get().iter().any(|&v| bare[column(v)])));
    }
}
