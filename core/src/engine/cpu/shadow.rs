//! Shadow: where the sun's depth map lies.
//!
//! A parallel projection is fitted to where the visible surfaces and the shadows that can fall on
//! them meet, with texels no finer than a pixel; casters are drawn whatever their distance towards
//! the sun. The map itself, and how it is looked up, is in [`map`].

pub(super) mod map;

use super::project::{Projection, SCREEN_BITS, ScreenVertex, Vertex, positions8};
use super::simd::{F32x8, I32x8, LANES, Mask8, Vec3x8, kernel};

/// Side of a tile of the map in texels.
pub(super) const TILE: usize = 64;
/// Texels left free around what the map is fitted to.
const MARGIN: f64 = 2.0;

/// An orthonormal frame with its third axis towards the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SunAxes([[f32; 3]; 3]);

impl SunAxes {
    /// A frame round a direction.
    pub(super) fn new(direction_to_sun: [f32; 3]) -> Self {
        let unit = |v: [f32; 3]| {
            let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt().max(1e-20);
            v.map(|x| x / length)
        };
        let cross = |a: [f32; 3], b: [f32; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let to_sun = unit(direction_to_sun);
        let helper = if to_sun[1].abs() < 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
        let right = unit(cross(helper, to_sun));
        Self([right, cross(to_sun, right), to_sun])
    }

    /// A point's coordinates along the three axes, metres.
    pub(super) fn coordinates(&self, p: [f32; 3]) -> [f32; 3] {
        self.0.map(|axis| axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2])
    }

    #[inline(always)]
    fn coordinates8<const AVX2: bool>(&self, p: Vec3x8<AVX2>) -> [F32x8<AVX2>; 3] {
        let [right, up, to_sun] = self.0;
        [Vec3x8::splat(right).dot(p), Vec3x8::splat(up).dot(p), Vec3x8::splat(to_sun).dot(p)]
    }
}

/// A box along the sun's axes, metres, and how near to the camera anything in it comes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    min: [f32; 3],
    max: [f32; 3],
    /// Along the camera's axis.
    nearest_m: f32,
}

impl Default for Bounds {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Bounds {
    /// Holds nothing.
    pub(super) const EMPTY: Self =
        Self { min: [f32::MAX; 3], max: [f32::MIN; 3], nearest_m: f32::MAX };

    /// Grows to hold a point of view space.
    pub(super) fn add(&mut self, point: [f32; 3], axes: &SunAxes) {
        let p = axes.coordinates(point);
        self.nearest_m = self.nearest_m.min(-point[2]);
        for axis in 0..3 {
            self.min[axis] = self.min[axis].min(p[axis]);
            self.max[axis] = self.max[axis].max(p[axis]);
        }
    }

    /// Whether a shadow of what is in here can fall on what is in another box.
    pub(super) fn may_shade(&self, receivers: &Self) -> bool {
        let beside = (0..2).any(|axis| {
            self.max[axis] < receivers.min[axis] || self.min[axis] > receivers.max[axis]
        });
        // Deeper than anything seen, it is in others' shadow and shades nothing.
        !beside && self.max[2] >= receivers.min[2]
    }

    /// Grows to hold another box.
    pub(super) fn join(&self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|i| self.min[i].min(other.min[i])),
            max: std::array::from_fn(|i| self.max[i].max(other.max[i])),
            nearest_m: self.nearest_m.min(other.nearest_m),
        }
    }
}

kernel! {
    /// Bounds of all vertices, and of those within the picture.
    fn bound_vertices(
        vertices: &[Vertex],
        screen: &[ScreenVertex],
        size: [u32; 2],
        axes: &SunAxes,
    ) -> (Bounds, Bounds) = bound_body
}

#[inline(always)]
fn bound_body<const AVX2: bool>(
    vertices: &[Vertex],
    screen: &[ScreenVertex],
    size: [u32; 2],
    axes: &SunAxes,
) -> (Bounds, Bounds) {
    let [width, height] = size.map(|s| (s as i32) << SCREEN_BITS);
    let (low, high) = (F32x8::<AVX2>::splat(f32::MAX), F32x8::<AVX2>::splat(f32::MIN));
    let (mut all, mut seen) = ([[low, high]; 3], [[low, high]; 3]);
    let (mut nearest_all, mut nearest_seen) = (low, low);
    for (vertices, screen) in vertices.chunks_exact(LANES).zip(screen.chunks_exact(LANES)) {
        let (mut x, mut y) = ([0; LANES], [0; LANES]);
        for lane in 0..LANES {
            (x[lane], y[lane]) = (screen[lane].x, screen[lane].y);
        }
        let visible = within::<AVX2>(I32x8(x), width) & within(I32x8(y), height);
        let position = positions8(vertices);
        nearest_all = nearest_all.min(-position.z);
        nearest_seen = nearest_seen.min(visible.select(-position.z, low));
        let p = axes.coordinates8(position);
        for axis in 0..3 {
            all[axis][0] = all[axis][0].min(p[axis]);
            all[axis][1] = all[axis][1].max(p[axis]);
            seen[axis][0] = seen[axis][0].min(visible.select(p[axis], low));
            seen[axis][1] = seen[axis][1].max(visible.select(p[axis], high));
        }
    }
    (narrowed(&all, nearest_all), narrowed(&seen, nearest_seen))
}

