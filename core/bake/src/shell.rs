//! Coordinates on the garment shell and the skin: along the limbs, and for cloth patterns.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use figurant_core::library::figure::data::LIMB_UNIT;
use glam::DVec3;

use crate::assemble::Draft;
use crate::rig::Rig;
use crate::source::Source;
use crate::surface::{smoothstep, triangles};

/// Arm and leg coordinate of every base vertex on the template.
pub struct Limbs {
    /// 0 shoulder .. 1 wrist, about -0.2 off the arm.
    pub arm: Vec<f64>,
    /// 0 hip .. 1 ankle, negative above.
    pub leg: Vec<f64>,
}

impl Limbs {
    /// Projections on the limbs' straight lines.
    pub fn new(source: &Source, rig: &Rig) -> Self {
        let is_arm: Vec<bool> =
            rig.joints.iter().map(|j| j.name.contains("Arm") || j.name.contains("Hand")).collect();
        let along = |a: &str, b: &str, p: DVec3| {
            let side = if p.x >= 0.0 { "l" } else { "r" };
            let (a, b) =
                (source.joint(&format!("{side}-{a}")), source.joint(&format!("{side}-{b}")));
            (p - a).dot(b - a) / (b - a).length_squared()
        };
        let arm = source.positions.iter().zip(&rig.skin).map(|(&p, s)| {
            let weight: f64 = (0..4)
                .filter(|&k| is_arm[usize::from(s.joints[k])])
                .map(|k| f64::from(s.weights[k]) / 255.0)
                .sum();
            -0.2 + (along("shoulder", "hand", p) + 0.2) * smoothstep(0.08, 0.6, weight)
        });
        let leg = source.positions.iter().map(|&p| along("upper-leg", "ankle", p));
        Self { arm: arm.collect(), leg: leg.collect() }
    }

    /// As they stand in the file.
    pub fn quantised(values: &[f64], vertices: &[usize]) -> Vec<i16> {
        vertices.iter().map(|&v| (values[v] / f64::from(LIMB_UNIT)).round() as i16).collect()
    }
}

/// Part of the body round which a pattern is wrapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Chart {
    Torso,
    Arm(bool),
    Leg(bool),
}

/// The shell with cylindrical texture coordinates, one repeat about every 0.3 m.
pub fn shell(source: &Source, rig: &Rig, limbs: &Limbs) -> Draft {
    let mut draft = Draft::default();
    let vertices = source.vertices("helper-tights");
    let index: BTreeMap<usize, u32> = vertices.iter().copied().zip(0..).collect();
    for &v in &vertices {
        draft.push(source.positions[v], vec![(v, 1.0)], rig.skin[v]);
    }
    let mut known = BTreeMap::<(usize, Chart, i32), u32>::new();
    for tri in triangles(source.quads("helper-tights")) {
        let tri = tri.map(|c| c.0);
        let mean = |f: &[f64]| tri.iter().map(|&v| f[v]).sum::<f64>() / 3.0;
        let left = tri.iter().map(|&v| source.positions[v].x).sum::<f64>() > 0.0;
        let chart = if mean(&limbs.arm) > 0.05 {
            Chart::Arm(left)
        } else if mean(&limbs.leg) > 0.06 {
            Chart::Leg(left)
        } else {
            Chart::Torso
        };
        let first = wrap(source, chart, source.positions[tri[0]])[0];
        let corners = tri.map(|v| {
            let [u, t] = wrap(source, chart, source.positions[v]);
            let turns = periods(chart) as f64;
            // The corner's turn is the one nearest to the first corner's.
            let shift = ((first - u) / turns).round() * turns;
            *known.entry((v, chart, shift as i32)).or_insert_with(|| {
                draft.render.push(index[&v]);
                draft.uvs.push([(u + shift) as f32, t as f32]);
                draft.render.len() as u32 - 1
            })
        });
        draft.triangles.push(corners);
    }
    draft
}

/// Repeats round a chart; whole, so that the pattern closes.
const fn periods(chart: Chart) -> i32 {
    match chart {
        Chart::Torso => 3,
        Chart::Arm(_) => 1,
        Chart::Leg(_) => 2,
    }
}

fn wrap(source: &Source, chart: Chart, p: DVec3) -> [f64; 2] {
    const REPEAT_M: f64 = 0.3;
    let turns = f64::from(periods(chart)) / (2.0 * PI);
    let limb = |a: &str, b: &str, left: bool| {
        let side = if left { "l" } else { "r" };
        let (a, b) = (source.joint(&format!("{side}-{a}")), source.joint(&format!("{side}-{b}")));
        (a, (b - a).normalize())
    };
    match chart {
        Chart::Torso => {
            let angle = p.x.atan2(p.z - 0.03);
            // On the shoulders the way towards the neck counts as height.
            let radius = p.x.hypot(p.z - 0.02);
            let over = 0.8 * (0.16 - radius) * smoothstep(0.47, 0.54, p.y);
            [angle * turns, -(p.y + over) / REPEAT_M]
        }
        Chart::Arm(left) => {
            let (a, d) = limb("shoulder", "hand", left);
            let out =
                DVec3::new(if left { 1.0 } else { -1.0 }, 0.8, 0.0).reject_from(d).normalize();
            let r = p - a;
            [r.dot(d.cross(out)).atan2(r.dot(out)) * turns, r.dot(d) / REPEAT_M]
        }
        Chart::Leg(left) => {
            let (a, d) = limb("upper-leg", "ankle", left);
            let out =
                DVec3::new(if left { 1.0 } else { -1.0 }, 0.0, 0.0).reject_from(d).normalize();
            let r = p - a;
            [r.dot(d.cross(out)).atan2(r.dot(out)) * turns, r.dot(d) / REPEAT_M]
        }
    }
}

/// Skin vertices that the shell covers on the template.
pub fn covered(source: &Source, vertices: &[usize]) -> Vec<u8> {
    let shell: Vec<DVec3> =
        source.vertices("helper-tights").iter().map(|&v| source.positions[v]).collect();
    vertices
        .iter()
        .map(|&v| {
            let p = source.positions[v];
            let near = shell.iter().any(|q| (*q - p).length_squared() < 0.045 * 0.045);
            u8::from(near && p.y < 0.60)
        })
        .collect()
}
