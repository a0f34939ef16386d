//! Annotations and images -> files.
//!
//! In flow a scene, the picture's pixels and the annotations of a frame; out come the files of a
//! data set. A frame goes through three steps: [`Dataset::encode`] makes bytes and touches no disk,
//! [`EncodedFrame::stage`] writes them under temporary names, and [`StagedFrame::commit`] syncs and
//! renames them, the frame's part of the index last. So a frame is whole or absent whenever the
//! program is killed, and [`Dataset::finish`] can put the index together from the parts that are
//! there. How labels came about is not decided here.

use serde::Serialize;

pub mod atomic;
mod coco;
mod dataset;
mod error;
mod folder;
mod frame_set;
mod layout;
mod manifest;
pub mod picture;
mod report;
pub mod rle;
#[cfg(test)]
pub(crate) mod sample;

pub use coco::annotation_id;
pub use dataset::{Dataset, EncodedFrame, StagedFrame};
pub use error::ExportError;
pub use folder::Existing;
pub use frame_set::FrameSet;
pub use layout::{FrameFile, Layout};
pub use manifest::{AssetLicence, DatasetInfo, FORMAT_VERSION, Identity};
pub use picture::PictureFormat;
pub use report::{FailedFrame, Report, SkippedAsset};

/// JSON to be read by people too, with a line feed at the end.
fn pretty_json(value: &impl Serialize) -> Vec<u8> {
    let mut bytes = serde_json::to_vec_pretty(value).expect(SERIALISES);
    bytes.push(b'\n');
    bytes
}

/// Why turning our own values into JSON in memory cannot fail.
const SERIALISES: &str = "plain structs with text keys always have a JSON form";
