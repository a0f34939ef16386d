//! `manifest.json`: what a data set is, what it was made from and how far it got.

use std::collections::BTreeSet;

use serde::Serialize;

use super::{FrameSet, PictureFormat};
use crate::label::annotation::SemanticClass;
use crate::plan::{Output, Outputs};
use crate::scene::Sex;

/// Version of the layout of a data set.
pub const FORMAT_VERSION: u32 = 1;

/// An asset that a data set shows, and the terms it is under.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct AssetLicence {
    /// Id in the library.
    pub id: String,
    /// BLAKE3 hash of its content, where it is a file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub content_hash: Option<String>,
    /// SPDX expression, such as `CC0-1.0`.
    pub licence: String,
    /// Where it comes from.
    pub source: String,
}

/// Somebody who recurs over the frames of a data set, as annotated in the first of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Identity {
    /// Who of those who recur it is.
    pub id: u32,
    /// What the config calls this person, if it does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Of the body model.
    pub sex: Sex,
    /// Years.
    pub age_years: f64,
    /// Standing height without shoes, metres.
    pub stature_m: f64,
    /// kg/m2.
    pub bmi_kg_m2: f64,
    /// How many annotations show this person.
    pub annotations: u64,
}

/// What stays the same over all frames of a data set.
#[derive(Clone, Debug, PartialEq)]
pub struct DatasetInfo {
    /// The document as it is written to `config.json`.
    pub config_json: String,
    /// Version of the program.
    pub program_version: String,
    /// Name of the engine, as on the command line.
    pub engine: String,
    /// The graphics adapter, where one rendered.
    pub adapter: Option<String>,
    /// The document's seed.
    pub seed: u64,
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// What is written.
    pub outputs: Outputs,
    /// How pictures are stored.
    pub picture: PictureFormat,
    /// Every asset that a frame may show.
    pub assets: BTreeSet<AssetLicence>,
}

#[derive(Serialize)]
struct File<'a> {
    format_version: u32,
    program: &'static str,
    program_version: &'a str,
    engine: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    adapter: Option<&'a str>,
    config_hash: String,
    seed: u64,
    width: u32,
    height: u32,
    outputs: &'a BTreeSet<Output>,
    /// First frame and the one after the last, for each unbroken range.
    frames_done: Vec<[u32; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    semantic_classes: Option<Vec<Class>>,
    /// Those who recur and are annotated, by their ids.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    identities: &'a [Identity],
    assets: &'a BTreeSet<AssetLicence>,
}

#[derive(Serialize)]
struct Class {
    id: u8,
    name: &'static str,
    color: [u8; 3],
}

/// The bytes of the file.
pub(super) fn to_json(info: &DatasetInfo, done: &FrameSet, identities: &[Identity]) -> Vec<u8> {
    let class = |c: SemanticClass| Class { id: c.id(), name: c.name(), color: c.color() };
    let classes = || SemanticClass::ALL.map(class).into_iter().collect();
    super::pretty_json(&File {
        format_version: FORMAT_VERSION,
        program: "figurant",
        program_version: &info.program_version,
        engine: &info.engine,
        adapter: info.adapter.as_deref(),
        config_hash: crate::base::hash::content_hash(info.config_json.as_bytes()),
        seed: info.seed,
        width: info.width,
        height: info.height,
        outputs: &info.outputs,
        frames_done: done.ranges().iter().map(|r| [r.start, r.end]).collect(),
        semantic_classes: info.outputs.contains(&Output::Semantic).then(classes),
        identities,
        assets: &info.assets,
    })
}
