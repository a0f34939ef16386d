//! A dressed person at rest: one mesh in parts.
//!
//! Figure, person and rest body flow in, a [`Dressed`] mesh flows out, in model space with skin
//! weights: soles at y = 0, facing +Z. A coarser level of detail costs proportionally less, since
//! every level evaluates only a prefix of the vertices. What the parts look like is decided in
//! [`super::surface`]; poses and the camera are not known here.

use std::ops::Range;
use std::sync::Arc;

use glam::Vec3;

use super::body::RestBody;
use super::cut::{Builder, Surface as Cloth, net_normals};
use super::garment::{self, Cuts};
use super::hang::Hang;
use super::shown::Shown;
use super::sway::CLOTH_JOINT_COUNT;
use super::tress::Tresses;
use super::{beard, clothes, glasses, hair, headwear, lashes, phenotype};
use crate::base::hash::Hasher;
use crate::library::figure::{Figure, GroupId, LOD_COUNT};
use crate::library::mesh::{Cutout, Mesh, SkinVertex};
use crate::scene::{BeardStyle, Body, Glasses, HairStyle, HeadwearKind, Look, Outfit, Person};

/// What a part of a person is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PartKind {
    /// Skin of the head.
    Head,
    /// Bare skin elsewhere.
    Skin,
    /// What is worn under a skirt: skin in another colour.
    Underwear,
    /// Eyeballs.
    Eyes,
    /// Teeth.
    Teeth,
    /// Lashes.
    Lashes,
    /// What lies under the locks of the hair, and hair without locks.
    Hair,
    /// Locks.
    Locks,
    /// Locks that are a little lighter.
    LightLocks,
    /// On the head.
    Headwear,
    /// Frame of the glasses.
    Frame,
    /// Dark lenses.
    Lenses,
    /// Garment of the upper body.
    Top,
    /// Garment of the legs.
    Bottom,
    /// Garment over the top.
    Outer,
    /// Socks.
    Socks,
    /// Shoes without their soles.
    Shoes,
    /// Soles of the shoes.
    Soles,
}

/// A range of a person's triangles with one surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// What it is.
    pub kind: PartKind,
    /// Range of the mesh's triangles.
    pub triangles: Range<u32>,
    /// Its back can be seen, through an opening of the cloth.
    pub double_sided: bool,
    /// Which part of the triangles there is, where that is not all.
    pub cutout: Option<Cutout>,
}

/// A dressed person at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Dressed {
    /// All parts, with skin weights.
    pub mesh: Arc<Mesh>,
    /// Parts in a fixed order; empty ones are left out.
    pub parts: Vec<Part>,
    /// What moves hanging hair: its joints come after those of [`super::sway`].
    pub tresses: Option<Tresses>,
    /// What moves a skirt: its joints come last.
    pub hang: Option<Hang>,
}

/// A group evaluated for one person at one level of detail.
pub(super) struct Evaluated<'a> {
    render: &'a [u16],
    uvs: &'a [f32],
    triangles: &'a [u16],
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub skin: &'a [SkinVertex],
}

impl<'a> Evaluated<'a> {
    pub fn new(figure: &'a Figure, rest: &RestBody, id: GroupId, lod: usize) -> Self {
        let range = figure.vertices(id, figure.group(id).lods[lod].vertices);
        let positions: Vec<Vec3> = phenotype::evaluate(figure, &rest.shape, range)
            .into_iter()
            .map(Vec3::from_array)
            .collect();
        let normals = net_normals(&positions, figure.net(id, lod));
        Self::of(figure, id, lod, (positions, normals))
    }

    /// A group's vertices that were evaluated.
    pub fn of(
        figure: &'a Figure,
        id: GroupId,
        lod: usize,
        (positions, normals): (Vec<Vec3>, Vec<Vec3>),
    ) -> Self {
        let group = figure.group(id);
        let level = &group.lods[lod];
        let uvs = match id {
            GroupId::Skin => figure.skin_uvs(),
            GroupId::Shell => figure.shell_uvs(),
            _ => &group.uvs,
        };
        Self {
            render: &group.render[..level.render as usize],
            uvs: &uvs[..2 * level.render as usize],
            triangles: &level.triangles,
            positions,
            normals,
            skin: &figure.skin()[figure.vertices(id, level.vertices)],
        }
    }

    /// Numbers of all its triangles.
    fn all(&self) -> impl Iterator<Item = u32> + use<> {
        0..(self.triangles.len() / 3) as u32
    }

