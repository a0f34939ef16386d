//! Cameras: what they focus on.

use std::sync::Arc;

use figurant_core::document::{Focus, Param, file, presets};
use figurant_core::draw::{Cast, DrawOptions, draw};
use figurant_core::job;
use figurant_core::library::Library;
use figurant_core::sampling::Sampler;

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
        let in_picture = |at: &glam::DVec3| {
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
