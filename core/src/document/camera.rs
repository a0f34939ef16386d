//! The picture's size and the camera that takes it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Param, Rotation, Vector};

/// The picture's size.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Image {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
}

impl Default for Image {
    fn default() -> Self {
        Self { width: 640, height: 640 }
    }
}

/// The camera. Unrotated it looks down -Z with +Y up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Camera {
    /// Where false, every parameter takes its median.
    pub enabled: bool,
    /// Angle between the rays through the middle of the top and bottom edge, without the distortion.
    pub fov_vertical_deg: Param,
    /// Of a lens that is focused far away. Where given, the angle follows from it and the sensor, as
    /// `2 atan(h / 2f)`, in place of `fov_vertical_deg`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focal_length_mm: Option<Param>,
    /// Height of the part of the sensor that the picture takes up; full frame has 24.
    #[serde(skip_serializing_if = "is_full_frame")]
    pub sensor_height_mm: f64,
    /// Where it stands.
    pub position_m: Vector,
    /// Added to the position.
    pub position_offset_m: Vector,
    /// Where it looks.
    pub rotation_deg: Rotation,
    /// Euler angles added to those of the rotation (or applied before a joint one).
    pub rotation_offset_deg: [Param; 3],
    /// Nothing nearer along the view axis is seen.
    pub near_m: f64,
    /// How what is not in focus blurs.
    pub depth_of_field: DepthOfField,
    /// How what moves blurs.
    #[serde(skip_serializing_if = "MotionBlur::is_default")]
    pub motion_blur: MotionBlur,
    /// What its lens makes of the pinhole's picture, in OpenCV's terms; nothing where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distortion: Option<Distortion>,
}

/// Height of a sensor of 36 x 24 mm.
const FULL_FRAME_MM: f64 = 24.0;

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for references")]
fn is_full_frame(height_mm: &f64) -> bool {
    *height_mm == FULL_FRAME_MM
}

impl Default for Camera {
    fn default() -> Self {
        let five = || Param::uniform(-5.0, 5.0);
        Self {
            enabled: true,
            fov_vertical_deg: Param::uniform(5.0, 50.0),
            focal_length_mm: None,
            sensor_height_mm: FULL_FRAME_MM,
            position_m: Vector::constant(0.0, 0.0, 15.0),
            position_offset_m: Vector::within(5.0),
            rotation_deg: Rotation::NONE,
            rotation_offset_deg: [five(), five(), five()],
            near_m: 0.1,
            depth_of_field: DepthOfField::default(),
            motion_blur: MotionBlur::default(),
            distortion: None,
        }
    }
}

/// How what lies before and behind the plane in focus blurs, as behind a thin lens. Labels are those
/// of the sharp picture.
///
/// The seed's lens has f/16, but its engine blurs 2.8 times less than optics: as f/45 does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DepthOfField {
    /// Where false, all is sharp.
    pub enabled: bool,
    /// Focal length over the width of the aperture: the smaller, the more blur.
    pub f_number: Param,
    /// What is sharp.
    pub focus: Focus,
    /// Distance along the view axis of the plane that is sharp, where nothing else is asked for.
    pub focus_distance_m: Param,
    /// Of the lens as far as it blurs; null for that of the camera, which is its `focal_length_mm` or
    /// what the angle and the sensor make it. The seed's camera blurs by a focal length that has nothing
    /// to do with its angle.
    pub focal_length_mm: Option<Param>,
}

impl Default for DepthOfField {
    fn default() -> Self {
        Self {
            enabled: true,
            f_number: 45.0.into(),
            focus: Focus::Distance,
            focus_distance_m: Param::uniform(0.1, 4.0),
            focal_length_mm: Some(Param::uniform(1.0, 23.0)),
        }
    }
}

/// How what moves while the shutter is open blurs: people as their clip goes on, and all of the
/// picture as the camera does. Labels are those of the middle of that time, and of the sharp picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MotionBlur {
    /// Where false, nothing moves.
    pub enabled: bool,
    /// How long the shutter is open; nothing blurs farther than a tenth of the picture's height.
    pub shutter_s: Param,
    /// The camera's own velocity along its axes: to the right, up, backwards.
    pub velocity_m_s: [Param; 3],
    /// How fast the camera turns about its axes: up, to the left, against the clock.
    pub angular_velocity_deg_s: [Param; 3],
}

impl MotionBlur {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl Default for MotionBlur {
    fn default() -> Self {
        let none = || [0.0, 0.0, 0.0].map(Param::from);
        Self {
            enabled: false,
            shutter_s: 0.02.into(),
            velocity_m_s: none(),
            angular_velocity_deg_s: none(),
        }
    }
}

/// What a camera focuses on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Focus {
    /// A plane at a distance.
    #[default]
    Distance,
    /// The plane through the eyes of the person, as they stand, who is the nearest of those whose head
    /// is in the picture; a distance where there is none.
    NearestPerson,
}

/// How a lens bends straight lines. Lengths are fractions of the focal length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "model", rename_all = "snake_case")]
pub enum Distortion {
    /// Radial and tangential, as `cv2.projectPoints`; with zeros alone there is none.
    Brown(Brown),
    /// By the angle off the axis, as `cv2.fisheye`: a picture reaches 80 degrees off it at most. With
    /// zeros alone it is the equidistant fisheye.
    Fisheye(Fisheye),
}

/// Coefficients of Brown's model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Brown {
    /// Radial, of the radius squared; barrels are negative.
    pub k1: Param,
    /// Radial, of the fourth power.
    pub k2: Param,
    /// Tangential, for a sensor tilted about x.
    pub p1: Param,
    /// Tangential, for a sensor tilted about y.
    pub p2: Param,
    /// Radial, of the sixth power.
    pub k3: Param,
}

/// Coefficients of the fisheye: `angle (1 + k1 angle^2 + k2 angle^4 + k3 angle^6 + k4 angle^8)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Fisheye {
    /// See [`Fisheye`].
    pub k1: Param,
    /// See [`Fisheye`].
    pub k2: Param,
    /// See [`Fisheye`].
    pub k3: Param,
    /// See [`Fisheye`].
    pub k4: Param,
}

impl Distortion {
    /// All coefficients with their names, in the order of their fields.
    #[must_use]
    pub fn coefficients(&self) -> Vec<(&'static str, &Param)> {
        match self {
            Self::Brown(Brown { k1, k2, p1, p2, k3 }) => {
                vec![("k1", k1), ("k2", k2), ("p1", p1), ("p2", p2), ("k3", k3)]
            }
            Self::Fisheye(Fisheye { k1, k2, k3, k4 }) => {
                vec![("k1", k1), ("k2", k2), ("k3", k3), ("k4", k4)]
            }
        }
    }
}

impl Default for Brown {
    fn default() -> Self {
        let none = || Param::Constant(0.0);
        Self { k1: none(), k2: none(), p1: none(), p2: none(), k3: none() }
    }
}

impl Default for Fisheye {
    fn default() -> Self {
        let none = || Param::Constant(0.0);
        Self { k1: none(), k2: none(), k3: none(), k4: none() }
    }
}
