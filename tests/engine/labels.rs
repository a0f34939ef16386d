//! Ids, distances and counts against the oracle and closed forms.

use figurant_core::draw::DrawList;
use figurant_core::library::mesh::{Cutout, Triangle};
use figurant_core::plan::{Frame, ObjectSamples};
use figurant_tests::drawlists::{self, add, empty, mixed, view};
use figurant_tests::meshes::{self, Dice};
use figurant_tests::oracle::{Oracle, Sample, sample_positions};
use glam::{DAffine3, DQuat, DVec3};
use std::sync::Arc;

use super::common::*;

/// The samples of every pixel by the oracle.
fn oracle_samples(list: &DrawList) -> Vec<Vec<Sample>> {
    let oracle = Oracle::new(list);
    let positions = sample_positions(list.samples);
    let (width, height) = (list.view.width, list.view.height);
    let mut pixels = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let at = |p: &[i32; 2]| {
                oracle.sample(
                    f64::from(x) + f64::from(p[0]) / 16.0,
                    f64::from(y) + f64::from(p[1]) / 16.0,
                )
            };
            pixels.push(positions.iter().map(at).collect());
        }
    }
    pixels
}

/// What the frame must say of a pixel: id and distance.
fn resolved(samples: &[Sample], near_m: f64) -> (u16, f64, f64) {
    let object = |s: &Sample| s.hit.map_or(0, |h| h.object as u16 + 1);
    let depth = |s: &Sample| s.hit.map_or(0.0, |h| h.depth);
    let mut best = (0, 0, -1.0, 0.0);
    for s in samples {
        let same = || samples.iter().filter(|o| object(o) == object(s));
        let count = same().count();
        let closest = same().max_by(|a, b| depth(a).total_cmp(&depth(b))).unwrap();
        let slope = closest.hit.map_or(0.0, |h| h.slope_per_px / h.depth);
        if count > best.1 || (count == best.1 && depth(closest) > best.2) {
            best = (object(s), count, depth(closest), slope);
        }
    }
    (best.0, if best.0 == 0 { 0.0 } else { near_m / best.2 }, best.3)
}

/// Compares a frame's labels with the oracle; returns how many pixels were in doubt.
pub fn compare(name: &str, list: &DrawList, frame: &Frame) -> usize {
    let pixels = oracle_samples(list);
    let (ids, depth) = (frame.object_ids.as_ref().unwrap(), frame.depth_m.as_ref().unwrap());
    let mut doubtful = 0;
    for (i, samples) in pixels.iter().enumerate() {
        if samples.iter().any(|s| s.doubt) {
            doubtful += 1;
            continue;
        }
        let (id, distance, slope) = resolved(samples, f64::from(list.view.near_m));
        let at = (i % frame.width as usize, i / frame.width as usize);
        assert_eq!(ids[i], id, "{name}: object at {at:?}: {samples:?}");
        // Vertices are single precision, which a steep surface turns into depth.
        let snapping_px = if list.lens.is_some() { 1.2e-3 } else { 2e-4 };
        let allowed = 1e-5 + slope * snapping_px;
        let error = (f64::from(depth[i]) - distance).abs() / distance.max(1e-9);
        assert!(
            error <= allowed,
            "{name}: depth at {at:?}: {} is not {distance}, {error:e} > {allowed:e}",
            depth[i]
        );
    }
    compare_sums(name, list, frame, &pixels);
    doubtful
}

/// Counts and extents, which samples in doubt may only widen.
fn compare_sums(name: &str, list: &DrawList, frame: &Frame, pixels: &[Vec<Sample>]) {
    let positions = sample_positions(list.samples);
    let mut sure = vec![ObjectSamples::default(); list.objects.len()];
    let mut doubts = 0u64;
    for (i, samples) in pixels.iter().enumerate() {
        for (s, p) in samples.iter().zip(&positions) {
            if s.doubt {
                doubts += 1;
            } else if let Some(hit) = s.hit {
                let (x, y) = (i as i32 % frame.width as i32, i as i32 / frame.width as i32);
                let (sum, at) = (&mut sure[hit.object], [x * 16 + p[0], y * 16 + p[1]]);
                sum.count += 1;
                for (axis, at) in at.into_iter().enumerate() {
                    sum.min_16th[axis] = sum.min_16th[axis].min(at);
                    sum.max_16th[axis] = sum.max_16th[axis].max(at);
                }
            }
        }
    }
    for (object, (got, sure)) in
        frame.object_samples.as_ref().unwrap().iter().zip(&sure).enumerate()
    {
        assert!(
            got.count >= sure.count && got.count <= sure.count + doubts,
            "{name}: object {object} has {} samples, not {} to {}",
            got.count,
            sure.count,
            sure.count + doubts
        );
        for axis in 0..2 {
            assert!(
                got.min_16th[axis] <= sure.min_16th[axis]
                    && got.max_16th[axis] >= sure.max_16th[axis]
            );
            if doubts == 0 {
                assert_eq!(got, sure, "{name}: object {object}");
            }
        }
    }
}

