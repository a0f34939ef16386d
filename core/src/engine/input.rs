//! What a draw list must fulfil before anything is computed from it: sizes, references, finite
//! numbers. Placed vertices are checked where they are made.

use super::EngineError;
use crate::draw::DrawList;
use crate::draw::abi::{Defocus, Draw, Grade, Material, Shutter};
use crate::library::mesh::Triangle;
use crate::library::texture::Texture;

/// Largest side of a picture or shadow map in pixels.
pub(super) const MAX_SIDE: u32 = 8192;
/// Objects that fit the 16-bit ids.
const MAX_OBJECTS: u64 = 65_534;
/// Largest radius of a point out of focus, pixels.
const MAX_BLUR_PX: u64 = MAX_SIDE as u64;
/// In [`EngineError::NotFinite`]: not an object.
const NO_OBJECT: u32 = u32::MAX;
/// log2 of the largest texture's side.
const MAX_TEXTURE_LOG2: u32 = 13;

/// Refuses draw lists that cannot be drawn.
pub(super) fn check(list: &DrawList) -> Result<(), EngineError> {
    check_sizes(list)?;
    check_view_and_lights(list)?;
    check_objects(list)?;
    for (index, draw) in list.draws.iter().enumerate() {
        check_draw(list, index, draw)?;
    }
    for (index, material) in list.materials.iter().enumerate() {
        check_material(list, index, material)?;
    }
    list.textures.iter().enumerate().try_for_each(|(index, t)| check_texture(index, t))
}

fn at_most(what: &'static str, got: u64, limit: u64) -> Result<(), EngineError> {
    if got <= limit { Ok(()) } else { Err(EngineError::TooLarge { what, got, limit }) }
}

fn invalid(
    what: &'static str,
    index: usize,
    got: u64,
    expected: &'static str,
) -> Result<(), EngineError> {
    Err(EngineError::Invalid { what, index: index as u64, got, expected })
}

/// Lane by lane the larger.
fn largest<T: Ord + Copy, const N: usize>(a: [T; N], b: [T; N]) -> [T; N] {
    std::array::from_fn(|i| a[i].max(b[i]))
}

/// Whether a reference into a list of known length holds.
fn within(what: &'static str, index: usize, got: u64, len: usize) -> Result<(), EngineError> {
    if got < len as u64 { Ok(()) } else { invalid(what, index, got, "an index that exists") }
}

fn finite<'a>(
    object: u32,
    what: &'static str,
    numbers: impl IntoIterator<Item = &'a f32>,
) -> Result<(), EngineError> {
    if numbers.into_iter().all(|v| v.is_finite()) {
        Ok(())
    } else {
        Err(EngineError::NotFinite { object, what })
    }
}

fn check_sizes(list: &DrawList) -> Result<(), EngineError> {
    let view = &list.view;
    at_most("picture width", view.width.into(), MAX_SIDE.into())?;
    at_most("picture height", view.height.into(), MAX_SIDE.into())?;
    at_most("number of objects", list.objects.len() as u64, MAX_OBJECTS)?;
    at_most("shadow map size", list.shadow_map_size.into(), MAX_SIDE.into())?;
    if view.width == 0 || view.height == 0 {
        return invalid("picture size", 0, 0, "at least one pixel");
    }
    let size = [view.width, view.height];
    if list.lens.as_ref().is_some_and(|lens| lens.size_px() != size) {
        return invalid("size of the lens's picture", 0, 0, "the size of the picture");
    }
    if !list.shadow_map_size.is_multiple_of(64) {
        return invalid("shadow map size", 0, list.shadow_map_size.into(), "a multiple of 64");
    }
    if !matches!(list.samples, 1 | 4 | 16) {
        return invalid("samples per pixel", 0, list.samples.into(), "1, 4 or 16");
    }
    Ok(())
}

fn check_grade(grade: &Grade) -> Result<(), EngineError> {
    let color = grade.color.iter().flat_map(|c| {
        c.before.as_flattened().iter().chain(c.after.as_flattened()).chain([&c.contrast])
    });
    let bloom = grade.bloom.iter().flat_map(|b| [&b.share, &b.spread]);
    let others = [&grade.vignette, &grade.grain];
    finite(NO_OBJECT, "a number of the grade", color.chain(bloom).chain(others))
}

