//! Keyed random numbers: `value = f(seed, frame, slot, key, index)`, never a running stream.
//!
//! The generator is Philox4x32-10 (Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy
//! as 1, 2, 3", SC 2011), a function from a 128-bit counter and a 64-bit key to 128 random bits.
//! The seed is its key; frame, slot, parameter key and draw index are its counter. So frame 417
//! never needs frame 416, and adding or switching off a parameter moves no other.
//!
//! In flows who asks ([`Draws::of`]), out flow uniform numbers. Which distribution they become, and
//! which keys there are, is not decided here. Outputs are fixed for ever: a test pins them to the
//! published vectors.

use std::convert::Infallible;

use rand_core::TryRng;

/// The name of a random quantity: a written constant, so that renaming a field changes no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Key(u32);

impl Key {
    /// The 32-bit FNV-1a hash of a name (Fowler, Noll and Vo).
    #[must_use]
    pub const fn new(name: &str) -> Self {
        let (bytes, mut hash, mut i) = (name.as_bytes(), 0x811c_9dc5_u32, 0);
        while i < bytes.len() {
            hash = (hash ^ bytes[i] as u32).wrapping_mul(0x0100_0193);
            i += 1;
        }
        Self(hash)
    }
}

/// The random numbers of one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draws {
    seed: u64,
    frame: u32,
    middle: bool,
}

impl Draws {
    /// The numbers of a frame under a seed.
    #[must_use]
    pub const fn new(seed: u64, frame: u32) -> Self {
        Self { seed, frame, middle: false }
    }

    /// The seed.
    #[must_use]
    pub const fn seed(self) -> u64 {
        self.seed
    }

    /// The same numbers, or, where `random` is false, one half in place of each: every parameter
    /// then takes its median. Streams stay random.
    #[must_use]
    pub const fn random_if(self, random: bool) -> Self {
        Self { middle: !random, ..self }
    }

    /// The numbers of one quantity of one slot (a person, a light, an occluder).
    #[must_use]
    pub const fn of(self, key: Key, slot: u32) -> Draw {
        Draw { draws: self, key, slot, turn: slot, lane: 0 }
    }
}

/// The random numbers of one quantity of one slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draw {
    draws: Draws,
    key: Key,
    slot: u32,
    turn: u32,
    lane: u32,
}

impl Draw {
    /// Independent numbers for a component of the quantity, such as an axis; up to 2^16 of them,
    /// and [`Draw::lane`] 0 is the draw itself.
    #[must_use]
    pub const fn lane(self, lane: u16) -> Self {
        Self { lane: lane as u32, ..self }
    }

    /// The same numbers for another place in a row; see [`Draw::turn`].
    #[must_use]
    pub const fn in_turn(self, turn: u32) -> Self {
        Self { turn, ..self }
    }

    /// Whose turn it is where things are not drawn but taken one after the other: the slot's place,
    /// whatever the numbers are keyed by.
    #[must_use]
    pub const fn turn(self) -> u32 {
        self.turn
    }

    /// Whether it is the median that is asked for, see [`Draws::random_if`].
    #[must_use]
    pub const fn is_middle(self) -> bool {
        self.draws.middle
    }

    /// Uniform in [0, 1), 53 bits.
    #[must_use]
    pub fn uniform(self) -> f64 {
        self.uniform_at(0)
    }

    /// The same for the numbers beyond the first; each index is independent of the others.
    #[must_use]
    pub fn uniform_at(self, index: u16) -> f64 {
        if self.draws.middle {
            return 0.5;
        }
        let words = self.block(self.lane << 16 | u32::from(index));
        unit_from_bits(words)
    }

    /// A generator for shuffles and rejection loops. It shares its first numbers with
    /// [`Draw::uniform_at`] of every lane: use a key for one or for the other.
    #[must_use]
    pub const fn stream(self) -> Stream {
        Stream { draw: self, index: 0, words: [0; 4], left: 0 }
    }

    fn block(self, index: u32) -> [u32; 4] {
        let seed = [self.draws.seed as u32, (self.draws.seed >> 32) as u32];
        philox4x32([self.draws.frame, self.slot, self.key.0, index], seed)
    }
}

/// An endless row of random words: 2^32 blocks of four.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stream {
    draw: Draw,
    index: u32,
    words: [u32; 4],
    left: usize,
}

impl Stream {
    fn next_word(&mut self) -> u32 {
        if self.left == 0 {
            self.words = self.draw.block(self.index);
            self.index = self.index.wrapping_add(1);
            self.left = 4;
        }
        self.left -= 1;
        self.words[3 - self.left]
    }

    /// Uniform in [0, 1), 53 bits.
    pub fn uniform(&mut self) -> f64 {
        let words = [self.next_word(), self.next_word()];
        unit_from_bits([words[0], words[1], 0, 0])
    }

