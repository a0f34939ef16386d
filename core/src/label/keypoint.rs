//! Keypoints: where they are, whether one can see them, and if not, why.
//!
//! A keypoint lies inside the body (a knee is not on the skin), so it counts as visible when the
//! surface in front of it is its own limb: the person's own surface in that pixel, and no nearer
//! to the camera than the limb is thick. COCO's flag follows: 2 visible, 1 in the picture but
//! hidden, 0 outside it (at 0, 0).

use glam::DVec2;

use super::annotation::{KEYPOINT_COUNT, Keypoint, Visibility};
use super::mask::Owners;
use crate::base::space::cv_from_view;
use crate::draw::{Drawn, DrawnPerson};
use crate::plan::Frame;
use crate::scene::Scene;

/// The 17 keypoints of a person, in COCO's order.
#[must_use]
pub fn label_all(
    scene: &Scene,
    drawn: &Drawn,
    person: &DrawnPerson,
    frame: &Frame,
    owners: &Owners,
) -> [Keypoint; KEYPOINT_COUNT] {
    let seen = Seen { drawn, frame, owners, person };
    std::array::from_fn(|k| {
        let p_in_view = person.keypoints_in_view[k];
        let at = scene.camera.project(p_in_view);
        Keypoint {
            image_px: at.unwrap_or_default().to_array(),
            camera_m: cv_from_view(p_in_view).to_array(),
            reason: match at {
                None => Visibility::BehindCamera,
                Some(_) if !scene.camera.lens_reaches(p_in_view) => Visibility::OutOfFrame,
                Some(at) => seen.judge(at, -p_in_view.z, person.keypoint_tolerance_m[k]),
            },
            visible_fraction: None,
        }
    })
}

/// What a picture shows, as far as one person's keypoints are concerned.
struct Seen<'a> {
    drawn: &'a Drawn,
    frame: &'a Frame,
    owners: &'a Owners,
    person: &'a DrawnPerson,
}

/// What stands at a pixel, compared with a keypoint that projects there.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shown {
    OwnLimb,
    OwnBody,
    InFront(u16),
    Behind,
}

impl Seen<'_> {
    /// Why a keypoint at an image position and a distance along the view axis is seen or not.
    fn judge(&self, at: DVec2, distance_m: f64, tolerance_m: f64) -> Visibility {
        let (w, h) = (f64::from(self.frame.width), f64::from(self.frame.height));
        if !(at.x >= 0.0 && at.x < w && at.y >= 0.0 && at.y < h) {
            return Visibility::OutOfFrame;
        }
        let pixel = [at.x as i64, at.y as i64];
        match self.shown(pixel, distance_m, tolerance_m) {
            Shown::OwnLimb => Visibility::Visible,
            Shown::OwnBody => Visibility::SelfOccluded,
            Shown::InFront(id) => self.hidden_by(id),
            // The point pokes out of the rendered outline by less than a pixel or two (ears, a
            // coarse level of detail): its own limb must be right beside it.
            Shown::Behind => self.nearby(pixel, distance_m, tolerance_m),
        }
    }

    fn nearby(&self, [x, y]: [i64; 2], distance_m: f64, tolerance_m: f64) -> Visibility {
        let mut best = None;
        for (dx, dy) in (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| (dx, dy))) {
            match self.shown([x + dx, y + dy], distance_m, tolerance_m) {
                Shown::OwnLimb => return Visibility::Visible,
                Shown::OwnBody => best = best.or(Some(Visibility::SelfOccluded)),
                Shown::InFront(id) => best = best.or(Some(self.hidden_by(id))),
                Shown::Behind => {}
            }
        }
        best.unwrap_or(Visibility::SelfOccluded)
    }

    fn hidden_by(&self, object_id: u16) -> Visibility {
        match self.owners.instance(object_id) {
            0 => Visibility::HiddenByObject,
            instance => Visibility::HiddenByPerson(instance),
        }
    }

    fn shown(&self, [x, y]: [i64; 2], distance_m: f64, tolerance_m: f64) -> Shown {
        let (w, h) = (i64::from(self.frame.width), i64::from(self.frame.height));
        let (Some(ids), Some(depths)) = (&self.frame.object_ids, &self.frame.depth_m) else {
            return Shown::Behind;
        };
        if !(0..w).contains(&x) || !(0..h).contains(&y) {
            return Shown::Behind;
        }
        let at = (y * w + x) as usize;
        let (id, surface_m) = (ids[at], f64::from(depths[at]));
        if id == 0 {
            return Shown::Behind;
        }
        let owner = self.owners.person(id).map(|k| &self.drawn.people[k]);
        if owner.is_some_and(|o| o.instance == self.person.instance) {
            return if surface_m >= distance_m - tolerance_m {
                Shown::OwnLimb
            } else {
                Shown::OwnBody
            };
        }
        if surface_m < distance_m { Shown::InFront(id) } else { Shown::Behind }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::draw::DrawList;

    const LIMB: f64 = 0.05;

    /// A 5x5 picture of one person (object 0) and one box (object 1).
    fn drawn() -> Drawn {
        let person = DrawnPerson {
            seat: None,
            person: 0,
            instance: 7,
            object: Some(0),
            keypoints_in_view: [DVec3::ZERO; 17],
            keypoint_tolerance_m: [LIMB; 17],
            mass_kg: 70.0,
        };
        let objects = vec![crate::draw::empty_object(), crate::draw::empty_object()];
        let list = DrawList { objects, ..DrawList::default() };
        Drawn { list, objects: vec![Some(1)], people: vec![person] }
    }

    fn judge(id: u16, depth_m: f32, at: [f64; 2]) -> Visibility {
        let drawn = drawn();
        let (ids, depth) = (vec![id; 25], vec![depth_m; 25]);
        let frame = Frame {
            width: 5,
            height: 5,
            object_ids: Some(ids),
            depth_m: Some(depth),
            ..Frame::default()
        };
        let owners = Owners::new(&drawn);
        let seen = Seen { drawn: &drawn, frame: &frame, owners: &owners, person: &drawn.people[0] };
        seen.judge(DVec2::from(at), 3.0, LIMB)
    }

    #[test]
    fn reasons_follow_from_who_stands_in_front() {
        assert_eq!(judge(1, 2.97, [2.5, 2.5]), Visibility::Visible);
        assert_eq!(judge(1, 2.5, [2.5, 2.5]), Visibility::SelfOccluded);
        assert_eq!(judge(2, 2.0, [2.5, 2.5]), Visibility::HiddenByObject);
        assert_eq!(judge(1, 2.97, [5.0, 2.5]), Visibility::OutOfFrame);
        assert_eq!(judge(1, 2.97, [-0.01, 2.5]), Visibility::OutOfFrame);
    }

    #[test]
    fn a_point_beside_its_limb_is_seen_through_the_gap() {
        let drawn = drawn();
        let mut ids = vec![0; 25];
        ids[2 * 5 + 4] = 1;
        let frame = Frame {
            width: 5,
            height: 5,
            object_ids: Some(ids),
            depth_m: Some(vec![2.98; 25]),
            ..Frame::default()
        };
        let owners = Owners::new(&drawn);
        let seen = Seen { drawn: &drawn, frame: &frame, owners: &owners, person: &drawn.people[0] };
        assert_eq!(seen.judge(DVec2::new(3.2, 2.5), 3.0, LIMB), Visibility::Visible);
    }
}
