//! Puts usable pictures in the place of those of a scene that cannot be used.
//!
//! Which one takes a place depends on the library alone, never on what was tried before: the next
//! one in the library's order that can be read. The scene says what it shows.

use crate::export::SkippedAsset;
use crate::library::Library;
use crate::scene::{EnvironmentSource, Scene};

/// Replaces what cannot be used; says what that was. What has no substitute stays, and drawing
/// the scene tells why it cannot be.
pub(super) fn substitute(scene: &mut Scene, library: &Library) -> Vec<SkippedAsset> {
    let mut skipped = Vec::new();
    let objects = scene.objects.iter_mut().map(|o| &mut o.material);
    let seats = scene.people.iter_mut().filter_map(|p| p.seat.as_mut()).map(|s| &mut s.material);
    let textures = library.surface_textures();
    for id in objects.chain(seats).filter_map(|material| material.texture.as_mut()) {
        replace(id, &textures, &mut skipped, |id| library.textures.get(id).map(drop));
    }
    if let Some(image) = &mut scene.lights.environment.image
        && let EnvironmentSource::Picture(id) = &mut image.source
    {
        let all = library.environments.ids();
        replace(id, all, &mut skipped, |id| library.environments.get(id).map(drop));
    }
    skipped.sort();
    skipped.dedup();
    skipped
}

/// Names the next of all ids that can be used, if this one cannot.
fn replace<E: std::error::Error>(
    id: &mut String,
    all: &[String],
    skipped: &mut Vec<SkippedAsset>,
    get: impl Fn(&str) -> Result<(), E>,
) {
    let Some(own) = all.iter().position(|known| known == id) else { return };
    for step in 0..all.len() {
        let next = &all[(own + step) % all.len()];
        match get(next) {
            Ok(()) => {
                next.clone_into(id);
                return;
            }
            Err(e) => skipped.push(SkippedAsset { id: next.clone(), reason: e.to_string() }),
        }
    }
}
