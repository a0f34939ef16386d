//! The surroundings that are part of the program: `assets/environments.env`.
//!
//! Light as 12-bit floats (5 bits of exponent, 6 of mantissa: steps of 1 %), green and the
//! differences of red and blue from it, each predicted from its neighbours (the median edge
//! detector of LOCO-I, Weinberger et al. 2000), packed with zstd picture by picture. Layout, all
//! numbers little endian: [`MAGIC`], `u32` count; of each picture 16 bytes of name, `u32` width,
//! `u32` length of its packed bytes; then the packed bytes.

use std::io::Read;

use glam::Vec3;

use super::equirect::Equirect;

/// First bytes of the file.
const MAGIC: &[u8; 8] = b"FIGENV1\n";
const NAME_BYTES: usize = 16;
const ENTRY_BYTES: usize = NAME_BYTES + 8;
/// Widest picture that is believed.
const MAX_WIDTH: usize = 8192;

static FILE: &[u8] = include_bytes!("../../../../assets/environments.env");

/// A packed picture.
#[derive(Clone, Copy, Debug)]
pub struct Packed<'a> {
    /// Its name, without the group.
    pub name: &'a str,
    width: usize,
    bytes: &'a [u8],
}

/// The pictures of the file that is part of the program, in its order; none if it is damaged.
pub fn built_in() -> Vec<Packed<'static>> {
    entries(FILE).unwrap_or_default()
}

/// The pictures of a file; nothing if it is no such file.
pub fn entries(file: &[u8]) -> Option<Vec<Packed<'_>>> {
    let number = |at: usize| {
        let bytes = file.get(at..at + 4)?.try_into().ok()?;
        Some(u32::from_le_bytes(bytes) as usize)
    };
    let count = number(MAGIC.len()).filter(|_| file.starts_with(MAGIC))?;
    let mut next = MAGIC.len() + 4 + count.checked_mul(ENTRY_BYTES)?;
    (0..count)
        .map(|i| {
            let at = MAGIC.len() + 4 + i * ENTRY_BYTES;
            let name = std::str::from_utf8(file.get(at..at + NAME_BYTES)?).ok()?;
            let (width, length) = (number(at + NAME_BYTES)?, number(at + NAME_BYTES + 4)?);
            let bytes = file.get(next..next.checked_add(length)?)?;
            next += length;
            (width.is_multiple_of(2) && (2..=MAX_WIDTH).contains(&width)).then_some(Packed {
                name: name.trim_end_matches('\0'),
                width,
                bytes,
            })
        })
        .collect()
}

impl Packed<'_> {
    /// Unpacks the picture; nothing if it is damaged.
    pub fn picture(&self) -> Option<Equirect> {
        let count = self.width * self.width / 2;
        let mut bytes = vec![0; count * 6];
        let mut packed = self.bytes;
        let mut stream = ruzstd::decoding::StreamingDecoder::new(&mut packed).ok()?;
        stream.read_exact(&mut bytes).ok()?;
        let (high, low) = bytes.split_at(count * 3);
        let mut planes: Vec<i16> =
            high.iter().zip(low).map(|(h, l)| i16::from_be_bytes([*h, *l])).collect();
        planes.chunks_exact_mut(count).for_each(|plane| restore(plane, self.width));
        let [green, red, blue] = [0, 1, 2].map(|k| &planes[k * count..(k + 1) * count]);
        let pixel = |i: usize| {
            let g = green[i];
            let [r, b] = [red[i], blue[i]].map(|d| d.wrapping_add(g));
            Vec3::new(from_float12(r), from_float12(g), from_float12(b))
        };
        Some(Equirect { width: self.width, pixels: (0..count).map(pixel).collect() })
    }
}

/// The bytes of a picture before they are packed with zstd.
#[must_use]
pub fn planes(picture: &Equirect) -> Vec<u8> {
    let coded: Vec<[i16; 3]> = picture.pixels.iter().map(|p| p.to_array().map(float12)).collect();
    let plane = |of: fn(&[i16; 3]) -> i16| {
        let mut plane: Vec<i16> = coded.iter().map(of).collect();
        reduce(&mut plane, picture.width);
        plane
    };
    let planes = [plane(|c| c[1]), plane(|c| c[0] - c[1]), plane(|c| c[2] - c[1])].concat();
    let byte = |k: usize| planes.iter().map(move |v| v.to_be_bytes()[k]);
    byte(0).chain(byte(1)).collect()
}

