//! Pack: a draw list as the records that the shaders read.

use half::f16;

use super::abi::{
    self, Blocker, CUTOUT_SHIFT, DOUBLE_SIDED, Frame, Light, MAP_COLOR, MAP_PRESENT, MIRRORED,
    NOTHING, SMOOTH, Surface, TRIANGLE_BATCH, Target, TriangleBatch, VERTEX_BATCH, VERTEX_WORDS,
    VertexBatch,
};
use crate::draw::DrawList;
use crate::draw::abi::{Grade, Material, ToneCurve, View};
use crate::engine::{noise, optics, pattern};
use crate::library::mesh::{Cutout, Mesh};
use crate::library::texture::{Encoding, Texture};

/// Which objects a frame needs, and for what.
pub struct Wanted {
    /// The camera may see it.
    pub seen: Vec<bool>,
    /// It casts shadows that may be seen.
    pub casts: Vec<bool>,
}

impl Wanted {
    /// What to draw, and what of it into the sun's map where there is one.
    pub fn new(list: &DrawList, shadow: bool) -> Self {
        Self {
            seen: list.objects.iter().map(|o| o.in_view).collect(),
            casts: list.objects.iter().map(|o| o.casts_shadow && shadow).collect(),
        }
    }

    /// Whether an object is needed at all.
    pub fn any(&self, object: usize) -> bool {
        self.seen[object] || self.casts[object]
    }
}

/// Where in their pools the parts of a draw list stand, words.
pub struct Places {
    /// By object.
    pub meshes: Vec<u32>,
    /// By texture.
    pub textures: Vec<u32>,
    /// Of the picture of the surroundings, if there is one; in the pool of the textures.
    pub surroundings: u32,
}

/// The records of one frame; keeps its memory for the next.
#[derive(Default)]
pub struct Packed {
    pub frame: Frame,
    pub vertex_batches: Vec<VertexBatch>,
    pub batches: Vec<TriangleBatch>,
    pub sun_batches: Vec<TriangleBatch>,
    pub palette: Vec<[f32; 4]>,
    pub surfaces: Vec<Surface>,
    pub lights: Vec<Light>,
    pub blockers: Vec<Blocker>,
    /// Placed vertices.
    pub vertices: u32,
    /// Triangles before culling, of the picture and of the sun's map.
    pub triangles: [u32; 2],
}

/// Words of a mesh in the pool: vertices, then triangles.
pub const fn mesh_words(mesh: &Mesh) -> u64 {
    mesh.positions.len() as u64 * VERTEX_WORDS as u64 + mesh.triangles.len() as u64 * 3
}

/// A mesh as the pool holds it, in memory of the pool's.
pub fn mesh_content<'a>(mesh: &'a Mesh, words: &'a mut Vec<u32>) -> &'a [u32] {
    // What was there before is written over, so that memory which is long enough is not cleared.
    words.resize(words.len().max(mesh_words(mesh) as usize), 0);
    let (vertices, rest) = words.split_at_mut(mesh.positions.len() * VERTEX_WORDS as usize);
    let vertices = vertices.as_chunks_mut::<{ VERTEX_WORDS as usize }>().0;
    let places = mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs);
    for (vertex, ((position, normal), uv)) in vertices.iter_mut().zip(places) {
        let [x, y, z] = position.map(f32::to_bits);
        let [u, v] = uv.map(f32::to_bits);
        *vertex = [x, y, z, normal.bits(), u, v, 0, 0];
    }
    for (vertex, skin) in vertices.iter_mut().zip(&mesh.skin) {
        (vertex[6], vertex[7]) =
            (u32::from_le_bytes(skin.joints), u32::from_le_bytes(skin.weights));
    }
    for (words, triangle) in rest.as_chunks_mut::<3>().0.iter_mut().zip(&mesh.triangles) {
        *words = triangle.get();
    }
    &words[..mesh_words(mesh) as usize]
}

