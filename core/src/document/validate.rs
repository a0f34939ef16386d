//! Which values of a document make sense: ranges, combinations and what a frame may hold at most.
//!
//! Form is [`super::check`]'s business, the rules for single parameters are in [`rules`], those for
//! parameters that look at each other in [`links`].

use std::collections::BTreeMap;

mod cast;
mod lights;
mod links;
mod people;
mod rules;
mod view;

pub(super) use cast::problems_of_member;
use rules::{Check, Range};

use super::{
    Background, Document, Labels, Occluders, Output, Param, Placement, Problem, Quality, Scheme,
    VERSION,
};

/// People in a frame at most.
pub const MAX_PEOPLE: u32 = 500;
/// Occluders in a frame at most.
pub const MAX_OBJECTS: u32 = 10_000;
const MAX_SIDE: u32 = 16_384;
const MAX_FRAMES: u32 = 100_000_000;

const POSITION: Range = Range::from_to(-1e7, 1e7);
const ANGLE: Range = Range::from_to(-3600.0, 3600.0);
const SHARE: Range = Range::from_to(0.0, 1.0);
const LENGTH: Range = Range::above(0.0, 1e5);

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
    view::image(&mut c, &d.image);
    view::camera(&mut c, &d.camera);
    lights::lights(&mut c, &d.lights);
    background(&mut c, &d.background);
    occluders(&mut c, &d.occluders);
    people::people(&mut c, &d.people);
    c.param("materials.roughness", &d.materials.roughness, Range::from_to(0.04, 1.0));
    c.param("materials.metallic", &d.materials.metallic, SHARE);
    c.param("materials.normal_strength", &d.materials.normal_strength, Range::from_to(0.0, 10.0));
    view::post(&mut c, &d.post);
    labels(&mut c, &d.labels);
    output(&mut c, &d.output);
    quality(&mut c, &d.quality);
    c
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
