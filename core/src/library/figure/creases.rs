//! Folds of worn cloth, as a field over the template: at elbows, knees, ankles and waist.
//!
//! Places are those of the garment shell. How high the folds of a garment are is decided where it
//! is made.

use super::GroupId;
use super::complexion::step;
use super::data::{FigureData, LIMB_UNIT};

/// Length of the template's arm, metres.
pub const ARM_M: f32 = 0.42;
/// Length of the template's leg, metres.
pub const LEG_M: f32 = 0.80;
const WAVE_M: f32 = 0.052;

/// Height of the folds at the shell's vertices, 0..1.
pub(super) fn creases(data: &FigureData) -> Vec<f32> {
    let group = &data.groups[GroupId::Shell as usize];
    let n = data.vertex_count();
    let first = group.first as usize;
    let at = |v: usize| {
        let p = [0, 1, 2].map(|axis| data.positions[axis * n + v]);
        fold(p, f32::from(data.arm[v]) * LIMB_UNIT, f32::from(data.leg[v]) * LIMB_UNIT)
    };
    (first..first + group.count as usize).map(at).collect()
}

/// Waves along the limb that run aslant round it.
fn fold([x, y, z]: [f32; 3], arm: f32, leg: f32) -> f32 {
    let bump = |x: f32, middle: f32, half: f32| step(half, 0.0, (x - middle).abs());
    let (along_m, share) = if arm > 0.05 {
        (arm * ARM_M, bump(arm, 0.5, 0.24).max(0.7 * bump(arm, 0.92, 0.1)))
    } else if leg > 0.1 {
        (leg * LEG_M, bump(leg, 0.52, 0.16).max(0.8 * bump(leg, 0.95, 0.1)))
    } else {
        (-y, (0.7 * bump(y, 0.12, 0.10)).max(0.6 * bump(leg, 0.03, 0.1)))
    };
    if share <= 0.0 {
        return 0.0;
    }
    let slant = 34.0 * z + 11.0 * libm::sinf(23.0 * x);
    let wave = libm::sinf(along_m * (std::f32::consts::TAU / WAVE_M) + 0.35 * slant);
    share * (0.5 + 0.5 * wave)
}
