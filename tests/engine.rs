//! The native engine against the brute-force oracle, closed forms, and itself in other forms.

#![allow(clippy::unwrap_used, reason = "helpers of tests, too, fail by panicking")]

use std::sync::Arc;

use figurant_core::draw::DrawList;
use figurant_core::draw::abi::{Material, PointLight, Sun};
use figurant_core::engine::cpu::{CpuEngine, CpuOptions, SimdChoice};
use figurant_core::engine::{Engine, EngineError};
use figurant_core::library::texture::{Encoding, Texture};
use figurant_core::plan::{
    Frame, ObjectSamples, Output, Outputs, PassPlan, SceneFacts, StageTimes,
};
use figurant_tests::drawlists::{self, add, empty, mixed, view};
use figurant_tests::meshes::{self, Dice};
use figurant_tests::oracle::{Oracle, Sample, display, nits, radiance, sample_positions};
use glam::{DAffine3, DMat3, DQuat, DVec3};

fn plan(outputs: &[Output]) -> PassPlan {
    let wanted: Outputs = outputs.iter().copied().collect();
    PassPlan::new(&wanted, SceneFacts { sun_shadow: true })
}

fn try_render(
    list: &DrawList,
    outputs: &[Output],
    options: CpuOptions,
) -> Result<Frame, EngineError> {
    CpuEngine::new(options).render(list, &plan(outputs), &mut StageTimes::default())
}

fn render(list: &DrawList, outputs: &[Output]) -> Frame {
    try_render(list, outputs, CpuOptions::default()).unwrap()
}

const LABELS: &[Output] = &[Output::Box2d, Output::Instance, Output::Keypoints];

/// A square of side `size` that faces the camera.
fn facing_square(size: f64, position: DVec3) -> DAffine3 {
    DAffine3::from_translation(position) * DAffine3::from_scale(DVec3::splat(size * 0.5))
}

fn plain(base_color: [f32; 3]) -> Material {
    Material { base_color, roughness: 1.0, ..Material::default() }
}

fn pixel(frame: &Frame, x: usize, y: usize) -> [u8; 3] {
    let at = (y * frame.width as usize + x) * 3;
    frame.picture.as_ref().unwrap()[at..at + 3].try_into().unwrap()
}

