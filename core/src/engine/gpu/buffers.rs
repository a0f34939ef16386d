//! The buffers of one engine: each grows when a frame needs more and stays for the next.

use std::collections::BTreeMap;

use super::device::Device;
use super::stage::{Access, Resource, Stage};
use super::variant::Variant;
use crate::engine::EngineError;

/// Bytes that no buffer is smaller than, enough for one record of any kind.
const LEAST: u64 = 1024;

/// Buffers by what they hold, and the bind groups over them.
#[derive(Default)]
pub struct Buffers {
    buffers: BTreeMap<Resource, wgpu::Buffer>,
    groups: BTreeMap<(Stage, Variant), wgpu::BindGroup>,
}

impl Buffers {
    /// Makes a buffer hold so many bytes at least. What it held is lost if it grows.
    pub fn ensure(
        &mut self,
        device: &Device,
        resource: Resource,
        bytes: u64,
    ) -> Result<&wgpu::Buffer, EngineError> {
        let limit = device.largest_buffer();
        if bytes > limit {
            return Err(EngineError::TooLarge { what: name(resource), got: bytes, limit });
        }
        if self.buffers.get(&resource).is_none_or(|b| b.size() < bytes) {
            let room = (bytes + bytes / 4).next_multiple_of(256).max(LEAST).min(limit);
            let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(name(resource)),
                size: room,
                usage: usages(resource),
                mapped_at_creation: false,
            });
            self.put(resource, buffer);
        }
        Ok(&self.buffers[&resource])
    }

    /// Uses a buffer of somebody else's.
    pub fn put(&mut self, resource: Resource, buffer: wgpu::Buffer) {
        if self.buffers.get(&resource) != Some(&buffer) {
            self.buffers.insert(resource, buffer);
            self.groups.clear();
        }
    }

    /// Makes bind groups anew, as pipelines were.
    pub fn forget_groups(&mut self) {
        self.groups.clear();
    }

    /// Makes a buffer hold some records, if only one that nobody reads.
    pub fn write<T: bytemuck::Pod>(
        &mut self,
        device: &Device,
        resource: Resource,
        records: &[T],
    ) -> Result<(), EngineError> {
        let bytes: &[u8] = bytemuck::cast_slice(records);
        let buffer = self.ensure(device, resource, bytes.len() as u64)?;
        device.queue.write_buffer(buffer, 0, bytes);
        Ok(())
    }

    /// A buffer that was made before.
    pub fn get(&self, resource: Resource) -> &wgpu::Buffer {
        &self.buffers[&resource]
    }

    /// The bind group of a stage.
    pub fn group(
        &mut self,
        device: &mut Device,
        stage: Stage,
        variant: Variant,
    ) -> &wgpu::BindGroup {
        let variant = variant.of(stage);
        let buffers = &self.buffers;
        self.groups.entry((stage, variant)).or_insert_with(|| {
            let entries: Vec<_> = (0..)
                .zip(stage.bindings())
                .map(|(binding, (resource, _))| wgpu::BindGroupEntry {
                    binding,
                    resource: buffers[resource].as_entire_binding(),
                })
                .collect();
            let layout = device.pipeline(stage, variant).get_bind_group_layout(0);
            device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(stage.name()),
                layout: &layout,
                entries: &entries,
            })
        })
    }
}

/// What a buffer may be used for.
fn usages(resource: Resource) -> wgpu::BufferUsages {
    let uniform = Stage::ALL
        .iter()
        .flat_map(|s| s.bindings())
        .any(|(r, access)| *r == resource && *access == Access::Uniform);
    let mut usages =
        wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
    if uniform {
        usages |= wgpu::BufferUsages::UNIFORM;
    }
    usages
}

/// What to call a buffer where it is too large.
const fn name(resource: Resource) -> &'static str {
    match resource {
        Resource::Frame | Resource::Target | Resource::SunTarget | Resource::Plane => {
            "graphics memory of the frame"
        }
        Resource::VertexBatches | Resource::Vertices | Resource::Screen => {
            "graphics memory of vertices"
        }
        Resource::Batches | Resource::SunBatches => "graphics memory of the list of triangles",
        Resource::Meshes => "graphics memory of meshes",
        Resource::Texels => "graphics memory of textures",
        Resource::Palette => "graphics memory of joints",
        Resource::Surfaces => "graphics memory of materials",
        Resource::Lights | Resource::Blockers => "graphics memory of lights",
        Resource::Primitives | Resource::SunPrimitives => "graphics memory of visible triangles",
        Resource::Counters | Resource::SunCounters => "graphics memory of counters",
        Resource::Crossing => "graphics memory of triangles to be cut",
        Resource::Bounds | Resource::Sums => "graphics memory of objects",
        Resource::Tiles | Resource::Lists => "graphics memory of tiles",
        Resource::Samples => "graphics memory of samples",
        Resource::ShadowMap | Resource::SunView => "graphics memory of the shadow map",
        Resource::Picture | Resource::Resolved => "graphics memory of the picture",
        Resource::Light
        | Resource::Layers
        | Resource::Widest
        | Resource::Gathered
        | Resource::Ways
        | Resource::Longest
        | Resource::DrawnOut
        | Resource::Scattered
        | Resource::Steps
        | Resource::Step => "graphics memory of light that spreads over the picture",
        Resource::Squares | Resource::Places | Resource::Rays => "graphics memory of the lens",
    }
}
