//! What an engine hands back.

use std::time::Duration;

/// The buffers of one rendered frame; those that the plan did not ask for are absent.
///
/// Pixel buffers are row by row from the top, `width * height` long (times 3 for the picture).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// 8-bit sRGB, RGB order.
    pub picture: Option<Vec<u8>>,
    /// Index in the draw list's objects plus one of the object with most samples in the pixel (of
    /// equals, the one nearest to the camera), 0 where most samples show nothing.
    pub object_ids: Option<Vec<u16>>,
    /// Metres along the view axis of the nearest sample of that object in the pixel, 0 where it is 0.
    pub depth_m: Option<Vec<f32>>,
    /// One entry for each object of the draw list.
    pub object_samples: Option<Vec<ObjectSamples>>,
}

/// The visible samples of one object, over the whole picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObjectSamples {
    /// How many samples show it.
    pub count: u64,
    /// Smallest x and y, largest x and y of those samples' positions, in 1/16 pixel.
    /// Meaningless when `count` is 0.
    pub min_16th: [i32; 2],
    /// See `min_16th`.
    pub max_16th: [i32; 2],
}

impl Default for ObjectSamples {
    fn default() -> Self {
        Self { count: 0, min_16th: [i32::MAX; 2], max_16th: [i32::MIN; 2] }
    }
}

/// Time spent by stage, summed over threads.
#[derive(Clone, Debug, Default)]
pub struct StageTimes {
    entries: Vec<(&'static str, Duration)>,
}

impl StageTimes {
    /// Adds time to a stage, which is listed where it was first named.
    pub fn add(&mut self, stage: &'static str, time: Duration) {
        match self.entries.iter_mut().find(|(name, _)| *name == stage) {
            Some((_, sum)) => *sum += time,
            None => self.entries.push((stage, time)),
        }
    }

    /// Counts time that was measured within one stage as another's.
    pub fn move_part(&mut self, from: &'static str, to: &'static str, time: Duration) {
        if let Some((_, sum)) = self.entries.iter_mut().find(|(name, _)| *name == from) {
            let time = time.min(*sum);
            *sum -= time;
            self.add(to, time);
        }
    }

    /// Runs a function and adds its time to a stage.
    pub fn measure<T>(&mut self, stage: &'static str, f: impl FnOnce() -> T) -> T {
        let start = std::time::Instant::now();
        let value = f();
        self.add(stage, start.elapsed());
        value
    }

    /// Adds all of another's stages.
    pub fn merge(&mut self, other: &Self) {
        for &(stage, time) in &other.entries {
            self.add(stage, time);
        }
    }

    /// Stages with their time, in order of first use.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, Duration)> + '_ {
        self.entries.iter().copied()
    }

    /// Sum over all stages.
    #[must_use]
    pub fn total(&self) -> Duration {
        self.entries.iter().map(|(_, t)| *t).sum()
    }
}
