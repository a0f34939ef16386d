//! Where things stand: placement, background and occluders.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Choice, Color, Param, Rotation, Vector};
use crate::scene::Shape;

/// How positions, and how many of them, come about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "mode", rename_all = "snake_case")]
pub enum Placement {
    /// A saturated Poisson-disk pattern in x and y, with depth drawn apart: nothing stands on a
    /// ground. The number follows from area and separation.
    PoissonDisk(PoissonDisk),
    /// At random on a level ground, at a distance from each other.
    Ground(Ground),
    /// Side by side along x.
    Row(Row),
    /// In rows along x, one behind or below the other.
    Grid(Grid),
}

impl Placement {
    /// Whether what is placed keeps out of what else stands.
    #[must_use]
    pub const fn no_overlap(&self) -> bool {
        match self {
            Self::PoissonDisk(disk) => disk.no_overlap,
            Self::Ground(ground) => ground.no_overlap,
            Self::Row(_) | Self::Grid(_) => false,
        }
    }
}

/// A saturated pattern: no further point fits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PoissonDisk {
    /// From and to.
    #[serde(default = "seed_side")]
    pub x_m: [f64; 2],
    /// From and to.
    #[serde(default = "seed_side")]
    pub y_m: [f64; 2],
    /// z, drawn for each.
    pub depth_m: Param,
    /// Least distance between two, measured in x and y.
    pub separation_m: f64,
    /// How many of the pattern, rounded to the nearest whole number: any of its points as likely as
    /// any other. All of them where absent, or where there are fewer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<Param>,
    /// Whether what stands there keeps out of what else stands: people of people, occluders of people
    /// and of each other. A person counts as a box of 0.6 x 1.8 x 0.6 m times the scale, whatever
    /// the pose; an occluder as its box. Up to 200 depths are tried for each; who finds no room is left
    /// out.
    #[serde(default, skip_serializing_if = "is_false")]
    pub no_overlap: bool,
    /// Share of those who must stand where the camera sees their middle, 0..1; the others may stand
    /// anywhere.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub in_view: f64,
}

fn seed_side() -> [f64; 2] {
    [-7.5, 7.5]
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for references")]
const fn is_false(value: &bool) -> bool {
    !*value
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// An area on the ground. Up to 200 places are tried for each; who finds no room is left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ground {
    /// From and to.
    pub x_m: [f64; 2],
    /// From and to.
    pub z_m: [f64; 2],
    /// Height of the ground.
    #[serde(default)]
    pub y_m: f64,
    /// How many, rounded to the nearest whole number.
    pub count: Param,
    /// Least distance between two.
    pub separation_m: f64,
    /// Whether what stands there keeps out of what else stands: people of people, occluders of people
    /// and of each other. A person counts as a box of 0.6 x 1.8 x 0.6 m times the scale, whatever
    /// the pose; an occluder as its box.
    #[serde(default, skip_serializing_if = "is_false")]
    pub no_overlap: bool,
    /// Share of those who must stand where the camera sees their middle, 0..1; the others may stand
    /// anywhere.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub in_view: f64,
}

/// Side by side along x.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// How many.
    pub count: u32,
    /// From one to the next.
    pub spacing_m: f64,
    /// The middle of the row.
    #[serde(default)]
    pub center_m: [f64; 3],
}

/// Rows along x.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// How many along x.
    pub columns: u32,
    /// How many rows.
    pub rows: u32,
    /// From one to the next along x, and from row to row.
    pub spacing_m: [f64; 2],
    /// The middle of the grid.
    #[serde(default)]
    pub center_m: [f64; 3],
    /// Where the rows after the first one are.
    #[serde(default)]
    pub plane: GridPlane,
}

/// In which plane a [`Grid`] lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GridPlane {
    /// On the ground: the first row is nearest to +Z.
    #[default]
    Ground,
    /// Upright, as on a contact sheet: the first row is on top.
    Upright,
}

/// What walls, floors, occluders and seats are made of where a texture does not say.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Materials {
    /// Where false, every parameter takes its median.
    pub enabled: bool,
    /// Perceptual roughness.
    pub roughness: Param,
    /// 0 dielectric .. 1 metal.
    pub metallic: Param,
    /// Strength of the texture's normal map, where it has one.
    pub normal_strength: Param,
}

