//! The same bytes everywhere, odd sizes, wrong numbers and extreme places.

use figurant_core::draw::DrawList;
use figurant_core::draw::abi::{PointLight, Sun};
use figurant_core::engine::cpu::{CpuEngine, CpuOptions, SimdChoice};
use figurant_core::engine::{Engine, EngineError};
use figurant_core::library::texture::{Encoding, Texture, color_from_srgb8};
use figurant_core::plan::{Output, StageTimes};
use figurant_tests::drawlists::{add, any_defocus, any_grade, any_shutter, empty, mixed, view};
use figurant_tests::meshes::{self, Dice};
use glam::{DAffine3, DMat3, DVec3};
use std::sync::Arc;

use super::common::*;

fn lit(seed: u64, samples: u32) -> DrawList {
    let mut list = mixed(seed, samples);
    if seed % 2 == 1 {
        list.grade = any_grade(&mut Dice::new(seed));
    }
    if seed % 4 >= 2 {
        list.defocus = Some(any_defocus(&mut Dice::new(seed + 1)));
    }
    if seed % 3 == 1 {
        any_shutter(&mut Dice::new(seed + 2), &mut list);
    }
    list.lights.sun =
        Some(Sun { direction_to_sun: [0.3, 0.8, 0.5], color_lux: [2.0; 3], shadow: true });
    list.lights.points = vec![PointLight {
        position: [0.5, 0.5, -2.0],
        range_m: 6.0,
        color_cd: [2.0; 3],
        radius_m: 0.05,
    }];
    let checks = (0..64 * 64).map(|i: u32| {
        let light = (i % 64 / 8 + i / 512).is_multiple_of(2);
        color_from_srgb8(if light { [192, 208, 224] } else { [80, 64, 48] })
    });
    let mut texels: Vec<u32> = checks.collect();
    for level in 1..=6 {
        texels.resize(
            texels.len() + (1usize << (2 * (6 - level))),
            color_from_srgb8([120, 136, 144]),
        );
    }
    list.textures.push(Arc::new(Texture {
        log2_size: 6,
        encoding: Encoding::Color,
        texels: texels.into(),
    }));
    for (i, m) in list.materials.iter_mut().enumerate() {
        m.albedo_map = (i % 2 == 0).then_some(0);
        m.normal_map = (i % 3 == 0).then_some(0);
        m.finish_map = (i % 3 == 1).then_some(0);
        m.hue_offset_deg = i as f32 * 70.0;
    }
    list
}

#[test]
fn instruction_sets_and_threads_do_not_change_a_byte() {
    let everything = &Output::ALL;
    let mut kept = CpuEngine::new(CpuOptions { threads: 2, ..CpuOptions::default() });
    for (seed, samples) in [(400, 1), (401, 4), (402, 16), (403, 4), (404, 1)] {
        let list = lit(seed, samples);
        let options = |simd, threads| CpuOptions { simd, threads };
        let first = try_render(&list, everything, options(SimdChoice::Baseline, 1)).unwrap();
        for other in [
            options(SimdChoice::Auto, 1),
            options(SimdChoice::Auto, 2),
            options(SimdChoice::Baseline, 3),
        ] {
            let got = try_render(&list, everything, other).unwrap();
            assert!(got == first, "scene {seed}: {other:?} differs");
        }
        // Neither do the frames that an engine has rendered before.
        let got = kept.render(&list, &plan(everything), &mut StageTimes::default()).unwrap();
        assert!(got == first, "scene {seed}: a used engine differs");
    }
}

#[test]
fn a_plan_yields_its_buffers_and_no_others() {
    let list = lit(410, 4);
    let all = render(&list, &Output::ALL);
    for outputs in
        [&[Output::Rgb][..], &[Output::Box2d], &[Output::Instance], &[Output::Keypoints], &[]]
    {
        let frame = render(&list, outputs);
        let wants = |o: Output| outputs.contains(&o);
        assert_eq!(frame.picture, all.picture.clone().filter(|_| wants(Output::Rgb)));
        let resolves = !outputs.is_empty() && !outputs.iter().all(|o| *o == Output::Rgb);
        assert_eq!(frame.object_ids, all.object_ids.clone().filter(|_| resolves));
        assert_eq!(frame.depth_m, all.depth_m.clone().filter(|_| resolves));
        let reduces = wants(Output::Box2d);
        assert_eq!(frame.object_samples, all.object_samples.clone().filter(|_| reduces));
    }
}

#[test]
fn odd_sizes_and_empty_scenes_render() {
    for (width, height) in [(1, 1), (1, 300), (300, 1), (31, 33), (65, 64)] {
        for samples in [1, 4, 16] {
            let mut list = empty(view(width, height, 50.0), samples);
            list.lights.background_nits = [1.0; 3];
            let frame = render(&list, &Output::ALL);
            assert!(frame.object_ids.unwrap().iter().all(|id| *id == 0));
            assert_eq!(frame.object_samples.unwrap(), []);
            add(
                &mut list,
                meshes::square(),
                facing_square(1e4, DVec3::new(0.0, 0.0, -3.0)),
                plain([0.5; 3]),
            );
            let frame = render(&list, &Output::ALL);
            assert!(frame.object_ids.unwrap().iter().all(|id| *id == 1));
            assert_eq!(frame.picture.unwrap().len() as u32, width * height * 3);
            let count = u64::from(width * height * samples);
            assert_eq!(frame.object_samples.unwrap()[0].count, count);
        }
    }
}

