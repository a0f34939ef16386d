//! The people of earlier frames, kept for frames in which they come again.
//!
//! A body at rest and its dressed meshes depend on the person alone ([`MeshKey`]), not on pose,
//! place or colours. What is kept decides how long a frame takes, never what it shows.

use std::sync::Arc;

use crate::base::cache::Cache;
use crate::geometry::body::{RestBody, rest_body};
use crate::geometry::person::{Dressed, MeshKey, dress};
use crate::library::figure::{Figure, FigureError};
use crate::library::mesh::Mesh;
use crate::scene::{Person, ShoeKind};

/// Some 100 people at the levels of detail that they are mostly seen at.
const MESHES_BYTES: usize = 192 << 20;
/// Some 1,500 people.
const BODIES_BYTES: usize = 32 << 20;

/// People by what their meshes depend on; shared between threads.
#[derive(Debug)]
pub struct Cast {
    bodies: Cache<MeshKey, RestBody>,
    meshes: Cache<(MeshKey, usize), Dressed>,
}

impl Default for Cast {
    fn default() -> Self {
        Self { bodies: Cache::new(BODIES_BYTES), meshes: Cache::new(MESHES_BYTES) }
    }
}

impl Cast {
    /// A person's body at rest.
    pub(super) fn body(
        &self,
        figure: &Figure,
        key: MeshKey,
        person: &Person,
    ) -> Result<Arc<RestBody>, FigureError> {
        let make = || {
            let body = rest_body(figure, &person.body, &person.look.face)?;
            let bare = person.outfit.shoes.kind == ShoeKind::Barefoot;
            Ok(if bare { body.barefoot() } else { body })
        };
        self.bodies.get_or_make(&key, RestBody::size_bytes, make)
    }

    /// A person's mesh at a level of detail.
    pub(super) fn dressed(
        &self,
        figure: &Figure,
        key: MeshKey,
        person: &Person,
        body: &RestBody,
        lod: usize,
    ) -> Result<Arc<Dressed>, FigureError> {
        let make = || Ok(dress(figure, person, body, lod));
        self.meshes.get_or_make(&(key, lod), |d| Mesh::size_bytes(&d.mesh), make)
    }
}