impl Packed {
    /// Packs a draw list whose meshes and textures stand at these places in their pools.
    pub fn fill(&mut self, list: &DrawList, wanted: &Wanted, shadow: bool, places: &Places) {
        let Places { meshes, textures, surroundings } = places;
        self.vertex_batches.clear();
        self.batches.clear();
        self.sun_batches.clear();
        self.palette.clear();
        self.palette.extend(list.palette.as_flattened());
        let first_vertex = self.add_objects(list, wanted, meshes);
        self.add_draws(list, wanted, meshes, &first_vertex);
        self.surfaces.clear();
        self.surfaces.extend(list.draws.iter().map(|draw| {
            let object = &list.objects[draw.object as usize];
            let mut surface =
                surface(&list.materials[draw.material as usize], list, textures, draw.object);
            let flag = |set: bool, flag: u32| if set { flag } else { 0 };
            surface.flags |= flag(draw.double_sided, DOUBLE_SIDED)
                | flag(is_mirrored(list, draw.object), MIRRORED)
                | flag(object.smooth, SMOOTH);
            surface
        }));
        self.lights.clear();
        self.lights.extend(list.lights.points.iter().map(|p| Light {
            position: p.position,
            per_range_m2: 1.0 / (p.range_m * p.range_m),
            color_cd: p.color_cd.map(|v| v * list.exposure),
            per_radius_m: 1.0 / p.radius_m.max(1e-6),
        }));
        self.blockers.clear();
        self.blockers.extend(list.blockers.iter().map(|b| {
            let (center, radius_m) = (b.center, b.radius_m);
            Blocker { center, radius_m }
        }));
        self.frame = frame(list, shadow);
        add_surroundings(&mut self.frame, list, *surroundings);
    }

    fn add_objects(&mut self, list: &DrawList, wanted: &Wanted, meshes: &[u32]) -> Vec<u32> {
        let mut first_vertex = Vec::with_capacity(list.objects.len());
        self.vertices = 0;
        for (index, object) in list.objects.iter().enumerate() {
            first_vertex.push(self.vertices);
            if !wanted.any(index) {
                continue;
            }
            let rigid = object.mesh.skin.is_empty();
            let palette = if rigid {
                let first = self.palette.len() as u32;
                self.palette.extend(object.view_from_model);
                self.palette.extend(normal_rows(&object.view_from_model));
                first
            } else {
                object.palette.start * 3
            };
            let end = object.end.as_ref().map_or(NOTHING, |end| {
                let first = self.palette.len() as u32;
                if rigid {
                    self.palette.extend(end.view_from_model);
                    return first;
                }
                end.palette.start * 3
            });
            let count = object.mesh.positions.len() as u32;
            for first in (0..count).step_by(VERTEX_BATCH as usize) {
                self.vertex_batches.push(VertexBatch {
                    object: index as u32,
                    source: meshes[index] + first * VERTEX_WORDS,
                    count: VERTEX_BATCH.min(count - first),
                    first: self.vertices + first,
                    palette,
                    rigid: rigid.into(),
                    in_view: wanted.seen[index].into(),
                    casts: wanted.casts[index].into(),
                    end,
                });
            }
            self.vertices += count;
        }
        first_vertex
    }

    fn add_draws(&mut self, list: &DrawList, wanted: &Wanted, meshes: &[u32], vertices: &[u32]) {
        let [mut picture, mut sun] = [0; 2];
        for (index, draw) in list.draws.iter().enumerate() {
            let object = draw.object as usize;
            let mesh = &list.objects[object].mesh;
            let triangles = meshes[object] + mesh.positions.len() as u32 * VERTEX_WORDS;
            let lists = [
                (wanted.seen[object], &mut self.batches, &mut picture),
                (wanted.casts[object], &mut self.sun_batches, &mut sun),
            ];
            for (_, batches, order) in lists.into_iter().filter(|(wanted, ..)| *wanted) {
                for first in draw.triangles.clone().step_by(TRIANGLE_BATCH as usize) {
                    let count = TRIANGLE_BATCH.min(draw.triangles.end - first);
                    batches.push(TriangleBatch {
                        draw: index as u32,
                        object: draw.object,
                        source: triangles + first * 3,
                        count,
                        vertices: vertices[object],
                        order: *order,
                        mirrored: is_mirrored(list, draw.object).into(),
                        double_sided: draw.double_sided.into(),
                        cutout: draw.cutout.map_or(0, cutout),
                    });
                    *order += count;
                }
            }
        }
        self.triangles = [picture, sun];
    }
}

/// A cutout as flags of a primitive.
fn cutout(cutout: Cutout) -> u32 {
    let strands = u32::from(cutout.strands_per_u).min(1023);
    (strands | u32::from(cutout.frayed_1024ths.max(1)) << 10) << CUTOUT_SHIFT
}

/// The plane behind a lens that the picture's triangles are set up in. Samples may lie anywhere in it.
pub fn plane_target(view: &View, packed: &Packed) -> Target {
    Target { first_row: 0, row_step_log2: 0, ..view_target(view, 1, packed, [0, view.height]) }
}

/// A band of the camera's picture: so many rows of pixels from one on.
pub fn picture_target(list: &DrawList, packed: &Packed, first_y: u32, rows: u32) -> Target {
    view_target(&list.view, list.samples, packed, [first_y, rows])
}

