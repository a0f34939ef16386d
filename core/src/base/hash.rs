//! Content hashes: how assets and documents are named, whatever their path.

/// A BLAKE3 hash as 64 hexadecimal digits.
#[must_use]
pub fn content_hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}
