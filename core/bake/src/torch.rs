//! Reads a PyTorch file that holds a dictionary of float vectors.
//!
//! Such a file is an uncompressed zip with a pickle, in which each key is followed by the number
//! of the member that holds its values. Only that much of either format is understood.

use std::path::Path;

use crate::BakeError;

/// Keys and vectors, in the file's order.
pub fn float_vectors(path: &Path) -> Result<Vec<(String, Vec<f32>)>, BakeError> {
    let bytes =
        std::fs::read(path).map_err(|e| BakeError::Io { path: path.to_owned(), source: e })?;
    let members = stored_members(&bytes)
        .ok_or_else(|| BakeError::content(path, "not an uncompressed zip file"))?;
    let find = |end: &str| members.iter().find(|m| m.0.ends_with(end)).map(|m| m.1);
    let pickle = find("/data.pkl").ok_or_else(|| BakeError::content(path, "no data.pkl"))?;
    let mut out = Vec::new();
    let mut key = None;
    for word in unicode_strings(pickle) {
        if word.bytes().all(|b| b.is_ascii_digit()) {
            let values = find(&format!("/data/{word}"))
                .ok_or_else(|| BakeError::content(path, format!("no member data/{word}")))?;
            let floats = values
                .chunks_exact(4)
                .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
                .collect();
            if let Some(key) = key.take() {
                out.push((key, floats));
            }
        } else if word != "storage" && word != "cpu" {
            key = Some(word);
        }
    }
    Ok(out)
}

fn u16_at(b: &[u8], i: usize) -> Option<usize> {
    Some(usize::from(u16::from_le_bytes(b.get(i..i + 2)?.try_into().ok()?)))
}

fn u32_at(b: &[u8], i: usize) -> Option<usize> {
    Some(u32::from_le_bytes(b.get(i..i + 4)?.try_into().ok()?) as usize)
}

/// Names and bytes of a zip's members, all of which must be stored.
fn stored_members(b: &[u8]) -> Option<Vec<(String, &[u8])>> {
    let end = b.windows(4).rposition(|w| w == b"PK\x05\x06")?;
    let (count, mut at) = (u16_at(b, end + 10)?, u32_at(b, end + 16)?);
    let mut out = Vec::with_capacity(count);
    for _ in 0..count {
        let (method, size) = (u16_at(b, at + 10)?, u32_at(b, at + 20)?);
        let (name, extra, comment) =
            (u16_at(b, at + 28)?, u16_at(b, at + 30)?, u16_at(b, at + 32)?);
        let local = u32_at(b, at + 42)?;
        let start = local + 30 + u16_at(b, local + 26)? + u16_at(b, local + 28)?;
        if method != 0 {
            return None;
        }
        let label = String::from_utf8(b.get(at + 46..at + 46 + name)?.to_vec()).ok()?;
        out.push((label, b.get(start..start + size)?));
        at += 46 + name + extra + comment;
    }
    Some(out)
}

/// Operands of the pickle's BINUNICODE opcodes (`X`, four bytes of length, text).
fn unicode_strings(p: &[u8]) -> Vec<String> {
    let (mut out, mut i) = (Vec::new(), 0);
    while i < p.len() {
        let text = (p[i] == b'X')
            .then(|| u32_at(p, i + 1))
            .flatten()
            .filter(|&n| n > 0 && n < 64)
            .and_then(|n| p.get(i + 5..i + 5 + n))
            .and_then(|t| std::str::from_utf8(t).ok())
            .filter(|t| t.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_'));
        if let Some(t) = text {
            out.push(t.to_owned());
            i += 5 + t.len();
        } else {
            i += 1;
        }
    }
    out
}
