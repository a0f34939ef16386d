//! The stages: which shader each is, what it reads and writes, and its source text.
//!
//! A shader is plain text: the constants of its variant, the shared files that it needs, and its
//! own file. Texts are embedded; [`super::reload`] can put others in their place.

use wgpu::naga::valid::Capabilities;

use super::reload::Sources;
use super::variant::Variant;
use Access::{Read, Uniform, Write};
use Resource as R;

/// A file of the folder of shaders.
macro_rules! file {
    ($name:literal) => {
        ($name, include_str!(concat!("../../../../shaders/", $name)))
    };
}

/// What stands at the bindings of shading: what it writes, and what more it reads.
macro_rules! shading {
    ($written:ident $(, $more:ident)?) => {
        &[
            (R::Frame, Uniform),
            (R::Target, Uniform),
            (R::Primitives, Read),
            (R::Surfaces, Read),
            (R::Vertices, Read),
            (R::Samples, Read),
            (R::Texels, Read),
            (R::Lights, Uniform),
            (R::SunView, Uniform),
            (R::ShadowMap, Read),
            (R::$written, Write),
            (R::Blockers, Uniform),
            $((R::$more, Read),)?
        ]
    };
}

/// The files of shading, with the one that knows rays through pixels.
macro_rules! shading_files {
    ($($rays:literal),+) => {
        &[
            ABI,
            file!("shared/texture.wgsl"),
            $(file!($rays)),+,
            NORMAL,
            file!("shared/surface.wgsl"),
            file!("shared/material.wgsl"),
            file!("shared/sunlight.wgsl"),
            file!("shared/environment.wgsl"),
            file!("shared/blockers.wgsl"),
            file!("shared/light.wgsl"),
            file!("shared/develop.wgsl"),
            file!("shared/display.wgsl"),
            LIGHT_OF_PIXELS,
            file!("shade.wgsl"),
        ]
    };
}

/// A buffer that stages read or write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Resource {
    /// [`super::abi::Frame`].
    Frame,
    /// [`super::abi::Target`] of the camera's picture, and of the sun's map.
    Target,
    SunTarget,
    /// Likewise of the plane that the picture's triangles are set up in: the picture itself, or what
    /// lies behind its lens.
    Plane,
    VertexBatches,
    Batches,
    SunBatches,
    Meshes,
    Texels,
    Palette,
    Surfaces,
    Lights,
    Blockers,
    Vertices,
    Screen,
    Primitives,
    SunPrimitives,
    Counters,
    SunCounters,
    Bounds,
    /// Triangles that are left to the clipping, of the picture, then of the sun's map.
    Crossing,
    Tiles,
    Lists,
    Samples,
    /// [`super::abi::SunView`], then texels.
    ShadowMap,
    /// The first of the sun's map once more, as a small block.
    SunView,
    Picture,
    Resolved,
    Sums,
    /// The light of pixels where it is kept: of the whole picture.
    Light,
    /// Depth of field: what lies before the focus and beyond, the widest disks, what disks bring.
    Layers,
    Widest,
    Gathered,
    /// Motion blur: ways of pixels, the longest of tiles, and light drawn out.
    Ways,
    Longest,
    DrawnOut,
    /// Levels of scattered light; all [`super::abi::Step`]s between them, and the one in hand.
    Scattered,
    Steps,
    Step,
    /// See `shared/lens_tiles.wgsl`.
    Squares,
    /// Where the band's samples lie behind a lens, and rays through its pixels.
    Places,
    Rays,
}

/// What shaders ask of a device beyond WGSL's least: numbers of half width in memory, which every
/// device of WebGPU has.
pub const CAPABILITIES: Capabilities = Capabilities::SHADER_FLOAT16_IN_FLOAT32;

/// How a stage uses a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// A small read-only block.
    Uniform,
    /// Storage.
    Read,
    /// Storage.
    Write,
}

/// A compute shader with its buffers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    Skin,
    Setup,
    Clip,
    Bound,
    Fit,
    Project,
    SunSetup,
    SunClip,
    Shadow,
    Count,
    Scan,
    Scatter,
    Raster,
    Resolve,
    Reduce,
    Shade,
    /// In place of `Shade` where light is kept.
    KeepLight,
    Split,
    Gather,
    Compose,
    Way,
    Longest,
    Streak,
    Halve,
    Widen,
    Finish,
    /// Behind a lens.
    LensCount,
    LensScatter,
    LensRaster,
    LensShade,
    LensKeepLight,
    LensWay,
}

