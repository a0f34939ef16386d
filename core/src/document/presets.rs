//! Documents that ship with the program.

/// A document that ships with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Its name, that of its file.
    pub name: &'static str,
    /// Its text, as [`super::file::parse`] reads it.
    pub text: &'static str,
}

/// All of them, the one to begin with first.
pub const ALL: [Preset; 16] = [
    Preset { name: "starter", text: include_str!("../../../presets/starter.json") },
    Preset {
        name: "peoplesanspeople",
        text: include_str!("../../../presets/peoplesanspeople.json"),
    },
    Preset { name: "psp-hdri", text: include_str!("../../../presets/psp-hdri.json") },
    Preset { name: "everyday", text: include_str!("../../../presets/everyday.json") },
    Preset { name: "crowd", text: include_str!("../../../presets/crowd.json") },
    Preset { name: "indoor", text: include_str!("../../../presets/indoor.json") },
    Preset { name: "portrait", text: include_str!("../../../presets/portrait.json") },
    Preset { name: "night", text: include_str!("../../../presets/night.json") },
    Preset { name: "lighting", text: include_str!("../../../presets/lighting.json") },
    Preset { name: "falls", text: include_str!("../../../presets/falls.json") },
    Preset { name: "lineup", text: include_str!("../../../presets/lineup.json") },
    Preset { name: "ages", text: include_str!("../../../presets/ages.json") },
    Preset { name: "faces", text: include_str!("../../../presets/faces.json") },
    Preset { name: "hair", text: include_str!("../../../presets/hair.json") },
    Preset { name: "wardrobe", text: include_str!("../../../presets/wardrobe.json") },
    Preset { name: "poses", text: include_str!("../../../presets/poses.json") },
];

/// The preset of a name.
#[must_use]
pub fn find(name: &str) -> Option<Preset> {
    ALL.into_iter().find(|p| p.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Document, file};

    #[test]
    fn every_preset_is_valid_and_says_everything() {
        for preset in ALL {
            let document =
                file::parse(preset.text).unwrap_or_else(|e| panic!("{}: {e}", preset.name));
            assert_eq!(document.name, preset.name);
            let again = file::parse(&file::text(&document)).unwrap();
            assert_eq!(again, document, "{}", preset.name);
        }
    }

    #[test]
    fn the_seeds_preset_is_the_default() {
        let preset = find("peoplesanspeople").unwrap();
        let expected = Document { name: preset.name.to_owned(), ..Document::default() };
        assert_eq!(file::parse(preset.text).unwrap(), expected);
    }
}
