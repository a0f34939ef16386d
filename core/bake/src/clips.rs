//! Motion clips: DeepMimic's JSON -> `assets/clips.clp`.
//!
//! In: a folder with `humanoid3d_*.txt` (44 columns a frame: duration, root position, then local
//! rotations w x y z or hinge angles; axes x forward, y up, z to the character's right). Out: the
//! file that `figurant_core::library::clip` documents, with rotations in model space and our axes.
//! Root positions are not kept: people stand where their scene puts them.

use std::path::{Path, PathBuf};

use figurant_core::library::clip::{Clip, ClipError, ClipFrame, Clips, MAGIC, SourceBody};
use glam::DQuat;

/// Numbers in a source frame.
const COLUMNS: usize = 44;

/// Where a body's rotation stands in a frame.
enum Column {
    /// Four numbers w x y z from here.
    Quaternion(usize),
    /// One angle in radians about z.
    Hinge(usize),
}

/// Parent and column of each body, by [`SourceBody`]; parents come first.
const BODIES: [(Option<SourceBody>, Column); SourceBody::COUNT] = {
    use Column::{Hinge, Quaternion};
    use SourceBody::{
        Chest, LeftHip, LeftKnee, LeftShoulder, RightHip, RightKnee, RightShoulder, Root,
    };
    [
        (None, Quaternion(4)),
        (Some(Root), Quaternion(8)),
        (Some(Chest), Quaternion(12)),
        (Some(Root), Quaternion(30)),
        (Some(LeftHip), Hinge(34)),
        (Some(LeftKnee), Quaternion(35)),
        (Some(Chest), Quaternion(39)),
        (Some(LeftShoulder), Hinge(43)),
        (Some(Root), Quaternion(16)),
        (Some(RightHip), Hinge(20)),
        (Some(RightKnee), Quaternion(21)),
        (Some(Chest), Quaternion(25)),
        (Some(RightShoulder), Hinge(29)),
    ]
};

/// Why the clips were not baked.
#[derive(Debug, thiserror::Error)]
pub enum ClipBakeError {
    /// A file or folder that cannot be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A motion file that is not as expected.
    #[error("{}: {what}", path.display())]
    Motion {
        /// Which.
        path: PathBuf,
        /// What was found.
        what: String,
    },
    /// The written file does not read back.
    #[error(transparent)]
    Clip(#[from] ClipError),
}

/// The parts of a motion file that are used.
#[derive(serde::Deserialize)]
struct Motion {
    #[serde(rename = "Loop")]
    repeat: String,
    #[serde(rename = "Frames")]
    frames: Vec<Vec<f64>>,
}

/// Reads all `humanoid3d_*.txt` of a folder and writes them as one file; returns its size in bytes.
///
/// # Errors
/// When the folder holds no motions, one is not as expected, or the output cannot be written.
pub fn bake_clips(motions: &Path, out: &Path) -> Result<usize, ClipBakeError> {
    let io = |path: &Path| {
        let path = path.to_owned();
        move |source| ClipBakeError::Io { path, source }
    };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(motions).map_err(io(motions))? {
        let path = entry.map_err(io(motions))?.path();
        let id = path
            .file_name()
            .and_then(|n| n.to_str())
            .and_then(|n| n.strip_prefix("humanoid3d_")?.strip_suffix(".txt"))
            .map(str::to_owned);
        found.extend(id.map(|id| (id, path)));
    }
    found.sort();
    if found.is_empty() {
        let what = "holds no humanoid3d_*.txt".to_owned();
        return Err(ClipBakeError::Motion { path: motions.to_owned(), what });
    }
    let clips = found.iter().map(|(id, path)| read(id, path)).collect::<Result<Vec<_>, _>>()?;
    let packed = pack(&clips).map_err(io(out))?;
    Clips::from_bytes(&packed)?;
    std::fs::write(out, &packed).map_err(io(out))?;
    Ok(packed.len())
}

fn read(id: &str, path: &Path) -> Result<Clip, ClipBakeError> {
    let motion_error = |what: String| ClipBakeError::Motion { path: path.to_owned(), what };
    let text = std::fs::read_to_string(path)
        .map_err(|source| ClipBakeError::Io { path: path.to_owned(), source })?;
    let motion: Motion = serde_json::from_str(&text).map_err(|e| motion_error(e.to_string()))?;
    for (i, row) in motion.frames.iter().enumerate() {
        if row.len() != COLUMNS || !row.iter().all(|x| x.is_finite()) {
            return Err(motion_error(format!("frame {i} is not {COLUMNS} finite numbers")));
        }
    }
    // The last frame's duration is 0; single frames may differ, the median does not.
    let mut durations: Vec<f64> =
        motion.frames.iter().map(|row| row[0]).filter(|&d| d > 0.0).collect();
    durations.sort_by(f64::total_cmp);
    let frame_s = *durations
        .get(durations.len() / 2)
        .ok_or_else(|| motion_error("no frame has a duration".to_owned()))?;
    let frames = motion.frames.iter().map(|row| model_rotations(row)).collect();
    Ok(Clip::new(id.to_owned(), frame_s, motion.repeat == "wrap", frames)?)
}

/// Local rotations in source axes -> rotations in model space in our axes.
fn model_rotations(row: &[f64]) -> ClipFrame {
    let mut source = [DQuat::IDENTITY; SourceBody::COUNT];
    for (i, (parent, column)) in BODIES.iter().enumerate() {
        let local = match *column {
            // Some of the source's quaternions are not of unit length.
            Column::Quaternion(c) => {
                DQuat::from_xyzw(row[c + 1], row[c + 2], row[c + 3], row[c]).normalize()
            }
            Column::Hinge(c) => DQuat::from_rotation_z(row[c]),
        };
        source[i] = parent.map_or(local, |p| source[p as usize] * local);
    }
    // (x, y, z) there is (-z, y, x) here; a rotation's axis follows the same map.
    ClipFrame { model_from_rest: source.map(|q| DQuat::from_xyzw(-q.z, q.y, q.x, q.w)) }
}

fn pack(clips: &[Clip]) -> std::io::Result<Vec<u8>> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend((clips.len() as u32).to_le_bytes());
    for clip in clips {
        bytes.push(clip.id.len() as u8);
        bytes.extend(clip.id.bytes());
        bytes.push(u8::from(clip.loops));
        bytes.extend((clip.frame_s as f32).to_le_bytes());
        bytes.extend((clip.frames().len() as u32).to_le_bytes());
        for body in 0..SourceBody::COUNT {
            let rotations =
                without_sign_flips(clip.frames().iter().map(|f| f.model_from_rest[body]));
            for component in 0..4 {
                let mut last = 0i16;
                let differences: Vec<[u8; 2]> = rotations
                    .iter()
                    .map(|q| {
                        let value = (q.to_array()[component] * 32767.0).round() as i16;
                        value.wrapping_sub(std::mem::replace(&mut last, value)).to_le_bytes()
                    })
                    .collect();
                bytes.extend(differences.iter().map(|d| d[0]));
                bytes.extend(differences.iter().map(|d| d[1]));
            }
        }
    }
    zstd::encode_all(bytes.as_slice(), 19)
}

