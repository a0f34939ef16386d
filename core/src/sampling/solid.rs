//! Boxes round what stands in a scene, before its form is known.

use glam::{DQuat, DVec3};

/// A person at scale 1: shoulders and elbows (Fruin, "Pedestrian Planning and Design", 1971, has
/// 0.61 m across), and a tall man's height.
const PERSON_HALF_M: DVec3 = DVec3::new(0.3, 0.9, 0.3);

/// A turned box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solid {
    /// Metres, world.
    pub(super) middle_m: DVec3,
    /// Half its sides along its own axes.
    pub(super) half_m: DVec3,
    /// World from its own axes.
    pub(super) rotation: DQuat,
}

impl Solid {
    /// Of a person who stands at a place, whatever the pose.
    pub(super) fn of_person(position_m: DVec3, rotation: DQuat, scale: f64) -> Self {
        let half_m = PERSON_HALF_M * scale;
        Self { middle_m: position_m + rotation * (DVec3::Y * half_m.y), half_m, rotation }
    }

    fn axes(&self) -> [DVec3; 3] {
        [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| self.rotation * axis)
    }

    /// Half its extent along a direction.
    fn reach(&self, direction: DVec3) -> f64 {
        let [x, y, z] = self.axes().map(|axis| axis.dot(direction).abs());
        x * self.half_m.x + y * self.half_m.y + z * self.half_m.z
    }

    /// Whether two boxes share any volume: they do not where their shadows on one of fifteen lines lie
    /// apart (Gottschalk, Lin and Manocha, "OBBTree", SIGGRAPH 1996).
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        let between = other.middle_m - self.middle_m;
        let near = self.half_m.length() + other.half_m.length();
        if between.length_squared() >= near * near {
            return false;
        }
        let (ours, theirs) = (self.axes(), other.axes());
        let edges = ours.iter().flat_map(|a| theirs.iter().map(|b| a.cross(*b)));
        // Of parallel edges nothing is left but rounding; the faces decide then.
        let edges = edges.filter(|line| line.length_squared() > 1e-12);
        ours.iter()
            .chain(&theirs)
            .copied()
            .chain(edges)
            .all(|line| between.dot(line).abs() < self.reach(line) + other.reach(line))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::rotation_from_euler_deg;
    use crate::base::rng::{Draws, Key};

    fn solid(middle_m: DVec3, half_m: DVec3, turn_deg: [f64; 3]) -> Solid {
        let [x, y, z] = turn_deg;
        Solid { middle_m, half_m, rotation: rotation_from_euler_deg(x, y, z) }
    }

    #[test]
    fn boxes_overlap_from_face_to_face_and_from_edge_to_edge() {
        let unit = |x: f64, turn| solid(DVec3::X * x, DVec3::ONE, turn);
        let upright = unit(0.0, [0.0; 3]);
        for (x, turn, expected) in [
            (1.99, [0.0; 3], true),
            (2.01, [0.0; 3], false),
            // An edge comes forward by the root of two.
            (1.0 + 2f64.sqrt() - 0.01, [0.0, 45.0, 0.0], true),
            (1.0 + 2f64.sqrt() + 0.01, [0.0, 45.0, 0.0], false),
        ] {
            assert_eq!(upright.overlaps(&unit(x, turn)), expected, "{x}");
            assert_eq!(unit(x, turn).overlaps(&upright), expected, "{x}");
        }
    }

    /// Boxes with a common point overlap; a line is found between all others. Common points are
    /// looked for among many drawn in one box.
    #[test]
    fn a_common_point_means_an_overlap() {
        let mut overlaps = 0;
        for i in 0..300 {
            let mut stream = Draws::new(3, i).of(Key::new("test"), 0).stream();
            let mut vector = |scale: f64| {
                DVec3::new(stream.uniform(), stream.uniform(), stream.uniform()) * scale
            };
            let [a, b] = [0, 1].map(|_| {
                let turn = vector(360.0).to_array();
                solid(vector(2.0), vector(0.8) + DVec3::splat(0.1), turn)
            });
            let common = (0..400).any(|_| {
                let in_a = (vector(2.0) - DVec3::ONE) * a.half_m;
                let p = a.middle_m + a.rotation * in_a;
                let in_b = b.rotation.inverse() * (p - b.middle_m);
                in_b.abs().cmplt(b.half_m).all()
            });
            assert!(!common || a.overlaps(&b), "{a:?} {b:?}");
            overlaps += u32::from(a.overlaps(&b));
        }
        assert!((30..270).contains(&overlaps), "{overlaps}");
    }

    #[test]
    fn a_person_stands_on_the_ground() {
        let solid = Solid::of_person(DVec3::new(1.0, 2.0, 3.0), DQuat::IDENTITY, 2.0);
        assert_eq!(solid.middle_m, DVec3::new(1.0, 3.8, 3.0));
    }
}