#[test]
fn the_largest_picture_has_its_edges_in_place() {
    let mut list = empty(view(8192, 8192, 8192.0), 1);
    // From pixel 1000 to pixel 7192, 10 m away.
    let half = (7192.0 - 4096.0) / 8192.0 * 10.0;
    add(
        &mut list,
        meshes::square(),
        facing_square(2.0 * half, DVec3::new(0.0, 0.0, -10.0)),
        plain([0.5; 3]),
    );
    let sums = render(&list, &[Output::Box2d]).object_samples.unwrap()[0];
    assert_eq!(sums.count, 6192 * 6192);
    assert_eq!((sums.min_16th, sums.max_16th), ([1000 * 16 + 8; 2], [7191 * 16 + 8; 2]));
}

#[test]
fn more_triangles_than_sixteen_bits_keep_their_objects() {
    let mut list = empty(view(96, 96, 96.0), 1);
    // Two spheres of 180,000 triangles beside each other.
    for x in [-1.0, 1.0] {
        add(
            &mut list,
            meshes::sphere(300, 300),
            DAffine3::from_translation(DVec3::new(x, 0.0, -4.0)),
            plain([0.5; 3]),
        );
    }
    let ids = render(&list, LABELS).object_ids.unwrap();
    assert!((0..96 * 96).all(|i| ids[i] == 0 || (ids[i] == 1) == (i % 96 < 48)));
    assert!(ids.iter().filter(|id| **id != 0).count() > 2500);
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_name() {
    let bad = |change: &dyn Fn(&mut DrawList)| {
        let mut list = lit(420, 1);
        let square = add(
            &mut list,
            meshes::square(),
            facing_square(1.0, DVec3::new(0.0, 0.0, -3.0)),
            plain([0.5; 3]),
        );
        change(&mut list);
        let error = try_render(&list, &[Output::Rgb], CpuOptions::default()).unwrap_err();
        (error, square as u32)
    };
    let of_object = |(error, square): (EngineError, u32)| matches!(error, EngineError::NotFinite { object, .. } if object == square);
    assert!(of_object(bad(&|l| l.objects.last_mut().unwrap().view_from_model[1][2] = f32::NAN)));
    assert!(of_object(bad(&|l| {
        let mesh = Arc::make_mut(&mut l.objects.last_mut().unwrap().mesh);
        mesh.positions[2][0] = f32::INFINITY;
    })));
    for change in [
        (|l: &mut DrawList| l.exposure = f32::NAN) as fn(&mut DrawList),
        |l| l.view.fx = f32::INFINITY,
        |l| l.lights.points[0].color_cd[0] = f32::NAN,
        |l| l.materials[0].roughness = f32::NAN,
    ] {
        assert!(matches!(bad(&change).0, EngineError::NotFinite { object: u32::MAX, .. }));
    }
}

#[test]
fn draw_lists_that_contradict_themselves_are_refused() {
    for change in [
        (|l: &mut DrawList| l.samples = 3) as fn(&mut DrawList),
        |l| l.shadow_map_size = 100,
        |l| l.draws[0].material = 1000,
        |l| l.draws[0].triangles.end = 1_000_000,
        |l| l.view.width = 0,
    ] {
        let mut list = lit(430, 1);
        change(&mut list);
        let error = try_render(&list, &[Output::Rgb], CpuOptions::default()).unwrap_err();
        assert!(matches!(error, EngineError::Invalid { .. }), "{error}");
    }
    let mut list = lit(431, 1);
    list.view.height = 8193;
    let error = try_render(&list, &[Output::Rgb], CpuOptions::default()).unwrap_err();
    assert!(matches!(error, EngineError::TooLarge { limit: 8192, .. }));
}

/// Surfaces that lie where numbers run out must not panic or spoil other pixels.
#[test]
fn extreme_places_do_no_harm() {
    for scale in [1e-12, 1e-6, 1.0, 1e6, 1e15] {
        for distance in [0.100_001, 1.0, 1e4, 1e12] {
            let mut list = empty(view(48, 48, 48.0), 4);
            let turn = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.5) * scale;
            let place = DAffine3::from_mat3_translation(turn, DVec3::new(0.0, 0.0, -distance));
            add(&mut list, meshes::sphere(8, 6), place, plain([0.5; 3]));
            add(
                &mut list,
                meshes::square(),
                facing_square(0.2, DVec3::new(0.0, 0.0, -0.2)),
                plain([0.9; 3]),
            );
            list.lights.sun =
                Some(Sun { direction_to_sun: [0.3, 0.8, 0.5], color_lux: [2.0; 3], shadow: true });
            list.draws[0].double_sided = true;
            let frame = render(&list, &Output::ALL);
            let depth = frame.depth_m.unwrap();
            assert!(depth.iter().all(|d| d.is_finite()));
        }
    }
}
