//! Poses: what people do who do not move, as the angles of their joints.
//!
//! In: JSON that people can write ([`file`]). Out: a [`Pose`] by its id, such as
//! `pose/sitting_chair`; poses and motion clips share one set of ids. What angles there are and
//! how far they go is told in [`angle`]; what they do to a body, in `geometry::stance`.

use std::sync::OnceLock;

pub mod angle;
mod file;

pub use file::PoseError;

use crate::document::HandShape;
use angle::Angles;

/// What the ids of poses begin with.
pub const PREFIX: &str = "pose/";

/// A pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// Its id, such as `pose/sitting_chair`.
    pub id: String,
    /// What a person does who takes it, such as `sitting`.
    pub activity: String,
    /// How the pelvis is turned from upright, applied in this order: to the left (about the
    /// vertical), forward, to the left side; degrees. The height follows from the ground.
    pub root_deg: Root,
    /// All joint angles.
    pub angles: Angles,
    /// Left and right.
    pub hands: [HandShape; 2],
    /// Left and right.
    pub feet: [Foot; 2],
    /// Whether the body tilts until it rests on the ground at both ends: who lies, sits on the
    /// floor or props himself up.
    pub rests: bool,
    /// Whether it takes something to sit on.
    pub seated: bool,
    /// What nobody takes it in, ascending.
    pub unsuited: Vec<Wear>,
    /// Share of the variation that trunk, arms and legs take part in, 0..1.
    pub freedom: Freedom,
}

/// Clothes that not every pose is taken in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wear {
    /// A skirt or a dress.
    Skirt,
    /// A jacket.
    Jacket,
    /// A coat.
    Coat,
}

impl Wear {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Skirt, Self::Jacket, Self::Coat];

    /// Its name in pose files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Skirt => "skirt",
            Self::Jacket => "jacket",
            Self::Coat => "coat",
        }
    }
}

/// How a pelvis is turned, degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Root {
    /// About the vertical, to the left.
    pub turn: f64,
    /// Forward: 90 lies on the front.
    pub pitch: f64,
    /// Sideways: 90 lies on the left side.
    pub roll: f64,
}

/// What decides how a foot is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foot {
    /// The ankle's angles.
    Free,
    /// The sole is level, as far as the ankle goes.
    Level,
    /// The sole is level, and the leg gives way so that both planted feet stand on one ground.
    Planted,
}

/// How freely parts of a pose may vary, 0..1 each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// Spine and head.
    pub trunk: f64,
    /// From the collar bones on.
    pub arms: f64,
    /// From the hips on.
    pub legs: f64,
}

impl Default for Freedom {
    fn default() -> Self {
        Self { trunk: 1.0, arms: 1.0, legs: 1.0 }
    }
}

/// A set of poses, ordered by id.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Poses {
    poses: Vec<Pose>,
    files: Vec<PoseFile>,
}

/// A file of the config's folders that poses were read from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PoseFile {
    /// Its name without the folder.
    pub name: String,
    /// BLAKE3 hash of its content, 64 hexadecimal digits.
    pub content_hash: String,
}

impl Poses {
    /// The poses that ship with the program.
    #[must_use]
    pub fn built_in() -> &'static Self {
        static POSES: OnceLock<Poses> = OnceLock::new();
        POSES.get_or_init(|| {
            const FILE: &str =
                include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/poses.json"));
            Self::parse(FILE).expect("the file is part of the program, and a test reads it")
        })
    }

    /// All poses, ordered by id.
    #[must_use]
    pub fn all(&self) -> &[Pose] {
        &self.poses
    }

    /// The files of the config's folders among what was read, in the order of the folders.
    #[must_use]
    pub fn files(&self) -> &[PoseFile] {
        &self.files
    }

    /// All ids, in order.
    pub fn ids(&self) -> impl Iterator<Item = &str> {
        self.poses.iter().map(|p| p.id.as_str())
    }

    /// The pose of an id.
    ///
    /// # Errors
    /// When there is none; the error lists what there is.
    pub fn get(&self, id: &str) -> Result<&Pose, PoseError> {
        match self.poses.binary_search_by(|p| p.id.as_str().cmp(id)) {
            Ok(i) => Ok(&self.poses[i]),
            Err(_) => Err(PoseError::Unknown {
                id: id.to_owned(),
                known: self.ids().collect::<Vec<_>>().join(", "),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use angle::Angle;

    #[test]
    fn built_in_poses_are_many_and_within_human_reach() {
        let poses = Poses::built_in();
        assert!(poses.all().len() >= 40, "{}", poses.all().len());
        for pose in poses.all() {
            assert!(pose.id.starts_with(PREFIX) && !pose.activity.is_empty(), "{}", pose.id);
            assert_eq!(poses.get(&pose.id).unwrap(), pose);
            for angle in Angle::all() {
                let [low, high] = angle.reach().limits_deg;
                let deg = pose.angles.get(angle);
                assert!((low..=high).contains(&deg), "{} {} {deg}", pose.id, angle.name());
            }
        }
        let error = poses.get("pose/sitting").unwrap_err().to_string();
        assert!(error.contains("pose/sitting_chair"), "{error}");
    }

    #[test]
    fn no_two_poses_are_alike() {
        let poses = Poses::built_in().all();
        for (i, a) in poses.iter().enumerate() {
            for b in &poses[..i] {
                let gap = |angle| (a.angles.get(angle) - b.angles.get(angle)).abs();
                let root = [a.root_deg.pitch - b.root_deg.pitch, a.root_deg.roll - b.root_deg.roll];
                let most = Angle::all().map(gap).chain(root.map(f64::abs)).fold(0.0, f64::max);
                assert!(most >= 10.0, "{} and {} differ by {most} degrees", a.id, b.id);
            }
        }
    }
}
