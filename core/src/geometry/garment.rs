//! Clothes: where the garment shell is cut, and what skin they hide.
//!
//! Every piece of a garment is a field over the template (metres inside its edge, negative
//! outside), so the same cut fits every body, and skin can be asked whether it lies underneath.
//! How far the pieces stand off is decided in [`super::layers`]; poses and colours are not known
//! here.

use glam::Vec3;

pub(super) use crate::library::figure::Place;
use crate::library::figure::{ARM_M, Figure, LEG_M, LOD_COUNT};
use crate::scene::{BottomKind, OuterKind, Outfit, ShoeKind, TopKind};

/// Upper edge of trousers on the template, metres above its origin.
pub(super) const WAIST_Y: f32 = 0.070;
/// Upper edge of skirts.
const SKIRT_Y: f32 = 0.115;
/// Seam between the bodice and the skirt of a dress.
const DRESS_Y: f32 = 0.150;
/// Where the shell's part of a coat ends and its skirt begins.
const COAT_Y: f32 = 0.120;
/// Lower edge of jackets.
const JACKET_Y: f32 = -0.004;
/// Depth under a garment from which skin is never seen, by level of detail: less where skin and
/// cloth follow each other less closely.
const HIDDEN_M: [f32; LOD_COUNT] = [0.016, 0.016, 0.012, 0.006, 0.002];
/// Cloth that lies deeper than this under another garment is left out: nobody looks so far into an
/// opening, and what is not there cannot show through.
pub(super) const DEEP_M: f32 = 0.045;
/// How far skin under cloth is drawn inwards, by level of detail.
const TUCK_M: [f32; LOD_COUNT] = [0.004, 0.004, 0.006, 0.010, 0.016];
/// So far inside a piece's edge skin is drawn inwards fully.
const TUCKED_M: f32 = 0.010;
/// Farther than this from a piece's edge skin is not drawn inwards.
const COVERS_M: f32 = 0.004;
/// A piece that is not worn.
pub(super) const NOT_WORN: f32 = -1.0;

/// A piece of cloth that is cut from the shell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Piece {
    Bottom,
    Top,
    Outer,
    Shoes,
    /// All of the foot that is above or under a sole.
    Sole,
    Socks,
    /// Turned down round the neck of shirts and polos.
    Collar,
    OuterCollar,
    /// Strip of buttons down the front.
    Placket,
    /// Pouch on the belly of hoodies.
    Pocket,
    /// Hood that lies on the back.
    Hood,
}

/// Cuts of one person's clothes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cuts {
    pub top: TopKind,
    pub bottom: BottomKind,
    pub outer: OuterKind,
    pub shoes: ShoeKind,
    pub sleeve: f32,
    neckline: f32,
    pub top_m: f32,
    /// End of trousers or skirts along the leg.
    pub leg_end: f32,
    pub flare: f32,
    pub bottom_m: f32,
    pub outer_m: f32,
    pub open: bool,
    /// Upper end of the socks along the leg.
    sock_end: f32,
}

impl Cuts {
    pub fn new(outfit: &Outfit) -> Self {
        let (top, bottom, outer) = (&outfit.top, &outfit.bottom, &outfit.outer);
        let (least, most) = match bottom.kind {
            BottomKind::Trousers | BottomKind::Jeans | BottomKind::Leggings => (0.5, 1.0),
            BottomKind::Shorts => (0.18, 0.62),
            _ => (0.22, 0.97),
        };
        let length = (bottom.length as f32).clamp(least, most);
        // Trousers that reach the ankle rest on the shoes.
        let rests = !bottom.kind.is_skirt() && bottom.kind != BottomKind::Leggings;
        let wears_socks = !matches!(outfit.shoes.kind, ShoeKind::Sandals | ShoeKind::Barefoot);
        let socks = if wears_socks { (outfit.shoes.socks as f32).clamp(0.0, 1.0) } else { 0.0 };
        Self {
            top: top.kind,
            bottom: bottom.kind,
            outer: outer.kind,
            shoes: outfit.shoes.kind,
            sleeve: (top.sleeve as f32).clamp(0.12, 0.97),
            neckline: (top.neckline as f32).clamp(0.0, 1.0),
            top_m: (top.looseness_m as f32).clamp(0.0, 0.06),
            leg_end: length + if rests { 0.03 * step(0.9, 1.0, length) } else { 0.0 },
            flare: (bottom.flare as f32).clamp(0.0, 1.0),
            bottom_m: (bottom.looseness_m as f32).clamp(0.0, 0.05),
            outer_m: (outer.looseness_m as f32).clamp(0.0, 0.05),
            open: outer.open,
            sock_end: 1.0 - 0.48 * socks,
        }
    }

