//! Instance and semantic maps: which person, and which class, a pixel shows.
//!
//! A pixel belongs to the object that most of its samples show; of equals, to the nearest.

use super::annotation::SemanticClass;
use crate::draw::Drawn;
use crate::scene::Scene;

/// Which person, if any, each object of a draw list belongs to.
#[derive(Clone, Debug)]
pub struct Owners {
    /// By object id (object index plus one): index in the drawn people plus one, or 0.
    person_of_id: Vec<u16>,
    /// By object id: instance id, or 0.
    instance_of_id: Vec<u16>,
    /// How many people were drawn or left out.
    people: usize,
}

/// Extent of the pixels of one person.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// How many pixels.
    pub pixels: u64,
    /// First column and row.
    pub min: [u32; 2],
    /// Last column and row, inclusive.
    pub max: [u32; 2],
}

impl Owners {
    /// Reads the owners off what was drawn.
    #[must_use]
    pub fn new(drawn: &Drawn) -> Self {
        let ids = drawn.list.objects.len() + 1;
        let (mut person_of_id, mut instance_of_id) = (vec![0; ids], vec![0; ids]);
        for (k, person) in drawn.people.iter().enumerate() {
            if let Some(object) = person.object {
                person_of_id[object as usize + 1] = k as u16 + 1;
                instance_of_id[object as usize + 1] = person.instance;
            }
        }
        Self { person_of_id, instance_of_id, people: drawn.people.len() }
    }

    /// Index in the drawn people of an object id's owner.
    #[must_use]
    pub fn person(&self, object_id: u16) -> Option<usize> {
        match self.person_of_id[usize::from(object_id)] {
            0 => None,
            k => Some(usize::from(k) - 1),
        }
    }

    /// Instance id of an object id's owner, 0 for what is nobody's.
    #[must_use]
    pub fn instance(&self, object_id: u16) -> u16 {
        self.instance_of_id[usize::from(object_id)]
    }

    /// The picture's instance ids.
    #[must_use]
    pub fn instance_map(&self, object_ids: &[u16]) -> Vec<u16> {
        object_ids.iter().map(|&id| self.instance_of_id[usize::from(id)]).collect()
    }
}

/// Extent of each drawn person's pixels, absent for who owns none.
#[must_use]
pub fn measure(object_ids: &[u16], width: u32, owners: &Owners) -> Vec<Option<Extent>> {
    let mut extents = vec![None; owners.people];
    for (y, row) in object_ids.chunks_exact(width.max(1) as usize).enumerate() {
        let mut x = 0;
        for run in row.chunk_by(|a, b| a == b) {
            if let Some(person) = owners.person(run[0]) {
                add_run(&mut extents[person], [x as u32, y as u32], run.len() as u32);
            }
            x += run.len();
        }
    }
    extents
}

fn add_run(extent: &mut Option<Extent>, [x, y]: [u32; 2], length: u32) {
    let last = x + length - 1;
    let e = extent.get_or_insert(Extent { pixels: 0, min: [x, y], max: [last, y] });
    e.pixels += u64::from(length);
    e.min = [e.min[0].min(x), e.min[1].min(y)];
    e.max = [e.max[0].max(last), e.max[1].max(y)];
}

/// Class id by object id.
#[must_use]
pub fn classes(scene: &Scene, drawn: &Drawn) -> Vec<u8> {
    let mut classes = vec![SemanticClass::Background.id(); drawn.list.objects.len() + 1];
    for (object, drawn_as) in scene.objects.iter().zip(&drawn.objects) {
        if let Some(index) = *drawn_as {
            classes[index as usize + 1] = SemanticClass::from(object.role).id();
        }
    }
    for person in &drawn.people {
        let own = [(person.object, SemanticClass::Person), (person.seat, SemanticClass::Occluder)];
        for (index, class) in own {
            if let Some(index) = index {
                classes[index as usize + 1] = class.id();
            }
        }
    }
    classes
}

/// Class ids, row by row.
#[must_use]
pub fn semantic_map(object_ids: &[u16], classes: &[u8]) -> Vec<u8> {
    object_ids.iter().map(|&id| classes[usize::from(id)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn owners() -> Owners {
        Owners { person_of_id: vec![0, 1, 0, 2], instance_of_id: vec![0, 5, 0, 9], people: 3 }
    }

    #[test]
    fn extents_are_those_of_a_plain_count() {
        let ids = [0, 1, 1, 0, 3, 2, 2, 1, 3, 0, 0, 0];
        let found = measure(&ids, 4, &owners());
        assert_eq!(found[0], Some(Extent { pixels: 3, min: [1, 0], max: [3, 1] }));
        assert_eq!(found[1], Some(Extent { pixels: 2, min: [0, 1], max: [0, 2] }));
    }

    #[test]
    fn who_owns_no_pixel_has_no_extent() {
        let found = measure(&[0, 2, 3, 0], 2, &owners());
        assert_eq!((found.len(), found[0], found[2]), (3, None, None));
    }

    #[test]
    fn the_instance_map_names_people_only() {
        assert_eq!(owners().instance_map(&[0, 1, 2, 3]), [0, 5, 0, 9]);
    }
}
