//! The people that are drawn, measured with a tape and a pair of scales: stature and body mass index
//! by age and sex against published means and spreads.

use figurant_core::document::{Document, file};
use figurant_core::geometry::body::rest_body;
use figurant_core::geometry::phenotype::evaluate;
use figurant_core::job;
use figurant_core::library::Library;
use figurant_core::library::figure::{Figure, GroupId};

use figurant_core::sampling::Sampler;
use figurant_core::scene::Person;
use glam::DVec3;

/// How many people are drawn of each kind.
const DRAWN: u32 = 2000;
/// How many of them are measured.
const MEASURED: usize = 60;
/// Mean density of the living body in kg per litre, from hydrostatic weighing of adults with a
/// residual of air in the lungs.
const DENSITY: f64 = 0.98;

/// What is published of an age and a sex: mean and standard deviation of stature in centimetres,
/// and of the body mass index in kg/m2.
struct Published {
    age_years: f64,
    sex: &'static str,
    stature_cm: (f64, f64),
    bmi: (f64, f64),
}

/// Children: WHO Reference 2007 at 7, 12 and 17 years (height for age; BMI for age, whose standard
/// deviation is half the distance between the lines at -1 and +1, and whose mean is a little above
/// the median for its skew). Adults: WHO's stature at 19, less than a centimetre of loss, and the
/// means of NCD-RisC (Lancet 387, 2016), with WHO's spread at 19 scaled with them.
const PUBLISHED: [Published; 8] = [
    Published { age_years: 7.0, sex: "male", stature_cm: (121.7, 5.3), bmi: (15.7, 1.45) },
    Published { age_years: 7.0, sex: "female", stature_cm: (120.8, 5.5), bmi: (15.6, 1.70) },
    Published { age_years: 12.0, sex: "male", stature_cm: (149.1, 7.1), bmi: (17.9, 2.07) },
    Published { age_years: 12.0, sex: "female", stature_cm: (151.2, 6.8), bmi: (18.4, 2.43) },
    Published { age_years: 17.0, sex: "male", stature_cm: (175.2, 7.6), bmi: (21.6, 2.76) },
    Published { age_years: 17.0, sex: "female", stature_cm: (162.9, 6.7), bmi: (21.5, 3.06) },
    Published { age_years: 40.0, sex: "male", stature_cm: (175.8, 7.4), bmi: (24.2, 3.25) },
    Published { age_years: 40.0, sex: "female", stature_cm: (162.0, 6.5), bmi: (24.4, 3.70) },
];

fn drawn(published: &Published) -> Vec<Person> {
    let document = serde_json::json!({
        "version": 1,
        "people": {
            "identities": null,
            "placement": {"mode": "row", "count": 100, "spacing_m": 1},
            "body": {"age_years": published.age_years, "sex": published.sex},
        },
    });
    let document: Document = file::parse(&document.to_string()).expect("a valid document");
    let library = Library::new(&[], 1024).expect("built-in assets load");
    let catalogue = job::catalogue(&library);
    let sampler = Sampler::new(document.into(), catalogue).expect("a valid document");
    (0..DRAWN / 100).flat_map(|frame| sampler.scene(frame).people).collect()
}

/// Stature in centimetres and body mass index of a body, from its finest skin.
fn measured(figure: &Figure, person: &Person) -> (f64, f64) {
    let rest = rest_body(figure, &person.body, &[]).expect("no face targets");
    let group = figure.group(GroupId::Skin);
    let skin = evaluate(figure, &rest.shape, figure.vertices(GroupId::Skin, group.count));
    let at =
        |r: u16| DVec3::from_array(skin[usize::from(group.render[usize::from(r)])].map(f64::from));
    let litres: f64 = group.lods[0]
        .triangles
        .chunks_exact(3)
        .map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0 * 1000.0)
        .sum();
    let top = skin.iter().map(|p| f64::from(p[1])).fold(f64::MIN, f64::max);
    let low = skin.iter().map(|p| f64::from(p[1])).fold(f64::MAX, f64::min);
    let stature_m = top - low;
    (100.0 * stature_m, litres * DENSITY / (stature_m * stature_m))
}

fn mean_and_spread(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    (mean, (values.map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt())
}

fn assert_close(what: &str, got: f64, published: f64, share: f64) {
    let off = got / published - 1.0;
    assert!(off.abs() < share, "{what}: {got:.3}, published {published}, {:.1} %", 100.0 * off);
}

#[test]
fn statures_and_body_mass_follow_the_published_tables() {
    for p in &PUBLISHED {
        let people = drawn(p);
        let kind = format!("{} of {}", p.sex, p.age_years);
        let (mean, spread) = mean_and_spread(people.iter().map(|p| 100.0 * p.body.stature_m));
        assert_close(&format!("{kind}: mean stature"), mean, p.stature_cm.0, 0.02);
        assert_close(&format!("{kind}: spread of stature"), spread, p.stature_cm.1, 0.1);
        let (mean, spread) = mean_and_spread(people.iter().map(|p| p.body.bmi_kg_m2));
        assert_close(&format!("{kind}: mean BMI"), mean, p.bmi.0, 0.05);
        assert_close(&format!("{kind}: spread of BMI"), spread, p.bmi.1, 0.1);
    }
}

#[test]
fn bodies_are_as_tall_and_heavy_as_they_were_drawn() {
    let figure = Figure::built_in().expect("the figure ships with the program");
    for p in &PUBLISHED {
        let people = drawn(p);
        let mut off = 0.0_f64;
        for person in &people[..MEASURED] {
            let (stature_cm, bmi) = measured(&figure, person);
            assert!((stature_cm - 100.0 * person.body.stature_m).abs() < 0.1, "{stature_cm}");
            off = off.max((bmi / person.body.bmi_kg_m2 - 1.0).abs());
        }
        assert!(off < 0.03, "{} of {}: BMI off by {:.1} %", p.sex, p.age_years, 100.0 * off);
    }
}

/// Two uniform numbers make two people differ: no stature says anything of a body mass index.
#[test]
fn body_mass_index_does_not_depend_on_stature() {
    let people = drawn(&PUBLISHED[6]);
    let (x, dx) = mean_and_spread(people.iter().map(|p| p.body.stature_m));
    let (y, dy) = mean_and_spread(people.iter().map(|p| p.body.bmi_kg_m2));
    let product = |p: &Person| (p.body.stature_m - x) / dx * (p.body.bmi_kg_m2 - y) / dy;
    let correlation = people.iter().map(product).sum::<f64>() / people.len() as f64;
    // Four standard errors of independent draws.
    assert!(correlation.abs() < 4.0 / f64::from(DRAWN).sqrt(), "{correlation}");
}
