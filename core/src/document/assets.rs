//! Where users' files lie, and what becomes of pictures that cannot be used.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Folders of users' files: a list of them, or `{"folders": [...], "on_error": "skip"}`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "Form", into = "Form")]
#[schemars(with = "Form")]
pub struct Assets {
    /// Relative ones start at the config's own folder.
    pub folders: Vec<String>,
    /// What happens when a frame needs a picture that cannot be read or used.
    pub on_error: OnError,
}

/// What happens when a frame needs a picture that cannot be read or used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OnError {
    /// The frame is not written, and `report.json` says why.
    #[default]
    Stop,
    /// The next picture that can be used takes its place, in the scene's file too; `report.json`
    /// lists what was skipped and why.
    Skip,
}

/// As it stands in a config.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
enum Form {
    /// Folders; unusable pictures stop the frames that need them.
    Folders(Vec<String>),
    /// Folders, and what happens to unusable pictures in them.
    Full(Full),
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Full {
    folders: Vec<String>,
    #[serde(default)]
    on_error: OnError,
}

impl From<Form> for Assets {
    fn from(form: Form) -> Self {
        match form {
            Form::Folders(folders) => Self { folders, on_error: OnError::Stop },
            Form::Full(Full { folders, on_error }) => Self { folders, on_error },
        }
    }
}

impl From<Assets> for Form {
    fn from(Assets { folders, on_error }: Assets) -> Self {
        match on_error {
            OnError::Stop => Self::Folders(folders),
            OnError::Skip => Self::Full(Full { folders, on_error }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Document, file};

    #[test]
    fn a_list_is_a_list_and_skipping_is_said() {
        let read = |text: &str| -> Assets {
            let text = format!("{{\"version\": 1, \"assets\": {text}}}");
            let document = file::parse(&text).unwrap();
            assert_eq!(file::parse(&file::text(&document)).unwrap(), document);
            document.assets
        };
        assert_eq!(read("[]"), Document::default().assets);
        let plain = read(r#"["a", "b"]"#);
        assert_eq!((plain.folders.len(), plain.on_error), (2, OnError::Stop));
        assert_eq!(read(r#"{"folders": ["a", "b"]}"#), plain);
        let skipping = read(r#"{"folders": ["a"], "on_error": "skip"}"#);
        assert_eq!(skipping.on_error, OnError::Skip);
        for wrong in [r#"{"folder": ["a"]}"#, r#"{"folders": [], "on_error": "stay"}"#, "3"] {
            let text = format!("{{\"version\": 1, \"assets\": {wrong}}}");
            let error = file::parse(&text).unwrap_err().to_string();
            assert!(error.contains("assets"), "{error}");
        }
    }
}
