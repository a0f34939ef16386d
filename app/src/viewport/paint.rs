//! Pictures as textures of the window. Those of the graphics engine are on its device already.

use std::sync::Arc;

use eframe::egui::{
    Color32, ColorImage, Context, Painter, Rect, TextureHandle, TextureId, TextureOptions, pos2,
};
use eframe::egui_wgpu::RenderState;
use figurant_core::label::Annotations;

use super::quad::Quad;
use super::worker::{Pixels, Shown};
use crate::overlay::instance_color;
use crate::theme;

/// All of a texture.
pub const WHOLE: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(1.0, 1.0) };
/// Opacity of a mask's tint.
const TINT: u8 = 105;

/// The picture in view and the masks over it, as textures.
#[derive(Default)]
pub struct Screen {
    quad: Option<Quad>,
    /// Kept so that its pixels stay untouched for as long as they are drawn.
    shown: Option<(Arc<Shown>, bool)>,
    /// The picture where there is no device of a window.
    plain: Option<TextureHandle>,
    masks: Option<(Arc<Shown>, TextureHandle)>,
}

impl Screen {
    /// Draws by a window's device; without one only pictures in memory are drawn.
    #[must_use]
    pub fn new(render: Option<RenderState>) -> Self {
        Self { quad: render.map(Quad::new), ..Self::default() }
    }

    /// Fills the painter's part of the screen with a picture at a place; `sharp` shows its pixels as squares.
    pub fn picture(&mut self, painter: &Painter, shown: &Arc<Shown>, place: Rect, sharp: bool) {
        let same =
            |(old, was_sharp): &(Arc<Shown>, bool)| Arc::ptr_eq(old, shown) && *was_sharp == sharp;
        if !self.shown.as_ref().is_some_and(same) {
            self.take(painter.ctx(), shown, sharp);
            self.shown = Some((Arc::clone(shown), sharp));
        }
        match (&self.quad, &self.plain) {
            (Some(quad), _) => {
                if let Some(callback) = quad.callback(place, painter.clip_rect()) {
                    painter.add(callback);
                }
            }
            (None, Some(texture)) => {
                painter.rect_filled(painter.clip_rect(), 0.0, theme::VOID);
                painter.image(texture.id(), place, WHOLE, Color32::WHITE);
            }
            (None, None) => {}
        }
    }

    fn take(&mut self, ctx: &Context, shown: &Shown, sharp: bool) {
        match (&shown.pixels, &mut self.quad) {
            (Pixels::Device(picture), Some(quad)) => quad.show(&picture.texture, sharp),
            (Pixels::Host(image), Some(quad)) => quad.upload(image, sharp),
            (Pixels::Host(image), None) => {
                let options = if sharp { TextureOptions::NEAREST } else { TextureOptions::LINEAR };
                self.plain = Some(ctx.load_texture("picture", Arc::clone(image), options));
            }
            (Pixels::Device(_), None) => {}
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
