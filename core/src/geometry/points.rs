//! Poses a few named vertices in double precision, the way the engines pose all of them.
//!
//! Linear blend skinning: a vertex goes through the weighted mean of its joints' matrices, weights
//! in 1/255 as the mesh stores them. What labels are made from comes from here; what pixels are
//! made from is skinned by the engines in single precision.

use glam::{DAffine3, DVec3};

use super::skeleton::JOINT_COUNT;
use crate::library::mesh::SkinVertex;

/// One vertex, posed: model space, metres.
#[must_use]
pub fn pose_vertex(
    model_from_rest: &[DAffine3; JOINT_COUNT],
    rest_m: DVec3,
    skin: SkinVertex,
) -> DVec3 {
    let mut posed = DVec3::ZERO;
    for (&joint, &weight) in skin.joints.iter().zip(&skin.weights) {
        if weight > 0 {
            let moved = model_from_rest[usize::from(joint)].transform_point3(rest_m);
            posed += moved * (f64::from(weight) / 255.0);
        }
    }
    posed
}

/// A weighted mean of vertices, posed: model space, metres. Each vertex comes with its rest position,
/// its joints and its weight; the weights sum to 1, single ones may be negative.
#[must_use]
pub fn pose_point(
    model_from_rest: &[DAffine3; JOINT_COUNT],
    vertices: impl Iterator<Item = (DVec3, SkinVertex, f64)>,
) -> DVec3 {
    vertices.fold(DVec3::ZERO, |sum, (rest_m, skin, weight)| {
        sum + pose_vertex(model_from_rest, rest_m, skin) * weight
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn skeleton() -> [DAffine3; JOINT_COUNT] {
        std::array::from_fn(|i| {
            DAffine3::from_translation(DVec3::new(i as f64, 0.0, -2.0 * i as f64))
        })
    }

    #[test]
    fn a_vertex_of_one_joint_moves_with_it_and_of_two_stands_between() {
        let rest = DVec3::new(0.25, 1.5, -0.5);
        let one = SkinVertex { joints: [3, 7, 0, 0], weights: [255, 0, 0, 0] };
        assert_eq!(pose_vertex(&skeleton(), rest, one), rest + DVec3::new(3.0, 0.0, -6.0));
        let two = SkinVertex { joints: [3, 8, 0, 0], weights: [51, 204, 0, 0] };
        let expected = rest + DVec3::new(7.0, 0.0, -14.0);
        assert!((pose_vertex(&skeleton(), rest, two) - expected).length() < 1e-14);
    }

    #[test]
    fn a_point_is_the_weighted_mean_of_its_vertices() {
        let at = |x: f64, joint: u8, weight: f64| {
            let skin = SkinVertex { joints: [joint, 0, 0, 0], weights: [255, 0, 0, 0] };
            (DVec3::new(x, 0.0, 0.0), skin, weight)
        };
        let p = pose_point(&skeleton(), [at(1.0, 0, 1.25), at(5.0, 2, -0.25)].into_iter());
        assert!((p - DVec3::new(1.25 - 0.25 * 7.0, 0.0, 1.0)).length() < 1e-15);
    }
}
