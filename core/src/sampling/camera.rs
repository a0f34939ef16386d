//! The camera.

use glam::DVec3;

use super::keys;
use super::linked::Draws;
use super::value::{number, rotation, vector};
use crate::document::Document;
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
    }
}
