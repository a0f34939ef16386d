//! What both engines read. Plain structs in view space ([`crate::base::space`]), `f32`.

use std::ops::Range;
use std::sync::Arc;

use crate::base::lens::LensGrid;
use crate::library::environment::EnvironmentMap;
use crate::library::mesh::{Cutout, Mesh};
use crate::library::texture::Texture;

/// From the sensor's light to that of the display, as the scene names it.
pub use crate::scene::ToneCurve;

/// One frame, ready to be drawn.
#[derive(Clone, Debug, Default)]
pub struct DrawList {
    /// Picture size and projection.
    pub view: View,
    /// What is drawn, at most 65,534.
    pub objects: Vec<DrawObject>,
    /// Parts of objects: ranges of triangles with one material.
    pub draws: Vec<Draw>,
    /// Surfaces.
    pub materials: Vec<Material>,
    /// Textures that the materials name by index.
    pub textures: Vec<Arc<Texture>>,
    /// `view_from_model` of every joint of every skinned object, and once more where it moves: three
    /// rows of four.
    pub palette: Vec<[[f32; 4]; 3]>,
    /// Spheres that keep surrounding light off what is near them, at most [`MAX_BLOCKERS`].
    pub blockers: Vec<Blocker>,
    /// Light in view space.
    pub lights: Lights,
    /// Linear scale from nits to the sensor's 0..1.
    pub exposure: f32,
    /// How what is not in focus blurs, where anything is.
    pub defocus: Option<Defocus>,
    /// What moves while the shutter is open, where anything does.
    pub shutter: Option<Shutter>,
    /// What else happens to the light behind the lens.
    pub grade: Grade,
    /// Largest side of the sun's shadow map in texels, a multiple of 64.
    pub shadow_map_size: u32,
    /// Samples per pixel: 1, 4 or 16.
    pub samples: u32,
    /// The lens before the pinhole that `view` is: pixels show what the way back through it leads to.
    pub lens: Option<Arc<LensGrid>>,
}

/// Picture size and projection: `x = cx + fx * X / -Z`, `y = cy - fy * Y / -Z`, depth `near / -Z`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct View {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// Focal length, pixels.
    pub fx: f32,
    /// Focal length, pixels.
    pub fy: f32,
    /// Principal point, pixels.
    pub cx: f32,
    /// Principal point, pixels.
    pub cy: f32,
    /// Metres.
    pub near_m: f32,
    /// Keeps the size a multiple of 16 bytes.
    pub pad: u32,
    /// Rows of the rotation view from world, for what is defined in world axes.
    pub view_from_world: [[f32; 4]; 3],
}

/// A mesh that stands somewhere.
#[derive(Clone, Debug)]
pub struct DrawObject {
    /// Its geometry.
    pub mesh: Arc<Mesh>,
    /// View from model: three rows of four. Unused for skinned meshes.
    pub view_from_model: [[f32; 4]; 3],
    /// Where its joints stand in the palette; empty for rigid meshes.
    pub palette: Range<u32>,
    /// How it stands when the shutter closes, where that is otherwise.
    pub end: Option<End>,
    /// Whether the camera may see it; what it may not see only casts shadows.
    pub in_view: bool,
    /// Whether it casts shadows.
    pub casts_shadow: bool,
    /// Shading may be done once a pixel for the whole object where its triangles meet smoothly.
    pub smooth: bool,
    /// Those of [`DrawList::blockers`] that are its own.
    pub blockers: Range<u32>,
}

/// How an object stands when the shutter closes, in the view space of that time.
#[derive(Clone, Debug, PartialEq)]
pub struct End {
    /// As [`DrawObject::view_from_model`].
    pub view_from_model: [[f32; 4]; 3],
    /// As [`DrawObject::palette`], and as long.
    pub palette: Range<u32>,
}

/// Triangles of one object with one material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Draw {
    /// Index in [`DrawList::objects`].
    pub object: u32,
    /// Range of its mesh's triangles.
    pub triangles: Range<u32>,
    /// Index in [`DrawList::materials`].
    pub material: u32,
    /// Back faces are drawn too, their normals turned round.
    pub double_sided: bool,
    /// Which part of the triangles there is, where that is not all; shadows are those of all.
    pub cutout: Option<Cutout>,
}