impl Stage {
    /// All stages in the order in which a frame runs them.
    pub const ALL: [Self; 32] = [
        Self::Skin,
        Self::Setup,
        Self::Clip,
        Self::Bound,
        Self::Fit,
        Self::Project,
        Self::SunSetup,
        Self::SunClip,
        Self::Shadow,
        Self::Count,
        Self::Scan,
        Self::Scatter,
        Self::Raster,
        Self::Resolve,
        Self::Reduce,
        Self::Shade,
        Self::KeepLight,
        Self::Split,
        Self::Gather,
        Self::Compose,
        Self::Way,
        Self::Longest,
        Self::Streak,
        Self::Halve,
        Self::Widen,
        Self::Finish,
        Self::LensCount,
        Self::LensScatter,
        Self::LensRaster,
        Self::LensShade,
        Self::LensKeepLight,
        Self::LensWay,
    ];

    /// What runs in its place behind a lens.
    pub const fn behind_lens(self) -> Self {
        match self {
            Self::Count => Self::LensCount,
            Self::Scatter => Self::LensScatter,
            Self::Raster => Self::LensRaster,
            Self::Shade => Self::LensShade,
            Self::KeepLight => Self::LensKeepLight,
            Self::Way => Self::LensWay,
            other => other,
        }
    }

