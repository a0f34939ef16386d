//! Wall, floor and occluders.

use glam::{DQuat, DVec3};

use super::linked::{Draw, Draws, Place};
use super::people::Standing;
use super::place::{OCCLUDERS, Places, Setting, places};
use super::solid::Solid;
use super::value::{color, item, number, rotation_at, vector};
use super::{Catalogue, keys};
use crate::base::rng::Key;
use crate::document::{Choice, Color, Document, Materials, Occluders, Param};
use crate::scene::{Camera, Material, Object, Placement, Role, Shape};

/// Thickness of the floor; its upper face is where the document says.
const FLOOR_THICKNESS_M: f64 = 0.1;
/// Sizes of the seed's primitives at scale 1: five inches, spheres six.
const BASE_SIZE_M: f64 = 0.127;
const SPHERE_SIZE_M: f64 = 0.1524;
/// Lanes that keep the materials of surfaces of one slot apart.
const OCCLUDER_LANE: u16 = 0;
const WALL_LANE: u16 = 1;
const FLOOR_LANE: u16 = 2;
/// That of what somebody sits on.
pub(super) const SEAT_LANE: u16 = 3;

pub(super) fn objects(
    document: &Document,
    catalogue: &Catalogue,
    draws: Draws,
    camera: &Camera,
) -> Vec<Object> {
    let surfaces = Surfaces { document, catalogue, draws, camera };
    let mut objects = Vec::new();
    objects.extend(surfaces.wall());
    objects.extend(surfaces.floor());
    surfaces.occluders(&mut objects);
    objects
}

struct Surfaces<'a> {
    document: &'a Document,
    catalogue: &'a Catalogue,
    draws: Draws<'a>,
    camera: &'a Camera,
}

