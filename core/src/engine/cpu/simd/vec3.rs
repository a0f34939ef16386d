//! Eight vectors.

use std::ops::{Add, Div, Mul, Sub};

use super::F32x8;

/// Eight vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::engine::cpu) struct Vec3x8<const AVX2: bool> {
    pub(in crate::engine::cpu) x: F32x8<AVX2>,
    pub(in crate::engine::cpu) y: F32x8<AVX2>,
    pub(in crate::engine::cpu) z: F32x8<AVX2>,
}

impl<const AVX2: bool> Vec3x8<AVX2> {
    pub(in crate::engine::cpu) const ZERO: Self =
        Self { x: F32x8::ZERO, y: F32x8::ZERO, z: F32x8::ZERO };

    #[inline(always)]
    pub(in crate::engine::cpu) const fn new(
        x: F32x8<AVX2>,
        y: F32x8<AVX2>,
        z: F32x8<AVX2>,
    ) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) const fn splat(v: [f32; 3]) -> Self {
        Self { x: F32x8::splat(v[0]), y: F32x8::splat(v[1]), z: F32x8::splat(v[2]) }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn dot(self, o: Self) -> F32x8<AVX2> {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn cross(self, o: Self) -> Self {
        Self {
            x: self.y * o.z - self.z * o.y,
            y: self.z * o.x - self.x * o.z,
            z: self.x * o.y - self.y * o.x,
        }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn scale(self, s: F32x8<AVX2>) -> Self {
        Self { x: self.x * s, y: self.y * s, z: self.z * s }
    }

    /// Unit length; a zero vector stays zero.
    #[inline(always)]
    pub(in crate::engine::cpu) fn normalized(self) -> Self {
        let length = self.dot(self).max(F32x8::splat(1e-30)).sqrt();
        self.scale(F32x8::ONE / length)
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn mix(self, o: Self, t: F32x8<AVX2>) -> Self {
        self + (o - self).scale(t)
    }
}

impl<const AVX2: bool> Add for Vec3x8<AVX2> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl<const AVX2: bool> Sub for Vec3x8<AVX2> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl<const AVX2: bool> Div for Vec3x8<AVX2> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        Self { x: self.x / o.x, y: self.y / o.y, z: self.z / o.z }
    }
}

impl<const AVX2: bool> Mul for Vec3x8<AVX2> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self { x: self.x * o.x, y: self.y * o.y, z: self.z * o.z }
    }
}
