//! The table of passes: what each reads and writes, in execution order.

/// A value that passes hand on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Buffer {
    /// Skinned and placed vertices, view space.
    Vertices,
    /// Object, triangle and reversed depth of each sample.
    Visibility,
    /// Depth seen from the sun.
    ShadowMap,
    /// Exposed light of each pixel, linear.
    Radiance,
    /// The 8-bit sRGB picture.
    Picture,
    /// The object with most samples in each pixel.
    ObjectIds,
    /// Metres along the view axis of that object's nearest sample in each pixel.
    Depth,
    /// Count and extent of each object's visible samples.
    ObjectSamples,
    /// Posed keypoints, view space.
    Points,
}

/// A step of rendering a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pass {
    /// Poses the few vertices that keypoints are made of, on the host.
    Points,
    /// Skins and places all vertices.
    Skin,
    /// Rasterises object, triangle and depth.
    Visibility,
    /// Rasterises depth from the sun.
    Shadow,
    /// Shades each pixel once per object.
    Shade,
    /// Spreads light that is out of focus.
    Defocus,
    /// Draws light out along the ways of what moves.
    MotionBlur,
    /// Scatters light round what is bright.
    Bloom,
    /// Tone map and sRGB.
    Display,
    /// Per-pixel ids and depth.
    Resolve,
    /// Per-object counts and extents.
    Reduce,
}

impl Pass {
    /// All passes in execution order.
    pub const ALL: [Self; 11] = [
        Self::Points,
        Self::Skin,
        Self::Visibility,
        Self::Shadow,
        Self::Shade,
        Self::Defocus,
        Self::MotionBlur,
        Self::Bloom,
        Self::Display,
        Self::Resolve,
        Self::Reduce,
    ];

    /// What it reads.
    #[must_use]
    pub const fn reads(self) -> &'static [Buffer] {
        match self {
            Self::Points | Self::Skin => &[],
            Self::Visibility | Self::Shadow => &[Buffer::Vertices],
            Self::Shade => &[Buffer::Vertices, Buffer::Visibility, Buffer::ShadowMap],
            Self::Defocus => &[Buffer::Visibility, Buffer::Radiance],
            Self::MotionBlur => &[Buffer::Vertices, Buffer::Visibility, Buffer::Radiance],
            Self::Bloom | Self::Display => &[Buffer::Radiance],
            Self::Resolve | Self::Reduce => &[Buffer::Visibility],
        }
    }

    /// What it writes.
    #[must_use]
    pub const fn writes(self) -> &'static [Buffer] {
        match self {
            Self::Points => &[Buffer::Points],
            Self::Skin => &[Buffer::Vertices],
            Self::Visibility => &[Buffer::Visibility],
            Self::Shadow => &[Buffer::ShadowMap],
            Self::Shade | Self::Defocus | Self::MotionBlur | Self::Bloom => &[Buffer::Radiance],
            Self::Display => &[Buffer::Picture],
            Self::Resolve => &[Buffer::ObjectIds, Buffer::Depth],
            Self::Reduce => &[Buffer::ObjectSamples],
        }
    }
}
