//! The scalp of one person: a grid of roots, and the head's own coordinates.
//!
//! The figure's group of hair roots is a grid by azimuth and way down from the crown. Here it is
//! put back in order, evaluated for a person, and can be asked for any place between its points.
//! *Local* coordinates are those of the template (metres, +Z forward, the hairline's middle at
//! about y = 0.796), so that styles are written down once for heads of all sizes.

use glam::Vec3;

use crate::geometry::body::RestBody;
use crate::geometry::phenotype;
use crate::library::figure::{Figure, GroupId};

/// Columns round the head: 0 the front, then towards the person's left.
pub(in crate::geometry) const COLUMNS: usize = 64;
/// Rows below the crown's one point.
pub(in crate::geometry) const ROWS: usize = 15;

/// Person to template and back: the same axes, another size.
#[derive(Clone, Copy, Debug)]
pub(in crate::geometry) struct Frame {
    person: Vec3,
    template: Vec3,
    /// Size of the head against the template's.
    pub scale: f32,
}

impl Frame {
    /// Template coordinates of a point near the head.
    pub fn local(&self, p: Vec3) -> Vec3 {
        (p - self.person) / self.scale + self.template
    }

    /// The point of a person's head that has these template coordinates.
    pub fn world(&self, local: Vec3) -> Vec3 {
        (local - self.template) * self.scale + self.person
    }
}

/// A place on the scalp.
#[derive(Clone, Copy, Debug)]
pub(in crate::geometry) struct Root {
    /// Model space, metres.
    pub p: Vec3,
    /// Unit, off the head.
    pub n: Vec3,
    /// On the template.
    pub local: Vec3,
    /// Distance to the hairline on the template, metres.
    pub depth: f32,
    /// 0 .. [`COLUMNS`].
    pub column: f32,
}

/// All roots of one person.
pub(in crate::geometry) struct Scalp {
    pub frame: Frame,
    roots: Vec<Root>,
}

impl Scalp {
    pub fn new(figure: &Figure, rest: &RestBody) -> Self {
        let group = figure.group(GroupId::HairCap);
        let range = figure.vertices(GroupId::HairCap, group.count);
        let at: Vec<Vec3> = phenotype::evaluate(figure, &rest.shape, range.clone())
            .into_iter()
            .map(Vec3::from_array)
            .collect();
        let template = figure.template();
        let local: Vec<Vec3> =
            range.map(|v| Vec3::new(template.x[v], template.y[v], template.z[v])).collect();
        let mean = |all: &[Vec3]| all.iter().sum::<Vec3>() / all.len() as f32;
        let frame = Frame {
            person: mean(&at),
            template: mean(&local),
            scale: rest.head_scale as f32 * rest.shape.scale,
        };
        let order = grid(figure);
        let p = |row: usize, column: usize| at[order[row * COLUMNS + column % COLUMNS]];
        let mut roots = Vec::with_capacity(order.len());
        for row in 0..=ROWS {
            for column in 0..COLUMNS {
                let v = order[row * COLUMNS + column];
                let n = if row == 0 {
                    Vec3::Y
                } else {
                    let down = p((row + 1).min(ROWS), column) - p(row - 1, column);
                    let round = p(row, column + 1) - p(row, column + COLUMNS - 1);
                    down.cross(round).normalize_or(Vec3::Y)
                };
                roots.push(Root {
                    p: at[v],
                    n,
                    local: local[v],
                    depth: figure.data().hair_depth[v],
                    column: column as f32,
                });
            }
        }
        Self { frame, roots }
    }

    /// The root of a grid point; columns go round.
    pub fn root(&self, row: usize, column: usize) -> &Root {
        &self.roots[row.min(ROWS) * COLUMNS + column % COLUMNS]
    }

    /// Between the grid's points.
    pub fn at(&self, row: f32, column: f32) -> Root {
        let row = row.clamp(0.0, ROWS as f32 - 1e-3);
        let column = column.rem_euclid(COLUMNS as f32);
        let (r, c) = (row as usize, column as usize);
        let (t, s) = (row - r as f32, column - c as f32);
        let [a, b] = [self.root(r, c), self.root(r, c + 1)];
        let [d, e] = [self.root(r + 1, c), self.root(r + 1, c + 1)];
        let v = |f: fn(&Root) -> Vec3| f(a).lerp(f(b), s).lerp(f(d).lerp(f(e), s), t);
        let upper = a.depth + (b.depth - a.depth) * s;
        let lower = d.depth + (e.depth - d.depth) * s;
        Root {
            p: v(|r| r.p),
            n: v(|r| r.n).normalize_or(Vec3::Y),
            local: v(|r| r.local),
            depth: upper + (lower - upper) * t,
            column,
        }
    }

