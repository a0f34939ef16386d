//! The human figure: body shapes, rig, garment shell, hair, keypoints and masks.
//!
//! Bytes of `assets/figure.fig` flow in, an immutable [`Figure`] flows out, shared by `Arc`. What
//! a given person looks like is decided in `geometry`, not here.

use std::io::Read;
use std::ops::Range;
use std::sync::{Arc, LazyLock, OnceLock};

mod complexion;
mod creases;
pub mod data;
mod eye;
mod maps;
mod net;
mod place;
pub mod predict;
mod seams;
mod stream;
mod tallness;
mod whiskers;

pub use complexion::upper_lid_y;
pub use creases::{ARM_M, LEG_M};
pub use data::{FigureData, Group, GroupId, LOD_COUNT, Lod};
use data::{GROUP_COUNT, KEYPOINT_VERTICES, MAX_FACTORS};
pub use maps::{CLOTH_REPEAT, Freckles, NEUTRAL_TINT, SKIRT};
pub use net::{Neighbour, Net};
pub use place::Place;
pub use seams::Sewn;
pub use tallness::Tallness;
pub use whiskers::{ScalpShade, Whiskers, beard, wreath};

use glam::DVec3;

use crate::library::mesh::SkinVertex;
use crate::library::texture::{Encoding, Texture};

/// Joints of the rig.
pub const JOINT_COUNT: usize = 52;
/// Level of detail from which a body's volume is measured.
pub const VOLUME_LOD: usize = 3;

/// Why a figure could not be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FigureError {
    /// The file does not hold what a figure file holds.
    #[error(
        "figure file: {what} is missing, too short or out of range; \
         expected a file written by figurant-bake of this version"
    )]
    Malformed {
        /// Part of the file.
        what: &'static str,
    },
    /// Not a zstd stream, or a damaged one.
    #[error("figure file cannot be unpacked ({0}); it is damaged or not a figure file")]
    Compressed(String),
    /// A person names a face target that the figure has not.
    #[error("unknown face target `{name}`; the nearest one is `{nearest}`")]
    UnknownFaceTarget {
        /// As it was written.
        name: String,
        /// The most similar name of the library.
        nearest: String,
    },
}

/// The human figure with all its shapes.
#[derive(Debug)]
pub struct Figure {
    data: FigureData,
    skin: Vec<SkinVertex>,
    /// Texture coordinates of the skin's render vertices, the head's in a layout of its own.
    skin_uvs: Vec<f32>,
    /// Which of the skin's render vertices are the head's.
    on_head: Vec<bool>,
    /// Texture coordinates of the garment shell's render vertices.
    shell_uvs: Vec<f32>,
    painted: Painted,
    /// Of each group and level of detail, made when first asked for.
    nets: [[OnceLock<Net>; LOD_COUNT]; GROUP_COUNT],
    /// Of each group.
    places: [OnceLock<Vec<Place>>; GROUP_COUNT],
    tallness: OnceLock<Tallness>,
    creases: OnceLock<Vec<f32>>,
    eye_mask: Arc<Texture>,
    reach_margin_m: [f64; JOINT_COUNT],
}

/// Maps of the skin, painted when first asked for.
#[derive(Debug, Default)]
struct Painted {
    /// By scalp and beard.
    head_masks: [OnceLock<Arc<Texture>>; 3 * Whiskers::ALL.len()],
    body_mask: OnceLock<Arc<Texture>>,
    head_tints: [OnceLock<Arc<Texture>>; Freckles::ALL.len()],
    head_age: OnceLock<[Arc<Texture>; 2]>,
    sewn: [OnceLock<Arc<Texture>>; Sewn::ALL.len()],
}

/// A macro target's row: the target and the keywords whose weights multiply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MacroRow<'a> {
    /// Index of the target.
    pub target: usize,
    /// Indices in [`data::KEYWORDS`], padded with [`data::NO_KEYWORD`].
    pub keywords: &'a [u8],
}

