//! Randomizers of where things stand, how large they are, how they are turned and what they wear.
//!
//! Scenarios are left-handed: x is mirrored here, and angles about y and z change their sign.

use super::fields::Fields;
use super::law::{Law, tidy};
use crate::document::{
    Choice, Color, ColorLaw, Distribution, Document, Param, Placement, PoissonDisk, Rotation,
};

/// The fields of the config that a placement goes to.
struct Names {
    x: &'static str,
    y: &'static str,
    depth: &'static str,
    separation: &'static str,
}

const OCCLUDERS: Names = Names {
    x: "occluders.placement.x_m",
    y: "occluders.placement.y_m",
    depth: "occluders.placement.depth_m",
    separation: "occluders.placement.separation_m",
};

const PEOPLE: Names = Names {
    x: "people.placement.x_m",
    y: "people.placement.y_m",
    depth: "people.placement.depth_m",
    separation: "people.placement.separation_m",
};

/// The seed's pattern, which every import begins with.
fn disk(placement: &mut Placement) -> Option<&mut PoissonDisk> {
    match placement {
        Placement::PoissonDisk(disk) => Some(disk),
        Placement::Ground(_) | Placement::Row(_) | Placement::Grid(_) => None,
    }
}

pub(super) fn seeds_occluders(fields: &mut Fields<'_>, document: &mut Document) {
    document.occluders.enabled = true;
    seeds_placement(fields, &mut document.occluders.placement, &OCCLUDERS);
}

pub(super) fn no_occluders(document: &mut Document) {
    document.occluders.enabled = false;
}

pub(super) fn seeds_people(fields: &mut Fields<'_>, document: &mut Document) {
    document.people.enabled = true;
    seeds_placement(fields, &mut document.people.placement, &PEOPLE);
}

pub(super) fn nobody(document: &mut Document) {
    document.people.enabled = false;
}

fn seeds_placement(fields: &mut Fields<'_>, placement: &mut Placement, names: &Names) {
    let Some(disk) = disk(placement) else { return };
    let [min_x, max_x] = [disk.x_m[1], disk.x_m[0]].map(|x| 0.0 - x);
    let min_x = fields.number("minX", names.x).unwrap_or(min_x);
    let max_x = fields.number("maxX", names.x).unwrap_or(max_x);
    disk.x_m = [max_x, min_x].map(|x| 0.0 - x);
    disk.y_m[0] = fields.number("minY", names.y).unwrap_or(disk.y_m[0]);
    disk.y_m[1] = fields.number("maxY", names.y).unwrap_or(disk.y_m[1]);
    if let Some(depth) = fields.law("depth", names.depth) {
        disk.depth_m = depth.param();
    }
    if let Some(separation) = fields.number("separationDistance", names.separation) {
        disk.separation_m = separation;
    }
}

const AREA: &str = "the area of the placement is not in the file: x and y from -7.5 to 7.5 m, as \
    in PeopleSansPeople, are kept";

/// Unity Perception's foreground: one layer.
pub(super) fn foreground(fields: &mut Fields<'_>, document: &mut Document) {
    document.people.enabled = true;
    fields.note(format!("places people; {AREA}"));
    let Some(disk) = disk(&mut document.people.placement) else { return };
    // Its own defaults, not the seed's.
    disk.depth_m = fields.law("depth", PEOPLE.depth).map_or(Param::Constant(0.0), |d| d.param());
    disk.separation_m = fields.number("separationDistance", PEOPLE.separation).unwrap_or(2.0);
}

/// Unity Perception's background: layers, each a pattern of its own.
pub(super) fn background(fields: &mut Fields<'_>, document: &mut Document) {
    document.occluders.enabled = true;
    fields.note(format!("places occluders; {AREA}"));
    let Some(disk) = disk(&mut document.occluders.placement) else { return };
    let depth = fields.number("depth", OCCLUDERS.depth).unwrap_or(0.0);
    let separation = fields.number("separationDistance", OCCLUDERS.separation).unwrap_or(2.0);
    let layers = fields.number("layerCount", OCCLUDERS.depth).unwrap_or(2.0);
    if layers.fract() != 0.0 || !(0.0..=1000.0).contains(&layers) {
        let message = format!("must be a whole number from 0 to 1000, got {layers}");
        return fields.problem("layerCount", message);
    }
    if layers == 0.0 {
        return no_occluders(document);
    }
    let z: Vec<(f64, f64)> =
        (0..layers as u32).map(|i| (tidy(separation * f64::from(i) + depth), 1.0)).collect();
    disk.separation_m = tidy(separation / layers.sqrt());
    disk.depth_m = match z.as_slice() {
        [(z, _)] => Param::Constant(*z),
        _ => {
            fields.note(format!(
                "{layers} layers become one pattern {} m apart, as many objects, with the layers' \
                 depths by turns of chance",
                disk.separation_m
            ));
            Param::Random(Distribution::Choice(z))
        }
    };
}

/// The seed's placement that nothing uses.
pub(super) fn normal_placement(fields: &mut Fields<'_>, _: &mut Document) {
    fields.note(
        "has no counterpart: positions by a normal law are left out, people.placement keeps its \
         pattern",
    );
}

