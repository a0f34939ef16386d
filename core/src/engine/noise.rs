//! Grain and the sensor's noise: numbers of a pixel, of which both engines must make the same.

/// Standard deviation of the sum of four bytes that take all values alike.
pub(super) const GRAIN_STD: f32 = 147.800_31;

/// A well mixed number: PCG (Jarzynski and Olano, "Hash functions for GPU rendering", Journal of
/// Computer Graphics Techniques 9, 2020).
#[inline(always)]
pub(super) const fn mixed(v: u32) -> u32 {
    let state = v.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// Set apart the sensor's noise from the grain.
const SENSOR: u32 = 0x5e45_0a7d;

/// The key of the sensor's noise, mixed.
pub(super) const fn sensor_key(grain_key: u32) -> u32 {
    mixed(grain_key ^ SENSOR)
}

/// Noise of a pixel's three channels, mean 0 and standard deviation 1: nearly normal, being sums of
/// four bytes of a hash.
#[inline(always)]
pub(super) fn sensor_noise(key: u32, [x, y]: [u32; 2]) -> [f32; 3] {
    let pixel = mixed(x.wrapping_add(mixed(y.wrapping_add(key))));
    [1, 2, 3].map(|channel| {
        let [a, b, c, d] = mixed(pixel ^ channel).to_le_bytes();
        let sum = i32::from(a) + i32::from(b) + i32::from(c) + i32::from(d) - 510;
        sum as f32 * (1.0 / GRAIN_STD)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_are_of_unit_spread_and_of_their_own() {
        let key = sensor_key(77);
        let all: Vec<[f64; 3]> =
            (0..250_000).map(|i| sensor_noise(key, [i % 500, i / 500]).map(f64::from)).collect();
        let mean = |f: &dyn Fn(&[f64; 3]) -> f64| all.iter().map(f).sum::<f64>() / all.len() as f64;
        for c in 0..3 {
            assert!(mean(&|v| v[c]).abs() < 0.01);
            assert!((mean(&|v| v[c] * v[c]) - 1.0).abs() < 0.01);
            assert!(mean(&|v| v[c] * v[(c + 1) % 3]).abs() < 0.01);
        }
        let beside = all.windows(2).map(|w| w[0][0] * w[1][0]).sum::<f64>() / all.len() as f64;
        assert!(beside.abs() < 0.01, "{beside}");
    }
}
