//! A fixed scene of realistic load, for benches and for looking at: seven bodies, thirty textured
//! objects, a wall and a floor under a sun and seven lamps.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use figurant_core::draw::DrawList;
use figurant_core::draw::abi::{Material, PointLight, Sun};
use figurant_core::library::mesh::{Mesh, Normal, SkinVertex};
use figurant_core::library::texture::{Encoding, Texture, colors_from_srgb};
use glam::{DAffine3, DQuat, DVec3};

use crate::drawlists::{add, add_skinned, empty, view};
use crate::meshes::{self, Dice};

/// Joints of a body.
const JOINTS: usize = 52;

/// A lumpy figure of about the given number of triangles, 1.76 m tall, its feet at y = 0.
fn body(triangles: usize) -> Mesh {
    let side = ((triangles / 2) as f64).sqrt() as usize;
    let mut mesh = meshes::sphere(side, side);
    let bump = |y: f64, center: f64, width: f64| (-((y - center) / width).powi(2)).exp();
    for (i, p) in mesh.positions.iter_mut().enumerate() {
        let (around, down) = (
            (i % (side + 1)) as f64 / side as f64 * TAU,
            (i / (side + 1)) as f64 / side as f64 * PI,
        );
        let y = down.cos() * 0.88;
        let ripple =
            0.012 * (9.0 * around + 12.0 * y).sin() + 0.008 * (23.0 * y + 3.0 * around).cos();
        let waist = 0.10 + 0.10 * bump(y, 0.35, 0.2) + 0.06 * bump(y, -0.1, 0.25)
            - 0.055 * bump(y, 0.60, 0.07);
        let radius = (waist + ripple) * down.sin().max(0.0).sqrt();
        *p = [
            (radius * 1.5 * around.sin()) as f32,
            (y + 0.88) as f32,
            (radius * around.cos()) as f32,
        ];
    }
    normals_from_triangles(&mut mesh, side + 1);
    mesh.skin = mesh.positions.iter().map(|p| skin(f64::from(p[1]) / 1.76, p[0] < 0.0)).collect();
    mesh
}

/// Two chains of 26 joints, left and right, each vertex on up to four of one.
fn skin(height: f64, right: bool) -> SkinVertex {
    let along = height.clamp(0.0, 0.999) * 25.0;
    let mut out = SkinVertex::default();
    let mut rest = 255u8;
    for k in 0..4 {
        let joint = (along as usize + k).saturating_sub(1).min(25);
        out.joints[k] = (joint + if right { 26 } else { 0 }) as u8;
        let near = (1.0 - (joint as f64 - along).abs() / 2.2).max(0.0);
        out.weights[k] = if k == 3 { rest } else { ((near * 128.0) as u8).min(rest) };
        rest -= out.weights[k];
    }
    out
}

/// Area-weighted normals, joined over the seam of a grid of `columns` columns.
fn normals_from_triangles(mesh: &mut Mesh, columns: usize) {
    let at = |i: u32| DVec3::from_array(mesh.positions[i as usize].map(f64::from));
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    for t in mesh.triangles.iter().map(|t| t.get()) {
        let normal = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
        t.iter().for_each(|v| sums[*v as usize] += normal);
    }
    for row in sums.chunks_mut(columns) {
        let seam = row[0] + row[columns - 1];
        (row[0], row[columns - 1]) = (seam, seam);
    }
    let unit = |n: &DVec3| Normal::new(n.normalize_or(DVec3::Y).as_vec3().to_array());
    mesh.normals = sums.iter().map(unit).collect();
}

/// A texture of 512x512 texels with its mip levels.
fn texture(color: impl Fn(usize, usize) -> [f64; 3]) -> Arc<Texture> {
    let mut side = 512;
    let mut level: Vec<[f64; 3]> = (0..side * side).map(|i| color(i % side, i / side)).collect();
    let mut texels = Vec::new();
    loop {
        let pixels: Vec<[f32; 3]> = level.iter().map(|c| c.map(|v| v as f32)).collect();
        texels.extend(colors_from_srgb(&pixels));
        if side == 1 {
            break;
        }
        let half = side / 2;
        level = (0..half * half)
            .map(|i| {
                let at = i % half * 2 + i / half * 2 * side;
                std::array::from_fn(|c| {
                    0.25 * (level[at][c]
                        + level[at + 1][c]
                        + level[at + side][c]
                        + level[at + side + 1][c])
                })
            })
            .collect();
        side = half;
    }
    Arc::new(Texture { log2_size: 9, encoding: Encoding::Color, texels: texels.into() })
}

