//! For what a parameter is drawn: the frame, a person, an object.

/// Within what a parameter has one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The frame.
    Frame,
    /// A surface: wall, floor or one occluder.
    Surface,
    /// One occluder.
    Occluder,
    /// One person in one frame.
    Person,
    /// One person, in all frames where that person comes again.
    Lasting,
}

impl Scope {
    /// Of the parameter at a path.
    #[must_use]
    pub fn of(path: &str) -> Self {
        let starts = |prefixes: &[&str]| prefixes.iter().any(|p| path.starts_with(p));
        // Colours of clothes are drawn anew in each frame, their cut lasts.
        let dyed = [".color", "_color", ".hue_offset_deg"].iter().any(|name| path.contains(name));
        let cut = path.starts_with("people.wardrobe.") && !dyed;
        if starts(&["people.placement.count", "occluders.placement.count"]) {
            Self::Frame
        } else if cut || starts(&["people.body.", "people.look."]) {
            Self::Lasting
        } else if starts(&["people."]) {
            Self::Person
        } else if starts(&["occluders."]) {
            Self::Occluder
        } else if starts(&["materials."]) {
            Self::Surface
        } else {
            Self::Frame
        }
    }

    /// Of a parameter as one that looks at others: depths are drawn before anybody is there.
    #[must_use]
    pub fn of_holder(path: &str) -> Self {
        if path.ends_with(".placement.depth_m") { Self::Frame } else { Self::of(path) }
    }

    /// Why a parameter cannot be seen from another, if it cannot. `recur` says whether people come
    /// again.
    #[must_use]
    pub const fn hidden_from(self, holder: Self, recur: bool) -> Option<&'static str> {
        match (holder, self) {
            (Self::Lasting, Self::Frame | Self::Person) if recur => Some(
                "the one lasts as long as the person does, the other changes from frame to frame; \
                 look at what lasts, or set people.identities to null",
            ),
            (_, Self::Frame)
            | (Self::Person | Self::Lasting, Self::Person | Self::Lasting)
            | (Self::Occluder, Self::Occluder | Self::Surface)
            | (Self::Surface, Self::Surface) => None,
            (_, Self::Person | Self::Lasting) => {
                Some("that is drawn for each person; only a person's own parameters can look at it")
            }
            (_, Self::Occluder | Self::Surface) => Some(
                "that is drawn for each object; only an object's own parameters can look at it",
            ),
        }
    }
}
