//! Keypoints: eight skin vertices each that stand in for the published regressors.
//!
//! The published regressors (Anny's `coco.pth`, Apache-2.0) weigh up to thousands of vertices.
//! Here a greedy least-squares fit with weights that sum to 1 picks eight, trained on random
//! bodies at rest and under random joint rotations with the final skin weights. The left side is
//! fitted and mirrored; the nose is fitted with mirrored pairs.

use std::path::Path;

use figurant_core::library::figure::data::{KEYPOINT_VERTICES, KEYWORDS};
use glam::{DMat3, DQuat, DVec3};

use crate::BakeError;
use crate::assemble::Macros;
use crate::rig::Rig;
use crate::source::{BODY_VERTICES, Source};
use crate::torch::float_vectors;

const TRAINING: usize = 110;
const HELD_OUT: usize = 50;
const CANDIDATES: usize = 420;

/// A keypoint in terms of base vertices.
#[derive(Debug)]
pub struct Keypoint {
    /// COCO's name.
    pub name: String,
    /// The vertices.
    pub vertices: Vec<usize>,
    /// Their weights, summing to 1.
    pub weights: Vec<f32>,
    /// Skin vertices all round it.
    pub ring: Vec<usize>,
}

/// COCO's order, then the feet.
const NAMES: [&str; 23] = [
    "nose",
    "left_eye",
    "right_eye",
    "left_ear",
    "right_ear",
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
    "left_hip",
    "right_hip",
    "left_knee",
    "right_knee",
    "left_ankle",
    "right_ankle",
    "left_big_toe",
    "right_big_toe",
    "left_small_toe",
    "right_small_toe",
    "left_heel",
    "right_heel",
];

/// Fits all keypoints and reports the error of each.
pub fn fit(
    anny: &Path,
    source: &Source,
    rig: &Rig,
    macros: &Macros,
) -> Result<Vec<Keypoint>, BakeError> {
    let path = anny.join("keypoints/coco.pth");
    let published = float_vectors(&path)?;
    let regressor = |name: &str| -> Result<Vec<(usize, f64)>, BakeError> {
        let row = published
            .iter()
            .find(|r| r.0 == name)
            .ok_or_else(|| BakeError::content(&path, format!("no keypoint {name}")))?;
        Ok(row
            .1
            .iter()
            .enumerate()
            .filter(|w| *w.1 != 0.0)
            .map(|(v, &w)| (v, f64::from(w)))
            .collect())
    };
    let bodies = sample_bodies(source, rig, macros);
    let mut out: Vec<Keypoint> = Vec::new();
    for name in NAMES {
        let full = regressor(name)?;
        let (vertices, weights) = match name.strip_prefix("right_") {
            None => fit_one(source, &bodies, &full, name == "nose"),
            Some(rest) => {
                let left = format!("left_{rest}");
                let twin = out.iter().find(|k| k.name == left).expect("left comes first");
                let vertices = twin.vertices.iter().map(|&v| source.mirror[v]).collect();
                (vertices, twin.weights.clone())
            }
        };
        report(name, &bodies, &full, &vertices, &weights);
        let ring = match name.strip_prefix("right_") {
            None => ring(source, &full),
            Some(rest) => {
                let left = format!("left_{rest}");
                let twin = out.iter().find(|k| k.name == left).expect("left comes first");
                twin.ring.iter().map(|&v| source.mirror[v]).collect()
            }
        };
        out.push(Keypoint { name: name.to_owned(), vertices, weights, ring });
    }
    Ok(out)
}

fn apply(body: &[DVec3], weights: impl IntoIterator<Item = (usize, f64)>) -> DVec3 {
    weights.into_iter().map(|(v, w)| body[v] * w).sum()
}