impl Default for Materials {
    fn default() -> Self {
        Self {
            enabled: true,
            roughness: 0.6.into(),
            metallic: 0.0.into(),
            normal_strength: 1.0.into(),
        }
    }
}

/// What stands behind and below.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Background {
    /// The wall.
    pub wall: Wall,
    /// The ground.
    pub floor: Floor,
}

/// A slab that stands upright behind everything.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Wall {
    /// Where false, there is none.
    pub enabled: bool,
    /// Its middle.
    pub position_m: Vector,
    /// Width, height and thickness.
    pub size_m: [f64; 3],
    /// Texture id; `"any"` for one of all, `"none"` for plain.
    pub texture: Choice<String>,
    /// Multiplies the texture.
    pub color: Color,
    /// Rotation of the hue.
    pub hue_offset_deg: Param,
    /// Repeats of the texture, across and down.
    pub uv_repeat: [f64; 2],
}

impl Default for Wall {
    fn default() -> Self {
        Self {
            enabled: true,
            position_m: Vector::constant(0.0, 0.0, -10.0),
            size_m: [30.0, 30.0, 0.1],
            texture: Choice::Always("any".to_owned()),
            color: Color::WHITE,
            hue_offset_deg: Param::uniform(-180.0, 180.0),
            uv_repeat: [1.0, 1.0],
        }
    }
}

/// A level slab to stand on. The seed has none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Floor {
    /// Where false, there is none.
    pub enabled: bool,
    /// The middle of its upper face.
    pub position_m: Vector,
    /// Along x and z.
    pub size_m: [f64; 2],
    /// Texture id; `"any"` for one of all, `"none"` for plain.
    pub texture: Choice<String>,
    /// Multiplies the texture.
    pub color: Color,
    /// Rotation of the hue.
    pub hue_offset_deg: Param,
    /// Repeats of the texture along x and z.
    pub uv_repeat: [f64; 2],
}

impl Default for Floor {
    fn default() -> Self {
        Self {
            enabled: false,
            position_m: Vector::constant(0.0, 0.0, 0.0),
            size_m: [30.0, 30.0],
            texture: Choice::Always("any".to_owned()),
            color: Color::WHITE,
            hue_offset_deg: 0.0.into(),
            uv_repeat: [4.0, 4.0],
        }
    }
}

/// Clutter that hides people.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Occluders {
    /// Where false, there are none.
    pub enabled: bool,
    /// Where they stand: the middle of their base, about which they are turned.
    pub placement: Placement,
    /// Times the base size of the shape: 0.127 m (5 inches), for spheres 0.1524 m (6 inches).
    pub scale: Param,
    /// Orientation.
    pub rotation_deg: Rotation,
    /// Form.
    pub shape: Choice<Shape>,
    /// Texture id; `"any"` for one of all, `"none"` for plain.
    pub texture: Choice<String>,
    /// Multiplies the texture.
    pub color: Color,
    /// Rotation of the hue.
    pub hue_offset_deg: Param,
    /// Repeats of the texture.
    pub uv_repeat: [f64; 2],
}

impl Default for Occluders {
    fn default() -> Self {
        let turn = || Param::uniform(0.0, 360.0);
        Self {
            enabled: true,
            placement: Placement::PoissonDisk(PoissonDisk {
                x_m: seed_side(),
                y_m: seed_side(),
                depth_m: Param::uniform(-10.0, 14.0),
                separation_m: 2.5,
                count: None,
                no_overlap: false,
                in_view: 0.0,
            }),
            scale: Param::uniform(1.0, 12.0),
            rotation_deg: Rotation::Euler([turn(), turn(), turn()]),
            // Ten primitives: four cubes, four cylinders and two spheres.
            shape: Choice::of([(Shape::Cube, 4.0), (Shape::Cylinder, 4.0), (Shape::Sphere, 2.0)]),
            texture: Choice::Always("any".to_owned()),
            color: Color::WHITE,
            hue_offset_deg: Param::uniform(-180.0, 180.0),
            uv_repeat: [1.0, 1.0],
        }
    }
}