fn view_target(view: &View, samples: u32, packed: &Packed, [first_y, rows]: [u32; 2]) -> Target {
    let View { width, height, fx, fy, cx, cy, near_m, .. } = *view;
    let (first_row, row_step_log2) = pattern::rows(samples);
    let mut target = Target {
        near_w: near_m,
        width,
        height,
        batch_count: packed.batches.len() as u32,
        vertex_batch_count: packed.vertex_batches.len() as u32,
        tiles: [width.div_ceil(abi::TILE), rows.div_ceil(abi::TILE)],
        first_y,
        band_height: rows,
        first_row,
        row_step_log2,
        ..Target::default()
    };
    target.rows[..4].copy_from_slice(&[
        [fx, 0.0, -cx, 0.0],
        [0.0, -fy, -cy, 0.0],
        [0.0, 0.0, -1.0, 0.0],
        [0.0, 0.0, 0.0, near_m],
    ]);
    target
}

/// The sun's map before it is fitted.
pub fn sun_target(packed: &Packed) -> Target {
    let (first_row, row_step_log2) = pattern::rows(1);
    Target {
        near_w: 0.5,
        batch_count: packed.sun_batches.len() as u32,
        vertex_batch_count: packed.vertex_batches.len() as u32,
        first_row,
        row_step_log2,
        ..Target::default()
    }
}

fn frame(list: &DrawList, shadow: bool) -> Frame {
    let (view, lights) = (&list.view, &list.lights);
    let exposed = |c: [f32; 3]| c.map(|v| v * list.exposure);
    let mut frame = Frame {
        size: [view.width, view.height],
        light_count: lights.points.len() as u32,
        zero: 0,
        focal: [view.fx, view.fy],
        center: [view.cx, view.cy],
        near_m: view.near_m,
        shadow_map_size: list.shadow_map_size,
        has_shadow: shadow.into(),
        up: view.view_from_world.map(|row| row[1]),
        object_count: list.objects.len() as u32,
        blocker_count: list.blockers.len() as u32,
        sky: exposed(lights.sky_lux),
        ground: exposed(lights.ground_lux),
        background: exposed(lights.background_nits),
        ..Frame::default()
    };
    if let Some(sun) = &lights.sun {
        frame.has_sun = 1;
        frame.to_sun = unit(sun.direction_to_sun);
        frame.sun_color = exposed(sun.color_lux);
        frame.sun_axes = sun_axes(sun.direction_to_sun).map(|[x, y, z]| [x, y, z, 0.0]);
    }
    add_grade(&mut frame, &list.grade);
    if let Some(defocus) = &list.defocus {
        frame.focus_m = defocus.focus_m;
        frame.blur_px = defocus.at_infinity_px;
        frame.blur_limit_px = defocus.largest_px;
        frame.blur_halvings = optics::blur_level(defocus);
    }
    if let Some(shutter) = &list.shutter {
        frame.longest_px = shutter.longest_px;
        frame.way_tile = optics::way_tile(shutter);
        frame.end_from_view = shutter.end_from_view.map(|[x, y, z]| [x, y, z, 0.0]);
    }
    if let Some(bloom) = list.grade.bloom {
        (frame.bloom_share, frame.bloom_spread) = (bloom.share, bloom.spread);
    }
    frame
}

/// Adds the picture of the surroundings, which starts at a word of the pool.
fn add_surroundings(frame: &mut Frame, list: &DrawList, first: u32) {
    let Some(surroundings) = &list.lights.surroundings else { return };
    let unit = list.exposure;
    frame.has_environment = 1;
    frame.environment_unit = surroundings.nits_per_unit * unit;
    frame.environment_from_view = surroundings.map_from_view.map(|[x, y, z]| [x, y, z, 0.0]);
    let levels = surroundings.map.levels.map(|l| [first + l.first, l.log2_width]);
    for (to, two) in frame.environment_levels.iter_mut().zip(levels.as_chunks::<2>().0) {
        *to = [two[0][0], two[0][1], two[1][0], two[1][1]];
    }
    frame.environment_irradiance =
        surroundings.irradiance_lux.map(|[r, g, b]| [r * unit, g * unit, b * unit, 0.0]);
}

/// Adds what develops the light.
fn add_grade(frame: &mut Frame, grade: &Grade) {
    let rows = |m: [[f32; 3]; 3]| m.map(|[x, y, z]| [x, y, z, 0.0]);
    if let Some(color) = &grade.color {
        frame.grade_before = rows(color.before);
        frame.grade_after = rows(color.after);
        // At 0 all light becomes mid-grey, as it does at next to nothing.
        frame.contrast = color.contrast.max(f32::MIN_POSITIVE);
    }
    frame.vignette = 3.0 * grade.vignette;
    frame.grain = grade.grain / noise::GRAIN_STD;
    frame.grain_key = noise::mixed(grade.grain_key);
    frame.sensor_key = noise::sensor_key(grade.grain_key);
    frame.shot_noise = grade.shot_noise;
    frame.read_variance = grade.read_noise * grade.read_noise;
    frame.tone_curve = match grade.tone_curve {
        ToneCurve::Aces => 0,
        ToneCurve::Agx => 1,
        ToneCurve::None => 2,
    };
}