fn report(name: &str, bodies: &[Vec<DVec3>], full: &[(usize, f64)], v: &[usize], w: &[f32]) {
    let errors: Vec<f64> = bodies[TRAINING..]
        .iter()
        .map(|b| {
            let ours = v.iter().copied().zip(w.iter().map(|&w| f64::from(w)));
            (apply(b, full.iter().copied()) - apply(b, ours)).length() * 1e3
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let worst = errors.iter().copied().fold(0.0, f64::max);
    eprintln!("keypoint {name:16} mean {mean:5.2} mm, largest {worst:5.2} mm");
}

/// Greedy selection. A column of the fit is a vertex, or for a point on the midline a vertex and
/// its mirror image with equal weights.
fn fit_one(
    source: &Source,
    bodies: &[Vec<DVec3>],
    full: &[(usize, f64)],
    middle: bool,
) -> (Vec<usize>, Vec<f32>) {
    let mut by_weight = full.to_vec();
    by_weight.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut columns: Vec<Vec<usize>> = Vec::new();
    for &(v, _) in by_weight.iter().take(CANDIDATES) {
        let m = source.mirror[v];
        let column = if middle { vec![v.min(m), v.max(m)] } else { vec![v] };
        if !columns.contains(&column) {
            columns.push(column);
        }
    }
    let picks = KEYPOINT_VERTICES / columns[0].len();
    let rows = 3 * TRAINING;
    // Everything relative to the candidates' mean, so that the sum of weights drops out.
    let (mut a, mut y) = (vec![vec![0.0; rows]; columns.len()], vec![0.0; rows]);
    for (s, body) in bodies[..TRAINING].iter().enumerate() {
        let place = |c: &[usize]| c.iter().map(|&v| body[v]).sum::<DVec3>() / c.len() as f64;
        let mean = columns.iter().map(|c| place(c)).sum::<DVec3>() / columns.len() as f64;
        for (k, c) in columns.iter().enumerate() {
            a[k][3 * s..3 * s + 3].copy_from_slice(&(place(c) - mean).to_array());
        }
        let target = apply(body, full.iter().copied()) - mean;
        y[3 * s..3 * s + 3].copy_from_slice(&target.to_array());
    }
    let (chosen, weights) = greedy(&a, &y, picks);
    let (mut vertices, mut out) = (Vec::new(), Vec::new());
    for (c, w) in chosen.iter().zip(weights) {
        let n = columns[*c].len() as f64;
        vertices.extend(&columns[*c]);
        out.extend(columns[*c].iter().map(|_| (w / n) as f32));
    }
    (vertices, out)
}

/// Columns of `a` and weights summing to 1 whose sum is near `y`: one more column at a time, each
/// time the best of those that correlate most with what is left, then rounds of exchanging.
fn greedy(a: &[Vec<f64>], y: &[f64], picks: usize) -> (Vec<usize>, Vec<f64>) {
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(a, b)| a * b).sum::<f64>();
    let gram: Vec<Vec<f64>> = a.iter().map(|x| a.iter().map(|z| dot(x, z)).collect()).collect();
    let right: Vec<f64> = a.iter().map(|x| dot(x, y)).collect();
    let yy = dot(y, y);
    let try_set = |set: &[usize]| solve(&gram, &right, yy, set);
    let best_addition = |kept: &[usize]| {
        (0..a.len())
            .filter(|c| !kept.contains(c))
            .filter_map(|c| {
                let set: Vec<usize> = kept.iter().copied().chain([c]).collect();
                try_set(&set).map(|(e, w)| (e, set, w))
            })
            .min_by(|x, y| x.0.total_cmp(&y.0))
    };
    let mut best = (f64::MAX, Vec::new(), Vec::new());
    while best.1.len() < picks {
        match best_addition(&best.1) {
            Some(next) => best = next,
            None => break,
        }
    }
    for _ in 0..3 {
        for i in 0..best.1.len() {
            let mut rest = best.1.clone();
            rest.remove(i);
            if let Some(next) = best_addition(&rest).filter(|n| n.0 < best.0) {
                best = next;
            }
        }
    }
    (best.1, best.2)
}

/// Least squares over a set of columns with weights that sum to 1, by Lagrange's multiplier and a
/// little damping against huge weights of opposite sign. Returns the squared error and weights.
fn solve(g: &[Vec<f64>], r: &[f64], yy: f64, set: &[usize]) -> Option<(f64, Vec<f64>)> {
    let n = set.len();
    let damping = 1e-5 * set.iter().map(|&i| g[i][i]).sum::<f64>() / n as f64;
    let mut m = vec![vec![0.0; n + 2]; n + 1];
    for (i, &ci) in set.iter().enumerate() {
        for (j, &cj) in set.iter().enumerate() {
            m[i][j] = g[ci][cj] + if i == j { damping } else { 0.0 };
        }
        (m[i][n], m[n][i], m[i][n + 1]) = (1.0, 1.0, r[ci]);
    }
    m[n][n + 1] = 1.0;
    for c in 0..=n {
        let pivot = (c..=n).max_by(|&a, &b| m[a][c].abs().total_cmp(&m[b][c].abs()))?;
        m.swap(c, pivot);
        if m[c][c].abs() < 1e-12 {
            return None;
        }
        for row in 0..=n {
            if row != c {
                let f = m[row][c] / m[c][c];
                let pivot = m[c].clone();
                m[row].iter_mut().zip(&pivot).skip(c).for_each(|(x, p)| *x -= f * p);
            }
        }
    }
    let w: Vec<f64> = (0..n).map(|i| m[i][n + 1] / m[i][i]).collect();
    let mut error = yy;
    for (i, &ci) in set.iter().enumerate() {
        error -= 2.0 * w[i] * r[ci];
        error += set.iter().enumerate().map(|(j, &cj)| w[i] * w[j] * g[ci][cj]).sum::<f64>();
        error += damping * w[i] * w[i];
    }
    Some((error, w))
}

/// Eight skin vertices round a keypoint on the template: for points inside a limb one in each of
/// eight directions across it, for points of the face the nearest ones.
fn ring(source: &Source, full: &[(usize, f64)]) -> Vec<usize> {
    let at = apply(&source.positions, full.iter().copied());
    let mut near: Vec<(f64, usize)> = source
        .vertices("body")
        .into_iter()
        .map(|v| ((source.positions[v] - at).length(), v))
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut out: Vec<usize> = Vec::new();
    // Eight octants' nearest vertices; where the point lies on the surface some are far, so the
    // reach is bounded by four times the nearest distance.
    let reach = 4.0 * near[0].0.max(0.004);
    for octant in 0..8 {
        let found = near.iter().take_while(|n| n.0 < reach).find(|(_, v)| {
            let d = source.positions[*v] - at;
            usize::from(d.x > 0.0) + 2 * usize::from(d.y > 0.0) + 4 * usize::from(d.z > 0.0)
                == octant
        });
        out.extend(found.map(|n| n.1));
    }
    let mut rest = near.iter().map(|n| n.1);
    while out.len() < KEYPOINT_VERTICES {
        let Some(v) = rest.next() else { break };
        if !out.contains(&v) {
            out.push(v);
        }
    }
    out
}

/// A small counter-based generator (SplitMix64, Steele et al. 2014): the fit is reproducible.
struct Dice(u64);

impl Dice {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.unit()
    }

    fn direction(&mut self) -> DVec3 {
        let (z, a) = (self.between(-1.0, 1.0), self.between(0.0, std::f64::consts::TAU));
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * a.cos(), r * a.sin(), z)
    }
}

