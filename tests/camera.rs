//! Cameras: what they focus on, and what moves while their shutter is open.

#![allow(clippy::unwrap_used, reason = "helpers of tests, too, fail by panicking")]

use std::sync::Arc;

use figurant_core::document::{Focus, Param, file, presets};
use figurant_core::draw::{Cast, DrawOptions, draw};
use figurant_core::engine::Engine;
use figurant_core::engine::cpu::CpuEngine;
use figurant_core::job;
use figurant_core::library::Library;
use figurant_core::plan::{Output, PassPlan, SceneFacts, StageTimes};
use figurant_core::sampling::Sampler;
use figurant_core::scene::{Camera, MotionBlur, Scene, ToneCurve};
use figurant_tests::light::{linear, psnr};
use glam::DVec3;

/// The distance in focus is that of the nearest face in the picture, wherever people stand upright.
#[test]
fn the_nearest_persons_eyes_are_in_focus() {
    let library = Library::new(&[], 64).unwrap();
    let mut document = file::parse(presets::find("everyday").unwrap().text).unwrap();
    let blur = &mut document.camera.depth_of_field;
    (blur.enabled, blur.focus) = (true, Focus::NearestPerson);
    blur.focus_distance_m = Param::Constant(77.0);
    let sampler = Sampler::new(Arc::new(document), job::catalogue(&library)).unwrap();
    let options = DrawOptions {
        raster: false,
        shading: false,
        samples: 1,
        shadow_map_size: 0,
        lod_error_px: 0.25,
    };
    let (mut close, mut found, mut nobody) = (0, 0, 0);
    for frame in 0..60 {
        let scene = sampler.scene(frame);
        let (camera, focus_m) =
            (&scene.camera, scene.camera.depth_of_field.unwrap().focus_distance_m);
        let drawn = draw(&scene, &library, &Cast::default(), &options).unwrap();
        // Between the eyes.
        let eyes =
            drawn.people.iter().map(|p| (p.keypoints_in_view[1] + p.keypoints_in_view[2]) / 2.0);
        let size = [camera.width, camera.height].map(f64::from);
        let in_picture = |at: &DVec3| {
            camera
                .project(*at)
                .is_some_and(|p| (0.0..size[0]).contains(&p.x) && (0.0..size[1]).contains(&p.y))
        };
        match eyes.filter(in_picture).map(|at| -at.z).min_by(f64::total_cmp) {
            None => nobody += u32::from(focus_m == 77.0),
            Some(nearest_m) => {
                found += 1;
                close += u32::from((nearest_m - focus_m).abs() < 0.35);
            }
        }
    }
    println!("{close} of {found}; nobody in {nobody}");
    // Who sits or bends over has the eyes elsewhere.
    assert!(found > 40 && close * 10 >= found * 8, "{close} of {found}");
}

/// Frames of a moving crowd, pictures alone, without what is not light.
fn crowd_in_motion() -> (Library, Sampler) {
    let library = Library::new(&[], 64).unwrap();
    let mut document = file::parse(presets::find("starter").unwrap().text).unwrap();
    (document.image.width, document.image.height) = (240, 240);
    (document.post.enabled, document.post.tone_curve) = (false, ToneCurve::None);
    document.camera.depth_of_field.enabled = false;
    let sampler = Sampler::new(Arc::new(document), job::catalogue(&library)).unwrap();
    (library, sampler)
}

fn linear_light(scene: &Scene, library: &Library) -> Vec<f64> {
    let options = DrawOptions {
        raster: true,
        shading: true,
        samples: 4,
        shadow_map_size: 1024,
        lod_error_px: 0.5,
    };
    let drawn = draw(scene, library, &Cast::default(), &options).unwrap();
    let plan = PassPlan::new(&[Output::Rgb].into(), SceneFacts::ANY);
    let frame = CpuEngine::default().render(&drawn.list, &plan, &mut StageTimes::default());
    let picture = frame.unwrap().picture.unwrap();
    picture.into_iter().map(linear).collect()
}

/// The scene some time later, its shutter open for no time.
fn later(scene: &Scene, library: &Library, time_s: f64) -> Scene {
    let mut scene = scene.clone();
    scene.camera = Camera { motion_blur: None, ..scene.camera.after(time_s) };
    for person in &mut scene.people {
        let Ok(clip) = library.clips.get(&person.pose.clip) else { continue };
        let phase = person.pose.phase + time_s / clip.duration_s();
        person.pose.phase = if clip.loops { phase.rem_euclid(1.0) } else { phase.clamp(0.0, 1.0) };
    }
    scene
}

/// What an open shutter blurs is near the mean of many shutters that open one after the other.
#[test]
fn motion_blur_is_near_the_mean_of_many_moments() {
    let (library, sampler) = crowd_in_motion();
    let still = MotionBlur {
        shutter_s: 0.0,
        velocity_m_s: DVec3::ZERO,
        angular_velocity_deg_s: DVec3::ZERO,
    };
    let walking = MotionBlur { shutter_s: 0.05, ..still };
    let panning = MotionBlur { angular_velocity_deg_s: DVec3::new(4.0, 14.0, 0.0), ..walking };
    let riding = MotionBlur { velocity_m_s: DVec3::new(1.0, 0.0, -1.5), ..walking };
    let rolling = MotionBlur { angular_velocity_deg_s: DVec3::new(0.0, 0.0, 60.0), ..walking };
    for (name, motion_blur, least_gain_db) in [
        ("walking", walking, 0.5),
        ("panning", panning, 8.0),
        ("riding", riding, 6.0),
        ("rolling", rolling, 7.0),
    ] {
        let (mut with, mut without, mut bias) = (0.0, 0.0, 0.0_f64);
        let frames = [0, 5, 9];
        for frame in frames {
            let mut scene = sampler.scene(frame);
            scene.camera.motion_blur = Some(motion_blur);
            // So that next to nothing is brighter than white.
            scene.exposure_ev100 += 1.0;
            let moments = 32;
            let mut truth = Vec::new();
            for moment in 0..moments {
                let share = (f64::from(moment) + 0.5) / f64::from(moments) - 0.5;
                let seen = later(&scene, &library, share * motion_blur.shutter_s);
                let light = linear_light(&seen, &library);
                truth.resize(light.len(), 0.0);
                truth.iter_mut().zip(light).for_each(|(t, v)| *t += v / f64::from(moments));
            }
            let sharp = linear_light(&later(&scene, &library, 0.0), &library);
            let got = linear_light(&scene, &library);
            let mean = |light: &[f64]| light.iter().sum::<f64>() / light.len() as f64;
            with += psnr(&got, &truth) / frames.len() as f64;
            without += psnr(&sharp, &truth) / frames.len() as f64;
            bias = bias.max((mean(&got) / mean(&truth) - 1.0).abs());
        }
        println!("{name}: {with:.1} dB, sharp {without:.1} dB, brightness off by {bias:.4}");
        assert!(with > without + least_gain_db, "{name}: {with:.1} dB, sharp {without:.1} dB");
        assert!(bias < 0.005, "{name}: brightness off by {bias:.4}");
    }
}