    pub fn surface(&self) -> Cloth<'_> {
        self.with(&self.positions, &self.normals)
    }

    /// The same triangles with other positions and normals.
    pub fn with<'b>(&'b self, positions: &'b [Vec3], normals: &'b [Vec3]) -> Cloth<'b> {
        Cloth {
            render: self.render,
            uvs: self.uvs,
            triangles: self.triangles,
            positions,
            normals,
            skin: self.skin,
        }
    }
}

/// The mesh and the parts while they grow.
pub(super) struct Parts {
    pub builder: Builder,
    parts: Vec<Part>,
}

impl Parts {
    pub fn add(&mut self, kind: PartKind, triangles: Range<u32>, double_sided: bool) {
        self.push(Part { kind, triangles, double_sided, cutout: None });
    }

    fn add_strands(&mut self, kind: PartKind, triangles: Range<u32>, cutout: Option<Cutout>) {
        self.push(Part { kind, triangles, double_sided: true, cutout });
    }

    fn push(&mut self, part: Part) {
        if !part.triangles.is_empty() {
            self.parts.push(part);
        }
    }
}

/// What a person's mesh depends on, as a hash: those who share it differ in pose, place and colours
/// only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct MeshKey([u8; 32]);

impl MeshKey {
    /// The key of a person.
    #[must_use]
    pub fn new(person: &Person) -> Self {
        let Person { body, look, outfit, .. } = person;
        let Body {
            sex,
            age_years,
            stature_m,
            bmi_kg_m2,
            muscle,
            proportions,
            ancestry: [african, asian, european],
            cup,
            firmness,
        } = *body;
        let Outfit { top, bottom, outer, shoes } = outfit;
        let mut hasher = Hasher::new();
        hasher.bytes(&[sex as u8, look.hair as u8, bottom.kind as u8]);
        hasher.bytes(&[look.beard as u8, look.headwear.kind as u8, look.glasses as u8]);
        hasher.bytes(&[top.kind as u8, outer.kind as u8, shoes.kind as u8, u8::from(outer.open)]);
        let sizes =
            [age_years, stature_m, bmi_kg_m2, muscle, proportions, african, asian, european];
        let cuts = [cup, firmness, top.sleeve, top.neckline, top.looseness_m];
        let ends =
            [bottom.length, bottom.looseness_m, bottom.flare, outer.looseness_m, shoes.socks];
        sizes.iter().chain(&cuts).chain(&ends).for_each(|v| hasher.number(*v));
        for (name, amount) in &look.face {
            hasher.bytes(name.as_bytes());
            hasher.number(*amount);
        }
        Self(hasher.finish())
    }
}

/// How far hair of a style may hang from where neck and head meet on an adult, wherever down is,
/// metres; nothing if it keeps to the head.
#[must_use]
pub fn hair_reach_m(style: HairStyle) -> Option<f64> {
    hair::reach_m(style)
}

/// Vertices of most people, by level of detail.
const VERTICES: [usize; LOD_COUNT] = [26_000, 12_000, 7_500, 4_000, 2_200];

/// Dresses a person at a level of detail, 0 the finest; levels beyond the coarsest are the
/// coarsest.
#[must_use]
pub fn dress(figure: &Figure, person: &Person, rest: &RestBody, lod: usize) -> Dressed {
    let lod = lod.min(LOD_COUNT - 1);
    let cuts = Cuts::new(&person.outfit);
    let mut out = Parts { builder: Builder::with_room(VERTICES[lod]), parts: Vec::new() };
    let skin = add_skin(&mut out, figure, person, (rest, &cuts), lod);
    add_face(&mut out, figure, person, (rest, &skin), lod);
    let tresses = add_head(&mut out, figure, person, (rest, &skin), lod);
    let first_joint = CLOTH_JOINT_COUNT + tresses.as_ref().map_or(0, Tresses::joint_count);
    let hang = clothes::add(&mut out, figure, (rest, first_joint), &cuts, lod);
    let mut mesh = out.builder.mesh;
    bound(&mut mesh);
    mesh.shrink_to_fit();
    Dressed { mesh: Arc::new(mesh), parts: out.parts, tresses, hang }
}