    /// Sums of the cells' areas on the template, each times a density: where roots are drawn.
    pub fn areas(&self, density: impl Fn(&Root) -> f32) -> Vec<f32> {
        let mut sum = 0.0;
        let mut out = Vec::with_capacity(ROWS * COLUMNS);
        for cell in 0..ROWS * COLUMNS {
            // Serpentine, so that neighbours in the list are neighbours on the head.
            let (row, column) = cell_place(cell);
            let [a, b] = [self.root(row, column), self.root(row, column + 1)];
            let [c, d] = [self.root(row + 1, column), self.root(row + 1, column + 1)];
            let area = 0.5 * (d.local - a.local).cross(c.local - b.local).length();
            sum += area * density(&self.at(row as f32 + 0.5, column as f32 + 0.5)).max(0.0);
            out.push(sum);
        }
        out
    }

    /// The root at a share of those sums, and somewhere within its cell.
    pub fn drawn(&self, areas: &[f32], share: f32, [x, y]: [f32; 2]) -> Root {
        let wanted = share * areas.last().copied().unwrap_or(0.0);
        let cell = areas.partition_point(|&a| a < wanted).min(areas.len() - 1);
        let (row, column) = cell_place(cell);
        self.at(row as f32 + y, column as f32 + x)
    }
}

const fn cell_place(cell: usize) -> (usize, usize) {
    let (row, i) = (cell / COLUMNS, cell % COLUMNS);
    (row, if row % 2 == 0 { i } else { COLUMNS - 1 - i })
}

/// Vertices of the group by row and column; the crown fills row 0.
fn grid(figure: &Figure) -> Vec<usize> {
    let group = figure.group(GroupId::HairCap);
    let mut columns: Vec<Vec<(f32, usize)>> = vec![Vec::new(); COLUMNS];
    let mut crown = 0;
    for (r, &v) in group.render.iter().enumerate() {
        let (u, along) = (group.uvs[2 * r], group.uvs[2 * r + 1]);
        // u runs four times round the head, v down from the crown.
        let column = (u * (COLUMNS / 4) as f32 + 0.5) as usize;
        if along <= 0.0 {
            crown = usize::from(v);
        } else if column < COLUMNS {
            columns[column].push((along, usize::from(v)));
        }
    }
    let mut out = vec![crown; (ROWS + 1) * COLUMNS];
    for (i, column) in columns.iter_mut().enumerate() {
        column.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (row, &(_, v)) in column.iter().take(ROWS).enumerate() {
            out[(row + 1) * COLUMNS + i] = v;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::body::rest_body;
    use crate::geometry::phenotype::tests::average;
    use crate::scene::Sex;

    #[test]
    fn the_grid_is_the_figures_and_in_order() {
        let figure = Figure::built_in().unwrap();
        let order = grid(&figure);
        let mut seen: Vec<usize> = order[COLUMNS - 1..].to_vec();
        seen.sort_unstable();
        let all: Vec<usize> = (0..figure.group(GroupId::HairCap).count as usize).collect();
        assert_eq!(seen, all);
        let rest = rest_body(&figure, &average(Sex::Female), &[]).unwrap();
        let scalp = Scalp::new(&figure, &rest);
        assert!(scalp.root(ROWS, 0).local.z > 0.12 && scalp.root(ROWS, 32).local.z < 0.0);
        assert!(scalp.root(8, 16).local.x > 0.06 && scalp.root(8, 48).local.x < -0.06);
        for column in 0..COLUMNS {
            assert!(scalp.root(ROWS, column).depth < 1e-4);
            for row in 1..=ROWS {
                let (above, here) = (scalp.root(row - 1, column), scalp.root(row, column));
                // The crown's point is not quite the highest.
                assert!(here.local.y < above.local.y + 2e-3, "{row} {column}");
                let out = here.local - Vec3::new(0.0, 0.745, 0.045);
                assert!(here.n.dot(out) > 0.0, "{row} {column}");
                let back = scalp.frame.world(scalp.frame.local(here.p));
                assert!((back - here.p).length() < 1e-5);
            }
        }
    }
}
