//! Colour transfer and hue, in scalar form. The engines hold the same formulas in their own shape.

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
