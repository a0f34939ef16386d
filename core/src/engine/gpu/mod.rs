//! The graphics engine: the native engine's stages as compute shaders, by way of wgpu.
//!
//! | stage | shader | in -> out |
//! |---|---|---|
//! | skin | `skin` | meshes, palette -> placed and projected vertices |
//! | visibility | `setup`, `clip`, `bin`, `scan` | -> triangles by tile |
//! | shadow | `bound`, `fit`, `project`, `sun_setup`, `clip`, `shadow` | -> the sun's depth map |
//! | visibility | `raster` | -> triangle and depth of each sample; behind a lens by the tables of `lens` |
//! | shade, display | `shade` | -> the 8-bit picture |
//! | depth of field | `split`, `gather`, `compose` | light, where it is kept -> light |
//! | motion blur | `way`, `longest`, `streak` | samples, light -> light |
//! | bloom | `halve`, `widen` | light -> scattered light |
//! | display | `finish` | both -> the 8-bit picture |
//! | resolve, reduce | `resolve`, `reduce` | -> ids, distances, counts, extents |
//!
//! Everything is computed, nothing drawn by fixed hardware: snapping, tie rules, sample positions
//! and formulas are those of the native engine, so that both show the same to a thousandth of a
//! pixel on every device with compute shaders. A picture whose samples do not fit one buffer is
//! rendered in bands. Meshes and textures stay on the device ([`pool`]); all other buffers are kept
//! from frame to frame. Only what the plan asks for is read back. Kinds of light that a frame has not
//! got are no part of its shaders (`variant`).
//!
//! An engine is done with a frame before it begins the next: it packs, uploads what is new, records
//! and submits on the thread that calls it, waits for that submission and copies what was read
//! back. Frames overlap because batches give each worker an engine of its own, with a device of its
//! own: as many frames are in flight as there are workers, and while one waits the others draw,
//! pack and copy. So one buffer to read back into is enough for each, and no lock is shared; what
//! it costs is that each worker holds and uploads its own meshes and textures. Once
//! buffers are large enough, a frame makes none; only wgpu itself stages what is written to them.
//! `tests/benches/gpu_submit.rs` measures all of this. A device of software that somebody else waits
//! for too, such as a window, is given a frame in small parts (`Device::takes_turns`).
//!
//! Lists of triangles are made in any order, but no result depends on it: the nearest sample wins,
//! of equals the earlier drawn.

mod abi;
mod adapter;
mod bands;
mod buffers;
mod device;
mod lens;
mod optics;
mod pack;
mod pool;
mod present;
mod probe;
mod readback;
mod record;
mod reload;
mod stage;
mod variant;

pub use adapter::{AdapterReport, GpuError, GpuOptions, adapters, choice};
pub use present::{GpuContext, GpuPicture, GpuPictures};
pub use probe::PlacedVertex;
pub use reload::{ShaderFolder, ShaderProblem};

use std::sync::Arc;

use self::abi::{Bounds, Counters, LARGE_ROOM, MAX_LAMPS, ObjectSums};
use self::buffers::Buffers;
use self::device::Device;
use self::lens::Lens;
use self::optics::Optics;
use self::pack::{Packed, Places, Wanted};
use self::pool::Pool;
use self::present::Presenter;
use self::readback::{Counted, Readback};
use self::record::Clock;
use self::stage::Resource;
use super::optics::{moves, scatters};
use super::{Engine, EngineError, input, resized};
use crate::draw::DrawList;
use crate::draw::abi::MAX_BLOCKERS;
use crate::library::mesh::Mesh;
use crate::library::texture::Texture;
use crate::plan::{Delivery, Frame, ObjectSamples, Pass, PassPlan, StageTimes};

/// How often a frame is tried anew with more room for triangles: what is needed is known after
/// the first try, but for the sun's map, of which it is known after the second.
const TRIES: usize = 4;

/// Renders draw lists on a graphics device. Keeps its buffers from frame to frame.
pub struct GpuEngine {
    /// How its device is opened; nothing if somebody else opened it.
    options: Option<GpuOptions>,
    state: State,
}

impl GpuEngine {
    /// Opens the adapter that the options name.
    ///
    /// # Errors
    /// When there is none, or it gives no device.
    pub fn new(options: GpuOptions) -> Result<Self, GpuError> {
        let state = State::open(&options)?;
        Ok(Self { options: Some(options), state })
    }

