//! Materials and the textures they name: each texture stands once in a draw list.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{DrawError, DrawList, abi};
use crate::geometry::surface::{Detail, Mask, Relief, Surface};
use crate::library::Library;
use crate::library::figure::NEUTRAL_TINT;
use crate::library::texture::Texture;
use crate::scene;

/// Normals of folded cloth.
const FOLDS: &str = "normal/detail/folds";
/// Strength of the relief of cloth that has its own, and of the light that its hollows lack.
const WEAVE_STRENGTH: f32 = 0.8;
const HOLLOWS_STRENGTH: f32 = 0.35;

/// How many pixels of the picture a metre must span for what is only seen close up: furrows and
/// freckles, strands, then the folds of cloth (about five pixels to a fold), then its finish.
const SKIN_PX_PER_M: f64 = 200.0;
const FOLDS_PX_PER_M: f64 = 100.0;
const FINISH_PX_PER_M: f64 = 40.0;

/// What has been put into a draw list so far.
#[derive(Default)]
pub struct Surfaces {
    index_of_texture: BTreeMap<String, u32>,
    plain: Option<u32>,
}

impl Surfaces {
    /// A surface for what nobody shades: frames without a picture, and what only casts a shadow.
    pub fn plain(&mut self, list: &mut DrawList) -> u32 {
        *self.plain.get_or_insert_with(|| push(list, abi::Material::default()))
    }

    /// The surface of a wall, floor or occluder.
    pub fn of_object(
        &mut self,
        material: &scene::Material,
        library: &Library,
        list: &mut DrawList,
    ) -> Result<u32, DrawError> {
        let albedo_map = self.optional(material.texture.as_deref(), library, list)?;
        let normal_map = match &material.texture {
            Some(id) if material.normal_strength > 0.0 => self.normal_of(id, library, list)?,
            _ => None,
        };
        let made = abi::Material {
            base_color: material.base_color.map(|c| c as f32),
            albedo_map,
            uv_repeat: material.uv_repeat.map(|c| c as f32),
            hue_offset_deg: material.hue_offset_deg as f32,
            roughness: material.roughness as f32,
            metallic: material.metallic as f32,
            normal_map,
            normal_strength: material.normal_strength as f32,
            ..abi::Material::default()
        };
        Ok(push(list, made))
    }

    /// The surface of a part of a person of whom a metre spans so many pixels.
    pub fn of_person(
        &mut self,
        surface: &Surface,
        px_per_m: f64,
        library: &Library,
        list: &mut DrawList,
    ) -> Result<u32, DrawError> {
        let near = px_per_m > FOLDS_PX_PER_M;
        let close = px_per_m > SKIN_PX_PER_M;
        let figure = &library.figure;
        let mut base_color = surface.base_color;
        let albedo_map = match surface.tint.filter(|_| close) {
            Some(freckles) => {
                base_color = base_color.map(|c| c / NEUTRAL_TINT);
                let id = format!("figure/head_tint/{}", freckles as u8);
                Some(self.shared(&id, list, || Arc::clone(figure.head_tint(freckles))))
            }
            None => self.optional(surface.texture.as_deref(), library, list)?,
        };
        let (detail, uv_repeat) = detail_texture(surface.detail);
        let weave = weave(surface, library).filter(|_| near);
        let aged = surface.detail == Detail::Age && close && surface.detail_strength > 0.0;
        let detail_map = if aged {
            Some(self.shared("figure/head_age", list, || Arc::clone(&figure.head_age()[0])))
        } else {
            self.optional(weave.or(detail), library, list)?
        };
        let finish = surface.finish.as_deref().filter(|_| px_per_m > FINISH_PX_PER_M);
        let mask = match surface.mask {
            Mask::None => None,
            Mask::Head(scalp, beard) => {
                let id = format!("figure/head_mask/{}/{}", scalp as u8, beard as u8);
                Some(self.shared(&id, list, || Arc::clone(figure.head_mask(scalp, beard))))
            }
            Mask::Body => {
                Some(self.shared("figure/body_mask", list, || Arc::clone(figure.body_mask())))
            }
            // Too fine to be seen from afar.
            Mask::Sewn(_) if !near => None,
            Mask::Sewn(kind) => {
                let id = format!("figure/sewn/{}", kind as u8);
                Some(self.shared(&id, list, || Arc::clone(figure.sewn_mask(kind))))
            }
            Mask::Eye => {
                Some(self.shared("figure/eye_mask", list, || Arc::clone(figure.eye_mask())))
            }
        };
        let (normal_map, normal_strength) = if aged {
            let normals = || Arc::clone(&figure.head_age()[1]);
            (Some(self.shared("figure/head_normals", list, normals)), surface.relief_strength)
        } else if near && surface.relief_strength > 0.0 {
            self.relief(surface, library, list)?
        } else {
            (None, 0.0)
        };
        let made = abi::Material {
            base_color,
            albedo_map,
            normal_map,
            normal_strength,
            detail_map,
            finish_map: self.optional(finish, library, list)?,
            detail_strength: weave.map_or(surface.detail_strength, |_| HOLLOWS_STRENGTH),
            uv_repeat: uv_repeat.map(|n| n * surface.repeat),
            hue_offset_deg: surface.hue_offset_deg,
            roughness: surface.roughness,
            mask,
            layers: surface.layers,
            wrap: surface.wrap,
            ..abi::Material::default()
        };
        Ok(push(list, made))
    }