/// Bodies of all shapes; every third at rest, the others posed.
fn sample_bodies(source: &Source, rig: &Rig, macros: &Macros) -> Vec<Vec<DVec3>> {
    let mut dice = Dice(417);
    (0..TRAINING + HELD_OUT)
        .map(|i| {
            let rest = random_body(source, macros, &mut dice);
            if i % 3 == 0 { rest } else { posed(source, rig, &rest, &mut dice) }
        })
        .collect()
}

/// Uniform sliders; the weights follow the keywords' two-neighbour interpolation.
fn random_body(source: &Source, macros: &Macros, dice: &mut Dice) -> Vec<DVec3> {
    let mut factor = vec![0.0; KEYWORDS.len()];
    let mut set = |from: &str, count: usize, value: f64| {
        let first = KEYWORDS.iter().position(|k| *k == from).expect("a keyword");
        let x = value * (count - 1) as f64;
        let i = (x as usize).min(count - 2);
        factor[first + i] = 1.0 - (x - i as f64);
        factor[first + i + 1] = x - i as f64;
    };
    set("male", 2, dice.unit().round());
    set("baby", 4, dice.between(0.15, 1.0));
    for (keyword, count) in [
        ("minmuscle", 3),
        ("minweight", 3),
        ("idealproportions", 2),
        ("mincup", 3),
        ("minfirmness", 3),
    ] {
        set(keyword, count, dice.unit());
    }
    set("minheight", 2, dice.between(0.2, 0.7));
    let race = [dice.unit(), dice.unit(), dice.unit()];
    let sum: f64 = race.iter().sum();
    (0..3).for_each(|i| factor[i] = race[i] / sum);
    let mut out = source.positions.clone();
    for (name, target) in &macros.rows {
        let weight: f64 = name
            .split('-')
            .filter_map(|w| KEYWORDS.iter().position(|k| *k == w))
            .map(|k| factor[k])
            .product();
        if weight > 0.0 {
            for &(v, d) in &macros.targets[*target] {
                out[v] += DVec3::from_array(d.map(f64::from)) * (weight * 1e-4);
            }
        }
    }
    out
}