    /// Renders on a device that somebody else opened. Pictures that are wanted as textures are left
    /// in what is handed back beside the engine.
    #[must_use]
    pub fn on(context: GpuContext) -> (Self, GpuPictures) {
        let mut state = State::new(Device::given(context));
        let pictures = state.present.insert(Presenter::new(&state.device)).pictures.clone();
        (Self { options: None, state }, pictures)
    }

    /// The name of the adapter in use.
    #[must_use]
    pub fn adapter_name(&self) -> &str {
        &self.state.device.name
    }

    /// Takes the device away, as a driver that fails does. The next frame opens it anew.
    pub fn lose_device(&mut self) {
        self.state.device.device.destroy();
    }

    /// Opens the device again, with nothing on it.
    fn reopen(&mut self, lost: EngineError) -> Result<(), EngineError> {
        match self.options.as_ref().map(State::open) {
            Some(Ok(state)) => {
                self.state = state;
                Ok(())
            }
            _ => Err(lost),
        }
    }
}

impl Engine for GpuEngine {
    fn render(
        &mut self,
        list: &DrawList,
        plan: &PassPlan,
        times: &mut StageTimes,
    ) -> Result<Frame, EngineError> {
        times.measure("check", || input::check(list))?;
        match self.state.render(list, plan, times) {
            // An error may come with the loss of the device, which is told a moment later.
            Err(error)
                if matches!(error, EngineError::DeviceLost { .. })
                    || self.state.device.lost().is_some() =>
            {
                self.reopen(error)?;
                self.state.render(list, plan, times)
            }
            result => result,
        }
    }

    fn recycle(&mut self, frame: Frame) {
        self.state.spare = frame;
    }
}

/// An open device with everything that lives on it.
struct State {
    device: Device,
    buffers: Buffers,
    meshes: Pool<Mesh>,
    textures: Pool<[u32]>,
    packed: Packed,
    optics: Optics,
    /// That of the last frame that had one.
    lens: Option<Lens>,
    /// Whether the device holds the tables of its last band.
    lens_is_there: bool,
    readback: Readback,
    present: Option<Presenter>,
    clock: Option<Clock>,
    room: Room,
    /// A frame that nobody reads any more.
    spare: Frame,
}

/// How much room triangles are given; grows when a frame needs more.
#[derive(Clone, Copy, Debug, Default)]
struct Room {
    primitives: [u64; 2],
    entries: u64,
}

impl Room {
    /// Grows to what was counted; whether that was needed.
    fn grow(&mut self, counted: &Counted) -> bool {
        let mut grew = false;
        for (room, counters) in self.primitives.iter_mut().zip(counted) {
            let needed = u64::from(counters.primitives);
            if needed > *room {
                (*room, grew) = (needed + needed / 4, true);
            }
        }
        let needed = u64::from(counted.iter().map(|c| c.entries).max().unwrap_or(0));
        if needed > self.entries {
            (self.entries, grew) = (needed + needed / 4, true);
        }
        grew
    }
}

impl State {
    fn open(options: &GpuOptions) -> Result<Self, GpuError> {
        Ok(Self::new(Device::open(options)?))
    }

    fn new(device: Device) -> Self {
        Self {
            clock: device.timed.then(|| Clock::new(&device)),
            device,
            buffers: Buffers::default(),
            meshes: Pool::new("graphics memory of meshes"),
            textures: Pool::new("graphics memory of textures"),
            packed: Packed::default(),
            optics: Optics::default(),
            lens: None,
            lens_is_there: false,
            readback: Readback::default(),
            present: None,
            room: Room::default(),
            spare: Frame::default(),
        }
    }

