//! Vertices lie where the formula of skinning, in double precision, says.

use figurant_core::plan::Output;
use figurant_tests::drawlists::mixed;
use figurant_tests::oracle::place;
use glam::DVec3;

use super::common::*;
use super::scenes::Source;

/// Farthest that a vertex may lie off, metres.
const POSITION_M: f64 = 1e-5;
/// Farthest that a normal may lean off, degrees.
const NORMAL_DEG: f64 = 0.05;

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from_array(v.map(f64::from))
}

#[test]
fn skinned_vertices_lie_within_a_hundredth_of_a_millimetre() {
    let Some(mut engine) = engine() else { return };
    let source = Source::new();
    let (mut vertices, mut skinned) = (0, 0);
    let (mut farthest_m, mut most_deg) = (0.0_f64, 0.0_f64);
    let sampled = (0..10).map(|frame| source.drawn("peoplesanspeople", frame, 128, 1).1.list);
    let made_up = (0..4).map(|seed| mixed(seed, 1));
    for list in sampled.chain(made_up) {
        by_gpu(&mut engine, &list, &[Output::Rgb]);
        for (index, object) in list.objects.iter().enumerate() {
            let placed = engine.placed_vertices(index as u32).unwrap();
            if placed.is_empty() {
                assert!(!object.in_view, "object {index} was left out");
                continue;
            }
            assert_eq!(placed.len(), object.mesh.positions.len(), "object {index}");
            for (vertex, got) in placed.iter().enumerate() {
                let (position, normal) = place(&list, object, vertex);
                let off_m = (vector(got.position) - position).length();
                farthest_m = farthest_m.max(off_m);
                // Twice the arc sine of half the chord: exact for small angles.
                let chord = (vector(got.normal) - normal).length();
                most_deg = most_deg.max(2.0 * (chord * 0.5).min(1.0).asin().to_degrees());
            }
            vertices += placed.len();
            skinned += placed.len() * usize::from(!object.mesh.skin.is_empty());
        }
    }
    println!("{vertices} vertices, {skinned} skinned: {farthest_m:e} m, {most_deg} degrees off");
    assert!(skinned > 100_000, "{skinned}");
    assert!(farthest_m <= POSITION_M, "a vertex lies {farthest_m} m off");
    assert!(most_deg <= NORMAL_DEG, "a normal leans {most_deg} degrees off");
}
