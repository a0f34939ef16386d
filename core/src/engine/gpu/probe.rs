//! Probe: what stages leave on the device, read back for those who check them.
//!
//! Frames hold what labels and pictures are made of; whether a vertex was placed where it belongs
//! is seen here. Slow, and no part of rendering.

use super::abi::Vertex;
use super::stage::Resource;
use super::{GpuEngine, State};
use crate::engine::EngineError;
use crate::library::mesh::Normal;

/// A vertex in view space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedVertex {
    /// Metres.
    pub position: [f32; 3],
    /// Unit shading normal.
    pub normal: [f32; 3],
}

impl GpuEngine {
    /// Where the frame that was rendered last placed the vertices of an object of its draw list, in
    /// the order of its mesh; nothing if the object was left out.
    ///
    /// # Errors
    /// When the device fails.
    pub fn placed_vertices(&self, object: u32) -> Result<Vec<PlacedVertex>, EngineError> {
        let state = &self.state;
        let batches = state.packed.vertex_batches.iter().filter(|b| b.object == object);
        let span = batches.fold(None, |span: Option<[u32; 2]>, b| {
            let [low, high] = span.unwrap_or([b.first; 2]);
            Some([low.min(b.first), high.max(b.first + b.count)])
        });
        let Some([low, high]) = span else { return Ok(Vec::new()) };
        let size = size_of::<Vertex>() as u64;
        let bytes = u64::from(low) * size..u64::from(high) * size;
        let bytes = state.read(Resource::Vertices, bytes)?;
        let placed = |v: Vertex| PlacedVertex {
            position: v.position,
            normal: Normal::of_bits(v.normal).unit(),
        };
        Ok(bytemuck::pod_collect_to_vec::<u8, Vertex>(&bytes).into_iter().map(placed).collect())
    }
}

impl State {
    /// Waits for the device and copies a part of a buffer.
    fn read(
        &self,
        resource: Resource,
        bytes: std::ops::Range<u64>,
    ) -> Result<Vec<u8>, EngineError> {
        let device = &self.device;
        let size = bytes.end - bytes.start;
        let staging = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("what is probed"),
            size,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let buffer = self.buffers.get(resource);
        encoder.copy_buffer_to_buffer(buffer, bytes.start, &staging, 0, Some(size));
        device.queue.submit([encoder.finish()]);
        let failed = |reason: String| {
            let adapter = device.name.clone();
            device.fault().err().unwrap_or(EngineError::Driver { adapter, reason })
        };
        // Whether that failed is seen when the range is asked for.
        staging.map_async(wgpu::MapMode::Read, .., |_| ());
        device
            .device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|e| failed(e.to_string()))?;
        let mapped = staging.get_mapped_range(..).map_err(|e| failed(e.to_string()))?;
        Ok(mapped.to_vec())
    }
}
