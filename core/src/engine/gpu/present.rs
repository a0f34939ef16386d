//! Present: pictures stay on a device that somebody else opened and shows them on.
//!
//! `present.wgsl` moves the picture from the buffer that shading writes to a texture; nothing of it
//! passes through the host. A texture is used again once nobody holds it any more.

use std::sync::{Arc, Mutex, PoisonError};

use super::adapter::{GpuError, is_hardware};
use super::buffers::Buffers;
use super::device::Device;
use super::reload::ShaderFolder;
use super::stage::Resource;
use crate::engine::EngineError;

/// The shader's text: what stages share, then its own.
const SOURCE: &str = concat!(
    include_str!("../../../../shaders/shared/abi.wgsl"),
    include_str!("../../../../shaders/present.wgsl")
);
/// Side of the shader's workgroups, pixels.
const GROUP: u32 = 8;

/// A device that somebody else opened, such as a window's.
#[derive(Clone, Debug)]
pub struct GpuContext {
    /// Name of the adapter.
    pub name: String,
    /// Whether it is a graphics processor and not a program that pretends to be one.
    pub hardware: bool,
    /// The device, best opened by [`Self::descriptor`].
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Shaders in place of the program's own, read anew whenever they change.
    pub shaders: Option<ShaderFolder>,
}

impl GpuContext {
    /// An open device of an adapter.
    ///
    /// # Errors
    /// When it has too little for the engine's shaders.
    pub fn new(
        adapter: &wgpu::Adapter,
        device: wgpu::Device,
        queue: wgpu::Queue,
    ) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let (has, least) = (device.limits(), wgpu::Limits::defaults());
        let enough = info.backend != wgpu::Backend::Gl
            && has.max_storage_buffers_per_shader_stage
                >= least.max_storage_buffers_per_shader_stage
            && has.max_compute_invocations_per_workgroup
                >= least.max_compute_invocations_per_workgroup
            && has.max_storage_buffer_binding_size >= least.max_storage_buffer_binding_size;
        if !enough {
            let reason = "its interface has less than WebGPU's least for compute shaders";
            return Err(GpuError::Refused { adapter: info.name, reason: reason.to_owned() });
        }
        Ok(Self { hardware: is_hardware(&info), name: info.name, device, queue, shaders: None })
    }

    /// What to ask an adapter for, so that an engine can use all of it.
    #[must_use]
    pub fn descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
        wgpu::DeviceDescriptor {
            label: Some("figurant"),
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: adapter.limits(),
            ..Default::default()
        }
    }
}

/// A picture on a device.
#[derive(Debug)]
pub struct GpuPicture {
    /// `Rgba8Unorm` that holds sRGB, opaque. Can be bound and copied from.
    pub texture: wgpu::Texture,
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
}

/// Where an engine leaves the picture that it made last.
#[derive(Clone, Debug, Default)]
pub struct GpuPictures(Arc<Mutex<Option<Arc<GpuPicture>>>>);

impl GpuPictures {
    /// The picture of the frame that was rendered last, if it was wanted as a texture and nobody
    /// took it yet.
    #[must_use]
    pub fn take(&self) -> Option<Arc<GpuPicture>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn put(&self, picture: Arc<GpuPicture>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(picture);
    }
}

/// Fills textures with pictures.
pub struct Presenter {
    /// Where they go.
    pub pictures: GpuPictures,
    pipeline: wgpu::ComputePipeline,
    kept: Vec<Arc<GpuPicture>>,
    /// What is being filled.
    current: Option<Arc<GpuPicture>>,
}

impl Presenter {
    /// On one device.
    pub fn new(device: &Device) -> Self {
        let module = device.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("present"),
            source: wgpu::ShaderSource::Wgsl(SOURCE.into()),
        });
        let pipeline = device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("present"),
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        Self { pictures: GpuPictures::default(), pipeline, kept: Vec::new(), current: None }
    }

    /// Begins a picture of so many pixels, in a texture that nobody looks at.
    pub fn begin(&mut self, device: &Device, [width, height]: [u32; 2]) -> Result<(), EngineError> {
        self.current = None;
        let limit = device.limits.max_texture_dimension_2d;
        if width.max(height) > limit {
            let (what, got) = ("side of a picture that is shown", width.max(height).into());
            return Err(EngineError::TooLarge { what, got, limit: limit.into() });
        }
        self.kept.retain(|p| [p.width, p.height] == [width, height]);
        if let Some(free) = self.kept.iter().find(|p| Arc::strong_count(p) == 1) {
            self.current = Some(Arc::clone(free));
            return Ok(());
        }
        let texture = device.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let picture = Arc::new(GpuPicture { texture, width, height });
        self.kept.push(Arc::clone(&picture));
        self.current = Some(picture);
        Ok(())
    }

    /// Records the move of a band of so many rows, which [`Resource::Target`] describes.
    pub fn record(
        &self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        buffers: &Buffers,
        rows: u32,
    ) {
        let Some(picture) = &self.current else { return };
        let view = picture.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("present"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                entry(1, buffers.get(Resource::Target).as_entire_binding()),
                entry(2, buffers.get(Resource::Picture).as_entire_binding()),
                entry(3, wgpu::BindingResource::TextureView(&view)),
            ],
        });
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("present"),
            timestamp_writes: None,
        });
        pass.set_bind_group(0, &group, &[]);
        pass.set_pipeline(&self.pipeline);
        pass.dispatch_workgroups(picture.width.div_ceil(GROUP), rows.div_ceil(GROUP), 1);
    }

    /// Hands the picture on, if one was begun.
    pub fn finish(&mut self) {
        if let Some(picture) = self.current.take() {
            self.pictures.put(picture);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wgpu::naga::front::wgsl;
    use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

    #[test]
    fn the_shader_is_valid() {
        let module =
            wgsl::parse_str(SOURCE).unwrap_or_else(|e| panic!("{}", e.emit_to_string(SOURCE)));
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        validator.validate(&module).unwrap_or_else(|e| panic!("{}", e.emit_to_string(SOURCE)));
        assert_eq!(module.entry_points[0].workgroup_size, [GROUP, GROUP, 1]);
    }
}
