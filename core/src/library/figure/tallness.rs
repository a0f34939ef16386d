//! How tall a body is follows from few vertices: their shapes, side by side.
//!
//! A figure flows in, tables flow out. Bodies of a wanted stature are found by trying, and the
//! whole figure's shapes are too long to be walked over at every trial.

use super::Figure;

/// Heights of the crown's and the feet's vertices.
#[derive(Debug)]
pub struct Tallness {
    /// On the template, metres; the crown's first.
    pub template_y: Vec<f32>,
    /// How many are the crown's.
    pub crown: usize,
    /// Deltas of every macro target along y, in [`super::data::DELTA_UNIT_M`].
    macro_dy: Vec<i16>,
    /// The same of every local target, of those vertices that it moves: which, and by how much.
    local_dy: Vec<Vec<(usize, i16)>>,
}

impl Tallness {
    pub(super) fn new(figure: &Figure) -> Self {
        let data = figure.data();
        let vertices: Vec<u16> = data.crown.iter().chain(&data.feet).copied().collect();
        let of = |y: &[i16]| -> Vec<i16> { vertices.iter().map(|&v| y[usize::from(v)]).collect() };
        let targets = data.macro_deltas.len() / (3 * data.vertex_count());
        let local = |target: usize| {
            let (moved, d) = figure.face_deltas(target);
            let dy = |(i, v): (usize, &u16)| Some((i, d.y[moved.binary_search(v).ok()?]));
            vertices.iter().enumerate().filter_map(dy).collect()
        };
        Self {
            template_y: vertices.iter().map(|&v| figure.template().y[usize::from(v)]).collect(),
            crown: data.crown.len(),
            macro_dy: (0..targets).flat_map(|t| of(figure.macro_target(t).y)).collect(),
            local_dy: (0..data.local_names.len()).map(local).collect(),
        }
    }

    /// A macro target's deltas.
    #[must_use]
    pub fn macro_dy(&self, target: usize) -> &[i16] {
        let n = self.template_y.len();
        &self.macro_dy[target * n..(target + 1) * n]
    }

    /// A local target's deltas, with the places in the list of those that it moves.
    #[must_use]
    pub fn local_dy(&self, target: usize) -> &[(usize, i16)] {
        &self.local_dy[target]
    }
}
