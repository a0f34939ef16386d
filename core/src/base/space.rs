//! The conventions of space, time and units; every other file refers to this page.
//!
//! * **World**: right-handed, +Y up, metres. People face +Z at rest, their left is +X.
//! * **Model** (of a mesh): the same axes, before the object's own placement.
//! * **View** (or camera): the camera at the origin, +X right, +Y up, looking down **-Z**.
//!   Everything an engine sees is in view space, so a scene a million metres from the origin is
//!   as sharp as one at it: the difference is taken in `f64` before it is narrowed to `f32`.
//! * **OpenCV camera axes**, used in files only: x right, y down, z forward;
//!   `x_cv = (x, -y, -z)_view` ([`cv_from_view`]).
//! * **Image**: continuous pixels, origin at the top-left *corner* of the top-left pixel, x right,
//!   y down. Pixel (i, j) covers `[i, i+1) x [j, j+1)`; its centre is (i + 0.5, j + 0.5).
//! * **Intrinsics**: `K = [[fx, 0, W/2], [0, fy, H/2], [0, 0, 1]]`, `x = K (R X + t)`; through a lens
//!   ([`super::lens`]) `x = K distort(R X + t)`.
//! * **Depth** in an engine: reversed Z with an infinite far plane, `near / distance`, where
//!   distance is metres along the view axis; 1 at the near plane, 0 at infinity and where nothing is.
//! * **Angles**: radians inside; degrees in the document, in names that end in `_deg`.
//! * **Transforms** are named `b_from_a`, so that products read like dominoes.
//! * **Light**: lux, candela, nits; exposure as EV at ISO 100 ([`exposure_from_ev100`]).
//! * **Colour**: linear Rec. 709 primaries in every computation, sRGB in files and textures.
//! * **Winding**: counter-clockwise is the front.

use glam::{DMat3, DVec3};

/// The same point in OpenCV's camera axes (x right, y down, z forward), in metres.
#[must_use]
pub fn cv_from_view(p_in_view: DVec3) -> DVec3 {
    DVec3::new(p_in_view.x, -p_in_view.y, -p_in_view.z)
}

/// [`cv_from_view`] as a matrix: a half turn about x.
pub const CV_FROM_VIEW: DMat3 =
    DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0]);

/// Linear scale from luminance in nits to the sensor's 0..1, for an exposure value at ISO 100:
/// `1 / (1.2 * 2^EV100)` (Lagarde and de Rousiers, "Moving Frostbite to PBR", 2014, section 5.1).
#[must_use]
pub fn exposure_from_ev100(ev100: f64) -> f64 {
    1.0 / (1.2 * libm::exp2(ev100))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposure_has_the_seeds_figures() {
        for (ev100, scale) in [(2.0, 0.208_333), (7.0, 0.006_510_4)] {
            assert!((exposure_from_ev100(ev100) / scale - 1.0).abs() < 1e-5);
        }
    }
}