fn textures(dice: &mut Dice) -> Vec<Arc<Texture>> {
    let noise: Vec<f64> = (0..512 * 512).map(|_| dice.range(-0.06, 0.06)).collect();
    let grain =
        move |x: usize, y: usize, v: f64, tint: [f64; 3]| tint.map(|t| v * t + noise[y * 512 + x]);
    vec![
        texture(|x, y| {
            let joint = y % 64 < 5 || (x + y / 64 % 2 * 64) % 128 < 5;
            grain(x, y, if joint { 0.75 } else { 0.45 }, [1.05, 0.8, 0.7])
        }),
        texture(|x, y| {
            grain(x, y, if (x / 64 + y / 64) % 2 == 0 { 0.9 } else { 0.3 }, [1.0, 0.95, 0.9])
        }),
        texture(|x, y| {
            grain(
                x,
                y,
                0.55 + 0.35 * (x as f64 * 0.0491).sin() * (y as f64 * 0.0491).cos(),
                [1.0, 0.95, 0.9],
            )
        }),
        texture(|x, y| grain(x, y, if (x + y) % 128 < 64 { 0.8 } else { 0.5 }, [1.0, 0.95, 0.9])),
    ]
}

/// The scene, with bodies of about this many triangles.
pub fn crowd(width: u32, height: u32, samples: u32, body_triangles: usize) -> DrawList {
    let mut dice = Dice::new(12);
    let focal = f64::from(height) * 0.5 / (15.0f64).to_radians().tan();
    let mut list = empty(view(width, height, focal as f32), samples);
    list.shadow_map_size = 2048;
    list.textures = textures(&mut dice);
    let world = |p: DVec3| p - DVec3::new(0.0, 1.2, 0.0);
    let textured = |dice: &mut Dice, map: usize| Material {
        base_color: std::array::from_fn(|_| dice.range(0.5, 1.0) as f32),
        albedo_map: Some(map as u32),
        roughness: dice.range(0.2, 0.9) as f32,
        uv_repeat: [4.0; 2],
        ..Material::default()
    };

    let mesh = body(body_triangles);
    for i in 0..7 {
        let x = [-0.55, 0.75, -1.5, 0.25, 1.9, -0.6, -2.4][i];
        let place = world(DVec3::new(x, 0.0, -5.0 - i as f64 * 1.1));
        let joints: Vec<DAffine3> = (0..JOINTS)
            .map(|joint| {
                let bend = 0.06 * (i as f64 + (joint % 26) as f64 * 0.12).sin();
                DAffine3::from_rotation_translation(
                    DQuat::from_rotation_z(bend) * DQuat::from_rotation_y(i as f64),
                    place,
                )
            })
            .collect();
        let mut material = textured(&mut dice, i % 4);
        material.wrap = 0.2;
        add_skinned(&mut list, mesh.clone(), &joints, material);
    }
    let shapes = [meshes::sphere(32, 24), meshes::torus(40, 20, 0.35), meshes::cuboid()];
    for i in 0..30 {
        let z = dice.range(-13.0, -6.0);
        let place = DVec3::new(dice.range(0.26, -0.26) * z, dice.range(0.25, -0.25) * z, z);
        let turn = DQuat::from_axis_angle(dice.direction(), dice.range(0.0, 6.0));
        let scale = DVec3::splat(dice.range(0.12, 0.35));
        let mut material = textured(&mut dice, i % 4);
        material.metallic = if i % 4 == 0 { 1.0 } else { 0.0 };
        material.hue_offset_deg = i as f32 * 40.0;
        let place = DAffine3::from_scale_rotation_translation(scale, turn, place);
        let object = add(&mut list, shapes[i % 3].clone(), place, material);
        list.objects[object].smooth = i % 3 != 2;
    }
    let wall = DAffine3::from_translation(world(DVec3::new(0.0, 0.0, -14.0)))
        * DAffine3::from_scale(DVec3::splat(15.0));
    let material = Material { uv_repeat: [12.0; 2], ..textured(&mut dice, 0) };
    let wall = add(&mut list, meshes::square(), wall, material);
    list.objects[wall].casts_shadow = false;

    list.lights.sky_lux = [0.5, 0.55, 0.65];
    list.lights.ground_lux = [0.25, 0.2, 0.15];
    list.lights.sun =
        Some(Sun { direction_to_sun: [0.45, 0.6, 0.66], color_lux: [4.2, 4.0, 3.6], shadow: true });
    list.lights.points = (0..7)
        .map(|i| {
            let f = f64::from(i);
            PointLight {
                position: world(DVec3::new(-3.0 + f, 0.4 + 0.35 * f, -4.5 - (f * 2.3) % 8.0))
                    .as_vec3()
                    .to_array(),
                range_m: 5.0,
                color_cd: [[3.0, 1.5, 0.5], [0.5, 1.5, 3.0], [1.0, 3.0, 1.0], [2.5, 2.5, 2.0]]
                    [i as usize % 4],
                radius_m: 0.05,
            }
        })
        .collect();
    list
}