/// A file of pictures, each with the name, width and bytes that it is packed into.
#[must_use]
pub fn file(pictures: &[(String, usize, Vec<u8>)]) -> Vec<u8> {
    let mut file = MAGIC.to_vec();
    file.extend((pictures.len() as u32).to_le_bytes());
    for (name, width, bytes) in pictures {
        let mut padded = [0; NAME_BYTES];
        padded.iter_mut().zip(name.bytes()).for_each(|(to, from)| *to = from);
        file.extend(padded);
        file.extend((*width as u32).to_le_bytes());
        file.extend((bytes.len() as u32).to_le_bytes());
    }
    pictures.iter().for_each(|(_, _, bytes)| file.extend(bytes));
    file
}

/// What is taken from the bits of a single-precision number for the smaller exponent.
const REBIAS: i32 = (127 - 15) << 6;
const FLOAT12_MAX: i32 = (31 << 6) - 1;

fn float12(v: f32) -> i16 {
    // Negative numbers and NaN are nothing.
    let v = 0.0_f32.max(v);
    let rounded = (v.to_bits() as i32).saturating_add(1 << 16) >> 17;
    (rounded - REBIAS).clamp(0, FLOAT12_MAX) as i16
}

fn from_float12(v: i16) -> f32 {
    let v = i32::from(v).clamp(0, FLOAT12_MAX);
    if v == 0 { 0.0 } else { f32::from_bits(((v + REBIAS) << 17) as u32) }
}

/// What is expected at a place of which the values above and to the left are known.
fn predicted(plane: &[i16], at: usize, width: usize) -> i16 {
    let inside = !at.is_multiple_of(width);
    let left = if inside { plane[at - 1] } else { 0 };
    if at < width {
        return left;
    }
    let above = plane[at - width];
    let corner = if inside { plane[at - width - 1] } else { 0 };
    let (low, high) = (left.min(above), left.max(above));
    if corner >= high {
        low
    } else if corner <= low {
        high
    } else {
        left.wrapping_add(above).wrapping_sub(corner)
    }
}

/// Replaces values by what differs from the prediction.
fn reduce(plane: &mut [i16], width: usize) {
    for at in (0..plane.len()).rev() {
        let difference = plane[at].wrapping_sub(predicted(plane, at, width));
        // Signs at the low end, so that the upper byte of small differences is 0.
        plane[at] = (difference << 1) ^ (difference >> 15);
    }
}

/// Undoes [`reduce`].
fn restore(plane: &mut [i16], width: usize) {
    for at in 0..plane.len() {
        let coded = plane[at];
        let difference = ((coded as u16 >> 1) as i16) ^ -(coded & 1);
        plane[at] = difference.wrapping_add(predicted(plane, at, width));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn packed(picture: &Equirect) -> Vec<u8> {
        let fastest = ruzstd::encoding::CompressionLevel::Fastest;
        ruzstd::encoding::compress_to_vec(planes(picture).as_slice(), fastest)
    }

    #[test]
    fn pictures_come_back_to_a_hundredth() {
        let light = |d: glam::DVec3| (d.abs() * libm::exp(6.0 * d.y)).as_vec3();
        let picture = Equirect::from_fn(64, light);
        let file = file(&[
            ("a".to_owned(), 64, packed(&picture)),
            ("bc".to_owned(), 64, packed(&picture)),
        ]);
        let entries = entries(&file).unwrap();
        assert_eq!(entries.iter().map(|e| e.name).collect::<Vec<_>>(), ["a", "bc"]);
        let back = entries[1].picture().unwrap();
        for (a, b) in picture.pixels.iter().zip(&back.pixels) {
            assert!(((*a - *b).abs() - a.abs() * 0.008).max_element() < 7e-5, "{a} {b}");
        }
    }

    #[test]
    fn damaged_files_are_noticed() {
        let picture = Equirect::from_fn(16, |d| d.abs().as_vec3());
        let whole = file(&[("a".to_owned(), 16, packed(&picture))]);
        for length in 0..whole.len() {
            let found = entries(&whole[..length]).and_then(|e| e.first()?.picture());
            assert!(found.is_none(), "{length} bytes");
        }
    }

    #[test]
    fn everything_that_ships_can_be_unpacked_and_is_light() {
        let all = built_in();
        assert!(all.len() >= 12, "{}", all.len());
        for packed in all {
            let picture = packed.picture().unwrap();
            assert!(picture.pixels.iter().all(|p| p.is_finite() && p.min_element() >= 0.0));
            assert!(picture.pixels.iter().any(|p| p.max_element() > 0.1), "{}", packed.name);
        }
    }
}
