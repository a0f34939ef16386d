//! The figure file: what it holds, as flat vectors, and its checks.
//!
//! Written by the bake program, read by [`super::Figure`]. Vertices of all groups stand in one
//! array; within a group those of coarser levels of detail come first, so that every level reads
//! a prefix. Nothing is evaluated here.

use super::predict::{self, PARENTS};
use super::stream::{Reader, Stream, Writer};
use super::{FigureError, VOLUME_LOD};

/// Levels of detail of every group, finest first.
pub const LOD_COUNT: usize = 5;
/// Units of the macro and local deltas: lossless for the source data.
pub const DELTA_UNIT_M: f32 = 1e-4;
/// Units of the arm and leg coordinates: 1 is the far end of the limb.
pub const LIMB_UNIT: f32 = 1.0 / 4096.0;
/// Vertices that regress one keypoint.
pub const KEYPOINT_VERTICES: usize = 8;
/// Keywords whose interpolation weights are multiplied into a macro target's weight.
pub const KEYWORDS: [&str; 25] = [
    "african",
    "asian",
    "caucasian",
    "male",
    "female",
    "baby",
    "child",
    "young",
    "old",
    "minmuscle",
    "averagemuscle",
    "maxmuscle",
    "minweight",
    "averageweight",
    "maxweight",
    "minheight",
    "maxheight",
    "idealproportions",
    "uncommonproportions",
    "mincup",
    "averagecup",
    "maxcup",
    "minfirmness",
    "averagefirmness",
    "maxfirmness",
];
/// Keywords in one target's name at most.
pub const MAX_FACTORS: usize = 6;
/// Fills the unused factors of a row.
pub const NO_KEYWORD: u8 = 255;

const MAGIC: &[u8] = b"figurant figure 1";

/// Groups of vertices, in the order in which they stand in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum GroupId {
    /// The body's skin.
    Skin,
    /// One-piece suit from neck to wrists and toes, from which all garments are cut.
    Shell,
    /// Both eyeballs.
    Eyes,
    /// Both rows of teeth.
    Teeth,
    /// Scalp: roots of the hair, row by row from the crown to the hairline.
    HairCap,
    /// Curtain of long hair.
    HairCurtain,
    /// Corners of the cubes whose means are the joints; never drawn.
    Joints,
}

/// How many groups there are.
pub const GROUP_COUNT: usize = 7;

/// One level of detail of a group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lod {
    /// It uses the group's vertices `0..vertices`.
    pub vertices: u32,
    /// And its render vertices `0..render`.
    pub render: u32,
    /// Largest distance of a full-detail vertex of the template to this level's surface, metres.
    pub error_m: f32,
    /// Render vertices, three a triangle, counter-clockwise from outside.
    pub triangles: Vec<u16>,
}

/// A group of vertices with its triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// Index of its first vertex among all vertices.
    pub first: u32,
    /// Number of its vertices.
    pub count: u32,
    /// Vertex, counted within the group, of each render vertex (they differ at texture seams).
    pub render: Vec<u16>,
    /// Texture coordinates of the render vertices, u then v, v down.
    pub uvs: Vec<f32>,
    /// Levels of detail, finest first; coarse ones may be empty.
    pub lods: Vec<Lod>,
}

