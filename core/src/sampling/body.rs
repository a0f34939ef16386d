//! Body shapes.

use super::keys;
use super::people::Source;
use super::quantile;
use super::value::{item, number};
use crate::base::rng::Draw;
use crate::document::{self, Ancestry, Auto, Normal, Origin};
use crate::scene::{Body, Sex};

pub(super) fn body(body: &document::Body, source: Source) -> Body {
    let of = |key| source.of(key);
    let sex = *item(&body.sex, of(keys::SEX));
    let age_years = number(&body.age_years, of(keys::AGE));
    Body {
        sex,
        age_years,
        stature_m: match &body.stature_m {
            Auto::Auto(_) => stature_m(sex, age_years, of(keys::STATURE).uniform()),
            Auto::Given(stature) => number(stature, of(keys::STATURE)),
        },
        muscle: number(&body.muscle, of(keys::MUSCLE)),
        weight: number(&body.weight, of(keys::WEIGHT)),
        proportions: number(&body.proportions, of(keys::PROPORTIONS)),
        ancestry: ancestry(&body.ancestry, of(keys::ANCESTRY)),
        cup: number(&body.cup, of(keys::CUP)),
        firmness: number(&body.firmness, of(keys::FIRMNESS)),
    }
}

/// African, Asian, European shares that sum to 1.
fn ancestry(ancestry: &Ancestry, draw: Draw) -> [f64; 3] {
    match ancestry {
        // Stick-breaking: the first share is beta, the second is beta of what is left.
        Ancestry::Dirichlet([_, _, _]) if draw.is_middle() => [1.0 / 3.0; 3],
        Ancestry::Dirichlet([a, b, c]) => {
            let first = quantile::unit_beta(draw.uniform(), *a, b + c);
            let second = (1.0 - first) * quantile::unit_beta(draw.lane(1).uniform(), *b, *c);
            [first, second, (1.0 - first - second).max(0.0)]
        }
        Ancestry::Shares(shares) => {
            let sum: f64 = shares.iter().sum();
            shares.map(|s| s / sum)
        }
        Ancestry::Choice(items) => {
            let chosen = quantile::index(draw.uniform(), items.iter().map(|i| i.1));
            match items[chosen].0 {
                Origin::African => [1.0, 0.0, 0.0],
                Origin::Asian => [0.0, 1.0, 0.0],
                Origin::European => [0.0, 0.0, 1.0],
            }
        }
    }
}

/// Median and standard deviation of stature in centimetres at ages 1, 2, ... 19: WHO Child Growth
/// Standards (2006, up to 5 years) and WHO Reference 2007 (from 5 years). Adults keep the last.
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
    (137.8, 6.3),
    (143.1, 6.6),
    (149.1, 7.0),
    (156.0, 7.4),
    (163.2, 7.7),
    (169.0, 7.8),
    (172.9, 7.7),
    (175.2, 7.6),
    (176.1, 7.4),
    (176.5, 7.3),
];
const GIRLS_CM: [(f64, f64); 19] = [
    (74.0, 2.6),
    (85.7, 3.2),
    (95.1, 3.8),
    (102.7, 4.3),
    (109.4, 4.7),
    (115.1, 5.1),
    (120.8, 5.4),
    (126.6, 5.8),
    (132.5, 6.1),
    (138.6, 6.4),
    (145.0, 6.6),
    (151.2, 6.8),
    (156.4, 6.8),
    (159.8, 6.8),
    (161.7, 6.7),
    (162.5, 6.7),
    (162.9, 6.6),
    (163.1, 6.5),
    (163.2, 6.5),
];
/// Stature lost since the age of 30, in centimetres (Sorkin, Muller and Andres, "Longitudinal
/// change in height of men and women", American Journal of Epidemiology 150, 1999; carried on in
/// a straight line beyond 80).
const MEN_LOSE_CM: [(f64, f64); 4] = [(30.0, 0.0), (70.0, 3.0), (80.0, 5.0), (90.0, 7.0)];
const WOMEN_LOSE_CM: [(f64, f64); 4] = [(30.0, 0.0), (70.0, 5.0), (80.0, 8.0), (90.0, 11.0)];

/// Stature by age and sex, normal within three standard deviations.
fn stature_m(sex: Sex, age_years: f64, u: f64) -> f64 {
    let (growth, loss) = match sex {
        Sex::Male => (&BOYS_CM, &MEN_LOSE_CM),
        Sex::Female => (&GIRLS_CM, &WOMEN_LOSE_CM),
    };
    let at = (age_years - 1.0).clamp(0.0, growth.len() as f64 - 1.0);
    let (i, t) = (at as usize, at.fract());
    let next = growth[(i + 1).min(growth.len() - 1)];
    let between = |a: f64, b: f64| a + t * (b - a);
    let median = between(growth[i].0, next.0) - interpolate(loss, age_years);
    let std = between(growth[i].1, next.1);
    let (min, max) = (Some(median - 3.0 * std), Some(median + 3.0 * std));
    quantile::truncated_normal(u, &Normal { mean: median, std, min, max }) / 100.0
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
    use crate::base::rng::{Draws, Key};

    fn all(law: &Ancestry) -> Vec<[f64; 3]> {
        let draw = |i| Draws::new(2, i).of(Key::new("test"), 0);
        (0..20_000).map(|i| ancestry(law, draw(i))).collect()
    }

    /// Moments of the Dirichlet law: mean a / s, variance a (s - a) / (s^2 (s + 1)).
    #[test]
    fn shares_follow_the_dirichlet_law() {
        let alpha = [0.4, 0.8, 2.0];
        let sum: f64 = alpha.iter().sum();
        let shares = all(&Ancestry::Dirichlet(alpha));
        assert!(shares.iter().all(|s| (s.iter().sum::<f64>() - 1.0).abs() < 1e-12));
        for (i, a) in alpha.into_iter().enumerate() {
            let mean = shares.iter().map(|s| s[i]).sum::<f64>() / 20_000.0;
            let variance = shares.iter().map(|s| (s[i] - mean).powi(2)).sum::<f64>() / 20_000.0;
            let expected = a * (sum - a) / (sum * sum * (sum + 1.0));
            assert!(
                (mean - a / sum).abs() < 4.0 * (expected / 20_000.0).sqrt(),
                "{i}: mean {mean}"
            );
            assert!((variance / expected - 1.0).abs() < 0.05, "{i}: variance {variance}");
        }
    }

    #[test]
    fn stature_follows_age_and_sex() {
        let median = |sex, age| stature_m(sex, age, 0.5);
        assert!((median(Sex::Male, 25.0) - 1.765).abs() < 1e-9);
        assert!((median(Sex::Female, 25.0) - 1.632).abs() < 1e-9);
        assert!((median(Sex::Male, 7.5) - 1.245).abs() < 1e-9);
        assert!((median(Sex::Female, 80.0) - 1.552).abs() < 1e-9);
        // One standard deviation above, but for the truncation at three.
        let above = stature_m(Sex::Male, 40.0, quantile::normal_cdf(1.0));
        let expected = 1.765 - 0.0075 + 0.073;
        assert!((above - expected).abs() < 1e-3, "{above}");
        for age in 0..=200 {
            for u in [0.0, 0.5, 0.999_999_9] {
                let s = stature_m(Sex::Female, f64::from(age) / 2.0, u);
                assert!((0.6..2.1).contains(&s), "{age} {u}: {s}");
            }
        }
    }
}
