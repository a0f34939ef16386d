//! One frame with every number settled: plain values that serialise, and nothing else.
//!
//! Made by `sampling`, read by `draw` and `label`, written beside each picture. A scene is enough
//! to render its frame again; it names assets, it does not hold them. No function that decides
//! anything belongs here.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

mod camera;
mod outfit;
mod person;
mod post;

pub use camera::{Camera, DepthOfField, MotionBlur};
pub use outfit::{Bottom, BottomKind, Outer, OuterKind, Outfit, ShoeKind, Shoes, Top, TopKind};
pub use person::{
    BeardStyle, Body, Glasses, HairStyle, HandShape, Headwear, HeadwearKind, Look, Person, Pose,
    PoseBlend, Seat, Sex,
};
pub use post::{Post, ToneCurve};

/// Everything that one frame shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Frame number; with the seed it is the key of every sampled value.
    pub frame: u32,
    /// The document's seed.
    pub seed: u64,
    /// The camera, with the picture's size.
    pub camera: Camera,
    /// Sun, point lights and surroundings.
    pub lights: Lights,
    /// Exposure value at ISO 100.
    pub exposure_ev100: f64,
    /// What else happens to the light behind the lens.
    pub post: Post,
    /// Walls, floors and occluders.
    pub objects: Vec<Object>,
    /// People.
    pub people: Vec<Person>,
    /// Quality of the picture's JPEG, 1..100, where it is drawn anew for each frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jpeg_quality: Option<u8>,
}

/// Where something stands: `world_from_model = translate(position) * rotate * scale`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Placement {
    /// Metres, world.
    pub position_m: DVec3,
    /// World from model, a unit quaternion (x, y, z, w).
    pub rotation: DQuat,
    /// Factor per model axis.
    pub scale: DVec3,
}

/// The light in a scene, in photometric units and linear colours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lights {
    /// The sun, when it is on.
    pub sun: Option<Sun>,
    /// Point lights that are on.
    pub points: Vec<PointLight>,
    /// Light from all around.
    pub environment: Environment,
}

/// A light at infinity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sun {
    /// Unit vector from the scene towards the sun, world.
    pub direction_to_sun: DVec3,
    /// On a surface facing it.
    pub illuminance_lux: f64,
    /// Linear, multiplies the illuminance per channel.
    pub color: [f64; 3],
    /// Whether it casts shadows.
    pub shadow: bool,
}

/// A light at a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointLight {
    /// Metres, world.
    pub position_m: DVec3,
    /// Luminous intensity, the same in all directions.
    pub intensity_cd: f64,
    /// Linear, multiplies the intensity per channel.
    pub color: [f64; 3],
    /// Distance at which its light reaches zero: `E = I / d^2 * clamp(1 - (d / range)^4)^2`.
    pub range_m: f64,
    /// Radius of the lamp; distances are not taken below it.
    pub radius_m: f64,
}

/// Light from all around: the irradiance of a surface facing up and of one facing down, blended
/// by the normal's y (a hemisphere light).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Environment {
    /// Linear colour times lux on a surface that faces the sky.
    pub sky_lux: [f64; 3],
    /// Linear colour times lux on a surface that faces the ground.
    pub ground_lux: [f64; 3],
    /// Linear luminance in nits of the background where nothing stands.
    pub background_nits: [f64; 3],
    /// Whether bodies keep this light off what is near them.
    #[serde(default)]
    pub ambient_occlusion: bool,
    /// Stands in for all of these.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<EnvironmentImage>,
}

/// Light from all around as a picture of all directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnvironmentImage {
    /// What it shows.
    pub source: EnvironmentSource,
    /// About the vertical, counter-clockwise seen from above. At 0 the middle of a picture lies
    /// along -Z. A computed sky goes by its sun and is not turned.
    pub rotation_deg: f64,
    /// Illuminance of a surface, mean over all directions that it may face.
    pub illuminance_lux: f64,
}

/// Where a picture of all directions comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EnvironmentSource {
    /// The library, by id.
    Picture(String),
    /// Computed.
    Sky(Sky),
}

/// Clear air, and clouds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sky {
    /// Unit vector, world.
    pub direction_to_sun: DVec3,
    /// 1.7 very clear .. 10 hazy.
    pub turbidity: f64,
    /// Share of the sky that clouds hide, 0..1.
    pub cloud_cover: f64,
    /// Where in the field of clouds the zenith is, both 0..1.
    pub cloud_place: [f64; 2],
    /// Linear colour of the ground below the horizon.
    pub ground_color: [f64; 3],
}

/// Something that is not a person.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Object {
    /// What it is for.
    pub role: Role,
    /// Its form, in a model space of unit size.
    pub shape: Shape,
    /// Where it stands.
    pub placement: Placement,
    /// What it is made of.
    pub material: Material,
}

/// What an object is for; also its semantic class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// The wall behind everything.
    Wall,
    /// The ground.
    Floor,
    /// Clutter that hides people.
    Occluder,
}

/// A primitive, inscribed in the unit cube centred on the model's origin.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Unit cube.
    Cube,
    /// Diameter 1, height 1, along y.
    Cylinder,
    /// Diameter 1.
    Sphere,
    /// Diameter 0.5, height 1 with its caps, along y.
    Capsule,
    /// Base diameter 1, height 1, tip towards +y.
    Cone,
    /// Outer diameter 1, tube diameter 0.3, axis y.
    Torus,
}

/// Surface of an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Texture id in the library; plain where absent.
    pub texture: Option<String>,
    /// Linear colour that multiplies the texture.
    pub base_color: [f64; 3],
    /// Rotation of the hue of texture times base colour.
    pub hue_offset_deg: f64,
    /// Repeats of the texture over the shape's 0..1 coordinates.
    pub uv_repeat: [f64; 2],
    /// Perceptual roughness, 0.04..1.
    pub roughness: f64,
    /// 0 dielectric .. 1 metal.
    pub metallic: f64,
    /// Strength of the texture's own normal map, 0 for none.
    pub normal_strength: f64,
}

impl Shape {
    /// Whether all its faces meet without hard edges.
    #[must_use]
    pub const fn is_smooth(self) -> bool {
        matches!(self, Self::Sphere | Self::Capsule | Self::Torus)
    }
}
