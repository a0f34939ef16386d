//! Motion blur against closed forms: what moves evenly is the box filter of what stands still.

use figurant_core::draw::abi::{End, Material, Shutter, ToneCurve};
use figurant_core::draw::{DrawList, rows};
use figurant_core::library::texture::{Encoding, Texture, color_from_srgb8};
use figurant_core::plan::{Frame, Output};
use figurant_tests::drawlists::{add, empty, view};
use figurant_tests::light::green;
use figurant_tests::meshes;
use glam::{DAffine3, DMat3, DVec3};
use std::sync::Arc;

use super::common::*;

const SIDE: usize = 160;
const FOCAL_PX: f64 = 200.0;

/// Evenly lit, without a tone curve.
fn lit() -> DrawList {
    let mut list = empty(view(SIDE as u32, SIDE as u32, FOCAL_PX as f32), 16);
    list.grade.tone_curve = ToneCurve::None;
    list.lights.sky_lux = [2.0; 3];
    list.lights.ground_lux = [2.0; 3];
    list
}

fn light(frame: &Frame) -> Vec<f64> {
    green(frame.picture.as_ref().unwrap())
}

fn shutter(longest_px: f64) -> Shutter {
    let end_from_view = DMat3::IDENTITY.to_cols_array_2d().map(|row| row.map(|v| v as f32));
    Shutter { end_from_view, longest_px: longest_px as f32 }
}

fn end(view_from_model: &DAffine3) -> Option<End> {
    Some(End { view_from_model: rows(view_from_model), palette: 0..0 })
}

fn wall(distance_m: f64) -> DAffine3 {
    facing_square(12.0, DVec3::new(0.0, 0.0, -distance_m))
}

fn stripes() -> Arc<Texture> {
    let color =
        |i: u32| color_from_srgb8(if (i % 64 / 2).is_multiple_of(2) { [210; 3] } else { [60; 3] });
    Arc::new(Texture::from_level0(6, Encoding::Color, (0..64 * 64).map(color).collect()))
}

/// A white square that goes to the right before a wall, by so many pixels until the shutter closes.
fn passing(way_px: f64, wall_color: f32) -> DrawList {
    let mut list = lit();
    add(&mut list, meshes::square(), wall(8.0), plain([wall_color; 3]));
    let at = |x_px: f64| facing_square(0.4, DVec3::new(x_px * 4.0 / FOCAL_PX, 0.0, -4.0));
    let object = add(&mut list, meshes::square(), at(0.0), plain([0.9; 3]));
    list.objects[object].end = end(&at(way_px));
    list.shutter = Some(shutter(way_px.abs()));
    list
}

/// The share of the time that something so wide, which moves by a way to both sides of the middle,
/// spends at a distance from there.
fn share_of_time(distance_px: f64, width_px: f64, way_px: f64) -> f64 {
    let from = (distance_px - width_px / 2.0).max(-way_px);
    let to = (distance_px + width_px / 2.0).min(way_px);
    (to - from).max(0.0) / (2.0 * way_px)
}

#[test]
fn what_passes_hides_what_is_behind_it_for_its_share_of_the_time() {
    for (way_px, wall_color) in [(3.0, 0.05), (6.0, 0.2), (-7.5, 0.1), (20.0, 0.1)] {
        let list = passing(way_px, wall_color);
        let still = light(&render(&DrawList { shutter: None, ..list.clone() }, &[Output::Rgb]));
        let got = light(&render(&list, &[Output::Rgb]));
        let row = 80 * SIDE;
        let (square, wall) = (still[row + 80], still[row + 10]);
        for x in 30..130 {
            let distance_px = x as f64 + 0.5 - 80.0;
            let share = share_of_time(distance_px, 20.0, way_px.abs());
            let wanted = wall + (square - wall) * share;
            let error = (got[row + x] - wanted).abs();
            // A pixel's own width is no part of the closed form.
            let tolerance = (square - wall) * (0.01 + 0.3 / way_px.abs());
            assert!(error < tolerance, "{way_px} px at {distance_px}: {} {wanted}", got[row + x]);
        }
        // Above and below it nothing moves.
        let (above, before) = (&got[60 * SIDE..61 * SIDE], &still[60 * SIDE..61 * SIDE]);
        assert_eq!(above, before, "{way_px} px");
    }
}

