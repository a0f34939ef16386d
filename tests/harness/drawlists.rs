//! Draw lists for tests of an engine, built from the ground up.

use std::sync::Arc;

use figurant_core::base::lens::{Lens, LensError, LensGrid};
use figurant_core::draw::DrawList;
use figurant_core::draw::abi::{
    Blocker, Bloom, ColorGrade, Defocus, Draw, DrawObject, End, Grade, Lights, Material, Shutter,
    Surroundings, ToneCurve, View,
};
use figurant_core::library::environment::EnvironmentMap;
use figurant_core::library::environment::equirect::Equirect;
use figurant_core::library::environment::map::Detail;
use figurant_core::library::mesh::{Cutout, Mesh};
use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};

use crate::meshes::{self, Dice};

/// A transform as the draw list holds it.
pub fn rows(m: &DAffine3) -> [[f32; 4]; 3] {
    let (r, t) = (m.matrix3, m.translation);
    std::array::from_fn(|i| {
        [r.col(0)[i] as f32, r.col(1)[i] as f32, r.col(2)[i] as f32, t[i] as f32]
    })
}

/// A picture with square pixels and its principal point in the middle, looking along world -Z.
pub fn view(width: u32, height: u32, focal_px: f32) -> View {
    View {
        width,
        height,
        fx: focal_px,
        fy: focal_px,
        cx: width as f32 * 0.5,
        cy: height as f32 * 0.5,
        near_m: 0.1,
        pad: 0,
        view_from_world: rows(&DAffine3::IDENTITY),
    }
}

/// Nothing yet, seen through a view, with a neutral light.
pub fn empty(view: View, samples: u32) -> DrawList {
    DrawList {
        view,
        exposure: 1.0,
        shadow_map_size: 1024,
        samples,
        lights: Lights { sky_lux: [2.0; 3], ground_lux: [1.0; 3], ..Lights::default() },
        ..DrawList::default()
    }
}

/// Adds an object of one draw; returns its index.
pub fn add(
    list: &mut DrawList,
    mesh: Mesh,
    view_from_model: DAffine3,
    material: Material,
) -> usize {
    let object = list.objects.len();
    list.draws.push(Draw {
        object: object as u32,
        triangles: 0..mesh.triangles.len() as u32,
        material: list.materials.len() as u32,
        double_sided: false,
        cutout: None,
    });
    list.materials.push(material);
    list.objects.push(DrawObject {
        mesh: Arc::new(mesh),
        view_from_model: rows(&view_from_model),
        palette: 0..0,
        end: None,
        in_view: true,
        casts_shadow: true,
        smooth: true,
        blockers: 0..0,
    });
    object
}

/// Adds a skinned object whose joints stand at the given transforms.
pub fn add_skinned(
    list: &mut DrawList,
    mesh: Mesh,
    joints: &[DAffine3],
    material: Material,
) -> usize {
    let first = list.palette.len() as u32;
    list.palette.extend(joints.iter().map(rows));
    let object = add(list, mesh, DAffine3::IDENTITY, material);
    list.objects[object].palette = first..list.palette.len() as u32;
    object
}

/// Everything that may happen to the light behind the lens, or some of it.
pub fn any_grade(dice: &mut Dice) -> Grade {
    let mut matrix = || {
        let mut entry = |same: bool| dice.range(-0.1, 0.1) as f32 + if same { 1.0 } else { 0.0 };
        std::array::from_fn(|r| std::array::from_fn(|c| entry(r == c)))
    };
    let (before, after) = (matrix(), matrix());
    let contrast = if dice.unit() < 0.3 { 1.0 } else { dice.range(0.5, 1.5) as f32 };
    let bloom = Bloom { share: dice.unit() as f32, spread: dice.unit() as f32 };
    Grade {
        bloom: (dice.unit() < 0.5).then_some(bloom),
        vignette: if dice.unit() < 0.3 { 0.0 } else { dice.range(0.0, 0.6) as f32 },
        shot_noise: if dice.unit() < 0.6 { 0.0 } else { dice.range(0.0, 0.01) as f32 },
        read_noise: if dice.unit() < 0.6 { 0.0 } else { dice.range(0.0, 0.02) as f32 },
        color: (dice.unit() < 0.8).then_some(ColorGrade { before, contrast, after }),
        tone_curve: [ToneCurve::Aces, ToneCurve::Agx, ToneCurve::None][dice.below(3)],
        grain: if dice.unit() < 0.5 { 0.0 } else { 0.03 },
        grain_key: dice.below(1 << 30) as u32,
    }
}