    /// The normal map of cloth or hair, and its strength.
    fn relief(
        &mut self,
        surface: &Surface,
        library: &Library,
        list: &mut DrawList,
    ) -> Result<(Option<u32>, f32), DrawError> {
        let of = match surface.relief {
            Relief::Cloth => surface.texture.as_deref(),
            Relief::Detail => detail_texture(surface.detail).0,
        };
        let of = weave(surface, library).or(of);
        let own = of.and_then(|id| library.textures.normal_map(id));
        let (id, strength) = match (&own, surface.relief) {
            (Some(id), Relief::Cloth) => (Some(id.as_str()), WEAVE_STRENGTH),
            (None, Relief::Cloth) => (Some(FOLDS), surface.relief_strength),
            (own, Relief::Detail) => (own.as_deref(), surface.relief_strength),
        };
        Ok((self.optional(id, library, list)?, strength))
    }

    fn optional(
        &mut self,
        id: Option<&str>,
        library: &Library,
        list: &mut DrawList,
    ) -> Result<Option<u32>, DrawError> {
        id.map(|id| self.named(id, library, list)).transpose()
    }

    fn named(
        &mut self,
        id: &str,
        library: &Library,
        list: &mut DrawList,
    ) -> Result<u32, DrawError> {
        if let Some(&index) = self.index_of_texture.get(id) {
            return Ok(index);
        }
        let texture = library.textures.get(id)?;
        Ok(self.shared(id, list, || texture))
    }

    /// The normal map that belongs to an albedo texture, if the library has one.
    fn normal_of(
        &mut self,
        id: &str,
        library: &Library,
        list: &mut DrawList,
    ) -> Result<Option<u32>, DrawError> {
        let normal_id = library.textures.normal_map(id);
        self.optional(normal_id.as_deref(), library, list)
    }

    fn shared(&mut self, id: &str, list: &mut DrawList, get: impl FnOnce() -> Arc<Texture>) -> u32 {
        *self.index_of_texture.entry(id.to_owned()).or_insert_with(|| {
            list.textures.push(get());
            list.textures.len() as u32 - 1
        })
    }
}

/// How a surface's cloth is woven, where its pattern does not say so.
fn weave<'a>(surface: &'a Surface, library: &Library) -> Option<&'a str> {
    let pattern = surface.texture.as_deref();
    let own = pattern.is_some_and(|id| library.textures.normal_map(id).is_some());
    surface.weave.as_deref().filter(|_| !own)
}

/// Texture of a fine structure, and how often it repeats over 0..1. Cloth patterns share its
/// repeats; skin and hair have none.
const fn detail_texture(detail: Detail) -> (Option<&'static str>, [f32; 2]) {
    match detail {
        Detail::None | Detail::Age => (None, [1.0; 2]),
        Detail::Skin => (Some("detail/skin"), [8.0; 2]),
        Detail::Cloth => (Some("detail/cloth"), [1.0; 2]),
        Detail::Hair => (Some("detail/hair"), [4.0; 2]),
        Detail::Curls => (Some("detail/curls"), [4.0; 2]),
    }
}

fn push(list: &mut DrawList, material: abi::Material) -> u32 {
    list.materials.push(material);
    list.materials.len() as u32 - 1
}
