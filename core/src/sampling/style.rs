//! Which hair, beard, headwear and glasses a person wears where the document says `"auto"`.
//!
//! Sex, age and ancestry flow in, one of the kinds flows out. The weights are plausible, not
//! measured; only the loss of hair follows counts of men by age (Hamilton, "Patterned loss of hair
//! in man", 1951; Norwood, "Male pattern baldness", 1975), coarsely.

use super::growth::interpolate;
use super::linked::Draw;
use super::people::PersonTraits;
use super::quantile;
use crate::scene::{BeardStyle, Glasses, HairStyle, HeadwearKind, Sex};

fn pick<T: Copy>(weights: &[(T, f64)], draw: Draw) -> T {
    weights[quantile::index(draw.uniform(), weights.iter().map(|w| w.1))].0
}

/// Hair on the head.
pub(super) fn hair(traits: PersonTraits, draw: Draw) -> HairStyle {
    let PersonTraits { sex, age_years, ancestry } = traits;
    let african = ((ancestry[0] - 0.3) / 0.4).clamp(0.0, 1.0);
    let others = 1.0 - african;
    if age_years < 3.0 {
        let short = [(HairStyle::Cropped, 0.5), (HairStyle::Short, 0.5 * others)];
        let curls = [(HairStyle::Afro, 0.5 * african)];
        return pick(&[short.as_slice(), &curls].concat(), draw);
    }
    match sex {
        Sex::Male => {
            // From the age of 20 on.
            let lost = |points: &[(f64, f64)]| {
                if age_years < 20.0 { 0.0 } else { interpolate(points, age_years) }
            };
            let bald = lost(&[(20.0, 0.02), (40.0, 0.10), (70.0, 0.18)]);
            let balding = lost(&[(28.0, 0.0), (45.0, 0.12), (70.0, 0.40)]);
            let kept = 1.0 - bald - balding;
            let young = interpolate(&[(25.0, 1.0), (50.0, 0.3)], age_years);
            let weights = [
                (HairStyle::Cropped, 0.16 + 0.34 * african),
                (HairStyle::CrewCut, 0.20),
                (HairStyle::Short, 0.24 * others),
                (HairStyle::SideParting, 0.22 * others),
                (HairStyle::Pixie, 0.08 * others * young),
                (HairStyle::Afro, 0.24 * african * young),
                (HairStyle::Curly, (0.05 + 0.05 * african) * young),
                (HairStyle::LongStraight, 0.02 * others * young),
                (HairStyle::LongWavy, 0.02 * others * young),
                (HairStyle::Ponytail, 0.012 * young),
                (HairStyle::Bun, 0.015 * young),
                (HairStyle::Braids, 0.03 * african * young),
            ];
            let sum: f64 = weights.iter().map(|w| w.1).sum();
            let kept = weights.map(|(style, w)| (style, w * kept / sum));
            let gone = [(HairStyle::Bald, bald), (HairStyle::Balding, balding)];
            pick(&[kept.as_slice(), &gone].concat(), draw)
        }
        Sex::Female => {
            let old = interpolate(&[(45.0, 0.0), (75.0, 1.0)], age_years);
            let girl = interpolate(&[(10.0, 1.0), (18.0, 0.0)], age_years);
            let long = 1.0 - 0.75 * old;
            let weights = [
                (HairStyle::Cropped, 0.01 + 0.06 * african),
                (HairStyle::Short, (0.05 + 0.22 * old) * (0.3 + 0.7 * others)),
                (HairStyle::Pixie, (0.06 + 0.12 * old) * (0.3 + 0.7 * others)),
                (HairStyle::Afro, 0.26 * african),
                (HairStyle::Curly, 0.08 + 0.10 * african + 0.10 * old),
                (HairStyle::Bob, (0.14 + 0.12 * old) * others),
                (HairStyle::LongStraight, (0.22 * others + 0.05 * african) * long),
                (HairStyle::LongWavy, (0.20 * others + 0.03) * long),
                (HairStyle::Ponytail, (0.15 + 0.15 * girl) * long),
                (HairStyle::Bun, 0.10 + 0.02 * old),
                (HairStyle::Braids, 0.015 * others + 0.20 * african * long + 0.12 * girl),
            ];
            pick(&weights, draw)
        }
    }
}

/// Hair on the face.
pub(super) fn beard(traits: PersonTraits, draw: Draw) -> BeardStyle {
    let age = traits.age_years;
    if traits.sex == Sex::Female || age < 16.0 {
        return BeardStyle::None;
    }
    let grown = interpolate(&[(16.0, 0.0), (24.0, 1.0)], age);
    // East Asian men have fewer.
    let some = grown * (1.0 - 0.55 * traits.ancestry[1]);
    let weights = [
        (BeardStyle::Stubble, 0.24 * some * interpolate(&[(40.0, 1.0), (75.0, 0.5)], age)),
        (BeardStyle::Moustache, 0.05 * some * interpolate(&[(25.0, 0.5), (60.0, 1.6)], age)),
        (BeardStyle::Goatee, 0.07 * some),
        (BeardStyle::Full, 0.17 * some),
    ];
    let shaven = 1.0 - weights.iter().map(|w| w.1).sum::<f64>();
    pick(&[weights.as_slice(), &[(BeardStyle::None, shaven)]].concat(), draw)
}

