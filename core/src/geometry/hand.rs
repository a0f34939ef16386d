//! What fingers do.

use glam::{DQuat, DVec3};

use super::skeleton::{JOINT_COUNT, Limb, Side};
use super::stance::turn;
use crate::scene::HandShape;

/// A hand beyond the rest pose, whose fingers are nearly straight; thumb, index, middle, ring and
/// little finger, degrees.
struct Fingers {
    /// Curl of the three segments, towards the palm.
    curl_deg: [[f64; 3]; 5],
    /// Turn of the whole finger away from the middle one.
    spread_deg: [f64; 5],
    /// Turn of the thumb's three segments across the palm.
    across_deg: [f64; 3],
}

const fn fingers(shape: HandShape) -> Fingers {
    match shape {
        HandShape::Relaxed => Fingers {
            curl_deg: [
                [6.0, 10.0, 12.0],
                [16.0, 20.0, 12.0],
                [20.0, 26.0, 15.0],
                [23.0, 29.0, 17.0],
                [24.0, 31.0, 19.0],
            ],
            spread_deg: [0.0; 5],
            across_deg: [0.0; 3],
        },
        HandShape::Flat => Fingers {
            curl_deg: [
                [-12.0, -4.0, 0.0],
                [2.0, 2.0, 1.0],
                [2.0, 2.0, 1.0],
                [2.0, 2.0, 1.0],
                [2.0, 2.0, 1.0],
            ],
            spread_deg: [-10.0, -8.0, 0.0, -7.0, -14.0],
            across_deg: [0.0; 3],
        },
        HandShape::Spread => Fingers {
            curl_deg: [
                [-4.0, -4.0, 0.0],
                [-2.0, 4.0, 3.0],
                [0.0, 5.0, 3.0],
                [0.0, 5.0, 3.0],
                [-2.0, 5.0, 3.0],
            ],
            spread_deg: [14.0, 9.0, 0.0, 7.0, 13.0],
            across_deg: [0.0; 3],
        },
        HandShape::Grip => Fingers {
            curl_deg: [
                [22.0, 10.0, 8.0],
                [46.0, 52.0, 26.0],
                [50.0, 54.0, 28.0],
                [52.0, 56.0, 30.0],
                [54.0, 56.0, 30.0],
            ],
            spread_deg: [0.0, -6.0, 0.0, -5.0, -10.0],
            across_deg: [0.0, 14.0, 18.0],
        },
        HandShape::Fist => Fingers {
            curl_deg: FIST_DEG,
            spread_deg: [0.0, -8.0, 0.0, -6.0, -12.0],
            across_deg: FIST_THUMB_DEG,
        },
        HandShape::Point => {
            let [thumb, _, middle, ring, little] = FIST_DEG;
            Fingers {
                curl_deg: [thumb, [4.0, 6.0, 4.0], middle, ring, little],
                spread_deg: [0.0, -6.0, 0.0, -6.0, -12.0],
                across_deg: FIST_THUMB_DEG,
            }
        }
    }
}

/// The thumb lies across the other fingers.
const FIST_THUMB_DEG: [f64; 3] = [8.0, 38.0, 50.0];

const FIST_DEG: [[f64; 3]; 5] = [
    [22.0, 12.0, 4.0],
    [74.0, 92.0, 56.0],
    [78.0, 94.0, 56.0],
    [80.0, 94.0, 56.0],
    [82.0, 92.0, 54.0],
];

/// Bends the fingers of one hand; the hand's own rotation is set already.
pub(super) fn bend(
    rest_m: &[DVec3; JOINT_COUNT],
    side: Side,
    shape: HandShape,
    rotations: &mut [DQuat; JOINT_COUNT],
) {
    let at = |limb: Limb| rest_m[side.joint(limb)];
    let hand = at(Limb::Hand);
    // Out of the palm: index, wrist and little finger lie in the plane of the hand.
    let across = (at(Limb::Pinky1) - hand).cross(at(Limb::Index1) - hand);
    let palm = match side {
        Side::Left => across,
        Side::Right => -across,
    };
    let shape = fingers(shape);
    let all = [Limb::Thumb1, Limb::Index1, Limb::Middle1, Limb::Ring1, Limb::Pinky1];
    for (i, finger) in all.into_iter().enumerate() {
        let first = side.joint(finger);
        let direction = rest_m[first + 1] - rest_m[first];
        // Without an axis (joints that coincide) the finger stays straight.
        let axis = direction.cross(palm).normalize_or_zero();
        let away = direction.cross(rest_m[first] - at(Limb::Middle1)).normalize_or_zero();
        let bend = |axis: DVec3, deg: f64| {
            if axis == DVec3::ZERO { DQuat::IDENTITY } else { turn(axis, deg) }
        };
        let mut rotation = rotations[side.joint(Limb::Hand)] * bend(away, shape.spread_deg[i]);
        for (segment, degrees) in shape.curl_deg[i].into_iter().enumerate() {
            rotation *= bend(axis, degrees);
            if finger == Limb::Thumb1 {
                rotation *= bend(-away, shape.across_deg[segment]);
            }
            rotation = rotation.normalize();
            rotations[first + segment] = rotation;
        }
    }
}
