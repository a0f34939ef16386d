//! Inverse distribution functions: one uniform number in [0, 1) to one value.
//!
//! Drawing by inversion keeps the count of random numbers fixed and makes a value grow with its
//! uniform number. libm and plain arithmetic only: the same bits on every machine.

use crate::document::{Beta, Binomial, Lognormal, Normal, Triangular};

/// The uniform numbers strictly between 0 and 1 that stand in for the ends.
const LEAST: f64 = 1.0 / (1u64 << 54) as f64;
const MOST: f64 = 1.0 - 1.0 / (1u64 << 53) as f64;

/// Standard normal distribution function.
pub(super) fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

/// Inverse of [`normal_cdf`] for `0 < p < 1`, to about 16 digits: algorithm AS 241, PPND16
/// (Wichura, "The percentage points of the normal distribution", Applied Statistics 37, 1988).
#[expect(clippy::excessive_precision, reason = "coefficients as they were published")]
pub(super) fn normal(p: f64) -> f64 {
    let p = p.clamp(LEAST, MOST);
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.180625 - q * q;
        const A: [f64; 8] = [
            3.3871328727963666080e0,
            1.3314166789178437745e2,
            1.9715909503065514427e3,
            1.3731693765509461125e4,
            4.5921953931549871457e4,
            6.7265770927008700853e4,
            3.3430575583588128105e4,
            2.5090809287301226727e3,
        ];
        const B: [f64; 8] = [
            1.0,
            4.2313330701600911252e1,
            6.8718700749205790830e2,
            5.3941960214247511077e3,
            2.1213794301586595867e4,
            3.9307895800092710610e4,
            2.8729085735721942674e4,
            5.2264952788528545610e3,
        ];
        return q * horner(&A, r) / horner(&B, r);
    }
    let tail = if q < 0.0 { p } else { 1.0 - p };
    let r = libm::sqrt(-libm::log(tail));
    let z = if r <= 5.0 {
        const C: [f64; 8] = [
            1.42343711074968357734e0,
            4.63033784615654529590e0,
            5.76949722146069140550e0,
            3.64784832476320460504e0,
            1.27045825245236838258e0,
            2.41780725177450611770e-1,
            2.27238449892691845833e-2,
            7.74545014278341407640e-4,
        ];
        const D: [f64; 8] = [
            1.0,
            2.05319162663775882187e0,
            1.67638483018380384940e0,
            6.89767334985100004550e-1,
            1.48103976427480074590e-1,
            1.51986665636164571966e-2,
            5.47593808499534494600e-4,
            1.05075007164441684324e-9,
        ];
        horner(&C, r - 1.6) / horner(&D, r - 1.6)
    } else {
        const E: [f64; 8] = [
            6.65790464350110377720e0,
            5.46378491116411436990e0,
            1.78482653991729133580e0,
            2.96560571828504891230e-1,
            2.65321895265761230930e-2,
            1.24266094738807843860e-3,
            2.71155556874348757815e-5,
            2.01033439929228813265e-7,
        ];
        const F: [f64; 8] = [
            1.0,
            5.99832206555887937690e-1,
            1.36929880922735805310e-1,
            1.48753612908506148525e-2,
            7.86869131145613259100e-4,
            1.84631831751005468180e-5,
            1.42151175831644588870e-7,
            2.04426310338993978564e-15,
        ];
        horner(&E, r - 5.0) / horner(&F, r - 5.0)
    };
    if q < 0.0 { -z } else { z }
}

