//! Square textures with their mip levels.

/// How a texture's bytes are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// sRGB colour; filtered in linear light.
    Srgb,
    /// Plain numbers: masks, normals.
    Linear,
}

/// A square power-of-two texture of RGBA8 texels with all mip levels down to 1x1.
///
/// Level k has side `1 << (log2_size - k)` and starts at [`Texture::level_offset`] in `texels`;
/// rows run downwards. A texel is `r | g << 8 | b << 16 | a << 24`.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// log2 of the side of level 0.
    pub log2_size: u32,
    /// How the bytes are meant.
    pub encoding: Encoding,
    /// All levels, largest first.
    pub texels: Vec<u32>,
}

impl Texture {
    /// Index in `texels` of the first texel of a level.
    #[must_use]
    pub const fn level_offset(log2_size: u32, level: u32) -> usize {
        // Sum of 4^(n - k) for k in 0..level, with n = log2_size.
        ((1usize << (2 * (log2_size + 1))) - (1usize << (2 * (log2_size + 1 - level)))) / 3
    }
}
