//! What skin looks like close up, as fields over the template: furrows of age, flushed places,
//! freckles and spots, and the line of the lashes.
//!
//! Places are those of the template in metres (+Y up, +Z forward, +X the figure's left), so that
//! one painting fits every face. Amounts are 0..1 unless said otherwise. How strongly they show on
//! whom is decided by those who use the maps, and which texels they fill in [`super::maps`].

/// Noise over a lattice: smooth, -1..1, by a hash of the lattice's points.
fn noise(p: [f32; 3], cell_m: f32, seed: u32) -> f32 {
    let q = p.map(|v| v / cell_m);
    let low = q.map(f32::floor);
    let base = low.map(|v| v as i32);
    let t: [f32; 3] = std::array::from_fn(|i| {
        let f = q[i] - low[i];
        f * f * (3.0 - 2.0 * f)
    });
    let at = |x: i32, y: i32, z: i32| unit(hash([base[0] + x, base[1] + y, base[2] + z], seed));
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let row = |y: i32, z: i32| mix(at(0, y, z), at(1, y, z), t[0]);
    let plane = |z: i32| mix(row(0, z), row(1, z), t[1]);
    2.0 * mix(plane(0), plane(1), t[2]) - 1.0
}

/// A hash of a lattice point: the primes of Teschner and others, "Optimized spatial hashing for
/// collision detection of deformable objects", 2003, and the finaliser of MurmurHash3 (Appleby,
/// placed in the public domain).
const fn hash([x, y, z]: [i32; 3], seed: u32) -> u32 {
    let mut h = (x as u32).wrapping_mul(73_856_093)
        ^ (y as u32).wrapping_mul(19_349_663)
        ^ (z as u32).wrapping_mul(83_492_791)
        ^ seed.wrapping_mul(0x9e37_79b9);
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    h ^ (h >> 16)
}

fn unit(h: u32) -> f32 {
    (h >> 8) as f32 / 16_777_216.0
}