/// Everything in a figure file. `n` is the number of vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigureData {
    /// Groups in the order of [`GroupId`].
    pub groups: Vec<Group>,
    /// Template positions, metres: n x, n y, n z. +Y up, +Z forward, +X the figure's left.
    pub positions: Vec<f32>,
    /// Three earlier vertices by which each vertex is predicted in the packed macro targets.
    pub parents: Vec<u16>,
    /// Their weights in 1/16.
    pub parent_weights: Vec<u8>,
    /// Macro targets: for each n dx, n dy, n dz, in [`DELTA_UNIT_M`].
    pub macro_deltas: Vec<i16>,
    /// Macro rows: the target that each row adds (several rows may share one).
    pub macro_target: Vec<u16>,
    /// Macro rows: [`MAX_FACTORS`] keywords each.
    pub macro_factors: Vec<u8>,
    /// Local targets: names.
    pub local_names: Vec<String>,
    /// Local targets: where each starts in the two lists below, and the end of the last.
    pub local_start: Vec<u32>,
    /// Local targets: vertices that move, ascending within a target.
    pub local_vertex: Vec<u16>,
    /// Local targets: all dx, all dy, all dz, in [`DELTA_UNIT_M`].
    pub local_delta: Vec<i16>,
    /// Joints: names.
    pub joint_names: Vec<String>,
    /// Joints: parent, 255 for the root; parents come first.
    pub joint_parent: Vec<u8>,
    /// Joints: eight vertices each whose mean is the head.
    pub joint_heads: Vec<u16>,
    /// Joints: eight vertices each whose mean is the tail.
    pub joint_tails: Vec<u16>,
    /// Skinning: four joints a vertex.
    pub skin_joints: Vec<u8>,
    /// Skinning: four weights a vertex in 1/255, summing to 255.
    pub skin_weights: Vec<u8>,
    /// Position along the arm of the vertices of skin and shell, 0 shoulder .. 1 wrist, in
    /// [`LIMB_UNIT`]; negative off the arm.
    pub arm: Vec<i16>,
    /// Position along the leg, 0 hip .. 1 ankle, likewise.
    pub leg: Vec<i16>,
    /// Vertices of the skin that lie under the shell.
    pub covered: Vec<u8>,
    /// Keypoints: names, COCO's seventeen first and in COCO's order.
    pub keypoint_names: Vec<String>,
    /// Keypoints: [`KEYPOINT_VERTICES`] vertices each.
    pub keypoint_vertices: Vec<u16>,
    /// Keypoints: their weights, summing to 1.
    pub keypoint_weights: Vec<f32>,
    /// Keypoints: vertices on the skin round each, [`KEYPOINT_VERTICES`] each.
    pub keypoint_ring: Vec<u16>,
    /// Skin vertices that can touch the ground when the figure does not stand.
    pub ground: Vec<u16>,
    /// Skin vertices among which the highest is the crown.
    pub crown: Vec<u16>,
    /// Skin vertices among which the lowest is the barefoot ground.
    pub feet: Vec<u16>,
    /// Shell vertices under the soles.
    pub sole: Vec<u16>,
    /// Body volume over the volume inside the skin's level of detail [`super::VOLUME_LOD`].
    pub volume_factor: Vec<f32>,
    /// Hair cap: distance of each root to the hairline along the head, metres.
    pub hair_depth: Vec<f32>,
    /// Mask texture of the skin: all red, all green, all blue, all alpha, rows downwards.
    pub mask: Vec<u8>,
}