    /// Whether the top's hem is under the skirt.
    pub fn tucked(&self) -> bool {
        let wide = matches!(self.top, TopKind::Hoodie | TopKind::Sweater);
        self.bottom.is_dress() || self.bottom.is_skirt() && !wide
    }

    /// Where the skirt of the bottom begins, on the template.
    pub fn skirt_y(&self) -> Option<f32> {
        match self.bottom {
            BottomKind::DressShort | BottomKind::DressLong => Some(DRESS_Y),
            BottomKind::SkirtShort | BottomKind::SkirtLong => Some(SKIRT_Y),
            _ => None,
        }
    }

    /// Where the skirt of a coat begins, on the template, and where it ends along the leg.
    pub fn coat(&self) -> Option<(f32, f32)> {
        (self.outer == OuterKind::Coat).then_some((COAT_Y, 0.42))
    }

    /// Whether a piece is worn at all.
    pub fn wears(&self, piece: Piece) -> bool {
        match piece {
            Piece::Top => true,
            Piece::Bottom => !self.bottom.is_skirt(),
            Piece::Outer | Piece::OuterCollar => self.outer != OuterKind::None,
            Piece::Shoes | Piece::Sole => self.shoes != ShoeKind::Barefoot,
            Piece::Socks => self.sock_end < 1.0 && self.leg_end < 0.93,
            Piece::Collar => matches!(self.top, TopKind::Shirt | TopKind::Polo),
            Piece::Placket => matches!(self.top, TopKind::Shirt | TopKind::Polo),
            Piece::Pocket => self.top == TopKind::Hoodie && !self.bottom.is_dress(),
            Piece::Hood => self.top == TopKind::Hoodie && self.outer == OuterKind::None,
        }
    }

    /// How far a place is inside a piece's edge.
    pub fn field(&self, piece: Piece, at: Place) -> f32 {
        if !self.wears(piece) {
            return NOT_WORN;
        }
        match piece {
            Piece::Top => self.hem(at).min(self.sleeve_end(at)).min(self.neck(at.p)),
            Piece::Bottom => self.waist(at).min(self.cuff(at)).min(at.p.y + 0.775),
            Piece::Outer => self.outer(at),
            Piece::Shoes => self.shoes(at),
            Piece::Sole => low_shoe(at.p),
            Piece::Socks => self.socks(at).min(0.02 - low_shoe(at.p)),
            Piece::Collar => collar(self.neck(at.p), at.p, (0.024, 0.004)),
            Piece::OuterCollar => {
                let edge = self.front_half_m(at.p).max(0.004);
                collar(self.outer_neck(at.p), at.p, (0.026, edge))
            }
            Piece::Placket => self.placket(at),
            Piece::Pocket => pocket(at),
            Piece::Hood => self.hood(at.p),
        }
    }

    /// Whether a place is surely farther from a piece than so many metres: a cheap answer, no where
    /// the piece might be.
    pub fn is_off(&self, piece: Piece, at: Place, by_m: f32) -> bool {
        let Place { p, arm, leg } = at;
        let below = |y: f32| p.y < y - by_m && arm <= 0.02;
        match piece {
            Piece::Top => below(self.hem_y()),
            Piece::Bottom => p.y > WAIST_Y + by_m,
            Piece::Outer => below(JACKET_Y),
            Piece::Shoes => leg < 0.70 - by_m / LEG_M && p.y > -0.70 + by_m,
            Piece::Sole => p.y > -0.72 + by_m,
            Piece::Socks => leg < 0.50 - by_m / LEG_M,
            // A neckline is nowhere lower, and nothing of a collar farther from it than 0.05.
            Piece::Collar | Piece::OuterCollar => p.y < 0.30 - by_m,
            Piece::Placket => p.x.abs() > 0.0145 + by_m || p.z < 0.02 - by_m,
            Piece::Pocket => p.z < 0.04 - by_m || p.y < 0.035 - by_m,
            Piece::Hood => p.y < 0.15 - by_m,
        }
    }

