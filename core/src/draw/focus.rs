//! Whether anything of a picture is out of focus, and by how much.

use super::abi::Defocus;
use crate::scene::Camera;

/// Largest radius of a blurred point, share of the picture's height.
const LARGEST: f64 = 0.05;

/// What a camera blurs of a scene that comes no nearer than so; nothing if that is nowhere seen.
pub fn defocus(camera: &Camera, nearest_m: f64) -> Option<Defocus> {
    let lens = camera.depth_of_field?;
    let height = f64::from(camera.height);
    let at_infinity_px = (lens.blur_at_infinity() * height).min(LARGEST * height);
    // Beyond the focus the blur grows to that of infinity.
    let nearest_px = at_infinity_px * (lens.focus_distance_m / nearest_m - 1.0);
    let limit_px = (LARGEST * height).min(Defocus::NEAR_LIMIT * at_infinity_px);
    let largest_px = nearest_px.max(at_infinity_px).min(limit_px);
    (largest_px > Defocus::SHARP_PX).then_some(Defocus {
        focus_m: lens.focus_distance_m as f32,
        at_infinity_px: at_infinity_px as f32,
        largest_px: largest_px as f32,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::DepthOfField;
    use glam::{DQuat, DVec3};

    fn camera(f_number: f64, focus_distance_m: f64) -> Camera {
        Camera {
            width: 640,
            height: 480,
            fov_vertical_deg: 30.0,
            position_m: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            near_m: 0.1,
            motion_blur: None,
            depth_of_field: Some(DepthOfField {
                f_number,
                focus_distance_m,
                focal_length_mm: 50.0,
                sensor_height_mm: 24.0,
            }),
            distortion: None,
        }
    }

    #[test]
    fn blur_is_that_of_a_thin_lens() {
        // 50 mm, f/2, focused at 2 m: a point at infinity becomes a disk of 0.641 mm.
        let got = defocus(&camera(2.0, 2.0), 1.5).unwrap();
        let expected_px = 0.5 * 0.641 / 24.0 * 480.0;
        assert!((f64::from(got.at_infinity_px) - expected_px).abs() < 0.01, "{got:?}");
        assert_eq!(got.largest_px, got.at_infinity_px);
        let near = defocus(&camera(2.0, 2.0), 0.8).unwrap();
        assert!((near.largest_px / near.at_infinity_px - 1.5).abs() < 1e-5, "{near:?}");
    }

    #[test]
    fn what_is_sharp_everywhere_costs_nothing() {
        assert_eq!(defocus(&Camera { depth_of_field: None, ..camera(2.0, 2.0) }, 1.0), None);
        assert_eq!(defocus(&camera(64.0, 10.0), 5.0), None);
    }

    #[test]
    fn a_lens_that_cannot_focus_so_near_blurs_within_limits() {
        let got = defocus(&camera(0.5, 0.01), 0.1).unwrap();
        assert!(got.largest_px <= 24.0 && got.at_infinity_px <= 24.0, "{got:?}");
    }
}
