//! Bytes to vectors and back: one description of a layout serves writing and reading.
//!
//! Numbers are little-endian; those wider than a byte are split into planes (all low bytes, then
//! the next ones), which a general compressor packs far better. What the vectors mean is not
//! known here.

use super::FigureError;

/// Either end of a byte stream. Writing leaves the value alone, reading replaces it.
pub trait Stream {
    /// Raw bytes.
    fn bytes(&mut self, what: &'static str, v: &mut Vec<u8>) -> Result<(), FigureError>;
    /// Words of `T`, split into byte planes over runs of `run` words (0 for one run).
    fn words<T: Word>(
        &mut self,
        what: &'static str,
        run: usize,
        v: &mut Vec<T>,
    ) -> Result<(), FigureError>;

    /// UTF-8 strings without line breaks.
    fn names(&mut self, what: &'static str, v: &mut Vec<String>) -> Result<(), FigureError> {
        let mut joined = v.join("\n").into_bytes();
        self.bytes(what, &mut joined)?;
        let text = String::from_utf8(joined).map_err(|_| FigureError::Malformed { what })?;
        *v = text.split('\n').filter(|s| !s.is_empty()).map(str::to_owned).collect();
        Ok(())
    }
}

/// A plain number of two or four bytes.
pub trait Word: Copy + Default {
    /// Its size in bytes.
    const SIZE: usize;
    /// Its bytes in the low end.
    fn to_u32(self) -> u32;
    /// From the low bytes.
    fn from_u32(bits: u32) -> Self;
}

macro_rules! word {
    ($t:ty, $size:literal, $to:expr, $from:expr) => {
        impl Word for $t {
            const SIZE: usize = $size;
            fn to_u32(self) -> u32 {
                $to(self)
            }
            fn from_u32(bits: u32) -> Self {
                $from(bits)
            }
        }
    };
}
word!(u16, 2, u32::from, |b| b as u16);
// Signed numbers are folded (0, -1, 1, -2, ...), so that small ones have an empty high byte.
word!(i16, 2, |v: i16| u32::from(((v << 1) ^ (v >> 15)) as u16), |b| ((b as u16 >> 1) as i16)
    ^ -((b & 1) as i16));
word!(u32, 4, |v| v, |b| b);
word!(f32, 4, f32::to_bits, f32::from_bits);

/// The writing end.
#[derive(Debug, Default)]
pub struct Writer {
    /// What was written so far.
    pub out: Vec<u8>,
}

impl Writer {
    fn length(&mut self, n: usize) {
        let n = u32::try_from(n).expect("a figure's vectors hold fewer than 2^32 values");
        self.out.extend_from_slice(&n.to_le_bytes());
    }
}

impl Stream for Writer {
    fn bytes(&mut self, _: &'static str, v: &mut Vec<u8>) -> Result<(), FigureError> {
        self.length(v.len());
        self.out.extend_from_slice(v);
        Ok(())
    }

    fn words<T: Word>(
        &mut self,
        _: &'static str,
        run: usize,
        v: &mut Vec<T>,
    ) -> Result<(), FigureError> {
        self.length(v.len());
        for part in v.chunks(if run == 0 { v.len().max(1) } else { run }) {
            for byte in 0..T::SIZE {
                self.out.extend(part.iter().map(|w| (w.to_u32() >> (8 * byte)) as u8));
            }
        }
        Ok(())
    }
}

/// The reading end.
#[derive(Debug)]
pub struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    /// Starts at the first byte.
    #[must_use]
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    /// Whether everything was read.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    fn take(&mut self, what: &'static str, n: usize) -> Result<&'a [u8], FigureError> {
        let (head, tail) = self.rest.split_at_checked(n).ok_or(FigureError::Malformed { what })?;
        self.rest = tail;
        Ok(head)
    }

    fn length(&mut self, what: &'static str) -> Result<usize, FigureError> {
        let mut n = [0; 4];
        n.copy_from_slice(self.take(what, 4)?);
        Ok(u32::from_le_bytes(n) as usize)
    }
}

impl Stream for Reader<'_> {
    fn bytes(&mut self, what: &'static str, v: &mut Vec<u8>) -> Result<(), FigureError> {
        let n = self.length(what)?;
        *v = self.take(what, n)?.to_vec();
        Ok(())
    }

    fn words<T: Word>(
        &mut self,
        what: &'static str,
        run: usize,
        v: &mut Vec<T>,
    ) -> Result<(), FigureError> {
        let n = self.length(what)?;
        let size = n.checked_mul(T::SIZE).ok_or(FigureError::Malformed { what })?;
        let bytes = self.take(what, size)?;
        let run = if run == 0 { n.max(1) } else { run };
        v.clear();
        v.reserve_exact(n);
        for part in bytes.chunks(run * T::SIZE) {
            let (words, low) = (part.len() / T::SIZE, part);
            v.extend((0..words).map(|i| {
                let bits = (0..T::SIZE)
                    .fold(0, |bits, byte| bits | u32::from(low[byte * words + i]) << (8 * byte));
                T::from_u32(bits)
            }));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_written_is_read_back() {
        let mut a = vec![-3i16, 0, 1, i16::MAX, i16::MIN];
        let mut b = vec![0.1f32, -7.25, f32::MAX];
        let mut c = vec!["eye".to_owned(), "nose".to_owned()];
        let mut w = Writer::default();
        w.words("a", 2, &mut a).unwrap();
        w.words("b", 0, &mut b).unwrap();
        w.names("c", &mut c).unwrap();
        let (mut x, mut y, mut z) = (vec![], vec![], vec![]);
        let mut r = Reader::new(&w.out);
        r.words::<i16>("a", 2, &mut x).unwrap();
        r.words::<f32>("b", 0, &mut y).unwrap();
        r.names("c", &mut z).unwrap();
        assert!(r.is_empty());
        assert_eq!((a, b, c), (x, y, z));
    }

    #[test]
    fn a_short_file_is_an_error_that_names_the_part() {
        let mut w = Writer::default();
        w.words("a", 0, &mut vec![1u32, 2, 3]).unwrap();
        let mut v = Vec::<u32>::new();
        let e = Reader::new(&w.out[..10]).words("joint heads", 0, &mut v).unwrap_err();
        assert!(e.to_string().contains("joint heads"), "{e}");
    }
}
