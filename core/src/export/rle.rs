//! COCO's run-length masks and their compressed text form.
//!
//! A mask is a list of run lengths over the pixels in column-major order (down the first column,
//! then down the second), starting with zeros. The text form, read by pycocotools, writes each
//! length from the third on as its difference to the one two places before, in groups of five bits
//! with a continuation bit, least significant group first, offset by 48 into printable characters.

use std::collections::BTreeMap;

/// A binary mask as run lengths.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rle {
    /// Lengths of alternating runs of zeros and ones, zeros first (possibly of length 0).
    counts: Vec<u32>,
}

impl Rle {
    /// Number of ones.
    #[must_use]
    pub fn area(&self) -> u64 {
        self.counts.iter().skip(1).step_by(2).map(|&n| u64::from(n)).sum()
    }

    /// The run lengths, zeros first.
    #[must_use]
    pub fn counts(&self) -> &[u32] {
        &self.counts
    }

    /// The compressed text, `counts` in COCO files.
    #[must_use]
    pub fn compressed(&self) -> String {
        let mut text = String::with_capacity(self.counts.len() * 2);
        for (i, &count) in self.counts.iter().enumerate() {
            let before = if i > 2 { i64::from(self.counts[i - 2]) } else { 0 };
            push_number(&mut text, i64::from(count) - before);
        }
        text
    }
}

/// Five bits at a time until only copies of the sign bit remain.
fn push_number(text: &mut String, mut value: i64) {
    loop {
        let group = (value & 0x1f) as u8;
        value >>= 5;
        let rest = if group & 0x10 == 0 { 0 } else { -1 };
        let more = value != rest;
        text.push(char::from(48 + group + if more { 0x20 } else { 0 }));
        if !more {
            return;
        }
    }
}

/// The mask of every id in a picture of ids, sorted by id; 0 is nobody.
///
/// `ids` runs row by row and is `width * height` long.
#[must_use]
pub fn masks(ids: &[u16], width: u32, height: u32) -> Vec<(u16, Rle)> {
    let (width, height) = (width as usize, height as usize);
    assert_eq!(ids.len(), width * height, "one id for each pixel");
    let mut masks: BTreeMap<u16, Building> = BTreeMap::new();
    let (mut id, mut start) = (0, 0);
    for change in changes(ids, width, height) {
        let at = change.x as usize * height + change.y as usize;
        if change.id != id {
            if id != 0 {
                masks.entry(id).or_default().run(start, at);
            }
            (id, start) = (change.id, at);
        }
    }
    if id != 0 {
        masks.entry(id).or_default().run(start, ids.len());
    }
    masks.into_iter().map(|(id, mask)| (id, mask.close(ids.len()))).collect()
}

/// A mask up to the end of its last run of ones.
#[derive(Default)]
struct Building {
    counts: Vec<u32>,
    end: usize,
}

impl Building {
    fn run(&mut self, start: usize, end: usize) {
        self.counts.extend([(start - self.end) as u32, (end - start) as u32]);
        self.end = end;
    }

    fn close(mut self, pixels: usize) -> Rle {
        if self.end < pixels {
            self.counts.push((pixels - self.end) as u32);
        }
        Rle { counts: self.counts }
    }
}

/// From here down its column, pixels have this id.
struct Change {
    x: u32,
    y: u32,
    id: u16,
}

