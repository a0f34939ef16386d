//! Small maths that must give the same bits on every machine: libm and plain arithmetic only.

use glam::{DAffine3, DQuat, DVec3};

/// Rotation from Euler angles in degrees, applied about z, then x, then y
/// (`R = Ry * Rx * Rz`, the order of the system that the config descends from).
#[must_use]
pub fn rotation_from_euler_deg(x: f64, y: f64, z: f64) -> DQuat {
    let q = |axis: DVec3, deg: f64| {
        let half = deg.to_radians() * 0.5;
        let (s, c) = (libm::sin(half), libm::cos(half));
        DQuat::from_xyzw(axis.x * s, axis.y * s, axis.z * s, c)
    };
    (q(DVec3::Y, y) * q(DVec3::X, x) * q(DVec3::Z, z)).normalize()
}

/// Rotation, uniform scale and position as one affine map.
#[must_use]
pub fn affine(position: DVec3, rotation: DQuat, scale: DVec3) -> DAffine3 {
    DAffine3::from_scale_rotation_translation(scale, rotation, position)
}
