//! Frame + scene + draw list -> annotations.
//!
//! Every label is read from the same visibility samples as the picture, never from the picture
//! itself, so the two cannot disagree. What flows in is an engine's frame and what was drawn; what
//! flows out is plain values. File formats do not belong here.
//!
//! | file | label |
//! |---|---|
//! | [`box2d`] | visible boxes |
//! | [`keypoint`] | projection and visibility of keypoints |
//! | [`mask`] | instance and semantic maps |
//! | [`annotation`] | the values themselves |

pub mod annotation;
pub mod box2d;
pub mod keypoint;
pub mod mask;

use crate::draw::Drawn;
use crate::plan::{Frame, Output, Outputs};
use crate::scene::Scene;

pub use annotation::{
    Annotations, CameraLabel, Keypoint, PersonLabel, PersonMeta, SemanticClass, Visibility,
};

/// All wanted labels of one frame.
///
/// A person is annotated when at least one pixel of the picture is theirs, that is when the
/// instance map holds their id; this does not depend on which outputs are wanted.
#[must_use]
pub fn annotate(scene: &Scene, drawn: &Drawn, frame: &Frame, wanted: &Outputs) -> Annotations {
    let owners = mask::Owners::new(drawn);
    let masks = frame.object_ids.as_deref().map(|ids| mask::measure(ids, frame.width, &owners));
    let wants = |output| wanted.contains(&output);
    let mut people = Vec::new();
    for (k, drawn_person) in drawn.people.iter().enumerate() {
        let Some(extent) = masks.as_ref().and_then(|m| m[k]) else { continue };
        let person = &scene.people[drawn_person.person];
        let samples = frame
            .object_samples
            .as_ref()
            .zip(drawn_person.object)
            .map(|(all, object)| all[object as usize]);
        people.push(PersonLabel {
            instance: drawn_person.instance,
            bbox: samples
                .filter(|_| wants(Output::Box2d))
                .map(|s| box2d::visible_box(&s, &extent, drawn.list.samples)),
            mask_area: Some(extent.pixels),
            keypoints: wants(Output::Keypoints)
                .then(|| keypoint::label_all(scene, drawn, drawn_person, frame, &owners)),
            meta: PersonMeta::new(person, Some(drawn_person.mass_kg)),
        });
    }
    let ids = frame.object_ids.as_deref();
    Annotations {
        frame: scene.frame,
        width: scene.camera.width,
        height: scene.camera.height,
        camera: CameraLabel::from(&scene.camera),
        people,
        instance_ids: ids.filter(|_| wants(Output::Instance)).map(|ids| owners.instance_map(ids)),
        semantic: ids
            .filter(|_| wants(Output::Semantic))
            .map(|ids| mask::semantic_map(ids, &mask::classes(scene, drawn))),
    }
}
