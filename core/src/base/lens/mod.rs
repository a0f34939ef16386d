//! Lens distortion in OpenCV's terms: from where a pinhole would show something to where a lens does.
//!
//! Positions are normalised: `(X / Z, Y / Z)` in OpenCV's camera axes (x right, y down), so that
//! `K` takes them to pixels. Both models are one polynomial of a vector v, with `s = |v|^2`:
//!
//! ```text
//! distorted = v (1 + c0 s + c1 s^2 + c2 s^3 + c3 s^4) + (2 p1 vx vy + p2 (s + 2 vx^2),
//!                                                       p1 (s + 2 vy^2) + 2 p2 vx vy)
//! ```
//!
//! Brown (Brown, "Decentering distortion of lenses", 1966; `cv2.projectPoints`): v is the pinhole's
//! position, `c = (k1, k2, k3, 0)`. Fisheye (Kannala and Brandt 2006; `cv2.fisheye`): v points the
//! same way and is as long as the angle off the axis in radians, `c = (k1, k2, k3, k4)`, `p = 0`.
//! What a picture needs of the way back is in [`grid`].

use glam::{DMat2, DVec2};
use serde::{Deserialize, Serialize};

pub mod grid;

pub use grid::LensGrid;

/// Farthest off the axis that a fisheye's picture may reach, radians: the plane of the pinhole in
/// which pictures are rastered has no room for much more.
const MAX_ANGLE: f64 = 80.0 / 180.0 * std::f64::consts::PI;
/// Least factor by which the polynomial may shorten anything within the picture. Where it is 0 the
/// picture folds over.
const LEAST_STRETCH: f64 = 0.2;

/// A lens with all coefficients settled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "model", rename_all = "snake_case")]
pub enum Lens {
    /// Radial and tangential: `k1, k2, p1, p2, k3` of `cv2.projectPoints`.
    Brown {
        /// Radial, of r^2.
        k1: f64,
        /// Radial, of r^4.
        k2: f64,
        /// Tangential.
        p1: f64,
        /// Tangential.
        p2: f64,
        /// Radial, of r^6.
        k3: f64,
    },
    /// By the angle off the axis: `k1..k4` of `cv2.fisheye`. All 0 is the equidistant fisheye.
    Fisheye {
        /// Of the angle's third power.
        k1: f64,
        /// Of the fifth.
        k2: f64,
        /// Of the seventh.
        k3: f64,
        /// Of the ninth.
        k4: f64,
    },
}

/// A lens that a picture cannot be taken through.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LensError {
    /// The distortion does not grow outwards.
    #[error(
        "camera.distortion: the picture folds over, or nearly does, at pixel ({x:.0}, {y:.0}), \
         expected a distorted radius that grows outwards all over it; use smaller coefficients or a \
         narrower camera.fov_vertical_deg"
    )]
    Folds {
        /// Pixels.
        x: f64,
        /// Pixels.
        y: f64,
    },
    /// A fisheye that sees too far sideways.
    #[error(
        "camera.distortion: the picture reaches {angle_deg:.1} degrees off the axis at pixel \
         ({x:.0}, {y:.0}), at most 80 can be drawn; use a narrower camera.fov_vertical_deg"
    )]
    TooWide {
        /// Off the axis.
        angle_deg: f64,
        /// Pixels.
        x: f64,
        /// Pixels.
        y: f64,
    },
}

/// The polynomial that both models are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial {
    /// Factors of s, s^2, s^3 and s^4.
    pub radial: [f64; 4],
    /// p1 and p2.
    pub tangential: [f64; 2],
    /// Whether v is as long as the angle off the axis, else as its tangent.
    pub of_angle: bool,
}

impl Lens {
    /// The name of the model, as in the document.
    #[must_use]
    pub const fn model(&self) -> &'static str {
        match self {
            Self::Brown { .. } => "brown",
            Self::Fisheye { .. } => "fisheye",
        }
    }

    /// The coefficients in OpenCV's order: k1, k2, p1, p2, k3, or k1 to k4.
    #[must_use]
    pub fn coefficients(&self) -> Vec<f64> {
        match *self {
            Self::Brown { k1, k2, p1, p2, k3 } => vec![k1, k2, p1, p2, k3],
            Self::Fisheye { k1, k2, k3, k4 } => vec![k1, k2, k3, k4],
        }
    }

    /// Whether it leaves all pictures as they are.
    #[must_use]
    pub fn is_neutral(&self) -> bool {
        matches!(self, Self::Brown { .. }) && self.coefficients().iter().all(|k| *k == 0.0)
    }

    /// Its polynomial.
    #[must_use]
    pub const fn polynomial(&self) -> Polynomial {
        match *self {
            Self::Brown { k1, k2, p1, p2, k3 } => {
                Polynomial { radial: [k1, k2, k3, 0.0], tangential: [p1, p2], of_angle: false }
            }
            Self::Fisheye { k1, k2, k3, k4 } => {
                Polynomial { radial: [k1, k2, k3, k4], tangential: [0.0; 2], of_angle: true }
            }
        }
    }

    /// Where it shows what a pinhole would show at `undistorted`; both normalised.
    #[must_use]
    pub fn distort(&self, undistorted: DVec2) -> DVec2 {
        let p = self.polynomial();
        p.distort(p.from_undistorted(undistorted))
    }

    /// The way back from a normalised position in the picture; nothing where none leads there.
    #[must_use]
    pub fn undistort(&self, distorted: DVec2) -> Option<DVec2> {
        let p = self.polynomial();
        p.solve(distorted).filter(|v| p.may_be_drawn(*v)).map(|v| p.to_undistorted(v))
    }

    /// Whether the distortion grows all the way from the middle to what a pinhole would show at
    /// `undistorted`. Farther out a polynomial may lead back into the picture, where no lens shows
    /// anything.
    #[must_use]
    pub fn reaches(&self, undistorted: DVec2) -> bool {
        const STEPS: u32 = 64;
        let p = self.polynomial();
        let v = p.from_undistorted(undistorted);
        (1..=STEPS).all(|k| {
            let at = v * (f64::from(k) / f64::from(STEPS));
            p.jacobian(at).determinant() > 0.0
        })
    }
}

