//! Which values of a document make sense: ranges, combinations and what a frame may hold at most.
//!
//! Form is [`super::check`]'s business, the rules for single parameters are in [`rules`], those for
//! parameters that look at each other in [`links`].

use std::collections::BTreeMap;

mod cast;
mod links;
mod rules;

pub(super) use cast::problems_of_member;
use rules::{Check, Range};

use super::{
    Ancestry, Auto, Background, Body, Camera, Document, Environment, Image, JointRotation, Labels,
    Lights, Look, MovingLight, Occluders, OutfitRow, Output, Param, People, Placement, PointLight,
    Pose, Post, Problem, Quality, Rotation, Scheme, Seats, Sun, SunDirection, VERSION, Wardrobe,
};

/// People in a frame at most.
pub const MAX_PEOPLE: u32 = 500;
/// Different people at most.
const MAX_IDENTITIES: u32 = 1_000_000;
/// Occluders in a frame at most.
pub const MAX_OBJECTS: u32 = 10_000;
const MAX_LIGHTS: usize = 256;
const MAX_SIDE: u32 = 16_384;
const MAX_PIXELS: u64 = 64 << 20;
const MAX_FRAMES: u32 = 100_000_000;

const MIN_FOV_DEG: f64 = 0.1;
const MAX_FOV_DEG: f64 = 179.0;
const FOV_DEG: Range = Range::from_to(MIN_FOV_DEG, MAX_FOV_DEG);
/// Where the fit of the colours of glowing bodies holds.
const GLOWING_K: Range = Range::from_to(1667.0, 25_000.0);
const POSITION: Range = Range::from_to(-1e7, 1e7);
const ANGLE: Range = Range::from_to(-3600.0, 3600.0);
const SHARE: Range = Range::from_to(0.0, 1.0);
const COEFFICIENT: Range = Range::from_to(-1e3, 1e3);
const LENGTH: Range = Range::above(0.0, 1e5);
const AGE_YEARS: Range = Range::from_to(1.0, 90.0);
const STATURE_M: Range = Range::from_to(0.4, 2.6);
const BMI_KG_M2: Range = Range::from_to(10.0, 60.0);

/// Everything in a document that makes no sense, in the order of its fields.
#[must_use]
pub fn validate(document: &Document) -> Vec<Problem> {
    let Check { mut problems, params } = sections(document);
    problems.extend(links::check(&params, &document.people));
    problems
}

/// Every parameter of a document by its path; what says `"auto"` has none.
#[must_use]
pub fn params(document: &Document) -> BTreeMap<String, Param> {
    sections(document).params
}

/// Those of them that others look at.
#[must_use]
pub fn linked(document: &Document) -> BTreeMap<String, Param> {
    links::targets(&params(document))
}

/// Checks all sections, each for itself.
fn sections(document: &Document) -> Check {
    let mut c = Check::default();
    let d = document;
    if d.version != VERSION {
        c.report("version", format!("must be {VERSION}, got {}", d.version));
    }
    c.count("frames", d.frames, 1, MAX_FRAMES);
    for (i, folder) in d.assets.folders.iter().enumerate() {
        if folder.trim().is_empty() {
            c.report(&format!("assets[{i}]"), "must name a folder, got an empty text");
        }
    }
    image(&mut c, &d.image);
    camera(&mut c, &d.camera);
    lights(&mut c, &d.lights);
    background(&mut c, &d.background);
    occluders(&mut c, &d.occluders);
    people(&mut c, &d.people);
    c.param("materials.roughness", &d.materials.roughness, Range::from_to(0.04, 1.0));
    c.param("materials.metallic", &d.materials.metallic, SHARE);
    c.param("materials.normal_strength", &d.materials.normal_strength, Range::from_to(0.0, 10.0));
    post(&mut c, &d.post);
    labels(&mut c, &d.labels);
    output(&mut c, &d.output);
    quality(&mut c, &d.quality);
    c
}