pub(super) fn nothing(_: &mut Document) {}

pub(super) fn occluder_scale(fields: &mut Fields<'_>, document: &mut Document) {
    if let Some(scale) = fields.law("scale", "occluders.scale") {
        document.occluders.scale = scale.param();
    }
}

/// The scale of the seed's prefabs.
pub(super) fn occluder_scale_off(document: &mut Document) {
    document.occluders.scale = Param::Constant(10.0);
}

pub(super) fn people_scale(fields: &mut Fields<'_>, document: &mut Document) {
    if let Some(scale) = fields.law("scale", "people.scale") {
        document.people.scale = scale.param();
    }
}

pub(super) fn people_scale_off(document: &mut Document) {
    document.people.scale = Param::Constant(1.0);
}

pub(super) fn occluder_rotation(fields: &mut Fields<'_>, document: &mut Document) {
    turn(fields, &mut document.occluders.rotation_deg, "occluders.rotation_deg");
}

pub(super) fn occluder_rotation_off(document: &mut Document) {
    document.occluders.rotation_deg = Rotation::NONE;
}

pub(super) fn people_rotation(fields: &mut Fields<'_>, document: &mut Document) {
    turn(fields, &mut document.people.rotation_deg, "people.rotation_deg");
}

/// The seed's people carry the tags of both rotations: without their own, the other one turns them.
pub(super) fn people_rotation_off(document: &mut Document) {
    document.people.rotation_deg = document.occluders.rotation_deg.clone();
}

fn turn(fields: &mut Fields<'_>, rotation: &mut Rotation, ours: &'static str) {
    let Rotation::Euler([x, y, z]) = rotation else { return };
    let [of_x, of_y, of_z] = fields.laws("rotation", ["x", "y", "z"], ours);
    if let Some(law) = of_x {
        *x = law.param();
    }
    for (angle, law) in [(y, of_y), (z, of_z)] {
        if let Some(law) = law {
            *angle = law.opposite_angle().param();
        }
    }
}

pub(super) fn texture(fields: &mut Fields<'_>, document: &mut Document) {
    fields.left_out("texture", "lists of textures are not taken over: give `assets` a folder");
    let any = || Choice::Always("any".to_owned());
    (document.background.wall.texture, document.occluders.texture) = (any(), any());
}

pub(super) fn texture_off(document: &mut Document) {
    let none = || Choice::Always("none".to_owned());
    (document.background.wall.texture, document.occluders.texture) = (none(), none());
}

pub(super) fn hue(fields: &mut Fields<'_>, document: &mut Document) {
    fields.shared("hueOffset", "background.wall.hue_offset_deg");
    if let Some(law) = fields.law("hueOffset", "occluders.hue_offset_deg") {
        document.background.wall.hue_offset_deg = law.param();
        document.occluders.hue_offset_deg = law.param();
    }
}

pub(super) fn hue_off(document: &mut Document) {
    document.background.wall.hue_offset_deg = Param::Constant(0.0);
    document.occluders.hue_offset_deg = Param::Constant(0.0);
}

/// Unity Perception's colours, hue 0 to 1, on all that has a texture or a hue offset in the seed.
pub(super) fn color(fields: &mut Fields<'_>, document: &mut Document) {
    fields.note("colours wall and occluders: which objects it is for is not in the file");
    let parts = ["hue", "saturation", "value"];
    fields.shared("colorParameter", "background.wall.color");
    let [hue, saturation, value] = fields.color("colorParameter", parts, "occluders.color");
    // Its own defaults: any hue, full saturation and value.
    let hue = hue.unwrap_or(Law::Uniform(0.0, 1.0)).mapped(360.0, 0.0);
    let [saturation, value] = [saturation, value].map(|l| l.unwrap_or(Law::Constant(1.0)));
    let hsv = ColorLaw::Hsv([hue, saturation, value].map(|law| law.param()));
    document.background.wall.color = Color::Other(hsv.clone());
    document.occluders.color = Color::Other(hsv);
}

pub(super) fn pose(_: &mut Fields<'_>, document: &mut Document) {
    document.people.pose.enabled = true;
}

pub(super) fn pose_off(document: &mut Document) {
    document.people.pose.enabled = false;
}

pub(super) fn clothes(fields: &mut Fields<'_>, document: &mut Document) {
    let why = "PeopleSansPeople never reads it: it draws hues from 0 to 360 degrees, as here";
    fields.left_out("hueTop", why);
    fields.left_out("hueBottom", why);
    let wardrobe = &mut document.people.wardrobe;
    wardrobe.top.hue_offset_deg = Param::uniform(0.0, 360.0);
    wardrobe.bottom.hue_offset_deg = Param::uniform(0.0, 360.0);
}

pub(super) fn clothes_off(document: &mut Document) {
    document.people.wardrobe.top.hue_offset_deg = Param::Constant(0.0);
    document.people.wardrobe.bottom.hue_offset_deg = Param::Constant(0.0);
}
