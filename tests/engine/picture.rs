//! Light, textures and shadows against the oracle and closed forms.

use figurant_core::draw::DrawList;
use figurant_core::draw::abi::{Blocker, Material, PointLight, Sun, Surroundings, ToneCurve};
use figurant_core::library::environment::EnvironmentMap;
use figurant_core::library::environment::equirect::Equirect;
use figurant_core::library::environment::map::Detail;
use figurant_core::library::texture::{Encoding, Texture, color_from_srgb8};
use figurant_core::plan::Output;
use figurant_tests::drawlists::{self, add, any_blockers, any_surroundings, empty, mixed, view};
use figurant_tests::meshes::{self, Dice};
use figurant_tests::oracle::{Oracle, display, nits, radiance};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use std::sync::Arc;

use super::common::*;

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
        list.lights.surroundings = (seed % 2 == 1).then(|| any_surroundings(&mut dice));
        any_blockers(&mut dice, &mut list);
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

/// A finish of nothing leaves hue and roughness, one of everything turns the one and polishes the
/// other, and half of it does half of both.
#[test]
fn a_finish_turns_the_hue_and_polishes_by_its_share() {
    let wall = |finish: Option<[u8; 2]>, hue_offset_deg: f32, roughness: f32| {
        let mut list = empty(view(64, 64, 64.0), 1);
        let material = Material { hue_offset_deg, roughness, ..plain([0.5, 0.3, 0.2]) };
        let square = facing_square(20.0, DVec3::new(0.0, 0.0, -3.0));
        add(&mut list, meshes::square(), square, material);
        list.lights.sun =
            Some(Sun { direction_to_sun: [0.1, 0.2, 1.0], color_lux: [1.5; 3], shadow: false });
        list.grade.tone_curve = ToneCurve::None;
        if let Some([turned, gloss]) = finish {
            let texel = u32::from_le_bytes([turned, gloss, 0, 0]);
            list.textures =
                vec![Arc::new(Texture::from_level0(2, Encoding::Linear, vec![texel; 16]))];
            list.materials[0].finish_map = Some(0);
        }
        let at = pixel(&render(&list, &[Output::Rgb]), 20, 24);
        at.map(|byte| linear_from_srgb(f64::from(byte) / 255.0))
    };
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.006);
    let (own, turned) = (wall(None, 0.0, 0.8), wall(None, 120.0, 0.8));
    assert!(!near(own, turned));
    assert!(near(wall(Some([0, 0]), 120.0, 0.8), own));
    assert!(near(wall(Some([255, 0]), 120.0, 0.8), turned));
    let half = std::array::from_fn(|c| (own[c] + turned[c]) * 0.5);
    assert!(near(wall(Some([128, 0]), 120.0, 0.8), half));
    let polished = wall(None, 0.0, Material::GLOSSY);
    assert!(!near(polished, own));
    assert!(near(wall(Some([0, 255]), 0.0, 0.8), polished));
}

#[test]
fn a_sensors_noise_has_the_spread_that_light_and_reading_give() {
    for (shot, read, light) in [(0.01_f64, 0.0_f64, 0.5_f64), (0.0, 0.03, 0.4), (0.004, 0.02, 0.25)]
    {
        let mut list = empty(view(256, 256, 256.0), 4);
        list.grade.shot_noise = shot as f32;
        list.grade.read_noise = read as f32;
        list.grade.tone_curve = ToneCurve::None;
        list.lights.background_nits = [light as f32; 3];
        let frame = render(&list, &[Output::Rgb]);
        let all: Vec<[f64; 3]> = (0..256 * 256)
            .map(|i| pixel(&frame, i % 256, i / 256))
            .map(|p| p.map(|byte| linear_from_srgb(f64::from(byte) / 255.0)))
            .collect();
        let mean = |f: &dyn Fn(&[f64; 3]) -> f64| all.iter().map(f).sum::<f64>() / all.len() as f64;
        let expected = (shot * light + read * read).sqrt();
        for c in 0..3 {
            let level = mean(&|p| p[c]);
            let spread = mean(&|p| (p[c] - level).powi(2)).sqrt();
            assert!((level / light - 1.0).abs() < 0.005, "{level} is not {light}");
            assert!((spread / expected - 1.0).abs() < 0.02, "{spread} is not {expected}");
            let other = mean(&|p| (p[c] - level) * (p[(c + 1) % 3] - light));
            assert!(other.abs() < 0.02 * expected * expected, "{other}");
        }
    }
}