/// Coefficients from the constant term upwards.
fn horner(coefficients: &[f64; 8], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// Standard normal between two bounds. In the upper tail it works with the mirror image, where
/// the distribution function has all its digits.
fn normal_between(u: f64, low: f64, high: f64) -> f64 {
    let mirrored = low > 0.0;
    let (a, b, u) = if mirrored { (-high, -low, 1.0 - u) } else { (low, high, u) };
    let (p, q) = (normal_cdf(a), normal_cdf(b));
    let z = normal(p + u * (q - p)).clamp(a, b);
    if mirrored { -z } else { z }
}

pub(super) fn truncated_normal(u: f64, n: &Normal) -> f64 {
    let z = |bound: Option<f64>, none: f64| bound.map_or(none, |b| (b - n.mean) / n.std);
    let low = z(n.min, f64::NEG_INFINITY);
    let value = n.mean + n.std * normal_between(u, low, z(n.max, f64::INFINITY));
    value.max(n.min.unwrap_or(f64::NEG_INFINITY)).min(n.max.unwrap_or(f64::INFINITY))
}

pub(super) fn lognormal(u: f64, l: &Lognormal) -> f64 {
    let z = |bound: Option<f64>, none: f64| match bound {
        Some(b) if b > 0.0 => libm::log(b / l.median) / l.sigma,
        _ => none,
    };
    let low = z(l.min, f64::NEG_INFINITY);
    let value = l.median * libm::exp(l.sigma * normal_between(u, low, z(l.max, f64::INFINITY)));
    value.max(l.min.unwrap_or(0.0)).min(l.max.unwrap_or(f64::INFINITY))
}

pub(super) fn triangular(u: f64, t: &Triangular) -> f64 {
    let (width, left) = (t.max - t.min, t.mode - t.min);
    if u * width < left {
        t.min + (u * width * left).sqrt()
    } else {
        t.max - ((1.0 - u) * width * (width - left)).sqrt()
    }
}

/// Beta by safeguarded Newton steps on the regularised incomplete beta function.
pub(super) fn beta(u: f64, law: &Beta) -> f64 {
    law.min + (law.max - law.min) * unit_beta(u, law.alpha, law.beta)
}

/// Beta on [0, 1].
pub(super) fn unit_beta(u: f64, a: f64, b: f64) -> f64 {
    if u <= 0.0 {
        return 0.0;
    }
    let log_scale = libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b);
    let (mut low, mut high, mut x) = (0.0_f64, 1.0_f64, a / (a + b));
    for _ in 0..200 {
        let error = beta_cdf(x, a, b, log_scale) - u;
        if error < 0.0 {
            low = x
        } else {
            high = x
        }
        let log_density = log_scale + (a - 1.0) * libm::log(x) + (b - 1.0) * libm::log1p(-x);
        let newton = x - error / libm::exp(log_density);
        // NaN fails the comparison and halves the interval as well.
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let step = (next - x).abs();
        x = next;
        if step <= 1e-15 * x || high - low <= f64::MIN_POSITIVE {
            break;
        }
    }
    x
}

/// Regularised incomplete beta function (DLMF 8.17.22), continued fraction by Lentz's method.
fn beta_cdf(x: f64, a: f64, b: f64, log_scale: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return f64::from(x >= 1.0);
    }
    let front = libm::exp(log_scale + a * libm::log(x) + b * libm::log1p(-x));
    if x < (a + 1.0) / (a + b + 2.0) {
        front * beta_fraction(x, a, b) / a
    } else {
        1.0 - front * beta_fraction(1.0 - x, b, a) / b
    }
}

fn beta_fraction(x: f64, a: f64, b: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let away_from_zero = |v: f64| if v.abs() < TINY { TINY } else { v };
    let mut c = 1.0;
    let mut d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for m in 1..10_000 {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut change = 1.0;
        for term in [even, odd] {
            d = 1.0 / away_from_zero(1.0 + term * d);
            c = away_from_zero(1.0 + term / c);
            change = d * c;
            fraction *= change;
        }
        if (change - 1.0).abs() < 1e-15 {
            break;
        }
    }
    fraction
}

pub(super) fn poisson(u: f64, mean: f64) -> f64 {
    if mean <= 0.0 {
        return 0.0;
    }
    let mode = mean.floor();
    let density = libm::exp(mode * libm::log(mean) - mean - libm::lgamma(mode + 1.0));
    count_from(u, mode, density, f64::INFINITY, |k| mean / k)
}

pub(super) fn binomial(u: f64, law: &Binomial) -> f64 {
    let (n, p) = (f64::from(law.n), law.p);
    if p <= 0.0 || p >= 1.0 {
        return if p >= 1.0 { n } else { 0.0 };
    }
    let mode = ((n + 1.0) * p).floor().min(n);
    let ways = libm::lgamma(n + 1.0) - libm::lgamma(mode + 1.0) - libm::lgamma(n - mode + 1.0);
    let density = libm::exp(ways + mode * libm::log(p) + (n - mode) * libm::log1p(-p));
    count_from(u, mode, density, n, |k| (n - k + 1.0) / k * (p / (1.0 - p)))
}

