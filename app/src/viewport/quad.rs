//! The picture drawn by the window's device: one rectangle by a shader that does nothing else.

use eframe::egui::{ColorImage, PaintCallback, PaintCallbackInfo, Rect};
use eframe::egui_wgpu::{
    Callback, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor,
};
use wgpu::{BindingResource, CommandBuffer, CommandEncoder, Device, FilterMode, Queue, RenderPass};

use crate::theme;

const SHADER: &str = include_str!("../../../shaders/picture.wgsl");

/// What draws pictures on a window's device.
pub struct Quad {
    state: RenderState,
    pipeline: wgpu::RenderPipeline,
    /// Where the pane lies on the picture, and what is around it.
    part: wgpu::Buffer,
    /// A picture that came from memory.
    host: Option<wgpu::Texture>,
    group: Option<wgpu::BindGroup>,
}

impl Quad {
    /// For a window.
    #[must_use]
    pub fn new(state: RenderState) -> Self {
        let device = &state.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("picture"),
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let linear = f64::from(state.target_format.is_srgb());
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("picture"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("pixel"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &[("LINEAR", linear)],
                    ..wgpu::PipelineCompilationOptions::default()
                },
                targets: &[Some(state.target_format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let part = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("part of the picture"),
            size: 32,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { state, pipeline, part, host: None, group: None }
    }

    /// Takes a picture from memory.
    pub fn upload(&mut self, image: &ColorImage, sharp: bool) {
        let [width, height] = image.size.map(|side| side as u32);
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let make = || {
            self.state.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("picture"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba8Unorm,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            })
        };
        let texture = self.host.take().filter(|t| t.size() == size).unwrap_or_else(make);
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(width * 4),
            rows_per_image: None,
        };
        self.state.queue.write_texture(texture.as_image_copy(), image.as_raw(), layout, size);
        self.show(&texture, sharp);
        self.host = Some(texture);
    }

    /// Shows a picture that is on the device; `sharp` shows its pixels as squares.
    pub fn show(&mut self, picture: &wgpu::Texture, sharp: bool) {
        let device = &self.state.device;
        let view = picture.create_view(&wgpu::TextureViewDescriptor::default());
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("picture"),
            mag_filter: if sharp { FilterMode::Nearest } else { FilterMode::Linear },
            min_filter: FilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        self.group = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                entry(0, self.part.as_entire_binding()),
                entry(1, BindingResource::TextureView(&view)),
                entry(2, BindingResource::Sampler(&sampler)),
            ],
        }));
    }

    /// Draws a pane with the picture, which lies at `whole`, in it; points.
    #[must_use]
    pub fn callback(&self, whole: Rect, pane: Rect) -> Option<PaintCallback> {
        let group = self.group.clone().filter(|_| pane.is_positive())?;
        let low = (pane.min - whole.min) / whole.size();
        let high = (pane.max - whole.min) / whole.size();
        let [r, g, b, a] = theme::VOID.to_normalized_gamma_f32();
        let part = [low.x, low.y, high.x, high.y, r, g, b, a];
        let draw = Draw { pipeline: self.pipeline.clone(), group, buffer: self.part.clone(), part };
        Some(Callback::new_paint_callback(pane, draw))
    }
}

/// One drawing of the picture.
struct Draw {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    buffer: wgpu::Buffer,
    part: [f32; 8],
}

impl CallbackTrait for Draw {
    fn prepare(
        &self,
        _: &Device,
        queue: &Queue,
        _: &ScreenDescriptor,
        _: &mut CommandEncoder,
        _: &mut CallbackResources,
    ) -> Vec<CommandBuffer> {
        let bytes = self.part.map(f32::to_ne_bytes);
        queue.write_buffer(&self.buffer, 0, bytes.as_flattened());
        Vec::new()
    }

    fn paint(&self, _: PaintCallbackInfo, pass: &mut RenderPass<'static>, _: &CallbackResources) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..4, 0..1);
    }
}