fn mixed_scenes(samples: u32, seeds: std::ops::Range<u64>) {
    let (mut doubtful, mut all) = (0, 0);
    for seed in seeds {
        let list = mixed(seed, samples);
        let frame = render(&list, LABELS);
        doubtful += compare(&format!("scene {seed}, {samples} samples"), &list, &frame);
        all += frame.object_ids.as_ref().unwrap().len();
    }
    assert!(doubtful * 8 < all, "{doubtful} of {all} pixels in doubt: nothing was compared");
}

#[test]
fn one_sample_agrees_with_the_oracle() {
    mixed_scenes(1, 0..28);
}

#[test]
fn four_samples_agree_with_the_oracle() {
    mixed_scenes(4, 100..110);
}

#[test]
fn sixteen_samples_agree_with_the_oracle() {
    mixed_scenes(16, 200..204);
}

#[test]
fn a_square_covers_the_pixels_that_it_covers() {
    // 10 m away at a focal length of 100 px: a metre is 10 px. The square spans 20..40 px.
    for (samples, per_px) in [(1, 1), (4, 4), (16, 16)] {
        let mut list = empty(view(64, 64, 100.0), samples);
        add(
            &mut list,
            meshes::square(),
            facing_square(2.0, DVec3::new(-0.2, 0.2, -10.0)),
            plain([0.5; 3]),
        );
        let frame = render(&list, LABELS);
        let ids = frame.object_ids.unwrap();
        assert_eq!(ids.iter().filter(|id| **id == 1).count(), 400);
        let inside = |x: usize, y: usize| (20..40).contains(&x) && (20..40).contains(&y);
        for (i, id) in ids.iter().enumerate() {
            assert_eq!(*id == 1, inside(i % 64, i / 64));
        }
        let sums = frame.object_samples.unwrap()[0];
        assert_eq!(sums.count, 400 * per_px);
        let (low, high) = match samples {
            1 => (8, 8),
            4 => (2, 14),
            _ => (0, 15),
        };
        assert_eq!((sums.min_16th, sums.max_16th), ([20 * 16 + low; 2], [39 * 16 + high; 2]));
        let distance = frame.depth_m.unwrap()[30 * 64 + 30];
        assert!((distance - 10.0).abs() < 1e-5);
    }
}

/// Strands of a square cover the area that the formula says, on every place of it alike.
#[test]
fn a_cutout_leaves_the_area_that_its_formula_says() {
    const STRANDS: u16 = 8;
    let mut list = empty(view(256, 256, 1000.0), 4);
    let square = facing_square(2.0, DVec3::new(0.0, 0.0, -10.0));
    add(&mut list, meshes::square(), square, plain([0.5; 3]));
    list.draws[0].cutout = Some(Cutout { strands_per_u: STRANDS, frayed_1024ths: 512 });
    let frame = render(&list, LABELS);
    // 200 pixels wide and high; v runs down and strands end at its upper edge.
    let share = |strand: u32, v: f64| {
        let [width, end, ..] = strand.wrapping_mul(0x9e37_79b1).to_be_bytes();
        let [width, end] = [width, end].map(|byte| f64::from(byte) / 256.0);
        let (half, end) = (0.30 + 0.32 * width, 0.75 * end);
        (2.0 * half * ((v / 0.5 - end) / (1.0 - end)).clamp(0.0, 1.0)).min(1.0)
    };
    let rows = (0..2000).map(|row| (f64::from(row) + 0.5) / 2000.0);
    let area: f64 =
        rows.flat_map(|v| (0..u32::from(STRANDS)).map(move |strand| share(strand, v))).sum();
    let expected = area / 2000.0 / f64::from(STRANDS) * 200.0 * 200.0 * 4.0;
    let got = frame.object_samples.unwrap()[0].count as f64;
    assert!((got / expected - 1.0).abs() < 0.003, "{got} samples, not {expected}");
    // Nothing is left at the upper edge, and by far the most of the lower half.
    let ids = frame.object_ids.unwrap();
    let row = |y: usize| ids[y * 256 + 28..y * 256 + 228].iter().filter(|id| **id == 1).count();
    assert_eq!(row(28), 0);
    assert!(row(200) > 150 && row(200) < 200, "{}", row(200));
}

