//! The native engine: tiles over threads, eight lanes at a time, the same bytes on every machine.
//!
//! | stage | file | in -> out |
//! |---|---|---|
//! | skin | `skin`, `project` | meshes, palette -> placed and projected vertices |
//! | visibility | `chunk`, `setup`, `clip`, `bin` | -> triangles by tile |
//! | shadow | `shadow` | -> the sun's depth map, fitted to what is seen, rastered where it is looked up |
//! | behind a lens | `lens` | -> where samples lie in the pinhole's plane |
//! | per tile (`tile`): visibility | `raster`, `lens_raster`, `samples` | -> object, triangle and depth of each sample |
//! | per tile: shade | `fragment`, `shade`, `develop` | -> linear display light |
//! | per tile: display | `display` | -> the 8-bit picture |
//! | per tile: ways | `ways` | -> how far what pixels show moves, where anything does |
//! | over the picture: depth of field, motion blur, bloom, display | `optics` | light, where it is kept -> the 8-bit picture |
//! | per tile: resolve, reduce | `resolve`, `reduce` | -> ids, distances, counts, extents |
//!
//! Picture and labels come from the same samples. A pass that the plan leaves out is not computed.
//! No result depends on the number of threads or the instruction set: every float operation is
//! exactly rounded and in a fixed order, and what threads share is summed in whole numbers.

#![allow(clippy::needless_range_loop, reason = "lane loops index several arrays at once")]

mod bin;
mod chunk;
mod clip;
mod cutout;
mod develop;
mod display;
mod fragment;
mod lens;
mod lens_raster;
mod optics;
mod project;
mod raster;
mod reduce;
mod resolve;
mod samples;
mod setup;
mod shade;
mod shadow;
mod simd;
mod skin;
mod tile;
mod ways;

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use self::chunk::{Chunk, ChunkList};
use self::develop::{Backdrop, Develop};
use self::lens::Lens;
use self::optics::{LightRow, Optics};
use self::project::{Projection, ScreenVertex};
use self::samples::TILE;
use self::setup::Target;
use self::shade::{Geometry, Lighting, Rays, Stage, Surface};
use self::shadow::map::{ShadowMap, SunShadow};
use self::shadow::{Bounds, ShadowView, SunAxes};
use self::simd::Level;
use self::tile::{Row, Scratch, Shading, TilePass};
use super::optics::{keeps_light, moves};
use super::{Engine, EngineError, input, resized};
use crate::draw::DrawList;
use crate::plan::{Frame, ObjectSamples, Pass, PassPlan, StageTimes};

/// Which compiled form of the kernels runs. The results are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SimdChoice {
    /// The fastest that the processor has.
    #[default]
    Auto,
    /// What every processor of the target has.
    Baseline,
}

/// How a [`CpuEngine`] works.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CpuOptions {
    /// Instruction set.
    pub simd: SimdChoice,
    /// Threads of its own; 0 to work on the rayon pool of the calling thread.
    pub threads: usize,
}

/// Renders draw lists on the processor. Keeps its buffers from frame to frame.
#[derive(Default)]
pub struct CpuEngine {
    level: Option<Level>,
    pool: Option<rayon::ThreadPool>,
    buffers: Buffers,
}

/// Everything that lives on from frame to frame.
#[derive(Default)]
struct Buffers {
    placed: skin::Placed,
    /// That of the last frame that had one.
    lens: Option<Lens>,
    visible: ChunkList,
    casting: ChunkList,
    sun_screen: Vec<ScreenVertex>,
    shadow_map: ShadowMap,
    scratches: Mutex<Vec<Scratch>>,
    optics: Optics,
    /// An earlier frame, for its memory.
    spare: Frame,
}

impl CpuEngine {
    /// An engine without buffers yet.
    #[must_use]
    pub fn new(options: CpuOptions) -> Self {
        let level = match options.simd {
            SimdChoice::Auto => Level::detect(),
            SimdChoice::Baseline => Level::BASELINE,
        };
        // Without a pool of its own the engine still works, on the caller's.
        let pool = (options.threads > 0)
            .then(|| rayon::ThreadPoolBuilder::new().num_threads(options.threads).build().ok())
            .flatten();
        Self { level: Some(level), pool, buffers: Buffers::default() }
    }

