//! Record: the passes of a frame as commands, each stage in a pass of its own.

use std::time::Duration;

use super::abi::{BATCHES_ACROSS, Frame, Step, SunView, TILE, Target};
use super::buffers::Buffers;
use super::device::Device;
use super::stage::{Resource, Stage};
use super::variant::{Variant, pixels_of_lane};
use crate::engine::optics::level_size;
use crate::plan::{Pass, PassPlan, StageTimes};

/// What the device's clock says at the start and end of each stage.
pub struct Clock {
    queries: wgpu::QuerySet,
    /// Where it is read from.
    pub resolved: wgpu::Buffer,
    /// Stages in the order of their queries.
    stages: Vec<Stage>,
    ns_per_tick: f32,
}

impl Clock {
    /// Of one device.
    pub fn new(device: &Device) -> Self {
        let count = 2 * Stage::ALL.len() as u32;
        let queries = device.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("clock"),
            ty: wgpu::QueryType::Timestamp,
            count,
        });
        let resolved = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("clock"),
            size: u64::from(count) * 8,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let ns_per_tick = device.queue.get_timestamp_period();
        Self { queries, resolved, stages: Vec::new(), ns_per_tick }
    }

    /// Counts the time of the device by stage; the rest of the wait is waiting.
    pub fn report(&self, ticks: &[u64], waited: Duration, times: &mut StageTimes) {
        let mut rest = waited;
        for (stage, ticks) in self.stages.iter().zip(ticks.as_chunks::<2>().0) {
            let ns = ticks[1].saturating_sub(ticks[0]) as f32 * self.ns_per_tick;
            let time = Duration::from_nanos(ns as u64).min(rest);
            rest -= time;
            times.add(stage.name(), time);
        }
        times.add("wait for the device", rest);
    }
}

/// Records the commands of one band.
pub struct Recorder<'a> {
    pub device: &'a mut Device,
    pub buffers: &'a mut Buffers,
    pub clock: Option<&'a mut Clock>,
    pub encoder: &'a mut wgpu::CommandEncoder,
    pub variant: Variant,
    /// Whether the picture lies behind a lens.
    pub lens: bool,
    pub target: &'a Target,
    /// Whether light is kept, to be developed by the pixel.
    pub keeps: bool,
    /// Triangles of the picture before culling.
    pub triangles: u32,
}

/// Workgroups of a stage.
type Groups = [u32; 3];

/// Workgroups that share the triangles to be cut, of which there are few.
const CLIPPERS: Groups = [16, 1, 1];
/// Workgroups that share the larger triangles of the sun's map.
const SHADOW_GROUPS: Groups = [256, 1, 1];

/// Side of the workgroups that look at whole pictures.
const SIDE: u32 = 8;

/// Pixels of a strip of `reduce.wgsl`, times the strips of a workgroup.
const REDUCE_WIDTH: u32 = 64;
/// Rows of a workgroup of `reduce.wgsl`.
const REDUCE_ROWS: u32 = 32;

