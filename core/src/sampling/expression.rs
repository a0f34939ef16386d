//! Expressions and gaze as weights of face units.
//!
//! The units are those of Apple's ARKit blend shapes by name, which the figure library carries; a
//! unit without a side stands for both.

use super::keys;
use super::people::Source;
use super::value::{item, number};
use crate::document::{Expression, ExpressionKind};

/// Degrees that an eye turns at weight 1 of a look unit, measured on the figure.
const EYE_DEG: f64 = 27.0;

/// Weights of the face units of an expression in full.
const fn units(kind: ExpressionKind) -> &'static [(&'static str, f64)] {
    use ExpressionKind as K;
    match kind {
        K::Neutral => &[],
        K::Smile => &[("mouthSmile", 0.65), ("mouthDimple", 0.2), ("cheekSquint", 0.35)],
        K::Grin => &[
            ("mouthSmile", 0.8),
            ("mouthUpperUp", 0.35),
            ("mouthLowerDown", 0.25),
            ("cheekSquint", 0.5),
            ("eyeSquint", 0.3),
            ("jawOpen", 0.08),
        ],
        K::Laugh => &[
            ("mouthSmile", 0.8),
            ("mouthUpperUp", 0.35),
            ("cheekSquint", 0.7),
            ("eyeSquint", 0.5),
            ("browInnerUp", 0.2),
            ("jawOpen", 0.45),
        ],
        K::Talk => &[("jawOpen", 0.24), ("mouthFunnel", 0.25), ("mouthLowerDown", 0.2)],
        K::Squint => &[("eyeSquint", 0.8), ("cheekSquint", 0.4), ("browDown", 0.35)],
        K::Surprise => &[
            ("jawOpen", 0.4),
            ("eyeWide", 0.7),
            ("browInnerUp", 0.7),
            ("browOuterUp", 0.7),
            ("mouthFunnel", 0.2),
        ],
        K::Sad => &[("mouthFrown", 0.6), ("browInnerUp", 0.7), ("mouthShrugLower", 0.3)],
        K::Angry => &[
            ("browDown", 0.8),
            ("noseSneer", 0.35),
            ("mouthPress", 0.5),
            ("eyeSquint", 0.3),
            ("mouthFrown", 0.2),
        ],
        K::Pucker => &[("mouthPucker", 0.7)],
        K::Blink => &[("eyeBlink", 1.0)],
    }
}

/// Units that have no sides.
const MIDDLE: [&str; 9] = [
    "jawOpen",
    "browInnerUp",
    "mouthFunnel",
    "mouthPucker",
    "mouthShrugLower",
    "mouthShrugUpper",
    "mouthRollLower",
    "mouthRollUpper",
    "cheekPuff",
];

/// Names and weights of the face units of a person.
pub(super) fn face_units(expression: &Expression, source: Source) -> Vec<(String, f64)> {
    if !expression.enabled {
        return Vec::new();
    }
    let kind = *item(&expression.kind, source.of(keys::EXPRESSION));
    let strength = number(&expression.strength, source.of(keys::EXPRESSION_STRENGTH));
    // Lids close wholly or not at all.
    let strength = if kind == ExpressionKind::Blink { 1.0 } else { strength };
    let mut face: Vec<(String, f64)> =
        units(kind).iter().flat_map(|(unit, full)| sides(unit, full * strength)).collect();
    let yaw = number(&expression.gaze_yaw_deg, source.of(keys::GAZE_YAW)) / EYE_DEG;
    let pitch = number(&expression.gaze_pitch_deg, source.of(keys::GAZE_PITCH)) / EYE_DEG;
    let (left, right) = if yaw > 0.0 { ("Out", "In") } else { ("In", "Out") };
    face.push((format!("eyeLook{left}Left"), yaw.abs()));
    face.push((format!("eyeLook{right}Right"), yaw.abs()));
    face.extend(sides(if pitch > 0.0 { "eyeLookUp" } else { "eyeLookDown" }, pitch.abs()));
    face
}

fn sides(unit: &str, weight: f64) -> Vec<(String, f64)> {
    if MIDDLE.contains(&unit) {
        vec![(unit.to_owned(), weight)]
    } else {
        ["Left", "Right"].map(|side| (format!("{unit}{side}"), weight)).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Choice;
    use crate::library::figure::Figure;
    use crate::sampling::linked::Draws;

    #[test]
    fn every_unit_is_one_of_the_figure_and_small() {
        use ExpressionKind as K;
        let figure = Figure::built_in().unwrap();
        for kind in [
            K::Neutral,
            K::Smile,
            K::Grin,
            K::Laugh,
            K::Talk,
            K::Squint,
            K::Surprise,
            K::Sad,
            K::Angry,
            K::Pucker,
            K::Blink,
        ] {
            let law = Expression { kind: Choice::Always(kind), ..Expression::default() };
            for frame in 0..20 {
                for (name, weight) in face_units(&law, Source::new(Draws::new(3, frame), 0)) {
                    figure.face_target(&name).unwrap();
                    assert!((0.0..=1.0).contains(&weight), "{kind:?} {name} {weight}");
                }
            }
        }
    }

    #[test]
    fn both_eyes_look_the_same_way() {
        for frame in 0..100 {
            let face = face_units(&Expression::default(), Source::new(Draws::new(4, frame), 0));
            let of = |name: &str| face.iter().find(|f| f.0 == name).map(|f| f.1);
            assert_eq!(of("eyeLookOutLeft"), of("eyeLookInRight"));
            assert_eq!(of("eyeLookInLeft"), of("eyeLookOutRight"));
            assert!(of("eyeLookOutLeft").is_some() != of("eyeLookInLeft").is_some());
        }
    }
}