/// Three runs of numbers of equal length, one per axis.
#[derive(Clone, Copy, Debug)]
pub struct Planes<'a, T> {
    /// Along +X.
    pub x: &'a [T],
    /// Along +Y.
    pub y: &'a [T],
    /// Along +Z.
    pub z: &'a [T],
}

impl<'a, T> Planes<'a, T> {
    fn of(all: &'a [T]) -> Self {
        let n = all.len() / 3;
        Self { x: &all[..n], y: &all[n..2 * n], z: &all[2 * n..] }
    }
}

impl Figure {
    /// The figure that is part of the program, unpacked once.
    ///
    /// # Errors
    /// Only if the program was built with a file that the bake program did not write.
    pub fn built_in() -> Result<Arc<Self>, FigureError> {
        static FIGURE: LazyLock<Result<Arc<Figure>, FigureError>> = LazyLock::new(|| {
            Figure::from_bytes(include_bytes!("../../../../assets/figure.fig")).map(Arc::new)
        });
        FIGURE.clone()
    }

    /// Unpacks and checks the bytes of a figure file.
    ///
    /// # Errors
    /// Says which part of the file is damaged.
    pub fn from_bytes(packed: &[u8]) -> Result<Self, FigureError> {
        let mut bytes = Vec::new();
        ruzstd::decoding::StreamingDecoder::new(packed)
            .map_err(|e| FigureError::Compressed(e.to_string()))?
            .read_to_end(&mut bytes)
            .map_err(|e| FigureError::Compressed(e.to_string()))?;
        let data = FigureData::from_bytes(&bytes)?;
        if data.joint_names.len() != JOINT_COUNT {
            return Err(FigureError::Malformed { what: "joint names" });
        }
        let skin: Vec<SkinVertex> = data
            .skin_joints
            .chunks_exact(4)
            .zip(data.skin_weights.chunks_exact(4))
            .map(|(j, w)| SkinVertex {
                joints: [j[0], j[1], j[2], j[3]],
                weights: [w[0], w[1], w[2], w[3]],
            })
            .collect();
        let reach_margin_m = reach_margins_m(&data, &skin);
        let eye_mask = Arc::new(eye::mask());
        let (skin_uvs, on_head) = maps::layout(&data);
        let shell_uvs = maps::shell_layout(&data);
        Ok(Self {
            data,
            skin,
            skin_uvs,
            on_head,
            shell_uvs,
            painted: Painted::default(),
            nets: Default::default(),
            places: Default::default(),
            tallness: OnceLock::new(),
            creases: OnceLock::new(),
            eye_mask,
            reach_margin_m,
        })
    }

    /// The raw tables.
    #[must_use]
    pub const fn data(&self) -> &FigureData {
        &self.data
    }

    /// A group of vertices.
    #[must_use]
    pub fn group(&self, id: GroupId) -> &Group {
        &self.data.groups[id as usize]
    }

    /// How the vertices of a group are joined at a level of detail.
    #[must_use]
    pub fn net(&self, id: GroupId, lod: usize) -> &Net {
        self.nets[id as usize][lod].get_or_init(|| Net::new(self.group(id), lod))
    }

    /// Where the first `count` vertices of a group are on the template.
    #[must_use]
    pub fn places(&self, id: GroupId, count: u32) -> &[Place] {
        let all = || {
            let vertices = self.vertices(id, self.group(id).count);
            vertices.map(|v| Place::of(&self.data, v)).collect()
        };
        &self.places[id as usize].get_or_init(all)[..count as usize]
    }

    /// Heights of the vertices that decide how tall a body is.
    #[must_use]
    pub fn tallness(&self) -> &Tallness {
        self.tallness.get_or_init(|| Tallness::new(self))
    }

    /// Height of the folds of worn cloth at the garment shell's vertices, 0..1: where limbs bend
    /// and where cloth piles up.
    #[must_use]
    pub fn creases(&self) -> &[f32] {
        self.creases.get_or_init(|| creases::creases(&self.data))
    }