    /// The name in lists of times.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Skin => "skin",
            Self::Setup | Self::Clip => "setup",
            Self::Bound | Self::Fit => "shadow fit",
            Self::Project | Self::SunSetup | Self::SunClip => "shadow setup",
            Self::Shadow => "shadow raster",
            Self::Count | Self::Scan | Self::Scatter | Self::LensCount | Self::LensScatter => "bin",
            Self::Raster | Self::LensRaster => "raster",
            Self::Resolve => "resolve",
            Self::Reduce => "reduce",
            Self::Shade | Self::KeepLight | Self::LensShade | Self::LensKeepLight => "shade",
            Self::Split | Self::Gather | Self::Compose => "depth of field",
            Self::Way | Self::LensWay | Self::Longest | Self::Streak => "motion blur",
            Self::Halve | Self::Widen => "bloom",
            Self::Finish => "display",
        }
    }

    /// The shader's entry point.
    pub const fn entry(self) -> &'static str {
        match self {
            Self::Count | Self::LensCount => "count",
            Self::Scatter | Self::LensScatter => "scatter",
            _ => "main",
        }
    }

    /// Whether there is a form of it for each number of samples a pixel.
    pub const fn by_samples(self) -> bool {
        matches!(
            self,
            Self::Raster
                | Self::Resolve
                | Self::Reduce
                | Self::Shade
                | Self::KeepLight
                | Self::Way
                | Self::LensWay
                | Self::LensRaster
                | Self::LensShade
                | Self::LensKeepLight
        )
    }

    /// What stands at each binding.
    pub const fn bindings(self) -> &'static [(Resource, Access)] {
        match self {
            Self::Skin => &[
                (R::Frame, Uniform),
                (R::Plane, Uniform),
                (R::VertexBatches, Read),
                (R::Meshes, Read),
                (R::Palette, Read),
                (R::Vertices, Write),
                (R::Screen, Write),
                (R::Counters, Write),
            ],
            Self::Setup => &[
                (R::Frame, Uniform),
                (R::Plane, Uniform),
                (R::Batches, Read),
                (R::Meshes, Read),
                (R::Screen, Read),
                (R::Primitives, Write),
                (R::Counters, Write),
                (R::Crossing, Write),
            ],
            Self::SunSetup => &[
                (R::Frame, Uniform),
                (R::SunTarget, Uniform),
                (R::SunBatches, Read),
                (R::Meshes, Read),
                (R::Screen, Read),
                (R::SunPrimitives, Write),
                (R::SunCounters, Write),
                (R::Crossing, Write),
                (R::ShadowMap, Write),
            ],
            Self::Clip => &[
                (R::Frame, Uniform),
                (R::Plane, Uniform),
                (R::Batches, Read),
                (R::Meshes, Read),
                (R::Vertices, Read),
                (R::Primitives, Write),
                (R::Counters, Write),
                (R::Crossing, Read),
                (R::Bounds, Write),
            ],
            Self::SunClip => &[
                (R::Frame, Uniform),
                (R::SunTarget, Uniform),
                (R::SunBatches, Read),
                (R::Meshes, Read),
                (R::Vertices, Read),
                (R::SunPrimitives, Write),
                (R::SunCounters, Write),
                (R::Crossing, Read),
                (R::Bounds, Write),
            ],
            Self::Bound => &[
                (R::Frame, Uniform),
                (R::Plane, Uniform),
                (R::VertexBatches, Read),
                (R::Vertices, Read),
                (R::Screen, Read),
                (R::Bounds, Write),
            ],
            Self::Fit => &[
                (R::Frame, Uniform),
                (R::Bounds, Write),
                (R::SunTarget, Write),
                (R::ShadowMap, Write),
            ],
            Self::Project => &[
                (R::Frame, Uniform),
                (R::SunTarget, Uniform),
                (R::VertexBatches, Read),
                (R::Vertices, Read),
                (R::Screen, Write),
                (R::Bounds, Read),
            ],
            Self::Count | Self::Scatter => &[
                (R::Frame, Uniform),
                (R::Target, Uniform),
                (R::Primitives, Write),
                (R::Counters, Write),
                (R::Tiles, Write),
                (R::Lists, Write),
            ],
            Self::LensCount | Self::LensScatter => &[
                (R::Frame, Uniform),
                (R::Target, Uniform),
                (R::Primitives, Write),
                (R::Counters, Write),
                (R::Tiles, Write),
                (R::Lists, Write),
                (R::Squares, Read),
            ],
            Self::Scan => &[
                (R::Frame, Uniform),
                (R::Target, Uniform),
                (R::Tiles, Write),
                (R::Counters, Write),
            ],
            Self::Raster => &[
                (R::Frame, Uniform),
                (R::Target, Uniform),
                (R::Primitives, Read),
                (R::Counters, Read),
                (R::Tiles, Read),
                (R::Lists, Read),
                (R::Samples, Write),
                (R::Vertices, Read),
            ],
            Self::LensRaster => &[
                (R::Frame, Uniform),
                (R::Target, Uniform),
                (R::Primitives, Read),
                (R::Counters, Read),
                (R::Tiles, Read),
                (R::Lists, Read),
                (R::Samples, Write),
                (R::Vertices, Read),
                (R::Places, Read),
            ],
            Self::Shadow => &[
                (R::Frame, Uniform),
                (R::SunTarget, Uniform),
                (R::SunPrimitives, Read),
                (R::SunCounters, Read),
                (R::ShadowMap, Write),
            ],
            Self::Resolve => &[
                (R::Frame, Uniform),
                (R::Target, Uniform),
                (R::Primitives, Read),
                (R::Surfaces, Read),
                (R::Samples, Read),
                (R::Resolved, Write),
            ],
            Self::Reduce => &[
                (R::Frame, Uniform),
                (R::Target, Uniform),
                (R::Primitives, Read),
                (R::Surfaces, Read),
                (R::Samples, Read),
                (R::Sums, Write),
            ],
            Self::Shade => shading!(Picture),
            Self::LensShade => shading!(Picture, Rays),
            Self::KeepLight => shading!(Light),
            Self::LensKeepLight => shading!(Light, Rays),
            Self::Split => {
                &[(R::Frame, Uniform), (R::Light, Read), (R::Layers, Write), (R::Widest, Write)]
            }
            Self::Gather => {
                &[(R::Frame, Uniform), (R::Layers, Read), (R::Widest, Read), (R::Gathered, Write)]
            }
            Self::Compose => &[(R::Frame, Uniform), (R::Gathered, Read), (R::Light, Write)],
            Self::Way => &[
                (R::Frame, Uniform),
                (R::Target, Uniform),
                (R::Primitives, Read),
                (R::Vertices, Read),
                (R::Samples, Read),
                (R::Ways, Write),
            ],
            Self::LensWay => &[
                (R::Frame, Uniform),
                (R::Target, Uniform),
                (R::Primitives, Read),
                (R::Vertices, Read),
                (R::Samples, Read),
                (R::Ways, Write),
                (R::Rays, Read),
            ],
            Self::Longest => &[(R::Frame, Uniform), (R::Ways, Write), (R::Longest, Write)],
            Self::Streak => &[
                (R::Frame, Uniform),
                (R::Light, Read),
                (R::Ways, Read),
                (R::Longest, Read),
                (R::DrawnOut, Write),
            ],
            Self::Halve => {
                &[(R::Frame, Uniform), (R::Step, Uniform), (R::Light, Read), (R::Scattered, Write)]
            }
            Self::Widen => &[(R::Frame, Uniform), (R::Step, Uniform), (R::Scattered, Write)],
            Self::Finish => {
                &[(R::Frame, Uniform), (R::Light, Read), (R::Scattered, Read), (R::Picture, Write)]
            }
        }
    }

    /// The whole text of its shader in a form.
    pub fn source(self, variant: Variant, sources: &Sources) -> String {
        let mut text = variant.of(self).constants();
        for file in self.files() {
            text += sources.text(*file);
            text.push('\n');
        }
        text
    }

    /// The file and its line where a line of the whole text stands, both from 1; nothing where no
    /// file holds it.
    pub fn place(
        self,
        variant: Variant,
        sources: &Sources,
        line: u32,
    ) -> Option<(&'static str, u32)> {
        let breaks = |text: &str| text.matches('\n').count() as u32;
        let mut line =
            line.checked_sub(breaks(&variant.of(self).constants())).filter(|l| *l > 0)?;
        for file in self.files() {
            let lines = breaks(sources.text(*file)) + 1;
            if line <= lines {
                return Some((file.0, line));
            }
            line -= lines;
        }
        None
    }

    /// The name of the file that no other stage's shader is about.
    pub fn name_of_file(self) -> &'static str {
        self.files().last().map_or("", |file| file.0)
    }

    /// Its files, each after those that it needs.
    pub fn files(self) -> &'static [File] {
        match self {
            Self::Skin => &[ABI, DOUBLE, PROJECT, NORMAL, file!("skin.wgsl")],
            Self::Project => &[ABI, DOUBLE, PROJECT, file!("project.wgsl")],
            Self::Bound => &[ABI, BOUNDS, file!("bound.wgsl")],
            Self::Fit => &[ABI, DOUBLE, BOUNDS, file!("fit.wgsl")],
            Self::Setup => &[ABI, WIDE, EDGE, TRIANGLE, file!("setup.wgsl")],
            Self::SunSetup => &[ABI, WIDE, EDGE, TRIANGLE, file!("sun_setup.wgsl")],
            Self::Clip | Self::SunClip => {
                &[ABI, DOUBLE, WIDE, EDGE, PROJECT, BOUNDS, TRIANGLE, file!("clip.wgsl")]
            }
            Self::Count | Self::Scatter => &[ABI, file!("shared/tiles.wgsl"), file!("bin.wgsl")],
            Self::LensCount | Self::LensScatter => {
                &[ABI, WIDE, EDGE, file!("shared/lens_tiles.wgsl"), file!("bin.wgsl")]
            }
            Self::Scan => &[ABI, file!("scan.wgsl")],
            Self::Raster => &[ABI, WIDE, EDGE, CUTOUT, KEPT, RASTER, file!("raster.wgsl")],
            Self::LensRaster => &[ABI, WIDE, EDGE, CUTOUT, KEPT, LENS_RASTER, file!("raster.wgsl")],
            Self::Shadow => &[ABI, WIDE, EDGE, file!("shadow.wgsl")],
            Self::Resolve => &[ABI, file!("resolve.wgsl")],
            Self::Reduce => &[ABI, file!("reduce.wgsl")],
            Self::Split => &[ABI, LIGHT_OF_PIXELS, DISK, file!("split.wgsl")],
            Self::Gather => &[ABI, DISK, file!("gather.wgsl")],
            Self::Compose => &[ABI, LIGHT_OF_PIXELS, DISK, file!("compose.wgsl")],
            Self::Way => &[ABI, file!("shared/ray.wgsl"), WAY, file!("way.wgsl")],
            Self::LensWay => &[
                ABI,
                file!("shared/way_rays.wgsl"),
                file!("shared/lens_ray.wgsl"),
                WAY,
                file!("way.wgsl"),
            ],
            Self::Longest => &[ABI, WAY, file!("longest.wgsl")],
            Self::Streak => &[ABI, LIGHT_OF_PIXELS, WAY, file!("streak.wgsl")],
            Self::Halve => &[ABI, LIGHT_OF_PIXELS, file!("halve.wgsl")],
            Self::Widen => &[ABI, LIGHT_OF_PIXELS, DRAWN_OUT, file!("widen.wgsl")],
            Self::Finish => &[
                ABI,
                LIGHT_OF_PIXELS,
                DRAWN_OUT,
                file!("shared/develop.wgsl"),
                file!("shared/display.wgsl"),
                file!("finish.wgsl"),
            ],
            Self::Shade | Self::KeepLight => shading_files!("shared/ray.wgsl"),
            Self::LensShade | Self::LensKeepLight => {
                shading_files!("shared/shade_rays.wgsl", "shared/lens_ray.wgsl")
            }
        }
    }
}

/// Name and text of a file of the folder of shaders.
pub type File = (&'static str, &'static str);

const ABI: File = file!("shared/abi.wgsl");
const DOUBLE: File = file!("shared/double.wgsl");
const WIDE: File = file!("shared/wide.wgsl");
const NORMAL: File = file!("shared/normal.wgsl");
const PROJECT: File = file!("shared/project.wgsl");
const BOUNDS: File = file!("shared/bounds.wgsl");
const TRIANGLE: File = file!("shared/triangle.wgsl");
const LIGHT_OF_PIXELS: File = file!("shared/light_of_pixels.wgsl");
const DISK: File = file!("shared/disk.wgsl");
const DRAWN_OUT: File = file!("shared/drawn_out.wgsl");
const WAY: File = file!("shared/way.wgsl");
const EDGE: File = file!("shared/edge.wgsl");
const KEPT: File = file!("shared/kept.wgsl");
const CUTOUT: File = file!("shared/cutout.wgsl");
const RASTER: File = file!("shared/raster.wgsl");
const LENS_RASTER: File = file!("shared/lens_raster.wgsl");

#[cfg(test)]
mod tests;
