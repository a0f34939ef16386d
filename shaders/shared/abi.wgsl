// What the host and the stages share. Mirrored in core/src/engine/gpu/abi.rs; a test compares
// every size and offset.
//
// Spaces: view space looks down -Z, metres. Picture: pixels from the top-left corner. Raster:
// 1/1024 pixel. Screen: 1/65536 pixel. Depth is reversed, larger is nearer.

// What is the same for all stages of a frame.
struct Frame {
    // Pixels.
    size: vec2<u32>,
    light_count: u32,
    // Always 0, which no compiler knows; see double.wgsl.
    zero: u32,
    // Focal lengths, then the principal point, pixels.
    focal: vec2<f32>,
    center: vec2<f32>,
    near_m: f32,
    // Largest side of the sun's map, texels.
    shadow_map_size: u32,
    has_sun: u32,
    has_shadow: u32,
    // World +Y in view space.
    up: vec3<f32>,
    object_count: u32,
    // Light, all of it times the exposure.
    sky: vec3<f32>,
    // Variance of the sensor's noise per unit of light, and that in the dark.
    shot_noise: f32,
    ground: vec3<f32>,
    read_variance: f32,
    // Exposed light where nothing stands.
    background: vec3<f32>,
    // Key of the grain, mixed.
    grain_key: u32,
    to_sun: vec3<f32>,
    pad3: u32,
    sun_color: vec3<f32>,
    pad4: u32,
    // Right, up and towards the sun, for the fit of its map.
    sun_axes: array<vec4<f32>, 3>,
    // Rows of the matrices before and after the contrast curve.
    grade_before: array<vec4<f32>, 3>,
    grade_after: array<vec4<f32>, 3>,
    // Three times the vignette; 0 for none.
    vignette: f32,
    // Exponent; 1 for none, 0 and less where nothing is graded.
    contrast: f32,
    // Standard deviation of the grain in sRGB 0..1, over that of a sum of four bytes.
    grain: f32,
    // 0 ACES, 1 AgX, 2 none.
    tone_curve: u32,
    // A picture of the surroundings: whether there is one, exposed light of its 1.
    has_environment: u32,
    environment_unit: f32,
    // Spheres in the way of surrounding light.
    blocker_count: u32,
    // Key of the sensor's noise, mixed.
    sensor_key: u32,
    // Depth of field: metres to what is sharp, radius at infinity and the largest, pixels, and how often
    // the picture is halved for it.
    focus_m: f32,
    blur_px: f32,
    blur_limit_px: f32,
    blur_halvings: u32,
    // Share of the light that is scattered, 0 for none, and what each level hands on.
    bloom_share: f32,
    bloom_spread: f32,
    // Motion blur: the longest way until the shutter closes, 0 where nothing moves, and the side of the
    // tiles that know theirs, pixels.
    longest_px: f32,
    way_tile: u32,
    // Rows of the rotation from view space to that of the time when the shutter closes.
    end_from_view: array<vec4<f32>, 3>,
    // Rows of the rotation into its axes.
    environment_from_view: array<vec4<f32>, 3>,
    // First word among the texels and log2 of the width of each level, two levels in one.
    environment_levels: array<vec4<u32>, 3>,
    // Exposed factors of 1, x, y, z, xx, yy, zz, xy, yz, zx of the normal, by channel.
    environment_irradiance: array<vec4<f32>, 10>,
}

// A picture that is rastered: a band of the camera's, or the sun's map.
struct Target {
    // x w, y w, w and depth w as affine functions of a view-space point: high parts, then low.
    rows: array<vec4<f32>, 8>,
    near_w: f32,
    width: u32,
    height: u32,
    // Batches of triangles, and of vertices.
    batch_count: u32,
    // Tiles of the band; its first row of pixels.
    tiles: vec2<u32>,
    first_y: u32,
    // Rows of pixels of the band.
    band_height: u32,
    // First row of samples and log2 of the distance between rows, raster units.
    first_row: i32,
    row_step_log2: u32,
    vertex_batch_count: u32,
    pad0: u32,
}

// Up to 256 vertices of one object.
struct VertexBatch {
    object: u32,
    // Words of the mesh pool, first vertex of the batch.
    source: u32,
    count: u32,
    // First placed vertex.
    first: u32,
    // Rows of the palette; rigid objects have one transform for points and one for normals.
    palette: u32,
    rigid: u32,
    in_view: u32,
    casts: u32,
    // Rows of the palette when the shutter closes; NOTHING of what stands still.
    end: u32,
}

// Up to 64 triangles of one draw.
struct TriangleBatch {
    draw: u32,
    object: u32,
    // Words of the mesh pool, first triangle of the batch.
    source: u32,
    count: u32,
    // First placed vertex of the object.
    vertices: u32,
    // Place of the first triangle in draw order.
    order: u32,
    mirrored: u32,
    double_sided: u32,
    // See Primitive.flags.
    cutout: u32,
}

