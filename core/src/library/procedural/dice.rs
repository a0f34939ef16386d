//! The random numbers of procedural textures.
//!
//! A texture's id is its seed, and its pixels must stay the same for ever; so this generator is
//! its own and does not follow that of scenes. SplitMix64 (Steele, Lea and Flood, "Fast splittable
//! pseudorandom number generators", 2014) over an FNV-1a hash of the id.

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub(in crate::library) struct Dice(u64);

impl Dice {
    /// The stream of an id.
    pub fn new(id: &str) -> Self {
        let hash = id.bytes().fold(0xcbf2_9ce4_8422_2325u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        Self(hash)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// 0..1.
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / 16_777_216.0
    }

    /// `low..high`.
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (((self.bits() >> 32) * n as u64) >> 32) as usize
    }

    /// True with a probability.
    pub fn chance(&mut self, probability: f32) -> bool {
        self.unit() < probability
    }

    /// One of a list.
    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// A place on the canvas.
    pub fn place(&mut self) -> [f32; 2] {
        let side = super::canvas::SIDE as f32;
        [self.range(0.0, side), self.range(0.0, side)]
    }

    /// A unit vector.
    pub fn direction(&mut self) -> [f32; 2] {
        let turn = self.unit();
        [super::canvas::cos_turns(turn), super::canvas::sin_turns(turn)]
    }

    /// The list in random order.
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for i in (1..list.len()).rev() {
            list.swap(i, self.below(i + 1));
        }
    }
}
