//! Pictures as linear light, and how near two of them are.

/// Linear light 0..1 of a byte of sRGB (IEC 61966-2-1).
#[must_use]
pub fn linear(byte: u8) -> f64 {
    let v = f64::from(byte) / 255.0;
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// Linear light of the green channel of a picture of RGB bytes.
#[must_use]
pub fn green(picture: &[u8]) -> Vec<f64> {
    picture.as_chunks::<3>().0.iter().map(|p| linear(p[1])).collect()
}

/// Peak signal-to-noise ratio of two pictures of light 0..1, decibels.
#[must_use]
pub fn psnr(a: &[f64], b: &[f64]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    -10.0 * (squares / a.len() as f64).log10()
}