/// Inverts a unimodal law over whole numbers by walking from its mode, where no mean is too large
/// for the density to be represented. `ratio(k)` is density(k) / density(k - 1).
fn count_from(u: f64, mode: f64, density: f64, max: f64, ratio: impl Fn(f64) -> f64) -> f64 {
    /// Below this a density changes no sum any more.
    const NOTHING: f64 = 1e-20;
    let (mut cdf, mut k, mut term) = (density, mode, density);
    while k > 0.0 && term > NOTHING {
        term /= ratio(k);
        cdf += term;
        k -= 1.0;
    }
    (k, term) = (mode, density);
    while u < cdf - term && k > 0.0 && term > NOTHING {
        cdf -= term;
        term /= ratio(k);
        k -= 1.0;
    }
    while u >= cdf && k < max && term > NOTHING {
        k += 1.0;
        term *= ratio(k);
        cdf += term;
    }
    k
}

/// Piecewise-linear density through points (x, density).
pub(super) fn curve(u: f64, points: &[(f64, f64)]) -> f64 {
    let area = |pair: &[(f64, f64)]| 0.5 * (pair[1].0 - pair[0].0) * (pair[0].1 + pair[1].1);
    let mut left = u * points.windows(2).map(area).sum::<f64>();
    let mut end = points[0].0;
    for pair in points.windows(2) {
        let whole = area(pair);
        if whole <= 0.0 {
            continue;
        }
        let ((x0, d0), (x1, d1)) = (pair[0], pair[1]);
        if left < whole {
            // d0 x + s x^2 / 2 = left, by the form that does not cancel.
            let slope = (d1 - d0) / (x1 - x0);
            let root = (d0 * d0 + 2.0 * slope * left).max(0.0).sqrt();
            let x = if left > 0.0 { 2.0 * left / (d0 + root) } else { 0.0 };
            return (x0 + x).min(x1);
        }
        left -= whole;
        end = x1;
    }
    end
}

