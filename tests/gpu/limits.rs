//! Odd sizes, wrong numbers, small limits and a device that goes away.

use figurant_core::base::lens::Lens;
use figurant_core::draw::DrawList;
use figurant_core::engine::gpu::{GpuEngine, GpuError, GpuOptions};
use figurant_core::engine::{Engine, EngineError};
use figurant_core::plan::{Output, StageTimes};
use figurant_tests::crowd::crowd;
use figurant_tests::drawlists::{add, empty, mixed, put_lens, view};
use figurant_tests::meshes;
use glam::{DAffine3, DVec3};
use std::sync::Arc;

use super::common::*;

/// A square of side `size` that faces the camera.
fn facing_square(size: f64, position: DVec3) -> DAffine3 {
    DAffine3::from_translation(position) * DAffine3::from_scale(DVec3::splat(size * 0.5))
}

fn with_square(list: &mut DrawList, size: f64, distance: f64) {
    let place = facing_square(size, DVec3::new(0.0, 0.0, -distance));
    add(list, meshes::square(), place, Default::default());
}

#[test]
fn odd_sizes_and_empty_scenes_render() {
    let Some(mut engine) = engine() else { return };
    for (width, height) in [(1, 1), (1, 300), (300, 1), (16, 16), (31, 33), (65, 64)] {
        for samples in [1, 4, 16] {
            let mut list = empty(view(width, height, 50.0), samples);
            list.lights.background_nits = [1.0; 3];
            let frame = by_gpu(&mut engine, &list, &Output::ALL);
            assert!(frame == by_cpu(&list, &Output::ALL), "{width}x{height}, {samples} samples");
            with_square(&mut list, 1e4, 3.0);
            let frame = by_gpu(&mut engine, &list, &Output::ALL);
            assert!(frame.object_ids.unwrap().iter().all(|id| *id == 1));
            assert_eq!(frame.picture.unwrap().len() as u32, width * height * 3);
            let count = u64::from(width * height * samples);
            assert_eq!(frame.object_samples.unwrap()[0].count, count);
        }
    }
}