    /// Uniform among `0..n` by multiplication (bias below n / 2^53); 0 where `n` is 0.
    pub fn below(&mut self, n: usize) -> usize {
        ((self.uniform() * n as f64) as usize).min(n.saturating_sub(1))
    }
}

impl TryRng for Stream {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(self.next_word())
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        rand_core::utils::next_u64_via_u32(self)
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        rand_core::utils::fill_bytes_via_next_word(bytes, || self.try_next_u32())
    }
}

fn unit_from_bits(words: [u32; 4]) -> f64 {
    let bits = u64::from(words[1]) << 32 | u64::from(words[0]);
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// Philox4x32 with ten rounds.
#[must_use]
pub const fn philox4x32(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    let mut round = 0;
    while round < 10 {
        let a = 0xD251_1F53_u64 * counter[0] as u64;
        let b = 0xCD9E_8D57_u64 * counter[2] as u64;
        counter = [
            (b >> 32) as u32 ^ counter[1] ^ key[0],
            b as u32,
            (a >> 32) as u32 ^ counter[3] ^ key[1],
            a as u32,
        ];
        key = [key[0].wrapping_add(0x9E37_79B9), key[1].wrapping_add(0xBB67_AE85)];
        round += 1;
    }
    counter
}

#[cfg(test)]
mod tests {
    use rand_core::Rng;

    use super::*;

    /// The known-answer vectors published with the authors' Random123 library.
    #[test]
    fn philox_gives_the_published_vectors() {
        let zero = [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8];
        assert_eq!(philox4x32([0; 4], [0; 2]), zero);
        let ones = [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd];
        assert_eq!(philox4x32([u32::MAX; 4], [u32::MAX; 2]), ones);
        let pi = [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344];
        let answer = [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1];
        assert_eq!(philox4x32(pi, [0xa409_3822, 0x299f_31d0]), answer);
    }

    /// Vectors of the FNV-1a authors.
    #[test]
    fn keys_are_fnv_1a() {
        assert_eq!(Key::new(""), Key(0x811c_9dc5));
        assert_eq!(Key::new("a"), Key(0xe40c_292c));
        assert_eq!(Key::new("foobar"), Key(0xbf9c_f968));
    }

    #[test]
    fn a_draw_is_the_counter_it_says() {
        let draw = Draws::new(0x0123_4567_89ab_cdef, 7).of(Key(42), 3).lane(2);
        let words = philox4x32([7, 3, 42, 2 << 16 | 5], [0x89ab_cdef, 0x0123_4567]);
        let bits = (u64::from(words[1]) << 32 | u64::from(words[0])) >> 11;
        assert_eq!(draw.uniform_at(5), bits as f64 * 2f64.powi(-53));
    }

    #[test]
    fn every_part_of_the_key_matters() {
        let base = Draws::new(1, 1).of(Key(1), 1);
        let others = [
            Draws::new(2, 1).of(Key(1), 1),
            Draws::new(1 << 32 | 1, 1).of(Key(1), 1),
            Draws::new(1, 2).of(Key(1), 1),
            Draws::new(1, 1).of(Key(2), 1),
            Draws::new(1, 1).of(Key(1), 2),
            base.lane(1),
        ];
        for other in others {
            assert_ne!(base.uniform(), other.uniform(), "{other:?}");
        }
        assert_ne!(base.uniform(), base.uniform_at(1));
    }

    #[test]
    fn a_stream_is_the_blocks_in_order() {
        let draw = Draws::new(9, 1).of(Key(3), 0);
        let mut stream = draw.stream();
        for index in 0..5 {
            for word in draw.block(index) {
                assert_eq!(stream.next_u32(), word);
            }
        }
        let (mut a, mut b) = (draw.stream(), draw.stream());
        let mut bytes = [0; 8];
        a.fill_bytes(&mut bytes);
        assert_eq!(u64::from_le_bytes(bytes), b.next_u64());
        assert_eq!(draw.stream().uniform(), draw.uniform());
    }

    #[test]
    fn the_middle_is_one_half() {
        let draws = Draws::new(9, 1);
        assert_eq!(draws.random_if(false).of(Key(3), 0).uniform_at(4), 0.5);
        assert_eq!(draws.random_if(true), draws);
    }

    /// Chi-squared over 256 bins of 2^16 draws: 255 degrees of freedom, 1e-6 quantiles 158 and 383.
    #[test]
    fn draws_are_uniform_over_slots_and_frames() {
        for by_frame in [false, true] {
            let mut bins = [0u32; 256];
            for i in 0..1 << 16 {
                let (frame, slot) = if by_frame { (i, 0) } else { (0, i) };
                let u = Draws::new(5, frame).of(Key::new("test"), slot).uniform();
                bins[(u * 256.0) as usize] += 1;
            }
            let chi2: f64 = bins.iter().map(|&n| (f64::from(n) - 256.0).powi(2) / 256.0).sum();
            assert!((158.0..383.0).contains(&chi2), "chi-squared {chi2}");
        }
    }
}