/// Some focus, with disks of some pixels.
pub fn any_defocus(dice: &mut Dice) -> Defocus {
    let (focus_m, at_infinity_px) = (dice.range(0.5, 6.0) as f32, dice.range(0.5, 9.0) as f32);
    Defocus { focus_m, at_infinity_px, largest_px: at_infinity_px * dice.range(1.0, 2.0) as f32 }
}

/// An open shutter, while which some objects move and the camera turns.
pub fn any_shutter(dice: &mut Dice, list: &mut DrawList) {
    let moved = |dice: &mut Dice, m: &[[f32; 4]; 3]| {
        let mut to = *m;
        for row in &mut to {
            row[3] += dice.range(-0.2, 0.2) as f32;
            row[..3].iter_mut().for_each(|v| *v *= dice.range(0.9, 1.1) as f32);
        }
        to
    };
    for object in &mut list.objects {
        if dice.unit() < 0.4 {
            continue;
        }
        let first = list.palette.len() as u32;
        for joint in object.palette.clone() {
            let there = moved(dice, &list.palette[joint as usize]);
            list.palette.push(there);
        }
        let view_from_model = moved(dice, &object.view_from_model);
        object.end = Some(End { view_from_model, palette: first..list.palette.len() as u32 });
    }
    let turn = DMat3::from_axis_angle(dice.direction(), dice.range(0.0, 0.1));
    list.shutter = Some(Shutter {
        end_from_view: turn.transpose().to_cols_array_2d().map(|row| row.map(|v| v as f32)),
        longest_px: dice.range(0.6, 20.0) as f32,
    });
}

/// A coloured sky with a small bright lamp in it, turned at random.
pub fn any_surroundings(dice: &mut Dice) -> Surroundings {
    let (lamp, tint) = (dice.direction(), DVec3::new(0.3, 0.25, 0.2));
    let light = |d: DVec3| {
        let glow = if d.dot(lamp) > 0.98 { 8.0 } else { 0.0 };
        (DVec3::splat(0.5 + glow) + tint * d).as_vec3()
    };
    let map = EnvironmentMap::new(Equirect::from_fn(128, light), Detail::COMPUTED);
    let turn = DMat3::from_axis_angle(dice.direction(), dice.range(0.0, 6.0));
    Surroundings::new(Arc::new(map.expect("a sky that is not black")), turn, dice.range(0.1, 0.5))
}

/// Spheres in the way of surrounding light, the first ones those of the first object.
pub fn any_blockers(dice: &mut Dice, list: &mut DrawList) {
    list.blockers = (0..40)
        .map(|_| {
            let distance = dice.range(0.4, 9.0);
            let offset = dice.vector() * DVec3::new(0.6, 0.6, 0.0) * distance;
            Blocker {
                center: (offset - DVec3::Z * distance).as_vec3().to_array(),
                radius_m: dice.range(0.05, 0.6) as f32,
            }
        })
        .collect();
    list.objects[0].blockers = 0..12;
}

/// Leaves strands of some draws.
fn any_cutouts(dice: &mut Dice, list: &mut DrawList) {
    for draw in &mut list.draws {
        let cutout = Cutout {
            strands_per_u: 1 + dice.below(40) as u16,
            frayed_1024ths: 1 + dice.below(1500) as u16,
        };
        draw.cutout = (dice.unit() < 0.3).then_some(cutout);
    }
}

/// Puts a lens before the pinhole of a draw list; says whether a picture can be taken through it.
pub fn put_lens(list: &mut DrawList, lens: Lens) -> Result<(), LensError> {
    let view = &list.view;
    let [fx, fy, cx, cy] = [view.fx, view.fy, view.cx, view.cy].map(f64::from);
    let size_px = [view.width, view.height];
    let grid = LensGrid::new(lens, DVec2::new(fx, fy), DVec2::new(cx, cy), size_px)?;
    list.lens = Some(Arc::new(grid));
    Ok(())
}

/// A barrel or a cushion with all five coefficients, or a fisheye, that a picture can be taken
/// through.
pub fn any_lens(dice: &mut Dice, list: &mut DrawList) {
    loop {
        let mut k = |limit: f64| dice.range(-limit, limit);
        let lens = if k(1.0) < 0.0 {
            Lens::Brown { k1: k(0.35), k2: k(0.1), p1: k(0.02), p2: k(0.02), k3: k(0.02) }
        } else {
            Lens::Fisheye { k1: k(0.1), k2: k(0.03), k3: k(0.01), k4: k(0.003) }
        };
        if put_lens(list, lens).is_ok() {
            return;
        }
    }
}

