//! Depth of field and bloom against closed forms, and against a lens made of many pinholes.

use figurant_core::draw::DrawList;
use figurant_core::draw::abi::{Bloom, Defocus, Material, ToneCurve};
use figurant_core::library::texture::{Encoding, Texture, color_from_srgb8};
use figurant_core::plan::{Frame, Output};
use figurant_tests::drawlists::{add, empty, view};
use figurant_tests::light::{green, psnr};
use figurant_tests::meshes;
use glam::{DAffine3, DVec2, DVec3};
use std::sync::Arc;

use super::common::*;

const SIDE: u32 = 160;
const FOCAL_PX: f64 = 200.0;

/// Black, without a tone curve.
fn dark(samples: u32) -> DrawList {
    let mut list = empty(view(SIDE, SIDE, FOCAL_PX as f32), samples);
    list.grade.tone_curve = ToneCurve::None;
    list.lights.sky_lux = [0.0; 3];
    list.lights.ground_lux = [0.0; 3];
    list
}

fn light(frame: &Frame) -> Vec<f64> {
    green(frame.picture.as_ref().unwrap())
}

fn at(i: usize) -> DVec2 {
    DVec2::new((i as u32 % SIDE) as f64 + 0.5, (i as u32 / SIDE) as f64 + 0.5)
}

/// Sum of the light, its middle, and its variance along both axes.
fn moments(light: &[f64]) -> (f64, DVec2, f64) {
    let sum: f64 = light.iter().sum();
    let middle: DVec2 = light.iter().enumerate().map(|(i, v)| at(i) * *v).sum::<DVec2>() / sum;
    let variance = light.iter().enumerate().map(|(i, v)| at(i).distance_squared(middle) * v);
    (sum, middle, variance.sum::<f64>() / sum)
}

fn largest(defocus: &Defocus, distance_m: f64) -> f64 {
    let (focus_m, infinity_px) = (f64::from(defocus.focus_m), f64::from(defocus.at_infinity_px));
    infinity_px * (1.0 - focus_m / distance_m).abs()
}

/// A small square before nothing.
fn spot(distance_m: f64, size_px: f64) -> DrawList {
    let mut list = dark(16);
    let place = DVec3::new(0.0, 0.0, -distance_m);
    let white = facing_square(size_px * distance_m / FOCAL_PX, place);
    add(&mut list, meshes::square(), white, plain([0.9; 3]));
    list.lights.sky_lux = [2.0; 3];
    list.lights.ground_lux = [2.0; 3];
    list
}

/// A disk of radius r has the variance r^2 / 2; the square and the pixel add theirs.
#[test]
fn what_is_out_of_focus_becomes_a_disk_of_the_lens() {
    for (focus_m, infinity_px, distance_m) in
        [(2.0, 4.0, 8.0), (2.0, 6.0, 50.0), (3.0, 12.0, 9.0), (6.0, 3.0, 3.0), (6.0, 7.0, 2.5)]
    {
        let defocus = Defocus { focus_m, at_infinity_px: infinity_px, largest_px: 0.0 };
        let radius_px = largest(&defocus, distance_m);
        let largest_px = infinity_px.max(radius_px as f32);
        // The picture is halved until eight texels reach as far as the largest disk.
        let texel_px = f64::from(largest_px / 8.0).max(1.0).log2().ceil().exp2();
        let mut list = spot(distance_m, 5.0 * texel_px);
        let sharp = light(&render(&list, &[Output::Rgb]));
        list.defocus = Some(Defocus { largest_px, ..defocus });
        let blurred = light(&render(&list, &[Output::Rgb]));
        let ((a, _, sharp_variance), (b, middle, variance)) = (moments(&sharp), moments(&blurred));
        let case = format!("focus {focus_m} m, {distance_m} m: {radius_px:.2} px");
        // Beside what is blurred more, disks are not weighed by their areas alone.
        assert!((b / a - 1.0).abs() < 0.12, "{case}: light {a} became {b}");
        assert!(middle.distance(DVec2::splat(80.0)) < 0.05, "{case}: middle {middle}");
        let got_px = (2.0 * (variance - sharp_variance)).sqrt();
        println!("{case}: {got_px:.2} px, light {:.3}", b / a);
        // At half the size, texels at an edge have the mean of two radii.
        let tolerance_px = if texel_px > 1.0 { 0.7 * texel_px } else { 0.35 };
        assert!((got_px - radius_px).abs() < tolerance_px, "{case}: radius {got_px:.2} px");
    }
}

#[test]
fn what_is_in_focus_keeps_its_light() {
    let mut list = spot(4.0, 20.0);
    let sharp = render(&list, &[Output::Rgb]);
    list.defocus = Some(Defocus { focus_m: 4.0, at_infinity_px: 20.0, largest_px: 20.0 });
    let kept = render(&list, &[Output::Rgb]);
    let pixels = sharp.picture.iter().flatten().zip(kept.picture.iter().flatten());
    let most = pixels.map(|(a, b)| a.abs_diff(*b)).max().unwrap();
    assert!(most <= 1, "off by {most}");
}

fn checks(size: u32) -> Arc<Texture> {
    let color = |i: u32| {
        let on = (i % 64 / size + i / 64 / size).is_multiple_of(2);
        color_from_srgb8(if on { [230, 150, 60] } else { [40, 90, 160] })
    };
    Arc::new(Texture::from_level0(6, Encoding::Color, (0..64 * 64).map(color).collect()))
}

