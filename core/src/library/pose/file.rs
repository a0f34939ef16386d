//! Reads pose files and refuses what no human body does.
//!
//! ```json
//! {"poses": {
//!     "waving": {
//!         "activity": "waving",
//!         "trunk": {"head_twist": 10},
//!         "both": {"hand": "relaxed", "foot": "planted"},
//!         "right": {"shoulder_abduction": 120, "elbow_flexion": 70, "hand": "flat"}
//!     }
//! }}
//! ```
//!
//! `trunk`, `both`, `left` and `right` hold the angles of [`super::angle`] in degrees; those left
//! out are 0, and a side's own come before those of `both`. `root` turns the pelvis (`turn`,
//! `pitch`, `roll`, degrees). `hand` is a shape of the fingers; `foot` is `free`, `level` or
//! `planted` on the ground, and the ankle follows. Where `rests` is true, the body tilts until it
//! rests on the ground. Where `seated` is true, it takes something to sit on. `unsuited` lists what
//! nobody wears in it: `skirt` (dresses too), `jacket`, `coat`.
//! `freedom` (`trunk`, `arms`, `legs`, 0..1) says how much of a variation the pose can bear.

use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::angle::{Angles, Reach, SIDE, SIDE_NAMES, TRUNK};
use super::{Foot, Freedom, PREFIX, Pose, PoseFile, Poses, Root, Wear};
use crate::base::hash::content_hash;
use crate::document::file::MAX_BYTES;
use crate::document::{self, HandShape, Problem};

/// What can be wrong with poses.
#[derive(Debug, thiserror::Error)]
pub enum PoseError {
    /// Not JSON.
    #[error("the pose file is not JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The JSON does not say poses, or one that no human body takes.
    #[error("pose file: {0}")]
    Problem(Problem),
    /// Not text.
    #[error("the pose file is not UTF-8 text: {0}; expected JSON")]
    Text(#[from] std::str::Utf8Error),
    /// More than poses need.
    #[error("the pose file {path} has more than {MAX_BYTES} bytes; split it into several files")]
    TooLarge {
        /// The file.
        path: PathBuf,
    },
    /// A file cannot be read.
    #[error("the pose file {path} cannot be read: {source}")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// What is wrong in a certain file.
    #[error("{path}: {source}")]
    In {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: Box<PoseError>,
    },
    /// No such pose.
    #[error("there is no pose \"{id}\"; there are: {known}")]
    Unknown {
        /// What was asked for.
        id: String,
        /// All ids.
        known: String,
    },
}

/// What names of pose files in the config's folders end in.
pub const FILE_ENDING: &str = ".poses.json";

/// Turns of the pelvis go once round at most, degrees.
const TURN_DEG: f64 = 360.0;

type Result<T> = std::result::Result<T, PoseError>;
type Fields = Map<String, Value>;

impl Poses {
    /// Reads a pose file.
    ///
    /// # Errors
    /// When it is not JSON of the form of this page, or an angle is beyond what joints can do; the
    /// error names the pose and the joint.
    pub fn parse(text: &str) -> Result<Self> {
        let value: Value = serde_json::from_str(text)?;
        let root = fields(&value, "")?;
        known(root, "", &["poses"])?;
        let poses = root.get("poses").ok_or_else(|| problem("poses", "missing".to_owned()))?;
        let all = fields(poses, "poses")?.iter();
        let mut poses = all.map(|(name, value)| pose(name, value)).collect::<Result<Vec<_>>>()?;
        poses.sort_by(|a, b| a.id.cmp(&b.id));
        Ok(Self { poses, files: Vec::new() })
    }

