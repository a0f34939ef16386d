//! Every shader is valid, and says the same of its buffers as the host does, without a device.

use std::mem::offset_of;

use wgpu::naga::front::wgsl;
use wgpu::naga::proc::Layouter;
use wgpu::naga::valid::{ValidationFlags, Validator};
use wgpu::naga::{AddressSpace, Module, StorageAccess, TypeInner};

use super::*;
use crate::draw::abi::{MAX_BLOCKERS, Material, Shutter};
use crate::engine::gpu::abi;
use crate::engine::optics::{MOST_TAPS, MOST_WAY_PX, WAY_PER_PX};

fn modules() -> impl Iterator<Item = (String, Stage, Module)> {
    Stage::ALL.into_iter().flat_map(|stage| {
        Variant::all(stage).map(move |variant| {
            let name = format!("{stage:?} for {variant:?}");
            let source = stage.source(variant, &Sources::default());
            let module = wgsl::parse_str(&source)
                .unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(&source)));
            (name, stage, module)
        })
    })
}

#[test]
fn every_shader_is_valid() {
    for (name, stage, module) in modules() {
        let mut validator = Validator::new(ValidationFlags::all(), CAPABILITIES);
        validator.validate(&module).unwrap_or_else(|e| {
            panic!("{name}: {e:?}");
        });
        let has_entry = module.entry_points.iter().any(|e| e.name == stage.entry());
        assert!(has_entry, "{name} has no function {}", stage.entry());
    }
}

#[test]
fn shaders_use_their_buffers_as_the_table_says() {
    for (name, stage, module) in modules() {
        let table = stage.bindings();
        let mut bound = 0;
        for (_, variable) in module.global_variables.iter() {
            let Some(binding) = variable.binding else { continue };
            let access = table[binding.binding as usize].1;
            let says = match variable.space {
                AddressSpace::Uniform => Uniform,
                AddressSpace::Storage { access } if access.contains(StorageAccess::STORE) => Write,
                _ => Read,
            };
            assert_eq!(says, access, "{name}: {:?}", variable.name);
            bound += 1;
        }
        assert_eq!(bound, table.len(), "{name}");
        // What every WebGPU device has.
        let storage = table.iter().filter(|(_, access)| *access != Uniform).count();
        assert!(storage <= 8, "{name} reads {storage} storage buffers");
    }
}

/// Names, offsets and size of a struct's members as Rust lays them out.
macro_rules! layout {
    ($t:ident { $($field:ident),* $(,)? }) => {
        (
            stringify!($t),
            vec![$((stringify!($field), offset_of!(abi::$t, $field) as u32)),*],
            size_of::<abi::$t>() as u32,
        )
    };
}

#[test]
fn shared_structs_are_laid_out_alike() {
    let (_, _, module) = modules().next().unwrap();
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).unwrap();
    let known = [
        layout!(Frame {
            size,
            light_count,
            zero,
            focal,
            center,
            near_m,
            shadow_map_size,
            has_sun,
            has_shadow,
            up,
            object_count,
            sky,
            shot_noise,
            ground,
            read_variance,
            background,
            grain_key,
            to_sun,
            pad3,
            sun_color,
            pad4,
            sun_axes,
            grade_before,
            grade_after,
            vignette,
            contrast,
            grain,
            tone_curve,
            has_environment,
            environment_unit,
            blocker_count,
            sensor_key,
            focus_m,
            blur_px,
            blur_limit_px,
            blur_halvings,
            bloom_share,
            bloom_spread,
            longest_px,
            way_tile,
            end_from_view,
            environment_from_view,
            environment_levels,
            environment_irradiance,
        }),
        layout!(Target {
            rows,
            near_w,
            width,
            height,
            batch_count,
            tiles,
            first_y,
            band_height,
            first_row,
            row_step_log2,
            vertex_batch_count,
            pad0,
        }),
        layout!(VertexBatch { object, source, count, first, palette, rigid, in_view, casts, end }),
        layout!(TriangleBatch {
            draw,
            object,
            source,
            count,
            vertices,
            order,
            mirrored,
            double_sided,
            cutout,
        }),
        layout!(Vertex { position, normal, uv, way }),
        layout!(ScreenVertex { x, y, depth, pad }),
        layout!(Primitive { x, inverse_area, y, order, depth, flags, corners, draw }),
        layout!(Counters { primitives, large, entries, bad_object, crossing, pad0, pad1, pad2 }),
        layout!(Tile { count, end }),
        layout!(Bounds { low, high, nearest, reaches }),
        layout!(SunView { rows, size, texel_m, depth_per_m, present, pad0, pad1, pad2 }),
        layout!(Surface {
            uv_repeat,
            detail_strength,
            normal_strength,
            base,
            metallic_wrap,
            hue_turn,
            map_first,
            map_info,
            flags,
            own_blockers,
            finish_first,
            finish_info,
            pad,
            layers,
        }),
        layout!(Blocker { center, radius_m }),
        layout!(Light { position, per_range_m2, color_cd, per_radius_m }),
        layout!(Step { larger_first, smaller_first, larger_size, smaller_size, pad0, pad1 }),
        layout!(ObjectSums { count, low, high }),
    ];
    let shared = module.types.iter().filter_map(|(handle, t)| match &t.inner {
        TypeInner::Struct { members, .. } => Some((t.name.as_deref()?, members, handle)),
        _ => None,
    });
    let text = include_str!("../../../../../shaders/shared/abi.wgsl");
    let mut compared = 0;
    for (name, members, handle) in shared.filter(|s| text.contains(&format!("struct {} {{", s.0))) {
        let (_, fields, size) = known
            .iter()
            .find(|k| k.0 == name)
            .unwrap_or_else(|| panic!("{name} has no struct of its name in abi.rs"));
        let says: Vec<(&str, u32)> =
            members.iter().map(|m| (m.name.as_deref().unwrap_or(""), m.offset)).collect();
        assert_eq!(&says, fields, "{name}");
        assert_eq!(layouter[handle].size, *size, "{name}");
        compared += 1;
    }
    assert_eq!(compared, known.len());
}