    fn render(
        &mut self,
        list: &DrawList,
        plan: &PassPlan,
        times: &mut StageTimes,
    ) -> Result<Frame, EngineError> {
        let (width, height) = (list.view.width, list.view.height);
        let mut frame = Frame { width, height, ..Frame::default() };
        if !plan.runs(Pass::Visibility) {
            return Ok(frame);
        }
        if self.device.reload() {
            self.buffers.forget_groups();
        }
        let pixels = width as usize * height as usize;
        let (resolves, reduces) = (plan.runs(Pass::Resolve), plan.runs(Pass::Reduce));
        let plan = &self.deliver(plan, [width, height])?;
        let read_back = plan.runs(Pass::Display) && plan.delivery() == Delivery::Readback;
        let spare = std::mem::take(&mut self.spare);
        // Every pixel is written, but only the objects that are seen.
        frame.picture = read_back.then(|| resized(spare.picture, pixels * 3));
        frame.object_ids = resolves.then(|| resized(spare.object_ids, pixels));
        frame.depth_m = resolves.then(|| resized(spare.depth_m, pixels));
        frame.object_samples = reduces.then(|| {
            let mut sums = spare.object_samples.unwrap_or_default();
            sums.clear();
            sums.resize(list.objects.len(), ObjectSamples::default());
            sums
        });
        let sun = list.lights.sun.is_some_and(|sun| sun.shadow);
        let shadow = sun && plan.runs(Pass::Shadow) && list.shadow_map_size > 0;
        times.measure("lens", || self.look_through_lens(list))?;
        self.upload(list, plan, shadow, times)?;
        for _ in 0..TRIES {
            if self.bands(list, plan, shadow, &mut frame, times)? {
                if let Some(present) = &mut self.present {
                    present.finish();
                }
                return Ok(frame);
            }
        }
        let (what, got) = ("number of triangles by tile", self.room.entries);
        Err(EngineError::TooLarge { what, got, limit: self.device.largest_buffer() / 4 })
    }

    /// Makes the tables of a draw list's lens, unless those of an earlier frame serve.
    fn look_through_lens(&mut self, list: &DrawList) -> Result<(), EngineError> {
        if list.lens.is_some() && !self.lens.as_ref().is_some_and(|lens| lens.serves(list)) {
            self.lens = Lens::new(list, self.band_rows(list)?);
            self.lens_is_there = false;
        }
        Ok(())
    }

    /// The plan as it can be carried out: where nobody shows pictures they are read back.
    fn deliver(&mut self, plan: &PassPlan, size: [u32; 2]) -> Result<PassPlan, EngineError> {
        let shown = plan.runs(Pass::Display) && plan.delivery() == Delivery::Texture;
        match self.present.as_mut().filter(|_| shown) {
            Some(present) => present.begin(&self.device, size).map(|()| plan.clone()),
            None => Ok(plan.clone().delivered(Delivery::Readback)),
        }
    }

    /// Brings meshes and textures to the device and packs the rest of the draw list.
    fn upload(
        &mut self,
        list: &DrawList,
        plan: &PassPlan,
        shadow: bool,
        times: &mut StageTimes,
    ) -> Result<(), EngineError> {
        let wanted = Wanted::new(list, shadow);
        let places = times.measure("upload", || {
            self.place(list, plan, &wanted).or_else(|_| {
                // This frame's may be scattered among gaps that other frames' left: once more, from
                // the start.
                self.meshes.forget();
                self.textures.forget();
                self.place(list, plan, &wanted)
            })
        })?;
        times.measure("pack", || {
            self.packed.fill(list, &wanted, shadow, &places);
            if scatters(list, plan).is_none() {
                self.packed.frame.bloom_share = 0.0;
            }
            if moves(list, plan).is_none() {
                self.packed.frame.longest_px = 0.0;
            }
            self.write(list, shadow)
        })
    }

    /// Where the meshes and the texels of a draw list stand, after those that were not there yet
    /// were brought to the device.
    fn place(
        &mut self,
        list: &DrawList,
        plan: &PassPlan,
        wanted: &Wanted,
    ) -> Result<Places, EngineError> {
        let device = &self.device;
        let needed = |i: &usize| wanted.any(*i);
        let used = (0..list.objects.len()).filter(needed).map(|i| &list.objects[i].mesh);
        self.meshes.begin(device, used);
        let mut meshes = vec![0; list.objects.len()];
        for i in (0..list.objects.len()).filter(needed) {
            let mesh = &list.objects[i].mesh;
            let words = pack::mesh_words(mesh);
            meshes[i] = self.meshes.place(device, mesh, words, pack::mesh_content)?;
        }
        let shaded: &[Arc<Texture>] = if plan.runs(Pass::Shade) { &list.textures } else { &[] };
        let surroundings = list.lights.surroundings.as_ref().filter(|_| plan.runs(Pass::Shade));
        let pictures = surroundings.map(|s| &s.map.texels);
        self.textures.begin(device, shaded.iter().map(|t| &t.texels).chain(pictures));
        let mut place = |texels: &Arc<[u32]>| {
            self.textures.place(device, texels, texels.len() as u64, |texels, _| texels)
        };
        let mut textures = vec![0; list.textures.len()];
        for (to, texture) in textures.iter_mut().zip(shaded) {
            *to = place(&texture.texels)?;
        }
        let surroundings = pictures.map(place).transpose()?.unwrap_or_default();
        Ok(Places { meshes, textures, surroundings })
    }

