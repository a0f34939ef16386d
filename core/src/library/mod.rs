//! Assets by id: human figures, motion clips, textures and meshes.
//!
//! The only door to asset files. Values of this layer are immutable and shared by `Arc`; ids and
//! content hashes are what scenes and manifests hold. What a frame shows is not decided here.

use std::path::PathBuf;
use std::sync::Arc;

pub mod clip;
pub mod figure;
pub mod mesh;
pub mod procedural;
pub mod texture;
pub mod textures;

use clip::Clips;
use figure::{Figure, FigureError};
use texture::TextureError;
use textures::TextureLibrary;

/// Everything that scenes may name.
#[derive(Debug)]
pub struct Library {
    /// The human figure.
    pub figure: Arc<Figure>,
    /// Motion clips.
    pub clips: &'static Clips,
    /// Textures of surfaces and cloth.
    pub textures: TextureLibrary,
}

/// A library that cannot be put together.
#[derive(Debug, thiserror::Error)]
pub enum LibraryError {
    /// The figure that is part of the program is damaged.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A texture folder cannot be used.
    #[error(transparent)]
    Texture(#[from] TextureError),
}

/// The terms that an asset is under.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Licence {
    /// Id in the library.
    pub id: String,
    /// BLAKE3 hash of its bytes, where it is a file.
    pub content_hash: Option<String>,
    /// SPDX expression.
    pub licence: &'static str,
    /// Where it comes from.
    pub source: &'static str,
}

impl Library {
    /// What ships with the program, and the textures of some folders. Textures are reduced to a
    /// largest side, texels.
    ///
    /// # Errors
    /// When what ships with the program is damaged, or a folder cannot be used.
    pub fn new(texture_folders: &[PathBuf], max_texture_size: u32) -> Result<Self, LibraryError> {
        Ok(Self {
            figure: Figure::built_in()?,
            clips: Clips::built_in(),
            textures: TextureLibrary::new(texture_folders, max_texture_size)?,
        })
    }
}
