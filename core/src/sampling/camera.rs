//! The camera.

use glam::DVec3;

use super::keys;
use super::linked::Draws;
use super::place::is_seen;
use super::value::{number, rotation, vector};
use crate::base::lens::Lens;
use crate::document::{self, Brown, Distortion, Document, Fisheye, Focus, Param};
use crate::scene::{Camera, DepthOfField, MotionBlur, Person, Placement};

pub(super) fn camera(document: &Document, draws: Draws) -> Camera {
    let camera = &document.camera;
    let of = |key| draws.random_if(camera.enabled).of(key, 0);
    let offset = of(keys::CAMERA_ROTATION_OFFSET);
    let angle = |i: u16| number(&camera.rotation_offset_deg[usize::from(i)], offset.lane(i));
    let offset_deg = DVec3::new(angle(0), angle(1), angle(2));
    let fov_vertical_deg = match &camera.focal_length_mm {
        None => number(&camera.fov_vertical_deg, of(keys::CAMERA_FOV)),
        Some(focal_length_mm) => {
            let f = number(focal_length_mm, of(keys::CAMERA_FOCAL_LENGTH));
            fov_vertical_deg(f, camera.sensor_height_mm)
        }
    };
    Camera {
        width: document.image.width,
        height: document.image.height,
        fov_vertical_deg,
        position_m: vector(&camera.position_m, of(keys::CAMERA_POSITION))
            + vector(&camera.position_offset_m, of(keys::CAMERA_POSITION_OFFSET)),
        rotation: rotation(&camera.rotation_deg, offset_deg, of(keys::CAMERA_ROTATION)),
        near_m: camera.near_m,
        depth_of_field: depth_of_field(camera, fov_vertical_deg, draws.random_if(camera.enabled)),
        motion_blur: motion_blur(camera, draws.random_if(camera.enabled)),
        distortion: camera
            .distortion
            .as_ref()
            .map(|d| lens(d, draws.random_if(camera.enabled)))
            .filter(|lens| !lens.is_neutral()),
    }
}

fn depth_of_field(
    camera: &document::Camera,
    fov_vertical_deg: f64,
    draws: Draws,
) -> Option<DepthOfField> {
    let blur = &camera.depth_of_field;
    let of = |param, key| number(param, draws.of(key, 0));
    blur.enabled.then(|| DepthOfField {
        f_number: of(&blur.f_number, keys::F_NUMBER),
        focus_distance_m: of(&blur.focus_distance_m, keys::FOCUS_DISTANCE),
        focal_length_mm: match &blur.focal_length_mm {
            Some(focal_length_mm) => of(focal_length_mm, keys::BLUR_FOCAL_LENGTH),
            None => focal_length_mm(fov_vertical_deg, camera.sensor_height_mm),
        },
        sensor_height_mm: camera.sensor_height_mm,
    })
}

fn motion_blur(camera: &document::Camera, draws: Draws) -> Option<MotionBlur> {
    let blur = &camera.motion_blur;
    let of_axes = |params: &[Param; 3], key| {
        let key = draws.of(key, 0);
        DVec3::from_array([0, 1, 2].map(|i| number(&params[usize::from(i)], key.lane(i))))
    };
    blur.enabled.then(|| MotionBlur {
        shutter_s: number(&blur.shutter_s, draws.of(keys::SHUTTER, 0)),
        velocity_m_s: of_axes(&blur.velocity_m_s, keys::CAMERA_VELOCITY),
        angular_velocity_deg_s: of_axes(&blur.angular_velocity_deg_s, keys::CAMERA_TURN),
    })
}

/// Height of the eyes of who stands, share of the stature (NASA-STD-3000, 1995: 0.936 of the median
/// man and woman), and how far they lie before the middle of the body.
const EYES: [f64; 2] = [0.936, 0.09];

/// Focuses on whom the document asks for.
pub(super) fn focus(wanted: &document::DepthOfField, camera: &mut Camera, people: &[Person]) {
    if wanted.focus == Focus::Distance {
        return;
    }
    let eyes = |person: &Person| {
        let Placement { position_m, rotation, scale } = person.placement;
        let in_model = DVec3::new(0.0, EYES[0] * person.body.stature_m, EYES[1]);
        position_m + rotation * (in_model * scale)
    };
    let seen = people.iter().map(eyes).filter(|at| is_seen(camera, *at));
    let nearest_m = seen.map(|at| -camera.view_from_world(at).z).min_by(f64::total_cmp);
    if let (Some(blur), Some(nearest_m)) = (&mut camera.depth_of_field, nearest_m) {
        blur.focus_distance_m = nearest_m;
    }
}

fn lens(distortion: &Distortion, draws: Draws) -> Lens {
    let k = |param, key| number(param, draws.of(key, 0));
    match distortion {
        Distortion::Brown(Brown { k1, k2, p1, p2, k3 }) => Lens::Brown {
            k1: k(k1, keys::LENS_K1),
            k2: k(k2, keys::LENS_K2),
            p1: k(p1, keys::LENS_P1),
            p2: k(p2, keys::LENS_P2),
            k3: k(k3, keys::LENS_K3),
        },
        Distortion::Fisheye(Fisheye { k1, k2, k3, k4 }) => Lens::Fisheye {
            k1: k(k1, keys::LENS_K1),
            k2: k(k2, keys::LENS_K2),
            k3: k(k3, keys::LENS_K3),
            k4: k(k4, keys::LENS_K4),
        },
    }
}

/// The angle that a lens has on a sensor, degrees.
fn fov_vertical_deg(focal_length_mm: f64, sensor_height_mm: f64) -> f64 {
    2.0 * libm::atan2(0.5 * sensor_height_mm, focal_length_mm).to_degrees()
}

/// The focal length that makes an angle on a sensor, millimetres.
fn focal_length_mm(fov_vertical_deg: f64, sensor_height_mm: f64) -> f64 {
    0.5 * sensor_height_mm / libm::tan(0.5 * fov_vertical_deg.to_radians())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lenses_have_their_angles() {
        for (focal_length_mm, expected_deg) in [(23.0, 55.1), (1.0, 170.5), (50.0, 27.0)] {
            let got_deg = fov_vertical_deg(focal_length_mm, 24.0);
            assert!((got_deg - expected_deg).abs() < 0.05, "{focal_length_mm} mm: {got_deg}");
            let back_mm = super::focal_length_mm(got_deg, 24.0);
            assert!((back_mm - focal_length_mm).abs() < 1e-9, "{back_mm}");
        }
    }
}
