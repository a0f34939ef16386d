//! Motion clips: how a standard human of thirteen bodies moves.
//!
//! In: the packed file that `figurant-bake` writes (`assets/clips.clp`). Out: for any position in
//! a clip, the rotation of each body in model space ([`crate::base::space`]: x left, y up,
//! z forward). At rest all rotations are the identity: the figure stands upright, its arms hang
//! straight down, its feet point forward. Who moves like that, and how long that person's limbs
//! are, is decided in `geometry::pose`.
//!
//! The file is one zstd frame around, all little-endian:
//!
//! ```text
//! "FGCLIPS1"  u32 number of clips
//! per clip:   u8 length of id, id (UTF-8), u8 loops, f32 seconds per frame, u32 frames,
//!             for each body, for each of x y z w: the components of all frames as i16 / 32767,
//!             first value then differences (wrapping), all low bytes, then all high bytes
//! ```

use std::io::Read;
use std::sync::OnceLock;

use glam::DQuat;

use super::pose::Wear;

/// First bytes of the unpacked file.
pub const MAGIC: &[u8; 8] = b"FGCLIPS1";

/// The bodies of the source figure; the order is that of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
#[expect(missing_docs, reason = "the names say it")]
pub enum SourceBody {
    Root,
    Chest,
    Neck,
    LeftHip,
    LeftKnee,
    LeftAnkle,
    LeftShoulder,
    LeftElbow,
    RightHip,
    RightKnee,
    RightAnkle,
    RightShoulder,
    RightElbow,
}

impl SourceBody {
    /// How many there are.
    pub const COUNT: usize = 13;

    /// The same body on the other side; those in the middle are their own.
    #[must_use]
    pub const fn mirrored_index(index: usize) -> usize {
        match index {
            3..=7 => index + 5,
            8..=12 => index - 5,
            _ => index,
        }
    }
}

/// The pose of the source figure at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipFrame {
    /// Rotation from rest of each body, model space, unit quaternions, by [`SourceBody`].
    pub model_from_rest: [DQuat; SourceBody::COUNT],
}

impl ClipFrame {
    /// Standing upright with hanging arms.
    pub const REST: Self = Self { model_from_rest: [DQuat::IDENTITY; SourceBody::COUNT] };

    /// Rotation of one body.
    #[must_use]
    pub const fn get(&self, body: SourceBody) -> DQuat {
        self.model_from_rest[body as usize]
    }

    /// The pose in a mirror at x = 0: left and right change places. Twice is the same again,
    /// to the bit.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self {
            model_from_rest: std::array::from_fn(|i| {
                // M R M with M = diag(-1, 1, 1) turns round the parts of the axis in the mirror.
                let q = self.model_from_rest[SourceBody::mirrored_index(i)];
                DQuat::from_xyzw(q.x, -q.y, -q.z, q.w)
            }),
        }
    }
}

/// Frames of a clip at least: what does not move is a pose.
pub const MIN_FRAMES: usize = 2;
/// Frames of a clip at most, half an hour at 60 a second; as [`ClipFrame`]s some 45 MB.
pub const MAX_FRAMES: usize = 108_000;
/// Size of the unpacked file at most, bytes; read no further.
const MAX_UNPACKED_BYTES: u64 = 32 << 20;

/// One motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// Its id, such as `walk`.
    pub id: String,
    /// Seconds from one frame to the next.
    pub frame_s: f64,
    /// Whether the last frame leads back to the first.
    pub loops: bool,
    frames: Vec<ClipFrame>,
}

impl Clip {
    /// A clip of [`MIN_FRAMES`] to [`MAX_FRAMES`] frames.
    ///
    /// # Errors
    /// With fewer or more.
    pub fn new(
        id: String,
        frame_s: f64,
        loops: bool,
        frames: Vec<ClipFrame>,
    ) -> Result<Self, ClipError> {
        check_length(&id, frames.len())?;
        Ok(Self { id, frame_s, loops, frames })
    }

