//! Light from all around, looked up eight directions at a time.
//!
//! Reads a map of [`crate::library::environment`], which says how directions stand in it. The
//! formulas stand in `shaders/shared/environment.wgsl` as well.

use std::f32::consts::{FRAC_PI_2, PI};

use crate::draw::abi::Surroundings;
use crate::engine::cpu::simd::{F32x8, I32x8, LANES, Vec3x8};
use crate::library::environment::equirect::ATAN;
use crate::library::environment::map::LEVELS;

/// Light from all around, times the exposure.
pub(in crate::engine::cpu) struct EnvironmentLight<'a> {
    texels: &'a [u32],
    /// First texel and log2 of the width of each level.
    first: [i32; LEVELS],
    log2_width: [i32; LEVELS],
    /// Rows.
    map_from_view: [[f32; 3]; 3],
    /// Exposed light of a unit.
    unit: f32,
    irradiance: [[f32; 3]; 10],
}

impl<'a> EnvironmentLight<'a> {
    pub(super) fn new(surroundings: &'a Surroundings, exposure: f32) -> Self {
        let levels = &surroundings.map.levels;
        Self {
            texels: &surroundings.map.texels,
            first: levels.map(|level| level.first as i32),
            log2_width: levels.map(|level| level.log2_width as i32),
            map_from_view: surroundings.map_from_view,
            unit: surroundings.nits_per_unit * exposure,
            irradiance: surroundings.irradiance_lux.map(|term| term.map(|v| v * exposure)),
        }
    }

    /// Irradiance of surfaces with unit normals in view space.
    #[inline(always)]
    pub(super) fn irradiance<const AVX2: bool>(&self, n: Vec3x8<AVX2>) -> Vec3x8<AVX2> {
        let basis =
            [n.x, n.y, n.z, n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.y * n.z, n.z * n.x];
        let mut sum = Vec3x8::splat(self.irradiance[0]);
        for (basis, term) in basis.into_iter().zip(&self.irradiance[1..]) {
            sum = sum + Vec3x8::splat(*term).scale(basis);
        }
        // Three orders can undershoot where a sun is alone.
        let zero = F32x8::ZERO;
        Vec3x8::new(sum.x.max(zero), sum.y.max(zero), sum.z.max(zero))
    }

    /// Light from directions in view space of any length, as mirrors of a perceptual roughness see it.
    #[inline(always)]
    pub(super) fn mirrored<const AVX2: bool>(
        &self,
        direction: Vec3x8<AVX2>,
        roughness: F32x8<AVX2>,
    ) -> Vec3x8<AVX2> {
        let top = (LEVELS - 1) as f32;
        let level = (roughness * F32x8::splat(top)).clamp(0.0, top);
        let lower = level.floor();
        let share = level - lower;
        let lower = lower.round_i32();
        let upper = (lower + I32x8::splat(1)).min(I32x8::splat(top as i32));
        let uv = self.uv_of(direction);
        let sharper = self.bilinear(uv, lower);
        sharper.mix(self.bilinear(uv, upper), share).scale(F32x8::splat(self.unit))
    }

    /// Light from directions in view space of any length.
    #[inline(always)]
    pub(in crate::engine::cpu) fn seen<const AVX2: bool>(
        &self,
        direction: Vec3x8<AVX2>,
    ) -> Vec3x8<AVX2> {
        self.bilinear(self.uv_of(direction), I32x8::ZERO).scale(F32x8::splat(self.unit))
    }

    /// Where directions in view space stand in the map.
    #[inline(always)]
    fn uv_of<const AVX2: bool>(&self, direction: Vec3x8<AVX2>) -> [F32x8<AVX2>; 2] {
        let x = Vec3x8::splat(self.map_from_view[0]).dot(direction);
        let y = Vec3x8::splat(self.map_from_view[1]).dot(direction);
        let z = Vec3x8::splat(self.map_from_view[2]).dot(direction);
        let level = (x * x + z * z).sqrt();
        let s = F32x8::splat;
        [s(0.5) + atan2(x, -z) * s(0.5 / PI), atan2(level, y) * s(1.0 / PI)]
    }

    /// Texels of levels at places 0..1, mixed.
    #[inline(always)]
    fn bilinear<const AVX2: bool>(&self, uv: [F32x8<AVX2>; 2], level: I32x8<AVX2>) -> Vec3x8<AVX2> {
        let (mut first, mut log2_width) = ([0; LANES], [0; LANES]);
        for lane in 0..LANES {
            let level = level.0[lane] as usize % LEVELS;
            (first[lane], log2_width[lane]) = (self.first[level], self.log2_width[level]);
        }
        let (first, log2_width) = (I32x8(first), I32x8(log2_width));
        let one = I32x8::splat(1);
        let last_column = one.shl_each(log2_width) - one;
        let last_row = one.shl_each(log2_width - one) - one;
        let half = F32x8::splat(0.5);
        let x = uv[0] * (last_column + one).to_f32() - half;
        let y = uv[1] * (last_row + one).to_f32() - half;
        let y = y.max(F32x8::ZERO).min(last_row.to_f32());
        let (left, top) = (x.floor(), y.floor());
        let (right_share, lower_share) = (x - left, y - top);
        let (left, top) = (left.round_i32(), top.round_i32());
        let (left, right) = (left & last_column, (left + one) & last_column);
        let upper = first + top.shl_each(log2_width);
        let lower = first + (top + one).min(last_row).shl_each(log2_width);
        let above = self.light(upper + left).mix(self.light(upper + right), right_share);
        let below = self.light(lower + left).mix(self.light(lower + right), right_share);
        above.mix(below, lower_share)
    }

    /// The light of texels, in units.
    #[inline(always)]
    fn light<const AVX2: bool>(&self, at: I32x8<AVX2>) -> Vec3x8<AVX2> {
        let texel = at.gather_u32(self.texels);
        let mask = I32x8::splat(511);
        let exponent = (texel >> 27) & I32x8::splat(31);
        let unit = ((exponent + I32x8::splat(127 - 24)) << 23).as_f32();
        Vec3x8::new(
            (texel & mask).to_f32() * unit,
            ((texel >> 9) & mask).to_f32() * unit,
            ((texel >> 18) & mask).to_f32() * unit,
        )
    }
}

/// Angle of the vectors (x, y), -pi..pi; see [`crate::library::environment::equirect`].
#[inline(always)]
fn atan2<const AVX2: bool>(y: F32x8<AVX2>, x: F32x8<AVX2>) -> F32x8<AVX2> {
    let (ax, ay) = (x.max(-x), y.max(-y));
    let t = ax.min(ay) / ax.max(ay).max(F32x8::splat(f32::MIN_POSITIVE));
    let t2 = t * t;
    let mut sum = F32x8::ZERO;
    for c in ATAN.iter().rev() {
        sum = sum * t2 + F32x8::splat(*c);
    }
    let angle = sum * t;
    let angle = ay.gt(ax).select(F32x8::splat(FRAC_PI_2) - angle, angle);
    let angle = F32x8::ZERO.gt(x).select(F32x8::splat(PI) - angle, angle);
    F32x8::ZERO.gt(y).select(-angle, angle)
}