/// Linear light of sRGB, 0..1 (IEC 61966-2-1).
fn linear_from_srgb(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// Under a uniform sky: by adding up the cosines of the directions that do not meet the sphere.
#[test]
fn a_sphere_over_a_wall_takes_the_light_that_it_hides() {
    let (radius, distance) = (0.3, 4.0);
    for height in [0.3, 0.36, 0.5] {
        let mut list = empty(view(129, 129, 129.0), 4);
        let wall = facing_square(20.0, DVec3::new(0.0, 0.0, -distance));
        add(&mut list, meshes::square(), wall, plain([1.0; 3]));
        list.lights.sky_lux = [2.0; 3];
        list.lights.ground_lux = [2.0; 3];
        let open = render(&list, &[Output::Rgb]);
        let center = DVec3::new(0.0, 0.0, height - distance);
        list.blockers =
            vec![Blocker { center: center.as_vec3().to_array(), radius_m: radius as f32 }];
        let frame = render(&list, &[Output::Rgb]);
        for step in 0..10 {
            let x = 64 + step as usize;
            let foot = DVec3::new(f64::from(step) / 129.0 * distance, 0.0, -distance);
            let to_center = center - foot;
            let cosine = |d: DVec3| {
                let along = d.dot(to_center);
                let off = to_center.length_squared() - along * along;
                if along > 0.0 && off < radius * radius { d.z } else { 0.0 }
            };
            let expected = 1.0 - over_hemisphere(cosine) / std::f64::consts::PI;
            let light = |frame| nits(f64::from(pixel(frame, x, 64)[1]), 1.0);
            let got = light(&frame) / light(&open);
            assert!((got - expected).abs() < 0.03, "{height} {step}: {got} is not {expected}");
        }
    }
}

/// Integral over the directions with positive z.
fn over_hemisphere(f: impl Fn(DVec3) -> f64) -> f64 {
    const N: usize = 400;
    let cell = |i: usize| {
        let z = (i as f64 + 0.5) / N as f64;
        let round = (0..2 * N).map(|k| {
            let turn = std::f64::consts::TAU * (k as f64 + 0.5) / (2 * N) as f64;
            let flat = (1.0 - z * z).sqrt();
            f(DVec3::new(flat * turn.cos(), flat * turn.sin(), z))
        });
        round.sum::<f64>()
    };
    (0..N).map(cell).sum::<f64>() * std::f64::consts::TAU / (2 * N * N) as f64
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

/// What reflects all light, whether matt, rough or polished metal, cannot be told from white
/// surroundings, be they a picture or the same sky and ground.
#[test]
fn a_white_sphere_in_white_surroundings_vanishes() {
    let white = Equirect::from_fn(64, |_| DVec3::ONE.as_vec3());
    let map = Arc::new(EnvironmentMap::new(white, Detail::COMPUTED).unwrap());
    for (roughness, metallic) in [(0.04, 0.0), (0.5, 0.0), (1.0, 0.0), (0.2, 1.0), (1.0, 1.0)] {
        for picture in [true, false] {
            let mut list = empty(view(96, 96, 120.0), 4);
            list.lights.surroundings =
                picture.then(|| Surroundings::new(Arc::clone(&map), DMat3::IDENTITY, 0.3));
            let lux = 0.3 * std::f32::consts::PI;
            (list.lights.sky_lux, list.lights.ground_lux) = ([lux; 3], [lux; 3]);
            list.lights.background_nits = [0.3; 3];
            let white = Material { roughness, metallic, ..plain([1.0; 3]) };
            let place = DAffine3::from_translation(DVec3::new(0.0, 0.0, -4.0));
            add(&mut list, meshes::sphere(96, 64), place, white);
            let frame = render(&list, &[Output::Rgb]);
            let wanted = i32::from(pixel(&frame, 0, 0)[0]);
            assert!(f64::from((wanted - display(0.3, 1.0).round() as i32).abs()) < 1.5);
            for v in frame.picture.unwrap() {
                let off = (i32::from(v) - wanted).abs();
                assert!(off <= 1, "roughness {roughness}, metallic {metallic}: {v}, not {wanted}");
            }
        }
    }
}

/// Where nothing stands, a picture of all directions is seen in its place: a lamp 20 degrees to
/// the right and 10 up, in a picture turned by 90 degrees.
#[test]
fn surroundings_stand_where_they_should() {
    let angle = |deg: f64| deg.to_radians().tan();
    let lamp = DVec3::new(angle(20.0), angle(10.0) / 20f64.to_radians().cos(), -1.0).normalize();
    // To the left of the picture's middle, in its axes.
    let map_from_view = DMat3::from_rotation_y(90f64.to_radians());
    let in_map = map_from_view * lamp;
    let light = |d: DVec3| DVec3::splat(if d.dot(in_map) > 0.9995 { 50.0 } else { 0.01 }).as_vec3();
    let map = EnvironmentMap::new(Equirect::from_fn(512, light), Detail::COMPUTED).unwrap();
    let mut list = empty(view(200, 160, 200.0), 1);
    list.lights.surroundings = Some(Surroundings::new(Arc::new(map), map_from_view, 0.1));
    let frame = render(&list, &[Output::Rgb]);
    let bright: Vec<[f64; 2]> = (0..160 * 200)
        .filter(|i| pixel(&frame, i % 200, i / 200)[0] > 200)
        .map(|i| [(i % 200) as f64 + 0.5, (i / 200) as f64 + 0.5])
        .collect();
    assert!(!bright.is_empty());
    let mean = |k: usize| bright.iter().map(|p| p[k]).sum::<f64>() / bright.len() as f64;
    let wanted = [100.0 - 200.0 * lamp.x / lamp.z, 80.0 + 200.0 * lamp.y / lamp.z];
    assert!((mean(0) - wanted[0]).abs() < 1.0, "{} and not {}", mean(0), wanted[0]);
    assert!((mean(1) - wanted[1]).abs() < 1.0, "{} and not {}", mean(1), wanted[1]);
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
    let (red, green, blue) = ([255, 0, 0], [0, 255, 0], [0, 0, 255]);
    let texels = [red, green, blue, [255; 3], [128; 3]].map(color_from_srgb8).to_vec();
    let mut list = empty(view(64, 64, 64.0), 4);
    list.textures.push(Arc::new(Texture {
        log2_size: 1,
        encoding: Encoding::Color,
        texels: texels.into(),
    }));
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
    let texels = [0, 255, 0, 255, 128].map(|v| color_from_srgb8([v; 3])).to_vec();
    list.textures[0] =
        Arc::new(Texture { log2_size: 1, encoding: Encoding::Color, texels: texels.into() });
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
        vec![Arc::new(Texture {
            log2_size: 0,
            encoding: Encoding::Linear,
            texels: vec![texel].into(),
        })]
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
    list.textures.push(Arc::new(Texture {
        log2_size: 0,
        encoding: Encoding::Linear,
        texels: texels.into(),
    }));
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
