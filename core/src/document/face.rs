//! What faces express and where eyes look.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Choice, Param};

/// Expression and gaze. They last as long as the face does: for one frame, or for an identity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Expression {
    /// Where false, faces are blank and eyes look straight ahead.
    pub enabled: bool,
    /// Which.
    pub kind: Choice<ExpressionKind>,
    /// 0 not at all .. 1 in full.
    pub strength: Param,
    /// Turn of the eyes to the person's left, -25..25.
    pub gaze_yaw_deg: Param,
    /// Turn of the eyes upwards, -20..20.
    pub gaze_pitch_deg: Param,
}

impl Default for Expression {
    fn default() -> Self {
        use ExpressionKind as K;
        Self {
            enabled: true,
            kind: Choice::of([
                (K::Neutral, 0.42),
                (K::Smile, 0.22),
                (K::Grin, 0.07),
                (K::Laugh, 0.03),
                (K::Talk, 0.1),
                (K::Squint, 0.05),
                (K::Surprise, 0.02),
                (K::Sad, 0.03),
                (K::Angry, 0.03),
                (K::Pucker, 0.01),
                (K::Blink, 0.02),
            ]),
            strength: Param::uniform(0.35, 0.9),
            gaze_yaw_deg: Param::normal(0.0, 8.0, -25.0, 25.0),
            gaze_pitch_deg: Param::normal(-2.0, 5.0, -20.0, 20.0),
        }
    }
}

/// What a face expresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ExpressionKind {
    /// Nothing.
    Neutral,
    /// With closed lips.
    Smile,
    /// A smile that shows teeth.
    Grin,
    /// With an open mouth.
    Laugh,
    /// In the middle of a word.
    Talk,
    /// Against the light.
    Squint,
    /// Wide eyes and raised brows.
    Surprise,
    /// Corners of the mouth down, brows up inside.
    Sad,
    /// Lowered brows, pressed lips.
    Angry,
    /// As for a kiss.
    Pucker,
    /// Eyes closed.
    Blink,
}
