//! Triangles on their way to the raster: up to 4096 of one draw at a time.
//!
//! A chunk is the unit of set-up and of ids: a sample's id is the chunk's index and the triangle's
//! index within the chunk. Its buffers live on from frame to frame.

use std::ops::Range;

use super::bin::{Bins, ChunksByTile};
use super::cutout::CutPlanes;
use super::shadow::Bounds;
use super::skin::Placed;
use crate::draw::DrawList;
use crate::engine::EngineError;
use crate::library::mesh::Cutout;

/// Triangles of a mesh that make a chunk.
const CHUNK: u32 = 4096;
/// Binary digits of the triangle in an id: clipping makes up to six triangles of one.
const TRIANGLE_BITS: u32 = 15;
/// Id of a sample that shows nothing.
pub(super) const NOTHING: u32 = u32::MAX;

/// Chunk and triangle of an id.
#[inline(always)]
pub(super) const fn split_id(id: u32) -> (usize, usize) {
    ((id >> TRIANGLE_BITS) as usize, (id & ((1 << TRIANGLE_BITS) - 1)) as usize)
}

/// The id of the first triangle of a chunk; the others follow.
#[inline(always)]
pub(super) const fn first_id(chunk: usize) -> u32 {
    (chunk as u32) << TRIANGLE_BITS
}

/// Whether two ids are of the same chunk.
#[inline(always)]
pub(super) const fn same_chunk(a: u32, b: u32) -> bool {
    (a ^ b) >> TRIANGLE_BITS == 0
}

/// Depth as a linear function of the position in the picture, which it is on every plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DepthPlane {
    /// At the picture's top-left corner.
    pub(super) origin: f64,
    /// Per pixel to the right.
    pub(super) dx: f64,
    /// Per pixel down.
    pub(super) dy: f64,
}

/// A triangle that may cover samples, its corners clockwise on screen: one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Triangle {
    /// Raster coordinates.
    pub(super) x: [i32; 3],
    /// Raster coordinates.
    pub(super) y: [i32; 3],
    /// See [`DepthPlane`].
    pub(super) plane: DepthPlane,
    /// Largest depth of the three corners.
    pub(super) nearest: f32,
    /// First and last pixel of the picture in x, then in y, that may hold covered samples.
    pub(super) pixels: [u16; 4],
    /// Too large for 32-bit edge functions over a whole tile.
    pub(super) large: bool,
}

/// What shading needs of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Vertices of the unclipped triangle.
    pub(super) corners: [u32; 3],
    /// Direction of its plane's normal in 1/127, either way round.
    pub(super) normal: [i8; 3],
}

/// Up to 4096 triangles of a draw.
#[derive(Default)]
pub(super) struct Chunk {
    /// Index in the draw list.
    pub(super) draw: u32,
    /// Index in the draw list.
    pub(super) object: u32,
    /// Triangles of the mesh.
    pub(super) source: Range<usize>,
    /// Where the object's vertices start.
    pub(super) first_vertex: u32,
    /// Counter-clockwise triangles of the mesh are back faces.
    pub(super) mirrored: bool,
    /// Back faces are drawn, too.
    pub(super) double_sided: bool,
    /// Which part of the triangles there is.
    pub(super) cutout: Option<Cutout>,
    /// Samples of the draw in one pixel may share their shading.
    pub(super) smooth: bool,
    /// Triangles that may cover samples.
    pub(super) triangles: Vec<Triangle>,
    /// For each of `triangles`; empty where nothing is shaded.
    pub(super) faces: Vec<Face>,
    /// For each of `triangles` where there is a cutout that samples look at.
    pub(super) cuts: Vec<CutPlanes>,
    /// Which triangles touch which tile.
    pub(super) bins: Bins,
    /// Triangles of the mesh that need clipping.
    pub(super) crossing: Vec<[u32; 3]>,
    /// Triangles of the mesh that reach over the picture's border.
    pub(super) border: Vec<[u32; 3]>,
    /// Bounds, along the sun's axes, of the visible parts of `border` and `crossing`.
    pub(super) border_bounds: Bounds,
}

/// Parts of a range of triangles, each a chunk.
fn divided(triangles: &Range<u32>) -> impl Iterator<Item = Range<u32>> {
    let end = triangles.end;
    (triangles.start..end).step_by(CHUNK as usize).map(move |start| start..end.min(start + CHUNK))
}

/// The chunks of one raster pass, in draw order.
#[derive(Default)]
pub(super) struct ChunkList {
    /// Those in use first, then buffers that this pass does not need.
    chunks: Vec<Chunk>,
    used: usize,
    by_tile: ChunksByTile,
}

impl ChunkList {
    /// Divides the triangles of all draws whose object is wanted.
    pub(super) fn fill(
        &mut self,
        list: &DrawList,
        placed: &Placed,
        wanted: &[bool],
    ) -> Result<(), EngineError> {
        let draws = list.draws.iter().enumerate();
        let parts: Vec<(usize, Range<u32>)> = draws
            .filter(|(_, draw)| wanted[draw.object as usize])
            .flat_map(|(index, draw)| divided(&draw.triangles).map(move |part| (index, part)))
            .collect();
        let limit = 1 << (32 - TRIANGLE_BITS);
        if parts.len() >= limit {
            let (what, got) = ("number of chunks of 4096 triangles", parts.len() as u64);
            return Err(EngineError::TooLarge { what, got, limit: limit as u64 - 1 });
        }
        self.hand_out_buffers(&parts);
        for (chunk, (index, part)) in self.chunks.iter_mut().zip(parts) {
            let draw = &list.draws[index];
            let object = draw.object as usize;
            chunk.draw = index as u32;
            chunk.object = draw.object;
            chunk.source = part.start as usize..part.end as usize;
            chunk.first_vertex = placed.first_vertex[object] as u32;
            chunk.mirrored = placed.mirrored[object];
            chunk.double_sided = draw.double_sided;
            chunk.cutout = draw.cutout;
            chunk.smooth = list.objects[object].smooth;
        }
        Ok(())
    }

    /// Gives the largest of the buffers there are to the parts with most triangles: if each part
    /// took what lay at its place, every buffer would grow to the largest part of all frames.
    fn hand_out_buffers(&mut self, parts: &[(usize, Range<u32>)]) {
        self.used = parts.len();
        let mut stock = std::mem::take(&mut self.chunks);
        stock.sort_by_key(|chunk| chunk.triangles.capacity());
        let mut by_size: Vec<usize> = (0..parts.len()).collect();
        by_size.sort_by_key(|&i| std::cmp::Reverse(parts[i].1.len()));
        self.chunks.resize_with(parts.len(), Chunk::default);
        for (place, chunk) in by_size.into_iter().zip(std::iter::from_fn(|| stock.pop())) {
            self.chunks[place] = chunk;
        }
        self.chunks.append(&mut stock);
    }

    /// Sorts the chunks, once set up, by the tiles of a picture, `1 << tile_log2` pixels wide.
    pub(super) fn sort_by_tile(&mut self, size: [u32; 2], tile_log2: u32) {
        let tiles = size.map(|side| side.div_ceil(1 << tile_log2));
        self.by_tile.fill(&self.chunks[..self.used], tiles);
    }

    /// Which chunks touch which tile.
    pub(super) const fn by_tile(&self) -> &ChunksByTile {
        &self.by_tile
    }

    pub(super) fn as_slice(&self) -> &[Chunk] {
        &self.chunks[..self.used]
    }

    pub(super) fn as_mut_slice(&mut self) -> &mut [Chunk] {
        &mut self.chunks[..self.used]
    }
}
