//! How far a batch is, how fast it goes and how long it will take.

use std::collections::VecDeque;
use std::time::Duration;

/// Where a batch stands after a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The frame that was finished.
    pub frame: u32,
    /// Frames that are in the data set.
    pub done: u32,
    /// Frames that went wrong.
    pub failed: u32,
    /// Frames that were asked for.
    pub total: u32,
    /// Time since the start.
    pub elapsed: Duration,
    /// Speed over the last frames.
    pub frames_per_s: f64,
    /// Time left at that speed; none before the speed is known.
    pub left: Option<Duration>,
}

/// Counts frames and measures speed over the last of them.
#[derive(Clone, Debug)]
pub(super) struct Meter {
    total: u32,
    done: u32,
    failed: u32,
    /// When the last frames were finished, counted from the start.
    last: VecDeque<Duration>,
}

impl Meter {
    /// Enough frames to even out their differences, few enough to follow a change of speed.
    const WINDOW: usize = 64;

    pub fn new(total: u32) -> Self {
        Self { total, done: 0, failed: 0, last: VecDeque::from([Duration::ZERO]) }
    }

    /// A frame was finished at this time after the start.
    pub fn finished(&mut self, frame: u32, good: bool, elapsed: Duration) -> Progress {
        if good {
            self.done += 1;
        } else {
            self.failed += 1;
        }
        self.last.push_back(elapsed);
        if self.last.len() > Self::WINDOW + 1 {
            self.last.pop_front();
        }
        let span = elapsed.saturating_sub(self.last[0]).as_secs_f64();
        let frames_per_s = if span > 0.0 { (self.last.len() - 1) as f64 / span } else { 0.0 };
        let remaining = f64::from(self.total.saturating_sub(self.done + self.failed));
        // Beyond what a duration can hold there is nothing to say.
        let left = Duration::try_from_secs_f64(remaining / frames_per_s).ok();
        Progress {
            frame,
            done: self.done,
            failed: self.failed,
            total: self.total,
            elapsed,
            frames_per_s,
            left,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_pace_is_measured_and_carried_on() {
        let mut meter = Meter::new(200);
        for i in 1..=150u32 {
            let p = meter.finished(i - 1, i % 10 != 0, Duration::from_millis(u64::from(i) * 40));
            assert!((p.frames_per_s - 25.0).abs() < 1e-6);
            let left = p.left.unwrap().as_secs_f64();
            assert!((left - f64::from(200 - i) * 0.04).abs() < 1e-6);
            assert_eq!((p.done, p.failed), (i - i / 10, i / 10));
        }
    }

    #[test]
    fn a_change_of_pace_is_followed() {
        let mut meter = Meter::new(1000);
        let mut now = Duration::ZERO;
        let mut speed = 0.0;
        for i in 0..200 {
            now += Duration::from_millis(if i < 100 { 1000 } else { 10 });
            speed = meter.finished(i, true, now).frames_per_s;
        }
        assert!((speed - 100.0).abs() < 1e-6, "{speed}");
    }

    #[test]
    fn no_time_gives_no_guess() {
        assert_eq!(Meter::new(5).finished(0, true, Duration::ZERO).left, None);
    }
}