// ---- against the oracle

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
fn compare(name: &str, list: &DrawList, frame: &Frame) -> usize {
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
        let allowed = 1e-5 + slope * 2e-4;
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

/// Normals, barycentric coordinates and the reflectance model, by way of the picture.
#[test]
fn shading_agrees_with_the_oracle() {
    let (mut compared, mut apart) = (0, 0);
    for seed in 300..312 {
        let mut list = mixed(seed, 1);
        let mut dice = Dice::new(seed + 7);
        let turn = DAffine3::from_quat(DQuat::from_axis_angle(dice.direction(), 2.0));
        list.view.view_from_world = drawlists::rows(&turn);
        list.lights.sun = Some(Sun {
            direction_to_sun: dice.direction().as_vec3().to_array(),
            color_lux: [2.0, 1.8, 1.5],
            shadow: false,
        });
        list.lights.points = (0..5)
            .map(|_| PointLight {
                position: (dice.vector() * 3.0 - DVec3::Z * 3.0).as_vec3().to_array(),
                range_m: dice.range(2.0, 8.0) as f32,
                color_cd: [1.0, 2.0, 3.0],
                radius_m: 0.05,
            })
            .collect();
        list.lights.sky_lux = [0.8, 0.6, 0.4];
        list.lights.ground_lux = [0.1, 0.2, 0.3];
        list.materials.iter_mut().for_each(|m| m.wrap = if dice.unit() < 0.3 { 0.3 } else { 0.0 });
        let frame = render(&list, &[Output::Rgb]);
        let oracle = Oracle::new(&list);
        for y in 0..frame.height {
            for x in 0..frame.width {
                let sample = oracle.sample(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let Some(hit) = sample.hit.filter(|_| !sample.doubt) else { continue };
                let material = &list.materials[list.draws[hit.draw].material as usize];
                let albedo = DVec3::from_array(material.base_color.map(f64::from));
                let light = radiance(&list, material, albedo, &hit).to_array();
                let got = pixel(&frame, x as usize, y as usize);
                compared += 1;
                for c in 0..3 {
                    let error = (f64::from(got[c]) - display(light[c], 1.0)).abs();
                    apart += usize::from(error > 0.75);
                    let expected = light.map(|v| display(v, 1.0));
                    assert!(error < 1.5, "scene {seed} at {x},{y}: {got:?} is not {expected:?}");
                }
            }
        }
    }
    assert!(compared > 50_000, "only {compared} pixels compared");
    assert!(apart * 1000 < compared, "{apart} of {compared} pixels off by more than rounding");
}

// ---- closed forms

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
            mesh.triangles = vec![[0, 1, 2]];
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
        mesh.triangles.push([3, 4, 5]);
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

#[test]
fn a_white_wall_sends_back_what_the_formula_says() {
    // A wall straight ahead; only its middle pixel is looked at.
    let wall = |list: &mut DrawList, distance: f64| {
        add(
            list,
            meshes::square(),
            facing_square(20.0, DVec3::new(0.0, 0.0, -distance)),
            plain([1.0; 3]),
        );
        list.lights.sky_lux = [0.0; 3];
        list.lights.ground_lux = [0.0; 3];
    };
    // Lambert gives E / pi. The mirror term at normal incidence and roughness 1 is that of
    // F = 0.04, D = 1/pi, V = 1/4, a hundredth more of it.
    let expected = |lux: f64| lux / std::f64::consts::PI * (1.0 + 0.04 / 4.0);
    let measured = |list: &DrawList| {
        nits(f64::from(pixel(&render(list, &[Output::Rgb]), 32, 32)[1]), f64::from(list.exposure))
    };

    let mut list = empty(view(65, 65, 65.0), 4);
    wall(&mut list, 5.0);
    list.lights.sun =
        Some(Sun { direction_to_sun: [0.0, 0.0, 1.0], color_lux: [1.0; 3], shadow: true });
    list.exposure = 1.2;
    let got = measured(&list);
    assert!((got / expected(1.0) - 1.0).abs() < 0.01, "sun: {got} is not {}", expected(1.0));

    list.lights.sun = None;
    list.lights.points =
        vec![PointLight { position: [0.0; 3], range_m: 20.0, color_cd: [30.0; 3], radius_m: 0.05 }];
    let window = 1.0 - (5.0f64 / 20.0).powi(4);
    let lux = 30.0 / 25.0 * window * window;
    let got = measured(&list);
    assert!((got / expected(lux) - 1.0).abs() < 0.01, "point: {got} is not {}", expected(lux));

    // Beyond its range a light does nothing.
    list.lights.points[0].range_m = 4.9;
    assert_eq!(pixel(&render(&list, &[Output::Rgb]), 32, 32), [0; 3]);
}

#[test]
fn a_background_goes_through_the_same_exposure() {
    let mut list = empty(view(40, 33, 40.0), 4);
    list.lights.background_nits = [0.2, 0.5, 2.0];
    list.exposure = 0.7;
    let frame = render(&list, &[Output::Rgb]);
    for (got, light) in pixel(&frame, 39, 32).into_iter().zip([0.2, 0.5, 2.0]) {
        assert!((f64::from(got) - display(light, 0.7)).abs() < 0.6);
    }
}

#[test]
fn an_edge_is_blended_by_coverage_after_tone_mapping() {
    // A black square whose left edge halves a pixel column, before a bright background.
    let mut list = empty(view(64, 64, 100.0), 16);
    list.lights.sky_lux = [0.0; 3];
    list.lights.ground_lux = [0.0; 3];
    list.lights.background_nits = [50.0; 3];
    add(
        &mut list,
        meshes::square(),
        facing_square(2.0, DVec3::new(0.05, 0.0, -10.0)),
        plain([0.0; 3]),
    );
    let frame = render(&list, &[Output::Rgb]);
    let linear = |v: u8| {
        let v = f64::from(v) / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    };
    let (outside, edge, inside) =
        (pixel(&frame, 10, 32)[0], pixel(&frame, 22, 32)[0], pixel(&frame, 30, 32)[0]);
    assert_eq!(inside, 0);
    assert!((linear(edge) / linear(outside) - 0.5).abs() < 0.01, "{edge} of {outside}");
}

#[test]
fn textures_are_read_upright_repeated_and_filtered_in_linear_light() {
    // Four colours, one per texel.
    let texels = vec![0x0000_00ff, 0x0000_ff00, 0x00ff_0000, 0x00ff_ffff, 0x0080_8080];
    let mut list = empty(view(64, 64, 64.0), 4);
    list.textures.push(Arc::new(Texture { log2_size: 1, encoding: Encoding::Srgb, texels }));
    list.lights.sky_lux = [3.0; 3];
    list.lights.ground_lux = [3.0; 3];
    let material = Material {
        base_color: [1.0; 3],
        roughness: 1.0,
        albedo_map: Some(0),
        ..Material::default()
    };
    // The square fills the picture: texel centres at 16 and 48 px.
    add(&mut list, meshes::square(), facing_square(10.0, DVec3::new(0.0, 0.0, -10.0)), material);
    let frame = render(&list, &[Output::Rgb]);
    let strongest = |x, y| pixel(&frame, x, y).map(|v| v > 128);
    assert_eq!(strongest(16, 16), [true, false, false], "u = v = 1/4 is the first texel");
    assert_eq!(strongest(47, 16), [false, true, false], "u runs to the right");
    assert_eq!(strongest(16, 47), [false, false, true], "v runs down");
    assert_eq!(strongest(47, 47), [true, true, true]);
    // Halfway between black and white in green, top right to bottom left of two texels: linear.
    let black_and_white = vec![0x0000_0000, 0x00ff_ffff, 0x0000_0000, 0x00ff_ffff, 0x0080_8080];
    list.textures[0] =
        Arc::new(Texture { log2_size: 1, encoding: Encoding::Srgb, texels: black_and_white });
    let lit = |list: &DrawList, x: usize| {
        let value = pixel(&render(list, &[Output::Rgb]), x, 32)[1];
        nits(f64::from(value), 1.0)
    };
    let (dark, bright) = (lit(&list, 15), lit(&list, 47));
    let between = 0.5 * (lit(&list, 31) + lit(&list, 32));
    assert!((between / (0.5 * (dark + bright)) - 1.0).abs() < 0.03, "{dark} {between} {bright}");
    // Repeated 64 times it is smaller than a pixel and becomes its coarsest level.
    list.materials[0].uv_repeat = [64.0; 2];
    let grey = pixel(&render(&list, &[Output::Rgb]), 20, 20);
    let white = bright - dark;
    let srgb_half = ((128.0 / 255.0 + 0.055) / 1.055f64).powf(2.4);
    assert!((nits(f64::from(grey[1]), 1.0) - dark - white * srgb_half).abs() < 0.03 * white);
}

#[test]
fn a_tilted_normal_map_turns_the_light() {
    // Normals tilted towards growing u: light from the right counts more.
    let tilted = |x: u8, y: u8| {
        let texel = u32::from(x) | u32::from(y) << 8 | 0x00e0_0000;
        vec![Arc::new(Texture { log2_size: 0, encoding: Encoding::Linear, texels: vec![texel] })]
    };
    let brightness = |x: u8, y: u8, sun: [f32; 3]| {
        let mut list = empty(view(32, 32, 32.0), 1);
        list.lights.sky_lux = [0.0; 3];
        list.lights.ground_lux = [0.0; 3];
        list.lights.sun = Some(Sun { direction_to_sun: sun, color_lux: [2.0; 3], shadow: false });
        list.textures = tilted(x, y);
        let material = Material { normal_map: Some(0), ..plain([0.8; 3]) };
        add(&mut list, meshes::square(), facing_square(20.0, DVec3::new(0.0, 0.0, -5.0)), material);
        pixel(&render(&list, &[Output::Rgb]), 16, 16)[0]
    };
    let (right, above) = ([0.7, 0.0, 0.7], [0.0, 0.7, 0.7]);
    assert!(brightness(200, 128, right) > brightness(128, 128, right) + 10);
    assert!(brightness(60, 128, right) + 10 < brightness(128, 128, right));
    assert!(brightness(128, 200, above) > brightness(128, 128, above) + 10);
    assert!(brightness(128, 60, above) + 10 < brightness(128, 128, above));
}

#[test]
fn masked_layers_replace_albedo_in_order() {
    let mut list = empty(view(32, 32, 32.0), 1);
    let texels = vec![0x00ff_00ff]; // channels 0 and 2 on, 1 and 3 off
    list.textures.push(Arc::new(Texture { log2_size: 0, encoding: Encoding::Linear, texels }));
    let mut material = Material { mask: Some(0), ..plain([0.5; 3]) };
    material.layers = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [1.0; 4]];
    add(&mut list, meshes::square(), facing_square(20.0, DVec3::new(0.0, 0.0, -5.0)), material);
    let layered = pixel(&render(&list, &[Output::Rgb]), 16, 16);
    list.materials[0] = plain([0.0, 0.0, 1.0]);
    assert_eq!(layered, pixel(&render(&list, &[Output::Rgb]), 16, 16));
}

// ---- shadows

/// A wall 6 m away and a square plate 1 m before it, the sun straight behind the camera but for a
/// shift to the side.
fn plate_before_wall(samples: u32) -> DrawList {
    let mut list = empty(view(200, 200, 200.0), samples);
    list.lights.sky_lux = [0.1; 3];
    list.lights.ground_lux = [0.1; 3];
    list.lights.sun =
        Some(Sun { direction_to_sun: [1.0, 0.0, 1.0], color_lux: [2.0; 3], shadow: true });
    list.shadow_map_size = 1024;
    add(
        &mut list,
        meshes::square(),
        facing_square(12.0, DVec3::new(0.0, 0.0, -6.0)),
        plain([0.8; 3]),
    );
    add(
        &mut list,
        meshes::square(),
        facing_square(1.0, DVec3::new(1.0, 0.0, -5.0)),
        plain([0.8; 3]),
    );
    list
}

#[test]
fn a_shadow_falls_where_geometry_says() {
    // Light goes down-left at 45 degrees: the plate at x 0.5..1.5, one metre before the wall,
    // shades x -0.5..0.5 of it, where 6 m away a metre is 33.3 px.
    let list = plate_before_wall(4);
    let frame = render(&list, &[Output::Rgb, Output::Instance]);
    let (dark, lit) = (pixel(&frame, 90, 100)[0], pixel(&frame, 70, 100)[0]);
    assert!(u32::from(dark) * 2 < u32::from(lit), "{dark} is not in shadow of {lit}");
    let middle = (u32::from(dark) + u32::from(lit)) / 2;
    let shaded = |x: usize, y: usize| u32::from(pixel(&frame, x, y)[0]) < middle;
    let left = (40..100).find(|x| shaded(*x, 100)).unwrap() as f64;
    assert!((left - (100.0 - 0.5 * 200.0 / 6.0)).abs() <= 1.0, "left edge at {left}");
    let top = (40..100).find(|y| shaded(95, *y)).unwrap() as f64;
    assert!((top - (100.0 - 0.5 * 200.0 / 6.0)).abs() <= 1.0, "top edge at {top}");
    // The rest of the wall and the plate are lit evenly: no surface shades itself.
    for (x, y) in [(30, 30), (150, 170), (70, 100), (20, 190), (130, 100), (140, 90)] {
        assert!(u32::from(pixel(&frame, x, y)[0]) > middle, "acne at {x},{y}");
    }
}

#[test]
fn an_object_out_of_sight_still_casts() {
    let mut list = plate_before_wall(1);
    let with = render(&list, &[Output::Rgb, Output::Box2d]);
    list.objects[1].in_view = false;
    let unseen = render(&list, &[Output::Rgb, Output::Box2d]);
    assert_eq!(pixel(&with, 90, 100), pixel(&unseen, 90, 100));
    assert_eq!(unseen.object_samples.as_ref().unwrap()[1].count, 0);
    list.objects[1].casts_shadow = false;
    let without = render(&list, &[Output::Rgb, Output::Box2d]);
    assert!(pixel(&without, 90, 100)[0] > pixel(&unseen, 90, 100)[0]);
}

#[test]
fn a_lit_sphere_shows_no_acne() {
    // With and without its own shadow, a convex body is lit alike wherever it faces the sun.
    let mut list = empty(view(160, 160, 200.0), 1);
    list.lights.sky_lux = [0.0; 3];
    list.lights.ground_lux = [0.0; 3];
    let direction = DVec3::new(0.6, 0.5, 0.5).normalize();
    let mut sun =
        Sun { direction_to_sun: direction.as_vec3().to_array(), color_lux: [3.0; 3], shadow: true };
    list.lights.sun = Some(sun);
    list.shadow_map_size = 2048;
    add(
        &mut list,
        meshes::sphere(96, 64),
        DAffine3::from_translation(DVec3::new(0.0, 0.0, -4.0)),
        plain([0.8; 3]),
    );
    let shadowed = render(&list, &[Output::Rgb]);
    sun.shadow = false;
    list.lights.sun = Some(sun);
    let free = render(&list, &[Output::Rgb]);
    let oracle = Oracle::new(&list);
    for y in 0..160 {
        for x in 0..160 {
            let Some(hit) = oracle.sample(f64::from(x) + 0.5, f64::from(y) + 0.5).hit else {
                continue;
            };
            if hit.normal.dot(direction) > 0.1 {
                let (a, b) = (
                    pixel(&shadowed, x as usize, y as usize),
                    pixel(&free, x as usize, y as usize),
                );
                assert!(a[0].abs_diff(b[0]) <= 2, "{x},{y}: {a:?} is not {b:?}");
            }
        }
    }
}

// ---- the same bytes everywhere, and the odd sizes

fn lit(seed: u64, samples: u32) -> DrawList {
    let mut list = mixed(seed, samples);
    list.lights.sun =
        Some(Sun { direction_to_sun: [0.3, 0.8, 0.5], color_lux: [2.0; 3], shadow: true });
    list.lights.points = vec![PointLight {
        position: [0.5, 0.5, -2.0],
        range_m: 6.0,
        color_cd: [2.0; 3],
        radius_m: 0.05,
    }];
    let checks = (0..64 * 64).map(|i: u32| {
        if (i % 64 / 8 + i / 512).is_multiple_of(2) { 0x00e0_d0c0 } else { 0x0030_4050 }
    });
    let mut texels: Vec<u32> = checks.collect();
    for level in 1..=6 {
        texels.resize(texels.len() + (1usize << (2 * (6 - level))), 0x0090_8878);
    }
    list.textures.push(Arc::new(Texture { log2_size: 6, encoding: Encoding::Srgb, texels }));
    for (i, m) in list.materials.iter_mut().enumerate() {
        m.albedo_map = (i % 2 == 0).then_some(0);
        m.normal_map = (i % 3 == 0).then_some(0);
        m.hue_offset_deg = i as f32 * 70.0;
    }
    list
}

#[test]
fn instruction_sets_and_threads_do_not_change_a_byte() {
    let everything = &Output::ALL;
    let mut kept = CpuEngine::new(CpuOptions { threads: 2, ..CpuOptions::default() });
    for (seed, samples) in [(400, 1), (401, 4), (402, 16), (403, 4), (404, 1)] {
        let list = lit(seed, samples);
        let options = |simd, threads| CpuOptions { simd, threads };
        let first = try_render(&list, everything, options(SimdChoice::Baseline, 1)).unwrap();
        for other in [
            options(SimdChoice::Auto, 1),
            options(SimdChoice::Auto, 2),
            options(SimdChoice::Baseline, 3),
        ] {
            let got = try_render(&list, everything, other).unwrap();
            assert!(got == first, "scene {seed}: {other:?} differs");
        }
        // Neither do the frames that an engine has rendered before.
        let got = kept.render(&list, &plan(everything), &mut StageTimes::default()).unwrap();
        assert!(got == first, "scene {seed}: a used engine differs");
    }
}

#[test]
fn a_plan_yields_its_buffers_and_no_others() {
    let list = lit(410, 4);
    let all = render(&list, &Output::ALL);
    for outputs in
        [&[Output::Rgb][..], &[Output::Box2d], &[Output::Instance], &[Output::Keypoints], &[]]
    {
        let frame = render(&list, outputs);
        let wants = |o: Output| outputs.contains(&o);
        assert_eq!(frame.picture, all.picture.clone().filter(|_| wants(Output::Rgb)));
        let resolves = !outputs.is_empty() && !outputs.iter().all(|o| *o == Output::Rgb);
        assert_eq!(frame.object_ids, all.object_ids.clone().filter(|_| resolves));
        assert_eq!(frame.depth_m, all.depth_m.clone().filter(|_| resolves));
        let reduces = wants(Output::Box2d);
        assert_eq!(frame.object_samples, all.object_samples.clone().filter(|_| reduces));
    }
}

#[test]
fn odd_sizes_and_empty_scenes_render() {
    for (width, height) in [(1, 1), (1, 300), (300, 1), (31, 33), (65, 64)] {
        for samples in [1, 4, 16] {
            let mut list = empty(view(width, height, 50.0), samples);
            list.lights.background_nits = [1.0; 3];
            let frame = render(&list, &Output::ALL);
            assert!(frame.object_ids.unwrap().iter().all(|id| *id == 0));
            assert_eq!(frame.object_samples.unwrap(), []);
            add(
                &mut list,
                meshes::square(),
                facing_square(1e4, DVec3::new(0.0, 0.0, -3.0)),
                plain([0.5; 3]),
            );
            let frame = render(&list, &Output::ALL);
            assert!(frame.object_ids.unwrap().iter().all(|id| *id == 1));
            assert_eq!(frame.picture.unwrap().len() as u32, width * height * 3);
            let count = u64::from(width * height * samples);
            assert_eq!(frame.object_samples.unwrap()[0].count, count);
        }
    }
}

#[test]
fn the_largest_picture_has_its_edges_in_place() {
    let mut list = empty(view(8192, 8192, 8192.0), 1);
    // From pixel 1000 to pixel 7192, 10 m away.
    let half = (7192.0 - 4096.0) / 8192.0 * 10.0;
    add(
        &mut list,
        meshes::square(),
        facing_square(2.0 * half, DVec3::new(0.0, 0.0, -10.0)),
        plain([0.5; 3]),
    );
    let sums = render(&list, &[Output::Box2d]).object_samples.unwrap()[0];
    assert_eq!(sums.count, 6192 * 6192);
    assert_eq!((sums.min_16th, sums.max_16th), ([1000 * 16 + 8; 2], [7191 * 16 + 8; 2]));
}

#[test]
fn more_triangles_than_sixteen_bits_keep_their_objects() {
    let mut list = empty(view(96, 96, 96.0), 1);
    // Two spheres of 180,000 triangles beside each other.
    for x in [-1.0, 1.0] {
        add(
            &mut list,
            meshes::sphere(300, 300),
            DAffine3::from_translation(DVec3::new(x, 0.0, -4.0)),
            plain([0.5; 3]),
        );
    }
    let ids = render(&list, LABELS).object_ids.unwrap();
    assert!((0..96 * 96).all(|i| ids[i] == 0 || (ids[i] == 1) == (i % 96 < 48)));
    assert!(ids.iter().filter(|id| **id != 0).count() > 2500);
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_name() {
    let bad = |change: &dyn Fn(&mut DrawList)| {
        let mut list = lit(420, 1);
        let square = add(
            &mut list,
            meshes::square(),
            facing_square(1.0, DVec3::new(0.0, 0.0, -3.0)),
            plain([0.5; 3]),
        );
        change(&mut list);
        let error = try_render(&list, &[Output::Rgb], CpuOptions::default()).unwrap_err();
        (error, square as u32)
    };
    let of_object = |(error, square): (EngineError, u32)| matches!(error, EngineError::NotFinite { object, .. } if object == square);
    assert!(of_object(bad(&|l| l.objects.last_mut().unwrap().view_from_model[1][2] = f32::NAN)));
    assert!(of_object(bad(&|l| {
        let mesh = Arc::make_mut(&mut l.objects.last_mut().unwrap().mesh);
        mesh.positions[2][0] = f32::INFINITY;
    })));
    assert!(of_object(bad(&|l| {
        let mesh = Arc::make_mut(&mut l.objects.last_mut().unwrap().mesh);
        mesh.normals[1][0] = f32::NAN;
    })));
    for change in [
        (|l: &mut DrawList| l.exposure = f32::NAN) as fn(&mut DrawList),
        |l| l.view.fx = f32::INFINITY,
        |l| l.lights.points[0].color_cd[0] = f32::NAN,
        |l| l.materials[0].roughness = f32::NAN,
    ] {
        assert!(matches!(bad(&change).0, EngineError::NotFinite { object: u32::MAX, .. }));
    }
}

#[test]
fn draw_lists_that_contradict_themselves_are_refused() {
    for change in [
        (|l: &mut DrawList| l.samples = 3) as fn(&mut DrawList),
        |l| l.shadow_map_size = 100,
        |l| l.draws[0].material = 1000,
        |l| l.draws[0].triangles.end = 1_000_000,
        |l| l.view.width = 0,
    ] {
        let mut list = lit(430, 1);
        change(&mut list);
        let error = try_render(&list, &[Output::Rgb], CpuOptions::default()).unwrap_err();
        assert!(matches!(error, EngineError::Invalid { .. }), "{error}");
    }
    let mut list = lit(431, 1);
    list.view.height = 8193;
    let error = try_render(&list, &[Output::Rgb], CpuOptions::default()).unwrap_err();
    assert!(matches!(error, EngineError::TooLarge { limit: 8192, .. }));
}

/// Surfaces that lie where numbers run out must not panic or spoil other pixels.
#[test]
fn extreme_places_do_no_harm() {
    for scale in [1e-12, 1e-6, 1.0, 1e6, 1e15] {
        for distance in [0.100_001, 1.0, 1e4, 1e12] {
            let mut list = empty(view(48, 48, 48.0), 4);
            let turn = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.5) * scale;
            let place = DAffine3::from_mat3_translation(turn, DVec3::new(0.0, 0.0, -distance));
            add(&mut list, meshes::sphere(8, 6), place, plain([0.5; 3]));
            add(
                &mut list,
                meshes::square(),
                facing_square(0.2, DVec3::new(0.0, 0.0, -0.2)),
                plain([0.9; 3]),
            );
            list.lights.sun =
                Some(Sun { direction_to_sun: [0.3, 0.8, 0.5], color_lux: [2.0; 3], shadow: true });
            list.draws[0].double_sided = true;
            let frame = render(&list, &Output::ALL);
            let depth = frame.depth_m.unwrap();
            assert!(depth.iter().all(|d| d.is_finite()));
        }
    }
}