    /// What a person does who moves like that, such as `walking`.
    #[must_use]
    pub fn activity(&self) -> &'static str {
        match self.id.as_str() {
            "walk" => "walking",
            "run" => "running",
            "jump" => "jumping",
            "kick" | "spinkick" => "kicking",
            "punch" => "punching",
            "backflip" | "cartwheel" | "roll" => "tumbling",
            "dance_a" | "dance_b" | "spin" => "dancing",
            "crawl" => "crawling",
            "getup_facedown" | "getup_faceup" => "getting_up",
            _ => "moving",
        }
    }

    /// What nobody moves like that in: skirts and coats hang still, which they would not on somebody
    /// who turns over.
    #[must_use]
    pub fn unsuited(&self) -> Vec<Wear> {
        match self.activity() {
            "tumbling" | "crawling" | "getting_up" => vec![Wear::Skirt, Wear::Coat],
            _ => Vec::new(),
        }
    }

    /// All frames.
    #[must_use]
    pub fn frames(&self) -> &[ClipFrame] {
        &self.frames
    }

    /// Seconds from the first frame to the last.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        (self.frames.len() - 1) as f64 * self.frame_s
    }

    /// The pose at a position in the clip, 0 its first frame, 1 its last; what lies outside (or is
    /// not a number) is taken to the nearer end (to 0). Between frames each body turns by the
    /// shorter way at constant speed.
    #[must_use]
    pub fn sample(&self, phase: f64) -> ClipFrame {
        let last = self.frames.len() - 1;
        let phase = if phase.is_nan() { 0.0 } else { phase.clamp(0.0, 1.0) };
        let position = phase * last as f64;
        let (index, t) = (position.floor() as usize, position - position.floor());
        if index >= last || t == 0.0 {
            return self.frames[index.min(last)];
        }
        let (a, b) = (&self.frames[index], &self.frames[index + 1]);
        ClipFrame {
            model_from_rest: std::array::from_fn(|i| {
                a.model_from_rest[i].slerp(b.model_from_rest[i], t).normalize()
            }),
        }
    }
}

fn check_length(id: &str, frames: usize) -> Result<(), ClipError> {
    if (MIN_FRAMES..=MAX_FRAMES).contains(&frames) {
        return Ok(());
    }
    let advice = if frames < MIN_FRAMES {
        "what does not move is a pose; write it as one"
    } else {
        "cut it into several clips"
    };
    Err(ClipError::Length { id: id.to_owned(), frames, advice })
}

/// A set of clips, ordered by id.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clips {
    clips: Vec<Clip>,
}

/// What can be wrong with clips.
#[derive(Debug, thiserror::Error)]
pub enum ClipError {
    /// Not a zstd frame, or a broken one.
    #[error("the clip file cannot be unpacked ({0}); it is damaged, replace it")]
    Packed(String),
    /// The unpacked bytes do not follow the format.
    #[error("the clip file is malformed: {what}; it is damaged or of another version, replace it")]
    Malformed {
        /// What was found.
        what: &'static str,
    },
    /// More than any clips need.
    #[error("the clip file unpacks to more than {MAX_UNPACKED_BYTES} bytes; split it")]
    TooLarge,
    /// A clip of too few or too many frames.
    #[error(
        "clip \"{id}\": must have from {MIN_FRAMES} to {MAX_FRAMES} frames, got {frames}; {advice}"
    )]
    Length {
        /// Which.
        id: String,
        /// How many it has.
        frames: usize,
        /// What to do.
        advice: &'static str,
    },
    /// No such clip.
    #[error("there is no motion clip \"{id}\"; there are: {known}")]
    Unknown {
        /// What was asked for.
        id: String,
        /// All ids.
        known: String,
    },
}

impl Clips {
    /// The clips that ship with the program.
    #[must_use]
    pub fn built_in() -> &'static Self {
        static CLIPS: OnceLock<Clips> = OnceLock::new();
        CLIPS.get_or_init(|| {
            const FILE: &[u8] =
                include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/clips.clp"));
            Self::from_bytes(FILE).expect("the file is part of the program, and a test reads it")
        })
    }

    /// Reads a packed file.
    ///
    /// # Errors
    /// When it does not follow the format of this page, or holds clips of too few or too many
    /// frames; how much of it is unpacked is bounded.
    pub fn from_bytes(packed: &[u8]) -> Result<Self, ClipError> {
        let mut bytes = Vec::new();
        ruzstd::decoding::StreamingDecoder::new(packed)
            .map_err(|e| ClipError::Packed(e.to_string()))?
            .take(MAX_UNPACKED_BYTES + 1)
            .read_to_end(&mut bytes)
            .map_err(|e| ClipError::Packed(e.to_string()))?;
        if bytes.len() as u64 > MAX_UNPACKED_BYTES {
            return Err(ClipError::TooLarge);
        }
        let mut r = Reader(&bytes);
        if r.take(MAGIC.len())? != MAGIC {
            return Err(ClipError::Malformed { what: "the file does not begin with FGCLIPS1" });
        }
        let count = r.u32()?;
        let mut clips = Vec::new();
        for _ in 0..count {
            clips.push(r.clip()?);
        }
        if !r.0.is_empty() {
            return Err(ClipError::Malformed { what: "bytes after the last clip" });
        }
        if !clips.is_sorted_by(|a, b| a.id < b.id) {
            return Err(ClipError::Malformed { what: "clips that are not ordered by id" });
        }
        Ok(Self { clips })
    }

    /// All clips, ordered by id.
    #[must_use]
    pub fn all(&self) -> &[Clip] {
        &self.clips
    }

    /// All ids, in order.
    pub fn ids(&self) -> impl Iterator<Item = &str> {
        self.clips.iter().map(|c| c.id.as_str())
    }

    /// The clip of an id.
    ///
    /// # Errors
    /// When there is none; the error lists what there is.
    pub fn get(&self, id: &str) -> Result<&Clip, ClipError> {
        match self.clips.binary_search_by(|c| c.id.as_str().cmp(id)) {
            Ok(i) => Ok(&self.clips[i]),
            Err(_) => Err(ClipError::Unknown {
                id: id.to_owned(),
                known: self.ids().collect::<Vec<_>>().join(", "),
            }),
        }
    }
}

