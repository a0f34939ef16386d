//! What the camera may see, and whose shadow it may see: conservative tests on hulls of spheres.
//!
//! A yes may be wrong, a no never is.

use glam::DVec3;

use crate::base::lens::LensGrid;
use crate::scene::Camera;

/// A ball of view space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// View space, metres.
    pub center: DVec3,
    /// Metres.
    pub radius_m: f64,
}

/// How far the hull of some spheres reaches along a unit direction.
#[must_use]
pub fn reach_along(direction: DVec3, hull: &[Sphere]) -> f64 {
    hull.iter().map(|s| direction.dot(s.center) + s.radius_m).fold(f64::NEG_INFINITY, f64::max)
}

/// The five planes of a camera's view, in view space; there is no far plane.
#[derive(Clone, Copy, Debug)]
pub struct Frustum {
    /// Inward unit normals and offsets: inside where `normal . p + offset >= 0`.
    planes: [(DVec3, f64); 5],
}

impl Frustum {
    /// The view of a camera through its lens, widened by one pixel on each side for samples and
    /// filters.
    #[must_use]
    pub fn new(camera: &Camera, lens: Option<&LensGrid>) -> Self {
        let (focal, center) = (camera.focal_px(), camera.center_px());
        let (tan_x, tan_y) = ((center.x + 1.0) / focal, (center.y + 1.0) / focal);
        // Tangents to the left, right, top and bottom.
        let [left, right, top, bottom] = match lens.map(LensGrid::extent) {
            None => [tan_x, tan_x, tan_y, tan_y],
            Some([low, high]) => {
                [-low.x, high.x, -low.y, high.y].map(|tangent| tangent + 1.0 / focal)
            }
        };
        let side = |x: f64, y: f64, tan: f64| (DVec3::new(x, y, -tan).normalize(), 0.0);
        Self {
            planes: [
                side(1.0, 0.0, left),
                side(-1.0, 0.0, right),
                side(0.0, 1.0, bottom),
                side(0.0, -1.0, top),
                (DVec3::NEG_Z, -camera.near_m),
            ],
        }
    }

    /// Whether the hull of some spheres may reach into the view.
    #[must_use]
    pub fn sees(&self, hull: &[Sphere]) -> bool {
        self.planes.iter().all(|(n, d)| reach_along(*n, hull) + d >= 0.0)
    }

    /// Whether the shadow of the hull may: the hull swept away from the sun without end.
    #[must_use]
    pub fn sees_shadow(&self, hull: &[Sphere], direction_to_sun: DVec3) -> bool {
        self.planes
            .iter()
            .all(|(n, d)| reach_along(*n, hull) + d >= 0.0 || n.dot(direction_to_sun) < 0.0)
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    fn frustum() -> Frustum {
        Frustum::new(
            &Camera {
                width: 100,
                height: 100,
                fov_vertical_deg: 90.0,
                position_m: DVec3::ZERO,
                rotation: DQuat::IDENTITY,
                near_m: 0.1,
                motion_blur: None,
                depth_of_field: None,
                distortion: None,
            },
            None,
        )
    }

    fn sphere(x: f64, y: f64, z: f64, radius_m: f64) -> Sphere {
        Sphere { center: DVec3::new(x, y, z), radius_m }
    }

    #[test]
    fn spheres_are_seen_where_they_reach_the_view() {
        let f = frustum();
        assert!(f.sees(&[sphere(0.0, 0.0, -5.0, 0.1)]));
        assert!(f.sees(&[sphere(6.0, 0.0, -5.0, 1.0)]));
        assert!(!f.sees(&[sphere(8.0, 0.0, -5.0, 1.0)]));
        assert!(!f.sees(&[sphere(0.0, 0.0, 1.0, 0.5)]));
        assert!(f.sees(&[sphere(0.0, 0.0, 0.0, 0.5)]));
    }

    #[test]
    fn a_hull_is_seen_where_no_plane_parts_all_of_it_from_the_view() {
        let f = frustum();
        let right = sphere(8.0, 0.0, -5.0, 1.0);
        assert!(f.sees(&[right, sphere(-8.0, 0.0, -5.0, 1.0)]), "the view lies between them");
        assert!(!f.sees(&[right, sphere(9.0, 3.0, -5.0, 1.0)]));
        assert!(!f.sees(&[]));
    }

    #[test]
    fn a_shadow_is_seen_when_it_falls_into_the_view() {
        let f = frustum();
        let above = [sphere(0.0, 20.0, -5.0, 1.0)];
        assert!(!f.sees(&above));
        assert!(f.sees_shadow(&above, DVec3::Y));
        assert!(!f.sees_shadow(&above, DVec3::NEG_Y));
        // Behind the camera, with the sun at its back, the shadow falls forward.
        assert!(f.sees_shadow(&[sphere(0.0, 0.0, 4.0, 1.0)], DVec3::Z));
    }
}