fn surface(material: &Material, list: &DrawList, textures: &[u32], object: u32) -> Surface {
    let turn = material.hue_offset_deg / 60.0;
    let maps = [
        material.albedo_map,
        material.detail_map,
        material.normal_map.filter(|_| material.normal_strength != 0.0),
        material.mask,
    ];
    let info = |texture: &Texture| {
        let color = if texture.encoding == Encoding::Color { MAP_COLOR } else { 0 };
        texture.log2_size | color | MAP_PRESENT
    };
    let infos = maps.map(|m| m.map_or(0, |i| info(&list.textures[i as usize])));
    let [r, g, b] = material.base_color;
    Surface {
        uv_repeat: material.uv_repeat,
        detail_strength: material.detail_strength,
        normal_strength: material.normal_strength,
        base: pairs([r, g, b, material.roughness.clamp(0.04, 1.0)]),
        metallic_wrap: pair([material.metallic.clamp(0.0, 1.0), material.wrap.clamp(0.0, 0.5)]),
        hue_turn: if turn == 0.0 { -1.0 } else { turn - 6.0 * (turn / 6.0).floor() },
        map_first: maps.map(|m| m.map_or(0, |i| textures[i as usize])),
        map_info: u32::from_le_bytes(infos.map(|info| info as u8)),
        flags: object << 16,
        own_blockers: {
            let own = &list.objects[object as usize].blockers;
            [own.start, own.end]
        },
        finish_first: material.finish_map.map_or(0, |i| textures[i as usize]),
        finish_info: material.finish_map.map_or(0, |i| info(&list.textures[i as usize])),
        pad: [0; 2],
        layers: material.layers.map(pairs),
    }
}

/// Two numbers as halves, the first one lower.
fn pair(v: [f32; 2]) -> u32 {
    let [low, high] = v.map(|v| u32::from(f16::from_f32(v).to_bits()));
    low | high << 16
}

/// Four numbers as halves.
fn pairs([a, b, c, d]: [f32; 4]) -> [u32; 2] {
    [pair([a, b]), pair([c, d])]
}

/// Whether an object's transform turns its triangles inside out.
fn is_mirrored(list: &DrawList, object: u32) -> bool {
    let object = &list.objects[object as usize];
    object.mesh.skin.is_empty() && determinant(&object.view_from_model) < 0.0
}

fn determinant(m: &[[f32; 4]; 3]) -> f64 {
    let d = |r: usize, c: usize| f64::from(m[r][c]);
    d(0, 0) * (d(1, 1) * d(2, 2) - d(1, 2) * d(2, 1))
        - d(0, 1) * (d(1, 0) * d(2, 2) - d(1, 2) * d(2, 0))
        + d(0, 2) * (d(1, 0) * d(2, 1) - d(1, 1) * d(2, 0))
}

/// The inverse transpose of the linear part but for a positive factor: its cofactors, with the
/// determinant's sign.
fn normal_rows(m: &[[f32; 4]; 3]) -> [[f32; 4]; 3] {
    let sign = if determinant(m) < 0.0 { -1.0 } else { 1.0 };
    let largest = m.iter().flat_map(|r| &r[..3]).fold(0.0f32, |a, v| a.max(v.abs()));
    let scale = if largest > 0.0 { 1.0 / f64::from(largest) } else { 1.0 };
    let d = |r: usize, c: usize| f64::from(m[r % 3][c % 3]) * scale;
    std::array::from_fn(|r| {
        let row: [f32; 3] = std::array::from_fn(|c| {
            (sign * (d(r + 1, c + 1) * d(r + 2, c + 2) - d(r + 1, c + 2) * d(r + 2, c + 1))) as f32
        });
        [row[0], row[1], row[2], 0.0]
    })
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt().max(1e-20);
    v.map(|x| x / length)
}

/// An orthonormal frame with its third axis towards the sun.
fn sun_axes(direction_to_sun: [f32; 3]) -> [[f32; 3]; 3] {
    let cross = |a: [f32; 3], b: [f32; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let to_sun = unit(direction_to_sun);
    let helper = if to_sun[1].abs() < 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
    let right = unit(cross(helper, to_sun));
    [right, cross(to_sun, right), to_sun]
}
