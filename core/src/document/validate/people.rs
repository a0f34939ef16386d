//! People: what of their bodies, looks, clothes, poses and seats makes sense. Listed people are the
//! business of [`super::cast`].

use super::rules::{Check, Range};
use super::{ANGLE, MAX_PEOPLE, SHARE, cast, placement};
use crate::document::{
    Ancestry, Auto, Body, Look, OutfitRow, Param, People, Pose, Seats, Wardrobe,
};

/// Different people at most.
pub(super) const MAX_IDENTITIES: u32 = 1_000_000;
pub(super) const AGE_YEARS: Range = Range::from_to(1.0, 90.0);
pub(super) const STATURE_M: Range = Range::from_to(0.4, 2.6);
pub(super) const BMI_KG_M2: Range = Range::from_to(10.0, 60.0);

pub(super) fn people(c: &mut Check, people: &People) {
    cast::cast(c, people);
    placement(c, "people.placement", &people.placement, MAX_PEOPLE);
    c.param("people.scale", &people.scale, Range::above(0.0, 100.0));
    c.rotation("people.rotation_deg", &people.rotation_deg);
    body(c, &people.body);
    look(c, &people.look);
    wardrobe(c, &people.wardrobe);
    pose(c, &people.pose);
    seats(c, &people.seats);
}

fn seats(c: &mut Check, seats: &Seats) {
    c.choice("people.seats.shape", &seats.shape);
    c.ids("people.seats.texture", &seats.texture);
    c.color("people.seats.color", &seats.color);
    c.param("people.seats.hue_offset_deg", &seats.hue_offset_deg, ANGLE);
}

fn pose(c: &mut Check, pose: &Pose) {
    c.ids("people.pose.clip", &pose.clip);
    c.param("people.pose.phase", &pose.phase, SHARE);
    c.flag("people.pose.mirrored", &pose.mirrored);
    c.param("people.pose.variation", &pose.variation, SHARE);
    c.ids("people.pose.blend.clip", &pose.blend.clip);
    c.param("people.pose.blend.phase", &pose.blend.phase, SHARE);
    c.param("people.pose.blend.share", &pose.blend.share, SHARE);
    if let Auto::Given(hands) = &pose.hands {
        c.choice("people.pose.hands", hands);
    }
    for (i, turn) in pose.gaze_deg.iter().enumerate() {
        c.param(&format!("people.pose.gaze_deg[{i}]"), turn, Range::from_to(-180.0, 180.0));
    }
}

fn body(c: &mut Check, body: &Body) {
    c.param("people.body.age_years", &body.age_years, AGE_YEARS);
    c.choice("people.body.sex", &body.sex);
    if let Auto::Given(stature) = &body.stature_m {
        c.param("people.body.stature_m", stature, STATURE_M);
    }
    if let Auto::Given(bmi) = &body.bmi_kg_m2 {
        c.param("people.body.bmi_kg_m2", bmi, BMI_KG_M2);
    }
    let sliders: [(&str, &Param); 4] = [
        ("people.body.muscle", &body.muscle),
        ("people.body.proportions", &body.proportions),
        ("people.body.cup", &body.cup),
        ("people.body.firmness", &body.firmness),
    ];
    for (path, slider) in sliders {
        c.param(path, slider, SHARE);
    }
    match &body.ancestry {
        Ancestry::Dirichlet(alpha) => {
            c.numbers("people.body.ancestry.dirichlet", alpha, Range::from_to(0.01, 1e3));
        }
        Ancestry::Shares(given) => {
            shares(c, "people.body.ancestry.shares", given);
        }
        Ancestry::Choice(items) => {
            c.weights("people.body.ancestry.choice", items.iter().map(|i| i.1));
        }
    }
}

/// Shares of forebears: none negative, not all 0.
pub(super) fn shares(c: &mut Check, path: &str, shares: &[f64; 3]) -> bool {
    c.numbers(path, shares, Range::from_to(0.0, 1e6))
        && (shares.iter().sum::<f64>() > 0.0 || c.report(path, "at least one share must be > 0"))
}

