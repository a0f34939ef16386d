//! Persons: shaped, posed and placed, at the level of detail their distance asks for.
//!
//! A person's few always-needed vertices (joints, keypoints, contact points) are evaluated first;
//! whoever neither shows nor casts a visible shadow is never dressed.

use std::ops::Range;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use rayon::prelude::*;

use super::frustum::Sphere;
use super::motion::Motion;
use super::objects::{self, world_from_model};
use super::{DrawError, Drawing, DrawnPerson, Relevance, abi, blockers, rows};
use crate::geometry::body::RestBody;
use crate::geometry::person::{Dressed, MeshKey, hair_reach_m};
use crate::geometry::points;
use crate::geometry::pose::PosedSkeleton;
use crate::geometry::seat::seat_block;
use crate::geometry::skeleton::{JOINT_COUNT, Limb, Side, trunk};
use crate::geometry::stance::Stance;
use crate::geometry::surface::surface;
use crate::geometry::sway;
use crate::library::Library;
use crate::library::figure::LOD_COUNT;
use crate::library::pose::PREFIX;
use crate::scene::{Object, OuterKind, Outfit, Person, Placement, Pose, PoseBlend, Role};

/// How much of a limb's thickness may lie in front of a keypoint before it counts as hidden: limbs
/// are seen at a slant, and clothes stand off.
const LIMB_SLACK: f64 = 1.6;
/// Cloth and hair in front of the skin, metres at scale 1.
const COVER_M: f64 = 0.025;
/// A skirt's or a coat's cloth in front of hips and knees, likewise.
const SKIRT_M: f64 = 0.08;

/// A person whose bones are settled.
struct Posed<'a> {
    person: &'a Person,
    key: MeshKey,
    body: Arc<RestBody>,
    skeleton: PosedSkeleton,
    view_from_model: DAffine3,
    scale: f64,
    /// No vertex leaves the hull of these.
    hull: Vec<Sphere>,
    /// When the shutter closes, where that is otherwise.
    end: Option<AtEnd>,
}

/// A person when the shutter closes.
struct AtEnd {
    skeleton: PosedSkeleton,
    /// View space of that time.
    view_from_model: DAffine3,
}

/// Adds the scene's people: keypoints of all, meshes of those that matter to the picture.
pub fn add(drawing: &mut Drawing) -> Result<(), DrawError> {
    let posed: Vec<Posed> = {
        let drawing = &*drawing;
        let people = drawing.scene.people.par_iter();
        people.map(|person| pose_one(person, drawing)).collect::<Result<_, _>>()?
    };
    let (library, cast) = (drawing.library, drawing.cast);
    let relevances: Vec<Relevance> = posed.iter().map(|p| relevance(drawing, p)).collect();
    let dressed: Vec<Option<Arc<Dressed>>> = {
        let drawing = &*drawing;
        let dress = |(p, r): (&Posed, &Relevance)| {
            let lod = level_of_detail(drawing, p, *r);
            r.any()
                .then(|| cast.dressed(&library.figure, p.key, p.person, &p.body, lod))
                .transpose()
        };
        posed.par_iter().zip(&relevances).map(dress).collect::<Result<_, _>>()?
    };
    for (index, ((posed, relevance), dressed)) in
        posed.iter().zip(&relevances).zip(dressed).enumerate()
    {
        let mut drawn = describe(index, posed);
        drawing.note_near_side(&posed.hull, *relevance);
        if let Some(end) = &posed.end {
            drawing.note_motion(&posed.hull, *relevance, ways(posed, end));
        }
        if let Some(dressed) = dressed {
            let blockers = add_blockers(drawing, posed, *relevance, &drawn);
            drawn.object = Some(add_mesh(drawing, posed, *relevance, &dressed, blockers)?);
        }
        drawn.seat = add_seat(drawing, posed)?;
        drawing.drawn.people.push(drawn);
    }
    Ok(())
}

