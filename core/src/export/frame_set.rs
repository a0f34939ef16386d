//! Sets of frame numbers, kept as ranges.

use std::ops::Range;

/// A set of frame numbers as sorted ranges that neither overlap nor touch, so that it stays small
/// for any number of frames.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameSet {
    ranges: Vec<Range<u32>>,
}

impl FrameSet {
    /// Adds a frame; whether it was new.
    pub fn insert(&mut self, frame: u32) -> bool {
        // The first range that ends at the frame or after it.
        let at = self.ranges.partition_point(|r| r.end < frame);
        match self.ranges.get_mut(at) {
            Some(range) if range.contains(&frame) => return false,
            Some(range) if range.end == frame => range.end = frame + 1,
            Some(range) if range.start == frame + 1 => range.start = frame,
            _ => self.ranges.insert(at, frame..frame + 1),
        }
        if let [left, right, ..] = &mut self.ranges[at..]
            && left.end == right.start
        {
            left.end = right.end;
            self.ranges.remove(at + 1);
        }
        true
    }

    /// Whether a frame is in it.
    #[must_use]
    pub fn contains(&self, frame: u32) -> bool {
        let at = self.ranges.partition_point(|r| r.end <= frame);
        self.ranges.get(at).is_some_and(|r| r.contains(&frame))
    }

    /// How many frames it holds.
    #[must_use]
    pub fn len(&self) -> u64 {
        self.ranges.iter().map(|r| u64::from(r.end - r.start)).sum()
    }

    /// Whether it holds none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ranges.is_empty()
    }

    /// Its ranges in ascending order.
    #[must_use]
    pub fn ranges(&self) -> &[Range<u32>] {
        &self.ranges
    }

    /// Its frames in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        self.ranges.iter().cloned().flatten()
    }
}

impl FromIterator<u32> for FrameSet {
    fn from_iter<I: IntoIterator<Item = u32>>(frames: I) -> Self {
        let mut set = Self::default();
        for frame in frames {
            set.insert(frame);
        }
        set
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn it_agrees_with_a_plain_set_and_stays_minimal() {
        let mut state = 1u32;
        for _ in 0..50 {
            let (mut set, mut plain) = (FrameSet::default(), BTreeSet::new());
            for _ in 0..60 {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let frame = (state >> 16) % 80;
                assert_eq!(set.insert(frame), plain.insert(frame));
                assert!(set.ranges().windows(2).all(|w| w[0].end < w[1].start), "{set:?}");
            }
            assert!(set.iter().eq(plain.iter().copied()));
            assert_eq!(set.len(), plain.len() as u64);
            assert!((0..90).all(|f| set.contains(f) == plain.contains(&f)));
        }
    }
}
