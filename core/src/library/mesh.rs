//! A triangle mesh as the engines read it.

/// Indexed triangles with smooth normals, texture coordinates and, for figures, skin weights.
///
/// All arrays run over vertices and have the same length, but for `skin`, which is empty on a
/// rigid mesh. Model space, metres; front faces are counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Metres, model space.
    pub positions: Vec<[f32; 3]>,
    /// Away from the surface.
    pub normals: Vec<Normal>,
    /// Texture coordinates, v down, wrapping.
    pub uvs: Vec<[f32; 2]>,
    /// Joints and weights of each vertex, or empty.
    pub skin: Vec<SkinVertex>,
    /// One triangle each.
    pub triangles: Vec<Triangle>,
    /// Centre of a sphere round all vertices at rest, model space.
    pub center: [f32; 3],
    /// Radius of that sphere, metres.
    pub radius_m: f32,
}

impl Mesh {
    /// Bytes that the arrays occupy.
    #[must_use]
    pub const fn size_bytes(&self) -> usize {
        let eights = self.uvs.capacity() + self.skin.capacity() + self.triangles.capacity();
        12 * self.positions.capacity() + 8 * eights + 4 * self.normals.capacity()
    }

    /// Adds a vertex without skin weights; gives back its index.
    pub fn push(&mut self, position: [f32; 3], unit_normal: [f32; 3], uv: [f32; 2]) -> u32 {
        self.positions.push(position);
        self.normals.push(Normal::new(unit_normal));
        self.uvs.push(uv);
        self.positions.len() as u32 - 1
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

/// Strips of a mesh that show strands side by side instead of a whole surface, as of hair.
///
/// Over the texture coordinates, strand `k = floor(n u)` with `n` strands to 1 of u lies round the
/// middle of its share and ends before `v = 0`, where each has another end and width: with the bytes
/// `e` and `w` of a hash of `k`, `E = 0.75 e / 256` and `H = 0.30 + 0.32 w / 256`, there is something
/// where
///
/// ```text
/// |n u - k - 1/2| < H min(1, (v / frayed - E) / (1 - E))
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cutout {
    /// Strands to 1 of u, 1..=1023.
    pub strands_per_u: u16,
    /// Below which v strands become narrower, 1/1024.
    pub frayed_1024ths: u16,
}

impl Cutout {
    /// Factor of the hash: its bytes from bit 16 and from bit 24 on are `e` and `w` (of the golden
    /// ratio, so that neighbours differ).
    pub const MULTIPLIER: u32 = 0x9e37_79b1;
    /// `E` by `e`.
    pub const END: f32 = 0.75 / 256.0;
    /// `H` at 0 and by `w`.
    pub const HALF: [f32; 2] = [0.30, 0.32 / 256.0];

    /// Below which v strands become narrower.
    #[must_use]
    pub fn frayed_v(self) -> f32 {
        f32::from(self.frayed_1024ths.max(1)) / 1024.0
    }
}

/// Three vertex indices in 8 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct Triangle(u64);

impl Triangle {
    /// Most vertices that triangles can name.
    pub const MAX_VERTICES: u32 = 1 << 21;

    /// A triangle of three vertices, each below [`Triangle::MAX_VERTICES`].
    ///
    /// # Panics
    /// Where one is not.
    #[must_use]
    pub const fn new([a, b, c]: [u32; 3]) -> Self {
        assert!((a | b | c) < Self::MAX_VERTICES, "a mesh has at most two million vertices");
        Self(a as u64 | (b as u64) << 21 | (c as u64) << 42)
    }

    /// The vertices, in order.
    #[must_use]
    #[inline(always)]
    pub const fn get(self) -> [u32; 3] {
        const LOW: u64 = Triangle::MAX_VERTICES as u64 - 1;
        [(self.0 & LOW) as u32, (self.0 >> 21 & LOW) as u32, (self.0 >> 42) as u32]
    }

    /// Whether all triangles name none but the first so many vertices.
    #[must_use]
    pub fn all_within(triangles: &[Self], vertices: usize) -> bool {
        const ONE: u64 = Triangle::MAX_VERTICES as u64 - 1;
        const OUTER: u64 = ONE | ONE << 42;
        const ABOVE_OUTER: u64 = 1 << 21 | 1 << 63;
        const MIDDLE: u64 = ONE << 21;
        const ABOVE_MIDDLE: u64 = 1 << 42;
        let Some(last) = vertices.min(Self::MAX_VERTICES as usize).checked_sub(1) else {
            return triangles.is_empty();
        };
        // The bit above each number's room is set, and a subtraction takes it away where the number
        // is larger than the last. The outer two go together: the middle's room holds their bit.
        let outer = ABOVE_OUTER | last as u64 | (last as u64) << 42;
        let middle = ABOVE_MIDDLE | (last as u64) << 21;
        let kept = triangles.iter().fold(ABOVE_OUTER | ABOVE_MIDDLE, |kept, t| {
            let (of_outer, of_middle) = (outer - (t.0 & OUTER), middle - (t.0 & MIDDLE));
            kept & (of_outer & ABOVE_OUTER | of_middle & ABOVE_MIDDLE)
        });
        kept == ABOVE_OUTER | ABOVE_MIDDLE
    }
}

/// A direction in 4 bytes: the octahedron |x| + |y| + |z| = 1 unfolded onto a square (Meyer et al.,
/// "On floating-point normal vectors", EGSR 2010). Within 0.004 degrees of what was meant, and
/// exact along the axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct Normal([i16; 2]);

impl Normal {
    /// The nearest to a unit vector, or nearly.
    #[must_use]
    pub fn new([x, y, z]: [f32; 3]) -> Self {
        let sum = (x.abs() + y.abs() + z.abs()).max(f32::MIN_POSITIVE);
        let (x, y) = (x / sum, y / sum);
        let signed = |size: f32, of: f32| if of < 0.0 { -size } else { size };
        // The lower half is folded outwards over the upper half's edges.
        let flat =
            if z < 0.0 { [signed(1.0 - y.abs(), x), signed(1.0 - x.abs(), y)] } else { [x, y] };
        Self(flat.map(|v| {
            let units = v * 32_767.0;
            (if units < 0.0 { units - 0.5 } else { units + 0.5 }) as i16
        }))
    }

    /// The two numbers of the square, 16 bits each in units of 1/32,767, the first in the low half.
    #[must_use]
    pub const fn bits(self) -> u32 {
        let [x, y] = self.0;
        x as u16 as u32 | (y as u16 as u32) << 16
    }

    /// From the bits.
    #[must_use]
    pub const fn of_bits(bits: u32) -> Self {
        Self([bits as i16, (bits >> 16) as i16])
    }

    /// A vector of this direction, 0.57 to 1 long: what turns it scales it as well.
    #[must_use]
    #[inline(always)]
    pub fn direction(self) -> [f32; 3] {
        let [x, y] = self.0.map(|v| f32::from(v) * (1.0 / 32_767.0));
        let z = 1.0 - x.abs() - y.abs();
        let fold = (-z).max(0.0);
        let inwards = |v: f32| if v < 0.0 { v + fold } else { v - fold };
        [inwards(x), inwards(y), z]
    }

    /// The unit vector.
    #[must_use]
    pub fn unit(self) -> [f32; 3] {
        let d = self.direction();
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        d.map(|v| v / length)
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

impl SkinVertex {
    /// Joints with shares that sum to 1: rounded so that the weights sum to 255.
    #[must_use]
    pub fn of_shares(joints: [u8; 4], shares: [f64; 4]) -> Self {
        let (mut sum, mut before) = (0.0, 0);
        let weights = shares.map(|share| {
            sum += share;
            let end = (sum * 255.0 + 0.5) as u8;
            let own = end - before;
            before = end;
            own
        });
        Self { joints, weights }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_come_back_within_a_few_thousandths_of_a_degree() {
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let mut unit = [0.0; 3];
                unit[axis] = sign;
                assert_eq!(Normal::new(unit).unit(), unit);
            }
        }
        for i in 0..2000 {
            let (a, b) = (f64::from(i) * 2.399_963, 1.0 - f64::from(i) / 999.5);
            let flat = (1.0 - b * b).max(0.0).sqrt();
            let unit = [flat * libm::cos(a), b, flat * libm::sin(a)];
            let normal = Normal::new(unit.map(|v| v as f32));
            let back = normal.unit().map(f64::from);
            let off: f64 = unit.iter().zip(back).map(|(u, v)| (u - v) * (u - v)).sum();
            assert!(off.sqrt().to_degrees() < 0.004, "{unit:?} {back:?}");
            let length = normal.direction().map(|v| v * v).iter().sum::<f32>().sqrt();
            assert!((0.57..=1.0001).contains(&length), "{length}");
        }
    }

    #[test]
    fn triangles_come_back() {
        for t in [[0, 1, 2], [90_600, 5, 70_000], [(1 << 21) - 1; 3]] {
            assert_eq!(Triangle::new(t).get(), t);
        }
    }

    #[test]
    fn a_vertex_beyond_the_last_is_seen_at_each_corner() {
        let most = Triangle::MAX_VERTICES - 1;
        for last in [0, 1, 54, 70_000, most] {
            for corners in [[last, 0, last], [0, last, 0], [last; 3]] {
                let fine = [Triangle::new([0; 3]), Triangle::new(corners)];
                assert!(Triangle::all_within(&fine, last as usize + 1), "{corners:?}");
                assert!(!Triangle::all_within(&fine, last as usize), "{corners:?}");
            }
            for corner in 0..3 {
                let mut corners = [0; 3];
                corners[corner] = last;
                let one = [Triangle::new(corners), Triangle::new([0; 3])];
                assert!(!Triangle::all_within(&one, last as usize), "{corners:?}");
                assert!(Triangle::all_within(&one, 1 << 30));
            }
        }
        assert!(Triangle::all_within(&[], 0));
    }

    #[test]
    #[should_panic(expected = "two million")]
    fn a_vertex_that_has_no_room_is_refused() {
        let _ = Triangle::new([0, 1 << 21, 0]);
    }
}
