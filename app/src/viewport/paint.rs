//! Pictures as textures of the window. Those of the graphics engine are on its device already.

use std::sync::Arc;

use eframe::egui::{
    Color32, ColorImage, Context, TextureFilter, TextureHandle, TextureId, TextureOptions,
};
use eframe::egui_wgpu::RenderState;
use figurant_core::label::Annotations;
use wgpu::FilterMode;

use super::worker::{Pixels, Shown};
use crate::overlay::instance_color;

/// Opacity of a mask's tint.
const TINT: u8 = 105;

/// The textures of the picture in view and of the masks over it.
#[derive(Default)]
pub struct Screen {
    render: Option<RenderState>,
    /// Kept so that its pixels stay untouched for as long as they are drawn.
    shown: Option<(Arc<Shown>, bool)>,
    host: Option<TextureHandle>,
    device: Option<TextureId>,
    masks: Option<(Arc<Shown>, TextureHandle)>,
}

impl Screen {
    /// Draws by a window's device; without one only pictures in memory are drawn.
    #[must_use]
    pub fn new(render: Option<RenderState>) -> Self {
        Self { render, ..Self::default() }
    }

    /// The texture of a picture; `sharp` shows its pixels as squares.
    pub fn picture(&mut self, ctx: &Context, shown: &Arc<Shown>, sharp: bool) -> Option<TextureId> {
        let same =
            |(old, was_sharp): &(Arc<Shown>, bool)| Arc::ptr_eq(old, shown) && *was_sharp == sharp;
        if !self.shown.as_ref().is_some_and(same) {
            self.upload(ctx, shown, sharp);
            self.shown = Some((Arc::clone(shown), sharp));
        }
        match &shown.pixels {
            Pixels::Host(_) => self.host.as_ref().map(TextureHandle::id),
            Pixels::Device(_) => self.device,
        }
    }

    fn upload(&mut self, ctx: &Context, shown: &Shown, sharp: bool) {
        match &shown.pixels {
            Pixels::Host(image) => {
                let magnification =
                    if sharp { TextureFilter::Nearest } else { TextureFilter::Linear };
                let options = TextureOptions { magnification, ..TextureOptions::LINEAR };
                match &mut self.host {
                    Some(texture) => texture.set(Arc::clone(image), options),
                    None => {
                        let texture = ctx.load_texture("picture", Arc::clone(image), options);
                        self.host = Some(texture);
                    }
                }
            }
            Pixels::Device(picture) => {
                let Some(RenderState { device, renderer, .. }) = &self.render else { return };
                let view = picture.texture.create_view(&wgpu::TextureViewDescriptor::default());
                let sampler = wgpu::SamplerDescriptor {
                    label: Some("picture"),
                    mag_filter: if sharp { FilterMode::Nearest } else { FilterMode::Linear },
                    min_filter: FilterMode::Linear,
                    ..wgpu::SamplerDescriptor::default()
                };
                let mut renderer = renderer.write();
                match self.device {
                    Some(id) => renderer
                        .update_egui_texture_from_wgpu_texture_with_sampler_options(
                            device, &view, sampler, id,
                        ),
                    None => {
                        self.device =
                            Some(renderer.register_native_texture_with_sampler_options(
                                device, &view, sampler,
                            ));
                    }
                }
            }
        }
    }

    /// The texture of a picture's masks, if it has any.
    pub fn masks(&mut self, ctx: &Context, shown: &Arc<Shown>) -> Option<TextureId> {
        if !self.masks.as_ref().is_some_and(|(old, _)| Arc::ptr_eq(old, shown)) {
            let image = masks(&shown.annotations)?;
            let options = TextureOptions::NEAREST;
            let texture = match self.masks.take() {
                Some((_, mut texture)) => {
                    texture.set(image, options);
                    texture
                }
                None => ctx.load_texture("masks", image, options),
            };
            self.masks = Some((Arc::clone(shown), texture));
        }
        self.masks.as_ref().map(|(_, texture)| texture.id())
    }
}

/// Each person's pixels in their colour, all others clear.
fn masks(labels: &Annotations) -> Option<ColorImage> {
    let tint = |id: &u16| {
        let [r, g, b] = instance_color(*id);
        if *id == 0 { Color32::TRANSPARENT } else { Color32::from_rgba_unmultiplied(r, g, b, TINT) }
    };
    let pixels = labels.instance_ids.as_ref()?.iter().map(tint).collect();
    let size = [labels.width, labels.height].map(|side| side as usize);
    Some(ColorImage::new(size, pixels))
}