    /// The instruction set in use: `avx2` or `baseline`.
    #[must_use]
    pub fn simd_name(&self) -> &'static str {
        self.level().name()
    }

    fn level(&self) -> Level {
        self.level.unwrap_or_else(Level::detect)
    }
}

impl Engine for CpuEngine {
    fn render(
        &mut self,
        list: &DrawList,
        plan: &PassPlan,
        times: &mut StageTimes,
    ) -> Result<Frame, EngineError> {
        let level = self.level();
        let buffers = &mut self.buffers;
        match &self.pool {
            Some(pool) => pool.install(|| buffers.render(level, list, plan, times)),
            None => buffers.render(level, list, plan, times),
        }
    }

    fn recycle(&mut self, frame: Frame) {
        self.buffers.spare = frame;
    }
}

impl Buffers {
    fn render(
        &mut self,
        level: Level,
        list: &DrawList,
        plan: &PassPlan,
        times: &mut StageTimes,
    ) -> Result<Frame, EngineError> {
        times.measure("check", || input::check(list))?;
        match list.samples {
            1 => self.passes::<1>(level, list, plan, times),
            4 => self.passes::<4>(level, list, plan, times),
            _ => self.passes::<16>(level, list, plan, times),
        }
    }

    fn passes<const S: usize>(
        &mut self,
        level: Level,
        list: &DrawList,
        plan: &PassPlan,
        times: &mut StageTimes,
    ) -> Result<Frame, EngineError> {
        let mut frame =
            Frame { width: list.view.width, height: list.view.height, ..Frame::default() };
        if !plan.runs(Pass::Visibility) {
            return Ok(frame);
        }
        let sun = list.lights.sun.filter(|sun| sun.shadow && plan.runs(Pass::Shadow));
        let axes = sun.map(|sun| SunAxes::new(sun.direction_to_sun));
        let seen: Vec<bool> = list.objects.iter().map(|o| o.in_view).collect();
        let casts: Vec<bool> =
            list.objects.iter().map(|o| o.casts_shadow && axes.is_some()).collect();
        let wanted: Vec<bool> = seen.iter().zip(&casts).map(|(a, b)| *a || *b).collect();
        times.measure("lens", || self.look_through_lens::<S>(level, list));
        let lens = self.lens.as_ref().filter(|_| list.lens.is_some());
        let projection = Projection::perspective(lens.map_or(&list.view, |l| &l.plane.plane));
        let shades = plan.runs(Pass::Shade);

        times.measure("skin", || self.placed.place(level, list, &projection, &wanted, shades))?;
        if moves(list, plan).is_some() {
            times.measure("skin", || self.placed.take_ways(list, &seen))?;
        }
        times.measure("setup", || {
            self.visible.fill(list, &self.placed, &seen)?;
            let (placed, chunks) = (&self.placed, self.visible.as_mut_slice());
            let (vertices, screen) = (&placed.vertices, &placed.screen);
            let whole = match lens {
                Some(lens) => Target::lens(vertices, screen, &projection, &lens.squares),
                None => Target::picture::<S>(vertices, screen, &projection),
            };
            let target = Target { shaded: shades, sun: axes.as_ref(), ..whole };
            set_up_all(level, chunks, list, &target);
            self.visible.sort_by_tile([list.view.width, list.view.height], target.tile_log2);
            Ok(())
        })?;
        let shadow = match &axes {
            Some(axes) => {
                let plane_px = projection.size;
                self.shadow(level, list, axes, plane_px, [&seen, &casts], times)?
            }
            None => None,
        };
        self.tiles::<S>(level, list, plan, shadow, &mut frame, times);
        Ok(frame)
    }

    /// Makes the tables of a draw list's lens, unless those of an earlier frame serve.
    fn look_through_lens<const S: usize>(&mut self, level: Level, list: &DrawList) {
        if list.lens.is_some() && !self.lens.as_ref().is_some_and(|lens| lens.serves(list)) {
            self.lens = Lens::new::<S>(level, list);
        }
    }

