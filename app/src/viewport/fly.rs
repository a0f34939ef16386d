//! The free camera: a viewpoint that is moved by hand. It is no part of the document.

use figurant_core::job::Viewpoint;
use figurant_core::scene::Scene;
use glam::{DQuat, DVec3};

/// Nearest that the camera comes to what it orbits, metres.
const NEAREST_M: f64 = 0.2;
/// Farthest, metres.
const FARTHEST_M: f64 = 1000.0;
/// How near to straight up or down it looks when orbiting, as the sine of the angle.
const STEEPEST: f64 = 0.98;

/// A camera in flight with the point that it orbits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// From where the scene is seen.
    pub viewpoint: Viewpoint,
    /// How far ahead the point that it orbits is, metres.
    pub distance_m: f64,
}

impl Flight {
    /// Starts from a camera; orbits what the scene's people stand around.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let viewpoint = Viewpoint::from(&scene.camera);
        let depth = |p: DVec3| -scene.camera.view_from_world(p).z;
        let mut depths: Vec<f64> = scene
            .people
            .iter()
            .map(|p| depth(p.placement.position_m))
            .filter(|d| *d > 0.0)
            .collect();
        depths.sort_by(f64::total_cmp);
        let distance_m = depths.get(depths.len() / 2).copied().unwrap_or(5.0);
        Self { viewpoint, distance_m: distance_m.clamp(NEAREST_M, FARTHEST_M) }
    }

    /// The point that it orbits, world.
    #[must_use]
    pub fn pivot_m(&self) -> DVec3 {
        self.viewpoint.position_m + self.viewpoint.rotation * (DVec3::NEG_Z * self.distance_m)
    }

    /// Goes around the point ahead; radians to the right and up.
    pub fn orbit(&mut self, right: f64, up: f64) {
        let pivot = self.pivot_m();
        self.look(-right, -up);
        self.viewpoint.position_m = pivot + self.viewpoint.rotation * (DVec3::Z * self.distance_m);
    }

    /// Turns where it stands; radians to the left and up.
    pub fn look(&mut self, left: f64, up: f64) {
        let turned = DQuat::from_rotation_y(left) * self.viewpoint.rotation;
        let tilted = (turned * DQuat::from_rotation_x(up)).normalize();
        let sine = |q: DQuat| (q * DVec3::NEG_Z).y.abs();
        let steeper = sine(tilted) > STEEPEST && sine(tilted) > sine(turned);
        self.viewpoint.rotation = if steeper { turned.normalize() } else { tilted };
    }

    /// Moves sideways with the point ahead, such that this follows the pointer; shares of the
    /// picture's height to the right and down.
    pub fn pan(&mut self, right: f64, down: f64) {
        let height_m =
            2.0 * self.distance_m * (self.viewpoint.fov_vertical_deg.to_radians() * 0.5).tan();
        let step = DVec3::new(-right, down, 0.0) * height_m;
        self.viewpoint.position_m += self.viewpoint.rotation * step;
    }

    /// Comes nearer to the point ahead by a factor below 1, or goes away.
    pub fn dolly(&mut self, factor: f64) {
        let pivot = self.pivot_m();
        self.distance_m = (self.distance_m * factor).clamp(NEAREST_M, FARTHEST_M);
        self.viewpoint.position_m = pivot + self.viewpoint.rotation * (DVec3::Z * self.distance_m);
    }

    /// Flies; metres to the right, up and back in the camera's own axes.
    pub fn fly(&mut self, step_m: DVec3) {
        self.viewpoint.position_m += self.viewpoint.rotation * step_m;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use figurant_core::scene::Camera;

    fn flight() -> Flight {
        let rotation = DQuat::from_rotation_y(0.3) * DQuat::from_rotation_x(-0.2);
        let viewpoint =
            Viewpoint { position_m: DVec3::new(1.0, 2.0, 8.0), rotation, fov_vertical_deg: 40.0 };
        Flight { viewpoint, distance_m: 6.0 }
    }

    #[test]
    fn orbiting_keeps_the_point_ahead_and_its_distance() {
        let mut flight = flight();
        let pivot = flight.pivot_m();
        for (right, up) in [(0.4, 0.1), (-2.0, 0.3), (0.0, -0.5), (3.0, 5.0), (0.1, -9.0)] {
            flight.orbit(right, up);
            assert!(flight.pivot_m().abs_diff_eq(pivot, 1e-9), "{:?}", flight.pivot_m());
            let distance = flight.viewpoint.position_m.distance(pivot);
            assert!((distance - 6.0).abs() < 1e-9, "{distance}");
            let ahead = flight.viewpoint.rotation * DVec3::NEG_Z;
            assert!(ahead.y.abs() < 0.999, "it looks straight up or down: {ahead}");
        }
    }

    #[test]
    fn panning_by_the_pictures_height_moves_what_is_ahead_out_of_it() {
        let mut flight = flight();
        let before = flight.pivot_m();
        flight.pan(0.0, 0.5);
        let camera = Camera {
            width: 100,
            height: 100,
            fov_vertical_deg: 40.0,
            position_m: flight.viewpoint.position_m,
            rotation: flight.viewpoint.rotation,
            near_m: 0.1,
            motion_blur: None,
            depth_of_field: None,
            distortion: None,
        };
        let at = camera.project(camera.view_from_world(before)).unwrap();
        assert!((at.x - 50.0).abs() < 1e-6 && (at.y - 100.0).abs() < 1e-6, "{at}");
    }

    #[test]
    fn a_dolly_never_passes_the_point_ahead() {
        let mut flight = flight();
        let pivot = flight.pivot_m();
        for _ in 0..100 {
            flight.dolly(0.5);
        }
        assert!((flight.viewpoint.position_m.distance(pivot) - NEAREST_M).abs() < 1e-9);
    }
}