/// On the head: one in ten wears something.
pub(super) fn headwear(traits: PersonTraits, draw: Draw) -> HeadwearKind {
    let old = interpolate(&[(30.0, 0.0), (70.0, 1.0)], traits.age_years);
    let female = f64::from(traits.sex == Sex::Female);
    let grown = if traits.age_years < 12.0 { 0.0 } else { 1.0 };
    let weights = [
        (HeadwearKind::None, 0.90),
        (HeadwearKind::Cap, 0.050 * (1.0 - 0.5 * old) * (1.0 - 0.5 * female)),
        (HeadwearKind::Beanie, 0.028 * (1.0 - 0.5 * old)),
        (HeadwearKind::BrimmedHat, 0.012 + 0.018 * old),
        (HeadwearKind::Headscarf, 0.050 * female * grown),
    ];
    pick(&weights, draw)
}

/// In front of the eyes.
pub(super) fn glasses(traits: PersonTraits, draw: Draw) -> Glasses {
    let worn =
        interpolate(&[(5.0, 0.03), (20.0, 0.12), (45.0, 0.18), (75.0, 0.42)], traits.age_years);
    let sun = if traits.age_years < 8.0 { 0.0 } else { 0.04 };
    let weights = [
        (Glasses::None, 1.0 - worn - sun),
        (Glasses::Thin, 0.6 * worn),
        (Glasses::Thick, 0.4 * worn),
        (Glasses::Sunglasses, sun),
    ];
    pick(&weights, draw)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Key;
    use crate::sampling::linked::Draws;

    const ANYONE: [f64; 3] = [0.2, 0.3, 0.5];
    const AFRICAN: [f64; 3] = [0.9, 0.1, 0.0];

    fn traits(sex: Sex, age_years: f64, ancestry: [f64; 3]) -> PersonTraits {
        PersonTraits { sex, age_years, ancestry }
    }

    fn share(of: impl Fn(Draw) -> bool) -> f64 {
        let draws = (0..5000).map(|i| Draws::new(8, i).of(Key::new("test"), 0));
        draws.map(|d| f64::from(of(d))).sum::<f64>() / 5000.0
    }

    #[test]
    fn hair_follows_sex_age_and_ancestry() {
        use HairStyle as H;
        let of = |t: PersonTraits, styles: &[H]| share(|d| styles.contains(&hair(t, d)));
        let long = [H::Bob, H::LongStraight, H::LongWavy, H::Ponytail, H::Bun, H::Braids, H::Curly];
        assert!(of(traits(Sex::Female, 30.0, ANYONE), &long) > 0.7);
        assert!(of(traits(Sex::Male, 30.0, ANYONE), &long) < 0.15);
        let gone = [H::Bald, H::Balding];
        for sex in [Sex::Male, Sex::Female] {
            assert_eq!(of(traits(sex, 12.0, ANYONE), &gone), 0.0);
        }
        assert_eq!(of(traits(Sex::Female, 80.0, ANYONE), &gone), 0.0);
        let old = of(traits(Sex::Male, 72.0, ANYONE), &gone);
        assert!((0.4..0.75).contains(&old), "{old}");
        assert!(of(traits(Sex::Male, 30.0, ANYONE), &gone) < 0.15);
        let curls = [H::Afro, H::Braids, H::Cropped];
        for sex in [Sex::Male, Sex::Female] {
            let [african, other] = [AFRICAN, [0.0, 0.5, 0.5]];
            assert!(of(traits(sex, 30.0, african), &curls) > 0.40);
            assert_eq!(of(traits(sex, 30.0, other), &[H::Afro]), 0.0);
        }
    }

    #[test]
    fn only_grown_men_have_beards() {
        let bearded = |sex, age| share(|d| beard(traits(sex, age, ANYONE), d) != BeardStyle::None);
        assert_eq!(bearded(Sex::Female, 40.0), 0.0);
        assert_eq!(bearded(Sex::Male, 12.0), 0.0);
        let men = bearded(Sex::Male, 35.0);
        assert!((0.3..0.6).contains(&men), "{men}");
    }

    #[test]
    fn most_heads_are_bare_and_glasses_come_with_age() {
        for (sex, age) in [(Sex::Male, 20.0), (Sex::Female, 40.0), (Sex::Male, 80.0)] {
            let bare = share(|d| headwear(traits(sex, age, ANYONE), d) == HeadwearKind::None);
            assert!((0.87..0.96).contains(&bare), "{bare}");
        }
        let scarf =
            |sex, age| share(|d| headwear(traits(sex, age, ANYONE), d) == HeadwearKind::Headscarf);
        assert!(scarf(Sex::Male, 30.0) == 0.0 && scarf(Sex::Female, 6.0) == 0.0);
        let worn = |age| share(|d| glasses(traits(Sex::Male, age, ANYONE), d) != Glasses::None);
        assert!(worn(10.0) < 0.15 && worn(75.0) > 0.35);
    }
}
