//! The camera, and the projection that every label goes through.

use glam::{DMat3, DQuat, DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::base::lens::Lens;
use crate::base::space::CV_FROM_VIEW;

/// A camera with square pixels and its principal point in the middle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Picture width in pixels.
    pub width: u32,
    /// Picture height in pixels.
    pub height: u32,
    /// Angle between the rays through the middle of the top and bottom edge, degrees; without the
    /// distortion.
    pub fov_vertical_deg: f64,
    /// Where it stands, metres, world.
    pub position_m: DVec3,
    /// World from view; at identity it looks down -Z with +Y up.
    pub rotation: DQuat,
    /// Distance of the near plane along the view axis.
    pub near_m: f64,
    /// How what is not in focus blurs; all is sharp where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_of_field: Option<DepthOfField>,
    /// How what moves blurs; nothing does where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion_blur: Option<MotionBlur>,
    /// What its lens makes of the pinhole's picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distortion: Option<Lens>,
}

/// A thin lens with an aperture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DepthOfField {
    /// Focal length over the width of the aperture.
    pub f_number: f64,
    /// Distance along the view axis of the plane that is sharp, metres.
    pub focus_distance_m: f64,
    /// Millimetres.
    pub focal_length_mm: f64,
    /// Height of the picture on the sensor, millimetres.
    pub sensor_height_mm: f64,
}

/// A shutter, and how the camera moves while it is open.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionBlur {
    /// How long it is open, seconds; the scene is that of the middle of this time.
    pub shutter_s: f64,
    /// Along the camera's axes.
    pub velocity_m_s: DVec3,
    /// About the camera's axes.
    pub angular_velocity_deg_s: DVec3,
}

impl DepthOfField {
    /// Radius, in heights of the picture, of the disk that a point at infinity becomes: half of
    /// `f^2 / (N (P - f))` on the sensor, P being the distance in focus. At a distance z it is
    /// `|1 - P / z|` of this. A lens does not focus nearer than its focal length; there it is as if
    /// the focus lay a micrometre beyond.
    #[must_use]
    pub fn blur_at_infinity(&self) -> f64 {
        let f_m = self.focal_length_mm * 1e-3;
        let aperture_m = f_m / self.f_number;
        let beyond_m = (self.focus_distance_m - f_m).max(1e-6);
        0.5 * aperture_m * f_m / beyond_m / (self.sensor_height_mm * 1e-3)
    }
}

impl Camera {
    /// The camera some time later, as it moves; itself where it does not.
    #[must_use]
    pub fn after(&self, time_s: f64) -> Self {
        let Some(motion) = &self.motion_blur else { return *self };
        let turn = motion.angular_velocity_deg_s.map(f64::to_radians) * time_s;
        Self {
            position_m: self.position_m + self.rotation * (motion.velocity_m_s * time_s),
            rotation: (self.rotation * rotation_by(turn)).normalize(),
            ..*self
        }
    }

    /// Focal length in pixels, the same for both axes: `H / 2 / tan(fov / 2)`.
    #[must_use]
    pub fn focal_px(&self) -> f64 {
        f64::from(self.height) * 0.5 / libm::tan(self.fov_vertical_deg.to_radians() * 0.5)
    }

    /// The principal point, pixels.
    #[must_use]
    pub fn center_px(&self) -> DVec2 {
        DVec2::new(f64::from(self.width) * 0.5, f64::from(self.height) * 0.5)
    }

    /// The intrinsic matrix `K` of [`crate::base::space`], row by row.
    #[must_use]
    pub fn intrinsics(&self) -> [[f64; 3]; 3] {
        let (f, c) = (self.focal_px(), self.center_px());
        [[f, 0.0, c.x], [0.0, f, c.y], [0.0, 0.0, 1.0]]
    }

    /// A world point in view space.
    #[must_use]
    pub fn view_from_world(&self, p_in_world: DVec3) -> DVec3 {
        self.rotation.inverse() * (p_in_world - self.position_m)
    }

    /// `R` of `X_cv = R X_world + t`.
    #[must_use]
    pub fn cv_from_world_rotation(&self) -> DMat3 {
        CV_FROM_VIEW * DMat3::from_quat(self.rotation.inverse())
    }

    /// `t` of `X_cv = R X_world + t`.
    #[must_use]
    pub fn cv_from_world_translation(&self) -> DVec3 {
        -(self.cv_from_world_rotation() * self.position_m)
    }

    /// Image position of a view-space point, or nothing if it lies not in front of the camera.
    #[must_use]
    pub fn project(&self, p_in_view: DVec3) -> Option<DVec2> {
        let distance = -p_in_view.z;
        (distance > 0.0).then(|| {
            let Some(lens) = &self.distortion else {
                let f = self.focal_px() / distance;
                return self.center_px() + DVec2::new(p_in_view.x * f, -p_in_view.y * f);
            };
            let undistorted = DVec2::new(p_in_view.x, -p_in_view.y) / distance;
            self.center_px() + lens.distort(undistorted) * self.focal_px()
        })
    }

    /// Whether the lens shows a view-space point in front of the camera, however large the picture:
    /// a polynomial may lead back where it shows nothing.
    #[must_use]
    pub fn lens_reaches(&self, p_in_view: DVec3) -> bool {
        let undistorted = DVec2::new(p_in_view.x, -p_in_view.y) / -p_in_view.z;
        self.distortion.is_none_or(|lens| lens.reaches(undistorted))
    }
}

/// The rotation about a vector by its length, radians.
fn rotation_by(turn: DVec3) -> DQuat {
    let angle = turn.length();
    if angle == 0.0 {
        return DQuat::IDENTITY;
    }
    let (sin, cos) = libm::sincos(0.5 * angle);
    let axis = turn * (sin / angle);
    DQuat::from_xyzw(axis.x, axis.y, axis.z, cos)
}