    /// These poses and those of all pose files that lie in some folders; whichever is read later
    /// takes the place of one of the same name.
    ///
    /// # Errors
    /// When a file cannot be read or is refused.
    pub fn with_folders(mut self, folders: &[PathBuf]) -> Result<Self> {
        for path in folders.iter().flat_map(|folder| files(folder)) {
            let bytes = document::file::read(&path)
                .map_err(|source| PoseError::Unreadable { path: path.clone(), source })?
                .ok_or_else(|| PoseError::TooLarge { path: path.clone() })?;
            let within = |source| PoseError::In { path: path.clone(), source: Box::new(source) };
            let text = std::str::from_utf8(&bytes).map_err(|e| within(e.into()))?;
            let more = Self::parse(text).map_err(within)?;
            self.poses.retain(|p| more.get(&p.id).is_err());
            self.poses.extend(more.poses);
            self.poses.sort_by(|a, b| a.id.cmp(&b.id));
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            self.files.push(PoseFile { name, content_hash: content_hash(&bytes) });
        }
        Ok(self)
    }
}

/// The pose files of a folder, in order; none where it cannot be read, which the reader of its
/// pictures reports.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> =
        entries.map(|e| e.path()).filter(|p| p.to_string_lossy().ends_with(FILE_ENDING)).collect();
    paths.sort();
    paths
}

fn problem(path: &str, message: String) -> PoseError {
    PoseError::Problem(Problem::new(if path.is_empty() { "file" } else { path }, message))
}

fn fields<'a>(value: &'a Value, path: &str) -> Result<&'a Fields> {
    value.as_object().ok_or_else(|| problem(path, format!("expected an object {{ }}, got {value}")))
}

/// Refuses fields that are not among some names.
fn known(fields: &Fields, path: &str, names: &[&str]) -> Result<()> {
    match fields.keys().find(|k| !names.contains(&k.as_str())) {
        None => Ok(()),
        Some(name) => {
            let at = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
            let message = format!("unknown, known here are {}", names.join(", "));
            let found = Problem::new(at, message).did_you_mean(name, names.iter().copied());
            Err(PoseError::Problem(found))
        }
    }
}

fn pose(name: &str, value: &Value) -> Result<Pose> {
    let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if name.is_empty() || !name.chars().all(is_plain) {
        let message = "a pose is named with small letters, digits and _".to_owned();
        return Err(problem(&format!("poses.{name}"), message));
    }
    let all = fields(value, name)?;
    let parts = [
        "activity", "rests", "seated", "unsuited", "root", "trunk", "both", "left", "right",
        "freedom",
    ];
    known(all, name, &parts)?;
    let activity = match all.get("activity") {
        Some(Value::String(text)) if !text.is_empty() => text.clone(),
        other => {
            let got = other.map_or("nothing".to_owned(), ToString::to_string);
            let message = format!("must say what the person does, got {got}");
            return Err(problem(&format!("{name}.activity"), message));
        }
    };
    let flag = |field: &str| match all.get(field) {
        None => Ok(false),
        Some(Value::Bool(flag)) => Ok(*flag),
        Some(other) => {
            let message = format!("must be true or false, got {other}");
            Err(problem(&format!("{name}.{field}"), message))
        }
    };
    let part = |part: &'static str| -> Result<Part> {
        let path = format!("{name}.{part}");
        let fields = all.get(part).map(|v| fields(v, &path)).transpose()?;
        Ok(Part { fields, path })
    };
    let (both, sides) = (part("both")?, [part("left")?, part("right")?]);
    both.known_on_a_side()?;
    let mut out = Pose {
        id: format!("{PREFIX}{name}"),
        activity,
        root_deg: root(&part("root")?)?,
        angles: Angles::default(),
        hands: [HandShape::Relaxed; 2],
        feet: [Foot::Free; 2],
        rests: flag("rests")?,
        seated: flag("seated")?,
        unsuited: unsuited(all.get("unsuited"), &format!("{name}.unsuited"))?,
        freedom: freedom(&part("freedom")?)?,
    };
    let trunk = part("trunk")?;
    trunk.known(TRUNK.iter().map(|r| r.name))?;
    for (angle, reach) in out.angles.trunk_deg.iter_mut().zip(&TRUNK) {
        *angle = trunk.angle(reach)?.unwrap_or(0.0);
    }
    for (i, side) in sides.iter().enumerate() {
        side.known_on_a_side()?;
        for (angle, reach) in out.angles.side_deg[i].iter_mut().zip(&SIDE) {
            *angle = side.angle(reach)?.or(both.angle(reach)?).unwrap_or(0.0);
        }
        if let Some(hand) = side.hand()?.or(both.hand()?) {
            out.hands[i] = hand;
        }
        out.feet[i] = side.foot()?.or(both.foot()?).unwrap_or(Foot::Free);
        elbow_stays_out(&out.angles.side_deg[i], &format!("{name}.{}", SIDE_NAMES[i]))?;
    }
    Ok(out)
}