    /// How far a place is from where a piece lies too deep under others to be seen.
    pub fn deepest_m(&self, piece: Piece, at: Place) -> f32 {
        let outer = DEEP_M - self.field(Piece::Outer, at);
        match piece {
            // A close top shows little of the waist under it, even from below.
            Piece::Bottom => outer.min(0.012 + 0.6 * self.top_m - self.field(Piece::Top, at)),
            Piece::Shoes if self.rests() => DEEP_M - self.field(Piece::Bottom, at),
            Piece::Outer | Piece::OuterCollar | Piece::Shoes | Piece::Sole | Piece::Socks => {
                f32::MAX
            }
            _ => outer,
        }
    }

    /// Whether trousers reach the ankle and fall over the shoes.
    pub fn rests(&self) -> bool {
        !self.bottom.is_skirt() && self.bottom != BottomKind::Leggings && self.leg_end > 0.9
    }

    /// Lower edge, on the template, of a top that is worn over a skirt.
    pub fn hem_over_skirt(&self) -> Option<f32> {
        (self.bottom.is_skirt() && !self.tucked()).then(|| self.hem_y())
    }

    /// Whether a place on the skin has underwear: under skirts, which fly up.
    pub fn is_underwear(&self, at: Place) -> bool {
        self.bottom.is_skirt() && at.arm < 0.0 && at.leg < 0.14 && at.p.y < WAIST_Y - 0.01
    }

    /// Lower edge of a jacket, on the template.
    pub fn jacket_hem(&self) -> Option<f32> {
        (self.outer == OuterKind::Jacket).then_some(JACKET_Y)
    }

    /// Whether a place is farther than so many metres from any opening: not to be seen from there is
    /// also what lies under two garments.
    fn is_deep(&self, at: Place, limit_m: f32) -> bool {
        // Top and trousers close each other's opening at the waist; wide ones can be looked into.
        let in_top = (self.hem(at) + 0.03)
            .min(self.sleeve_end(at) - 2.0 * self.top_m)
            .min(self.neck(at.p) - self.top_m);
        if in_top > limit_m {
            return true;
        }
        let depth = if self.wears(Piece::Bottom) {
            let long = self.bottom != BottomKind::Shorts;
            let deep = if long { 2.5 } else { 8.0 } * self.bottom_m;
            let in_bottom = (self.waist(at) + 0.03).min(self.cuff(at) - deep);
            in_bottom.min(at.p.y + 0.775)
        } else {
            let begin = self.skirt_y().unwrap_or(WAIST_Y) - at.p.y - on_arm(at);
            (begin + 0.02).min(self.cuff(at) - 0.22)
        };
        let closed = !matches!(self.shoes, ShoeKind::Sandals | ShoeKind::Barefoot);
        depth > limit_m
            || self.wears(Piece::Socks) && self.socks(at) > limit_m
            || closed && self.shoes(at) > limit_m
    }

    /// How far inside a piece that lies on the skin, the nearest unless one is [`TUCKED_M`] inside.
    fn cover(&self, at: Place) -> f32 {
        let mut depth = NOT_WORN;
        for piece in [Piece::Top, Piece::Bottom, Piece::Shoes, Piece::Socks] {
            if depth < TUCKED_M && !self.is_off(piece, at, COVERS_M) {
                depth = depth.max(self.field(piece, at));
            }
        }
        depth
    }

    /// Lower edge of the top.
    fn hem(&self, at: Place) -> f32 {
        at.p.y - self.hem_y() + on_arm(at)
    }