impl Polynomial {
    /// The vector of a pinhole's position.
    #[must_use]
    pub fn from_undistorted(&self, u: DVec2) -> DVec2 {
        let r = u.length();
        if self.of_angle && r > 0.0 { u * (libm::atan(r) / r) } else { u }
    }

    /// The pinhole's position of a vector, which for angles must be below a right one.
    #[must_use]
    pub fn to_undistorted(&self, v: DVec2) -> DVec2 {
        let angle = v.length();
        if self.of_angle && angle > 0.0 { v * (libm::tan(angle) / angle) } else { v }
    }

    /// The distorted position.
    #[must_use]
    pub fn distort(&self, v: DVec2) -> DVec2 {
        let ([c0, c1, c2, c3], [p1, p2]) = (self.radial, self.tangential);
        let s = v.length_squared();
        let radial = 1.0 + s * (c0 + s * (c1 + s * (c2 + s * c3)));
        let cross = 2.0 * v.x * v.y;
        v * radial
            + DVec2::new(
                p1 * cross + p2 * (s + 2.0 * v.x * v.x),
                p1 * (s + 2.0 * v.y * v.y) + p2 * cross,
            )
    }

    /// The change of the distorted position with v.
    #[must_use]
    pub fn jacobian(&self, v: DVec2) -> DMat2 {
        let ([c0, c1, c2, c3], [p1, p2]) = (self.radial, self.tangential);
        let s = v.length_squared();
        let radial = 1.0 + s * (c0 + s * (c1 + s * (c2 + s * c3)));
        let slope = c0 + s * (2.0 * c1 + s * (3.0 * c2 + s * (4.0 * c3)));
        let across = 2.0 * (v.x * v.y * slope + p1 * v.x + p2 * v.y);
        DMat2::from_cols_array(&[
            radial + 2.0 * v.x * v.x * slope + 2.0 * p1 * v.y + 6.0 * p2 * v.x,
            across,
            across,
            radial + 2.0 * v.y * v.y * slope + 6.0 * p1 * v.y + 2.0 * p2 * v.x,
        ])
    }

    /// Least and largest factor by which lengths change at v; negative where it is turned over.
    #[must_use]
    pub fn stretch(&self, v: DVec2) -> [f64; 2] {
        // The Jacobian is symmetric.
        let [a, b, _, d] = self.jacobian(v).to_cols_array();
        let (middle, half) = ((a + d) * 0.5, DVec2::new((a - d) * 0.5, b).length());
        [middle - half, middle + half]
    }

    /// By how much, at most, lengths grow from a pinhole's picture to this one.
    #[must_use]
    pub fn magnification(&self, v: DVec2) -> f64 {
        // Angles grow more slowly than their tangents, most of all along the radius.
        let u = self.to_undistorted(v).length();
        self.stretch(v)[1] * if u > 0.0 { v.length() / u } else { 1.0 }
    }

    /// Whether a picture may hold what v leads to.
    #[must_use]
    pub fn may_be_drawn(&self, v: DVec2) -> bool {
        self.stretch(v)[0] >= LEAST_STRETCH && !(self.of_angle && v.length() > MAX_ANGLE)
    }

    /// The v that leads to a distorted position, on the way out from the middle.
    #[must_use]
    pub fn solve(&self, distorted: DVec2) -> Option<DVec2> {
        const STEPS: u32 = 16;
        (1..=STEPS).try_fold(DVec2::ZERO, |v, k| {
            self.solve_from(distorted * (f64::from(k) / f64::from(STEPS)), v)
        })
    }

    /// The v near another that leads to a distorted position, by Newton's method; nothing where
    /// none is found or the polynomial folds over.
    #[must_use]
    pub fn solve_from(&self, distorted: DVec2, near: DVec2) -> Option<DVec2> {
        let mut v = near;
        for _ in 0..20 {
            let jacobian = self.jacobian(v);
            let step = jacobian.inverse() * (distorted - self.distort(v));
            v += step;
            if !(jacobian.determinant() > 0.0 && v.is_finite()) {
                return None;
            }
            if step.length_squared() < 1e-28 {
                return (self.stretch(v)[0] > 0.0).then_some(v);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests;
