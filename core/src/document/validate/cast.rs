//! People who are listed: which of their numbers and names make no sense.
//!
//! Each problem names the entry and its field. Files have been read before; what only the asset
//! library knows, as the names of face shapes, is checked by the sampler.

use std::collections::BTreeMap;

use super::SHARE;
use super::people::{AGE_YEARS, BMI_KG_M2, MAX_IDENTITIES, STATURE_M};
use super::rules::{Check, Range};
use crate::document::cast::{FixedColor, FixedColorOther, Member, MemberBody, MemberLook};
use crate::document::{People, Problem};

/// Letters of a name at most.
const NAME_LENGTH: usize = 64;
/// Gap between cloths, metres.
pub(super) const LOOSENESS: Range = Range::from_to(0.0, 0.1);

/// What makes no sense in a member that stands in a file of its own.
pub(in crate::document) fn problems_of_member(member: &Member) -> Vec<Problem> {
    let mut c = Check::default();
    if member.file.is_some() {
        c.report("file", "a file of people cannot name another one; list both in the config");
    }
    self::member(&mut c, "", member);
    c.problems
}

/// The whole cast, and how many people recur.
pub(super) fn cast(c: &mut Check, people: &People) {
    let listed = people.cast.len();
    if listed > MAX_IDENTITIES as usize {
        let what = format!("must hold at most {MAX_IDENTITIES} people, got {listed}");
        c.report("people.cast", what);
        return;
    }
    if let Some(count) = people.identities {
        let in_range = c.count("people.identities", count, 1, MAX_IDENTITIES);
        if in_range && (count as usize) < listed {
            let what = format!(
                "must be at least {listed}, for so many are listed in people.cast, got {count}; \
                 raise it, or write null for those people alone"
            );
            c.report("people.identities", what);
        }
    }
    let mut names = BTreeMap::new();
    for (i, listed) in people.cast.iter().enumerate() {
        let path = format!("people.cast[{i}]");
        if listed.file.as_ref().is_some_and(|file| file.trim().is_empty()) {
            c.report(&format!("{path}.file"), "must name a file, got an empty text");
        }
        member(c, &path, listed);
        if let Some(name) = &listed.name
            && let Some(other) = names.insert(name, i)
        {
            let what = format!(
                "\"{name}\" is also the name of people.cast[{other}]; give one of them another"
            );
            c.report(&format!("{path}.name"), what);
        }
    }
}

fn member(c: &mut Check, path: &str, member: &Member) {
    let at =
        |field: &str| if path.is_empty() { field.to_owned() } else { format!("{path}.{field}") };
    if let Some(name) = &member.name {
        let plain = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '-';
        if !(1..=NAME_LENGTH).contains(&name.chars().count()) || !name.chars().all(plain) {
            let what = format!(
                "must be 1 to {NAME_LENGTH} letters, digits, _ and -, got \"{}\"",
                name.chars().take(NAME_LENGTH).collect::<String>()
            );
            c.report(&at("name"), what);
        }
    }
    body(c, &at("body"), &member.body);
    look(c, &at("look"), &member.look);
    let wardrobe = &member.wardrobe;
    let (top, bottom, outer) = (&wardrobe.top, &wardrobe.bottom, &wardrobe.outer);
    let cuts = [
        ("top.sleeve", top.sleeve, SHARE),
        ("top.neckline", top.neckline, SHARE),
        ("top.looseness_m", top.looseness_m, LOOSENESS),
        ("bottom.length", bottom.length, SHARE),
        ("bottom.flare", bottom.flare, SHARE),
        ("bottom.looseness_m", bottom.looseness_m, LOOSENESS),
        ("outer.looseness_m", outer.looseness_m, LOOSENESS),
        ("shoes.socks", wardrobe.shoes.socks, SHARE),
        ("top.hue_offset_deg", top.hue_offset_deg, super::ANGLE),
        ("bottom.hue_offset_deg", bottom.hue_offset_deg, super::ANGLE),
        ("outer.hue_offset_deg", outer.hue_offset_deg, super::ANGLE),
    ];
    numbers(c, &at("wardrobe"), &cuts);
    let dyes = [
        ("top.color", top.color),
        ("bottom.color", bottom.color),
        ("outer.color", outer.color),
        ("shoes.color", wardrobe.shoes.color),
        ("shoes.sock_color", wardrobe.shoes.sock_color),
    ];
    colors(c, &at("wardrobe"), &dyes);
}

/// Numbers of a group, those that are given.
fn numbers(c: &mut Check, path: &str, all: &[(&str, Option<f64>, Range)]) {
    for (name, value, range) in all {
        if let Some(value) = value {
            c.number(&format!("{path}.{name}"), *value, *range);
        }
    }
}

/// Colours of a group, those that are given.
fn colors(c: &mut Check, path: &str, all: &[(&str, Option<FixedColor>)]) {
    for (name, color) in all {
        match color {
            None => true,
            Some(FixedColor::Srgb(rgb)) => c.numbers(&format!("{path}.{name}"), rgb, SHARE),
            Some(FixedColor::Other(FixedColorOther::Linear(rgb))) => {
                c.numbers(&format!("{path}.{name}.linear"), rgb, SHARE)
            }
        };
    }
}

fn body(c: &mut Check, path: &str, body: &MemberBody) {
    let MemberBody {
        sex: _,
        age_years,
        stature_m,
        bmi_kg_m2,
        muscle,
        proportions,
        ancestry,
        cup,
        firmness,
    } = body;
    let all = [
        ("age_years", *age_years, AGE_YEARS),
        ("stature_m", *stature_m, STATURE_M),
        ("bmi_kg_m2", *bmi_kg_m2, BMI_KG_M2),
        ("muscle", *muscle, SHARE),
        ("proportions", *proportions, SHARE),
        ("cup", *cup, SHARE),
        ("firmness", *firmness, SHARE),
    ];
    numbers(c, path, &all);
    if let Some(shares) = ancestry {
        super::people::shares(c, &format!("{path}.ancestry"), shares);
    }
}

fn look(c: &mut Check, path: &str, look: &MemberLook) {
    let all = [
        ("skin", look.skin),
        ("hair_color", look.hair_color),
        ("headwear_color", look.headwear_color),
        ("iris_color", look.iris_color),
    ];
    colors(c, path, &all);
    numbers(c, path, &[("freckles", look.freckles, SHARE), ("flush", look.flush, SHARE)]);
    for (name, amounts) in [("face", &look.face), ("expression", &look.expression)] {
        for (target, amount) in amounts.iter().flatten() {
            c.number(&format!("{path}.{name}.{target}"), *amount, SHARE);
        }
    }
}