#[test]
fn shared_constants_are_the_same() {
    let text = include_str!("../../../../../shaders/shared/abi.wgsl");
    for (name, value) in [
        ("DOUBLE_SIDED: u32 = ", abi::DOUBLE_SIDED),
        ("MIRRORED: u32 = ", abi::MIRRORED),
        ("SMOOTH: u32 = ", abi::SMOOTH),
        ("BATCHES_ACROSS: u32 = ", abi::BATCHES_ACROSS),
        ("LARGE_ROOM: u32 = ", abi::LARGE_ROOM),
        ("MAX_LAMPS: u32 = ", abi::MAX_LAMPS),
        ("MAX_BLOCKERS: u32 = ", MAX_BLOCKERS as u32),
        ("TILE_LOG2: u32 = ", abi::TILE.ilog2()),
    ] {
        assert!(text.contains(&format!("const {name}{value}u;")), "{name}");
    }
    let texture = include_str!("../../../../../shaders/shared/texture.wgsl");
    for (name, value) in
        [("MAP_COLOR: u32 = ", abi::MAP_COLOR), ("MAP_PRESENT: u32 = ", abi::MAP_PRESENT)]
    {
        assert!(texture.contains(&format!("const {name}{value}u;")), "{name}");
    }
    let disk = include_str!("../../../../../shaders/shared/disk.wgsl");
    assert!(disk.contains(&format!("const SQUARE: u32 = {}u;", abi::SQUARE)));
    let split = include_str!("../../../../../shaders/split.wgsl");
    assert!(split.contains(&format!("array<array<u32, {}>>", abi::LAYER_WORDS)));
    let streak = include_str!("../../../../../shaders/streak.wgsl");
    assert!(streak.contains(&format!("const MOST_TAPS: f32 = {MOST_TAPS}.0;")));
    assert!(streak.contains(&format!("const STILL_PX: f32 = {:?};", Shutter::STILL_PX)));
    let way = include_str!("../../../../../shaders/shared/way.wgsl");
    assert!(way.contains(&format!("const PER_PX: f32 = {WAY_PER_PX:?};")));
    assert!(way.contains(&format!("const MOST_PX: f32 = {MOST_WAY_PX:?};")));
    assert_eq!(abi::LIGHT_OF_PIXELS, u32::MAX);
    assert!(text.contains("const NOTHING: u32 = 0xffffffffu;"));
    assert_eq!(abi::NOTHING, 0xffff_ffff);
    let material = include_str!("../../../../../shaders/shared/material.wgsl");
    assert!(material.contains(&format!("const GLOSSY: f32 = {};", Material::GLOSSY)));
    let skin = include_str!("../../../../../shaders/skin.wgsl");
    assert!(skin.contains(&format!("const VERTEX_WORDS: u32 = {}u;", abi::VERTEX_WORDS)));
    let header = size_of::<abi::SunView>() / 4;
    assert!(text.contains(&format!("const HEADER: u32 = {header}u;")));
}
