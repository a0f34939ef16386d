//! From buffers of the device to the frame's.

use super::abi::{Counters, ObjectSums};
use super::buffers::Buffers;
use super::device::Device;
use super::stage::Resource;
use crate::engine::EngineError;
use crate::plan::{Delivery, Frame, ObjectSamples, Pass, PassPlan};

/// What is copied back of a band, one thing behind the other.
#[derive(Default)]
pub struct Readback {
    buffer: Option<wgpu::Buffer>,
    parts: Vec<(Resource, u64, u64)>,
}

/// Rows of pixels of a band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Band {
    pub first_y: u32,
    pub rows: u32,
    /// Whether it is the lowest.
    pub last: bool,
}

/// What the set-ups counted: of the picture, then of the sun's map.
pub type Counted = [Counters; 2];

impl Readback {
    /// Records the copies of what the plan asks for.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        buffers: &Buffers,
        (plan, width, objects): (&PassPlan, u32, usize),
        band: Band,
        timings: Option<&wgpu::Buffer>,
    ) -> Result<(), EngineError> {
        let pixels = u64::from(width) * u64::from(band.rows);
        let counters = size_of::<Counters>() as u64;
        let mut wishes = vec![(Resource::Counters, counters), (Resource::SunCounters, counters)];
        if plan.runs(Pass::Display) && plan.delivery() == Delivery::Readback {
            wishes.push((Resource::Picture, pixels * 4));
        }
        if plan.runs(Pass::Resolve) {
            wishes.push((Resource::Resolved, pixels * 8));
        }
        if plan.runs(Pass::Reduce) && band.last && objects > 0 {
            wishes.push((Resource::Sums, (objects * size_of::<ObjectSums>()) as u64));
        }
        self.parts.clear();
        let mut end = 0;
        for (resource, bytes) in wishes {
            self.parts.push((resource, end, bytes));
            end += bytes;
        }
        let timing_bytes = timings.map_or(0, wgpu::Buffer::size);
        self.make_room(device, end.next_multiple_of(8) + timing_bytes)?;
        let Some(staging) = &self.buffer else { return Ok(()) };
        for (resource, at, bytes) in &self.parts {
            encoder.copy_buffer_to_buffer(buffers.get(*resource), 0, staging, *at, *bytes);
        }
        if let Some(timings) = timings {
            let at = end.next_multiple_of(8);
            encoder.copy_buffer_to_buffer(timings, 0, staging, at, timing_bytes);
        }
        Ok(())
    }

    fn make_room(&mut self, device: &Device, bytes: u64) -> Result<(), EngineError> {
        let limit = device.limits.max_buffer_size;
        if bytes > limit {
            let what = "graphics memory of what is read back";
            return Err(EngineError::TooLarge { what, got: bytes, limit });
        }
        if self.buffer.as_ref().is_none_or(|b| b.size() < bytes) {
            self.buffer = Some(device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("what is read back"),
                size: bytes.next_multiple_of(256).min(limit),
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        Ok(())
    }

    /// Waits until what was recorded last is done and can be read.
    pub fn wait(&self, device: &Device) -> Result<(), EngineError> {
        let failed = |reason: String| device.failed(reason);
        let Some(buffer) = &self.buffer else { return Err(failed("nothing to read".to_owned())) };
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // Fails only if nobody waits any more.
            drop(sender.send(result));
        });
        device
            .device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|e| failed(e.to_string()))?;
        device.fault()?;
        match receiver.try_recv() {
            Ok(Ok(())) => Ok(()),
            Ok(Err(e)) => Err(failed(e.to_string())),
            Err(e) => Err(failed(e.to_string())),
        }
    }

    /// Fills the band's part of a frame with what was waited for; ticks of the clock go to `ticks`.
    /// What was counted is handed back; the rest is nonsense where that says so.
    pub fn take(
        &self,
        device: &Device,
        band: Band,
        frame: &mut Frame,
        ticks: &mut [u64],
    ) -> Result<Counted, EngineError> {
        let failed = |reason: String| device.failed(reason);
        let Some(buffer) = &self.buffer else { return Err(failed("nothing to read".to_owned())) };
        let mapped = buffer.get_mapped_range(..).map_err(|e| failed(e.to_string()))?;
        let mut counted = [Counters::default(); 2];
        let mut end = 0;
        for &(resource, at, bytes) in &self.parts {
            end = at + bytes;
            let content = &mapped[at as usize..end as usize];
            match resource {
                Resource::Counters => counted[0] = bytemuck::pod_read_unaligned(content),
                Resource::SunCounters => counted[1] = bytemuck::pod_read_unaligned(content),
                Resource::Picture => take_picture(content, band, frame),
                Resource::Resolved => take_resolved(content, band, frame),
                _ => take_sums(content, frame),
            }
        }
        let clock = end.next_multiple_of(8) as usize;
        for (tick, bytes) in ticks.iter_mut().zip(mapped[clock..].as_chunks::<8>().0) {
            *tick = u64::from_le_bytes(*bytes);
        }
        drop(mapped);
        buffer.unmap();
        Ok(counted)
    }
}

fn take_picture(content: &[u8], band: Band, frame: &mut Frame) {
    let first = frame.width as usize * band.first_y as usize * 3;
    let Some(picture) = &mut frame.picture else { return };
    let pixels = picture[first..].as_chunks_mut::<3>().0;
    for (pixel, [r, g, b, _]) in pixels.iter_mut().zip(content.as_chunks::<4>().0) {
        *pixel = [*r, *g, *b];
    }
}

fn take_resolved(content: &[u8], band: Band, frame: &mut Frame) {
    let first = frame.width as usize * band.first_y as usize;
    let (Some(ids), Some(depth)) = (&mut frame.object_ids, &mut frame.depth_m) else { return };
    let pixels = ids[first..].iter_mut().zip(&mut depth[first..]);
    for ((id, depth), [a, b, _, _, d @ ..]) in pixels.zip(content.as_chunks::<8>().0) {
        *id = u16::from_le_bytes([*a, *b]);
        *depth = f32::from_le_bytes(*d);
    }
}

fn take_sums(content: &[u8], frame: &mut Frame) {
    let Some(sums) = &mut frame.object_samples else { return };
    let records = content.chunks_exact(size_of::<ObjectSums>());
    for (sum, record) in sums.iter_mut().zip(records) {
        let record: ObjectSums = bytemuck::pod_read_unaligned(record);
        if record.count > 0 {
            *sum = ObjectSamples {
                count: record.count.into(),
                min_16th: record.low.map(|v| (u32::MAX - v) as i32),
                max_16th: record.high.map(|v| v as i32),
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_keep_their_three_channels() {
        for (width, rows, first_y) in [(1, 1, 0), (3, 1, 1), (5, 3, 2), (8, 2, 1), (7, 5, 0)] {
            let count = width * (rows + first_y + 1) * 3;
            let mut frame = Frame { width: width as u32, ..Frame::default() };
            frame.picture = Some(vec![9; count]);
            let pixel = |i: usize| [i as u8, 100 + i as u8, 200 + i as u8];
            let content: Vec<u8> =
                (0..width * rows).flat_map(|i| [pixel(i).as_slice(), &[77]].concat()).collect();
            let band = Band { first_y: first_y as u32, rows: rows as u32, last: false };
            take_picture(&content, band, &mut frame);
            let mut wanted = vec![9; width * first_y * 3];
            wanted.extend((0..width * rows).flat_map(pixel));
            wanted.resize(count, 9);
            assert_eq!(frame.picture.as_ref(), Some(&wanted), "{width} x {rows} from {first_y}");
        }
    }
}