/// A wall far off, a ball in focus, and a bar near by.
fn three_distances() -> DrawList {
    let mut list = dark(16);
    list.lights.sky_lux = [2.2; 3];
    list.lights.ground_lux = [1.6; 3];
    list.textures = vec![checks(4)];
    let textured = Material { albedo_map: Some(0), base_color: [1.0; 3], ..plain([1.0; 3]) };
    let wall = facing_square(12.0, DVec3::new(0.0, 0.0, -9.0));
    add(&mut list, meshes::square(), wall, textured);
    let ball = DAffine3::from_translation(DVec3::new(0.15, 0.1, -3.0))
        * DAffine3::from_scale(DVec3::splat(0.5));
    add(&mut list, meshes::sphere(64, 32), ball, textured);
    let bar = DAffine3::from_translation(DVec3::new(-0.4, 0.0, -1.6))
        * DAffine3::from_scale(DVec3::new(0.06, 2.0, 0.02));
    add(&mut list, meshes::cuboid(), bar, plain([0.2, 0.7, 0.3]));
    list
}

/// The mean of pinholes all over a lens's opening, each looking at the plane in focus as the middle one
/// does.
fn by_many_pinholes(list: &DrawList, defocus: &Defocus) -> Vec<f64> {
    let radius_m = f64::from(defocus.at_infinity_px * defocus.focus_m) / FOCAL_PX;
    let count = 240;
    let mut sum = vec![0.0; (SIDE * SIDE) as usize];
    for i in 0..count {
        // Vogel's spiral.
        let (radius, angle) =
            (((f64::from(i) + 0.5) / f64::from(count)).sqrt(), 2.399_963 * f64::from(i));
        let eye_m = DVec2::new(angle.cos(), angle.sin()) * radius * radius_m;
        let mut seen = list.clone();
        let per_m = f64::from(list.view.fx / defocus.focus_m);
        seen.view.cx += (eye_m.x * per_m) as f32;
        seen.view.cy -= (eye_m.y * per_m) as f32;
        for object in &mut seen.objects {
            object.view_from_model[0][3] -= eye_m.x as f32;
            object.view_from_model[1][3] -= eye_m.y as f32;
        }
        let frame = render(&seen, &[Output::Rgb]);
        sum.iter_mut().zip(light(&frame)).for_each(|(sum, v)| *sum += v / f64::from(count));
    }
    sum
}

#[test]
fn blur_is_near_that_of_many_pinholes() {
    let list = three_distances();
    let sharp = light(&render(&list, &[Output::Rgb]));
    for (infinity_px, least_db) in [(2.0, 44.0), (4.5, 40.0), (9.0, 36.0)] {
        let mut list = list.clone();
        let defocus =
            Defocus { focus_m: 2.6, at_infinity_px: infinity_px, largest_px: infinity_px };
        list.defocus = Some(defocus);
        let truth = by_many_pinholes(&list, &defocus);
        let got = psnr(&light(&render(&list, &[Output::Rgb])), &truth);
        let without = psnr(&sharp, &truth);
        println!("{infinity_px} px: {got:.1} dB, without blur {without:.1} dB");
        assert!(got > least_db && got > without + 8.0, "{infinity_px}: {got:.1}, {without:.1} dB");
    }
}

#[test]
fn bloom_scatters_light_and_loses_none() {
    let mut list = spot(4.0, 6.0);
    let sharp = light(&render(&list, &[Output::Rgb]));
    // So wide that all of it falls into steps of 1/255 otherwise.
    list.exposure = 0.5;
    for (share, spread) in [(0.2, 0.3), (0.6, 0.5), (1.0, 0.6)] {
        list.grade.bloom = Some(Bloom { share, spread });
        let got = light(&render(&list, &[Output::Rgb]));
        let ((a, _, _), (b, middle, _)) = (moments(&sharp), moments(&got));
        assert!((b / (0.5 * a) - 1.0).abs() < 0.06, "{share} {spread}: {a} became {b}");
        assert!(middle.distance(DVec2::splat(80.0)) < 0.1, "{share} {spread}: {middle}");
        // The same to all sides.
        for i in 1..20 {
            let of = |x: usize, y: usize| got[y * SIDE as usize + x];
            let sides = [of(79 - i, 79), of(80 + i, 79), of(79, 79 - i), of(79, 80 + i)];
            let (low, high) =
                sides.iter().fold((f64::MAX, 0.0_f64), |(l, h), v| (l.min(*v), h.max(*v)));
            assert!(high - low <= 0.002 + 0.02 * high, "{share} {spread} at {i}: {sides:?}");
        }
    }
}

#[test]
fn even_light_stays_even_and_none_stays_none() {
    let mut list = dark(4);
    list.lights.background_nits = [0.5, 0.25, 1.0];
    let plain = render(&list, &[Output::Rgb]);
    list.grade.bloom = Some(Bloom { share: 0.7, spread: 0.8 });
    list.defocus = Some(Defocus { focus_m: 1.0, at_infinity_px: 7.0, largest_px: 7.0 });
    assert_eq!(render(&list, &[Output::Rgb]).picture, plain.picture);
    // Labels know nothing of it.
    let mut list = three_distances();
    let labels = render(&list, LABELS);
    list.defocus = Some(Defocus { focus_m: 1.0, at_infinity_px: 7.0, largest_px: 7.0 });
    let blurred = render(&list, &[Output::Rgb, Output::Box2d, Output::Instance]);
    assert_eq!(
        (blurred.object_ids, blurred.object_samples),
        (labels.object_ids, labels.object_samples)
    );
}
