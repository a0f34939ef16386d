//! Body shapes.

use super::growth;
use super::keys;
use super::linked::Draw;
use super::people::Source;
use super::quantile;
use super::value::{item, number};
use crate::document::cast::MemberBody;
use crate::document::{self, Ancestry, Auto, Origin};
use crate::scene::Body;

/// Shares that sum to 1 as nearly as this are taken as they are, so that what was written is what
/// is read.
const SUM_SLACK: f64 = 1e-9;

/// What is known of a person stays, the rest is drawn.
pub(super) fn body(body: &document::Body, known: &MemberBody, source: Source) -> Body {
    let of = |key| source.of(key);
    let sex = known.sex.unwrap_or_else(|| *item(&body.sex, of(keys::SEX)));
    let age_years = known.age_years.unwrap_or_else(|| number(&body.age_years, of(keys::AGE)));
    Body {
        sex,
        age_years,
        stature_m: known.stature_m.unwrap_or_else(|| match &body.stature_m {
            Auto::Auto(_) => growth::stature_m(sex, age_years, of(keys::STATURE).uniform()),
            Auto::Given(stature) => number(stature, of(keys::STATURE)),
        }),
        bmi_kg_m2: known.bmi_kg_m2.unwrap_or_else(|| match &body.bmi_kg_m2 {
            Auto::Auto(_) => growth::bmi_kg_m2(sex, age_years, of(keys::BMI).uniform()),
            Auto::Given(bmi) => number(bmi, of(keys::BMI)),
        }),
        muscle: known.muscle.unwrap_or_else(|| number(&body.muscle, of(keys::MUSCLE))),
        proportions: known
            .proportions
            .unwrap_or_else(|| number(&body.proportions, of(keys::PROPORTIONS))),
        ancestry: match known.ancestry {
            Some(shares) => summing_to_one(shares),
            None => ancestry(&body.ancestry, of(keys::ANCESTRY)),
        },
        cup: known.cup.unwrap_or_else(|| number(&body.cup, of(keys::CUP))),
        firmness: known.firmness.unwrap_or_else(|| number(&body.firmness, of(keys::FIRMNESS))),
    }
}

fn summing_to_one(shares: [f64; 3]) -> [f64; 3] {
    let sum: f64 = shares.iter().sum();
    if (sum - 1.0).abs() < SUM_SLACK { shares } else { shares.map(|s| s / sum) }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Key;
    use crate::sampling::linked::Draws;

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
}
