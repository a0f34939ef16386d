//! Stature and body mass index by age and sex, from published growth references.
//!
//! Age, sex and a uniform number in, a measure out: its quantile. Two draws make a person; that
//! tall people are not heavier for their stature is how the body mass index is made.

use super::quantile;
use crate::document::Normal;
use crate::scene::Sex;

/// Nobody is farther from the median than so many standard deviations.
const FARTHEST: f64 = 3.0;

/// Median and standard deviation of stature in centimetres at ages 1, 2, ... 19: WHO Child Growth
/// Standards (2006, up to 5 years) and WHO Reference 2007 (height for age, from 5 years). Adults
/// keep the last.
const BOYS_CM: [(f64, f64); 19] = [
    (75.7, 2.4),
    (87.1, 3.1),
    (96.1, 3.7),
    (103.3, 4.2),
    (110.0, 4.6),
    (116.0, 4.9),
    (121.7, 5.3),
    (127.3, 5.6),
    (132.6, 6.0),
    (137.8, 6.4),
    (143.1, 6.7),
    (149.1, 7.1),
    (156.0, 7.4),
    (163.2, 7.7),
    (169.0, 7.8),
    (172.9, 7.8),
    (175.2, 7.6),
    (176.1, 7.5),
    (176.5, 7.4),
];
const GIRLS_CM: [(f64, f64); 19] = [
    (74.0, 2.6),
    (85.7, 3.2),
    (95.1, 3.8),
    (102.7, 4.3),
    (109.4, 4.8),
    (115.1, 5.1),
    (120.8, 5.5),
    (126.6, 5.8),
    (132.5, 6.1),
    (138.6, 6.4),
    (145.0, 6.6),
    (151.2, 6.8),
    (156.4, 6.9),
    (159.8, 6.9),
    (161.7, 6.9),
    (162.5, 6.8),
    (162.9, 6.7),
    (163.1, 6.6),
    (163.2, 6.5),
];
/// Stature lost since the age of 30, in centimetres (Sorkin, Muller and Andres, "Longitudinal
/// change in height of men and women", American Journal of Epidemiology 150, 1999; carried on in
/// a straight line beyond 80).
const MEN_LOSE_CM: [(f64, f64); 4] = [(30.0, 0.0), (70.0, 3.0), (80.0, 5.0), (90.0, 7.0)];
const WOMEN_LOSE_CM: [(f64, f64); 4] = [(30.0, 0.0), (70.0, 5.0), (80.0, 8.0), (90.0, 11.0)];

/// A skewed law: power L, median M and coefficient of variation S, so that the value at z standard
/// deviations is `M (1 + L S z)^(1 / L)` (Cole, "The LMS method for constructing normalized growth
/// standards", European Journal of Clinical Nutrition 44, 1990).
type Lms = [f64; 3];

/// Body mass index at ages 1, 2, ... 19: WHO Child Growth Standards (2006, up to 4 years) and WHO
/// Reference 2007 (from 5 years).
const BOYS_BMI: [Lms; 19] = [
    [-0.41, 16.80, 0.0803],
    [-0.62, 16.02, 0.0779],
    [-0.31, 15.60, 0.0793],
    [-0.36, 15.33, 0.0824],
    [-0.74, 15.26, 0.0839],
    [-1.01, 15.32, 0.0871],
    [-1.27, 15.50, 0.0910],
    [-1.48, 15.76, 0.0957],
    [-1.64, 16.08, 0.1008],
    [-1.75, 16.48, 0.1061],
    [-1.79, 16.98, 0.1111],
    [-1.77, 17.59, 0.1156],
    [-1.71, 18.30, 0.1193],
    [-1.61, 19.07, 0.1221],
    [-1.48, 19.84, 0.1243],
    [-1.34, 20.55, 0.1259],
    [-1.18, 21.19, 0.1273],
    [-1.03, 21.7, 0.128],
    [-0.88, 22.2, 0.129],
];
const GIRLS_BMI: [Lms; 19] = [
    [-0.37, 16.36, 0.0854],
    [-0.57, 15.69, 0.0845],
    [-0.57, 15.40, 0.0854],
    [-0.57, 15.26, 0.0917],
    [-0.89, 15.24, 0.0969],
    [-1.10, 15.28, 0.1024],
    [-1.27, 15.42, 0.1079],
    [-1.40, 15.71, 0.1134],
    [-1.47, 16.14, 0.1186],
    [-1.49, 16.66, 0.1235],
    [-1.46, 17.30, 0.1278],
    [-1.39, 18.06, 0.1316],
    [-1.31, 18.87, 0.1347],
    [-1.22, 19.62, 0.1372],
    [-1.12, 20.26, 0.1392],
    [-1.03, 20.73, 0.1408],
    [-0.93, 21.06, 0.1422],
    [-0.85, 21.28, 0.1434],
    [-0.75, 21.43, 0.1444],
];
/// Mean of all adults of the world in 2014, men and women (NCD Risk Factor Collaboration, "Trends
/// in adult body-mass index in 200 countries from 1975 to 2014", Lancet 387, 2016). It is reached
/// at 30; spread and skew stay those of the age of 19.
const ADULT_MEAN_BMI: [f64; 2] = [24.2, 24.4];
const ADULT_FROM_YEARS: f64 = 30.0;