/// A metallic-roughness surface with up to four masked layers.
///
/// `albedo = hue_rotate(base_color * albedo_map)`, then for each channel k of the mask, in order,
/// `albedo = mix(albedo, layers[k].rgb, mask[k])` and the same for roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Linear.
    pub base_color: [f32; 3],
    /// Colour texture, multiplies the base colour.
    pub albedo_map: Option<u32>,
    /// Linear texture, its red channel multiplies the albedo by `1 + detail_strength * (2 r - 1)`.
    pub detail_map: Option<u32>,
    /// See `detail_map`.
    pub detail_strength: f32,
    /// Repeats of the albedo, detail, normal and finish maps over 0..1; the mask is not repeated.
    pub uv_repeat: [f32; 2],
    /// Rotation of the hue in HSV; 0 for none.
    pub hue_offset_deg: f32,
    /// Perceptual roughness, 0.04..1.
    pub roughness: f32,
    /// 0..1.
    pub metallic: f32,
    /// Linear texture of tangent-space normals: x along growing u, y against v (up the picture),
    /// z off the surface.
    pub normal_map: Option<u32>,
    /// Factor on the normal map's x and y.
    pub normal_strength: f32,
    /// Linear texture of cloth: red is the share of the hue's rotation that is done, green moves the
    /// roughness towards [`Material::GLOSSY`].
    pub finish_map: Option<u32>,
    /// Linear texture of four masks.
    pub mask: Option<u32>,
    /// Linear colour and roughness of each masked layer.
    pub layers: [[f32; 4]; 4],
    /// Light that goes round the terminator, for skin: 0 none .. 0.5.
    pub wrap: f32,
}

impl Material {
    /// Roughness of cloth of full gloss.
    pub const GLOSSY: f32 = 0.25;
}

impl Default for Material {
    fn default() -> Self {
        Self {
            base_color: [0.5; 3],
            albedo_map: None,
            detail_map: None,
            detail_strength: 0.0,
            uv_repeat: [1.0; 2],
            hue_offset_deg: 0.0,
            roughness: 0.7,
            metallic: 0.0,
            normal_map: None,
            normal_strength: 1.0,
            finish_map: None,
            mask: None,
            layers: [[0.0; 4]; 4],
            wrap: 0.0,
        }
    }
}

/// Light in view space, in photometric units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lights {
    /// The sun, when it is on.
    pub sun: Option<Sun>,
    /// Point lights that are on.
    pub points: Vec<PointLight>,
    /// Irradiance of a surface that faces the sky (world +Y), lux per channel.
    pub sky_lux: [f32; 3],
    /// Irradiance of a surface that faces the ground, lux per channel.
    pub ground_lux: [f32; 3],
    /// Luminance where nothing stands, nits per channel.
    pub background_nits: [f32; 3],
    /// Stands in for sky, ground and background.
    pub surroundings: Option<Surroundings>,
}

/// Light from all directions, as a picture of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Surroundings {
    /// The picture, in its own axes.
    pub map: Arc<EnvironmentMap>,
    /// Rows of a rotation.
    pub map_from_view: [[f32; 3]; 3],
    /// Luminance of the map's 1.
    pub nits_per_unit: f32,
    /// Irradiance of a surface as a polynomial of its unit normal (x, y, z) in view space: factors,
    /// lux per channel, of 1, x, y, z, xx, yy, zz, xy, yz, zx.
    pub irradiance_lux: [[f32; 3]; 10],
}

/// A light at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Unit vector towards it, view space.
    pub direction_to_sun: [f32; 3],
    /// Illuminance per channel of a surface facing it.
    pub color_lux: [f32; 3],
    /// Whether it casts shadows.
    pub shadow: bool,
}

/// A light at a point: `E = I / max(d, radius)^2 * clamp(1 - (d / range)^4, 0, 1)^2`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct PointLight {
    /// View space, metres.
    pub position: [f32; 3],
    /// Metres.
    pub range_m: f32,
    /// Candela per channel.
    pub color_cd: [f32; 3],
    /// Metres.
    pub radius_m: f32,
}

/// Spheres that there is room for.
pub const MAX_BLOCKERS: usize = 3072;

