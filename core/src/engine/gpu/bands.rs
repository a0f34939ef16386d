//! Bands: a picture in parts that fit the device's buffers, each submitted and waited for.
//!
//! Samples are kept of one band at a time. Where light is kept, it is that of the whole picture, which
//! is developed once the last band is there.

use std::time::Instant;

use super::State;
use super::abi::{self, Primitive};
use super::lens;
use super::pack::{self, Packed};
use super::readback::{Band, Counted};
use super::record::Recorder;
use super::stage::{Resource, Stage};
use super::variant::{Light, Variant};
use crate::draw::DrawList;
use crate::engine::EngineError;
use crate::engine::optics::keeps_light;
use crate::plan::{Delivery, Frame, Pass, PassPlan, Skipped, StageTimes};

/// Rows of pixels that a device which takes turns is given at a time.
const ROWS_OF_A_TURN: u64 = 128;

impl State {
    /// Renders band after band; false if there was too little room, of which there is more now.
    pub(super) fn bands(
        &mut self,
        list: &DrawList,
        plan: &PassPlan,
        shadow: bool,
        frame: &mut Frame,
        times: &mut StageTimes,
    ) -> Result<bool, EngineError> {
        let rows = self.band_rows(list)?;
        let keeps = keeps_light(list, plan);
        self.make_room(list, rows, keeps)?;
        self.optics.make_room(&self.device, &mut self.buffers, list, plan)?;
        // Pictures of light that is kept are made once all of it is there.
        let of_bands = &if keeps {
            plan.clone().without(Pass::Display, Skipped::NotWanted)
        } else {
            plan.clone()
        };
        for first_y in (0..list.view.height).step_by(rows as usize) {
            let rows = rows.min(list.view.height - first_y);
            let band = Band { first_y, rows, last: first_y + rows == list.view.height };
            times.measure("lens", || self.bring_lens(list, band))?;
            times.measure("submit", || self.submit(list, of_bands, shadow, band))?;
            let counted = self.take_back(band, frame, times)?;
            if counted[0].bad_object != 0 {
                let object = u32::MAX - counted[0].bad_object;
                return Err(EngineError::NotFinite { object, what: "a placed vertex" });
            }
            if self.room.grow(&counted) {
                return Ok(false);
            }
        }
        if keeps {
            let band = Band { first_y: 0, rows: list.view.height, last: true };
            times.measure("submit", || self.submit_optics(list, plan, band))?;
            self.take_back(band, frame, times)?;
        }
        Ok(true)
    }

    /// Waits for what was submitted and copies back what was recorded of it.
    fn take_back(
        &mut self,
        band: Band,
        frame: &mut Frame,
        times: &mut StageTimes,
    ) -> Result<Counted, EngineError> {
        let start = Instant::now();
        self.readback.wait(&self.device)?;
        let waited = start.elapsed();
        let mut ticks = [0; 2 * Stage::ALL.len()];
        let counted = times
            .measure("copy back", || self.readback.take(&self.device, band, frame, &mut ticks))?;
        match &self.clock {
            Some(clock) => clock.report(&ticks, waited, times),
            None => times.add("wait for the device", waited),
        }
        Ok(counted)
    }

    /// Rows of pixels of a band, a multiple of the tile's, such that everything by pixel fits.
    pub(super) fn band_rows(&self, list: &DrawList) -> Result<u32, EngineError> {
        let limit = self.device.largest_buffer();
        let of_ray = if list.lens.is_some() { lens::RAY_BYTES } else { 0 };
        let per_row = u64::from(list.view.width) * (8 * u64::from(list.samples)).max(of_ray);
        let staging = u64::from(list.view.width) * 12 + 1;
        let rows = (limit / per_row).min(self.device.limits.max_buffer_size / 2 / staging);
        // Behind a lens each band would need its tables anew.
        let turns = self.device.takes_turns && list.lens.is_none();
        let most = if turns { ROWS_OF_A_TURN } else { 8192 };
        let rows = rows.min(most) as u32 / abi::TILE * abi::TILE;
        if rows == 0 {
            let got = per_row * u64::from(abi::TILE);
            return Err(EngineError::TooLarge {
                what: "graphics memory of a row of tiles",
                got,
                limit,
            });
        }
        Ok(rows)
    }

