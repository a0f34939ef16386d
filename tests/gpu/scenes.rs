//! Draw lists of the presets, small.

use std::sync::Arc;

use figurant_core::base::lens::Lens;
use figurant_core::document::{file, presets};
use figurant_core::draw::{Cast, DrawOptions, Drawn, draw};
use figurant_core::job::catalogue;
use figurant_core::library::Library;
use figurant_core::sampling::Sampler;
use figurant_core::scene::{Camera, Scene};

/// What scenes are sampled and drawn from.
pub struct Source {
    library: Library,
    cast: Cast,
}

impl Source {
    pub fn new() -> Self {
        Self { library: Library::new(&[], 1024).unwrap(), cast: Cast::default() }
    }

    /// A frame of a preset in a picture of this size.
    pub fn drawn(&self, preset: &str, frame: u32, size: u32, samples: u32) -> (Scene, Drawn) {
        self.drawn_through(preset, frame, size, samples, None)
    }

    /// As [`Self::drawn`], through a lens.
    pub fn drawn_through(
        &self,
        preset: &str,
        frame: u32,
        size: u32,
        samples: u32,
        lens: Option<Lens>,
    ) -> (Scene, Drawn) {
        self.drawn_with(preset, frame, size, samples, |camera| camera.distortion = lens)
    }

    /// As [`Self::drawn`], of a camera that is another in something.
    pub fn drawn_with(
        &self,
        preset: &str,
        frame: u32,
        size: u32,
        samples: u32,
        change: impl FnOnce(&mut Camera),
    ) -> (Scene, Drawn) {
        let mut document = file::parse(presets::find(preset).unwrap().text).unwrap();
        (document.image.width, document.image.height) = (size, size);
        let sampler = Sampler::new(Arc::new(document), catalogue(&self.library)).unwrap();
        let mut scene = sampler.scene(frame);
        change(&mut scene.camera);
        let options = DrawOptions {
            raster: true,
            shading: true,
            samples,
            shadow_map_size: 2048,
            lod_error_px: 0.25,
        };
        let drawn = draw(&scene, &self.library, &self.cast, &options).unwrap();
        (scene, drawn)
    }
}
