//! Scene -> [`DrawList`]: everything in view space and single precision, ready for an engine.
//!
//! Here a scene meets its geometry: persons are shaped, dressed and posed, levels of detail are
//! chosen by their projected error, and what neither shows nor casts a visible shadow is left out.
//! Differences to the camera are taken in `f64` before anything is narrowed to `f32`. Pixels and
//! labels are decided elsewhere.
//!
//! | file | what it does |
//! |---|---|
//! | [`abi`] | the structs both engines read |
//! | `blockers` | bodies as spheres, for ambient occlusion |
//! | `cast` | the people of earlier frames |
//! | `focus` | whether anything is out of focus, and by how much |
//! | [`frustum`] | what the camera may see, and whose shadow it may see |
//! | `lights` | lights in view space |
//! | `motion` | what moves while the shutter is open, and where to |
//! | `objects` | walls, floors, occluders |
//! | `people` | persons: shape, pose, level of detail, keypoints |
//! | `surfaces` | materials and the textures they name |

pub mod abi;
mod blockers;
mod cast;
mod focus;
pub mod frustum;
mod grade;
mod lights;
mod motion;
mod objects;
mod people;
mod surfaces;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3};

pub use abi::DrawList;
pub use cast::Cast;

use crate::base::lens::{LensError, LensGrid};
use crate::base::space::exposure_from_ev100;
use crate::library::Library;
use crate::library::clip::ClipError;
use crate::library::figure::FigureError;
use crate::library::pose::PoseError;
use crate::library::textures::TextureError;
use crate::scene::{Camera, Scene};
use frustum::{Frustum, Sphere, reach_along};

/// A draw list, and what in it belongs to whom.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    /// What the engine draws.
    pub list: DrawList,
    /// For each of the scene's objects its index in the draw list, if it is drawn.
    pub objects: Vec<Option<u32>>,
    /// The scene's people, in order.
    pub people: Vec<DrawnPerson>,
}

/// What is known of a person once shaped and posed, whether drawn or not.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPerson {
    /// Index in the scene's people.
    pub person: usize,
    /// Id in instance maps: the person's slot plus one.
    pub instance: u16,
    /// Index in the draw list's objects, if drawn.
    pub object: Option<u32>,
    /// Index in the draw list's objects of what the person sits on, if drawn.
    pub seat: Option<u32>,
    /// Posed COCO-17 keypoints, metres, view space.
    pub keypoints_in_view: [DVec3; 17],
    /// How far in front of each keypoint the surface of its own limb may lie, metres.
    pub keypoint_tolerance_m: [f64; 17],
    /// Body mass at scale 1, kilograms.
    pub mass_kg: f64,
}

/// What the frame is drawn for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawOptions {
    /// Somebody wants pixels or labels that come from pixels; otherwise only keypoints are posed.
    pub raster: bool,
    /// Materials, lights and casters of shadows are wanted.
    pub shading: bool,
    /// Samples a pixel: 1, 4 or 16.
    pub samples: u32,
    /// Largest side of the sun's shadow map, texels.
    pub shadow_map_size: u32,
    /// Largest error of a level of detail, pixels.
    pub lod_error_px: f64,
}

