//! Colour transfer and hue, in scalar form. The engines hold the same formulas in their own shape.

use glam::{DMat3, DVec3};

/// XYZ of linear Rec. 709 (IEC 61966-2-1), by columns.
pub const XYZ_FROM_LINEAR: DMat3 = DMat3::from_cols_array(&[
    0.412_390_8,
    0.212_639_0,
    0.019_330_8,
    0.357_584_3,
    0.715_168_7,
    0.119_194_8,
    0.180_480_8,
    0.072_192_3,
    0.950_532_2,
]);

/// Linear Rec. 709 of CIE XYZ, white at D65.
#[must_use]
pub fn linear_from_xyz(xyz: DVec3) -> DVec3 {
    XYZ_FROM_LINEAR.inverse() * xyz
}

/// sRGB 0..1 to linear 0..1 (IEC 61966-2-1).
#[must_use]
pub fn linear_from_srgb(v: f32) -> f32 {
    if v <= 0.040_45 { v / 12.92 } else { libm::powf((v + 0.055) / 1.055, 2.4) }
}

/// Linear 0..1 to sRGB 0..1 (IEC 61966-2-1).
#[must_use]
pub fn srgb_from_linear(v: f32) -> f32 {
    if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * libm::powf(v, 1.0 / 2.4) - 0.055 }
}

/// Linear RGB from an sRGB triple.
#[must_use]
pub fn linear_rgb(srgb: [f32; 3]) -> [f32; 3] {
    srgb.map(linear_from_srgb)
}
