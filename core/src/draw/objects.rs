//! Walls, floors and occluders.

use glam::{DAffine3, DVec3};

use super::{DrawError, Drawing, abi, rows};
use crate::base::math::affine;
use crate::geometry::shape;
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

fn add_one(drawing: &mut Drawing, object: &Object) -> Result<Option<u32>, DrawError> {
    let mesh = shape::mesh(object.shape);
    let view_from_model = drawing.view_from_world * world_from_model(&object.placement);
    let center = view_from_model.transform_point3(DVec3::from(mesh.center.map(f64::from)));
    let radius_m = f64::from(mesh.radius_m) * object.placement.scale.abs().max_element();
    let relevance = drawing.relevance(center, radius_m);
    if !relevance.any() {
        return Ok(None);
    }
    let material = if drawing.options.shading {
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
    });
    list.objects.push(abi::DrawObject {
        mesh,
        view_from_model: rows(&view_from_model),
        palette: 0..0,
        in_view: relevance.in_view,
        // What stands behind everything shades nothing; leaving it out keeps the map tight.
        casts_shadow: relevance.casts_shadow && object.role == Role::Occluder,
        smooth: object.shape.is_smooth(),
    });
    Ok(Some(index))
}

/// `translate * rotate * scale`.
pub fn world_from_model(placement: &Placement) -> DAffine3 {
    affine(placement.position_m, placement.rotation, placement.scale)
}
