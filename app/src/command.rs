//! Every command of the window: what it is called, what it does, and its keys.

use eframe::egui::{Key, KeyboardShortcut, Modifiers};

/// Something the user can ask the window to do, by button or by key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// The frame after this one.
    NextFrame,
    /// The frame before this one.
    PreviousFrame,
    /// The config from its file once more.
    Reload,
    /// The camera that the config samples.
    DataCamera,
    /// A camera that is moved by hand, from where the picture was seen last.
    FreeCamera,
    /// The other engine.
    SwitchEngine,
    /// Boxes over the picture, on or off.
    Boxes,
    /// Keypoints over the picture, on or off.
    Keypoints,
    /// Masks over the picture, on or off.
    Masks,
    /// The whole picture.
    Fit,
    /// One pixel of the picture to one of the screen.
    ActualSize,
    /// The end.
    Quit,
}

impl Command {
    /// All of them; one whose keys hold another's stands before it.
    pub const ALL: [Self; 12] = [
        Self::PreviousFrame,
        Self::NextFrame,
        Self::Reload,
        Self::DataCamera,
        Self::FreeCamera,
        Self::SwitchEngine,
        Self::Boxes,
        Self::Keypoints,
        Self::Masks,
        Self::Fit,
        Self::ActualSize,
        Self::Quit,
    ];

    /// What stands on its button.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::NextFrame => "Next",
            Self::PreviousFrame => "Previous",
            Self::Reload => "Reload",
            Self::DataCamera => "Data",
            Self::FreeCamera => "Free",
            Self::SwitchEngine => "Switch engine",
            Self::Boxes => "Boxes",
            Self::Keypoints => "Keypoints",
            Self::Masks => "Masks",
            Self::Fit => "Fit",
            Self::ActualSize => "100 %",
            Self::Quit => "Quit",
        }
    }

    /// What it does, in a sentence.
    #[must_use]
    pub const fn tooltip(self) -> &'static str {
        match self {
            Self::NextFrame => "Shows the next frame.",
            Self::PreviousFrame => "Shows the frame before.",
            Self::Reload => "Reads the config from its file again.",
            Self::DataCamera => "Looks through the camera that the config samples, as export does.",
            Self::FreeCamera => {
                "Moves a camera of your own through the scene of this frame. Drag orbits, \
                 right drag looks around, middle drag pans, the wheel goes nearer; W A S D Q E fly, \
                 with Shift faster."
            }
            Self::SwitchEngine => "Renders with the other engine.",
            Self::Boxes => "Draws the box of each person's visible part.",
            Self::Keypoints => "Draws the 17 keypoints: filled where visible, hollow where hidden.",
            Self::Masks => "Tints the pixels of each person.",
            Self::Fit => "Shows the whole picture.",
            Self::ActualSize => "Shows one pixel of the picture as one pixel of the screen.",
            Self::Quit => "Closes the window.",
        }
    }

    /// Its keys.
    #[must_use]
    pub const fn shortcut(self) -> KeyboardShortcut {
        let (modifiers, key) = match self {
            Self::NextFrame => (Modifiers::NONE, Key::Space),
            Self::PreviousFrame => (Modifiers::SHIFT, Key::Space),
            Self::Reload => (Modifiers::COMMAND, Key::R),
            Self::DataCamera => (Modifiers::NONE, Key::Escape),
            Self::FreeCamera => (Modifiers::NONE, Key::C),
            Self::SwitchEngine => (Modifiers::NONE, Key::G),
            Self::Boxes => (Modifiers::NONE, Key::B),
            Self::Keypoints => (Modifiers::NONE, Key::K),
            Self::Masks => (Modifiers::NONE, Key::M),
            Self::Fit => (Modifiers::NONE, Key::F),
            Self::ActualSize => (Modifiers::NONE, Key::Num1),
            Self::Quit => (Modifiers::COMMAND, Key::Q),
        };
        KeyboardShortcut::new(modifiers, key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_commands_share_their_keys() {
        for (i, a) in Command::ALL.into_iter().enumerate() {
            for b in &Command::ALL[i + 1..] {
                assert_ne!(a.shortcut(), b.shortcut(), "{a:?} and {b:?}");
            }
        }
    }
}
