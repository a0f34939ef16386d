//! The structs that the host writes and the shaders read: `shaders/shared/abi.wgsl` in Rust.
//!
//! A test reads the shaders and compares every size and offset.

use bytemuck::{Pod, Zeroable};

/// What is the same for all stages of a frame.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Frame {
    pub size: [u32; 2],
    pub light_count: u32,
    pub zero: u32,
    pub focal: [f32; 2],
    pub center: [f32; 2],
    pub near_m: f32,
    pub shadow_map_size: u32,
    pub has_sun: u32,
    pub has_shadow: u32,
    pub up: [f32; 3],
    pub object_count: u32,
    pub sky: [f32; 3],
    pub shot_noise: f32,
    pub ground: [f32; 3],
    pub read_variance: f32,
    pub background: [f32; 3],
    pub grain_key: u32,
    pub to_sun: [f32; 3],
    pub pad3: u32,
    pub sun_color: [f32; 3],
    pub pad4: u32,
    pub sun_axes: [[f32; 4]; 3],
    pub grade_before: [[f32; 4]; 3],
    pub grade_after: [[f32; 4]; 3],
    pub vignette: f32,
    pub contrast: f32,
    pub grain: f32,
    pub tone_curve: u32,
    pub has_environment: u32,
    pub environment_unit: f32,
    pub blocker_count: u32,
    pub sensor_key: u32,
    pub focus_m: f32,
    pub blur_px: f32,
    pub blur_limit_px: f32,
    pub blur_halvings: u32,
    pub bloom_share: f32,
    pub bloom_spread: f32,
    pub longest_px: f32,
    pub way_tile: u32,
    pub end_from_view: [[f32; 4]; 3],
    pub environment_from_view: [[f32; 4]; 3],
    pub environment_levels: [[u32; 4]; 3],
    pub environment_irradiance: [[f32; 4]; 10],
}

/// A picture that is rastered: a band of the camera's, or the sun's map.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Target {
    pub rows: [[f32; 4]; 8],
    pub near_w: f32,
    pub width: u32,
    pub height: u32,
    pub batch_count: u32,
    pub tiles: [u32; 2],
    pub first_y: u32,
    pub band_height: u32,
    pub first_row: i32,
    pub row_step_log2: u32,
    pub vertex_batch_count: u32,
    pub pad0: u32,
}

/// Up to 256 vertices of one object.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct VertexBatch {
    pub object: u32,
    pub source: u32,
    pub count: u32,
    pub first: u32,
    pub palette: u32,
    pub rigid: u32,
    pub in_view: u32,
    pub casts: u32,
    pub end: u32,
}

/// Up to 64 triangles of one draw.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct TriangleBatch {
    pub draw: u32,
    pub object: u32,
    pub source: u32,
    pub count: u32,
    pub vertices: u32,
    pub order: u32,
    pub mirrored: u32,
    pub double_sided: u32,
    pub cutout: u32,
}

/// A placed vertex.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    pub position: [f32; 3],
    pub normal: u32,
    pub uv: [f32; 2],
    pub way: [u32; 2],
}

/// A projected vertex.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct ScreenVertex {
    pub x: i32,
    pub y: i32,
    pub depth: f32,
    pub pad: u32,
}

/// A triangle that may cover samples.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Primitive {
    pub x: [i32; 3],
    pub inverse_area: f32,
    pub y: [i32; 3],
    pub order: u32,
    pub depth: [f32; 3],
    pub flags: u32,
    pub corners: [u32; 3],
    pub draw: u32,
}

/// What a set-up counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Counters {
    pub primitives: u32,
    pub large: u32,
    pub entries: u32,
    pub bad_object: u32,
    pub crossing: u32,
    pub pad0: u32,
    pub pad1: u32,
    pub pad2: u32,
}

/// Where a list of a tile stands.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Tile {
    pub count: u32,
    pub end: u32,
}

/// A box along the sun's axes.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Bounds {
    pub low: [u32; 3],
    pub high: [u32; 3],
    pub nearest: u32,
    pub reaches: u32,
}

/// How points are found in the sun's map.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct SunView {
    pub rows: [[f32; 4]; 3],
    pub size: [u32; 2],
    pub texel_m: f32,
    pub depth_per_m: f32,
    pub present: u32,
    pub pad0: u32,
    pub pad1: u32,
    pub pad2: u32,
}

/// A draw's material.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Surface {
    pub uv_repeat: [f32; 2],
    pub detail_strength: f32,
    pub normal_strength: f32,
    pub base: [u32; 2],
    pub metallic_wrap: u32,
    pub hue_turn: f32,
    pub map_first: [u32; 4],
    pub map_info: u32,
    pub flags: u32,
    pub own_blockers: [u32; 2],
    pub finish_first: u32,
    pub finish_info: u32,
    pub pad: [u32; 2],
    pub layers: [[u32; 2]; 4],
}

/// A sphere in the way of surrounding light.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Blocker {
    pub center: [f32; 3],
    pub radius_m: f32,
}

/// A point light, scaled by the exposure.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Light {
    pub position: [f32; 3],
    pub per_range_m2: f32,
    pub color_cd: [f32; 3],
    pub per_radius_m: f32,
}

/// Two levels of scattered light.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Step {
    pub larger_first: u32,
    pub smaller_first: u32,
    pub larger_size: [u32; 2],
    pub smaller_size: [u32; 2],
    pub pad0: u32,
    pub pad1: u32,
}

/// Count and extent of an object's samples.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct ObjectSums {
    pub count: u32,
    pub low: [u32; 2],
    pub high: [u32; 2],
}

/// A place in a list that does not exist.
pub const NOTHING: u32 = u32::MAX;

/// [`Step::larger_first`] of the light of pixels.
pub const LIGHT_OF_PIXELS: u32 = u32::MAX;
/// Side of the squares of texels that know their widest disk.
pub const SQUARE: u32 = 16;
/// Words of a texel of the layers of depth of field.
pub const LAYER_WORDS: u32 = 5;
/// Words of a vertex in the mesh pool.
pub const VERTEX_WORDS: u32 = 8;
/// Vertices of a [`VertexBatch`].
pub const VERTEX_BATCH: u32 = 256;
/// Triangles of a [`TriangleBatch`].
pub const TRIANGLE_BATCH: u32 = 64;
/// Workgroups along x of a stage with one for each batch.
pub const BATCHES_ACROSS: u32 = 32_768;
/// [`Primitive::flags`]: where the cutout begins.
pub const CUTOUT_SHIFT: u32 = 2;
/// Side of a tile in pixels.
pub const TILE: u32 = 8;
/// Point lights that there is room for.
pub const MAX_LAMPS: u32 = 512;
/// Entries in front of the tiles' lists.
pub const LARGE_ROOM: u32 = 4096;
/// [`Surface::flags`].
pub const DOUBLE_SIDED: u32 = 1;
/// See [`DOUBLE_SIDED`].
pub const MIRRORED: u32 = 2;
/// See [`DOUBLE_SIDED`].
pub const SMOOTH: u32 = 4;
/// [`Surface::map_info`].
pub const MAP_COLOR: u32 = 32;
/// See [`MAP_COLOR`].
pub const MAP_PRESENT: u32 = 64;