/// A scene that cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum DrawError {
    /// The camera's lens makes no picture of this size.
    #[error(transparent)]
    Lens(#[from] LensError),
    /// A texture that the scene names cannot be had.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// The scene's sky gives no light.
    #[error("the computed sky of lights.environment.image is black; give it another turbidity")]
    BlackSky,
    /// The scene names a face target that the figure has not.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// The scene names a clip that the library does not hold.
    #[error(transparent)]
    Clip(#[from] ClipError),
    /// The scene names a pose that the library does not hold.
    #[error(transparent)]
    Pose(#[from] PoseError),
}

/// Draws a scene. What `cast` holds is reused; the result does not depend on it.
///
/// # Errors
/// When the scene names an asset that the library does not hold or cannot read.
pub fn draw(
    scene: &Scene,
    library: &Library,
    cast: &Cast,
    options: &DrawOptions,
) -> Result<Drawn, DrawError> {
    let mut drawing = Drawing::new(scene, library, cast, *options)?;
    if options.shading {
        drawing.drawn.list.lights = lights::in_view(scene, library, &drawing.view_from_world)?;
    }
    if options.raster {
        objects::add(&mut drawing)?;
    }
    people::add(&mut drawing)?;
    drawing.drawn.list.defocus = focus::defocus(&scene.camera, drawing.nearest_m);
    drawing.drawn.list.shutter = drawing.motion.as_ref().and_then(motion::Motion::shutter);
    Ok(drawing.drawn)
}

/// A draw list in the making.
struct Drawing<'a> {
    scene: &'a Scene,
    library: &'a Library,
    cast: &'a Cast,
    options: DrawOptions,
    view_from_world: DAffine3,
    frustum: Frustum,
    /// Focal length where the lens enlarges most, pixels.
    finest_focal_px: f64,
    /// View space, towards the sun, when its shadows are wanted.
    shadow_direction: Option<DVec3>,
    surfaces: surfaces::Surfaces,
    /// No nearer does anything come that may be seen, along the view axis.
    nearest_m: f64,
    /// When the shutter is open for a while.
    motion: Option<motion::Motion>,
    drawn: Drawn,
}

impl<'a> Drawing<'a> {
    fn new(
        scene: &'a Scene,
        library: &'a Library,
        cast: &'a Cast,
        options: DrawOptions,
    ) -> Result<Self, LensError> {
        let lens = lens(&scene.camera)?;
        let view_from_world = view_from_world(&scene.camera);
        let sun = scene.lights.sun.as_ref().filter(|s| s.shadow && options.shading);
        let list = DrawList {
            view: view(&scene.camera, &view_from_world),
            exposure: exposure_from_ev100(scene.exposure_ev100) as f32,
            grade: grade::grade(&scene.post),
            shadow_map_size: options.shadow_map_size,
            samples: options.samples,
            lens: lens.clone(),
            ..DrawList::default()
        };
        Ok(Self {
            scene,
            library,
            cast,
            options,
            view_from_world,
            frustum: Frustum::new(&scene.camera, lens.as_deref()),
            finest_focal_px: scene.camera.focal_px() * lens.map_or(1.0, |l| l.magnification()),
            shadow_direction: sun.map(|s| view_from_world.transform_vector3(s.direction_to_sun)),
            surfaces: surfaces::Surfaces::default(),
            nearest_m: f64::INFINITY,
            motion: motion::Motion::new(&scene.camera).filter(|_| options.shading),
            drawn: Drawn { list, ..Drawn::default() },
        })
    }

    /// Pixels that a metre spans at most, at the nearest point of a hull of spheres.
    fn px_per_m(&self, hull: &[Sphere]) -> f64 {
        // The distance along the axis decides; off the axis it is more than the near side suggests.
        self.finest_focal_px / self.near_side_m(hull)
    }

    /// How near a hull of spheres comes, along the view axis; no nearer than the near plane.
    fn near_side_m(&self, hull: &[Sphere]) -> f64 {
        (-reach_along(DVec3::Z, hull)).max(self.scene.camera.near_m)
    }

    /// Takes note of how near comes what is drawn.
    fn note_near_side(&mut self, hull: &[Sphere], relevance: Relevance) {
        if relevance.in_view {
            self.nearest_m = self.nearest_m.min(self.near_side_m(hull));
        }
    }

    /// Takes note of how far what is drawn moves until the shutter closes.
    fn note_motion(
        &mut self,
        hull: &[Sphere],
        relevance: Relevance,
        ways: impl Iterator<Item = (DVec3, DVec3)>,
    ) {
        let px_per_m = self.px_per_m(hull);
        if let Some(motion) = self.motion.as_mut().filter(|_| relevance.in_view) {
            motion.note(ways, px_per_m);
        }
    }

    /// Whether what lies in a hull of spheres may be seen, and whether its shadow may be.
    fn relevance(&self, hull: &[Sphere]) -> Relevance {
        Relevance {
            in_view: self.frustum.sees(hull),
            casts_shadow: self.shadow_direction.is_some_and(|d| self.frustum.sees_shadow(hull, d)),
        }
    }
}

/// What something contributes to a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Relevance {
    in_view: bool,
    casts_shadow: bool,
}

impl Relevance {
    const fn any(self) -> bool {
        self.in_view || self.casts_shadow
    }
}

fn view_from_world(camera: &Camera) -> DAffine3 {
    let rotation = DMat3::from_quat(camera.rotation.inverse());
    DAffine3::from_mat3_translation(rotation, -(rotation * camera.position_m))
}

/// The way back through a camera's lens.
fn lens(camera: &Camera) -> Result<Option<Arc<LensGrid>>, LensError> {
    let Some(lens) = camera.distortion else { return Ok(None) };
    let focal_px = DVec2::splat(camera.focal_px());
    let size_px = [camera.width, camera.height];
    Ok(Some(Arc::new(LensGrid::new(lens, focal_px, camera.center_px(), size_px)?)))
}

fn view(camera: &Camera, view_from_world: &DAffine3) -> abi::View {
    let (focal, center) = (camera.focal_px() as f32, camera.center_px());
    abi::View {
        width: camera.width,
        height: camera.height,
        fx: focal,
        fy: focal,
        cx: center.x as f32,
        cy: center.y as f32,
        near_m: camera.near_m as f32,
        pad: 0,
        view_from_world: rows(view_from_world),
    }
}

/// An affine map as three rows of four, narrowed to `f32`.
#[must_use]
pub fn rows(b_from_a: &DAffine3) -> [[f32; 4]; 3] {
    let m = b_from_a.matrix3;
    let t = b_from_a.translation.to_array();
    std::array::from_fn(|r| {
        let row = m.row(r);
        [row.x as f32, row.y as f32, row.z as f32, t[r] as f32]
    })
}

#[cfg(test)]
pub(crate) fn empty_object() -> abi::DrawObject {
    abi::DrawObject {
        mesh: Arc::default(),
        view_from_model: rows(&DAffine3::IDENTITY),
        palette: 0..0,
        end: None,
        in_view: true,
        casts_shadow: false,
        smooth: true,
        blockers: 0..0,
    }
}
