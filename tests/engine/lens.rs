//! Pictures through lenses: against the oracle, and the same bytes everywhere.

use std::num::NonZeroUsize;
use std::sync::Arc;

use figurant_core::base::lens::Lens;
use figurant_core::document::{file, presets};
use figurant_core::draw::abi::{PointLight, Sun};
use figurant_core::draw::{DrawError, DrawList};
use figurant_core::engine::cpu::{CpuEngine, CpuOptions, SimdChoice};
use figurant_core::job::{FrameError, FrameMaker, Studio};
use figurant_core::label::Visibility;
use figurant_core::library::Library;
use figurant_core::plan::Output;
use figurant_tests::drawlists::{add, any_lens, empty, mixed, put_lens, view};
use figurant_tests::meshes::{self, Dice};
use figurant_tests::oracle::{Oracle, sample_positions};
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::common::*;
use super::labels::compare;

/// A scene of everything that is hard for a rasteriser, through some lens.
fn seen_through_a_lens(seed: u64, samples: u32) -> DrawList {
    let mut list = mixed(seed, samples);
    any_lens(&mut Dice::new(seed + 3), &mut list);
    list
}

fn agree_with_the_oracle(samples: u32, seeds: std::ops::Range<u64>) {
    let (mut doubtful, mut all) = (0, 0);
    for seed in seeds {
        let list = seen_through_a_lens(seed, samples);
        let frame = render(&list, LABELS);
        let name =
            format!("scene {seed}, {samples} samples, {:?}", list.lens.as_ref().unwrap().lens());
        doubtful += compare(&name, &list, &frame);
        all += frame.object_ids.as_ref().unwrap().len();
    }
    println!("{doubtful} of {all} pixels in doubt");
    assert!(doubtful * 8 < all, "{doubtful} of {all} pixels in doubt: nothing was compared");
}

#[test]
fn one_sample_agrees_with_the_oracle() {
    agree_with_the_oracle(1, 700..728);
}

#[test]
fn four_samples_agree_with_the_oracle() {
    agree_with_the_oracle(4, 800..810);
}

#[test]
fn sixteen_samples_agree_with_the_oracle() {
    agree_with_the_oracle(16, 900..904);
}

/// A fisheye that sees 78 degrees off the axis, in whose plane a pixel of the corner is 23 wide.
#[test]
fn the_widest_fisheye_agrees_with_the_oracle() {
    for (seed, samples) in [(950, 1), (951, 4), (952, 4), (953, 16)] {
        let mut list = mixed(seed, samples);
        let half = f64::from(list.view.width).hypot(f64::from(list.view.height)) * 0.5 + 9.0;
        let focal_px = half / 78f64.to_radians();
        (list.view.fx, list.view.fy) = (focal_px as f32, focal_px as f32);
        put_lens(&mut list, Lens::Fisheye { k1: 0.0, k2: 0.0, k3: 0.0, k4: 0.0 }).unwrap();
        let frame = render(&list, LABELS);
        compare(&format!("scene {seed}"), &list, &frame);
    }
}

/// Lenses that do nothing show what no lens shows, but where surfaces coincide.
#[test]
fn a_lens_of_zeros_changes_nothing() {
    for (seed, samples) in [(960, 1), (961, 4), (962, 16)] {
        let mut list = mixed(seed, samples);
        let without = render(&list, LABELS);
        put_lens(&mut list, Lens::Brown { k1: 0.0, k2: 0.0, p1: 0.0, p2: 0.0, k3: 0.0 }).unwrap();
        let with = render(&list, LABELS);
        let oracle = Oracle::new(&list);
        let [a, b] = [without, with].map(|frame| frame.object_ids.unwrap());
        for i in (0..a.len()).filter(|i| a[*i] != b[*i]) {
            let (x, y) = (i % list.view.width as usize, i / list.view.width as usize);
            let doubtful = sample_positions(samples).iter().any(|p| {
                let at = |v: usize, p: i32| v as f64 + f64::from(p) / 16.0;
                oracle.sample(at(x, p[0]), at(y, p[1])).doubt
            });
            assert!(doubtful, "scene {seed}: {} instead of {} at {x}, {y}", b[i], a[i]);
        }
    }
}

/// A square round the axis, whose corners stand at 0.3 and whose sides bend inwards: of 1 - 0.2 r^2
/// is left, which is 0.964 at the corners and 0.982 in the middle of the sides.
#[test]
fn a_barrel_bends_the_sides_of_a_square() {
    let mut list = empty(view(1000, 1000, 1000.0), 1);
    add(
        &mut list,
        meshes::square(),
        facing_square(6.0, DVec3::new(0.0, 0.0, -10.0)),
        plain([0.5; 3]),
    );
    put_lens(&mut list, Lens::Brown { k1: -0.2, k2: 0.0, p1: 0.0, p2: 0.0, k3: 0.0 }).unwrap();
    let frame = render(&list, LABELS);
    let ids = frame.object_ids.unwrap();
    // The middle of the right side is at 500 + 300 * 0.982, the corner at 500 + 300 * 0.964.
    for (x, y, id) in
        [(794, 500, 1), (795, 500, 0), (788, 788, 1), (790, 790, 0), (791, 700, 1), (792, 700, 0)]
    {
        assert_eq!(ids[y * 1000 + x], id, "{x}, {y}");
    }
    let sums = frame.object_samples.unwrap()[0];
    assert_eq!((sums.min_16th, sums.max_16th), ([205 * 16 + 8; 2], [794 * 16 + 8; 2]));
}

