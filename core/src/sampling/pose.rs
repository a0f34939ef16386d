//! What a person does, and on what.

use super::background::asset;
use super::linked::Draw;
use super::people::Source;
use super::value::{color, flag, item, number};
use super::{Activity, Catalogue, keys, quantile};
use crate::document::{self, Auto, Choice, Normal};
use crate::library::pose::Wear;
use crate::library::pose::angle::Angle;
use crate::scene::{HandShape, Material, OuterKind, Outfit, Pose, PoseBlend, Seat};

/// No variation strays farther, in standard deviations.
const FARTHEST: f64 = 2.5;
/// Lanes between the angles of the trunk, of the left and of the right.
const PLACE_LANES: usize = 64;
/// How many poses are drawn for clothes that they may not suit.
const TRIES: u16 = 32;

/// What somebody in some clothes does, and what that takes to sit on, of this finish.
pub(super) fn pose(
    people: &document::People,
    outfit: &Outfit,
    catalogue: &Catalogue,
    source: Source,
    finish: [f64; 3],
) -> (Pose, Option<Seat>) {
    let (pose, here) = (&people.pose, source);
    let source = source.random_if(pose.enabled);
    let tries = if pose.suits_clothes { TRIES } else { 1 };
    let clip = source.of(keys::CLIP);
    let mut drawn = (0..tries).map(|i| activity(&pose.clip, catalogue, clip, i));
    let suits = |name: &&Activity| name.unsuited.iter().all(|wear| !is_worn(*wear, outfit));
    let first = drawn.next().unwrap_or(&NOTHING);
    let name = if suits(&first) { first } else { drawn.find(suits).unwrap_or(first) };
    let share = number(&pose.blend.share, source.of(keys::BLEND_SHARE));
    let second = &pose.blend.clip;
    let blend = (share > 0.0).then(|| PoseBlend {
        clip: activity(second, catalogue, source.of(keys::BLEND_CLIP), 0).id.clone(),
        phase: number(&pose.blend.phase, source.of(keys::BLEND_PHASE)),
        share,
    });
    let gaze = source.of(keys::GAZE);
    let seat =
        (name.seated && people.seats.enabled).then(|| seat(&people.seats, catalogue, here, finish));
    let pose = Pose {
        phase: number(&pose.phase, source.of(keys::PHASE)),
        mirrored: flag(&pose.mirrored, source.of(keys::MIRRORED)),
        activity: done(name, blend.as_ref(), catalogue).to_owned(),
        variation_deg: variation(number(&pose.variation, source.of(keys::POSE_VARIATION)), source),
        gaze_deg: [0, 1].map(|i| number(&pose.gaze_deg[usize::from(i)], gaze.lane(i))),
        hands: hands(&pose.hands, name, catalogue, source),
        clip: name.id.clone(),
        blend,
    };
    (pose, seat)
}

/// Something to sit on, of no certain size.
fn seat(
    seats: &document::Seats,
    catalogue: &Catalogue,
    source: Source,
    [roughness, metallic, normal_strength]: [f64; 3],
) -> Seat {
    Seat {
        shape: *item(&seats.shape, source.of(keys::SEAT_SHAPE)),
        material: Material {
            texture: asset(&seats.texture, &catalogue.textures, source.of(keys::SEAT_TEXTURE)),
            base_color: color(&seats.color, source.of(keys::SEAT_COLOR)),
            hue_offset_deg: number(&seats.hue_offset_deg, source.of(keys::SEAT_HUE)),
            uv_repeat: [1.0; 2],
            roughness,
            metallic,
            normal_strength,
        },
    }
}

/// Whether an outfit has such clothes.
fn is_worn(wear: Wear, outfit: &Outfit) -> bool {
    match wear {
        Wear::Skirt => outfit.bottom.kind.is_skirt(),
        Wear::Jacket => outfit.outer.kind == OuterKind::Jacket,
        Wear::Coat => outfit.outer.kind == OuterKind::Coat,
    }
}

static NOTHING: Activity =
    Activity { id: String::new(), activity: String::new(), seated: false, unsuited: Vec::new() };

/// The clip or pose that a choice falls on, when it is drawn again for the n-th time. The catalogue
/// holds what the choice names.
fn activity<'a>(
    choice: &Choice<String>,
    catalogue: &'a Catalogue,
    draw: Draw,
    again: u16,
) -> &'a Activity {
    let draws = [2 * again, 2 * again + 1].map(|lane| draw.lane(lane));
    let (clips, poses) = (&catalogue.clips, &catalogue.poses);
    let one_of = |n: usize| (draws[1].uniform() * n as f64) as usize;
    let found = match item(choice, draws[0]).as_str() {
        "any_clip" => clips.get(one_of(clips.len())),
        "any_pose" => poses.get(one_of(poses.len())),
        "any" => clips.iter().chain(poses).nth(one_of(clips.len() + poses.len())),
        id => clips.iter().chain(poses).find(|a| a.id == id),
    };
    found.unwrap_or(&NOTHING)
}

/// The activity of whichever has the greater share.
fn done<'a>(first: &'a Activity, blend: Option<&PoseBlend>, catalogue: &'a Catalogue) -> &'a str {
    let second = blend
        .filter(|b| b.share > 0.5)
        .and_then(|b| catalogue.clips.iter().chain(&catalogue.poses).find(|a| a.id == b.clip));
    &second.unwrap_or(first).activity
}

/// Angles by name, degrees; none where there is no variation.
fn variation(amount: f64, source: Source) -> Vec<(String, f64)> {
    if amount == 0.0 {
        return Vec::new();
    }
    let angle = |angle: Angle| {
        let (place, index) = angle.place();
        let draw = source.of(keys::POSE_ANGLE).lane((place * PLACE_LANES + index) as u16);
        let std = amount * angle.reach().spread_deg;
        let (min, max) = (Some(-FARTHEST * std), Some(FARTHEST * std));
        let law = Normal { mean: 0.0, std, min, max };
        (angle.name(), quantile::truncated_normal(draw.uniform(), &law))
    };
    Angle::all().map(angle).collect()
}

/// What the left and the right hand do; nothing where the pose knows best.
fn hands(
    hands: &Auto<Choice<HandShape>>,
    name: &Activity,
    catalogue: &Catalogue,
    source: Source,
) -> Option<[HandShape; 2]> {
    let draws = [0, 1].map(|side| source.of(keys::HANDS).lane(side));
    match hands {
        Auto::Given(choice) => Some(draws.map(|draw| *item(choice, draw))),
        Auto::Auto(_) if catalogue.clips.iter().all(|c| c.id != name.id) => None,
        Auto::Auto(_) => {
            let usual = Choice::of(usual_hands(&name.activity));
            Some(draws.map(|draw| *item(&usual, draw)))
        }
    }
}

/// Weights of what hands do in a clip, our own choice.
fn usual_hands(activity: &str) -> Vec<(HandShape, f64)> {
    use HandShape::{Fist, Flat, Grip, Relaxed, Spread};
    match activity {
        "punching" => vec![(Fist, 1.0)],
        "kicking" => vec![(Fist, 0.7), (Relaxed, 0.3)],
        "running" => vec![(Relaxed, 0.5), (Grip, 0.25), (Fist, 0.25)],
        "tumbling" | "crawling" | "getting_up" => vec![(Flat, 0.6), (Spread, 0.2), (Relaxed, 0.2)],
        "dancing" => vec![(Relaxed, 0.6), (Flat, 0.2), (Spread, 0.2)],
        _ => vec![(Relaxed, 0.85), (Grip, 0.08), (Flat, 0.07)],
    }
}