    /// Makes room for what depends on the size of the picture and the number of triangles.
    fn make_room(&mut self, list: &DrawList, rows: u32, keeps: bool) -> Result<(), EngineError> {
        let (device, buffers) = (&self.device, &mut self.buffers);
        let width = u64::from(list.view.width);
        let rows = u64::from(rows.min(list.view.height));
        let primitive = size_of::<Primitive>() as u64;
        let [picture, sun] = self.room.primitives;
        buffers.ensure(device, Resource::Primitives, picture * primitive)?;
        buffers.ensure(device, Resource::SunPrimitives, sun * primitive)?;
        buffers.ensure(device, Resource::Lists, self.room.entries * 4)?;
        buffers.ensure(device, Resource::Samples, width * rows * u64::from(list.samples) * 8)?;
        let pixels = width * if keeps { u64::from(list.view.height) } else { rows };
        buffers.ensure(device, Resource::Picture, pixels * 4)?;
        buffers.ensure(device, Resource::Resolved, width * rows * 8)?;
        let tile = u64::from(abi::TILE);
        let tiles = width.div_ceil(tile) * rows.div_ceil(tile);
        // A list of small primitives and one of others for each.
        buffers.ensure(device, Resource::Tiles, tiles * 2 * size_of::<abi::Tile>() as u64)?;
        Ok(())
    }

    /// Brings the tables of a band behind a lens to the device, unless they are there.
    fn bring_lens(&mut self, list: &DrawList, band: Band) -> Result<(), EngineError> {
        let Some(lens) = self.lens.as_mut().filter(|_| list.lens.is_some()) else { return Ok(()) };
        let made = lens.take_band(list.view.width, [band.first_y, band.rows]);
        if made || !self.lens_is_there {
            self.buffers.write(&self.device, Resource::Squares, &lens.squares)?;
            self.buffers.write(&self.device, Resource::Places, &lens.places)?;
            self.buffers.write(&self.device, Resource::Rays, &lens.rays)?;
            self.lens_is_there = true;
        }
        Ok(())
    }

    /// Records the passes of a band and sends them off.
    fn submit(
        &mut self,
        list: &DrawList,
        plan: &PassPlan,
        shadow: bool,
        band: Band,
    ) -> Result<(), EngineError> {
        self.record(list, plan, band, |recorder, packed| {
            if band.first_y == 0 {
                recorder.geometry();
                if shadow {
                    recorder.shadow(packed.sun_batches.len() as u32);
                }
            }
            recorder.visibility();
            recorder.outputs(plan, &packed.frame);
        })
    }

    /// Records what follows all bands where light is kept, and sends it off.
    fn submit_optics(
        &mut self,
        list: &DrawList,
        plan: &PassPlan,
        picture: Band,
    ) -> Result<(), EngineError> {
        let labels = [Pass::Resolve, Pass::Reduce];
        let plan = labels.into_iter().fold(plan.clone(), |p, l| p.without(l, Skipped::NotWanted));
        let steps = std::mem::take(&mut self.optics.steps);
        let result = self.record(list, &plan, picture, |recorder, packed| {
            recorder.optics(&plan, &packed.frame, &steps);
        });
        self.optics.steps = steps;
        result
    }

    /// Records passes over a band and what becomes of them, and sends it all off.
    fn record(
        &mut self,
        list: &DrawList,
        plan: &PassPlan,
        band: Band,
        passes: impl FnOnce(&mut Recorder<'_>, &Packed),
    ) -> Result<(), EngineError> {
        let mut target = pack::picture_target(list, &self.packed, band.first_y, band.rows);
        if let Some(lens) = self.lens.as_ref().filter(|_| list.lens.is_some()) {
            // Samples behind a lens stand in its plane.
            target.rows = pack::plane_target(lens.plane(), &self.packed).rows;
        }
        self.buffers.write(&self.device, Resource::Target, &[target])?;
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let mut recorder = Recorder {
            device: &mut self.device,
            buffers: &mut self.buffers,
            clock: self.clock.as_mut(),
            encoder: &mut encoder,
            variant: Variant {
                samples: list.samples,
                light: Light::of(&self.packed.frame),
                cutouts: list.draws.iter().any(|draw| draw.cutout.is_some()),
            },
            lens: list.lens.is_some(),
            target: &target,
            keeps: !plan.runs(Pass::Display),
            triangles: self.packed.triangles[0],
        };
        recorder.start();
        passes(&mut recorder, &self.packed);
        recorder.finish();
        let shown = plan.runs(Pass::Display) && plan.delivery() == Delivery::Texture;
        if let Some(present) = self.present.as_ref().filter(|_| shown) {
            present.record(&self.device, &mut encoder, &self.buffers, band.rows);
        }
        let timings = self.clock.as_ref().map(|c| &c.resolved);
        let what = (plan, list.view.width, list.objects.len());
        self.readback.record(&self.device, &mut encoder, &self.buffers, what, band, timings)?;
        self.device.queue.submit([encoder.finish()]);
        Ok(())
    }
}
