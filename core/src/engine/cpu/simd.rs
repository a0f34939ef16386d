//! Eight lanes, and the choice of instruction set at run time.
//!
//! Kernels are written once over [`F32x8`] and [`I32x8`], with the instruction set as a constant
//! parameter; the [`kernel`] macro compiles each of them twice. Without AVX2 the lanes are plain
//! arrays that the compiler vectorises as the target allows; with it, each operation is one
//! instruction, as the compiler cannot be relied on to find eight lanes again in a long kernel.
//! Only exactly rounded operations are used (no fused multiply-add, no approximate reciprocal), so
//! both give the same bits. Nothing of rendering belongs here.
//!
//! What a kernel calls must be `#[inline(always)]`: a function, or a closure, that stands alone is
//! compiled for the baseline and takes its vectors through memory.

#![allow(clippy::missing_transmute_annotations, reason = "lanes and registers, as declared")]

/// Number of lanes.
pub(in crate::engine::cpu) const LANES: usize = 8;

/// Which compiled form of the kernels runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::engine::cpu) struct Level {
    /// Set by detection only: running the AVX2 form on other processors is undefined.
    avx2: bool,
}

impl Level {
    /// What every processor of the target has.
    pub(in crate::engine::cpu) const BASELINE: Self = Self { avx2: false };

    /// The best form that this processor runs.
    pub(in crate::engine::cpu) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        return Self { avx2: std::arch::is_x86_feature_detected!("avx2") };
        #[cfg(not(target_arch = "x86_64"))]
        Self::BASELINE
    }

    #[cfg(target_arch = "x86_64")]
    pub(in crate::engine::cpu) const fn has_avx2(self) -> bool {
        self.avx2
    }

    pub(in crate::engine::cpu) const fn name(self) -> &'static str {
        if self.avx2 { "avx2" } else { "baseline" }
    }
}

/// Defines a function that runs an `#[inline(always)]` body in the form that a [`Level`] names;
/// the body's first constant parameter says which.
macro_rules! kernel {
    ($(#[$meta:meta])* fn $name:ident $([$(const $c:ident: $ct:ty),+])?
     ($($arg:ident: $ty:ty),* $(,)?) $(-> $ret:ty)? = $body:ident) => {
        $(#[$meta])*
        pub(in crate::engine::cpu) fn $name $(<$(const $c: $ct),+>)? (
            level: $crate::engine::cpu::simd::Level, $($arg: $ty),*
        ) $(-> $ret)? {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn avx2 $(<$(const $c: $ct),+>)? ($($arg: $ty),*) $(-> $ret)? {
                    $body::<true $($(, $c)+)?>($($arg),*)
                }
                if level.has_avx2() {
                    #[expect(unsafe_code, reason = "a function for a detected instruction set")]
                    // SAFETY: a level has AVX2 only after the processor was asked for it.
                    return unsafe { avx2 $(::<$($c),+>)? ($($arg),*) };
                }
            }
            #[cfg(not(target_arch = "x86_64"))]
            let _ = level;
            $body::<false $($(, $c)+)?>($($arg),*)
        }
    };
}
pub(in crate::engine::cpu) use kernel;

/// An array whose entry `$i` is `$e`, written as a loop that the compiler vectorises.
macro_rules! lanes {
    ($zero:expr, $i:ident => $e:expr) => {{
        let mut out = [$zero; LANES];
        let mut $i = 0;
        while $i < LANES {
            out[$i] = $e;
            $i += 1;
        }
        out
    }};
}

/// The AVX2 form of an operation, or its lane by lane form.
macro_rules! either {
    (avx2: $vector:expr, lanes: $lanes:expr $(,)?) => {{
        #[cfg(target_arch = "x86_64")]
        {
            if AVX2 {
                #[expect(unsafe_code, reason = "vector instructions of a detected processor")]
                // SAFETY: lanes with AVX2 set are computed with only in the AVX2 form of kernels,
                // which run only where it was detected; the types on both sides are 32 bytes of
                // numbers for which every bit pattern is valid.
                return unsafe { $vector };
            }
        }
        $lanes
    }};
}

macro_rules! binary {
    ($t:ident, $trait:ident, $f:ident, $zero:expr, $instruction:ident, $a:ident, $b:ident => $e:expr) => {
        impl<const AVX2: bool> $trait for $t<AVX2> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, other: Self) -> Self {
                either! {
                    avx2: cast(arch::$instruction(cast(self.0), cast(other.0))),
                    lanes: Self(lanes!($zero, i => { let ($a, $b) = (self.0[i], other.0[i]); $e })),
                }
            }
        }
    };
}

// After the macros that they use.
mod float;
mod int;
mod mask;
mod power;
mod shuffle;
mod vec3;

pub(in crate::engine::cpu) use float::F32x8;
pub(in crate::engine::cpu) use int::I32x8;
pub(in crate::engine::cpu) use mask::Mask8;
pub(in crate::engine::cpu) use shuffle::{transposed, unzipped};
pub(in crate::engine::cpu) use vec3::Vec3x8;

#[cfg(test)]
mod tests;