fn image(c: &mut Check, image: &Image) {
    c.count("image.width", image.width, 1, MAX_SIDE);
    c.count("image.height", image.height, 1, MAX_SIDE);
    let pixels = u64::from(image.width) * u64::from(image.height);
    if pixels > MAX_PIXELS {
        let got = format!("{} x {} is {pixels}", image.width, image.height);
        c.report("image", format!("must have at most {MAX_PIXELS} pixels, {got}"));
    }
}

fn camera(c: &mut Check, camera: &Camera) {
    c.number("camera.sensor_height_mm", camera.sensor_height_mm, Range::from_to(0.1, 1e3));
    match &camera.focal_length_mm {
        None => c.param("camera.fov_vertical_deg", &camera.fov_vertical_deg, FOV_DEG),
        Some(focal_length_mm) => focal_length(c, focal_length_mm, camera.sensor_height_mm),
    };
    c.vector("camera.position_m", &camera.position_m, POSITION);
    c.vector("camera.position_offset_m", &camera.position_offset_m, POSITION);
    if let Rotation::Joint(JointRotation::Facing(_)) = &camera.rotation_deg {
        let what = "only people and occluders can face something; give Euler angles";
        c.report("camera.rotation_deg.facing", what);
    }
    c.rotation("camera.rotation_deg", &camera.rotation_deg);
    c.axes("camera.rotation_offset_deg", &camera.rotation_offset_deg, ANGLE);
    c.number("camera.near_m", camera.near_m, Range::from_to(1e-4, 1e3));
    let blur = &camera.depth_of_field;
    c.param("camera.depth_of_field.f_number", &blur.f_number, Range::from_to(0.1, 1e6));
    let focus_m = Range::from_to(1e-3, 1e9);
    c.param("camera.depth_of_field.focus_distance_m", &blur.focus_distance_m, focus_m);
    if let Some(focal_length_mm) = &blur.focal_length_mm {
        let path = "camera.depth_of_field.focal_length_mm";
        c.param(path, focal_length_mm, Range::above(0.0, 1e6));
    }
    if let Some(distortion) = &camera.distortion {
        // Whether a picture folds over depends on its size and the field of view, and is found out
        // frame by frame.
        for (name, coefficient) in distortion.coefficients() {
            c.param(&format!("camera.distortion.{name}"), coefficient, COEFFICIENT);
        }
    }
}

/// A focal length whose angle is one that a camera may have.
fn focal_length(c: &mut Check, focal_length_mm: &Param, sensor_height_mm: f64) -> bool {
    let path = "camera.focal_length_mm";
    if !c.param(path, focal_length_mm, Range::above(0.0, 1e6)) {
        return false;
    }
    let (shortest, longest) = focal_length_mm.bounds();
    let fov_deg = |f: f64| 2.0 * libm::atan2(0.5 * sensor_height_mm, f).to_degrees();
    // The file has not been read yet where the bounds are infinite.
    let fault = [shortest, longest].into_iter().find(|f| {
        let fov_deg = fov_deg(*f);
        f.is_finite() && !(MIN_FOV_DEG..=MAX_FOV_DEG).contains(&fov_deg)
    });
    fault.is_none_or(|f| {
        let what = format!(
            "{f} mm on {sensor_height_mm} mm give {:.3} degrees, must be {MIN_FOV_DEG} to {MAX_FOV_DEG}",
            fov_deg(f)
        );
        c.report(path, what)
    })
}