    /// The first `count` vertices of a group among all vertices.
    #[must_use]
    pub fn vertices(&self, id: GroupId, count: u32) -> Range<usize> {
        let first = self.group(id).first as usize;
        first..first + count as usize
    }

    /// Template positions, metres.
    #[must_use]
    pub fn template(&self) -> Planes<'_, f32> {
        Planes::of(&self.data.positions)
    }

    /// Joints and weights of all vertices.
    #[must_use]
    pub fn skin(&self) -> &[SkinVertex] {
        &self.skin
    }

    /// All macro rows.
    pub fn macro_rows(&self) -> impl Iterator<Item = MacroRow<'_>> {
        self.data
            .macro_target
            .iter()
            .zip(self.data.macro_factors.chunks_exact(MAX_FACTORS))
            .map(|(&target, keywords)| MacroRow { target: usize::from(target), keywords })
    }

    /// Deltas of a macro target over all vertices, in [`data::DELTA_UNIT_M`].
    #[must_use]
    pub fn macro_target(&self, target: usize) -> Planes<'_, i16> {
        let n = 3 * self.data.vertex_count();
        Planes::of(&self.data.macro_deltas[target * n..(target + 1) * n])
    }

    /// Names of the local targets of the face: shapes (`nose-hump-incr`) and expressions
    /// (`mouthSmileLeft`), each good from 0 to 1.
    #[must_use]
    pub fn face_target_names(&self) -> &[String] {
        &self.data.local_names
    }

    /// Names of those local targets that make a face somebody's own; expressions are left out.
    pub fn face_shape_names(&self) -> impl Iterator<Item = &str> {
        // Expressions are named in camel case, shapes with dashes.
        self.data.local_names.iter().map(String::as_str).filter(|name| name.contains('-'))
    }

    /// Names of those local targets that make expressions and gaze.
    pub fn face_unit_names(&self) -> impl Iterator<Item = &str> {
        self.data.local_names.iter().map(String::as_str).filter(|name| !name.contains('-'))
    }

    /// Index of a local target.
    ///
    /// # Errors
    /// [`FigureError::UnknownFaceTarget`] suggests the nearest name.
    pub fn face_target(&self, name: &str) -> Result<usize, FigureError> {
        let names = &self.data.local_names;
        names.iter().position(|n| n == name).ok_or_else(|| FigureError::UnknownFaceTarget {
            name: name.to_owned(),
            nearest: names
                .iter()
                .min_by_key(|n| strsim::levenshtein(n, name))
                .cloned()
                .unwrap_or_default(),
        })
    }

    /// Vertices and deltas (x, y, z in [`data::DELTA_UNIT_M`]) of a local target, ascending.
    #[must_use]
    pub fn face_deltas(&self, target: usize) -> (&[u16], Planes<'_, i16>) {
        let d = &self.data;
        let range = d.local_start[target] as usize..d.local_start[target + 1] as usize;
        let all = Planes::of(&d.local_delta);
        let planes =
            Planes { x: &all.x[range.clone()], y: &all.y[range.clone()], z: &all.z[range.clone()] };
        (&d.local_vertex[range], planes)
    }

    /// Names of the joints, those of the widespread 52-joint humanoid rig.
    #[must_use]
    pub fn joint_names(&self) -> &[String] {
        &self.data.joint_names
    }

    /// Parent of a joint, nothing for the root. Parents have smaller indices.
    #[must_use]
    pub fn joint_parent(&self, joint: usize) -> Option<usize> {
        Some(usize::from(self.data.joint_parent[joint])).filter(|&p| p != 255)
    }

    /// Names of the keypoints, COCO's seventeen first.
    #[must_use]
    pub fn keypoint_names(&self) -> &[String] {
        &self.data.keypoint_names
    }

    /// Vertices and weights that regress a keypoint.
    pub fn keypoint(&self, k: usize) -> impl Iterator<Item = (usize, f32)> + '_ {
        let range = k * KEYPOINT_VERTICES..(k + 1) * KEYPOINT_VERTICES;
        self.data.keypoint_vertices[range.clone()]
            .iter()
            .zip(&self.data.keypoint_weights[range])
            .map(|(&v, &w)| (usize::from(v), w))
    }

    /// Geometric error of a level of detail, metres on the template; 0 for the finest. No vertex of
    /// the finest level lies farther from the level's surface; where the finest surface folds,
    /// points between its vertices may, by less than twice as much.
    #[must_use]
    pub fn lod_error_m(&self, lod: usize) -> f32 {
        self.group(GroupId::Skin).lods[lod]
            .error_m
            .max(self.group(GroupId::Shell).lods[lod].error_m)
    }

    /// How much farther from each joint's head the vertices of all groups reach that the joint
    /// moves than those of the skin's level [`VOLUME_LOD`], metres on the template.
    #[must_use]
    pub const fn reach_margin_m(&self) -> &[f64; JOINT_COUNT] {
        &self.reach_margin_m
    }

    /// Texture coordinates of the skin's render vertices, u then v, v down: those of the head
    /// cover its own maps, the others the body's.
    #[must_use]
    pub fn skin_uvs(&self) -> &[f32] {
        &self.skin_uvs
    }

    /// Which of the skin's render vertices are the head's; no triangle has some that are and some
    /// that are not.
    #[must_use]
    pub fn on_head(&self) -> &[bool] {
        &self.on_head
    }

    /// Texture coordinates of the garment shell's render vertices, u then v, v down: every place has
    /// its own, and a cloth's pattern repeats [`CLOTH_REPEAT`] times over 0..1.
    #[must_use]
    pub fn shell_uvs(&self) -> &[f32] {
        &self.shell_uvs
    }

    /// Masks over the garment shell: red seams, green what is sewn on, blue darker parts, alpha
    /// hollows. 5.6 MB each.
    #[must_use]
    pub fn sewn_mask(&self, kind: Sewn) -> &Arc<Texture> {
        self.painted.sewn[kind as usize].get_or_init(|| maps::sewn_mask(&self.data, kind))
    }

    /// Masks over the head: red lips, green brows, blue flushed places, alpha the hair that shades
    /// scalp and face. 1.4 MB each.
    #[must_use]
    pub fn head_mask(&self, scalp: ScalpShade, beard: Whiskers) -> &Arc<Texture> {
        self.painted.head_masks[scalp as usize * Whiskers::ALL.len() + beard as usize].get_or_init(
            || match (scalp, beard) {
                (ScalpShade::Full, Whiskers::None) => maps::head_mask(&self.data),
                _ => {
                    let plain = self.head_mask(ScalpShade::Full, Whiskers::None);
                    maps::head_mask_with(&self.data, plain, scalp, beard)
                }
            },
        )
    }

    /// Masks over the rest of the skin: red the mouth's inside, blue flushed places, alpha nails.
    #[must_use]
    pub fn body_mask(&self) -> &Arc<Texture> {
        self.painted.body_mask.get_or_init(|| maps::body_mask(&self.data))
    }

    /// Colour of the head's skin against its mean, times [`NEUTRAL_TINT`].
    #[must_use]
    pub fn head_tint(&self, freckles: Freckles) -> &Arc<Texture> {
        self.painted.head_tints[freckles as usize]
            .get_or_init(|| maps::head_tint(&self.data, freckles))
    }

    /// An old head's furrows and spots: their shade round 0.5, and their normals.
    #[must_use]
    pub fn head_age(&self) -> &[Arc<Texture>; 2] {
        self.painted.head_age.get_or_init(|| maps::head_age(&self.data))
    }

    /// Masks over an eyeball: red iris, green pupil and its dark rim, blue the veined outer white, alpha a
    /// glint.
    #[must_use]
    pub const fn eye_mask(&self) -> &Arc<Texture> {
        &self.eye_mask
    }
}

