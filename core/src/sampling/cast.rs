//! People who are listed, and people as they can be listed.
//!
//! A settled person becomes the value that lists them in another config, and listed faces are held
//! against what the catalogue knows. How a listed person is completed stands with what is drawn, in
//! `body`, `look` and `outfit`; files are not read here.

use std::collections::BTreeMap;

use super::Catalogue;
use crate::document::cast::{
    FixedColor, Member, MemberBody, MemberBottom, MemberLook, MemberOuter, MemberShoes, MemberTop,
    MemberWardrobe,
};
use crate::document::{People, Problem};
use crate::scene::{Body, Headwear, Look, Outfit};

/// The pattern of cloth that has none.
pub(super) const PLAIN: &str = "none";

/// What lasts of a person, complete: listed, it gives the same person in every config. Colours and
/// patterns of clothes are those of `dyed`.
pub(super) fn member(
    name: Option<&str>,
    (body, look, outfit): (&Body, &Look, &Outfit),
    dyed: &MemberWardrobe,
    catalogue: &Catalogue,
) -> Member {
    Member {
        file: None,
        name: name.map(str::to_owned),
        body: member_body(body),
        look: member_look(look, catalogue),
        wardrobe: member_wardrobe(outfit, dyed),
    }
}

fn member_body(body: &Body) -> MemberBody {
    let Body { sex, age_years, stature_m, bmi_kg_m2, muscle, proportions, ancestry, cup, firmness } =
        *body;
    MemberBody {
        sex: Some(sex),
        age_years: Some(age_years),
        stature_m: Some(stature_m),
        bmi_kg_m2: Some(bmi_kg_m2),
        muscle: Some(muscle),
        proportions: Some(proportions),
        ancestry: Some(ancestry),
        cup: Some(cup),
        firmness: Some(firmness),
    }
}

fn member_look(look: &Look, catalogue: &Catalogue) -> MemberLook {
    let Look {
        skin_color,
        hair,
        hair_color,
        beard,
        headwear: Headwear { kind: headwear, color: headwear_color },
        glasses,
        iris_color,
        freckles,
        flush,
        face,
    } = look;
    let color = |rgb: &[f64; 3]| Some(FixedColor::from_linear(*rgb));
    let (expression, face): (BTreeMap<_, _>, BTreeMap<_, _>) =
        face.iter().cloned().partition(|(name, _)| catalogue.face_units.contains(name));
    MemberLook {
        skin: color(skin_color),
        hair: Some(*hair),
        hair_color: color(hair_color),
        beard: Some(*beard),
        headwear: Some(*headwear),
        headwear_color: color(headwear_color),
        glasses: Some(*glasses),
        iris_color: color(iris_color),
        freckles: Some(*freckles),
        flush: Some(*flush),
        face: Some(face),
        expression: Some(expression),
    }
}

/// The colours and patterns of an outfit alone.
pub(super) fn dyed(outfit: &Outfit) -> MemberWardrobe {
    let Outfit { top, bottom, outer, shoes } = outfit;
    let color = |rgb: [f64; 3]| Some(FixedColor::from_linear(rgb));
    let pattern = |id: &Option<String>| Some(id.clone().unwrap_or_else(|| PLAIN.to_owned()));
    MemberWardrobe {
        top: MemberTop {
            color: color(top.color),
            pattern: pattern(&top.texture),
            relief: pattern(&top.relief),
            finish: pattern(&top.finish),
            hue_offset_deg: Some(top.hue_offset_deg),
            ..MemberTop::default()
        },
        bottom: MemberBottom {
            color: color(bottom.color),
            pattern: pattern(&bottom.texture),
            relief: pattern(&bottom.relief),
            finish: pattern(&bottom.finish),
            hue_offset_deg: Some(bottom.hue_offset_deg),
            ..MemberBottom::default()
        },
        outer: MemberOuter {
            color: color(outer.color),
            pattern: pattern(&outer.texture),
            relief: pattern(&outer.relief),
            finish: pattern(&outer.finish),
            hue_offset_deg: Some(outer.hue_offset_deg),
            ..MemberOuter::default()
        },
        shoes: MemberShoes {
            color: color(shoes.color),
            sock_color: color(shoes.sock_color),
            ..MemberShoes::default()
        },
    }
}

fn member_wardrobe(outfit: &Outfit, dyed: &MemberWardrobe) -> MemberWardrobe {
    let Outfit { top, bottom, outer, shoes } = outfit;
    let dyed = dyed.clone();
    MemberWardrobe {
        top: MemberTop {
            kind: Some(top.kind),
            sleeve: Some(top.sleeve),
            neckline: Some(top.neckline),
            looseness_m: Some(top.looseness_m),
            ..dyed.top
        },
        bottom: MemberBottom {
            kind: Some(bottom.kind),
            length: Some(bottom.length),
            flare: Some(bottom.flare),
            looseness_m: Some(bottom.looseness_m),
            ..dyed.bottom
        },
        outer: MemberOuter {
            kind: Some(outer.kind),
            open: Some(outer.open),
            looseness_m: Some(outer.looseness_m),
            ..dyed.outer
        },
        shoes: MemberShoes { kind: Some(shoes.kind), socks: Some(shoes.socks), ..dyed.shoes },
    }
}

/// The shapes and units of listed faces and the patterns of cloth that a catalogue does not hold, and
/// files that nobody has read.
pub(super) fn check(people: &People, catalogue: &Catalogue, problems: &mut Vec<Problem>) {
    for (i, member) in people.cast.iter().enumerate() {
        if member.file.is_some() {
            let what = "the file was not read; load the config from its own file";
            problems.push(Problem::new(format!("people.cast[{i}].file"), what));
        }
        let wardrobe = &member.wardrobe;
        let (top, bottom, outer) = (&wardrobe.top, &wardrobe.bottom, &wardrobe.outer);
        let [patterns, reliefs, finishes] = [
            ("pattern", "cloth pattern", &catalogue.cloth_patterns),
            ("relief", "relief of cloth", &catalogue.cloth_reliefs),
            ("finish", "finish of cloth", &catalogue.cloth_finishes),
        ];
        let cloths = [
            ("top", &top.pattern, patterns),
            ("bottom", &bottom.pattern, patterns),
            ("outer", &outer.pattern, patterns),
            ("top", &top.relief, reliefs),
            ("bottom", &bottom.relief, reliefs),
            ("outer", &outer.relief, reliefs),
            ("top", &top.finish, finishes),
            ("bottom", &bottom.finish, finishes),
            ("outer", &outer.finish, finishes),
        ];
        for (garment, id, (field, kind, known)) in cloths {
            let Some(id) = id.as_ref().filter(|id| *id != PLAIN && !known.contains(id)) else {
                continue;
            };
            let path = format!("people.cast[{i}].wardrobe.{garment}.{field}");
            let problem = Problem::new(path, format!("there is no {kind} \"{id}\""));
            let all = known.iter().map(String::as_str).chain([PLAIN]);
            problems.push(problem.did_you_mean(id, all));
        }
        let groups = [
            ("face", &member.look.face, &catalogue.face_targets),
            ("expression", &member.look.expression, &catalogue.face_units),
        ];
        for (group, amounts, known) in groups {
            for name in amounts.iter().flat_map(BTreeMap::keys).filter(|name| !known.contains(name))
            {
                let path = format!("people.cast[{i}].look.{group}.{name}");
                let kind = if group == "face" { "shape of a face" } else { "unit of expression" };
                let problem = Problem::new(path, format!("there is no such {kind}"));
                problems.push(problem.did_you_mean(name, known.iter().map(String::as_str)));
            }
        }
    }
}