fn lights(c: &mut Check, lights: &Lights) {
    sun(c, &lights.sun);
    if lights.points.len() > MAX_LIGHTS {
        let got = lights.points.len();
        c.report("lights.points", format!("must hold at most {MAX_LIGHTS} lamps, got {got}"));
    }
    for (i, lamp) in lights.points.iter().enumerate() {
        let PointLight {
            enabled: _,
            on,
            position_m,
            intensity_cd,
            color,
            temperature_k,
            range_m,
            radius_m,
        } = lamp;
        let path = format!("lights.points[{i}]");
        c.flag(&format!("{path}.on"), on);
        c.vector(&format!("{path}.position_m"), position_m, POSITION);
        c.param(&format!("{path}.intensity_cd"), intensity_cd, Range::from_to(0.0, 1e9));
        c.color(&format!("{path}.color"), color);
        glowing(c, &path, temperature_k.as_ref());
        reach(c, &path, *range_m, *radius_m);
    }
    let moving: &MovingLight = &lights.moving;
    c.flag("lights.moving.on", &moving.on);
    c.vector("lights.moving.position_m", &moving.position_m, POSITION);
    c.vector("lights.moving.position_offset_m", &moving.position_offset_m, POSITION);
    c.param("lights.moving.intensity_cd", &moving.intensity_cd, Range::from_to(0.0, 1e9));
    c.color("lights.moving.color", &moving.color);
    glowing(c, "lights.moving", moving.temperature_k.as_ref());
    reach(c, "lights.moving", moving.range_m, moving.radius_m);
    environment(c, &lights.environment);
}

fn glowing(c: &mut Check, path: &str, temperature_k: Option<&Param>) {
    if let Some(temperature_k) = temperature_k {
        c.param(&format!("{path}.temperature_k"), temperature_k, GLOWING_K);
    }
}

fn reach(c: &mut Check, path: &str, range_m: f64, radius_m: f64) {
    c.number(&format!("{path}.range_m"), range_m, Range::above(0.0, 1e6));
    c.number(&format!("{path}.radius_m"), radius_m, Range::above(0.0, 1e3));
    if radius_m >= range_m && range_m > 0.0 {
        let message = format!("must be smaller than range_m ({range_m}), got {radius_m}");
        c.report(&format!("{path}.radius_m"), message);
    }
}

fn sun(c: &mut Check, sun: &Sun) {
    match &sun.direction {
        SunDirection::Clock(clock) => {
            c.param("lights.sun.direction.hour", &clock.hour, Range::from_to(0.0, 24.0));
            let day = Range::from_to(0.0, 366.0);
            c.param("lights.sun.direction.day_of_year", &clock.day_of_year, day);
            let latitude = Range::from_to(-90.0, 90.0);
            c.param("lights.sun.direction.latitude_deg", &clock.latitude_deg, latitude);
        }
        SunDirection::Angles(angles) => {
            c.param("lights.sun.direction.azimuth_deg", &angles.azimuth_deg, ANGLE);
            let elevation = Range::from_to(-90.0, 90.0);
            c.param("lights.sun.direction.elevation_deg", &angles.elevation_deg, elevation);
        }
    }
    c.param("lights.sun.illuminance_lux", &sun.illuminance_lux, Range::from_to(0.0, 1e7));
    c.color("lights.sun.color", &sun.color);
    glowing(c, "lights.sun", sun.temperature_k.as_ref());
}

fn environment(c: &mut Check, environment: &Environment) {
    let amount = Range::from_to(0.0, 1e7);
    c.param("lights.environment.sky_lux", &environment.sky_lux, amount);
    c.color("lights.environment.sky_color", &environment.sky_color);
    c.param("lights.environment.ground_lux", &environment.ground_lux, amount);
    c.color("lights.environment.ground_color", &environment.ground_color);
    c.param("lights.environment.background_nits", &environment.background_nits, amount);
    c.color("lights.environment.background_color", &environment.background_color);
    let image = &environment.image;
    c.ids("lights.environment.image.source", &image.source);
    c.param("lights.environment.image.rotation_deg", &image.rotation_deg, ANGLE);
    c.param("lights.environment.image.illuminance_lux", &image.illuminance_lux, amount);
    let turbidity = Range::from_to(1.7, 10.0);
    c.param("lights.environment.image.sky.turbidity", &image.sky.turbidity, turbidity);
    let cover = Range::from_to(0.0, 1.0);
    c.param("lights.environment.image.sky.cloud_cover", &image.sky.cloud_cover, cover);
}