#[test]
fn a_picture_that_goes_as_a_whole_is_filtered_by_a_box() {
    for way_px in [2.0, 5.0, 12.0] {
        let mut list = lit();
        list.textures = vec![stripes()];
        let textured = Material { albedo_map: Some(0), base_color: [1.0; 3], ..plain([1.0; 3]) };
        let object = add(&mut list, meshes::square(), wall(8.0), textured);
        let ahead = DAffine3::from_translation(DVec3::new(way_px * 8.0 / FOCAL_PX, 0.0, 0.0));
        list.objects[object].end = end(&(ahead * wall(8.0)));
        let still = light(&render(&list, &[Output::Rgb]));
        list.shutter = Some(shutter(way_px));
        let got = light(&render(&list, &[Output::Rgb]));
        let reach = way_px as usize;
        for x in 20..140 {
            let at = 40 * SIDE + x;
            let inner: f64 = still[at + 1 - reach..at + reach].iter().sum();
            let outer = 0.5 * (still[at - reach] + still[at + reach]);
            let wanted = (inner + outer) / (2.0 * way_px);
            assert!((got[at] - wanted).abs() < 0.006, "{way_px} px at {x}: {} {wanted}", got[at]);
        }
    }
}

/// What stands before something that moves keeps its edge, and its labels are those of the sharp
/// picture.
#[test]
fn what_stands_still_stays_sharp_and_labels_know_nothing_of_it() {
    let mut list = lit();
    list.textures = vec![stripes()];
    let textured = Material { albedo_map: Some(0), base_color: [1.0; 3], ..plain([1.0; 3]) };
    let object = add(&mut list, meshes::square(), wall(8.0), textured);
    let ahead = DAffine3::from_translation(DVec3::new(0.3, 0.1, 0.0));
    list.objects[object].end = end(&(ahead * wall(8.0)));
    let post = facing_square(0.5, DVec3::new(0.0, 0.0, -3.0));
    add(&mut list, meshes::square(), post, plain([0.7; 3]));
    let labels = render(&list, LABELS);
    let still = render(&list, &[Output::Rgb]);
    list.shutter = Some(shutter(9.0));
    let all = [LABELS, &[Output::Rgb]].concat();
    let moved = render(&list, &all);
    assert_eq!(
        (&moved.object_ids, &moved.object_samples),
        (&labels.object_ids, &labels.object_samples)
    );
    let mut compared = 0;
    for y in 66..94 {
        for x in 66..94 {
            let [a, b] = [&still, &moved].map(|frame| pixel(frame, x, y)[1]);
            assert!(a.abs_diff(b) <= 1, "{x}, {y}: {a} became {b}");
            compared += 1;
        }
    }
    assert_eq!(compared, 28 * 28);
    assert_ne!(still.picture, moved.picture);
}

#[test]
fn ways_that_are_no_numbers_do_no_harm() {
    let mut list = passing(6.0, 0.2);
    // To the camera's own plane and behind it.
    for z_m in [4.0, 3.95, 5.0, 1e6] {
        let object = list.objects.last_mut().unwrap();
        let there = DAffine3::from_translation(DVec3::new(0.1, 0.0, z_m));
        object.end = end(&(there * facing_square(0.4, DVec3::new(0.0, 0.0, -4.0))));
        let got = light(&render(&list, &[Output::Rgb]));
        assert!(got.iter().all(|v| v.is_finite()) && got[80 * SIDE + 80] > 0.1, "{z_m} m");
    }
    let object = list.objects.last_mut().unwrap();
    object.end.as_mut().unwrap().view_from_model[0][3] = f32::NAN;
    assert!(try_render(&list, &[Output::Rgb], Default::default()).is_err());
}