/// The bytes not yet read.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, n: usize) -> Result<&'a [u8], ClipError> {
        let (head, tail) = self
            .0
            .split_at_checked(n)
            .ok_or(ClipError::Malformed { what: "it ends in the middle of a clip" })?;
        self.0 = tail;
        Ok(head)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], ClipError> {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N)?);
        Ok(out)
    }

    fn u32(&mut self) -> Result<u32, ClipError> {
        self.array().map(u32::from_le_bytes)
    }

    fn clip(&mut self) -> Result<Clip, ClipError> {
        let [id_len, ..] = self.array::<1>()?;
        let id = std::str::from_utf8(self.take(usize::from(id_len))?)
            .map_err(|_| ClipError::Malformed { what: "an id that is not UTF-8" })?
            .to_owned();
        let [loops] = self.array()?;
        let frame_s = f64::from(f32::from_le_bytes(self.array()?));
        if !(frame_s > 0.0 && frame_s.is_finite()) {
            return Err(ClipError::Malformed { what: "a frame time that is not positive" });
        }
        let count = self.u32()? as usize;
        // Before anything is made ready for them.
        check_length(&id, count)?;
        let mut frames = Vec::new();
        for body in 0..SourceBody::COUNT {
            let [x, y, z, w] = [
                self.channel(count)?,
                self.channel(count)?,
                self.channel(count)?,
                self.channel(count)?,
            ];
            // Only now is it known that the file holds that many frames.
            frames.resize(count, ClipFrame::REST);
            for (i, frame) in frames.iter_mut().enumerate() {
                let q = [x[i], y[i], z[i], w[i]].map(|c| f64::from(c) / 32767.0);
                let q = DQuat::from_array(q);
                if q.length_squared() < 0.5 {
                    return Err(ClipError::Malformed {
                        what: "a rotation that is not a unit quaternion",
                    });
                }
                frame.model_from_rest[body] = q.normalize();
            }
        }
        Clip::new(id, frame_s, loops != 0, frames)
    }

    fn channel(&mut self, count: usize) -> Result<Vec<i16>, ClipError> {
        let (low, high) = (self.take(count)?, self.take(count)?);
        let mut value = 0i16;
        Ok(low
            .iter()
            .zip(high)
            .map(|(&l, &h)| {
                value = value.wrapping_add(i16::from_le_bytes([l, h]));
                value
            })
            .collect())
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn turned(angle: f64) -> ClipFrame {
        ClipFrame { model_from_rest: [DQuat::from_rotation_y(angle); SourceBody::COUNT] }
    }

    fn clip(frames: Vec<ClipFrame>) -> Clip {
        Clip::new("test".into(), 0.1, false, frames).unwrap()
    }

    #[test]
    fn built_in_clips_are_whole() {
        let clips = Clips::built_in();
        assert_eq!(clips.all().len(), 15);
        assert_eq!(clips.all().iter().map(|c| c.frames().len()).sum::<usize>(), 1620);
        for clip in clips.all() {
            assert!((0.01..0.07).contains(&clip.frame_s), "{}", clip.id);
            assert_ne!(clip.activity(), "moving", "{}", clip.id);
            for frame in clip.frames() {
                for q in frame.model_from_rest {
                    assert!((q.length() - 1.0).abs() < 1e-12, "{}", clip.id);
                }
            }
        }
        assert!(clips.get("walk").unwrap().loops);
        assert!((clips.get("walk").unwrap().duration_s() - 1.27).abs() < 0.01);
        assert!(!clips.get("kick").unwrap().loops);
    }

    #[test]
    fn a_walk_goes_forward_upright_with_knees_that_bend_backwards() {
        for frame in Clips::built_in().get("walk").unwrap().frames() {
            let root = frame.get(SourceBody::Root);
            assert!((root * DVec3::Z).z > 0.9 && (root * DVec3::Y).y > 0.9);
            for (hip, knee) in [
                (SourceBody::LeftHip, SourceBody::LeftKnee),
                (SourceBody::RightHip, SourceBody::RightKnee),
            ] {
                // The shank, seen in the thigh's frame, may only swing backwards.
                let shank = frame.get(hip).inverse() * frame.get(knee) * -DVec3::Y;
                assert!(shank.z < 0.01, "{shank}");
            }
        }
    }

    #[test]
    fn sampling_passes_through_the_frames_and_turns_evenly_between() {
        let c = clip(vec![turned(0.0), turned(0.4), turned(1.2)]);
        let at = |phase| c.sample(phase).model_from_rest[0];
        for (phase, angle) in [(0.0, 0.0), (0.25, 0.2), (0.5, 0.4), (0.75, 0.8), (1.0, 1.2)] {
            assert!(at(phase).angle_between(DQuat::from_rotation_y(angle)) < 1e-7, "{phase}");
        }
        assert_eq!(at(-3.0), at(0.0));
        assert_eq!(at(7.0), at(1.0));
        assert_eq!(at(f64::NAN), at(0.0));
    }

    #[test]
    fn sampling_takes_the_short_way_and_survives_half_turns() {
        let (a, b) = (turned(0.1), turned(0.3));
        let negated = ClipFrame { model_from_rest: b.model_from_rest.map(|q| -q) };
        let middle = clip(vec![a, negated]).sample(0.5).model_from_rest[0];
        assert!(middle.angle_between(DQuat::from_rotation_y(0.2)) < 1e-7);
        let half = clip(vec![turned(0.0), turned(std::f64::consts::PI)]).sample(0.5);
        assert!(half.model_from_rest.iter().all(|q| (q.length() - 1.0).abs() < 1e-12));
    }

    #[test]
    fn mirrored_twice_is_the_same_and_once_is_a_reflection() {
        let frame = Clips::built_in().get("cartwheel").unwrap().sample(0.37);
        assert_eq!(frame.mirrored().mirrored(), frame);
        let v = DVec3::new(0.3, -0.8, 0.5);
        let m = |v: DVec3| DVec3::new(-v.x, v.y, v.z);
        let left = frame.get(SourceBody::LeftElbow) * v;
        let right = frame.mirrored().get(SourceBody::RightElbow) * m(v);
        assert!((right - m(left)).length() < 1e-15);
    }

    #[test]
    fn damaged_files_are_refused() {
        let file: &[u8] =
            include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/clips.clp"));
        assert!(matches!(Clips::from_bytes(&[]), Err(ClipError::Packed(_))));
        assert!(Clips::from_bytes(&file[..file.len() / 2]).is_err());
        let unknown = Clips::built_in().get("swim").unwrap_err().to_string();
        assert!(unknown.contains("swim") && unknown.contains("walk"), "{unknown}");
    }
    /// A packed file of one clip that says how many frames it has, and of so many bytes of frames.
    fn packed(frames: u32, bytes: usize) -> Vec<u8> {
        let mut file = MAGIC.to_vec();
        file.extend(1u32.to_le_bytes());
        file.extend(b"\x04long\x00");
        file.extend(0.1f32.to_le_bytes());
        file.extend(frames.to_le_bytes());
        file.resize(file.len() + bytes, 1);
        let fastest = ruzstd::encoding::CompressionLevel::Fastest;
        ruzstd::encoding::compress_to_vec(file.as_slice(), fastest)
    }

    #[test]
    fn clips_of_one_frame_and_of_ten_million_are_refused() {
        let refused = |frames| Clips::from_bytes(&packed(frames, 1000)).unwrap_err().to_string();
        let one = refused(1);
        assert!(one.contains("clip \"long\"") && one.contains("from 2 to 108000"), "{one}");
        assert!(one.contains("got 1;") && one.contains("is a pose"), "{one}");
        assert!(refused(0).contains("got 0;"));
        let many = refused(10_000_000);
        assert!(many.contains("got 10000000; cut it"), "{many}");
        // As many frames as may be, of which the file holds a few.
        assert!(refused(MAX_FRAMES as u32).contains("in the middle of a clip"));
        let error = Clip::new("still".into(), 0.1, false, vec![turned(0.0)]).unwrap_err();
        assert!(error.to_string().contains("clip \"still\""), "{error}");
    }

    #[test]
    fn files_that_unpack_without_end_are_given_up() {
        let bomb = packed(1000, 33 << 20);
        assert!(bomb.len() < 1 << 20, "{} bytes", bomb.len());
        assert!(matches!(Clips::from_bytes(&bomb), Err(ClipError::TooLarge)));
    }
}