fn background(c: &mut Check, background: &Background) {
    let wall = &background.wall;
    c.vector("background.wall.position_m", &wall.position_m, POSITION);
    c.numbers("background.wall.size_m", &wall.size_m, LENGTH);
    c.ids("background.wall.texture", &wall.texture);
    c.color("background.wall.color", &wall.color);
    c.param("background.wall.hue_offset_deg", &wall.hue_offset_deg, ANGLE);
    c.numbers("background.wall.uv_repeat", &wall.uv_repeat, Range::above(0.0, 1e4));
    let floor = &background.floor;
    c.vector("background.floor.position_m", &floor.position_m, POSITION);
    c.numbers("background.floor.size_m", &floor.size_m, LENGTH);
    c.ids("background.floor.texture", &floor.texture);
    c.color("background.floor.color", &floor.color);
    c.param("background.floor.hue_offset_deg", &floor.hue_offset_deg, ANGLE);
    c.numbers("background.floor.uv_repeat", &floor.uv_repeat, Range::above(0.0, 1e4));
}

fn occluders(c: &mut Check, occluders: &Occluders) {
    placement(c, "occluders.placement", &occluders.placement, MAX_OBJECTS);
    c.param("occluders.scale", &occluders.scale, Range::above(0.0, 1e4));
    c.rotation("occluders.rotation_deg", &occluders.rotation_deg);
    c.choice("occluders.shape", &occluders.shape);
    c.ids("occluders.texture", &occluders.texture);
    c.color("occluders.color", &occluders.color);
    c.param("occluders.hue_offset_deg", &occluders.hue_offset_deg, ANGLE);
    c.numbers("occluders.uv_repeat", &occluders.uv_repeat, Range::above(0.0, 1e4));
}

/// The most points at a distance `separation` from each other whose discs' centres lie in a
/// rectangle: hexagonal packing over the rectangle grown by half a separation (Groemer's bound).
fn most_points(width: f64, height: f64, separation: f64) -> f64 {
    let (w, h) = (width / separation, height / separation);
    2.0 / 3f64.sqrt() * w * h + w + h + 1.0
}

fn placement(c: &mut Check, path: &str, placement: &Placement, limit: u32) {
    let at = |field: &str| format!("{path}.{field}");
    match placement {
        Placement::PoissonDisk(disk) => {
            let area = c.interval(&at("x_m"), disk.x_m, POSITION)
                & c.interval(&at("y_m"), disk.y_m, POSITION);
            c.param(&at("depth_m"), &disk.depth_m, POSITION);
            if let Some(count) = &disk.count {
                c.param(&at("count"), count, Range::from_to(0.0, f64::from(limit)));
            }
            c.number(&at("in_view"), disk.in_view, SHARE);
            if c.number(&at("separation_m"), disk.separation_m, Range::above(0.0, 1e6)) && area {
                let (w, h) = (disk.x_m[1] - disk.x_m[0], disk.y_m[1] - disk.y_m[0]);
                let most = most_points(w, h, disk.separation_m);
                if most > f64::from(limit) {
                    let what = format!(
                        "{} lets up to {most:.0} fit into {w} x {h} m, at most {limit} may; make it larger",
                        disk.separation_m
                    );
                    c.report(&at("separation_m"), what);
                }
            }
        }
        Placement::Ground(ground) => {
            let area = c.interval(&at("x_m"), ground.x_m, POSITION)
                & c.interval(&at("z_m"), ground.z_m, POSITION);
            c.number(&at("y_m"), ground.y_m, POSITION);
            c.number(&at("in_view"), ground.in_view, SHARE);
            let count = c.param(&at("count"), &ground.count, Range::from_to(0.0, f64::from(limit)));
            let separation =
                c.number(&at("separation_m"), ground.separation_m, Range::from_to(0.0, 1e6));
            if area && count && separation && ground.separation_m > 0.0 {
                let (w, d) = (ground.x_m[1] - ground.x_m[0], ground.z_m[1] - ground.z_m[0]);
                let most = most_points(w, d, ground.separation_m).floor();
                let least = ground.count.bounds().0;
                if least > most {
                    let what = format!(
                        "is at least {least}, but at separation_m {} only {most} fit into {w} x {d} m",
                        ground.separation_m
                    );
                    c.report(&at("count"), what);
                }
            }
        }
        Placement::Row(row) => {
            c.count(&at("count"), row.count, 1, limit);
            c.number(&at("spacing_m"), row.spacing_m, Range::above(0.0, 1e5));
            c.numbers(&at("center_m"), &row.center_m, POSITION);
        }
        Placement::Grid(grid) => {
            c.count(&at("columns"), grid.columns, 1, limit);
            c.count(&at("rows"), grid.rows, 1, limit);
            let all = u64::from(grid.columns) * u64::from(grid.rows);
            if all > u64::from(limit) {
                c.report(path, format!("columns times rows must be at most {limit}, got {all}"));
            }
            c.numbers(&at("spacing_m"), &grid.spacing_m, Range::above(0.0, 1e5));
            c.numbers(&at("center_m"), &grid.center_m, POSITION);
        }
    }
}