/// The skin that shows; gives back all of it.
fn add_skin<'a>(
    out: &mut Parts,
    figure: &'a Figure,
    person: &Person,
    (rest, cuts): (&RestBody, &Cuts),
    lod: usize,
) -> Evaluated<'a> {
    let count = figure.group(GroupId::Skin).lods[lod].vertices;
    let places = figure.places(GroupId::Skin, count);
    let hidden = garment::hidden(figure, cuts, places, lod);
    let shown = Shown::new(figure, lod, &hidden, hair::above_y(person));
    let mut skin = shown.evaluate(figure, rest);
    let on = (&mut skin.positions[..], &skin.normals[..]);
    garment::tuck(figure, cuts, places, lod, on, &shown.wanted);
    let net = figure.net(GroupId::Skin, lod);
    let is_under = |t: &u32| {
        net.triangles[*t as usize].iter().all(|v| cuts.is_underwear(places[usize::from(*v)]))
    };
    let (under, bare) = shown.elsewhere.into_iter().partition(is_under);
    let parts =
        [(PartKind::Head, shown.head), (PartKind::Skin, bare), (PartKind::Underwear, under)];
    for (kind, triangles) in parts {
        let range = out.builder.add_whole(&skin.surface(), triangles.into_iter());
        out.add(kind, range, false);
    }
    skin
}

fn add_face(
    out: &mut Parts,
    figure: &Figure,
    person: &Person,
    (rest, skin): (&RestBody, &Evaluated<'_>),
    lod: usize,
) {
    let eyes = Evaluated::new(figure, rest, GroupId::Eyes, lod);
    let range = out.builder.add_whole(&eyes.surface(), eyes.all());
    out.add(PartKind::Eyes, range, false);
    if lod == 0 {
        let range = lashes::add(&mut out.builder.mesh, figure, &skin.surface(), &eyes.positions);
        out.add(PartKind::Lashes, range, true);
    }
    if opens_mouth(&person.look) {
        let teeth = Evaluated::new(figure, rest, GroupId::Teeth, lod);
        let range = out.builder.add_whole(&teeth.surface(), teeth.all());
        out.add(PartKind::Teeth, range, true);
    }
}

/// Whether an expression parts the lips. Expressions are named in camel case, shapes with dashes.
fn opens_mouth(look: &Look) -> bool {
    look.face.iter().any(|(name, amount)| {
        *amount > 0.05
            && (name.starts_with("jaw") || name.starts_with("mouth"))
            && !name.contains('-')
    })
}

/// What grows and sits on the head; gives what moves hanging hair.
fn add_head(
    out: &mut Parts,
    figure: &Figure,
    person: &Person,
    (rest, skin): (&RestBody, &Evaluated<'_>),
    lod: usize,
) -> Option<Tresses> {
    let look = &person.look;
    let bare = look.hair == HairStyle::Bald && look.headwear.kind == HeadwearKind::None;
    let shaven = matches!(look.beard, BeardStyle::None | BeardStyle::Stubble);
    if bare && shaven && look.glasses == Glasses::None {
        return None;
    }
    let head = hair::Head::new(figure, person, rest, lod, &skin.positions);
    let hair = hair::add(&mut out.builder.mesh, rest, &head, look.hair);
    let [base, locks, light] = hair.ranges;
    // Hair without locks has no light ones beside which it would have to be dark.
    let plain = locks.is_empty() && light.is_empty();
    out.add(if plain { PartKind::Locks } else { PartKind::Hair }, base, true);
    let cutout = hair::cutout(look.hair, lod);
    out.add_strands(PartKind::Locks, locks, cutout);
    out.add_strands(PartKind::LightLocks, light, cutout);
    if !shaven {
        let [base, locks] =
            beard::add(&mut out.builder, figure, &head, look.beard, &skin.surface());
        out.add(PartKind::Hair, base, true);
        out.add_strands(PartKind::Locks, locks, beard::cutout(look.beard, lod));
    }
    let range = headwear::add(&mut out.builder.mesh, &head);
    out.add(PartKind::Headwear, range, true);
    if look.glasses != Glasses::None {
        let eyes = Evaluated::new(figure, rest, GroupId::Eyes, 0);
        let [frame, lenses] =
            glasses::add(&mut out.builder.mesh, &head, look.glasses, &eyes.positions);
        out.add(PartKind::Frame, frame, true);
        out.add(PartKind::Lenses, lenses, true);
    }
    hair.tresses
}

/// Sets the sphere round all vertices: the middle of their box and the farthest of them.
fn bound(mesh: &mut Mesh) {
    let (mut low, mut high) = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
    for p in mesh.positions.iter().map(|p| Vec3::from_array(*p)) {
        (low, high) = (low.min(p), high.max(p));
    }
    let center = (low + high) * 0.5;
    let far = |p: &[f32; 3]| (Vec3::from_array(*p) - center).length();
    mesh.radius_m = mesh.positions.iter().map(far).fold(0.0, f32::max);
    mesh.center = center.to_array();
}

#[cfg(test)]
mod tests;