/// Whether whole numbers lie in `0..=end`.
#[inline(always)]
fn within<const AVX2: bool>(v: I32x8<AVX2>, end: i32) -> Mask8<AVX2> {
    v.gt(I32x8::splat(-1)) & I32x8::splat(end + 1).gt(v)
}

/// Eight boxes to one.
#[inline(always)]
fn narrowed<const AVX2: bool>(b: &[[F32x8<AVX2>; 2]; 3], nearest: F32x8<AVX2>) -> Bounds {
    Bounds {
        min: [b[0][0].smallest(), b[1][0].smallest(), b[2][0].smallest()],
        max: [b[0][1].largest(), b[1][1].largest(), b[2][1].largest()],
        nearest_m: nearest.smallest(),
    }
}

/// How points are found in the shadow map.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadowView {
    /// The map as a picture.
    pub(super) projection: Projection,
    /// Texel column, texel row and depth of a view-space point.
    rows: [[f32; 4]; 3],
    /// Larger side of a texel, metres.
    texel_m: f32,
    /// Change of depth over a metre towards the sun.
    depth_per_m: f32,
}

impl ShadowView {
    /// Fits a map of at most `largest` texels a side; nothing if no shadow can be seen. Texels are
    /// no finer than a pixel at the nearest receiver, which is half a pixel at twice its distance.
    pub(super) fn fit(
        axes: &SunAxes,
        casters: &Bounds,
        receivers: &Bounds,
        largest: u32,
        focal_px: f32,
    ) -> Option<Self> {
        let mut low = [0.0; 2];
        let mut scale = [0.0; 2];
        let mut size = [0; 2];
        let pixel_m = f64::from(receivers.nearest_m / focal_px);
        for axis in 0..2 {
            low[axis] = f64::from(casters.min[axis].max(receivers.min[axis]));
            let high = f64::from(casters.max[axis].min(receivers.max[axis]));
            if high < low[axis] {
                return None;
            }
            let extent_m = (high - low[axis]).max(1e-3);
            let texels = (extent_m / pixel_m + 2.0 * MARGIN).min(f64::from(largest));
            size[axis] = (texels.ceil() as u32).next_multiple_of(TILE as u32).min(largest);
            scale[axis] = (f64::from(size[axis]) - 2.0 * MARGIN) / extent_m;
        }
        let both = casters.join(receivers);
        let [far, near] = [both.min[2], both.max[2]].map(f64::from);
        // Depth stays above 0, which means that nothing casts.
        let depth_scale = 0.998 / (near - far).max(1e-3);
        let row = |axis: usize, scale: f64, offset: f64| -> [f64; 4] {
            let a = axes.0[axis].map(f64::from);
            [a[0] * scale, a[1] * scale, a[2] * scale, offset]
        };
        // Rows run down, against the second axis, so that front faces turn as in a picture.
        let x = row(0, scale[0], MARGIN - low[0] * scale[0]);
        let y = row(1, -scale[1], f64::from(size[1]) - MARGIN + low[1] * scale[1]);
        let depth = row(2, depth_scale, 0.001 - far * depth_scale);
        Some(Self {
            projection: Projection::parallel(x, y, depth, size),
            rows: [x, y, depth].map(|r| r.map(|v| v as f32)),
            texel_m: (1.0 / scale[0].min(scale[1])) as f32,
            depth_per_m: depth_scale as f32,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_a_right_handed_frame() {
        for d in [[0.0, 1.0, 0.0], [0.3, -0.5, 0.8], [1.0, 0.0, 0.0]] {
            let SunAxes([r, u, s]) = SunAxes::new(d);
            let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            for (a, b) in [(r, u), (u, s), (s, r)] {
                assert!(dot(a, b).abs() < 1e-6);
            }
            let cross =
                [r[1] * u[2] - r[2] * u[1], r[2] * u[0] - r[0] * u[2], r[0] * u[1] - r[1] * u[0]];
            assert!(dot(cross, s) > 0.999_99 && dot(d, s) > 0.9);
        }
    }
}