fn reach_margins_m(data: &FigureData, skin: &[SkinVertex]) -> [f64; JOINT_COUNT] {
    let t = Planes::of(&data.positions);
    let at = |v: usize| DVec3::new(f64::from(t.x[v]), f64::from(t.y[v]), f64::from(t.z[v]));
    let head = |j: usize| {
        let cube = &data.joint_heads[8 * j..8 * j + 8];
        cube.iter().map(|&v| at(usize::from(v))).sum::<DVec3>() / 8.0
    };
    let heads: [DVec3; JOINT_COUNT] = std::array::from_fn(head);
    let reach = |vertices: Range<usize>| {
        let mut out = [0.0_f64; JOINT_COUNT];
        for v in vertices {
            let s = &skin[v];
            for (&j, _) in s.joints.iter().zip(&s.weights).filter(|w| *w.1 > 0) {
                let j = usize::from(j);
                out[j] = out[j].max((at(v) - heads[j]).length());
            }
        }
        out
    };
    let coarse = data.groups[GroupId::Skin as usize].lods[VOLUME_LOD].vertices as usize;
    let joints = data.groups[GroupId::Joints as usize].first as usize;
    let (all, few) = (reach(0..joints), reach(0..coarse));
    std::array::from_fn(|j| all[j] - few[j])
}

