//! Everybody in the picture, in slot order.

use glam::DVec3;

use super::background::{SEAT_LANE, finish_of};
use super::linked::{Draw, Draws, Place, Somebody, Spot};
use super::look::FaceShape;
use super::place::{PEOPLE, Places, Setting, places};
use super::solid::Solid;
use super::value::{number, rotation_at};
use super::{Catalogue, body, cast, keys, look, outfit, pose};
use crate::base::rng::{self, Key};
use crate::document::{self, Document, cast::Member};
use crate::scene::{Body, Camera, Look, Outfit, Person, Placement, Sex};

pub(super) fn people(
    document: &Document,
    catalogue: &Catalogue,
    faces: &[FaceShape],
    draws: Draws,
    camera: &Camera,
) -> Vec<Person> {
    let people = &document.people;
    let company = Company { people, catalogue, faces };
    let standing = Standing::new(people, draws, camera);
    let person = |(slot, position_m)| {
        let who = standing.who(slot);
        let (body, look, outfit) = company.person(who.known, who.lasting, who.here);
        let finish = finish_of(&document.materials, draws, slot, SEAT_LANE);
        let (pose, seat) = pose::pose(people, &outfit, catalogue, who.here, finish);
        Person {
            slot,
            identity: who.identity,
            name: who.known.name.clone(),
            placement: standing.placement(who, position_m),
            body,
            look,
            outfit,
            pose,
            seat,
        }
    };
    standing.places().points.into_iter().map(person).collect()
}

/// Who stands where in a frame, before anything else is known of anybody.
pub(super) struct Standing<'a> {
    people: &'a document::People,
    draws: Draws<'a>,
    camera: &'a Camera,
    identities: Option<Identities>,
    nobody: Member,
}

/// Who stands in a slot.
#[derive(Clone, Copy)]
struct Who<'a> {
    identity: Option<u32>,
    known: &'a Member,
    here: Source<'a>,
    lasting: Source<'a>,
}

impl<'a> Standing<'a> {
    pub(super) fn new(people: &'a document::People, draws: Draws<'a>, camera: &'a Camera) -> Self {
        let identities = people.identity_count().map(|count| Identities::new(count, draws));
        Self { people, draws, camera, identities, nobody: Member::default() }
    }

    fn who(&self, slot: u32) -> Who<'_> {
        let draws = self.draws;
        let identity = self.identities.map(|i| i.of_slot(slot));
        let listed = identity.and_then(|id| self.people.cast.get(id as usize));
        let known = listed.unwrap_or(&self.nobody);
        let here = Spot { draws: draws.keyed(), slot, turn: slot };
        // Whoever recurs has the numbers of an identity instead of those of a frame.
        let lasting = identity.map_or(here, |id| of_identity(draws.seed(), id, slot));
        let draws = draws.at(Place::Person(Somebody { here, lasting, known }));
        let [here, lasting] = [here, lasting].map(|spot| Source { draws, spot });
        Who { identity, known, here, lasting }
    }

    fn placement(&self, who: Who, position_m: DVec3) -> Placement {
        let turn = who.here.of(keys::PERSON_ROTATION);
        let camera_m = self.camera.position_m;
        Placement {
            position_m,
            rotation: rotation_at(&self.people.rotation_deg, position_m, camera_m, turn),
            scale: DVec3::splat(number(&self.people.scale, who.here.of(keys::PERSON_SCALE))),
        }
    }

    fn solid(&self, slot: u32, position_m: DVec3) -> Solid {
        let Placement { rotation, scale, .. } = self.placement(self.who(slot), position_m);
        Solid::of_person(position_m, rotation, scale.x)
    }

    /// Where people stand; nowhere if there are none.
    pub(super) fn places(&self) -> Places {
        if !self.people.enabled {
            return Places { points: Vec::new(), wanted: 0 };
        }
        let solid = |slot, position_m| self.solid(slot, position_m);
        let setting = Setting { camera: self.camera, taken: &[], solid: &solid };
        places(&self.people.placement, &PEOPLE, self.draws, setting)
    }

    /// The room that people take.
    pub(super) fn solids(&self) -> Vec<Solid> {
        let points = self.places().points.into_iter();
        points.map(|(slot, position_m)| self.solid(slot, position_m)).collect()
    }
}