    /// Writes the packed records, and makes room for what depends on their number.
    fn write(&mut self, list: &DrawList, shadow: bool) -> Result<(), EngineError> {
        let (device, buffers, packed) = (&self.device, &mut self.buffers, &self.packed);
        for (resource, pool) in
            [(Resource::Meshes, self.meshes.buffer()), (Resource::Texels, self.textures.buffer())]
        {
            if let Some(buffer) = pool {
                buffers.put(resource, buffer.clone());
            }
        }
        buffers.write(device, Resource::Frame, &[packed.frame])?;
        let lens = self.lens.as_ref().filter(|_| list.lens.is_some());
        let plane = match lens {
            Some(lens) => pack::plane_target(lens.plane(), packed),
            None => pack::picture_target(list, packed, 0, list.view.height),
        };
        buffers.write(device, Resource::Plane, &[plane])?;
        buffers.write(device, Resource::VertexBatches, &packed.vertex_batches)?;
        buffers.write(device, Resource::Batches, &packed.batches)?;
        buffers.write(device, Resource::SunBatches, &packed.sun_batches)?;
        buffers.write(device, Resource::Palette, &packed.palette)?;
        buffers.write(device, Resource::Surfaces, &packed.surfaces)?;
        let (got, limit) = (packed.lights.len() as u64, u64::from(MAX_LAMPS));
        if got > limit {
            return Err(EngineError::TooLarge { what: "number of point lights", got, limit });
        }
        buffers.ensure(device, Resource::Lights, limit * size_of::<abi::Light>() as u64)?;
        buffers.write(device, Resource::Lights, &packed.lights)?;
        let room = (MAX_BLOCKERS * size_of::<abi::Blocker>()) as u64;
        buffers.ensure(device, Resource::Blockers, room)?;
        buffers.write(device, Resource::Blockers, &packed.blockers)?;
        buffers.ensure(device, Resource::SunView, size_of::<abi::SunView>() as u64)?;
        let sun = pack::sun_target(packed);
        buffers.write(device, Resource::SunTarget, &[sun])?;
        let objects = list.objects.len() as u64;
        let vertices = u64::from(packed.vertices);
        buffers.ensure(device, Resource::Vertices, vertices * size_of::<abi::Vertex>() as u64)?;
        buffers.ensure(
            device,
            Resource::Screen,
            vertices * size_of::<abi::ScreenVertex>() as u64,
        )?;
        buffers.ensure(device, Resource::Bounds, (objects + 1) * size_of::<Bounds>() as u64)?;
        buffers.ensure(device, Resource::Sums, objects * size_of::<ObjectSums>() as u64)?;
        buffers.ensure(device, Resource::Counters, size_of::<Counters>() as u64)?;
        buffers.ensure(device, Resource::SunCounters, size_of::<Counters>() as u64)?;
        let texels = if shadow { u64::from(list.shadow_map_size).pow(2) } else { 0 };
        let header = size_of::<abi::SunView>() as u64;
        buffers.ensure(device, Resource::ShadowMap, header + texels * 4)?;
        // About half of the triangles of closed surfaces face away.
        for (room, triangles) in self.room.primitives.iter_mut().zip(packed.triangles) {
            *room = (*room).max(u64::from(triangles) / 2 + 4096);
        }
        let triangles = u64::from(packed.triangles.into_iter().max().unwrap_or(0));
        buffers.ensure(device, Resource::Crossing, triangles * 4)?;
        self.room.entries = self.room.entries.max(triangles * 2 + u64::from(LARGE_ROOM) * 4);
        Ok(())
    }
}