/// Scale, then a random rotation, then a position.
pub fn tumbled(dice: &mut Dice, scale: f64, position: DVec3) -> DAffine3 {
    let rotation = DQuat::from_axis_angle(dice.direction(), dice.range(0.0, 6.0));
    DAffine3::from_scale_rotation_translation(DVec3::splat(scale), rotation, position)
}

/// A scene made of everything that is hard for a rasteriser: skinned bodies, uneven and mirrored
/// scale, walls larger than the picture, floors under the camera, surfaces through the near plane,
/// specks smaller than a pixel, and triangle soup.
pub fn mixed(seed: u64, samples: u32) -> DrawList {
    let mut dice = Dice::new(seed);
    let side = |dice: &mut Dice| 64 + dice.below(if samples == 1 { 65 } else { 17 }) as u32;
    let (width, height) = (side(&mut dice), side(&mut dice));
    let mut view = view(width, height, dice.range(0.6, 1.6) as f32 * width as f32);
    view.fy *= dice.range(0.9, 1.1) as f32;
    view.cx += dice.range(-9.0, 9.0) as f32;
    view.cy += dice.range(-9.0, 9.0) as f32;
    let mut list = empty(view, samples);
    let material = |dice: &mut Dice| Material {
        base_color: [
            dice.range(0.1, 0.9) as f32,
            dice.range(0.1, 0.9) as f32,
            dice.range(0.1, 0.9) as f32,
        ],
        roughness: dice.range(0.3, 1.0) as f32,
        metallic: if dice.unit() < 0.3 { dice.unit() as f32 } else { 0.0 },
        ..Material::default()
    };
    for _ in 0..3 + dice.below(5) {
        let distance = dice.range(0.4, 9.0);
        let offset = dice.vector() * DVec3::new(0.6, 0.6, 0.0) * distance;
        let place = offset - DVec3::Z * distance;
        let m = material(&mut dice);
        match dice.below(9) {
            0 => {
                let joints: Vec<DAffine3> = (0..6)
                    .map(|_| {
                        let turn = DQuat::from_axis_angle(dice.direction(), dice.range(-0.4, 0.4));
                        DAffine3::from_scale_rotation_translation(DVec3::splat(0.5), turn, place)
                    })
                    .collect();
                let mesh = meshes::skinned_body(&mut dice, 14, 16, 6);
                add_skinned(&mut list, mesh, &joints, m);
            }
            1 => {
                let uneven = DAffine3::from_mat3(DMat3::from_diagonal(
                    DVec3::new(-0.3, 0.6, 0.2) * dice.range(0.5, 2.0),
                ));
                let turn = tumbled(&mut dice, 1.0, place);
                add(&mut list, meshes::sphere(16, 10), turn * uneven, m);
            }
            2 => {
                let turn = tumbled(&mut dice, 0.4, place);
                let torus = add(&mut list, meshes::torus(18, 9, 0.35), turn, m);
                list.objects[torus].smooth = false;
            }
            3 => {
                let turn = tumbled(&mut dice, 0.4, place);
                add(&mut list, meshes::cuboid(), turn, m);
            }
            4 => {
                let turn = tumbled(&mut dice, 0.7, place);
                let mesh = meshes::soup(&mut dice, 60, 0.5);
                add(&mut list, mesh, turn, m);
                list.draws.last_mut().expect("an object was added").double_sided = true;
            }
            5 => {
                // Specks, most of which miss every sample.
                let turn = tumbled(&mut dice, distance * 0.3, place);
                let mesh = meshes::soup(&mut dice, 200, 0.01);
                add(&mut list, mesh, turn, m);
                list.draws.last_mut().expect("an object was added").double_sided = true;
            }
            6 => {
                let floor = DAffine3::from_translation(DVec3::new(0.0, -1.0, 0.0))
                    * DAffine3::from_rotation_x(-1.57)
                    * DAffine3::from_scale(DVec3::splat(dice.range(20.0, 3000.0)));
                add(&mut list, meshes::square(), floor, m);
            }
            7 => {
                // Through the near plane and past the camera.
                let place = dice.vector() * 0.7;
                let turn = tumbled(&mut dice, 1.5, place);
                let mesh = meshes::soup(&mut dice, 30, 2.0);
                add(&mut list, mesh, turn, m);
                list.draws.last_mut().expect("an object was added").double_sided = true;
            }
            _ => {
                let wall = tumbled(&mut dice, 1.0, DVec3::ZERO).matrix3;
                let leaning = DMat3::IDENTITY + wall * 0.3;
                let wall =
                    DAffine3::from_mat3_translation(leaning * 40.0, DVec3::new(0.0, 0.0, -12.0));
                add(&mut list, meshes::square(), wall, m);
            }
        }
    }
    any_cutouts(&mut Dice::new(seed + 11), &mut list);
    list
}
