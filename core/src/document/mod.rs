//! The config as a typed value: [`Document`].
//!
//! A document is data only: `Clone + PartialEq + serde`, no handles, no NaN. It says how numbers are
//! distributed, never what they turned out to be; `sampling` draws them. Every default is that of
//! PeopleSansPeople (Ebadi et al. 2021, table "Domain Randomization Parameters"), with its
//! left-handed coordinates mirrored in x.
//!
//! [`mod@file`] reads and writes documents, [`mod@import`] makes them from the scenarios of Unity
//! Perception, [`mod@cast`] holds people who are listed in them, [`mod@measured`] reads numbers from
//! tables, [`mod@settle`] puts what stands in such files into the document, [`mod@check`] compares
//! their form with the schema, and [`validate()`] says which values make no sense. Each problem names
//! its field.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod assets;
mod camera;
pub mod cast;
pub mod check;
mod face;
pub mod file;
mod format;
pub mod import;
mod lights;
pub mod measured;
mod output;
mod param;
mod people;
mod place;
mod post;
pub mod presets;
mod scope;
pub mod settle;
mod validate;
mod vector;
mod wardrobe;

pub use assets::{Assets, OnError};
pub use camera::{Brown, Camera, DepthOfField, Distortion, Fisheye, Focus, Image, MotionBlur};
pub use face::{Expression, ExpressionKind};
pub use lights::{
    Clock, Environment, Lights, MovingLight, PointLight, Sun, SunAngles, SunDirection,
};
pub use output::{ImageFormat, Labels, Output, Quality, Scheme};
pub use param::{
    Auto, AutoWord, Beta, Binomial, Chance, Choice, Distribution, Empirical, Flag, Given,
    Lognormal, Normal, Param, Triangular, Weighted,
};
pub use people::{Ancestry, Blend, Body, Look, Origin, People, Pose, Seats};
pub use place::{
    Background, Floor, Grid, GridPlane, Ground, Materials, Occluders, Placement, PoissonDisk, Row,
    Wall,
};
pub use post::Post;
pub use scope::Scope;
pub use validate::{MAX_OBJECTS, MAX_PEOPLE, linked, params, validate};
pub use vector::{
    BoxRegion, CameraWord, Color, ColorLaw, Facing, GridRegion, JointRotation, Region, Rotation,
    RotationLaw, Round, Towards, Vector,
};
pub use wardrobe::{Bottom, Outer, OutfitRow, Season, Shoes, Top, Wardrobe};

/// Words of the config that other layers share.
pub use crate::scene::HandShape;

/// The version of the config that this program writes.
pub const VERSION: u32 = 1;

/// A config.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Document {
    /// Version of this format, 1.
    pub version: u32,
    /// What the data set is called.
    pub name: String,
    /// Key of all randomness: the same seed gives the same data set.
    pub seed: u64,
    /// How many frames there are.
    pub frames: u32,
    /// Folders of JPEG and PNG textures, of .hdr and .exr surroundings, of pose files and of files of
    /// people.
    pub assets: Assets,
    /// The picture's size.
    pub image: Image,
    /// The camera.
    pub camera: Camera,
    /// All light.
    pub lights: Lights,
    /// Wall and floor.
    pub background: Background,
    /// Clutter that hides people.
    pub occluders: Occluders,
    /// Everybody in the picture.
    pub people: People,
    /// What walls, floors and occluders are made of.
    pub materials: Materials,
    /// What happens to the light behind the lens.
    pub post: Post,
    /// How labels are made.
    pub labels: Labels,
    /// What is written.
    pub output: Output,
    /// What accuracy may cost.
    pub quality: Quality,
}

impl Default for Document {
    fn default() -> Self {
        Self {
            version: VERSION,
            name: String::new(),
            seed: 539_662_031,
            frames: 100,
            assets: Assets::default(),
            image: Image::default(),
            camera: Camera::default(),
            lights: Lights::default(),
            background: Background::default(),
            occluders: Occluders::default(),
            people: People::default(),
            materials: Materials::default(),
            post: Post::default(),
            labels: Labels::default(),
            output: Output::default(),
            quality: Quality::default(),
        }
    }
}

/// The JSON Schema (draft 2020-12) of a document.
#[must_use]
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Document).to_value()
}

/// Something wrong in a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where, as in `people.placement.separation_m` or `lights.points[2].range_m`; empty for the whole.
    pub path: String,
    /// What is wrong and what was expected.
    pub message: String,
    /// What was probably meant.
    pub suggestion: Option<String>,
}

impl Problem {
    /// A problem without a suggestion.
    pub fn new(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self { path: path.into(), message: message.into(), suggestion: None }
    }

    /// The same with the nearest of some words suggested, if one is near.
    #[must_use]
    pub fn did_you_mean<'a>(
        mut self,
        word: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        self.suggestion = nearest(word, known);
        self
    }
}

impl std::fmt::Display for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let path = if self.path.is_empty() { "config" } else { &self.path };
        write!(f, "{path}: {}", self.message)?;
        match &self.suggestion {
            Some(suggestion) => write!(f, "; did you mean `{suggestion}`?"),
            None => Ok(()),
        }
    }
}

/// The word most like another one, by Jaro-Winkler similarity, if any is like it.
fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let word = word.to_lowercase();
    known
        .into_iter()
        .map(|k| (strsim::jaro_winkler(&word, &k.to_lowercase()), k))
        .filter(|(similarity, _)| *similarity > 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, k)| k.to_owned())
}