/// 0 below a, 1 above b, smooth between; falling where a > b.
pub(super) fn step(a: f32, b: f32, x: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// 1 at the middle of a ball on the template, 0 from its surface on; the same on both sides.
fn ball([x, y, z]: [f32; 3], middle: [f32; 3], radius: f32) -> f32 {
    let d = [x.abs() - middle[0], y - middle[1], z - middle[2]];
    step(radius * radius, 0.0, d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
}

/// A furrow of the face.
struct Furrow {
    /// Distance from the middle of the face and height, and how deep it is there as a share.
    line: &'static [[f32; 3]],
    depth_m: f32,
    half_m: f32,
}

const fn furrow(depth_m: f32, half_m: f32, line: &'static [[f32; 3]]) -> Furrow {
    Furrow { line, depth_m, half_m }
}

/// How far lines bulge beyond the heights of their ends, at most.
const BULGE_M: f32 = 0.008;

/// Where faces crease with age: forehead, between the brows, beside and below the eyes, from the
/// nose and the corners of the mouth downwards, round the lips, down the cheeks.
const FURROWS: [Furrow; 25] = [
    furrow(
        5e-4,
        1.7e-3,
        &[[0.0, 0.7655, 0.7], [0.014, 0.7675, 1.0], [0.030, 0.7685, 0.8], [0.046, 0.7640, 0.0]],
    ),
    furrow(
        6e-4,
        1.7e-3,
        &[[0.0, 0.7740, 1.0], [0.016, 0.7755, 1.0], [0.032, 0.7765, 0.9], [0.050, 0.7730, 0.0]],
    ),
    furrow(
        5e-4,
        1.7e-3,
        &[[0.0, 0.7815, 0.9], [0.016, 0.7830, 1.0], [0.032, 0.7835, 0.7], [0.046, 0.7815, 0.0]],
    ),
    furrow(4e-4, 1.5e-3, &[[0.0, 0.7880, 0.7], [0.018, 0.7890, 0.8], [0.036, 0.7885, 0.0]]),
    furrow(7e-4, 1.6e-3, &[[0.0060, 0.7400, 0.2], [0.0068, 0.7490, 1.0], [0.0085, 0.7590, 0.0]]),
    furrow(4e-4, 1.3e-3, &[[0.0, 0.7365, 1.0], [0.0080, 0.7355, 0.0]]),
    furrow(5e-4, 1.2e-3, &[[0.0480, 0.7335, 0.0], [0.0545, 0.7375, 1.0], [0.0625, 0.7430, 0.0]]),
    furrow(6e-4, 1.2e-3, &[[0.0480, 0.7305, 0.0], [0.0550, 0.7315, 1.0], [0.0650, 0.7325, 0.0]]),
    furrow(5e-4, 1.2e-3, &[[0.0475, 0.7280, 0.0], [0.0545, 0.7250, 1.0], [0.0635, 0.7215, 0.0]]),
    furrow(4e-4, 1.2e-3, &[[0.0455, 0.7245, 0.0], [0.0515, 0.7190, 1.0], [0.0585, 0.7125, 0.0]]),
    furrow(
        9e-4,
        2.2e-3,
        &[
            [0.0200, 0.7230, 0.2],
            [0.0250, 0.7180, 1.0],
            [0.0335, 0.7155, 1.0],
            [0.0420, 0.7180, 0.6],
            [0.0470, 0.7225, 0.0],
        ],
    ),
    furrow(
        4e-4,
        1.4e-3,
        &[
            [0.0230, 0.7150, 0.0],
            [0.0290, 0.7110, 1.0],
            [0.0370, 0.7105, 1.0],
            [0.0440, 0.7130, 0.0],
        ],
    ),
    furrow(3e-4, 1.1e-3, &[[0.0250, 0.7205, 0.0], [0.0330, 0.7190, 1.0], [0.0410, 0.7210, 0.0]]),
    furrow(
        1.6e-3,
        3.4e-3,
        &[
            [0.0155, 0.6990, 0.3],
            [0.0215, 0.6910, 1.0],
            [0.0290, 0.6790, 1.0],
            [0.0345, 0.6660, 0.8],
            [0.0370, 0.6530, 0.0],
        ],
    ),
    furrow(
        1.1e-3,
        2.6e-3,
        &[
            [0.0300, 0.6590, 0.2],
            [0.0325, 0.6490, 1.0],
            [0.0330, 0.6370, 0.5],
            [0.0310, 0.6290, 0.0],
        ],
    ),
    furrow(5e-4, 2.4e-3, &[[0.0, 0.6440, 1.0], [0.0100, 0.6435, 1.0], [0.0190, 0.6405, 0.0]]),
    furrow(
        6e-4,
        2.0e-3,
        &[
            [0.0490, 0.7040, 0.0],
            [0.0535, 0.6890, 1.0],
            [0.0545, 0.6700, 0.7],
            [0.0520, 0.6540, 0.0],
        ],
    ),
    furrow(4e-4, 1.8e-3, &[[0.0420, 0.6960, 0.0], [0.0455, 0.6830, 1.0], [0.0460, 0.6660, 0.0]]),
    furrow(3e-4, 0.9e-3, &[[0.0045, 0.6735, 0.8], [0.0050, 0.6800, 0.0]]),
    furrow(3e-4, 0.9e-3, &[[0.0095, 0.6735, 0.9], [0.0105, 0.6805, 0.0]]),
    furrow(3e-4, 0.9e-3, &[[0.0150, 0.6720, 0.9], [0.0170, 0.6790, 0.0]]),
    furrow(3e-4, 0.9e-3, &[[0.0205, 0.6695, 0.9], [0.0240, 0.6755, 0.0]]),
    furrow(3e-4, 0.9e-3, &[[0.0060, 0.6525, 0.8], [0.0065, 0.6470, 0.0]]),
    furrow(3e-4, 0.9e-3, &[[0.0130, 0.6530, 0.8], [0.0145, 0.6475, 0.0]]),
    furrow(3e-4, 0.9e-3, &[[0.0195, 0.6545, 0.7], [0.0220, 0.6500, 0.0]]),
];

/// Height of an old face's skin over a young one's, metres: furrows, the swellings beside them,
/// and slack skin.
pub(super) fn relief_m(p: [f32; 3]) -> f32 {
    let [x, y, z] = p;
    if z < 0.07 || !(0.60..0.80).contains(&y) {
        return 0.0;
    }
    // No furrow is quite straight, nor the same on both sides.
    let bend = [noise(p, 0.011, 1), noise(p, 0.011, 2)];
    let (ax, ay) = ((x + 0.0011 * bend[0]).abs(), y + 0.0011 * bend[1]);
    let uneven = 0.75 + 0.5 * noise(p, 0.017, 3);
    let mut height = 0.0;
    for f in &FURROWS {
        // Lines that are all above or all below cannot be near.
        let (first, last) = (f.line[0][1], f.line[f.line.len() - 1][1]);
        let reach = 3.0 * f.half_m + BULGE_M;
        if ay < first.min(last) - reach || ay > first.max(last) + reach {
            continue;
        }
        let (d, amount) = nearest(f.line, [ax, ay]);
        let t = d / f.half_m;
        if t < 3.0 {
            let dent = step(1.0, 0.0, t);
            let swell = step(0.5, 1.3, t) * step(3.0, 1.3, t);
            height += f.depth_m * amount * uneven * (0.45 * swell - dent);
        }
    }
    let cheek = step(0.02, 0.045, ax) * step(0.62, 0.66, y) * step(0.79, 0.74, y);
    height + 1.3e-4 * cheek * (noise(p, 0.0042, 4) + 0.6 * noise(p, 0.0023, 5))
}

/// Distance to a line, and the third numbers of its points there.
fn nearest(line: &[[f32; 3]], [x, y]: [f32; 2]) -> (f32, f32) {
    let mut best = (f32::MAX, 0.0);
    for pair in line.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let t = (((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
        let (ex, ey) = (x - a[0] - t * dx, y - a[1] - t * dy);
        let d = (ex * ex + ey * ey).sqrt();
        if d < best.0 {
            best = (d, a[2] + t * (b[2] - a[2]));
        }
    }
    best
}

/// How strongly blood shows through: cheeks, nose, ears, chin, lids, in blotches.
pub(super) fn flush(p: [f32; 3]) -> f32 {
    let [x, y, z] = p;
    let cheeks = 0.50 * ball(p, [0.043, 0.700, 0.125], 0.042);
    let nose =
        0.60 * ball(p, [0.0, 0.690, 0.168], 0.022) + 0.5 * ball(p, [0.014, 0.690, 0.15], 0.013);
    let chin = 0.35 * ball(p, [0.0, 0.640, 0.150], 0.022);
    let lids = 0.40 * ball(p, [0.032, 0.728, 0.140], 0.019)
        + 0.35 * ball(p, [0.0205, 0.7275, 0.137], 0.006);
    let ear = 0.75
        * step(0.071, 0.077, x.abs())
        * step(0.765, 0.755, y)
        * step(0.675, 0.690, y)
        * step(0.045, 0.035, z);
    let brow = 0.20 * ball(p, [0.0, 0.752, 0.155], 0.030);
    let face = cheeks + nose + chin + lids + brow;
    if face == 0.0 {
        return ear;
    }
    let blotch = 0.85 + 0.35 * noise(p, 0.013, 11) + 0.25 * noise(p, 0.006, 12);
    (face * blotch + ear).clamp(0.0, 1.0)
}

/// Unevenness of healthy skin, -1..1: fine grain over blotches.
pub(super) fn grain(p: [f32; 3]) -> f32 {
    0.55 * noise(p, 0.018, 21) + 0.35 * noise(p, 0.007, 22) + 0.35 * noise(p, 0.0022, 23)
}

/// Freckles of a face that has `many` (0..1): densest on nose and cheeks.
pub(super) fn freckles(p: [f32; 3], many: f32) -> f32 {
    let near = ball(p, [0.0, 0.708, 0.158], 0.030).max(ball(p, [0.036, 0.706, 0.135], 0.036));
    let wide = ball(p, [0.030, 0.715, 0.120], 0.085);
    let density = many * (0.75 * near + 0.28 * wide);
    dots(p, 0.0030, density, [0.34, 0.56], 31)
}

/// Spots of age: few, large and pale, on temples and cheeks.
pub(super) fn spots(p: [f32; 3]) -> f32 {
    let temple = ball(p, [0.066, 0.745, 0.075], 0.050).max(ball(p, [0.0, 0.81, 0.12], 0.060));
    let cheek = ball(p, [0.056, 0.695, 0.095], 0.045);
    dots(p, 0.0095, 0.42 * temple + 0.26 * cheek, [0.16, 0.36], 37)
}

/// Round dots on a lattice of cells: a share `density` of the cells has one, its radius within a
/// range of shares of the cell.
fn dots(p: [f32; 3], cell_m: f32, density: f32, [least, most]: [f32; 2], seed: u32) -> f32 {
    if density <= 0.0 {
        return 0.0;
    }
    let bend = 0.35 * noise(p, 0.5 * cell_m, seed + 1);
    let bent = p.map(|v| v / cell_m + bend);
    let low = bent.map(f32::floor);
    // A dot reaches less than half a cell beyond its own: the nearer neighbours are enough.
    let aside: [i32; 3] = std::array::from_fn(|i| if bent[i] - low[i] < 0.5 { -1 } else { 1 });
    let mut most_dark = 0.0f32;
    for k in 0..8 {
        let cell: [i32; 3] =
            std::array::from_fn(|i| low[i] as i32 + if k >> i & 1 == 1 { aside[i] } else { 0 });
        if unit(hash(cell, seed)) >= density {
            continue;
        }
        let mut square = 0.0;
        for i in 0..3 {
            let middle = cell[i] as f32 + 0.5 + 0.6 * (unit(hash(cell, seed + 4 + i as u32)) - 0.5);
            square += (bent[i] - middle) * (bent[i] - middle);
        }
        let radius = least + (most - least) * unit(hash(cell, seed + 7));
        let tone = 0.5 + 0.5 * unit(hash(cell, seed + 8));
        most_dark = most_dark.max(tone * step(1.0, 0.45, square.sqrt() / radius));
    }
    most_dark
}

/// The roots of the lashes: dark along the upper lid's edge, fainter along the lower one's.
pub(super) fn lash_line([x, y, z]: [f32; 3]) -> f32 {
    let x = x.abs();
    let Some((upper, lower)) = lids(x).filter(|_| z > 0.128) else { return 0.0 };
    let t = ((x - LID_X[0]) / (LID_X[1] - LID_X[0])).clamp(0.0, 1.0);
    // Thicker outwards, where lashes are longest.
    let line = |at: f32, half: f32| step(half, 0.25 * half, (y - at).abs());
    let above = line(upper + 0.0003, 0.0012 + 0.0007 * t) * step(0.0, 0.15, t);
    let below = 0.45 * line(lower - 0.0002, 0.0011) * step(0.1, 0.45, t);
    above.max(below)
}

/// Distance of the corners of an eye from the middle of the face.
const LID_X: [f32; 2] = [0.0205, 0.0432];

/// Heights of the edges of the upper and the lower lid at a distance from the middle of the face.
fn lids(x: f32) -> Option<(f32, f32)> {
    let t = (x - LID_X[0]) / (LID_X[1] - LID_X[0]);
    if !(-0.03..1.12).contains(&t) {
        return None;
    }
    let bow = (4.0 * t * (1.0 - t)).max(0.0);
    let line = 0.7281 + 0.0020 * t;
    Some((line + 0.0046 * bow, line - 0.0050 * bow.sqrt() * (0.6 + 0.4 * bow)))
}

/// Height of the edge of the upper lid at a distance from the middle of the face; nothing beside
/// the eye.
#[must_use]
pub fn upper_lid_y(x: f32) -> Option<f32> {
    lids(x).map(|(upper, _)| upper)
}