/// A mask with all its levels.
fn with_mips(log2_size: u32, top: Vec<u32>) -> Texture {
    Texture::from_level0(log2_size, Encoding::Linear, top)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn figure() -> Arc<Figure> {
        Figure::built_in().unwrap()
    }

    fn at(figure: &Figure, v: usize) -> [f32; 3] {
        let t = figure.template();
        [t.x[v], t.y[v], t.z[v]]
    }

    /// Centimetres on the template, measured independently with a script on the source files.
    #[test]
    fn joints_stand_where_the_source_rig_has_them() {
        let expected = [
            ("Hips", [0.0, 7.3, 1.4]),
            ("Spine", [0.0, 11.9, -1.0]),
            ("Spine1", [0.0, 18.7, 1.5]),
            ("Spine2", [0.0, 28.0, 2.6]),
            ("Neck", [0.0, 58.9, 0.7]),
            ("Head", [0.0, 69.7, 1.6]),
            ("LeftShoulder", [2.7, 51.9, 6.9]),
            ("LeftArm", [16.8, 52.5, 1.5]),
            ("LeftForeArm", [31.3, 34.9, 1.3]),
            ("LeftHand", [43.1, 24.5, 17.6]),
            ("LeftUpLeg", [11.0, 4.9, 1.2]),
            ("LeftLeg", [15.8, -36.9, 3.2]),
            ("LeftFoot", [22.0, -74.5, -0.1]),
            ("LeftToeBase", [22.0, -81.0, 12.1]),
        ];
        let figure = figure();
        assert_eq!(figure.joint_names().len(), JOINT_COUNT);
        for (name, cm) in expected {
            let j = figure.joint_names().iter().position(|n| n == name).unwrap();
            for c in 0..3 {
                let cube = &figure.data().joint_heads[8 * j..8 * j + 8];
                let mean: f32 = cube.iter().map(|&v| at(&figure, v.into())[c]).sum::<f32>() / 8.0;
                assert!((mean * 100.0 - cm[c]).abs() < 0.06, "{name} {mean} {cm:?}");
            }
        }
    }

    #[test]
    fn skin_weights_mirror_exactly() {
        let figure = figure();
        let names = figure.joint_names();
        let mirror: Vec<u8> = names
            .iter()
            .map(|n| {
                let other = if n.starts_with("Left") {
                    n.replacen("Left", "Right", 1)
                } else {
                    n.replacen("Right", "Left", 1)
                };
                names.iter().position(|m| *m == other).unwrap() as u8
            })
            .collect();
        let set = |s: SkinVertex, m: &dyn Fn(u8) -> u8| -> BTreeMap<u8, u8> {
            let pairs = s.joints.iter().zip(s.weights);
            pairs.filter(|p| p.1 > 0).map(|(&j, w)| (m(j), w)).collect()
        };
        let body = figure.vertices(GroupId::Skin, figure.group(GroupId::Skin).count);
        let shell = figure.vertices(GroupId::Shell, figure.group(GroupId::Shell).count);
        for range in [body, shell] {
            // Vertices that share a place (closed lips) share the key: each must find its twin.
            let mut places = BTreeMap::<[u32; 3], Vec<usize>>::new();
            for v in range.clone() {
                let [x, y, z] = at(&figure, v);
                places.entry([(x + 0.0).to_bits(), y.to_bits(), z.to_bits()]).or_default().push(v);
            }
            for v in range {
                let [x, y, z] = at(&figure, v);
                let twins = &places[&[(-x + 0.0).to_bits(), y.to_bits(), z.to_bits()]];
                let mine = set(figure.skin()[v], &|j| mirror[usize::from(j)]);
                assert!(twins.iter().any(|&t| set(figure.skin()[t], &|j| j) == mine), "{v}");
            }
        }
    }

    #[test]
    fn levels_of_detail_are_nested_prefixes() {
        let figure = figure();
        for id in [GroupId::Skin, GroupId::Shell, GroupId::HairCap, GroupId::HairCurtain] {
            let lods = &figure.group(id).lods;
            assert_eq!(lods[0].vertices, figure.group(id).count);
            for pair in lods.windows(2) {
                assert!(pair[1].vertices < pair[0].vertices && pair[1].render < pair[0].render);
                assert!(pair[1].triangles.len() < pair[0].triangles.len());
                assert!(pair[1].error_m >= pair[0].error_m, "{id:?}");
            }
        }
        assert!(figure.lod_error_m(0) == 0.0 && figure.lod_error_m(3) < 0.02);
    }

    #[test]
    fn regressors_sum_to_one() {
        let figure = figure();
        assert_eq!(figure.keypoint_names()[..3], ["nose", "left_eye", "right_eye"]);
        for k in 0..figure.keypoint_names().len() {
            let sum: f32 = figure.keypoint(k).map(|p| p.1).sum();
            assert!((sum - 1.0).abs() < 1e-4, "{k} {sum}");
        }
    }

    #[test]
    fn the_smallest_mip_is_the_mean() {
        let figure = figure();
        let head = figure.head_mask(ScalpShade::Full, Whiskers::None);
        for t in [head, figure.body_mask(), figure.eye_mask()] {
            assert_eq!(t.texels.len(), Texture::level_offset(t.log2_size, t.log2_size) + 1);
            let side = 1usize << t.log2_size;
            for c in [0, 8, 16, 24] {
                let top = &t.texels[..side * side];
                let sum: u64 = top.iter().map(|p| u64::from((p >> c) & 255)).sum();
                let mean = sum as f64 / (side * side) as f64;
                let last = f64::from((t.texels[t.texels.len() - 1] >> c) & 255);
                assert!((mean - last).abs() < 3.0, "{mean} {last}");
            }
        }
    }

    #[test]
    fn damaged_files_are_refused() {
        let good = include_bytes!("../../../../assets/figure.fig");
        assert!(matches!(Figure::from_bytes(&good[..1000]), Err(FigureError::Compressed(_))));
        assert!(matches!(Figure::from_bytes(b"no figure"), Err(FigureError::Compressed(_))));
        let mut data = figure().data().clone();
        data.keypoint_vertices[5] = u16::MAX;
        let e = FigureData::from_bytes(&data.to_bytes()).unwrap_err();
        assert!(e.to_string().contains("keypoints"), "{e}");
    }
}