fn unsuited(value: Option<&Value>, path: &str) -> Result<Vec<Wear>> {
    let none = Vec::new();
    let list = match value {
        None => &none,
        Some(Value::Array(list)) => list,
        Some(other) => {
            return Err(problem(path, format!("expected a list of clothes [ ], got {other}")));
        }
    };
    let wear = |(i, item): (usize, &Value)| {
        let found = Wear::ALL.into_iter().find(|wear| item.as_str() == Some(wear.name()));
        found.ok_or_else(|| {
            let names = Wear::ALL.map(Wear::name).join(", ");
            problem(&format!("{path}[{i}]"), format!("must be one of {names}, got {item}"))
        })
    };
    let mut all = list.iter().enumerate().map(wear).collect::<Result<Vec<_>>>()?;
    all.sort_unstable();
    all.dedup();
    Ok(all)
}

fn root(part: &Part) -> Result<Root> {
    part.known(["turn", "pitch", "roll"])?;
    let angle =
        |name| -> Result<f64> { Ok(part.number(name, [-TURN_DEG, TURN_DEG])?.unwrap_or(0.0)) };
    Ok(Root { turn: angle("turn")?, pitch: angle("pitch")?, roll: angle("roll")? })
}

fn freedom(part: &Part) -> Result<Freedom> {
    part.known(["trunk", "arms", "legs"])?;
    let share = |name| -> Result<f64> { Ok(part.number(name, [0.0, 1.0])?.unwrap_or(1.0)) };
    Ok(Freedom { trunk: share("trunk")?, arms: share("arms")?, legs: share("legs")? })
}

/// An arm crosses the body only in front of it or behind it.
fn elbow_stays_out(side_deg: &[f64], path: &str) -> Result<()> {
    use super::angle::Limb::{ShoulderAbduction, ShoulderFlexion};
    let (flexion, abduction) =
        (side_deg[ShoulderFlexion as usize], side_deg[ShoulderAbduction as usize]);
    let lowest = if flexion >= 20.0 || flexion <= -15.0 { -60.0 } else { -15.0 };
    if abduction >= lowest {
        return Ok(());
    }
    let message = format!(
        "must be {lowest} or more while shoulder_flexion is {flexion}, got {abduction}: the arm is inside the trunk"
    );
    Err(problem(&format!("{path}.shoulder_abduction"), message))
}

/// A part of a pose, where it is there.
struct Part<'a> {
    fields: Option<&'a Fields>,
    path: String,
}