    /// Fits the sun's shadow map and sets up what it will show; nothing if no shadow can be seen.
    fn shadow(
        &mut self,
        level: Level,
        list: &DrawList,
        axes: &SunAxes,
        plane_px: [u32; 2],
        [seen, casts]: [&[bool]; 2],
        times: &mut StageTimes,
    ) -> Result<Option<ShadowView>, EngineError> {
        let size = list.shadow_map_size;
        if size == 0 {
            return Ok(None);
        }
        let (view, casts) = times.measure("shadow fit", || {
            let (casters, receivers) = self.bounds(level, list, axes, plane_px, [seen, casts]);
            let reaches: Vec<bool> = casters.iter().map(|c| c.may_shade(&receivers)).collect();
            let casting = casters.iter().zip(&reaches).filter(|(_, reaches)| **reaches);
            let casters = casting.fold(Bounds::EMPTY, |all, (caster, _)| all.join(caster));
            let focal_px = list.view.fx.max(list.view.fy);
            (ShadowView::fit(axes, &casters, &receivers, size, focal_px), reaches)
        });
        let Some(view) = view else { return Ok(None) };
        times.measure("shadow setup", || {
            let placed = &self.placed;
            self.sun_screen.resize(placed.vertices.len(), ScreenVertex::default());
            project_objects(level, placed, &view.projection, &casts, &mut self.sun_screen);
            self.casting.fill(list, placed, &casts)?;
            let target = Target::shadow(&placed.vertices, &self.sun_screen, &view.projection);
            set_up_all(level, self.casting.as_mut_slice(), list, &target);
            self.casting.sort_by_tile(view.projection.size, target.tile_log2);
            Ok(())
        })?;
        self.shadow_map.restart(view.projection.size);
        Ok(Some(view))
    }

    /// Bounds, along the sun's axes, of each object that casts shadows (of none where it does not)
    /// and of what is seen.
    fn bounds(
        &self,
        level: Level,
        list: &DrawList,
        axes: &SunAxes,
        plane_px: [u32; 2],
        [seen, casts]: [&[bool]; 2],
    ) -> (Vec<Bounds>, Bounds) {
        let placed = &self.placed;
        let of_object = |object: usize| {
            let span = placed.first_vertex[object]..placed.first_vertex[object + 1];
            let (vertices, screen) = (&placed.vertices[span.clone()], &placed.screen[span]);
            let (all, visible) = shadow::bound_vertices(level, vertices, screen, plane_px, axes);
            (
                if casts[object] { all } else { Bounds::EMPTY },
                if seen[object] { visible } else { Bounds::EMPTY },
            )
        };
        let (casters, visible): (Vec<_>, Vec<_>) =
            (0..list.objects.len()).into_par_iter().map(of_object).unzip();
        let borders = self.visible.as_slice().iter().map(|chunk| &chunk.border_bounds);
        let receivers = visible.iter().chain(borders).fold(Bounds::EMPTY, |all, b| all.join(b));
        (casters, receivers)
    }

    /// Runs the passes that go tile by tile and fills the frame.
    fn tiles<const S: usize>(
        &mut self,
        level: Level,
        list: &DrawList,
        plan: &PassPlan,
        shadow: Option<ShadowView>,
        frame: &mut Frame,
        times: &mut StageTimes,
    ) {
        let pixels = frame.width as usize * frame.height as usize;
        let shades = plan.runs(Pass::Display);
        let (resolves, reduces) = (plan.runs(Pass::Resolve), plan.runs(Pass::Reduce));
        let spare = std::mem::take(&mut self.spare);
        frame.picture = shades.then(|| resized(spare.picture, pixels * 3));
        frame.object_ids = resolves.then(|| resized(spare.object_ids, pixels));
        frame.depth_m = resolves.then(|| resized(spare.depth_m, pixels));
        let (map, casting) = (&self.shadow_map, &self.casting);
        let raster_time = shadow.map(|_| || map.raster_time());
        let shadow = shadow.map(|view| SunShadow { map, view, casting, level });
        let pass = TilePass {
            level,
            list,
            placed: &self.placed,
            lens: self.lens.as_ref().filter(|_| list.lens.is_some()),
            chunks: self.visible.as_slice(),
            by_tile: self.visible.by_tile(),
            shading: shades.then(|| {
                let develop =
                    if keeps_light(list, plan) { Develop::keep() } else { Develop::new(list) };
                shading(list, self.visible.as_slice(), &self.placed, shadow, develop)
            }),
            shutter: moves(list, plan),
            resolves,
            reduces,
        };
        let keeps = keeps_light(list, plan);
        let light = if keeps { self.optics.begin(list, plan) } else { Vec::new() };
        let scratches = &self.scratches;
        let used = Mutex::new(Vec::new());
        let lock = |pool: &Mutex<Vec<Scratch>>| pool.lock().map(|mut p| p.pop()).ok().flatten();
        rows(frame, light).into_par_iter().enumerate().with_max_len(1).for_each(|(y, row)| {
            // A scratch that has seen this frame, one of an earlier frame, or a new one.
            let mut scratch = lock(&used).unwrap_or_else(|| {
                let mut scratch = lock(scratches).unwrap_or_default();
                scratch.prepare(S, list.objects.len());
                scratch
            });
            pass.row::<S>(y as u32, row, &mut scratch);
            used.lock().unwrap_or_else(PoisonError::into_inner).push(scratch);
        });
        let used = used.into_inner().unwrap_or_else(PoisonError::into_inner);
        used.iter().for_each(|scratch| scratch.report(times));
        if let Some(raster_time) = raster_time {
            times.move_part("shade", "shadow raster", raster_time());
        }
        if let Some(picture) = frame.picture.as_deref_mut().filter(|_| keeps) {
            self.optics.finish(level, list, plan, picture, times);
        }
        frame.object_samples = reduces.then(|| {
            let mut sums = vec![ObjectSamples::default(); list.objects.len()];
            used.iter().for_each(|scratch| reduce::merge(&mut sums, &scratch.sums));
            sums
        });
        self.scratches.lock().unwrap_or_else(PoisonError::into_inner).extend(used);
    }
}