/// Random rotations of plausible size about every joint, and linear blend skinning.
fn posed(source: &Source, rig: &Rig, rest: &[DVec3], dice: &mut Dice) -> Vec<DVec3> {
    let head = |name: &str| {
        let v = source.joint_vertices(name);
        v.iter().map(|&i| rest[i]).sum::<DVec3>() / v.len() as f64
    };
    let heads: Vec<DVec3> = rig.joints.iter().map(|j| head(&j.head)).collect();
    let mut global: Vec<(DMat3, DVec3)> = Vec::new();
    for (j, joint) in rig.joints.iter().enumerate() {
        let local = random_rotation(&joint.name, rig, &heads, dice);
        global.push(match joint.parent {
            None => (local, heads[j]),
            Some(p) => (global[p].0 * local, global[p].1 + global[p].0 * (heads[j] - heads[p])),
        });
    }
    rest.iter()
        .enumerate()
        .map(|(v, &p)| {
            if (BODY_VERTICES..13_606).contains(&v) {
                return p;
            }
            let s = &rig.skin[v];
            (0..4)
                .map(|k| {
                    let j = usize::from(s.joints[k]);
                    let (r, t) = global[j];
                    (t + r * (p - heads[j])) * (f64::from(s.weights[k]) / 255.0)
                })
                .sum()
        })
        .collect()
}

fn random_rotation(name: &str, rig: &Rig, heads: &[DVec3], dice: &mut Dice) -> DMat3 {
    let part = name.trim_start_matches("Left").trim_start_matches("Right");
    let turn =
        |axis: DVec3, deg: f64| DMat3::from_quat(DQuat::from_axis_angle(axis, deg.to_radians()));
    let largest = match part {
        "Leg" => return turn(DVec3::X, dice.between(0.0, 125.0)),
        "ForeArm" => {
            let side = name.trim_end_matches("ForeArm");
            let at = |n: &str| {
                let name = format!("{side}{n}");
                heads[rig.joints.iter().position(|j| j.name == name).expect("an arm joint")]
            };
            let (a, b, c) = (at("Arm"), at("ForeArm"), at("Hand"));
            return turn((b - a).cross(c - b).normalize(), dice.between(-35.0, 95.0));
        }
        "Hips" | "Spine" | "Spine1" | "Spine2" => 16.0,
        "Neck" | "Head" => 25.0,
        "Shoulder" => 10.0,
        "Arm" => 70.0,
        "Hand" => 40.0,
        "UpLeg" => 75.0,
        "Foot" => 30.0,
        "ToeBase" => 25.0,
        _ => 20.0,
    };
    let axis = dice.direction();
    let deg = largest * dice.unit();
    turn(axis, deg)
}
