//! Keyed random numbers as the samplers ask for them, and what linked parameters look at.
//!
//! The value of a parameter follows from its law, its key and its slot alone. So whoever looks at
//! another parameter draws it once more, at any time, and nothing needs an order. [`Draws`] and
//! [`Draw`] are those of [`crate::base::rng`] that also know where they are: in the frame, at a
//! surface or at a person.

use std::collections::BTreeMap;

use super::address::{Address, address};
use super::value::number;
use crate::base::rng::{self, Key, Stream};
use crate::document::cast::Member;
use crate::document::{Document, Param, Scope, linked};

/// The parameters that others look at, with where their numbers come from.
#[derive(Clone, Debug, Default)]
pub(super) struct Links {
    targets: BTreeMap<String, Target>,
}

#[derive(Clone, Debug)]
struct Target {
    param: Param,
    address: Address,
    scope: Scope,
    /// Whether it is drawn; else it takes its median.
    random: bool,
}

/// Nobody looks at anything.
#[cfg(test)]
static NONE: Links = Links { targets: BTreeMap::new() };

impl Links {
    /// Of a valid document.
    pub(super) fn new(document: &Document) -> Self {
        let target = |(path, param): (String, Param)| {
            let (address, scope) = (address(&path)?, Scope::of(&path));
            let random = is_drawn(document, &path);
            Some((path, Target { param, address, scope, random }))
        };
        Self { targets: linked(document).into_iter().filter_map(target).collect() }
    }
}

/// Whether a section that can be switched off draws the parameter.
fn is_drawn(document: &Document, path: &str) -> bool {
    let people = &document.people;
    let switches = [
        ("camera.", document.camera.enabled),
        ("materials.", document.materials.enabled),
        ("post.", document.post.enabled),
        ("people.body.", people.body.enabled),
        ("people.look.", people.look.enabled),
        ("people.wardrobe.", people.wardrobe.enabled),
        ("people.pose.", people.pose.enabled),
    ];
    switches.iter().all(|(prefix, enabled)| *enabled || !path.starts_with(prefix))
}

/// For what something is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place<'a> {
    /// The frame.
    Frame,
    /// A surface: its slot, and the lane that keeps wall, floor and occluders apart.
    Surface(u32, u16),
    /// A person.
    Person(Somebody<'a>),
}

/// A person, for whoever looks at that person's numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Somebody<'a> {
    /// Where the numbers of the frame come from.
    pub(super) here: Spot,
    /// Where those come from that last as long as the person.
    pub(super) lasting: Spot,
    /// What is known of the person.
    pub(super) known: &'a Member,
}

/// A slot of a frame, or of what lasts over frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) draws: rng::Draws,
    pub(super) slot: u32,
    /// The slot of the frame, whatever the numbers are keyed by.
    pub(super) turn: u32,
}

impl Spot {
    pub(super) const fn random_if(self, random: bool) -> Self {
        Self { draws: self.draws.random_if(random), ..self }
    }

    pub(super) const fn of(self, key: Key) -> rng::Draw {
        self.draws.of(key, self.slot).in_turn(self.turn)
    }
}

/// What can be seen from a place.
#[derive(Clone, Copy, Debug)]
struct View<'a> {
    links: &'a Links,
    frame: rng::Draws,
    place: Place<'a>,
}

impl View<'_> {
    /// The value of the parameter at a path of the document.
    fn value(self, path: &str) -> f64 {
        let target = self.links.targets.get(path).expect("a valid document links to what it holds");
        let Target { param, address: Address { key, slot, lane }, scope, random } = target;
        let frame = self.frame.random_if(*random);
        let draw = match (scope, self.place) {
            (Scope::Frame, _) => frame.of(*key, *slot).lane(*lane),
            (Scope::Surface, Place::Surface(slot, place)) => frame.of(*key, slot).lane(place),
            (Scope::Occluder, Place::Surface(slot, _)) => frame.of(*key, slot).lane(*lane),
            (Scope::Person | Scope::Lasting, Place::Person(somebody)) => {
                if let Some(known) = somebody.known.number(path) {
                    return known;
                }
                let lasts = *scope == Scope::Lasting;
                let spot = if lasts { somebody.lasting } else { somebody.here };
                spot.random_if(*random).of(*key).lane(*lane)
            }
            _ => unreachable!("a valid document links to what can be seen, {path} cannot"),
        };
        number(param, Draw { keyed: draw, view: self })
    }
}

/// The random numbers of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Draws<'a> {
    keyed: rng::Draws,
    view: View<'a>,
}

impl<'a> Draws<'a> {
    /// The numbers of a frame under a seed, where nobody looks at anything.
    #[cfg(test)]
    pub(super) const fn new(seed: u64, frame: u32) -> Self {
        Self::linked(seed, frame, &NONE)
    }

    /// The numbers of a frame under a seed.
    pub(super) const fn linked(seed: u64, frame: u32, links: &'a Links) -> Self {
        let keyed = rng::Draws::new(seed, frame);
        Self { keyed, view: View { links, frame: keyed, place: Place::Frame } }
    }

    pub(super) const fn seed(self) -> u64 {
        self.keyed.seed()
    }

    /// The numbers alone.
    pub(super) const fn keyed(self) -> rng::Draws {
        self.keyed
    }

    /// See [`rng::Draws::random_if`].
    pub(super) const fn random_if(self, random: bool) -> Self {
        Self { keyed: self.keyed.random_if(random), ..self }
    }

    /// The same numbers, seen from a place.
    pub(super) const fn at(self, place: Place<'a>) -> Self {
        Self { view: View { place, ..self.view }, ..self }
    }

    /// Other numbers, seen from the same place.
    pub(super) const fn draw(self, keyed: rng::Draw) -> Draw<'a> {
        Draw { keyed, view: self.view }
    }

    pub(super) const fn of(self, key: Key, slot: u32) -> Draw<'a> {
        self.draw(self.keyed.of(key, slot))
    }
}

/// The random numbers of one quantity of one slot; see [`rng::Draw`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Draw<'a> {
    keyed: rng::Draw,
    view: View<'a>,
}

impl Draw<'_> {
    pub(super) const fn lane(self, lane: u16) -> Self {
        Self { keyed: self.keyed.lane(lane), ..self }
    }

    pub(super) const fn turn(self) -> u32 {
        self.keyed.turn()
    }

    pub(super) const fn is_middle(self) -> bool {
        self.keyed.is_middle()
    }

    pub(super) fn uniform(self) -> f64 {
        self.keyed.uniform()
    }

    pub(super) fn uniform_at(self, index: u16) -> f64 {
        self.keyed.uniform_at(index)
    }

    pub(super) const fn stream(self) -> Stream {
        self.keyed.stream()
    }

    /// The value that the parameter at a path of the document takes here.
    pub(super) fn value_of(self, path: &str) -> f64 {
        self.view.value(path)
    }
}