/// Of q and -q, which are the same rotation, the one nearer to the frame before: small differences.
fn without_sign_flips(rotations: impl Iterator<Item = DQuat>) -> Vec<DQuat> {
    let mut last = DQuat::IDENTITY;
    rotations
        .map(|q| {
            last = if q.dot(last) < 0.0 { -q } else { q };
            last
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn row() -> Vec<f64> {
        let mut row = vec![0.0; COLUMNS];
        for (_, column) in &BODIES {
            if let Column::Quaternion(c) = column {
                row[*c] = 1.0;
            }
        }
        row
    }

    #[test]
    fn a_bent_knee_takes_the_shank_backwards_and_a_bent_elbow_the_forearm_forwards() {
        let mut bent = row();
        bent[20] = -1.0;
        bent[43] = 1.0;
        let frame = model_rotations(&bent);
        assert!((frame.get(SourceBody::RightKnee) * -DVec3::Y).z < -0.8);
        assert!((frame.get(SourceBody::LeftElbow) * -DVec3::Y).z > 0.8);
        assert_eq!(frame.get(SourceBody::LeftKnee), DQuat::IDENTITY);
    }

    #[test]
    fn source_axes_become_ours() {
        // A turn about the source's up axis that takes its forward (x) to its right (z).
        let mut turned = row();
        let q = DQuat::from_rotation_y(-std::f64::consts::FRAC_PI_2);
        (turned[4], turned[5], turned[6], turned[7]) = (q.w, q.x, q.y, q.z);
        assert!((q * DVec3::X - DVec3::Z).length() < 1e-12);
        let root = model_rotations(&turned).get(SourceBody::Root);
        assert!((root * DVec3::Z + DVec3::X).length() < 1e-12, "forward goes to the right, -x");
    }

    #[test]
    fn what_is_packed_reads_back_to_a_few_thousandths_of_a_degree() {
        let frames: Vec<_> = (0..40)
            .map(|i| {
                let mut r = row();
                r[34] = -0.05 * f64::from(i);
                (r[4], r[5]) = (libm_cos(i), libm_cos(i + 11));
                model_rotations(&r)
            })
            .collect();
        let clips = [Clip::new("a".into(), 0.5, true, frames.clone()).unwrap()];
        let back = Clips::from_bytes(&pack(&clips).unwrap()).unwrap();
        assert!(back.all()[0].loops);
        for (a, b) in frames.iter().zip(back.all()[0].frames()) {
            for (p, q) in a.model_from_rest.iter().zip(b.model_from_rest) {
                assert!(p.dot(q).abs() > 1.0 - 1e-8);
            }
        }
    }

    fn libm_cos(i: i32) -> f64 {
        DQuat::from_rotation_x(f64::from(i) * 0.3).w
    }
}