fn pose_one<'a>(person: &'a Person, drawing: &Drawing<'a>) -> Result<Posed<'a>, DrawError> {
    let library = drawing.library;
    let key = MeshKey::new(person);
    let body = drawing.cast.body(&library.figure, key, person)?;
    let skeleton = stand(&person.pose, library, &body)?;
    let world_from_model = world_from_model(&person.placement);
    let view_from_model = drawing.view_from_world * world_from_model;
    let motion = drawing.motion.as_ref();
    let end = motion.map(|m| at_end(person, library, &body, &skeleton, m)).transpose()?.flatten();
    let scale = person.placement.scale.abs().max_element();
    let of_joint = |j: usize| (skeleton.joint_m(j, body.heads_m[j]), body.reach_m[j]);
    let hanging =
        [hanging_hair(&skeleton, &body, person), hanging_cloth(&skeleton, &body, &person.outfit)];
    let in_view = |(center_m, radius_m): (DVec3, f64)| Sphere {
        center: view_from_model.transform_point3(center_m),
        radius_m: radius_m * scale,
    };
    Ok(Posed {
        hull: (0..JOINT_COUNT)
            .map(of_joint)
            .chain(hanging.into_iter().flatten())
            .map(in_view)
            .collect(),
        person,
        key,
        body,
        skeleton,
        view_from_model,
        scale,
        end,
    })
}

/// A body in a pose, on the ground.
fn stand(pose: &Pose, library: &Library, body: &RestBody) -> Result<PosedSkeleton, DrawError> {
    let (mut skeleton, rests) = skeleton(pose, library, &body.heads_m)?;
    body.trunk.push_arms_out(&body.heads_m, &mut skeleton);
    let contacts = body.ground.iter().map(|p| (p.rest_m, p.skin));
    if rests {
        skeleton.settle(&body.heads_m, contacts.clone());
    }
    skeleton.ground(contacts);
    Ok(skeleton)
}

/// Somebody when the shutter closes; nothing where neither they nor the camera move.
fn at_end(
    person: &Person,
    library: &Library,
    body: &RestBody,
    now: &PosedSkeleton,
    motion: &Motion,
) -> Result<Option<AtEnd>, DrawError> {
    let view_from_model = motion.view_from_world * world_from_model(&person.placement);
    let skeleton = match motion.pose_at_end(&person.pose, library)? {
        Some(pose) => stand(&pose, library, body)?,
        None if motion.camera_moves => now.clone(),
        None => return Ok(None),
    };
    Ok(Some(AtEnd { skeleton, view_from_model }))
}

/// Where joints are, and where they are when the shutter closes, each in its view space.
fn ways(posed: &Posed, end: &AtEnd) -> impl Iterator<Item = (DVec3, DVec3)> {
    posed.body.heads_m.iter().enumerate().map(|(joint, head_m)| {
        let now = posed.view_from_model.transform_point3(posed.skeleton.joint_m(joint, *head_m));
        (now, end.view_from_model.transform_point3(end.skeleton.joint_m(joint, *head_m)))
    })
}

/// Where a pose takes a person's joints, and whether the body then rests on the ground; the height
/// is not settled yet.
fn skeleton(
    pose: &Pose,
    library: &Library,
    heads_m: &[DVec3; JOINT_COUNT],
) -> Result<(PosedSkeleton, bool), DrawError> {
    let is_plain =
        pose.blend.is_none() && pose.variation_deg.is_empty() && pose.gaze_deg == [0.0; 2];
    if is_plain && !pose.clip.starts_with(PREFIX) {
        let frame = library.clips.get(&pose.clip)?.sample(pose.phase);
        let hands = pose.hands.unwrap_or_default();
        return Ok((PosedSkeleton::of_clip(heads_m, &frame, hands, pose.mirrored), false));
    }
    let stance = |id: &str, phase: f64| -> Result<Stance, DrawError> {
        if id.starts_with(PREFIX) {
            return Ok(Stance::of_pose(library.poses.get(id)?));
        }
        Ok(Stance::of_clip(&library.clips.get(id)?.sample(phase)))
    };
    let mut all = stance(&pose.clip, pose.phase)?;
    if let Some(PoseBlend { clip, phase, share }) = &pose.blend {
        all = all.blended(&stance(clip, *phase)?, *share);
    }
    let mut all = all.varied(&pose.variation_deg).looking(pose.gaze_deg);
    all.hands = pose.hands.unwrap_or(all.hands);
    let all = if pose.mirrored { all.mirrored() } else { all };
    Ok((PosedSkeleton::of_stance(heads_m, &all), all.rests))
}