#[test]
fn a_plan_yields_its_buffers_and_no_others() {
    let Some(mut engine) = engine() else { return };
    let list = mixed(410, 4);
    let all = by_gpu(&mut engine, &list, &Output::ALL);
    for outputs in
        [&[Output::Rgb][..], &[Output::Box2d], &[Output::Instance], &[Output::Keypoints], &[]]
    {
        let frame = by_gpu(&mut engine, &list, outputs);
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
fn the_largest_picture_has_its_edges_in_place() {
    let Some(options) = options() else { return };
    // In bands, as its samples do not fit the smallest binding that there may be.
    let mut engine = GpuEngine::new(GpuOptions { minimum_limits: true, ..options }).unwrap();
    let mut list = empty(view(8192, 8192, 8192.0), 1);
    let half = (7192.0 - 4096.0) / 8192.0 * 10.0;
    with_square(&mut list, 2.0 * half, 10.0);
    let frame = by_gpu(&mut engine, &list, &[Output::Box2d]);
    let sums = frame.object_samples.unwrap()[0];
    assert_eq!(sums.count, 6192 * 6192);
    assert_eq!((sums.min_16th, sums.max_16th), ([1000 * 16 + 8; 2], [7191 * 16 + 8; 2]));
    let ids = frame.object_ids.unwrap();
    for (x, y, id) in [(999, 5000, 0), (1000, 5000, 1), (7191, 1000, 1), (4096, 7192, 0)] {
        assert_eq!(ids[y * 8192 + x], id, "{x},{y}");
    }
}

/// A band's tables take the places of those of the band before, and of another frame.
#[test]
fn a_lens_in_bands_shows_what_it_shows_at_once() {
    let Some(options) = options() else { return };
    let mut engine = GpuEngine::new(GpuOptions { minimum_limits: true, ..options }).unwrap();
    let mut list = empty(view(3000, 2600, 2600.0), 4);
    with_square(&mut list, 6.0, 8.0);
    let barrel = Lens::Brown { k1: -0.2, k2: 0.03, p1: 0.001, p2: 0.0, k3: 0.0 };
    put_lens(&mut list, barrel).unwrap();
    for _ in 0..2 {
        let outputs = &[Output::Box2d, Output::Instance];
        let (cpu, gpu) = (by_cpu(&list, outputs), by_gpu(&mut engine, &list, outputs));
        assert!(cpu.object_ids == gpu.object_ids);
        assert_eq!(cpu.object_samples, gpu.object_samples);
    }
}

#[test]
fn a_frame_that_every_device_must_render_renders_with_the_least_limits() {
    let Some(options) = options() else { return };
    let mut least = GpuEngine::new(GpuOptions { minimum_limits: true, ..options.clone() }).unwrap();
    let mut own = GpuEngine::new(options).unwrap();
    let list = crowd(640, 640, 4, 3000);
    let frame = by_gpu(&mut least, &list, &Output::ALL);
    assert!(frame == by_gpu(&mut own, &list, &Output::ALL));
    // A sun's map of 256 MiB is more than they allow.
    let list = DrawList { shadow_map_size: 8192, ..list };
    let refused = least.render(&list, &plan(&Output::ALL), &mut StageTimes::default());
    let error = refused.unwrap_err();
    assert!(matches!(error, EngineError::TooLarge { .. }), "{error}");
    assert!(error.to_string().contains("shadow map"), "{error}");
    // And it goes on afterwards.
    let list = DrawList { shadow_map_size: 1024, ..list };
    assert!(by_gpu(&mut least, &list, &Output::ALL).picture.is_some());
}

#[test]
fn frames_do_not_depend_on_those_before() {
    let Some(mut used) = engine() else { return };
    for (seed, samples) in [(400, 1), (401, 4), (402, 16), (403, 4), (404, 1)] {
        let list = mixed(seed, samples);
        let mut new = engine().unwrap();
        let (a, b) =
            (by_gpu(&mut used, &list, &Output::ALL), by_gpu(&mut new, &list, &Output::ALL));
        assert!(a == b, "scene {seed}: a used engine differs");
        assert!(a == by_gpu(&mut used, &list, &Output::ALL), "scene {seed}: not the same twice");
    }
}

#[test]
fn a_lost_device_is_opened_again() {
    let Some(mut engine) = engine() else { return };
    let list = mixed(410, 4);
    let before = by_gpu(&mut engine, &list, &Output::ALL);
    for _ in 0..2 {
        engine.lose_device();
        assert!(by_gpu(&mut engine, &list, &Output::ALL) == before);
    }
}

#[test]
fn unknown_adapters_are_named_with_what_there_is() {
    let Some(options) = options() else { return };
    let known = options.adapter.unwrap();
    let wrong = GpuOptions { adapter: Some("Voodoo 2".to_owned()), ..GpuOptions::default() };
    let error = GpuEngine::new(wrong).err().unwrap();
    assert!(matches!(error, GpuError::UnknownAdapter { .. }), "{error}");
    assert!(error.to_string().contains("Voodoo 2") && error.to_string().contains(&known));
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_name() {
    let Some(mut engine) = engine() else { return };
    let mut list = mixed(420, 1);
    with_square(&mut list, 1.0, 3.0);
    let square = list.objects.len() as u32 - 1;
    let mut refused = |list: &DrawList| {
        engine.render(list, &plan(&[Output::Rgb]), &mut StageTimes::default()).unwrap_err()
    };
    Arc::make_mut(&mut list.objects.last_mut().unwrap().mesh).positions[2][0] = f32::INFINITY;
    let error = refused(&list);
    assert!(matches!(error, EngineError::NotFinite { object, .. } if object == square), "{error}");
}

/// Surfaces that lie where numbers run out must not panic or spoil other pixels.
#[test]
fn extreme_places_do_no_harm() {
    let Some(mut engine) = engine() else { return };
    for scale in [1e-12, 1e-6, 1.0, 1e6, 1e15] {
        for distance in [0.100_001, 1.0, 1e4, 1e12] {
            let mut list = empty(view(48, 48, 48.0), 4);
            let turn = glam::DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.5) * scale;
            let place = DAffine3::from_mat3_translation(turn, DVec3::new(0.0, 0.0, -distance));
            add(&mut list, meshes::sphere(8, 6), place, Default::default());
            with_square(&mut list, 0.2, 0.2);
            list.draws[0].double_sided = true;
            let frame = by_gpu(&mut engine, &list, &Output::ALL);
            assert!(frame.depth_m.unwrap().iter().all(|d| d.is_finite()));
        }
    }
}