    fn hem_y(&self) -> f32 {
        if self.tucked() {
            // Under the skirt's edge.
            if self.bottom.is_dress() { DRESS_Y - 0.05 } else { SKIRT_Y - 0.05 }
        } else {
            match self.top {
                TopKind::Shirt => 0.002,
                TopKind::Sweater | TopKind::Hoodie => 0.012,
                _ => 0.016,
            }
        }
    }

    fn sleeve_end(&self, at: Place) -> f32 {
        if self.top != TopKind::TankTop {
            return (self.sleeve - at.arm) * ARM_M;
        }
        // A round opening for the arm, which leans outwards over the shoulder.
        let (x, y) = (at.p.x.abs() - 0.188, at.p.y - 0.470);
        let along = (0.36 * x + 0.93 * y).clamp(0.0, 0.15);
        let (x, y) = (x - 0.36 * along, y - 0.93 * along);
        ((x * x + y * y).sqrt() - 0.070).min((0.03 - at.arm) * ARM_M)
    }

    fn cuff(&self, at: Place) -> f32 {
        (self.leg_end - at.leg) * LEG_M
    }

    fn waist(&self, at: Place) -> f32 {
        WAIST_Y - at.p.y - on_arm(at)
    }

    fn socks(&self, at: Place) -> f32 {
        (at.leg - self.sock_end) * LEG_M
    }

    fn shoes(&self, at: Place) -> f32 {
        match self.shoes {
            ShoeKind::Boots => (at.leg - 0.74) * LEG_M - 0.01 * at.p.z,
            ShoeKind::Sneakers => low_shoe(at.p) + 0.006,
            ShoeKind::Sandals => {
                let toes = 0.013 - (at.p.z - 0.108).abs();
                let instep = 0.010 - (at.p.z - 0.062).abs();
                let heel = (0.009 - (at.p.y + 0.757).abs()).min(0.045 - at.p.z);
                toes.max(instep).max(heel).min(-0.73 - at.p.y)
            }
            _ => low_shoe(at.p),
        }
    }

    fn outer(&self, at: Place) -> f32 {
        let y = if self.outer == OuterKind::Coat { COAT_Y - 0.05 } else { JACKET_Y };
        let hem = at.p.y - y + on_arm(at);
        hem.min((0.985 - at.arm) * ARM_M).min(self.outer_neck(at.p)).min(self.front_gap(at.p))
    }

    /// Half of what the outer garment leaves open in front, as a field.
    pub fn front_gap(&self, p: Vec3) -> f32 {
        p.x.abs() - self.front_half_m(p) + step(0.05, 0.02, p.z)
    }

    fn front_half_m(&self, p: Vec3) -> f32 {
        let lapel = step(0.30, 0.52, p.y);
        if self.open { 0.055 - 0.01 * lapel } else { 0.034 * lapel - 0.01 }
    }

    fn placket(&self, at: Place) -> f32 {
        let end = if self.top == TopKind::Polo { 0.40 } else { -1.0 };
        let strip = (0.0145 - at.p.x.abs()).min(at.p.y - end).min(at.p.z - 0.02);
        strip.min(self.field(Piece::Top, at))
    }

    pub fn outer_neck(&self, p: Vec3) -> f32 {
        neck(0.0, p) - 0.003
    }

    /// About the distance from the top's neckline.
    pub fn neck(&self, p: Vec3) -> f32 {
        neck(self.neckline, p)
    }

    /// Distance from the neck at the back, and how far that is from the hood's edge.
    fn hood(&self, p: Vec3) -> f32 {
        let n = self.neck(p);
        // Long behind, narrow at the collar bones, open in front.
        (n - 0.001).min(hood_width(p) - n).min(p.x.abs() - 0.012 + step(0.02, 0.0, p.z))
    }
}

/// How far a hood reaches from the neckline.
pub(super) fn hood_width(p: Vec3) -> f32 {
    let behind = step(0.03, -0.06, p.z);
    0.026 + 0.115 * behind * step(0.15, 0.06, p.x.abs())
}

