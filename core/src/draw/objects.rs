//! Walls, floors and occluders.

use glam::{DAffine3, DVec3};

use super::frustum::Sphere;
use super::{DrawError, Drawing, Relevance, abi, rows};
use crate::base::math::affine;
use crate::geometry::shape::{Detail, shape_mesh};
use crate::scene::{Object, Placement, Role};

/// Adds the scene's objects that show or cast a visible shadow.
pub fn add(drawing: &mut Drawing) -> Result<(), DrawError> {
    let scene = drawing.scene;
    for object in &scene.objects {
        let drawn_as = add_one(drawing, object)?;
        drawing.drawn.objects.push(drawn_as);
    }
    Ok(())
}

/// Adds an object; gives its index in the draw list, if it matters to the picture.
pub fn add_one(drawing: &mut Drawing, object: &Object) -> Result<Option<u32>, DrawError> {
    let view_from_model = drawing.view_from_world * world_from_model(&object.placement);
    let scale = object.placement.scale.abs().max_element();
    let hull = corners(&view_from_model);
    let relevance = drawing.relevance(&hull);
    if !relevance.any() {
        return Ok(None);
    }
    drawing.note_near_side(&hull, relevance);
    let view_from_model_at_end = drawing
        .motion
        .as_ref()
        .filter(|motion| motion.camera_moves)
        .map(|motion| motion.view_from_world * world_from_model(&object.placement));
    if let Some(at_end) = &view_from_model_at_end {
        let ends = corners(at_end);
        drawing.note_motion(&hull, relevance, ways(&hull, &ends));
    }
    let mesh = shape_mesh(object.shape, detail(drawing, &hull, scale, relevance));
    let material = if drawing.options.shading && relevance.in_view {
        let list = &mut drawing.drawn.list;
        drawing.surfaces.of_object(&object.material, drawing.library, list)?
    } else {
        drawing.surfaces.plain(&mut drawing.drawn.list)
    };
    let list = &mut drawing.drawn.list;
    let index = list.objects.len() as u32;
    list.draws.push(abi::Draw {
        object: index,
        triangles: 0..mesh.triangles.len() as u32,
        material,
        double_sided: false,
        cutout: None,
    });
    list.objects.push(abi::DrawObject {
        mesh,
        view_from_model: rows(&view_from_model),
        palette: 0..0,
        end: view_from_model_at_end.map(|m| abi::End { view_from_model: rows(&m), palette: 0..0 }),
        in_view: relevance.in_view,
        // What stands behind everything shades nothing; leaving it out keeps the map tight.
        casts_shadow: relevance.casts_shadow && object.role == Role::Occluder,
        smooth: object.shape.is_smooth(),
        blockers: 0..0,
    });
    Ok(Some(index))
}

/// The corners of the unit cube, which holds every shape.
fn corners(view_from_model: &DAffine3) -> [Sphere; 8] {
    let side = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { -0.5 } else { 0.5 };
    std::array::from_fn(|k| Sphere {
        center: view_from_model.transform_point3(DVec3::new(side(k, 0), side(k, 1), side(k, 2))),
        radius_m: 0.0,
    })
}

/// Between the middles of spheres.
fn ways(from: &[Sphere], to: &[Sphere]) -> impl Iterator<Item = (DVec3, DVec3)> {
    from.iter().zip(to).map(|(from, to)| (from.center, to.center))
}

/// The coarsest detail whose circles leave their polygons by less than the wanted error.
fn detail(drawing: &Drawing, hull: &[Sphere], scale: f64, relevance: Relevance) -> Detail {
    if !relevance.in_view {
        return Detail::Low;
    }
    let px_per_m = drawing.px_per_m(hull);
    let error_px = |d: &Detail| d.chord_error() * scale * px_per_m;
    let fine_enough = |d: &&Detail| error_px(d) <= drawing.options.lod_error_px;
    Detail::ALL.iter().rev().find(fine_enough).copied().unwrap_or(Detail::High)
}

/// `translate * rotate * scale`.
pub fn world_from_model(placement: &Placement) -> DAffine3 {
    affine(placement.position_m, placement.rotation, placement.scale)
}