fn look(c: &mut Check, look: &Look) {
    let colors = [
        ("people.look.skin", &look.skin),
        ("people.look.hair_color", &look.hair_color),
        ("people.look.headwear_color", &look.headwear_color),
        ("people.look.iris_color", &look.iris_color),
    ];
    for (path, color) in colors {
        if let Auto::Given(color) = color {
            c.color(path, color);
        }
    }
    if let Auto::Given(hair) = &look.hair {
        c.choice("people.look.hair", hair);
    }
    c.flag("people.look.dyed", &look.dyed);
    if let Auto::Given(beard) = &look.beard {
        c.choice("people.look.beard", beard);
    }
    if let Auto::Given(headwear) = &look.headwear {
        c.choice("people.look.headwear", headwear);
    }
    if let Auto::Given(glasses) = &look.glasses {
        c.choice("people.look.glasses", glasses);
    }
    c.param("people.look.face_targets", &look.face_targets, Range::from_to(0.0, 100.0));
    c.number("people.look.face_std", look.face_std, SHARE);
    c.number("people.look.face_max", look.face_max, SHARE);
    let expression = &look.expression;
    let gaze = |limit_deg: f64| Range::from_to(-limit_deg, limit_deg);
    c.choice("people.look.expression.kind", &expression.kind);
    c.param("people.look.expression.strength", &expression.strength, SHARE);
    c.param("people.look.expression.gaze_yaw_deg", &expression.gaze_yaw_deg, gaze(25.0));
    c.param("people.look.expression.gaze_pitch_deg", &expression.gaze_pitch_deg, gaze(20.0));
}

fn wardrobe(c: &mut Check, wardrobe: &Wardrobe) {
    c.choice("people.wardrobe.season", &wardrobe.season);
    if let Auto::Given(rows) = &wardrobe.outfit {
        outfit_rows(c, rows);
    }
    let loose = cast::LOOSENESS;
    let (top, bottom, outer) = (&wardrobe.top, &wardrobe.bottom, &wardrobe.outer);
    let shoes = &wardrobe.shoes;
    given(&top.kind, |kind| c.choice("people.wardrobe.top.kind", kind));
    given(&bottom.kind, |kind| c.choice("people.wardrobe.bottom.kind", kind));
    given(&outer.kind, |kind| c.choice("people.wardrobe.outer.kind", kind));
    given(&shoes.kind, |kind| c.choice("people.wardrobe.shoes.kind", kind));
    let params = [
        ("people.wardrobe.top.sleeve", &top.sleeve, SHARE),
        ("people.wardrobe.top.neckline", &top.neckline, SHARE),
        ("people.wardrobe.top.looseness_m", &top.looseness_m, loose),
        ("people.wardrobe.bottom.skirt_length", &bottom.skirt_length, SHARE),
        ("people.wardrobe.bottom.looseness_m", &bottom.looseness_m, loose),
        ("people.wardrobe.outer.looseness_m", &outer.looseness_m, loose),
    ];
    for (path, param, range) in params {
        given(param, |param| c.param(path, param, range));
    }
    let cloths = [
        ("top", &top.color, [&top.pattern, &top.relief, &top.finish], &top.hue_offset_deg),
        (
            "bottom",
            &bottom.color,
            [&bottom.pattern, &bottom.relief, &bottom.finish],
            &bottom.hue_offset_deg,
        ),
        (
            "outer",
            &outer.color,
            [&outer.pattern, &outer.relief, &outer.finish],
            &outer.hue_offset_deg,
        ),
    ];
    for (name, color, [pattern, relief, finish], hue_offset_deg) in cloths {
        let at = |field: &str| format!("people.wardrobe.{name}.{field}");
        given(color, |color| c.color(&at("color"), color));
        c.ids(&at("pattern"), pattern);
        c.ids(&at("relief"), relief);
        c.ids(&at("finish"), finish);
        c.param(&at("hue_offset_deg"), hue_offset_deg, ANGLE);
    }
    c.param("people.wardrobe.bottom.trousers_length", &bottom.trousers_length, SHARE);
    c.param("people.wardrobe.bottom.shorts_length", &bottom.shorts_length, SHARE);
    c.param("people.wardrobe.bottom.flare", &bottom.flare, SHARE);
    c.flag("people.wardrobe.outer.open", &outer.open);
    c.color("people.wardrobe.shoes.color", &shoes.color);
    c.param("people.wardrobe.shoes.socks", &shoes.socks, SHARE);
    c.color("people.wardrobe.shoes.sock_color", &shoes.sock_color);
}

/// Checks what is given in place of `"auto"`.
fn given<T>(auto: &Auto<T>, check: impl FnOnce(&T) -> bool) {
    if let Auto::Given(value) = auto {
        check(value);
    }
}

fn outfit_rows(c: &mut Check, rows: &[OutfitRow]) {
    c.weights("people.wardrobe.outfit", rows.iter().map(|row| row.weight));
    for (i, row) in rows.iter().enumerate() {
        let at = |field: &str| format!("people.wardrobe.outfit[{i}].{field}");
        c.interval(&at("age_years"), row.age_years, Range::from_to(0.0, 200.0));
        c.choice(&at("top"), &row.top);
        c.choice(&at("bottom"), &row.bottom);
        c.choice(&at("outer"), &row.outer);
        c.choice(&at("shoes"), &row.shoes);
    }
}
