//! A triangle mesh as the engines read it.

/// Indexed triangles with smooth normals, texture coordinates and, for figures, skin weights.
///
/// All arrays run over vertices and have the same length, but for `skin`, which is empty on a
/// rigid mesh. Model space, metres; front faces are counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Metres, model space.
    pub positions: Vec<[f32; 3]>,
    /// Unit length.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, v down, wrapping.
    pub uvs: Vec<[f32; 2]>,
    /// Joints and weights of each vertex, or empty.
    pub skin: Vec<SkinVertex>,
    /// Vertex indices, one triangle each.
    pub triangles: Vec<[u32; 3]>,
    /// Centre of a sphere round all vertices at rest, model space.
    pub center: [f32; 3],
    /// Radius of that sphere, metres.
    pub radius_m: f32,
}

impl Mesh {
    /// Bytes that the arrays occupy.
    #[must_use]
    pub const fn size_bytes(&self) -> usize {
        let vectors = self.positions.capacity() + self.normals.capacity();
        let small = self.uvs.capacity() + self.skin.capacity();
        12 * (vectors + self.triangles.capacity()) + 8 * small
    }

    /// Gives back memory beyond what the arrays need.
    pub fn shrink_to_fit(&mut self) {
        self.positions.shrink_to_fit();
        self.normals.shrink_to_fit();
        self.uvs.shrink_to_fit();
        self.skin.shrink_to_fit();
        self.triangles.shrink_to_fit();
    }
}

/// Up to four joints of one vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct SkinVertex {
    /// Joint indices.
    pub joints: [u8; 4],
    /// Weights in 1/255; they sum to 255.
    pub weights: [u8; 4],
}
