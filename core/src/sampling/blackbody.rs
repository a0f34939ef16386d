//! The colour of glowing bodies.

/// Linear sRGB of a blackbody at a temperature of 1,667..25,000 K, of luminance 1: it changes the
/// colour of a light and not how much of it there is. What lies outside sRGB (blue below 1,900 K) is
/// 0.
///
/// Chromaticity by the cubic fit of Kim et al., "Design of advanced color temperature control system
/// for HDTV applications", Journal of the Korean Physical Society 41 (2002), to linear sRGB by the
/// matrix of IEC 61966-2-1.
pub(super) fn tint(temperature_k: f64) -> [f64; 3] {
    let [x, y] = chromaticity(temperature_k);
    let (big_x, big_z) = (x / y, (1.0 - x - y) / y);
    let rgb = [
        3.2406 * big_x - 1.5372 - 0.4986 * big_z,
        -0.9689 * big_x + 1.8758 + 0.0415 * big_z,
        0.0557 * big_x - 0.2040 + 1.0570 * big_z,
    ]
    .map(|channel| channel.max(0.0));
    let luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    rgb.map(|channel| channel / luminance)
}

/// CIE 1931 x and y.
fn chromaticity(temperature_k: f64) -> [f64; 2] {
    let t = 1e3 / temperature_k;
    let x = if temperature_k < 4000.0 {
        cubic([-0.266_123_9, -0.234_358_9, 0.877_695_6, 0.179_910], t)
    } else {
        cubic([-3.025_846_9, 2.107_037_9, 0.222_634_7, 0.240_390], t)
    };
    let y = if temperature_k < 2222.0 {
        cubic([-1.106_381_4, -1.348_110_20, 2.185_558_32, -0.202_196_83], x)
    } else if temperature_k < 4000.0 {
        cubic([-0.954_947_6, -1.374_185_93, 2.091_370_15, -0.167_488_67], x)
    } else {
        cubic([3.081_758_0, -5.873_386_70, 3.751_129_97, -0.370_014_83], x)
    };
    [x, y]
}

/// Coefficients from the highest power down.
fn cubic(coefficients: [f64; 4], x: f64) -> f64 {
    coefficients.into_iter().fold(0.0, |sum, c| sum * x + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of the Planckian locus as tabulated (Wyszecki and Stiles, "Color Science", 1982);
    /// 2,856 K is illuminant A.
    #[test]
    fn bodies_glow_in_their_colours() {
        for (temperature_k, x, y) in [
            (2000.0, 0.5267, 0.4133),
            (2856.0, 0.4476, 0.4074),
            (4000.0, 0.3805, 0.3768),
            (6500.0, 0.3135, 0.3237),
            (10_000.0, 0.2807, 0.2884),
        ] {
            let [got_x, got_y] = chromaticity(temperature_k);
            let label = format!("{temperature_k} K: {got_x} {got_y}");
            assert!((got_x - x).abs() < 1e-3 && (got_y - y).abs() < 1e-3, "{label}");
        }
    }

    #[test]
    fn tints_keep_the_luminance_and_turn_from_red_to_blue() {
        let mut last = f64::INFINITY;
        for temperature_k in (1667..=25_000).step_by(97) {
            let [r, g, b] = tint(f64::from(temperature_k));
            assert!((0.2126 * r + 0.7152 * g + 0.0722 * b - 1.0).abs() < 1e-12);
            assert!(
                r >= 0.0 && g > 0.0 && b >= 0.0 && r - b < last,
                "{temperature_k}: {r} {g} {b}"
            );
            last = r - b;
        }
        let [r, g, b] = tint(6504.0);
        assert!([r, g, b].iter().all(|v| (v - 1.0).abs() < 0.07), "{r} {g} {b}");
    }
}