/// Index by weight: the first whose cumulative share exceeds `u`; never one of weight 0.
pub(super) fn index(u: f64, weights: impl Iterator<Item = f64> + Clone) -> usize {
    let mut left = u * weights.clone().sum::<f64>();
    let mut last = 0;
    for (i, weight) in weights.enumerate() {
        if weight > 0.0 {
            if left < weight {
                return i;
            }
            last = i;
        }
        left -= weight;
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_quantile_inverts_the_distribution_function() {
        for i in 1..2000 {
            let p = f64::from(i) / 2000.0;
            assert!((normal_cdf(normal(p)) - p).abs() < 4e-16 + 2e-15 * p, "{p}");
        }
        for e in 1..16 {
            let p = 10f64.powi(-e);
            assert!((normal_cdf(normal(p)) / p - 1.0).abs() < 1e-13, "{p}");
        }
        // Published: Wichura's check values.
        assert!((normal(0.25) + 0.674_489_750_196_081_7).abs() < 1e-15);
        assert!((normal(0.001) + 3.090_232_306_167_814).abs() < 1e-14);
        assert!(normal(0.0).is_finite() && normal(1.0).is_finite());
        assert!(normal(0.0).abs() < 8.3 && normal(1.0).abs() < 8.3);
    }

    #[test]
    fn truncation_holds_even_far_out() {
        for (min, max) in [(-1.0, 2.0), (5.0, 5.5), (-5.5, -5.0), (0.0, 1e-3)] {
            let law = Normal { mean: 0.0, std: 1.0, min: Some(min), max: Some(max) };
            let mut before = min;
            for i in 0..=1000 {
                let x = truncated_normal(f64::from(i) / 1000.0, &law);
                assert!(x >= before && x <= max, "{x} not in [{before}, {max}]");
                before = x;
            }
            assert!(truncated_normal(0.0, &law) - min < 1e-6 * (1.0 + min.abs()));
            assert!(max - before < 1e-6 * (1.0 + max.abs()), "{max} {before}");
        }
    }

    #[test]
    fn beta_meets_its_closed_forms() {
        for i in 1..100 {
            let u = f64::from(i) / 100.0;
            // I_x(a, 1) = x^a, I_x(1, b) = 1 - (1 - x)^b, arcsine law for a = b = 1/2.
            for a in [0.1, 0.5, 3.0, 50.0] {
                assert!(
                    (unit_beta(u, a, 1.0) / libm::pow(u, 1.0 / a) - 1.0).abs() < 1e-11,
                    "{u} {a}"
                );
                let x = -libm::expm1(libm::log1p(-u) / a);
                assert!((unit_beta(u, 1.0, a) / x - 1.0).abs() < 1e-11, "{u} {a}");
            }
            let s = libm::sin(u * std::f64::consts::FRAC_PI_2);
            assert!((unit_beta(u, 0.5, 0.5) - s * s).abs() < 1e-12, "{u}");
        }
        let median = unit_beta(0.5, 1e4, 1e4);
        assert!((median - 0.5).abs() < 1e-12, "{median}");
        assert_eq!(unit_beta(0.0, 2.0, 2.0), 0.0);
    }

    #[test]
    fn counts_invert_their_sums() {
        // Poisson and binomial against plain summation of the densities.
        let mut density = libm::exp(-6.0);
        let mut cdf = 0.0;
        for k in 0..20 {
            let middle = cdf + 0.5 * density;
            assert_eq!(poisson(middle, 6.0), f64::from(k));
            cdf += density;
            density *= 6.0 / f64::from(k + 1);
        }
        let law = Binomial { n: 3, p: 0.5 };
        let values: Vec<f64> = [0.0, 0.12, 0.13, 0.49, 0.51, 0.87, 0.88, 0.999]
            .into_iter()
            .map(|u| binomial(u, &law))
            .collect();
        assert_eq!(values, [0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
        assert_eq!(binomial(0.3, &Binomial { n: 7, p: 1.0 }), 7.0);
        assert_eq!(binomial(0.3, &Binomial { n: 7, p: 0.0 }), 0.0);
    }

    #[test]
    fn large_means_are_safe() {
        for mean in [800.0, 1e4, 1e6] {
            let spread = f64::sqrt(mean);
            let median = poisson(0.5, mean);
            assert!((median - mean).abs() < 2.0, "{mean}: {median}");
            let upper = poisson(normal_cdf(2.0), mean);
            assert!((upper - mean - 2.0 * spread).abs() < 4.0, "{mean}: {upper}");
            assert!(poisson(0.0, mean) > mean - 11.0 * spread);
            assert!(poisson(MOST, mean) < mean + 11.0 * spread);
        }
        let law = Binomial { n: 1_000_000, p: 0.5 };
        assert!((binomial(normal_cdf(1.0), &law) - 500_500.0).abs() < 2.0);
    }

    #[test]
    fn curves_invert_their_area() {
        let tent = [(0.0, 0.0), (1.0, 2.0), (2.0, 0.0)];
        let same = Triangular { min: 0.0, mode: 1.0, max: 2.0 };
        for i in 0..100 {
            let u = f64::from(i) / 100.0;
            assert!((curve(u, &tent) - triangular(u, &same)).abs() < 1e-12, "{u}");
        }
        // A gap in the middle is never drawn.
        let gap = [(0.0, 1.0), (1.0, 1.0), (1.1, 0.0), (2.0, 0.0), (2.1, 1.0), (3.0, 1.0)];
        assert!(
            (0..1000).map(|i| curve(f64::from(i) / 1000.0, &gap)).all(|x| !(1.1..2.0).contains(&x))
        );
        assert_eq!(curve(0.0, &gap), 0.0);
    }

    #[test]
    fn an_index_of_weight_0_never_comes() {
        let weights = [0.0, 1.0, 0.0, 3.0, 0.0];
        let of = |u| index(u, weights.iter().copied());
        assert_eq!([of(0.0), of(0.24), of(0.26), of(MOST)], [1, 1, 3, 3]);
    }
}