/// Stature by age and sex in metres, normal within three standard deviations.
pub(super) fn stature_m(sex: Sex, age_years: f64, u: f64) -> f64 {
    let (growth, loss) = match sex {
        Sex::Male => (&BOYS_CM, &MEN_LOSE_CM),
        Sex::Female => (&GIRLS_CM, &WOMEN_LOSE_CM),
    };
    let (i, t) = row(age_years, growth.len());
    let next = growth[(i + 1).min(growth.len() - 1)];
    let between = |a: f64, b: f64| a + t * (b - a);
    let median = between(growth[i].0, next.0) - interpolate(loss, age_years);
    let std = between(growth[i].1, next.1);
    let (min, max) = (Some(median - FARTHEST * std), Some(median + FARTHEST * std));
    quantile::truncated_normal(u, &Normal { mean: median, std, min, max }) / 100.0
}

/// Body mass index by age and sex in kg/m2, within three standard deviations.
pub(super) fn bmi_kg_m2(sex: Sex, age_years: f64, u: f64) -> f64 {
    let (growth, adult_mean) = match sex {
        Sex::Male => (&BOYS_BMI, ADULT_MEAN_BMI[0]),
        Sex::Female => (&GIRLS_BMI, ADULT_MEAN_BMI[1]),
    };
    let (i, t) = row(age_years, growth.len());
    let next = growth[(i + 1).min(growth.len() - 1)];
    let [l, youth, s]: Lms = std::array::from_fn(|k| growth[i][k] + t * (next[k] - growth[i][k]));
    // To second order the mean of the law is its median times this.
    let adult = adult_mean / (1.0 + 0.5 * (1.0 - l) * s * s);
    let last = growth.len() as f64;
    let grown = ((age_years - last) / (ADULT_FROM_YEARS - last)).clamp(0.0, 1.0);
    let median = youth + grown * (adult - youth);
    let (min, max) = (Some(-FARTHEST), Some(FARTHEST));
    let z = quantile::truncated_normal(u, &Normal { mean: 0.0, std: 1.0, min, max });
    median * libm::pow(1.0 + l * s * z, 1.0 / l)
}

/// The row of a table by years from 1, and how far on the way to the next.
fn row(age_years: f64, rows: usize) -> (usize, f64) {
    let at = (age_years - 1.0).clamp(0.0, rows as f64 - 1.0);
    (at as usize, at.fract())
}

/// Straight lines between points, level beyond their ends.
pub(super) fn interpolate(points: &[(f64, f64)], x: f64) -> f64 {
    for pair in points.windows(2) {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        if x < x1 {
            return y0 + ((x - x0) / (x1 - x0)).max(0.0) * (y1 - y0);
        }
    }
    points.last().map_or(0.0, |p| p.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stature_follows_age_and_sex() {
        let median = |sex, age| stature_m(sex, age, 0.5);
        assert!((median(Sex::Male, 25.0) - 1.765).abs() < 1e-9);
        assert!((median(Sex::Female, 25.0) - 1.632).abs() < 1e-9);
        assert!((median(Sex::Male, 7.5) - 1.245).abs() < 1e-9);
        assert!((median(Sex::Female, 80.0) - 1.552).abs() < 1e-9);
        // One standard deviation above, but for the truncation at three.
        let above = stature_m(Sex::Male, 40.0, quantile::normal_cdf(1.0));
        let expected = 1.765 - 0.0075 + 0.074;
        assert!((above - expected).abs() < 1e-3, "{above}");
        for age in 0..=200 {
            for u in [0.0, 0.5, 0.999_999_9] {
                let s = stature_m(Sex::Female, f64::from(age) / 2.0, u);
                assert!((0.6..2.1).contains(&s), "{age} {u}: {s}");
            }
        }
    }

    /// Published percentiles: WHO's standard deviation lines for children, the mean for adults.
    #[test]
    fn body_mass_index_follows_age_and_sex() {
        let at = |sex, age, z: f64| bmi_kg_m2(sex, age, quantile::normal_cdf(z));
        for (sex, age, z, published) in [
            (Sex::Male, 1.0, 0.0, 16.8),
            (Sex::Male, 5.0, 0.0, 15.3),
            (Sex::Male, 10.0, 1.0, 18.5),
            (Sex::Male, 10.0, -2.0, 13.7),
            (Sex::Male, 15.0, 2.0, 27.0),
            (Sex::Female, 7.0, 1.0, 17.3),
            (Sex::Female, 12.0, 2.0, 25.0),
            (Sex::Female, 17.0, -1.0, 18.4),
        ] {
            let got = at(sex, age, z);
            assert!((got - published).abs() < 0.15, "{sex:?} {age} {z}: {got} {published}");
        }
        for (sex, mean) in [(Sex::Male, 24.2), (Sex::Female, 24.4)] {
            let all = (0..1000).map(|i| bmi_kg_m2(sex, 45.0, (f64::from(i) + 0.5) / 1000.0));
            let got = all.sum::<f64>() / 1000.0;
            assert!((got - mean).abs() < 0.1, "{sex:?}: {got}");
        }
    }
}