/// About the distance from a neckline, a closed curve round the neck that dips in front.
/// Outwards and downwards count alike, so that the cut crosses the skin at a right angle both
/// on the neck's steep sides and on the flat shoulders.
fn neck(t: f32, p: Vec3) -> f32 {
    let (x, z) = (p.x, p.z - 0.020);
    let radius = (x * x + z * z).sqrt();
    let ahead = z / radius.max(1e-4);
    let (side_r, side_y) = (0.066 + 0.020 * t, 0.573 - 0.004 * t);
    let (r, y) = if ahead > 0.0 { (0.070 + 0.042 * t, 0.538 - 0.085 * t) } else { (0.064, 0.556) };
    // Flat at the front and at the back, so that deep necklines are round.
    let across = 1.0 - ahead * ahead;
    let w = 1.0 - across * across;
    let (r, y) = (side_r + (r - side_r) * w, side_y + (y - side_y) * w);
    0.6 * (radius - r) + 0.8 * (y - p.y)
}

/// A leaf round the neck with two points in front, `width` at the back, whose ends lie so far from
/// the middle at the throat. `n` is the distance from the neckline.
fn collar(n: f32, p: Vec3, (width, end): (f32, f32)) -> f32 {
    let front = step(0.03, 0.085, p.z);
    let points = 0.026 * front * step(0.080, 0.040, p.x.abs());
    // The two leaves part further down.
    let apart = p.x.abs() - end - 0.45 * n.max(0.0) + step(0.05, 0.02, p.z);
    n.min(width + points - n).min(apart)
}

/// A pouch with slanted openings.
fn pocket(at: Place) -> f32 {
    let y = at.p.y - 0.035;
    let slanted = 0.125 - at.p.x.abs() - 0.45 * (y - 0.05).max(0.0);
    y.min(0.135 - y).min(slanted).min(at.p.z - 0.04) - on_arm(at)
}

/// Below the ankle.
fn low_shoe(p: Vec3) -> f32 {
    -0.732 - 0.15 * p.z.clamp(-0.05, 0.07) - p.y
}

fn on_arm(at: Place) -> f32 {
    step(0.02, 0.10, at.arm)
}

/// How far the shell's vertices are inside the pieces that others lie over; [`NOT_WORN`] where that is
/// far outside.
pub(super) struct Fields {
    pub top: Vec<f32>,
    pub bottom: Vec<f32>,
    pub shoes: Vec<f32>,
}

impl Fields {
    pub fn new(cuts: &Cuts, places: &[Place]) -> Self {
        // Layers ask no farther from an edge than this.
        const FAR_M: f32 = 0.04;
        let of = |piece: Piece| {
            let field = |at: &Place| match cuts.is_off(piece, *at, FAR_M) {
                true => NOT_WORN,
                false => cuts.field(piece, *at),
            };
            places.iter().map(field).collect()
        };
        Self { top: of(Piece::Top), bottom: of(Piece::Bottom), shoes: of(Piece::Shoes) }
    }
}

/// Which skin vertices can never be seen.
pub(super) fn hidden(figure: &Figure, cuts: &Cuts, places: &[Place], lod: usize) -> Vec<bool> {
    places
        .iter()
        .zip(&figure.data().covered)
        .map(|(at, &covered)| covered != 0 && cuts.is_deep(*at, HIDDEN_M[lod]))
        .collect()
}

/// Draws covered skin near a hem a little inwards where it is wanted, so that it never shows through
/// the cloth.
pub(super) fn tuck(
    figure: &Figure,
    cuts: &Cuts,
    places: &[Place],
    lod: usize,
    (skin, normals): (&mut [Vec3], &[Vec3]),
    wanted: &[bool],
) {
    let covered = figure.data().covered.iter().zip(wanted).map(|(c, wanted)| *c != 0 && *wanted);
    for (((p, n), at), _) in
        skin.iter_mut().zip(normals).zip(places).zip(covered).filter(|(_, covered)| *covered)
    {
        let depth = cuts.cover(*at);
        if depth > -0.002 {
            *p -= *n * (TUCK_M[lod] * step(-0.002, TUCKED_M, depth));
        }
    }
}

/// 0 below a, 1 above b, smooth between; falling where a > b.
pub(super) fn step(a: f32, b: f32, x: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