/// A sphere that keeps surrounding light off what is near it, view space.
///
/// Where a sphere of radius r at distance d lies wholly above a surface, it takes the share
/// `max(n.w, 0) (r / d)^2` of the light that the surface gets from a uniform sky, n being the unit normal
/// and w the unit vector to the sphere (the form factor of a sphere; Quilez, "Sphere ambient
/// occlusion", 2006). So every sphere multiplies that light by
///
/// ```text
/// 1 - max(n.w - b, 0) / (1 - b) min((r / d)^2, 1) max(1 - (d / (4 r))^4, 0)^2
/// ```
///
/// with b = 0, and for the spheres of the surface's own object b = 0.25, which leaves out those that
/// it merely bulges over. The last factor ends their reach at four radii.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Blocker {
    /// Metres.
    pub center: [f32; 3],
    /// Metres.
    pub radius_m: f32,
}

impl Blocker {
    /// How far its effect goes, radii.
    pub const REACH: f32 = 4.0;
    /// See above: of an object's own spheres.
    pub const OWN_BIAS: f32 = 0.25;
}

/// Light out of focus: what lies at a distance z along the view axis becomes a disk whose radius is
/// that of infinity times `|1 - focus / z|`, within limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defocus {
    /// Metres along the view axis to what is sharp.
    pub focus_m: f32,
    /// Radius at infinity, pixels.
    pub at_infinity_px: f32,
    /// Largest radius of all that is seen, pixels.
    pub largest_px: f32,
}

impl Defocus {
    /// A disk of this radius is a pixel, and all smaller ones are.
    pub const SHARP_PX: f64 = 0.5;
    /// What lies before the focus is blurred no more than this times what lies at infinity.
    pub const NEAR_LIMIT: f64 = 2.0;
}

/// What moves while the shutter is open, evenly and on straight lines: from as far before the frame's
/// time as it goes until the shutter closes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shutter {
    /// Rows of the rotation from view space to that of the time when it closes.
    pub end_from_view: [[f32; 3]; 3],
    /// Longest way until it closes, pixels; longer ones are cut.
    pub longest_px: f32,
}

impl Shutter {
    /// Where nothing goes farther until the shutter closes, nothing moves.
    pub const STILL_PX: f64 = 0.5;
}

/// Light that a lens scatters: `light + share (scattered - light)`.
///
/// What is scattered is a pyramid of pictures, each half as large as the one before and smoothed by
/// the binomial 1 3 3 1 along both axes, that is built up again from the smallest with
/// `level + spread (larger - level)`, the larger one drawn out with 1 3 3 1 again (Jimenez, "Next
/// generation post processing in Call of Duty", SIGGRAPH 2014). All weights sum to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bloom {
    /// Share of the light that is scattered, 0..1.
    pub share: f32,
    /// Share that each level hands on to the next larger one, 0..1.
    pub spread: f32,
}

/// From exposed light to the picture: bloom, vignette, the sensor's noise, colour, tone curve, and grain on
/// what is encoded.
///
/// Noise is that of photons and of reading them out (Foi, Trimeche, Katkovnik and Egiazarian,
/// "Practical Poissonian-Gaussian noise modeling and fitting for single-image raw-data", IEEE
/// Transactions on Image Processing 17, 2008): light v of a channel of a pixel becomes `v + sqrt(shot v +
/// read^2) z`, with z of mean 0 and standard deviation 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grade {
    /// Light that the lens scatters, where it scatters any.
    pub bloom: Option<Bloom>,
    /// 0 none .. 1: `1 - d.d` of the light is left at `d = min(3 vignette |xy / size - 1/2|, 1)`.
    pub vignette: f32,
    /// Variance of the sensor's noise per unit of light.
    pub shot_noise: f32,
    /// Standard deviation of the sensor's noise in the dark.
    pub read_noise: f32,
    /// White balance, contrast and saturation.
    pub color: Option<ColorGrade>,
    /// To linear display light.
    pub tone_curve: ToneCurve,
    /// Standard deviation of monochrome noise in sRGB 0..1.
    pub grain: f32,
    /// Key of all noise.
    pub grain_key: u32,
}

/// `after (before v)^contrast`, component by component, with negative ones cut before the power.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorGrade {
    /// Rows of a matrix; all of the grade where the contrast is 1.
    pub before: [[f32; 3]; 3],
    /// Exponent; 1 for none.
    pub contrast: f32,
    /// Rows of a matrix.
    pub after: [[f32; 3]; 3],
}
