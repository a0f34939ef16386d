//! Buffers of frames whose light is kept: for light that leaves its pixel.

use super::abi::{LAYER_WORDS, LIGHT_OF_PIXELS, SQUARE, Step};
use super::buffers::Buffers;
use super::device::Device;
use super::stage::Resource;
use crate::draw::DrawList;
use crate::engine::EngineError;
use crate::engine::optics::{
    bloom_levels, blur_level, blurs, keeps_light, level_size, moves, scatters, way_tile,
};
use crate::plan::PassPlan;

/// What is known of them.
#[derive(Default)]
pub struct Optics {
    /// Between the levels of scattered light, from the light of pixels on.
    pub steps: Vec<Step>,
}

impl Optics {
    /// Makes room for a frame.
    pub fn make_room(
        &mut self,
        device: &Device,
        buffers: &mut Buffers,
        list: &DrawList,
        plan: &PassPlan,
    ) -> Result<(), EngineError> {
        self.steps.clear();
        if !keeps_light(list, plan) {
            return Ok(());
        }
        let size = [list.view.width, list.view.height];
        let texels = |[w, h]: [u32; 2]| u64::from(w) * u64::from(h);
        buffers.ensure(device, Resource::Light, texels(size) * 8)?;
        if let Some(defocus) = blurs(list, plan) {
            let layer = level_size(size, blur_level(&defocus));
            let words = u64::from(LAYER_WORDS);
            buffers.ensure(device, Resource::Layers, texels(layer) * words * 4)?;
            let squares = layer.map(|side| side.div_ceil(SQUARE));
            buffers.ensure(device, Resource::Widest, texels(squares) * 8)?;
            buffers.ensure(device, Resource::Gathered, texels(layer) * 16)?;
        }
        if let Some(shutter) = moves(list, plan) {
            buffers.ensure(device, Resource::Ways, texels(size) * 8)?;
            let tiles = size.map(|side| side.div_ceil(way_tile(&shutter)));
            buffers.ensure(device, Resource::Longest, texels(tiles) * 8)?;
            buffers.ensure(device, Resource::DrawnOut, texels(size) * 8)?;
        }
        let mut scattered = 0;
        if scatters(list, plan).is_some() {
            let (mut larger_first, mut larger_size) = (LIGHT_OF_PIXELS, size);
            for smaller_size in bloom_levels(size) {
                let smaller_first = scattered as u32;
                let step = Step {
                    larger_first,
                    smaller_first,
                    larger_size,
                    smaller_size,
                    ..Step::default()
                };
                self.steps.push(step);
                (larger_first, larger_size) = (smaller_first, smaller_size);
                scattered += texels(smaller_size);
            }
        }
        buffers.ensure(device, Resource::Scattered, scattered * 8)?;
        buffers.ensure(device, Resource::Step, size_of::<Step>() as u64)?;
        buffers.write(device, Resource::Steps, &self.steps)
    }
}