/// A studio over a preset through a lens.
fn studio(lens: Value, fov_vertical_deg: f64) -> Studio {
    let mut value: Value =
        serde_json::from_str(presets::find("peoplesanspeople").unwrap().text).unwrap();
    value["camera"]["distortion"] = lens;
    value["camera"]["fov_vertical_deg"] = fov_vertical_deg.into();
    value["image"] = json!({"width": 256, "height": 256});
    value["output"]["outputs"] = json!(["keypoints", "box2d", "instance"]);
    let document = Arc::new(file::parse(&value.to_string()).unwrap());
    let (library, cast) = (Arc::new(Library::new(&[], 1024).unwrap()), Arc::default());
    let engine = Box::new(CpuEngine::default());
    Studio::new(document, library, cast, engine, NonZeroUsize::MIN).unwrap()
}

/// Labels through lenses hold what they hold without: a visible keypoint is on its person or right
/// beside it, where `x = K distort(R X + t)` puts it, and boxes hold masks.
#[test]
fn labels_lie_on_what_the_lens_shows() {
    let lenses = [
        (
            json!({"model": "brown", "k1": {"uniform": [-0.3, 0.2]}, "p1": 0.004, "p2": -0.003}),
            40.0,
        ),
        (json!({"model": "fisheye", "k1": {"uniform": [-0.05, 0.05]}}), 80.0),
    ];
    for (lens, fov_vertical_deg) in lenses {
        let mut studio = studio(lens, fov_vertical_deg);
        let (mut visible, mut beside) = (0, 0);
        for frame in 0..12 {
            let made = studio.make(frame).unwrap();
            let ids = made.annotations.instance_ids.as_ref().unwrap();
            let camera = &made.scene.camera;
            let lens = camera.distortion.unwrap();
            for person in &made.annotations.people {
                for point in person.keypoints.as_ref().unwrap() {
                    let [x, y, z] = point.camera_m;
                    let shown = lens.distort(DVec2::new(x, y) / z) * camera.focal_px();
                    let [px, py] = point.image_px;
                    assert!(z <= 0.0 || (shown + 128.0).distance(DVec2::new(px, py)) < 1e-9);
                    if point.reason == Visibility::Visible {
                        visible += 1;
                        let own = |dx: i64, dy: i64| {
                            let (x, y) = (px as i64 + dx, py as i64 + dy);
                            (0..256).contains(&x)
                                && (0..256).contains(&y)
                                && ids[(y * 256 + x) as usize] == person.instance
                        };
                        let near = (-2..=2).any(|dy| (-2..=2).any(|dx| own(dx, dy)));
                        assert!(near, "frame {frame}: {point:?}");
                        beside += u32::from(!own(0, 0));
                    }
                }
                let [left, top, width, height] = person.bbox.unwrap();
                for i in (0..ids.len()).filter(|i| ids[*i] == person.instance) {
                    let (x, y) = ((i % 256) as f64, (i / 256) as f64);
                    assert!(x >= left && x + 1.0 <= left + width, "frame {frame}");
                    assert!(y >= top && y + 1.0 <= top + height, "frame {frame}");
                }
            }
        }
        println!("{visible} visible keypoints, {beside} of them beside their mask");
        // People are small here, and joints lie near outlines.
        assert!(visible > 500 && beside * 15 < visible, "{visible}, {beside}");
    }
}

/// A frame whose sampled lens folds fails by name; others do not.
#[test]
fn a_lens_that_folds_fails_its_frame_and_no_other() {
    let lens = json!({"model": "brown", "k1": {"choice": [[-0.1, 1], [-2, 1]]}});
    let mut studio = studio(lens, 40.0);
    let (mut good, mut bad) = (0, 0);
    for frame in 0..24 {
        match studio.make(frame) {
            Ok(_) => good += 1,
            Err(error) => {
                bad += 1;
                assert!(matches!(error, FrameError::Draw(DrawError::Lens(_))), "{error}");
                let text = error.to_string();
                assert!(text.contains("camera.distortion") && text.contains("folds"), "{text}");
            }
        }
    }
    assert!(good > 1 && bad > 1, "{good} good, {bad} bad");
}

#[test]
fn instruction_sets_and_threads_do_not_change_a_byte() {
    for (seed, samples) in [(970, 1), (971, 4), (972, 16), (973, 4)] {
        let mut list = seen_through_a_lens(seed, samples);
        list.lights.sun =
            Some(Sun { direction_to_sun: [0.3, 0.8, 0.5], color_lux: [2.0; 3], shadow: true });
        list.lights.points = vec![PointLight {
            position: [0.5, 0.5, -2.0],
            range_m: 6.0,
            color_cd: [2.0; 3],
            radius_m: 0.05,
        }];
        let options = |simd, threads| CpuOptions { simd, threads };
        let everything = &Output::ALL;
        let first = try_render(&list, everything, options(SimdChoice::Baseline, 1)).unwrap();
        for other in [options(SimdChoice::Auto, 1), options(SimdChoice::Auto, 3)] {
            let got = try_render(&list, everything, other).unwrap();
            assert!(got == first, "scene {seed}: {other:?} differs");
        }
    }
}