fn people(c: &mut Check, people: &People) {
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
fn shares(c: &mut Check, path: &str, shares: &[f64; 3]) -> bool {
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

fn post(c: &mut Check, post: &Post) {
    c.param("post.exposure_ev", &post.exposure_ev, Range::from_to(-20.0, 40.0));
    c.param("post.compensation_ev", &post.compensation_ev, Range::from_to(-20.0, 20.0));
    c.param("post.bloom", &post.bloom, Range::from_to(0.0, 1.0));
    c.param("post.bloom_scatter", &post.bloom_scatter, Range::from_to(0.0, 1.0));
    c.param("post.vignette", &post.vignette, Range::from_to(0.0, 1.0));
    c.param("post.shot_noise", &post.shot_noise, SHARE);
    c.param("post.read_noise", &post.read_noise, SHARE);
    let both_ways = [
        ("post.white_balance_temperature", &post.white_balance_temperature),
        ("post.white_balance_tint", &post.white_balance_tint),
        ("post.contrast", &post.contrast),
        ("post.saturation", &post.saturation),
    ];
    for (path, param) in both_ways {
        c.param(path, param, Range::from_to(-100.0, 100.0));
    }
    c.param("post.grain", &post.grain, Range::from_to(0.0, 1.0));
}

fn labels(c: &mut Check, labels: &Labels) {
    if ![1, 4, 16].contains(&labels.samples) {
        c.report("labels.samples", format!("must be 1, 4 or 16, got {}", labels.samples));
    }
    let later = match labels.scheme {
        Scheme::Visible => return,
        Scheme::VisibleAndOccluded => "visible_and_occluded",
        Scheme::All => "all",
    };
    c.report("labels.scheme", format!("\"{later}\" is not available yet; use \"visible\""));
}

fn output(c: &mut Check, output: &Output) {
    if output.outputs.is_empty() {
        c.report("output.outputs", "must name at least one output, such as \"rgb\"");
    }
    c.param("output.jpeg_quality", &output.jpeg_quality, Range::from_to(1.0, 100.0));
}

fn quality(c: &mut Check, quality: &Quality) {
    let size = quality.shadow_map_size;
    if c.count("quality.shadow_map_size", size, 64, MAX_SIDE) && !size.is_multiple_of(64) {
        c.report("quality.shadow_map_size", format!("must be a multiple of 64, got {size}"));
    }
    c.number("quality.lod_error_px", quality.lod_error_px, Range::from_to(0.0, 100.0));
    let size = quality.max_texture_size;
    if c.count("quality.max_texture_size", size, 1, 8192) && !size.is_power_of_two() {
        c.report("quality.max_texture_size", format!("must be a power of two, got {size}"));
    }
}

#[cfg(test)]
mod tests;