/// Two triangles that share an edge through sample centres leave no gap and no overlap, whatever
/// the direction of the edge.
#[test]
fn neighbours_share_every_sample_exactly_once() {
    for (a, b) in [
        ([8.5, 8.5], [40.5, 40.5]),
        ([8.5, 40.5], [40.5, 8.5]),
        ([8.5, 20.5], [40.5, 28.5]),
        ([20.5, 8.5], [28.5, 40.5]),
    ] {
        let place =
            |p: [f64; 2]| [((p[0] - 32.0) / 32.0) as f32, ((32.0 - p[1]) / 32.0) as f32, -1.0];
        let d = [b[0] - a[0], b[1] - a[1]];
        let corner = |side: f64| [a[0] + d[0] * 0.5 + side * d[1], a[1] + d[1] * 0.5 - side * d[0]];
        let mut list = empty(view(64, 64, 32.0), 1);
        for side in [-0.4, 0.4] {
            let mut mesh = meshes::square();
            mesh.positions = vec![place(a), place(b), place(corner(side))];
            mesh.normals.truncate(3);
            mesh.uvs.truncate(3);
            mesh.triangles = vec![Triangle::new([0, 1, 2])];
            add(&mut list, mesh, DAffine3::IDENTITY, plain([0.5; 3]));
            list.draws.last_mut().unwrap().double_sided = true;
        }
        let both = render(&list, LABELS).object_samples.unwrap();
        let mut swapped = list.clone();
        swapped.draws.swap(0, 1);
        let other = render(&swapped, LABELS).object_samples.unwrap();
        // Were a sample of both, the draw order would decide.
        assert_eq!(both, other);
        let mut whole = list.clone();
        let (first, second) = (list.objects[0].mesh.clone(), list.objects[1].mesh.clone());
        let mut mesh = (*first).clone();
        mesh.positions.extend(&second.positions);
        mesh.normals.extend(&second.normals);
        mesh.uvs.extend(&second.uvs);
        mesh.triangles.push(Triangle::new([3, 4, 5]));
        whole.objects[0].mesh = Arc::new(mesh);
        whole.draws.truncate(1);
        whole.draws[0].triangles = 0..2;
        assert_eq!(
            render(&whole, LABELS).object_samples.unwrap()[0].count,
            both[0].count + both[1].count
        );
    }
}

#[test]
fn a_rigid_bone_moves_its_vertices_rigidly() {
    let mut dice = Dice::new(5);
    let place = DAffine3::from_rotation_translation(
        DQuat::from_axis_angle(dice.direction(), 1.0),
        DVec3::new(0.3, -0.2, -6.0),
    );
    let body = |skinned: bool| {
        let mut list = empty(view(96, 96, 120.0), 4);
        let mut mesh = meshes::skinned_body(&mut Dice::new(5), 24, 24, 5);
        if skinned {
            drawlists::add_skinned(&mut list, mesh, &[place; 5], plain([0.5; 3]));
        } else {
            mesh.skin.clear();
            add(&mut list, mesh, place, plain([0.5; 3]));
        }
        render(&list, LABELS)
    };
    let (a, b) = (body(true), body(false));
    let differing =
        a.object_ids.unwrap().iter().zip(b.object_ids.unwrap()).filter(|(a, b)| *a != b).count();
    assert!(differing <= 2, "{differing} pixels differ");
    for (a, b) in a.depth_m.unwrap().iter().zip(b.depth_m.unwrap()) {
        assert!(*a == 0.0 || b == 0.0 || (a - b).abs() < 1e-4 * b);
    }
}