impl Recorder<'_> {
    /// Begins a band.
    pub fn start(&mut self) {
        if let Some(clock) = &mut self.clock {
            clock.stages.clear();
        }
    }

    /// Ends a band.
    pub fn finish(&mut self) {
        if let Some(clock) = &self.clock {
            let queries = 0..2 * clock.stages.len() as u32;
            self.encoder.resolve_query_set(&clock.queries, queries, &clock.resolved, 0);
        }
    }

    /// Places all vertices and sets up the picture's triangles.
    pub fn geometry(&mut self) {
        for resource in
            [Resource::Counters, Resource::SunCounters, Resource::Bounds, Resource::Sums]
        {
            self.encoder.clear_buffer(self.buffers.get(resource), 0, None);
        }
        self.run(Stage::Skin, batches(self.target.vertex_batch_count));
        self.run(Stage::Setup, batches(self.target.batch_count));
        self.run(Stage::Clip, CLIPPERS);
    }

    /// Fits and fills the sun's map.
    pub fn shadow(&mut self, batch_count: u32) {
        let vertex_batches = batches(self.target.vertex_batch_count);
        self.run(Stage::Bound, vertex_batches);
        self.encoder.clear_buffer(self.buffers.get(Resource::ShadowMap), 0, None);
        self.run(Stage::Fit, [1; 3]);
        self.run(Stage::Project, vertex_batches);
        self.run(Stage::SunSetup, batches(batch_count));
        self.run(Stage::SunClip, CLIPPERS);
        self.run(Stage::Shadow, SHADOW_GROUPS);
        let [map, view] = [Resource::ShadowMap, Resource::SunView].map(|r| self.buffers.get(r));
        self.encoder.copy_buffer_to_buffer(map, 0, view, 0, Some(size_of::<SunView>() as u64));
    }

    /// Finds what the band's samples show.
    pub fn visibility(&mut self) {
        let walkers = walkers(self.triangles);
        self.encoder.clear_buffer(self.buffers.get(Resource::Tiles), 0, None);
        // The count of large primitives, which differs from band to band.
        self.encoder.clear_buffer(self.buffers.get(Resource::Counters), 4, Some(4));
        self.run(Stage::Count, walkers);
        self.run(Stage::Scan, [1; 3]);
        self.run(Stage::Scatter, walkers);
        let [columns, rows] = self.target.tiles;
        self.run(Stage::Raster, [columns.div_ceil(pixels_of_lane(self.variant.samples)), rows, 1]);
    }

    /// Makes what the plan asks for from the samples.
    pub fn outputs(&mut self, plan: &PassPlan, frame: &Frame) {
        let Target { width, band_height, .. } = *self.target;
        let tiles = [width.div_ceil(TILE), band_height.div_ceil(TILE), 1];
        if plan.runs(Pass::Resolve) {
            self.run(Stage::Resolve, tiles);
        }
        if plan.runs(Pass::Reduce) {
            let strips = [width.div_ceil(REDUCE_WIDTH), band_height.div_ceil(REDUCE_ROWS), 1];
            self.run(Stage::Reduce, strips);
        }
        if plan.runs(Pass::Shade) {
            self.run(if self.keeps { Stage::KeepLight } else { Stage::Shade }, tiles);
            if frame.longest_px > 0.0 {
                self.run(Stage::Way, tiles);
            }
        }
    }

    /// Makes the picture of the light that all bands left.
    pub fn optics(&mut self, plan: &PassPlan, frame: &Frame, steps: &[Step]) {
        let squares = |[w, h]: [u32; 2]| [w.div_ceil(SIDE), h.div_ceil(SIDE), 1];
        let by_four = |[w, h]: [u32; 2]| squares([w.div_ceil(2), h.div_ceil(2)]);
        if plan.runs(Pass::Defocus) && frame.blur_limit_px > 0.0 {
            let layers = squares(level_size(frame.size, frame.blur_halvings));
            self.encoder.clear_buffer(self.buffers.get(Resource::Widest), 0, None);
            self.run(Stage::Split, layers);
            self.run(Stage::Gather, layers);
            self.run(Stage::Compose, squares(frame.size));
        }
        if frame.longest_px > 0.0 {
            let [columns, rows] = frame.size.map(|side| side.div_ceil(frame.way_tile));
            self.run(Stage::Longest, [columns, rows, 1]);
            self.run(Stage::Streak, squares(frame.size));
            let [from, to] = [Resource::DrawnOut, Resource::Light].map(|r| self.buffers.get(r));
            let bytes = u64::from(frame.size[0]) * u64::from(frame.size[1]) * 8;
            self.encoder.copy_buffer_to_buffer(from, 0, to, 0, Some(bytes));
        }
        if plan.runs(Pass::Bloom) {
            for (index, step) in steps.iter().enumerate() {
                self.take_step(index);
                self.run(Stage::Halve, by_four(step.smaller_size));
            }
            for (index, step) in steps.iter().enumerate().skip(1).rev() {
                self.take_step(index);
                self.run(Stage::Widen, by_four(step.larger_size));
            }
        }
        self.run(Stage::Finish, by_four(frame.size));
    }

    /// Puts a step between levels in hand.
    fn take_step(&mut self, index: usize) {
        let [steps, step] = [Resource::Steps, Resource::Step].map(|r| self.buffers.get(r));
        let bytes = size_of::<Step>() as u64;
        self.encoder.copy_buffer_to_buffer(steps, index as u64 * bytes, step, 0, Some(bytes));
    }

    fn run(&mut self, stage: Stage, groups: Groups) {
        if groups.contains(&0) {
            return;
        }
        let stage = if self.lens { stage.behind_lens() } else { stage };
        let timestamp_writes = self.clock.as_mut().map(|clock| {
            let first = 2 * clock.stages.len() as u32;
            clock.stages.push(stage);
            wgpu::ComputePassTimestampWrites {
                query_set: &clock.queries,
                beginning_of_pass_write_index: Some(first),
                end_of_pass_write_index: Some(first + 1),
            }
        });
        let group = self.buffers.group(self.device, stage, self.variant);
        let mut pass = self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(stage.name()),
            timestamp_writes,
        });
        pass.set_bind_group(0, group, &[]);
        pass.set_pipeline(self.device.pipeline(stage, self.variant));
        let [x, y, z] = groups;
        pass.dispatch_workgroups(x, y, z);
        drop(pass);
        if self.device.takes_turns {
            self.rest();
        }
    }

    /// Sends off what was recorded and waits for it, so that others' work comes next. What fails is
    /// heard of when the band is waited for.
    fn rest(&mut self) {
        let device = &self.device.device;
        let next = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let part = std::mem::replace(self.encoder, next);
        let submission_index = Some(self.device.queue.submit([part.finish()]));
        drop(device.poll(wgpu::PollType::Wait { submission_index, timeout: None }));
    }
}

/// One workgroup for each batch.
fn batches(count: u32) -> Groups {
    [count.min(BATCHES_ACROSS), count.div_ceil(BATCHES_ACROSS), 1]
}

/// Invocations that walk a list of so many triangles at most.
fn walkers(triangles: u32) -> Groups {
    [triangles.div_ceil(64).clamp(1, 1024), 1, 1]
}