impl FigureData {
    /// Number of vertices of all groups.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.positions.len() / 3
    }

    fn walk<S: Stream>(&mut self, s: &mut S) -> Result<(), FigureError> {
        let mut magic = MAGIC.to_vec();
        s.bytes("header", &mut magic)?;
        if magic != MAGIC {
            return Err(FigureError::Malformed { what: "header" });
        }
        self.groups.resize(GROUP_COUNT, Group::default());
        for g in &mut self.groups {
            let mut range = vec![g.first, g.count];
            s.words("group ranges", 0, &mut range)?;
            let [first, count] = range[..] else {
                return Err(FigureError::Malformed { what: "group ranges" });
            };
            (g.first, g.count) = (first, count);
            s.words("render vertices", 0, &mut g.render)?;
            s.words("texture coordinates", 0, &mut g.uvs)?;
            g.lods.resize(LOD_COUNT, Lod::default());
            for lod in &mut g.lods {
                let mut head = vec![lod.vertices, lod.render, lod.error_m.to_bits()];
                s.words("levels of detail", 0, &mut head)?;
                let [vertices, render, error] = head[..] else {
                    return Err(FigureError::Malformed { what: "levels of detail" });
                };
                (lod.vertices, lod.render, lod.error_m) = (vertices, render, f32::from_bits(error));
                s.words("triangles", 0, &mut lod.triangles)?;
            }
        }
        s.words("positions", 0, &mut self.positions)?;
        let n = self.vertex_count();
        s.words("parents", 0, &mut self.parents)?;
        s.bytes("parents", &mut self.parent_weights)?;
        s.words("macro deltas", n, &mut self.macro_deltas)?;
        s.words("macro rows", 0, &mut self.macro_target)?;
        s.bytes("macro rows", &mut self.macro_factors)?;
        s.names("local names", &mut self.local_names)?;
        s.words("local starts", 0, &mut self.local_start)?;
        s.words("local vertices", 0, &mut self.local_vertex)?;
        s.words("local deltas", 0, &mut self.local_delta)?;
        s.names("joint names", &mut self.joint_names)?;
        s.bytes("joint parents", &mut self.joint_parent)?;
        s.words("joint heads", 0, &mut self.joint_heads)?;
        s.words("joint tails", 0, &mut self.joint_tails)?;
        s.bytes("skin joints", &mut self.skin_joints)?;
        s.bytes("skin weights", &mut self.skin_weights)?;
        s.words("arm coordinates", 0, &mut self.arm)?;
        s.words("leg coordinates", 0, &mut self.leg)?;
        s.bytes("covered skin", &mut self.covered)?;
        s.names("keypoint names", &mut self.keypoint_names)?;
        s.words("keypoint vertices", 0, &mut self.keypoint_vertices)?;
        s.words("keypoint weights", 0, &mut self.keypoint_weights)?;
        s.words("keypoint rings", 0, &mut self.keypoint_ring)?;
        s.words("ground vertices", 0, &mut self.ground)?;
        s.words("crown vertices", 0, &mut self.crown)?;
        s.words("foot vertices", 0, &mut self.feet)?;
        s.words("sole vertices", 0, &mut self.sole)?;
        s.words("volume factor", 0, &mut self.volume_factor)?;
        s.words("hair depth", 0, &mut self.hair_depth)?;
        s.bytes("mask", &mut self.mask)
    }

    /// The file's bytes before compression.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut packed = self.clone();
        predict::encode(&mut packed.macro_deltas, &self.parents, &self.parent_weights);
        let mut w = Writer::default();
        packed.walk(&mut w).expect("writing to memory does not fail");
        w.out
    }

    /// Reads uncompressed bytes and checks that every index is in range.
    ///
    /// # Errors
    /// [`FigureError::Malformed`] names the part that is short or out of range.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FigureError> {
        let mut data = Self::default();
        let mut r = Reader::new(bytes);
        data.walk(&mut r)?;
        if !r.is_empty() {
            return Err(FigureError::Malformed { what: "end of file" });
        }
        data.check()?;
        predict::decode(&mut data.macro_deltas, &data.parents, &data.parent_weights);
        Ok(data)
    }

    fn check(&self) -> Result<(), FigureError> {
        let need = |ok: bool, what| if ok { Ok(()) } else { Err(FigureError::Malformed { what }) };
        let n = self.vertex_count();
        let below = |v: &[u16], first: u32, count: u32| {
            v.iter().all(|&i| (first..first + count).contains(&u32::from(i)))
        };
        let mut next = 0;
        for g in &self.groups {
            need(g.first == next, "group ranges")?;
            next = g
                .first
                .checked_add(g.count)
                .ok_or(FigureError::Malformed { what: "group ranges" })?;
            need(below(&g.render, 0, g.count), "render vertices")?;
            need(g.uvs.len() == 2 * g.render.len(), "texture coordinates")?;
            for lod in &g.lods {
                need(lod.render as usize <= g.render.len(), "levels of detail")?;
                need(below(&g.render[..lod.render as usize], 0, lod.vertices), "levels of detail")?;
                need(lod.vertices <= g.count && lod.error_m.is_finite(), "levels of detail")?;
                need(
                    lod.triangles.len().is_multiple_of(3) && below(&lod.triangles, 0, lod.render),
                    "triangles",
                )?;
            }
        }
        need(next as usize == n && self.positions.len() == 3 * n, "positions")?;
        need(self.positions.iter().all(|v| v.is_finite()), "positions")?;
        need(self.parents.len() == PARENTS * n, "parents")?;
        need(self.parent_weights.len() == PARENTS * n, "parents")?;
        let earlier = |(i, &p): (usize, &u16)| usize::from(p) <= i / PARENTS;
        need(self.parents.iter().enumerate().all(earlier), "parents")?;
        let targets = self.macro_deltas.len().checked_div(3 * n).unwrap_or(0);
        need(targets * 3 * n == self.macro_deltas.len() && targets > 0, "macro deltas")?;
        need(self.macro_target.iter().all(|&t| usize::from(t) < targets), "macro rows")?;
        need(self.macro_factors.len() == self.macro_target.len() * MAX_FACTORS, "macro rows")?;
        need(
            self.macro_factors.iter().all(|&k| k == NO_KEYWORD || usize::from(k) < KEYWORDS.len()),
            "macro rows",
        )?;
        let locals = self.local_vertex.len();
        need(self.local_start.len() == self.local_names.len() + 1, "local starts")?;
        need(self.local_start.is_sorted(), "local starts")?;
        need(self.local_start.last().is_some_and(|&e| e as usize == locals), "local starts")?;
        need(self.local_delta.len() == 3 * locals, "local deltas")?;
        need(self.local_vertex.iter().all(|&v| usize::from(v) < n), "local vertices")?;
        let joints = self.joint_names.len();
        need(self.joint_parent.len() == joints, "joint parents")?;
        for (j, &p) in self.joint_parent.iter().enumerate() {
            need(if j == 0 { p == 255 } else { usize::from(p) < j }, "joint parents")?;
        }
        let all = u32::try_from(n).unwrap_or(u32::MAX);
        need(
            self.joint_heads.len() == 8 * joints && below(&self.joint_heads, 0, all),
            "joint heads",
        )?;
        need(
            self.joint_tails.len() == 8 * joints && below(&self.joint_tails, 0, all),
            "joint tails",
        )?;
        need(self.skin_joints.len() == 4 * n, "skin joints")?;
        need(self.skin_joints.iter().all(|&j| usize::from(j) < joints), "skin joints")?;
        need(self.skin_weights.len() == 4 * n, "skin weights")?;
        need(
            self.skin_weights
                .chunks(4)
                .all(|w| w.iter().map(|&x| u32::from(x)).sum::<u32>() == 255),
            "skin weights",
        )?;
        let (skin, shell) =
            (&self.groups[GroupId::Skin as usize], &self.groups[GroupId::Shell as usize]);
        let dressed = (skin.count + shell.count) as usize;
        need(self.arm.len() == dressed && self.leg.len() == dressed, "arm and leg coordinates")?;
        need(self.covered.len() == skin.count as usize, "covered skin")?;
        let points = self.keypoint_names.len();
        need(points >= 17, "keypoint names")?;
        for list in [&self.keypoint_vertices, &self.keypoint_ring] {
            need(list.len() == points * KEYPOINT_VERTICES && below(list, 0, all), "keypoints")?;
        }
        let prefix = |g: GroupId, lod: usize| {
            let g = &self.groups[g as usize];
            g.first..g.first + g.lods[lod].vertices
        };
        let always = [
            prefix(GroupId::Skin, VOLUME_LOD),
            prefix(GroupId::Shell, LOD_COUNT - 1),
            prefix(GroupId::Eyes, LOD_COUNT - 1),
            prefix(GroupId::Joints, LOD_COUNT - 1),
        ];
        for list in [
            &self.keypoint_vertices,
            &self.keypoint_ring,
            &self.ground,
            &self.sole,
            &self.joint_heads,
            &self.joint_tails,
        ] {
            let known = |v: &u16| always.iter().any(|r| r.contains(&u32::from(*v)));
            need(list.iter().all(known), "vertices that every body needs")?;
        }
        need(self.keypoint_weights.len() == self.keypoint_vertices.len(), "keypoint weights")?;
        for list in [&self.ground, &self.crown, &self.feet] {
            need(!list.is_empty() && below(list, skin.first, skin.count), "ground vertices")?;
        }
        need(
            !self.sole.is_empty() && below(&self.sole, shell.first, shell.count),
            "sole vertices",
        )?;
        need(self.volume_factor.len() == 1, "volume factor")?;
        let cap = &self.groups[GroupId::HairCap as usize];
        need(self.hair_depth.len() == cap.count as usize, "hair depth")?;
        let side = (self.mask.len() / 4).isqrt();
        need(side.is_power_of_two() && side * side * 4 == self.mask.len(), "mask")
    }
}
