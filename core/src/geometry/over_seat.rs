//! Cloth that hangs over the seat.
//!
//! The shell goes in between the buttocks; what hangs over them spans them instead, and moves as they
//! do. Layers and skin weights of the shell flow in, the same without the cleft flow out.

use glam::{Vec3, Vec4};

use super::garment::{Place, step};
use super::shell::Shell;
use super::skeleton::{Limb, Side, trunk};
use crate::library::figure::Neighbour;
use crate::library::mesh::SkinVertex;

/// Heights on the template between which cloth spans the middle of the seat.
const SPAN_Y: (f32, f32) = (-0.08, 0.10);
const ROUNDS: usize = 12;

/// Vertices of the middle of the seat up to half of a width, with how far they are in it.
fn seat(shell: &Shell<'_>, half_x: f32) -> Vec<(usize, f32)> {
    let (low_y, high_y) = SPAN_Y;
    let share = |at: &Place| {
        let seat = at.arm < 0.0 && at.p.z < 0.0 && (low_y..high_y).contains(&at.p.y);
        f32::from(seat) * step(half_x, half_x - 0.02, at.p.x.abs()) * step(high_y, 0.06, at.p.y)
    };
    let shares = shell.places.iter().map(share).enumerate();
    shares.filter(|(_, share)| *share > 0.0).collect()
}

/// Joints and weights of cloth over the seat: its middle goes with the thighs as its two sides do.
pub(super) fn weights(shell: &Shell<'_>, skin: &[SkinVertex]) -> Vec<SkinVertex> {
    /// Which joints move the seat.
    const JOINTS: [usize; 4] =
        [trunk::HIPS, trunk::SPINE, Side::Left.joint(Limb::UpLeg), Side::Right.joint(Limb::UpLeg)];
    let own = |s: &SkinVertex| {
        let of = |joint: usize| {
            let all = s.joints.iter().zip(&s.weights).filter(|w| usize::from(*w.0) == joint);
            all.map(|w| f32::from(*w.1)).sum()
        };
        Vec4::from_array(JOINTS.map(of))
    };
    let seat = seat(shell, 0.09);
    let mut dense = vec![Vec4::ZERO; skin.len()];
    for (v, _) in &seat {
        let around = shell.net.around(*v).iter().map(|n| n.vertex as usize);
        around.chain([*v]).for_each(|v| dense[v] = own(&skin[v]));
    }
    for _ in 0..2 * ROUNDS {
        let mean = |(v, share): &(usize, f32)| {
            let sum = |sum, n: &Neighbour| sum + dense[n.vertex as usize] * n.share;
            dense[*v].lerp(shell.net.around(*v).iter().fold(Vec4::ZERO, sum), 0.5 * share)
        };
        let means: Vec<Vec4> = seat.iter().map(mean).collect();
        seat.iter().zip(means).for_each(|((v, _), mean)| dense[*v] = mean);
    }
    let mut out = skin.to_vec();
    for (v, _) in seat {
        let sum = dense[v].element_sum();
        if sum > 0.0 {
            let shares = (dense[v] / sum).to_array().map(f64::from);
            out[v] = SkinVertex::of_shares(JOINTS.map(|j| j as u8), shares);
        }
    }
    out
}

/// Lets what hangs over the seat span the middle of it: the shell goes in there, and its folds have
/// to be drawn apart.
pub(super) fn span(shell: &Shell<'_>, layer: &mut [Vec3]) {
    let Some(tube) = shell.trunk_tube(layer, SPAN_Y, &[]) else { return };
    let seat = seat(shell, 0.06);
    // Heights against the template's, or hems would not be level.
    let scale = shell.head(0).y / 0.9;
    let level = |v: usize| Vec3::Y * (scale * shell.places[v].p.y);
    for _ in 0..ROUNDS {
        let mean = |(v, _): &(usize, f32)| {
            let around = shell.net.around(*v).iter().map(|n| (n.vertex as usize, n.share));
            let sum = |sum, (v, share): (usize, f32)| sum + (layer[v] - level(v)) * share;
            around.fold(level(*v), sum)
        };
        let means: Vec<Vec3> = seat.iter().map(mean).collect();
        for ((v, share), mean) in seat.iter().zip(means) {
            let q = layer[*v].lerp(mean, 0.5 * share);
            let spot = tube.spot(q);
            layer[*v] = q + spot.out * ((spot.radius - spot.own).max(0.0) * share);
        }
    }
}