/// Centre and radius of a sphere, model space, beyond which no hair hangs, wherever down is.
fn hanging_hair(
    skeleton: &PosedSkeleton,
    body: &RestBody,
    person: &Person,
) -> Option<(DVec3, f64)> {
    let reach_m = hair_reach_m(person.look.hair)? * body.head_scale * f64::from(body.shape.scale);
    Some((skeleton.joint_m(trunk::HEAD, body.heads_m[trunk::HEAD]), reach_m))
}

/// How much farther than other clothes a skirt's hem may stand off the leg.
fn skirt_reach_m(outfit: &Outfit) -> f64 {
    let skirt = if outfit.bottom.kind.is_skirt() { 0.08 + 0.35 * outfit.bottom.flare } else { 0.0 };
    let coat = if outfit.outer.kind == OuterKind::Coat { 0.15 } else { 0.0 };
    skirt + coat
}

/// Centre and radius of a sphere, model space, beyond which no skirt and no coat hangs, wherever down
/// is: no longer than the legs, from the hips. Nothing where none is worn.
fn hanging_cloth(
    skeleton: &PosedSkeleton,
    body: &RestBody,
    outfit: &Outfit,
) -> Option<(DVec3, f64)> {
    let reach_m = skirt_reach_m(outfit);
    let head_m = |joint: usize| body.heads_m[joint];
    let leg_m = head_m(trunk::HIPS).distance(head_m(Side::Left.joint(Limb::Foot)));
    let hips_m = skeleton.joint_m(trunk::HIPS, head_m(trunk::HIPS));
    (reach_m > 0.0).then_some((hips_m, leg_m + reach_m))
}

fn relevance(drawing: &Drawing, posed: &Posed) -> Relevance {
    if !drawing.options.raster {
        return Relevance { in_view: false, casts_shadow: false };
    }
    drawing.relevance(&posed.hull)
}

/// The coarsest level whose error stays below the wanted one at the person's nearest point; who
/// only casts a shadow gets the coarsest of all.
fn level_of_detail(drawing: &Drawing, posed: &Posed, relevance: Relevance) -> usize {
    let figure = &drawing.library.figure;
    if !relevance.in_view {
        return LOD_COUNT - 1;
    }
    let px_per_m = drawing.px_per_m(&posed.hull) * posed.scale;
    let error_px = |lod: usize| f64::from(figure.lod_error_m(lod)) * px_per_m;
    (0..LOD_COUNT).rev().find(|&l| error_px(l) <= drawing.options.lod_error_px).unwrap_or(0)
}

fn add_mesh(
    drawing: &mut Drawing,
    posed: &Posed,
    relevance: Relevance,
    dressed: &Dressed,
    blockers: Range<u32>,
) -> Result<u32, DrawError> {
    let px_per_m = drawing.px_per_m(&posed.hull) * posed.scale;
    let list = &mut drawing.drawn.list;
    let index = list.objects.len() as u32;
    for part in &dressed.parts {
        let material = if drawing.options.shading && relevance.in_view {
            let surface = surface(part.kind, posed.person);
            drawing.surfaces.of_person(&surface, px_per_m, drawing.library, list)?
        } else {
            drawing.surfaces.plain(list)
        };
        list.draws.push(abi::Draw {
            object: index,
            triangles: part.triangles.clone(),
            material,
            double_sided: part.double_sided,
            cutout: part.cutout,
        });
    }
    let first = list.palette.len() as u32;
    let now = joints(posed, &posed.skeleton, dressed);
    list.palette.extend(now.map(|m| rows(&(posed.view_from_model * m))));
    let palette = first..list.palette.len() as u32;
    let end = posed.end.as_ref().map(|end| {
        let joints = joints(posed, &end.skeleton, dressed);
        list.palette.extend(joints.map(|m| rows(&(end.view_from_model * m))));
        let view_from_model = rows(&end.view_from_model);
        abi::End { view_from_model, palette: palette.end..list.palette.len() as u32 }
    });
    list.objects.push(abi::DrawObject {
        mesh: Arc::clone(&dressed.mesh),
        view_from_model: rows(&posed.view_from_model),
        palette,
        end,
        in_view: relevance.in_view,
        casts_shadow: relevance.casts_shadow,
        smooth: true,
        blockers,
    });
    Ok(index)
}