/// What a section says of its surface, with the keys of its values.
struct Finish<'a> {
    texture: (&'a Choice<String>, Key),
    color: (&'a Color, Key),
    hue_offset_deg: (&'a Param, Key),
    uv_repeat: [f64; 2],
}

impl Surfaces<'_> {
    fn material(&self, finish: &Finish, slot: u32, lane: u16) -> Material {
        let of = |key| self.draws.at(Place::Surface(slot, lane)).of(key, slot);
        let [roughness, metallic, normal_strength] =
            finish_of(&self.document.materials, self.draws, slot, lane);
        Material {
            texture: asset(finish.texture.0, &self.catalogue.textures, of(finish.texture.1)),
            base_color: color(finish.color.0, of(finish.color.1)),
            hue_offset_deg: number(finish.hue_offset_deg.0, of(finish.hue_offset_deg.1)),
            uv_repeat: finish.uv_repeat,
            roughness,
            metallic,
            normal_strength,
        }
    }

    fn wall(&self) -> Option<Object> {
        let wall = &self.document.background.wall;
        let finish = Finish {
            texture: (&wall.texture, keys::WALL_TEXTURE),
            color: (&wall.color, keys::WALL_COLOR),
            hue_offset_deg: (&wall.hue_offset_deg, keys::WALL_HUE),
            uv_repeat: wall.uv_repeat,
        };
        wall.enabled.then(|| Object {
            role: Role::Wall,
            shape: Shape::Cube,
            placement: Placement {
                position_m: vector(&wall.position_m, self.draws.of(keys::WALL_POSITION, 0)),
                rotation: DQuat::IDENTITY,
                scale: DVec3::from_array(wall.size_m),
            },
            material: self.material(&finish, 0, WALL_LANE),
        })
    }

    fn floor(&self) -> Option<Object> {
        let floor = &self.document.background.floor;
        let finish = Finish {
            texture: (&floor.texture, keys::FLOOR_TEXTURE),
            color: (&floor.color, keys::FLOOR_COLOR),
            hue_offset_deg: (&floor.hue_offset_deg, keys::FLOOR_HUE),
            uv_repeat: floor.uv_repeat,
        };
        let top = vector(&floor.position_m, self.draws.of(keys::FLOOR_POSITION, 0));
        floor.enabled.then(|| Object {
            role: Role::Floor,
            shape: Shape::Cube,
            placement: Placement {
                position_m: top - DVec3::new(0.0, 0.5 * FLOOR_THICKNESS_M, 0.0),
                rotation: DQuat::IDENTITY,
                scale: DVec3::new(floor.size_m[0], FLOOR_THICKNESS_M, floor.size_m[1]),
            },
            material: self.material(&finish, 0, FLOOR_LANE),
        })
    }

    fn occluders(&self, objects: &mut Vec<Object>) {
        let occluders = &self.document.occluders;
        if !occluders.enabled {
            return;
        }
        let finish = Finish {
            texture: (&occluders.texture, keys::OCCLUDER_TEXTURE),
            color: (&occluders.color, keys::OCCLUDER_COLOR),
            hue_offset_deg: (&occluders.hue_offset_deg, keys::OCCLUDER_HUE),
            uv_repeat: occluders.uv_repeat,
        };
        let (draws, camera) = (self.draws, self.camera);
        for (slot, base_m) in occluder_places(self.document, draws, camera).points {
            let (shape, form) = occluder(occluders, draws, camera, slot, base_m);
            objects.push(Object {
                role: Role::Occluder,
                shape,
                placement: form,
                material: self.material(&finish, slot, OCCLUDER_LANE),
            });
        }
    }
}

/// Roughness, metal and strength of the normal map of a surface of a slot.
pub(super) fn finish_of(rules: &Materials, draws: Draws, slot: u32, lane: u16) -> [f64; 3] {
    let draws = draws.at(Place::Surface(slot, lane)).random_if(rules.enabled);
    let rule = |param, key| number(param, draws.of(key, slot).lane(lane));
    [
        rule(&rules.roughness, keys::MATERIAL_ROUGHNESS),
        rule(&rules.metallic, keys::MATERIAL_METALLIC),
        rule(&rules.normal_strength, keys::MATERIAL_NORMAL),
    ]
}

/// Where occluders stand; nowhere if there are none.
pub(super) fn occluder_places(document: &Document, draws: Draws, camera: &Camera) -> Places {
    let occluders = &document.occluders;
    if !occluders.enabled {
        return Places { points: Vec::new(), wanted: 0 };
    }
    let taken = if occluders.placement.no_overlap() {
        Standing::new(&document.people, draws, camera).solids()
    } else {
        Vec::new()
    };
    let solid = |slot, base_m| {
        let (shape, form) = occluder(occluders, draws, camera, slot, base_m);
        let half = DVec3::new(0.5, half_height(shape), 0.5);
        Solid { middle_m: form.position_m, half_m: half * form.scale, rotation: form.rotation }
    };
    let setting = Setting { camera, taken: &taken, solid: &solid };
    places(&occluders.placement, &OCCLUDERS, draws, setting)
}

/// An occluder that stands with the middle of its base somewhere.
fn occluder(
    occluders: &Occluders,
    draws: Draws,
    camera: &Camera,
    slot: u32,
    base_m: DVec3,
) -> (Shape, Placement) {
    let draws = draws.at(Place::Surface(slot, OCCLUDER_LANE));
    let of = |key| draws.of(key, slot);
    let shape = *item(&occluders.shape, of(keys::OCCLUDER_SHAPE));
    let unit = if shape == Shape::Sphere { SPHERE_SIZE_M } else { BASE_SIZE_M };
    let size = unit * number(&occluders.scale, of(keys::OCCLUDER_SCALE));
    let turn = of(keys::OCCLUDER_ROTATION);
    let turn = rotation_at(&occluders.rotation_deg, base_m, camera.position_m, turn);
    // Turned about the middle of the base.
    let middle_m = base_m + turn * DVec3::new(0.0, half_height(shape) * size, 0.0);
    (shape, Placement { position_m: middle_m, rotation: turn, scale: DVec3::splat(size) })
}

/// Of a primitive in its model space.
fn half_height(shape: Shape) -> f64 {
    match shape {
        Shape::Torus => 0.15,
        Shape::Cube | Shape::Cylinder | Shape::Sphere | Shape::Capsule | Shape::Cone => 0.5,
    }
}

/// The asset that a choice of ids falls on, if any. The catalogue holds what the choice names.
pub(super) fn asset(choice: &Choice<String>, known: &[String], draw: Draw) -> Option<String> {
    match item(choice, draw).as_str() {
        "none" => None,
        "any" => {
            let index = (draw.lane(1).uniform() * known.len() as f64) as usize;
            known.get(index).cloned()
        }
        id => Some(id.to_owned()),
    }
}
