//! What the camera may see, and whose shadow it may see: conservative tests on spheres.
//!
//! A yes may be wrong, a no never is.

use glam::DVec3;

use crate::scene::Camera;

/// The five planes of a camera's view, in view space; there is no far plane.
#[derive(Clone, Copy, Debug)]
pub struct Frustum {
    /// Inward unit normals and offsets: inside where `normal . p + offset >= 0`.
    planes: [(DVec3, f64); 5],
}

impl Frustum {
    /// The view of a camera, widened by one pixel on each side for samples and filters.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        let (focal, center) = (camera.focal_px(), camera.center_px());
        let (tan_x, tan_y) = ((center.x + 1.0) / focal, (center.y + 1.0) / focal);
        let side = |x: f64, y: f64, tan: f64| (DVec3::new(x, y, -tan).normalize(), 0.0);
        Self {
            planes: [
                side(1.0, 0.0, tan_x),
                side(-1.0, 0.0, tan_x),
                side(0.0, 1.0, tan_y),
                side(0.0, -1.0, tan_y),
                (DVec3::NEG_Z, -camera.near_m),
            ],
        }
    }

    /// Whether a sphere may reach into the view.
    #[must_use]
    pub fn sees(&self, center: DVec3, radius: f64) -> bool {
        self.planes.iter().all(|(n, d)| n.dot(center) + d >= -radius)
    }

    /// Whether the shadow of a sphere may: the sphere swept away from the sun without end.
    #[must_use]
    pub fn sees_shadow(&self, center: DVec3, radius: f64, direction_to_sun: DVec3) -> bool {
        self.planes
            .iter()
            .all(|(n, d)| n.dot(center) + d >= -radius || n.dot(direction_to_sun) < 0.0)
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    fn frustum() -> Frustum {
        Frustum::new(&Camera {
            width: 100,
            height: 100,
            fov_vertical_deg: 90.0,
            position_m: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            near_m: 0.1,
        })
    }

    #[test]
    fn spheres_are_seen_where_they_reach_the_view() {
        let f = frustum();
        assert!(f.sees(DVec3::new(0.0, 0.0, -5.0), 0.1));
        assert!(f.sees(DVec3::new(6.0, 0.0, -5.0), 1.0));
        assert!(!f.sees(DVec3::new(8.0, 0.0, -5.0), 1.0));
        assert!(!f.sees(DVec3::new(0.0, 0.0, 1.0), 0.5));
        assert!(f.sees(DVec3::ZERO, 0.5));
    }

    #[test]
    fn a_shadow_is_seen_when_it_falls_into_the_view() {
        let f = frustum();
        let above = DVec3::new(0.0, 20.0, -5.0);
        assert!(!f.sees(above, 1.0));
        assert!(f.sees_shadow(above, 1.0, DVec3::Y));
        assert!(!f.sees_shadow(above, 1.0, DVec3::NEG_Y));
        // Behind the camera, with the sun at its back, the shadow falls forward.
        assert!(f.sees_shadow(DVec3::new(0.0, 0.0, 4.0), 1.0, DVec3::Z));
    }
}