/// Somebody who recurs, as a complete member; `each` in the document counts identities here.
pub(super) fn member(
    people: &document::People,
    catalogue: &Catalogue,
    faces: &[FaceShape],
    draws: Draws,
    id: u32,
) -> Member {
    let company = Company { people, catalogue, faces };
    let nobody = Member::default();
    let known = company.listed(id).unwrap_or(&nobody);
    let spot = of_identity(draws.seed(), id, id);
    let draws = draws.at(Place::Person(Somebody { here: spot, lasting: spot, known }));
    let lasting = Source { draws, spot };
    let (body, look, outfit) = company.person(known, lasting, lasting);
    // Colours and patterns that are drawn do not last.
    let what = (&body, &look, &outfit);
    cast::member(known.name.as_deref(), what, &known.wardrobe, catalogue)
}

/// What people are drawn from.
#[derive(Clone, Copy)]
struct Company<'a> {
    people: &'a document::People,
    catalogue: &'a Catalogue,
    faces: &'a [FaceShape],
}

impl<'a> Company<'a> {
    fn listed(self, id: u32) -> Option<&'a Member> {
        self.people.cast.get(id as usize)
    }

    /// Body, look and clothes of somebody.
    fn person(self, known: &Member, lasting: Source, here: Source) -> (Body, Look, Outfit) {
        let Self { people, catalogue, faces } = self;
        let body = body::body(&people.body, &known.body, lasting.random_if(people.body.enabled));
        let traits = PersonTraits::new(&body);
        let look = look::look(&people.look, &known.look, faces, traits, lasting);
        let outfit =
            outfit::outfit(&people.wardrobe, &known.wardrobe, catalogue, traits, lasting, here);
        (body, look, outfit)
    }
}

/// What an identity is drawn from, in a slot.
const fn of_identity(seed: u64, id: u32, turn: u32) -> Spot {
    Spot { draws: rng::Draws::new(seed, id), slot: 0, turn }
}

/// Where a person's random numbers come from: a slot of the frame, or what lasts over frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    draws: Draws<'a>,
    spot: Spot,
}

impl<'a> Source<'a> {
    /// Of a slot of a frame, for somebody of whom nothing is known.
    #[cfg(test)]
    pub(super) const fn new(draws: Draws<'a>, slot: u32) -> Self {
        Self { draws, spot: Spot { draws: draws.keyed(), slot, turn: slot } }
    }

    pub(super) const fn random_if(self, random: bool) -> Self {
        Self { spot: self.spot.random_if(random), ..self }
    }

    pub(super) const fn of(self, key: Key) -> Draw<'a> {
        self.draws.draw(self.spot.of(key))
    }
}

/// Who of a fixed number of people stands in which slot of a frame: `(first + slot * step) mod
/// count` with the step prime to the count, so that nobody is there twice before everybody is, and
/// no slot's person depends on how many slots there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Identities {
    count: u32,
    first: u32,
    step: u32,
}

impl Identities {
    fn new(count: u32, draws: Draws) -> Self {
        let mut stream = draws.of(keys::IDENTITY, 0).stream();
        let mut below = || stream.below(count as usize) as u32;
        let first = below();
        // Most numbers are prime to the count, 1 always is.
        let step = (0..64).map(|_| below()).find(|&s| greatest_common_divisor(s, count) == 1);
        Self { count, first, step: step.unwrap_or(1) }
    }

    const fn of_slot(self, slot: u32) -> u32 {
        let (count, step) = (self.count as u64, self.step as u64);
        ((self.first as u64 + slot as u64 * step) % count) as u32
    }
}

const fn greatest_common_divisor(mut a: u32, mut b: u32) -> u32 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn nobody_is_in_a_frame_twice_and_everybody_comes_as_often() {
        for count in [1, 2, 28, 100, 997] {
            let mut times = vec![0u32; count as usize];
            for frame in 0..4000 {
                let identities = Identities::new(count, Draws::new(5, frame));
                let who: Vec<u32> = (0..20).map(|slot| identities.of_slot(slot)).collect();
                let different: BTreeSet<u32> = who.iter().copied().collect();
                assert_eq!(different.len(), 20.min(count as usize));
                who.iter().for_each(|&id| times[id as usize] += 1);
            }
            // Chi squared over count - 1 degrees of freedom, within five standard deviations; the
            // draws of a frame exclude each other, which only lowers it.
            let expected = 80_000.0 / f64::from(count);
            let chi2: f64 =
                times.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
            let freedom = f64::from(count - 1);
            assert!(chi2 <= freedom + 5.0 * (2.0 * freedom).sqrt(), "{count}: {chi2}");
        }
    }
}