/// Where a pose takes all joints that move somebody's mesh: the skeleton's and those of what hangs.
fn joints<'a>(
    posed: &Posed,
    skeleton: &PosedSkeleton,
    dressed: &'a Dressed,
) -> impl Iterator<Item = DAffine3> + use<'a> {
    let body = &*posed.body;
    // Weight pulls down in the world.
    let down = posed.person.placement.rotation.inverse() * DVec3::NEG_Y;
    let cloth = sway::joints(skeleton, &body.heads_m);
    let hair = dressed.tresses.as_ref().map(|t| t.joints(skeleton, body, down));
    let skirt = dressed.hang.as_ref().map(|hang| {
        let seat = posed.person.seat.as_ref().and_then(|_| seat_block(skeleton, body));
        hang.joints(skeleton, (body, &cloth), (down, seat.as_ref()))
    });
    let hanging = hair.into_iter().chain(skirt).flatten();
    skeleton.model_from_rest.into_iter().chain(cloth).chain(hanging)
}

/// Adds what somebody sits on, where that may be seen.
fn add_seat(drawing: &mut Drawing, posed: &Posed) -> Result<Option<u32>, DrawError> {
    let Some(seat) = posed.person.seat.as_ref().filter(|_| drawing.options.raster) else {
        return Ok(None);
    };
    let Some(block) = seat_block(&posed.skeleton, &posed.body) else { return Ok(None) };
    let person = &posed.person.placement;
    let placement = Placement {
        position_m: world_from_model(person).transform_point3(block.middle_m),
        rotation: person.rotation * block.rotation,
        scale: block.size_m * posed.scale,
    };
    let (shape, material) = (seat.shape, seat.material.clone());
    objects::add_one(drawing, &Object { role: Role::Occluder, shape, placement, material })
}

/// Adds what keeps surrounding light off places near somebody.
fn add_blockers(
    drawing: &mut Drawing,
    posed: &Posed,
    relevance: Relevance,
    drawn: &DrawnPerson,
) -> Range<u32> {
    let wanted = drawing.options.shading && drawing.scene.lights.environment.ambient_occlusion;
    if !wanted || !relevance.in_view {
        return 0..0;
    }
    let (body, skeleton) = (&posed.body, &posed.skeleton);
    let toe = |side: Side| {
        let joint = side.joint(Limb::ToeBase);
        posed.view_from_model.transform_point3(skeleton.joint_m(joint, body.heads_m[joint]))
    };
    let figure = blockers::Figure {
        keypoints: &drawn.keypoints_in_view,
        radii_m: std::array::from_fn(|k| body.keypoints[k].radius_m * posed.scale),
        toes: Side::BOTH.map(toe),
        px_per_m: drawing.px_per_m(&posed.hull),
        stature_m: body.stature_m * posed.scale,
    };
    blockers::add(&mut drawing.drawn.list.blockers, &figure)
}

/// What is known of a person without being drawn.
fn describe(index: usize, posed: &Posed) -> DrawnPerson {
    let bones = &posed.skeleton.model_from_rest;
    let regressors = &posed.body.keypoints;
    let in_view = |k: usize| {
        let vertices = regressors[k].points.iter().zip(&regressors[k].weights);
        let p_in_model =
            points::pose_point(bones, vertices.map(|(p, &weight)| (p.rest_m, p.skin, weight)));
        posed.view_from_model.transform_point3(p_in_model)
    };
    // Skirts stand off the legs that they show the form of.
    let legs_m = if skirt_reach_m(&posed.person.outfit) > 0.0 { SKIRT_M } else { 0.0 };
    let cover_m = |k: usize| COVER_M + if (11..=14).contains(&k) { legs_m } else { 0.0 };
    DrawnPerson {
        person: index,
        instance: posed.person.slot as u16 + 1,
        object: None,
        seat: None,
        keypoints_in_view: std::array::from_fn(in_view),
        keypoint_tolerance_m: std::array::from_fn(|k| {
            (regressors[k].radius_m * LIMB_SLACK + cover_m(k)) * posed.scale
        }),
        mass_kg: posed.body.mass_kg,
    }
}