impl Part<'_> {
    fn known<'b>(&self, names: impl IntoIterator<Item = &'b str>) -> Result<()> {
        let names: Vec<&str> = names.into_iter().collect();
        self.fields.map_or(Ok(()), |f| known(f, &self.path, &names))
    }

    fn known_on_a_side(&self) -> Result<()> {
        self.known(SIDE.iter().map(|r| r.name).chain(["hand", "foot"]))
    }

    fn get(&self, name: &str) -> Option<&Value> {
        self.fields.and_then(|f| f.get(name))
    }

    fn number(&self, name: &str, [low, high]: [f64; 2]) -> Result<Option<f64>> {
        let Some(value) = self.get(name) else { return Ok(None) };
        match value.as_f64() {
            Some(number) if (low..=high).contains(&number) => Ok(Some(number)),
            _ => {
                let message = format!("must be a number from {low} to {high}, got {value}");
                Err(problem(&format!("{}.{name}", self.path), message))
            }
        }
    }

    fn angle(&self, reach: &Reach) -> Result<Option<f64>> {
        self.number(reach.name, reach.limits_deg)
    }

    fn word<'b>(&self, name: &str, words: &[&'b str]) -> Result<Option<&'b str>> {
        let Some(value) = self.get(name) else { return Ok(None) };
        let word = value.as_str().unwrap_or_default();
        if let Some(known) = words.iter().find(|w| **w == word) {
            return Ok(Some(known));
        }
        let message = format!("must be one of {}, got {value}", words.join(", "));
        let found = Problem::new(format!("{}.{name}", self.path), message);
        Err(PoseError::Problem(found.did_you_mean(word, words.iter().copied())))
    }

    fn hand(&self) -> Result<Option<HandShape>> {
        let names = HandShape::ALL.map(HandShape::name);
        let word = self.word("hand", &names)?;
        Ok(HandShape::ALL.into_iter().find(|h| Some(h.name()) == word))
    }

    fn foot(&self) -> Result<Option<Foot>> {
        Ok(self.word("foot", &["free", "level", "planted"])?.map(|word| match word {
            "level" => Foot::Level,
            "planted" => Foot::Planted,
            _ => Foot::Free,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::pose::angle::{Limb, Trunk};

    fn read(pose: &str) -> Result<Pose> {
        let text = format!(r#"{{"poses": {{"p": {pose}}}}}"#);
        Ok(Poses::parse(&text)?.get("pose/p")?.clone())
    }

    #[test]
    fn sides_come_before_both_and_the_rest_is_zero() {
        let pose = read(
            r#"{"activity": "testing", "rests": true, "seated": true, "unsuited": ["coat", "skirt", "coat"],
            "root": {"pitch": -90}, "trunk": {"head_twist": 12},
            "both": {"knee_flexion": 30, "hip_flexion": 10, "hand": "fist", "foot": "planted"},
            "right": {"knee_flexion": 40, "hand": "point", "foot": "free"},
            "freedom": {"legs": 0.25}}"#,
        )
        .unwrap();
        assert_eq!((pose.activity.as_str(), pose.rests, pose.seated), ("testing", true, true));
        assert_eq!(pose.unsuited, [Wear::Skirt, Wear::Coat]);
        assert_eq!(pose.root_deg, Root { pitch: -90.0, ..Root::default() });
        let mut angles = Angles::default();
        angles.trunk_deg[Trunk::HeadTwist as usize] = 12.0;
        for (side, knee) in [30.0, 40.0].into_iter().enumerate() {
            angles.side_deg[side][Limb::KneeFlexion as usize] = knee;
            angles.side_deg[side][Limb::HipFlexion as usize] = 10.0;
        }
        assert_eq!(pose.angles, angles);
        assert_eq!(pose.hands, [HandShape::Fist, HandShape::Point]);
        assert_eq!(pose.feet, [Foot::Planted, Foot::Free]);
        assert_eq!(pose.freedom, Freedom { trunk: 1.0, arms: 1.0, legs: 0.25 });
    }

    #[test]
    fn what_no_body_does_is_refused_with_pose_joint_and_limit() {
        for (pose, expected) in [
            (
                r#"{"activity": "a", "left": {"knee_flexion": -40}}"#,
                "pose file: p.left.knee_flexion: must be a number from -5 to 160, got -40",
            ),
            (
                r#"{"activity": "a", "both": {"elbow_flexion": 1e400}}"#,
                "the pose file is not JSON: number out of range",
            ),
            (
                r#"{"activity": "a", "trunk": {"spine_twist": "far"}}"#,
                "p.trunk.spine_twist: must be a number from -50 to 50, got \"far\"",
            ),
            (
                r#"{"activity": "a", "both": {"kne_flexion": 4}}"#,
                "p.both.kne_flexion: unknown, known here are clavicle_elevation",
            ),
            (r#"{"activity": "a", "both": {"kne_flexion": 4}}"#, "did you mean `knee_flexion`?"),
            (r#"{"activity": "a", "trunk": {"tail": 4}}"#, "p.trunk.tail: unknown"),
            (r#"{"activity": "a", "legs": {}}"#, "p.legs: unknown"),
            (r#"{"activity": "a", "both": {"hand": "claw"}}"#, "p.both.hand: must be one of"),
            (
                r#"{"activity": "a", "both": {"foot": 3}}"#,
                "p.both.foot: must be one of free, level, planted",
            ),
            (r#"{"activity": "a", "rests": 1}"#, "p.rests: must be true or false, got 1"),
            (
                r#"{"activity": "a", "seated": "yes"}"#,
                "p.seated: must be true or false, got \"yes\"",
            ),
            (
                r#"{"activity": "a", "unsuited": 3}"#,
                "p.unsuited: expected a list of clothes [ ], got 3",
            ),
            (
                r#"{"activity": "a", "unsuited": ["coat", "hat"]}"#,
                "p.unsuited[1]: must be one of skirt, jacket, coat, got \"hat\"",
            ),
            (r#"{"activity": "a", "root": {"roll": 400}}"#, "p.root.roll: must be a number from"),
            (r#"{"activity": "a", "freedom": {"arms": 2}}"#, "p.freedom.arms: must be a number"),
            (
                r#"{"activity": "a", "left": {"shoulder_abduction": -30}}"#,
                "p.left.shoulder_abduction: must be -15 or more while shoulder_flexion is 0",
            ),
            (r#"{"activity": ""}"#, "p.activity: must say what the person does"),
            ("{}", "p.activity: must say what the person does, got nothing"),
            ("3", "p: expected an object { }, got 3"),
        ] {
            let error = read(pose).unwrap_err().to_string();
            assert!(error.contains(expected), "{pose}: {error}");
        }
        for (text, expected) in [
            ("{", "not JSON"),
            ("", "not JSON"),
            ("{}", "poses: missing"),
            ("[]", "file: expected an object"),
            (r#"{"poses": {}, "more": 1}"#, "more: unknown"),
            (r#"{"poses": {"No spaces": {}}}"#, "poses.No spaces: a pose is named with"),
        ] {
            let error = Poses::parse(text).unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }

    #[test]
    fn files_of_folders_are_read_remembered_and_refused_by_name() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("mine.poses.json");
        let text = r#"{"poses": {"p": {"activity": "testing", "both": {"knee_flexion": 9}}}}"#;
        std::fs::write(&path, text).unwrap();
        let folders = [dir.path().to_owned()];
        let poses = Poses::default().with_folders(&folders).unwrap();
        assert_eq!(poses.ids().collect::<Vec<_>>(), ["pose/p"]);
        let hash = content_hash(text.as_bytes());
        assert_eq!(
            poses.files,
            [PoseFile { name: "mine.poses.json".to_owned(), content_hash: hash }]
        );
        let refused = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            Poses::default().with_folders(&folders).unwrap_err().to_string()
        };
        for (bytes, expected) in [
            (text.replace("knee", "neck").as_bytes(), "p.both.neck_flexion: unknown"),
            (text.replace('9', "200").as_bytes(), "p.both.knee_flexion: must be a number from -5"),
            (b"\xff\xfe".as_slice(), "not UTF-8"),
        ] {
            let error = refused(bytes);
            assert!(error.contains(expected) && error.contains("mine.poses.json"), "{error}");
        }
        std::fs::File::create(&path).unwrap().set_len(MAX_BYTES + 1).unwrap();
        let error = Poses::default().with_folders(&folders).unwrap_err().to_string();
        assert!(error.contains("mine.poses.json has more than"), "{error}");
    }
}
