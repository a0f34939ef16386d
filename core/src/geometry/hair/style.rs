//! What makes a style: thickness, lengths, and which way hair lies.
//!
//! Lengths in metres on an adult; directions and places in local coordinates (the template's).

use glam::Vec3;

use super::scalp::Root;
use crate::geometry::garment::step;
use crate::scene::HairStyle;

/// Where hair gathered at the back is tied: row and column of the scalp's grid.
pub(super) const TIE_HIGH: (f32, f32) = (8.6, 32.0);

/// The cap of hair under the locks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cap {
    /// On top.
    pub thick_m: f32,
    /// Distance from the hairline at which the thickness is reached.
    pub taper_m: f32,
    /// Share of the thickness at the sides.
    pub side: f32,
    /// Unevenness as a share of the thickness, and its size.
    pub lump: (f32, f32),
    /// How far the hairline wanders inwards, rows of the grid.
    pub ragged: f32,
}

/// How long locks are.
#[derive(Clone, Copy, Debug)]
pub(super) enum Length {
    /// Between two lengths.
    Between(f32, f32),
    /// Down to a local height, and by how much that varies.
    Down(f32, f32),
    /// To where the hair is tied.
    ToTie,
}

impl Length {
    /// Over which length from the end strands end, one here and one there, metres.
    pub fn frayed_m(self) -> f32 {
        match self {
            Self::Between(_, high) => 0.5 * high,
            Self::Down(y, _) => {
                if y > 0.6 {
                    0.035
                } else {
                    0.07
                }
            }
            Self::ToTie => 0.03,
        }
    }
}

/// The locks laid over the cap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Locks {
    /// How many at the finest level.
    pub count: usize,
    pub length: Length,
    pub width_m: f32,
    /// Distance of their ends from the skin, least and most.
    pub clear_m: (f32, f32),
    /// How much farther off those lie that grow higher up.
    pub layer_m: f32,
    /// See [`super::strand::Comb`].
    pub yields: f32,
    pub clings: f32,
    /// Radius and length of a curl.
    pub curl: Option<(f32, f32)>,
    /// Points of the finest ribbons.
    pub points: usize,
    /// They end in several points.
    pub tuft: bool,
    /// Which way they lie.
    pub flow: Flow,
}

/// Which way hair lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flow {
    /// Away from the whorl on the crown, forwards in front.
    Whorl,
    /// Down and a little back.
    Side,
    /// Upwards on top, down at the sides.
    Brush,
    /// Away from a parting, back and down at the sides.
    Parting,
    /// Forwards.
    Fringe,
    /// Off the head in all directions.
    Burst,
    /// Away from a parting and down over the shoulders.
    Fall,
    /// To the tie at the back.
    Back,
    /// Away from the middle to a tie behind each ear.
    Sides,
}

/// What is made of gathered hair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tail {
    None,
    Ponytail,
    Bun,
    Braids,
}

/// A style.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub cap: Cap,
    pub locks: Option<Locks>,
    /// Local height down to which a sheet of hair hangs.
    pub sheet_y: Option<f32>,
    pub tail: Tail,
}

const SMOOTH: Cap =
    Cap { thick_m: 0.010, taper_m: 0.035, side: 0.8, lump: (0.10, 0.03), ragged: 0.7 };

const LOOSE: Locks = Locks {
    count: 760,
    length: Length::Between(0.024, 0.045),
    width_m: 0.0085,
    clear_m: (0.003, 0.010),
    layer_m: 0.010,
    yields: 0.6,
    clings: 0.6,
    curl: None,
    points: 4,
    tuft: true,
    flow: Flow::Whorl,
};

