//! The camera.

use glam::DVec3;

use super::keys;
use super::value::{number, rotation, vector};
use crate::base::lens::Lens;
use crate::base::rng::{Draw, Draws};
use crate::document::{Brown, Distortion, Document, Fisheye};
use crate::scene::Camera;

pub(super) fn camera(document: &Document, draws: Draws) -> Camera {
    let camera = &document.camera;
    let of = |key| draws.random_if(camera.enabled).of(key, 0);
    let offset = of(keys::CAMERA_ROTATION_OFFSET);
    let angle = |i: u16| number(&camera.rotation_offset_deg[usize::from(i)], offset.lane(i));
    let offset_deg = DVec3::new(angle(0), angle(1), angle(2));
    Camera {
        width: document.image.width,
        height: document.image.height,
        fov_vertical_deg: number(&camera.fov_vertical_deg, of(keys::CAMERA_FOV)),
        position_m: vector(&camera.position_m, of(keys::CAMERA_POSITION))
            + vector(&camera.position_offset_m, of(keys::CAMERA_POSITION_OFFSET)),
        rotation: rotation(&camera.rotation_deg, offset_deg, of(keys::CAMERA_ROTATION)),
        near_m: camera.near_m,
        distortion: camera
            .distortion
            .as_ref()
            .map(|d| lens(d, of(keys::CAMERA_DISTORTION)))
            .filter(|lens| !lens.is_neutral()),
    }
}

/// A lane for each coefficient.
fn lens(distortion: &Distortion, draw: Draw) -> Lens {
    match distortion {
        Distortion::Brown(Brown { k1, k2, p1, p2, k3 }) => Lens::Brown {
            k1: number(k1, draw.lane(0)),
            k2: number(k2, draw.lane(1)),
            p1: number(p1, draw.lane(2)),
            p2: number(p2, draw.lane(3)),
            k3: number(k3, draw.lane(4)),
        },
        Distortion::Fisheye(Fisheye { k1, k2, k3, k4 }) => Lens::Fisheye {
            k1: number(k1, draw.lane(0)),
            k2: number(k2, draw.lane(1)),
            k3: number(k3, draw.lane(2)),
            k4: number(k4, draw.lane(3)),
        },
    }
}
