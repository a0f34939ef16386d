//! Everybody in the picture, in slot order.

use glam::DVec3;

use super::background::asset;
use super::place::{PEOPLE, places};
use super::value::{flag, number, rotation};
use super::{Catalogue, body, keys, look, outfit};
use crate::base::rng::Draws;
use crate::document;
use crate::scene::{Body, Person, Placement, Pose, Sex};

pub(super) fn people(
    people: &document::People,
    catalogue: &Catalogue,
    draws: Draws,
) -> Vec<Person> {
    if !people.enabled {
        return Vec::new();
    }
    let faces = look::face_shapes(&catalogue.face_targets);
    let places = places(&people.placement, &PEOPLE, draws).points;
    let person = |(slot, position_m)| {
        let body = body::body(&people.body, draws.random_if(people.body.enabled), slot);
        let traits = PersonTraits::new(&body);
        let turn = draws.of(keys::PERSON_ROTATION, slot);
        Person {
            slot,
            placement: Placement {
                position_m,
                rotation: rotation(&people.rotation_deg, DVec3::ZERO, turn),
                scale: DVec3::splat(number(&people.scale, draws.of(keys::PERSON_SCALE, slot))),
            },
            look: look::look(&people.look, &faces, traits, draws, slot),
            outfit: outfit::outfit(&people.wardrobe, &catalogue.cloth_patterns, draws, slot),
            pose: pose(&people.pose, &catalogue.clips, draws, slot),
            body,
        }
    };
    places.into_iter().map(person).collect()
}

/// What looks follow from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PersonTraits {
    /// Of the body model.
    pub(super) sex: Sex,
    /// Years.
    pub(super) age_years: f64,
    /// African, Asian, European; they sum to 1.
    pub(super) ancestry: [f64; 3],
}

impl PersonTraits {
    fn new(body: &Body) -> Self {
        Self { sex: body.sex, age_years: body.age_years, ancestry: body.ancestry }
    }
}

fn pose(pose: &document::Pose, clips: &[String], draws: Draws, slot: u32) -> Pose {
    let of = |key| draws.random_if(pose.enabled).of(key, slot);
    Pose {
        clip: asset(&pose.clip, clips, of(keys::CLIP)).unwrap_or_default(),
        phase: number(&pose.phase, of(keys::PHASE)),
        mirrored: flag(&pose.mirrored, of(keys::MIRRORED)),
    }
}