// A placed vertex, view space.
struct Vertex {
    position: vec3<f32>,
    // Of the unit shading normal; see normal.wgsl.
    normal: u32,
    uv: vec2<f32>,
    // How far it goes until the shutter closes, view space, as halves.
    way: vec2<u32>,
}

// A projected vertex; x is OUTSIDE where it cannot be projected.
struct ScreenVertex {
    x: i32,
    y: i32,
    depth: f32,
    pad: u32,
}

// A triangle that may cover samples, clockwise on screen, its farthest corner first.
struct Primitive {
    x: vec3<i32>,
    // Inverse of twice the area, raster units.
    inverse_area: f32,
    y: vec3<i32>,
    // Place in draw order.
    order: u32,
    // Depth at the corners.
    depth: vec3<f32>,
    flags: u32,
    // Vertices of the unclipped triangle.
    corners: vec3<u32>,
    draw: u32,
}

// What a set-up counts. Capacities that did not suffice are seen by the host.
struct Counters {
    primitives: u32,
    // Primitives in the list of large ones.
    large: u32,
    // Entries of the tiles' lists, the most over all bands.
    entries: u32,
    // All ones minus the first object with a number that is not finite; 0 for none.
    bad_object: u32,
    // Triangles that are cut, or whose visible part is bounded.
    crossing: u32,
    pad0: u32,
    pad1: u32,
    pad2: u32,
}

// Where a list of a tile stands: those of small primitives come first, then those of others.
struct Tile {
    count: u32,
    // Its end, once scattered.
    end: u32,
}

// A box along the sun's axes in ordered integers; see shared/bounds.wgsl.
struct Bounds {
    low: array<u32, 3>,
    high: array<u32, 3>,
    nearest: u32,
    // Whether the object's shadow can be seen.
    reaches: u32,
}

// How points are found in the sun's map.
struct SunView {
    // Texel column, texel row and depth of a view-space point.
    rows: array<vec4<f32>, 3>,
    size: vec2<u32>,
    texel_m: f32,
    depth_per_m: f32,
    // 0 if no shadow can be seen.
    present: u32,
    pad0: u32,
    pad1: u32,
    pad2: u32,
}

// A draw's material.
struct Surface {
    uv_repeat: vec2<f32>,
    detail_strength: f32,
    normal_strength: f32,
    // Halves: red and green, blue and roughness.
    base: vec2<u32>,
    // Halves: metallic, and how far light goes round the terminator.
    metallic_wrap: u32,
    // Sixths of a turn, negative for none.
    hue_turn: f32,
    // Albedo, detail, normal and mask: first texel of each in the pool.
    map_first: vec4<u32>,
    // A byte for each: log2 of the side, and what texture.wgsl says.
    map_info: u32,
    // Flags in the low half, the object in the high half.
    flags: u32,
    // First of the object's own spheres, and the one after the last.
    own_blockers: vec2<u32>,
    // As map_first and map_info, of the finish.
    finish_first: u32,
    finish_info: u32,
    pad: vec2<u32>,
    // Halves: red and green, blue and roughness.
    layers: array<vec2<u32>, 4>,
}

// A sphere in the way of surrounding light, view space.
struct Blocker {
    center: vec3<f32>,
    radius_m: f32,
}

// A point light, scaled by the exposure.
struct Light {
    position: vec3<f32>,
    per_range_m2: f32,
    color_cd: vec3<f32>,
    per_radius_m: f32,
}

// Two levels of scattered light: first texel and size. The light of pixels has NOTHING as its first.
struct Step {
    larger_first: u32,
    smaller_first: u32,
    larger_size: vec2<u32>,
    smaller_size: vec2<u32>,
    pad0: u32,
    pad1: u32,
}

// Count and extent of an object's samples in 1/16 pixel; smallest as all ones minus.
struct ObjectSums {
    count: u32,
    low: array<u32, 2>,
    high: array<u32, 2>,
}

const OUTSIDE: i32 = -2147483648;
// As x of a vertex whose object is left out.
const LEFT_OUT: i32 = -2147483647;
const NOTHING: u32 = 0xffffffffu;

// Surface.flags
const DOUBLE_SIDED: u32 = 1u;
const MIRRORED: u32 = 2u;
const SMOOTH: u32 = 4u;

// Primitive.flags
const SMALL: u32 = 1u;
const LARGE: u32 = 2u;
// From here on: strands to 1 of u of its cutout, 10 binary digits, 0 for none, and its frayed v, 1/1024.
const CUTOUT_SHIFT: u32 = 2u;

// Side of a tile in pixels.
const TILE_LOG2: u32 = 3u;
// Workgroups along x of a stage with one for each batch.
const BATCHES_ACROSS: u32 = 32768u;
// Room for primitives that every tile looks at, in front of the tiles' lists.
const LARGE_ROOM: u32 = 4096u;

// Words of the sun's map in front of its texels: the SunView.
const HEADER: u32 = 20u;
// Point lights that there is room for.
const MAX_LAMPS: u32 = 512u;
const MAX_BLOCKERS: u32 = 3072u;

@group(0) @binding(0) var<uniform> frame: Frame;