fn check_view_and_lights(list: &DrawList) -> Result<(), EngineError> {
    let (view, lights) = (&list.view, &list.lights);
    let numbers = [view.fx, view.fy, view.cx, view.cy, view.near_m, list.exposure];
    finite(NO_OBJECT, "a number of the view", &numbers)?;
    check_grade(&list.grade)?;
    if let Some(Defocus { focus_m, at_infinity_px, largest_px }) = list.defocus {
        let numbers = [focus_m, at_infinity_px, largest_px];
        finite(NO_OBJECT, "a number of the depth of field", &numbers)?;
        at_most("blur of the depth of field", largest_px as u64, MAX_BLUR_PX)?;
    }
    if let Some(Shutter { end_from_view, longest_px }) = &list.shutter {
        let numbers = end_from_view.as_flattened().iter().chain([longest_px]);
        finite(NO_OBJECT, "a number of the shutter", numbers)?;
        at_most("way of what moves", *longest_px as u64, MAX_BLUR_PX)?;
    }
    finite(NO_OBJECT, "a number of the view", view.view_from_world.as_flattened())?;
    if view.fx <= 0.0 || view.fy <= 0.0 || view.near_m <= 0.0 {
        return invalid("focal length and near plane", 0, 0, "positive numbers");
    }
    if let Some(sun) = &lights.sun {
        finite(
            NO_OBJECT,
            "a number of the sun",
            sun.direction_to_sun.iter().chain(&sun.color_lux),
        )?;
    }
    for (index, light) in lights.points.iter().enumerate() {
        let shape = [light.range_m, light.radius_m];
        finite(
            NO_OBJECT,
            "a number of a point light",
            light.position.iter().chain(&light.color_cd).chain(&shape),
        )?;
        if light.range_m <= 0.0 {
            return invalid("range of point light", index, 0, "a positive number");
        }
    }
    let ambient = lights.sky_lux.iter().chain(&lights.ground_lux).chain(&lights.background_nits);
    finite(NO_OBJECT, "a number of the surrounding light", ambient)?;
    if let Some(surroundings) = &lights.surroundings {
        let numbers = surroundings
            .irradiance_lux
            .iter()
            .chain(&surroundings.map_from_view)
            .flatten()
            .chain(std::iter::once(&surroundings.nits_per_unit));
        finite(NO_OBJECT, "a number of the surrounding light", numbers)?;
    }
    Ok(())
}

fn check_objects(list: &DrawList) -> Result<(), EngineError> {
    for (index, object) in list.objects.iter().enumerate() {
        let (mesh, id) = (&object.mesh, index as u32);
        let n = mesh.positions.len();
        let lengths = [mesh.normals.len(), mesh.uvs.len(), mesh.skin.len()];
        if lengths[0] != n || lengths[1] != n || (lengths[2] != n && lengths[2] != 0) {
            return invalid("mesh of object", index, n as u64, "arrays of equal length");
        }
        if mesh.skin.is_empty() {
            finite(id, "view_from_model", object.view_from_model.as_flattened())?;
            continue;
        }
        let palette = object.palette.start as usize..object.palette.end as usize;
        let ends = object.end.as_ref().map(|end| end.palette.clone());
        if ends.is_some_and(|end| {
            end.len() != object.palette.len() || end.end as usize > list.palette.len()
        }) {
            let expected = "a range within the list's palette, as long as that of the object";
            return invalid("palette at the end of object", index, 0, expected);
        }
        let Some(palette) = list.palette.get(palette) else {
            return invalid(
                "palette of object",
                index,
                object.palette.end.into(),
                "a range within the list's palette",
            );
        };
        for m in palette {
            finite(id, "a joint's view_from_model", m.as_flattened())?;
        }
        // Folds of plain values: the compiler turns them into vector instructions.
        let joints = mesh.skin.iter().fold([0; 4], |most, s| largest(most, s.joints));
        let joint = joints.into_iter().max().unwrap_or(0);
        within("joint in the mesh of object", index, joint.into(), palette.len())?;
    }
    Ok(())
}

fn check_draw(list: &DrawList, index: usize, draw: &Draw) -> Result<(), EngineError> {
    within("object of draw", index, draw.object.into(), list.objects.len())?;
    within("material of draw", index, draw.material.into(), list.materials.len())?;
    let mesh = &list.objects[draw.object as usize].mesh;
    let range = draw.triangles.start as usize..draw.triangles.end as usize;
    let Some(triangles) = mesh.triangles.get(range) else {
        return invalid(
            "triangles of draw",
            index,
            draw.triangles.end.into(),
            "a range of its mesh's triangles",
        );
    };
    if Triangle::all_within(triangles, mesh.positions.len()) {
        return Ok(());
    }
    let highest = triangles.iter().fold([0; 3], |most, t| largest(most, t.get()));
    let highest = highest.into_iter().max().unwrap_or(0);
    within("vertex in the mesh of draw", index, highest.into(), mesh.positions.len())
}

fn check_material(list: &DrawList, index: usize, m: &Material) -> Result<(), EngineError> {
    let numbers =
        [m.detail_strength, m.hue_offset_deg, m.roughness, m.metallic, m.normal_strength, m.wrap];
    let all =
        m.base_color.iter().chain(&m.uv_repeat).chain(m.layers.as_flattened()).chain(&numbers);
    finite(NO_OBJECT, "a number of a material", all)?;
    for map in
        [m.albedo_map, m.detail_map, m.normal_map, m.finish_map, m.mask].into_iter().flatten()
    {
        within("texture of material", index, map.into(), list.textures.len())?;
    }
    Ok(())
}

fn check_texture(index: usize, texture: &Texture) -> Result<(), EngineError> {
    at_most("log2 of a texture's size", texture.log2_size.into(), MAX_TEXTURE_LOG2.into())?;
    let texels = Texture::level_offset(texture.log2_size, texture.log2_size) + 1;
    if texture.texels.len() == texels {
        return Ok(());
    }
    invalid("texels of texture", index, texture.texels.len() as u64, "all mip levels down to 1x1")
}
