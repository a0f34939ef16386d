//! `report.json`: which frames are missing, and why.

use std::collections::BTreeSet;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::FrameSet;

/// A frame that could not be made.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct FailedFrame {
    /// Frame number.
    pub frame: u32,
    /// What went wrong.
    pub reason: String,
}

/// A picture that could not be used, and in whose place another one stands.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct SkippedAsset {
    /// Its id.
    pub id: String,
    /// What is wrong with it.
    pub reason: String,
}

/// How an export went. It holds no times, so that equal runs give equal files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// The frames that were asked for.
    pub asked: Range<u32>,
    /// The frames that are in the data set.
    pub done: FrameSet,
    /// The frames that are not, for they went wrong.
    pub failed: Vec<FailedFrame>,
    /// Pictures that were passed over in this run; the file lists those of all frames that are there.
    pub skipped: BTreeSet<SkippedAsset>,
    /// Whether the run was stopped before it came to all frames.
    pub interrupted: bool,
}

#[derive(Serialize)]
struct File<'a> {
    frames_asked: [u32; 2],
    frames_done: u64,
    interrupted: bool,
    failed: Vec<&'a FailedFrame>,
    #[serde(skip_serializing_if = "BTreeSet::is_empty")]
    skipped_assets: &'a BTreeSet<SkippedAsset>,
}

impl Report {
    /// Whether every frame that was asked for is there.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.asked.clone().all(|frame| self.done.contains(frame))
    }

    /// The bytes of the file; frames in ascending order.
    pub(super) fn to_json(&self, skipped_assets: &BTreeSet<SkippedAsset>) -> Vec<u8> {
        let mut failed: Vec<_> = self.failed.iter().collect();
        failed.sort();
        super::pretty_json(&File {
            frames_asked: [self.asked.start, self.asked.end],
            frames_done: self.done.len(),
            interrupted: self.interrupted,
            failed,
            skipped_assets,
        })
    }
}