/// The top of every column and each place where a pixel differs from the one above, in column-major
/// order. Rows are compared in pieces, since most of them are equal; walking down the columns
/// instead would miss the cache at every step.
fn changes(ids: &[u16], width: usize, height: usize) -> Vec<Change> {
    const PIECE: usize = 32;
    if width == 0 || height == 0 {
        return Vec::new();
    }
    let top = ids[..width].iter().enumerate();
    let mut changes: Vec<_> = top.map(|(x, &id)| Change { x: x as u32, y: 0, id }).collect();
    let rows = ids.chunks_exact(width);
    for (y, (above, row)) in rows.clone().zip(rows.skip(1)).enumerate() {
        for (piece, (a, b)) in above.chunks(PIECE).zip(row.chunks(PIECE)).enumerate() {
            if a == b {
                continue;
            }
            for (i, (_, &id)) in a.iter().zip(b).enumerate().filter(|(_, (a, b))| a != b) {
                changes.push(Change { x: (piece * PIECE + i) as u32, y: y as u32 + 1, id });
            }
        }
    }
    // Stable, so that each column stays in order.
    changes.sort_by_key(|change| change.x);
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Text of the mask of ones in a picture given by its rows.
    fn text(rows: &[&[u16]]) -> String {
        let masks = masks(&rows.concat(), rows[0].len() as u32, rows.len() as u32);
        let [(1, rle)] = masks.as_slice() else { panic!("one mask expected") };
        rle.compressed()
    }

    fn picture(width: usize, height: usize, inside: impl Fn(i64, i64) -> bool) -> Vec<u16> {
        let pixel = |i: usize| u16::from(inside((i % width) as i64, (i / width) as i64));
        (0..width * height).map(pixel).collect()
    }

    // Expected strings are those of pycocotools 2.0 for the same pictures.
    #[test]
    fn small_masks_read_as_in_pycocotools() {
        assert_eq!(text(&[&[0, 1], &[1, 1]]), "13");
        assert_eq!(text(&[&[1, 1, 1], &[1, 1, 1]]), "06");
        assert_eq!(text(&[&[1, 0, 0, 1], &[0, 1, 1, 0], &[1, 1, 0, 1]]), "0110010O0000");
    }

    #[test]
    fn large_masks_read_as_in_pycocotools() {
        let square = picture(80, 100, |x, y| (20..60).contains(&x) && (10..90).contains(&y));
        let expected = format!("jn1`2d{}Vn1", "0".repeat(78));
        assert_eq!(masks(&square, 80, 100)[0].1.compressed(), expected);
        let corner = picture(640, 640, |x, y| x == 639 && y >= 600);
        assert_eq!(masks(&corner, 640, 640)[0].1.compressed(), "hn_<X1");
        let disk = picture(640, 640, |x, y| (x - 300).pow(2) + (y - 200).pow(2) < 50);
        let expected = "XZg51lc06L2N2N2O000O20N10001N2N2N4JkY_6";
        assert_eq!(masks(&disk, 640, 640)[0].1.compressed(), expected);
        let stripes = picture(5, 7, |_, y| y % 2 == 0);
        assert_eq!(masks(&stripes, 5, 7)[0].1.compressed(), "011000010O00010O00010O00010O0000");
    }

    /// The inverse of the text form, from its description.
    fn decompressed(text: &str) -> Vec<i64> {
        let mut counts: Vec<i64> = Vec::new();
        let mut bytes = text.bytes();
        while let Some(mut byte) = bytes.next() {
            let (mut value, mut shift) = (0i64, 0);
            loop {
                let group = i64::from(byte - 48);
                value |= (group & 0x1f) << shift;
                shift += 5;
                if group & 0x20 == 0 {
                    if group & 0x10 != 0 {
                        value |= -1 << shift;
                    }
                    break;
                }
                byte = bytes.next().unwrap();
            }
            let before = if counts.len() > 2 { counts[counts.len() - 2] } else { 0 };
            counts.push(value + before);
        }
        counts
    }

    #[test]
    fn noise_decodes_to_the_mask_of_each_id() {
        let mut state = 7u32;
        let mut random = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 16
        };
        for (width, height) in [(1, 1), (1, 50), (50, 1), (33, 70), (64, 64), (100, 31)] {
            let pixels = width * height;
            let ids: Vec<u16> = (0..pixels)
                .map(|_| if random() % 3 == 0 { [0, 1, 2, 9][random() as usize % 4] } else { 2 })
                .collect();
            let masks = masks(&ids, width as u32, height as u32);
            let mut seen = ids.clone();
            seen.sort_unstable();
            seen.dedup();
            seen.retain(|id| *id != 0);
            assert_eq!(masks.iter().map(|(id, _)| *id).collect::<Vec<_>>(), seen);
            for (id, rle) in masks {
                let mut column_major = Vec::new();
                for (i, count) in decompressed(&rle.compressed()).into_iter().enumerate() {
                    column_major.extend(std::iter::repeat_n(i % 2 == 1, count as usize));
                }
                assert_eq!(column_major.len(), pixels);
                for (p, inside) in column_major.iter().enumerate() {
                    let (x, y) = (p / height, p % height);
                    assert_eq!(*inside, ids[y * width + x] == id, "id {id} at {x}, {y}");
                }
                assert_eq!(rle.area(), ids.iter().filter(|i| **i == id).count() as u64);
            }
        }
    }

    #[test]
    fn an_empty_picture_has_no_masks() {
        assert!(masks(&[0; 12], 4, 3).is_empty());
        assert!(masks(&[], 0, 0).is_empty());
    }
}