/// The table of styles; nothing for a bald head.
pub(super) fn form(style: HairStyle) -> Option<Form> {
    let none = Form { cap: SMOOTH, locks: None, sheet_y: None, tail: Tail::None };
    let close = Cap { thick_m: 0.0045, taper_m: 0.022, side: 0.8, lump: (0.08, 0.02), ragged: 0.5 };
    Some(match style {
        HairStyle::Bald => return None,
        HairStyle::Cropped => Form {
            cap: Cap { thick_m: 0.0035, taper_m: 0.030, ragged: 1.2, ..close },
            locks: Some(Locks {
                count: 900,
                length: Length::Between(0.005, 0.009),
                width_m: 0.0020,
                clear_m: (0.002, 0.0045),
                layer_m: 0.0,
                clings: 0.2,
                points: 3,
                tuft: false,
                ..LOOSE
            }),
            ..none
        },
        HairStyle::Balding => Form {
            cap: Cap { thick_m: 0.0042, taper_m: 0.020, side: 1.0, ..close },
            locks: Some(Locks {
                count: 620,
                length: Length::Between(0.018, 0.032),
                width_m: 0.0052,
                clear_m: (0.0015, 0.004),
                layer_m: 0.001,
                clings: 0.9,
                flow: Flow::Side,
                ..LOOSE
            }),
            ..none
        },
        HairStyle::CrewCut => Form {
            cap: Cap {
                thick_m: 0.012,
                taper_m: 0.030,
                side: 0.35,
                lump: (0.12, 0.02),
                ragged: 0.7,
            },
            locks: Some(Locks {
                count: 1000,
                length: Length::Between(0.009, 0.015),
                width_m: 0.0032,
                clear_m: (0.002, 0.011),
                layer_m: 0.007,
                clings: 0.0,
                points: 3,
                tuft: false,
                flow: Flow::Brush,
                ..LOOSE
            }),
            ..none
        },
        HairStyle::Short => Form {
            cap: Cap { thick_m: 0.016, taper_m: 0.050, side: 0.5, lump: (0.20, 0.03), ragged: 1.0 },
            locks: Some(LOOSE),
            ..none
        },
        HairStyle::SideParting => Form {
            cap: Cap {
                thick_m: 0.016,
                taper_m: 0.045,
                side: 0.45,
                lump: (0.12, 0.03),
                ragged: 0.8,
            },
            locks: Some(Locks {
                count: 540,
                length: Length::Between(0.04, 0.075),
                clear_m: (0.003, 0.009),
                layer_m: 0.012,
                points: 5,
                flow: Flow::Parting,
                ..LOOSE
            }),
            ..none
        },
        HairStyle::Pixie => Form {
            cap: Cap { thick_m: 0.015, taper_m: 0.045, side: 0.6, lump: (0.15, 0.03), ragged: 0.8 },
            locks: Some(Locks {
                count: 540,
                length: Length::Between(0.030, 0.056),
                clear_m: (0.003, 0.008),
                layer_m: 0.012,
                points: 5,
                flow: Flow::Fringe,
                ..LOOSE
            }),
            ..none
        },
        HairStyle::Afro => Form {
            cap: Cap {
                thick_m: 0.055,
                taper_m: 0.050,
                side: 0.85,
                lump: (0.10, 0.022),
                ragged: 0.8,
            },
            locks: Some(Locks {
                count: 1300,
                length: Length::Between(0.006, 0.012),
                width_m: 0.0062,
                clear_m: (0.0, 0.0),
                layer_m: 0.0,
                yields: 0.6,
                clings: 0.0,
                curl: None,
                points: 3,
                tuft: true,
                flow: Flow::Burst,
            }),
            ..none
        },
        HairStyle::Curly => Form {
            cap: Cap { thick_m: 0.022, taper_m: 0.045, side: 0.8, lump: (0.25, 0.03), ragged: 0.8 },
            locks: Some(Locks {
                count: 430,
                length: Length::Down(0.655, 0.035),
                width_m: 0.0062,
                clear_m: (0.010, 0.030),
                layer_m: 0.012,
                yields: 0.5,
                clings: 0.1,
                curl: Some((0.0095, 0.048)),
                points: 18,
                tuft: false,
                flow: Flow::Fall,
            }),
            sheet_y: Some(0.69),
            ..none
        },
        HairStyle::Bob => Form {
            cap: Cap { thick_m: 0.013, taper_m: 0.030, side: 0.8, lump: (0.06, 0.03), ragged: 0.8 },
            locks: Some(Locks {
                count: 440,
                length: Length::Down(0.655, 0.012),
                width_m: 0.0125,
                clear_m: (0.010, 0.017),
                layer_m: 0.005,
                clings: 0.35,
                points: 10,
                flow: Flow::Fall,
                ..LOOSE
            }),
            sheet_y: Some(0.665),
            ..none
        },
        HairStyle::LongStraight | HairStyle::LongWavy => {
            let wavy = style == HairStyle::LongWavy;
            Form {
                cap: Cap { thick_m: 0.013, taper_m: 0.030, ragged: 1.0, ..SMOOTH },
                locks: Some(Locks {
                    count: if wavy { 370 } else { 480 },
                    length: Length::Down(0.46, 0.05),
                    width_m: if wavy { 0.015 } else { 0.0125 },
                    clear_m: (0.010, 0.017),
                    layer_m: 0.004,
                    clings: 0.3,
                    curl: wavy.then_some((0.007, 0.085)),
                    points: if wavy { 16 } else { 14 },
                    tuft: false,
                    flow: Flow::Fall,
                    ..LOOSE
                }),
                sheet_y: Some(0.50),
                ..none
            }
        }
        HairStyle::Ponytail | HairStyle::Bun => Form {
            cap: Cap { thick_m: 0.007, taper_m: 0.030, ..SMOOTH },
            locks: Some(Locks {
                count: 270,
                length: Length::ToTie,
                width_m: 0.0115,
                clear_m: (0.008, 0.011),
                layer_m: 0.0,
                yields: 0.8,
                clings: 1.0,
                points: 9,
                tuft: false,
                flow: Flow::Back,
                ..LOOSE
            }),
            tail: if style == HairStyle::Bun { Tail::Bun } else { Tail::Ponytail },
            ..none
        },
        HairStyle::Braids => Form {
            cap: Cap { thick_m: 0.007, taper_m: 0.030, ..SMOOTH },
            locks: Some(Locks {
                count: 270,
                length: Length::ToTie,
                width_m: 0.0115,
                clear_m: (0.008, 0.011),
                layer_m: 0.0,
                yields: 0.8,
                clings: 1.0,
                points: 9,
                tuft: false,
                flow: Flow::Sides,
                ..LOOSE
            }),
            tail: Tail::Braids,
            ..none
        },
    })
}

