//! Where a vertex is on the template, as the edges of garments ask for it.

use glam::Vec3;

use super::data::{FigureData, LIMB_UNIT};

/// Place of a vertex on the template.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Metres.
    pub p: Vec3,
    /// Along the arm, 0 at the shoulder to 1 at the wrist; negative elsewhere.
    pub arm: f32,
    /// Along the leg, 0 at the hip to 1 at the ankle; negative elsewhere.
    pub leg: f32,
}

impl Place {
    /// The place of a vertex by its number among all of them.
    pub(super) fn of(data: &FigureData, vertex: usize) -> Self {
        let n = data.vertex_count();
        let [x, y, z] = [0, 1, 2].map(|axis| data.positions[axis * n + vertex]);
        Self {
            p: Vec3::new(x, y, z),
            arm: f32::from(data.arm[vertex]) * LIMB_UNIT,
            leg: f32::from(data.leg[vertex]) * LIMB_UNIT,
        }
    }

    /// Half way between two places.
    #[must_use]
    pub fn between(a: Self, b: Self) -> Self {
        Self { p: (a.p + b.p) * 0.5, arm: (a.arm + b.arm) * 0.5, leg: (a.leg + b.leg) * 0.5 }
    }
}