/// Projects the vertices of the wanted objects; the others' places keep what they held.
fn project_objects(
    level: Level,
    placed: &skin::Placed,
    projection: &Projection,
    wanted: &[bool],
    out: &mut [ScreenVertex],
) {
    let mut batches = Vec::new();
    let mut rest = out;
    for (span, wanted) in placed.first_vertex.windows(2).zip(wanted) {
        let (own, after) = rest.split_at_mut(span[1] - span[0]);
        rest = after;
        if *wanted {
            let from = placed.vertices[span[0]..span[1]].chunks(4096);
            batches.extend(from.zip(own.chunks_mut(4096)));
        }
    }
    batches
        .into_par_iter()
        .for_each(|(from, to)| project::project_all(level, from, projection, to));
}

/// Sets up all chunks for a raster pass.
fn set_up_all(level: Level, chunks: &mut [Chunk], list: &DrawList, target: &Target<'_>) {
    chunks.par_iter_mut().with_max_len(1).for_each(|chunk| {
        let mesh = &list.objects[chunk.object as usize].mesh;
        setup::set_up(level, chunk, &mesh.triangles, target);
    });
}

/// Prepares materials and lights.
fn shading<'a>(
    list: &'a DrawList,
    chunks: &'a [Chunk],
    placed: &'a skin::Placed,
    shadow: Option<SunShadow<'a>>,
    develop: Develop,
) -> Shading<'a> {
    let view = &list.view;
    Shading {
        stage: Stage {
            geometry: Geometry { chunks, vertices: &placed.vertices },
            rays: Rays::new(view),
            lighting: Lighting::new(list, shadow),
            develop,
        },
        surfaces: list.materials.iter().map(|m| Surface::new(m, list)).collect(),
        backdrop: Backdrop(list.lights.background_nits.map(|nits| nits * list.exposure)),
    }
}

/// Divides a frame's buffers into rows of tiles.
fn rows<'a>(frame: &'a mut Frame, light: Vec<LightRow<'a>>) -> Vec<Row<'a>> {
    let line = frame.width as usize * TILE;
    let count = (frame.height as usize).div_ceil(TILE);
    let mut picture = frame.picture.as_deref_mut().unwrap_or_default().chunks_mut(line * 3);
    let mut object_ids = frame.object_ids.as_deref_mut().unwrap_or_default().chunks_mut(line);
    let mut depth_m = frame.depth_m.as_deref_mut().unwrap_or_default().chunks_mut(line);
    let mut light = light.into_iter();
    (0..count)
        .map(|_| Row {
            picture: picture.next().unwrap_or_default(),
            object_ids: object_ids.next().unwrap_or_default(),
            depth_m: depth_m.next().unwrap_or_default(),
            light: light.next().unwrap_or_default(),
        })
        .collect()
}