/// Tie behind an ear, local.
pub(super) fn side_tie(side: f32) -> Vec3 {
    Vec3::new(0.060 * side, 0.690, -0.026)
}

/// How somebody wears a style; local coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worn {
    /// Where the parting runs.
    pub part_x: f32,
    /// Of the roots on the left and on the right, those before it have their hair in front of the
    /// shoulder.
    pub front_z: [f32; 2],
}

/// Direction of the hair at a local place for a root; `tie` is the place of the tie to which the
/// root's hair goes.
pub(super) fn direction(flow: Flow, l: Vec3, root: &Root, worn: &Worn, tie: Vec3) -> Vec3 {
    let part_x = worn.part_x;
    let away = if root.local.x > part_x { 1.0 } else { -1.0 };
    let top = step(0.772, 0.806, l.y);
    let front = step(0.03, 0.10, l.z);
    let side = Vec3::new(0.15 * away, -1.0, -0.45);
    match flow {
        Flow::Whorl => {
            let d = l - Vec3::new(-0.008, 0.856, -0.012);
            (d + Vec3::new(0.0, -0.02, 0.03 * front)).normalize_or(Vec3::NEG_Y)
        }
        Flow::Brush => {
            let up = Vec3::new(0.0, 0.9, 0.55);
            let down = Vec3::new(0.0, -1.0, -0.15);
            down.lerp(up, step(0.795, 0.820, l.y))
        }
        Flow::Side => side,
        Flow::Parting => {
            let over = Vec3::new(away, -0.20, 0.10 - 0.55 * front);
            side.lerp(over, top)
        }
        Flow::Fringe => {
            let over = Vec3::new(-0.35 + 2.0 * l.x, -0.35, 1.0);
            let side = Vec3::new(0.0, -1.0, 0.55 * step(-0.04, 0.04, l.z));
            side.lerp(over, step(0.765, 0.80, l.y) * step(-0.06, 0.02, l.z))
        }
        Flow::Burst => l - Vec3::new(0.0, 0.755, 0.03),
        Flow::Fall => {
            let crown = step(0.05, 0.0, l.z);
            let over = Vec3::new(away, -0.30, -0.15 - 0.5 * front - 1.1 * crown);
            let face = step(0.055, 0.09, l.z) * step(0.60, 0.66, l.y);
            let hang = Vec3::new(away * (0.05 + 0.5 * face), -1.0, -0.10 - 0.65 * face);
            let hang = hang.lerp(over, top * (1.0 - step(0.035, 0.070, l.x.abs())));
            // Before the shoulders it gathers in front of them or behind them.
            let low = 1.0 - step(0.62, 0.70, l.y);
            let in_front = root.local.z > worn.front_z[usize::from(root.local.x < 0.0)];
            let goal = if in_front {
                Vec3::new(l.x.abs().clamp(0.055, 0.095) * away, 0.0, 0.075)
            } else {
                Vec3::new(l.x.clamp(-0.085, 0.085), 0.0, -0.085)
            };
            hang + Vec3::new((goal.x - l.x) * 16.0, 0.0, (goal.z - l.z) * 12.0) * low
        }
        Flow::Back => tie - l,
        Flow::Sides => {
            // Over the head first, then behind the ear.
            let ahead = step(-0.02, 0.06, l.z);
            let behind = Vec3::new(0.0, 0.0, -0.05) * step(0.70, 0.76, l.y) * ahead;
            tie - l + behind + Vec3::new(0.05 * away, 0.0, 0.0) * top
        }
    }
}

/// How much hair a balding head has at a local place: all at the sides and the back, none on top.
pub(in crate::geometry) fn wreath(l: Vec3) -> f32 {
    crate::library::figure::wreath(l.to_array())
}
