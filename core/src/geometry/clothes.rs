//! All of a person's clothes as parts of the mesh.
//!
//! Layers come from [`super::layers`] and [`super::skirt`], edges from [`super::garment`]; here
//! they are cut and collected. Colours are not known here.

use std::ops::Range;

use glam::Vec3;

use super::body::{RestBody, SOLE_M};
use super::cut::{Builder, Rim, Surface, normals_within};
use super::garment::{self, Cuts, DEEP_M, Fields, NOT_WORN, Piece, Place, step};
use super::hang::Hang;
use super::layers::{self, raised};
use super::over_seat;
use super::person::{Evaluated, PartKind, Parts};
use super::refine::Refined;
use super::shell::Shell;
use super::skirt::{self, Level, Skirt};
use super::trunk::Trunk;
use crate::library::figure::{Figure, GroupId};
use crate::library::mesh::SkinVertex;
use crate::scene::{BottomKind, ShoeKind};

/// How far collars, plackets and pockets stand off the cloth that they are sewn to.
const SEWN_M: f32 = 0.0022;
const COLLAR_M: f32 = 0.0045;
const POCKET_M: f32 = 0.006;
/// Thickness of a hood that lies on the back.
const HOOD_M: f32 = 0.034;

/// How far a piece stands off its cloth, and how far it is moved upwards, metres.
type Rise<'a> = &'a dyn Fn(Place) -> [f32; 2];

/// Everything that is worn, as surfaces.
pub(super) struct Worn {
    pub bottom: Option<Vec<Vec3>>,
    pub top: Vec<Vec3>,
    pub skirt: Option<Skirt>,
    pub outer: Option<Vec<Vec3>>,
    pub coat: Option<Skirt>,
    pub feet: layers::Footwear,
    /// What a skirt hangs on.
    pub hang: Option<Hang>,
}

impl Worn {
    /// Lays one garment over the other, from the skin outwards.
    pub fn new(shell: &Shell<'_>, cuts: &Cuts, net: (&Trunk, usize)) -> Self {
        let fields = Fields::new(cuts, shell.places);
        let cut = (cuts, &fields);
        let feet = layers::footwear(shell, cuts);
        let bottom = cuts.wears(Piece::Bottom).then(|| layers::bottom(shell, cut, &feet.shoes));
        let tucked_top = cuts.tucked().then(|| layers::top(shell, cut, None, &[]));
        let skirt = cuts.skirt_y().and_then(|top_y| {
            let cut = skirt::Cut {
                top_y,
                leg_end: cuts.leg_end,
                flare: cuts.flare,
                ease_m: 0.003 + 0.4 * cuts.bottom_m,
                gap_m: None,
            };
            let under = |i: usize| match &tucked_top {
                Some(t) if fields.top[i] > -0.01 => t[i],
                _ if fields.shoes[i] > -0.02 => feet.shoes[i],
                _ => shell.positions[i],
            };
            Skirt::new(shell, &cut, &(0..shell.positions.len()).map(under).collect::<Vec<_>>())
        });
        let over = skirt.as_ref().map_or(&[][..], |s| &s.positions);
        let top = tucked_top.unwrap_or_else(|| layers::top(shell, cut, bottom.as_deref(), over));
        let outer = cuts
            .wears(Piece::Outer)
            .then(|| layers::outer(shell, cut, bottom.as_deref(), &top, over));
        let coat = outer.as_ref().zip(cuts.coat()).and_then(|(outer, (top_y, leg_end))| {
            let cut = skirt::Cut {
                top_y,
                leg_end,
                flare: 0.25,
                ease_m: 0.002,
                gap_m: Some(if cuts.open { 0.055 } else { 0.004 }),
            };
            // Round the coat's own upper part, whatever is under it, and a skirt's rings.
            let mut under: Vec<Vec3> = outer.clone();
            if let Some(s) = &skirt {
                under.truncate(shell.positions.len());
                spread_over(&mut under, shell, &s.positions);
            }
            Skirt::new(shell, &cut, &under)
        });
        let mut all = Self { bottom, top, skirt, outer, coat, feet, hang: None };
        all.hang(shell, cuts, net);
        all
    }

    /// Hangs a skirt and a coat's lower part on one net, that of the longer one, so that neither shows
    /// through the other; where a jacket lies over a skirt, it moves with the body, as that does.
    fn hang(&mut self, shell: &Shell<'_>, cuts: &Cuts, (trunk, first_joint): (&Trunk, usize)) {
        let covered_y =
            cuts.jacket_hem().and_then(|y| Level::find(shell, y)).map(|hem| hem.at(0.0));
        let mut hung: Vec<&mut Skirt> = self.skirt.iter_mut().chain(&mut self.coat).collect();
        let lower = |a: &&Skirt, b: &&Skirt| a.hem_m().total_cmp(&b.hem_m());
        let longest = hung.iter().map(|skirt| &**skirt).min_by(lower);
        let net = longest.map(|skirt| skirt.net(shell, (trunk, covered_y), first_joint));
        if let Some(net) = &net {
            hung.iter_mut().for_each(|skirt| skirt.hang_on(shell, net));
        }
        self.hang = net;
    }

    /// Takes away what of a skirt lies under a top or an outer garment.
    fn hide_skirt(&mut self, shell: &Shell<'_>, cuts: &Cuts) {
        let Some(skirt) = &mut self.skirt else { return };
        let gap_m: f32 = if cuts.open { 0.14 } else { 0.0 };
        let from_hem = |y: f32| Level::find(shell, y + 0.8 * DEEP_M);
        if let Some(hem_y) = cuts.hem_over_skirt().and_then(from_hem) {
            skirt.hide(hem_y, 0.0);
        }
        match (&self.coat, cuts.jacket_hem().and_then(from_hem)) {
            (Some(coat), _) => skirt.hide(Level::flat(coat.hem_m() + DEEP_M), gap_m.max(0.06)),
            (None, Some(end)) => skirt.hide(end, gap_m),
            (None, None) => {}
        }
    }
}

/// Moves the leg's vertices of a layer out to the nearest of a skirt's points, where those are
/// farther from the middle.
fn spread_over(layer: &mut [Vec3], shell: &Shell<'_>, skirt: &[Vec3]) {
    let line = Vec3::new(0.0, 0.0, shell.heads_m[0].z as f32);
    let flat = |p: Vec3| Vec3::new(p.x, 0.0, p.z) - line;
    for (q, at) in layer.iter_mut().zip(shell.places) {
        if at.leg < -0.1 || at.arm > 0.0 {
            continue;
        }
        let out = flat(*q).normalize_or_zero();
        let far = skirt
            .iter()
            .filter(|s| (s.y - q.y).abs() < 0.05 && flat(**s).normalize_or_zero().dot(out) > 0.97)
            .map(|s| flat(*s).length())
            .fold(0.0, f32::max);
        *q += out * (far - flat(*q).length()).max(0.0);
    }
}

/// Adds all clothes to the parts; gives what a skirt hangs on, whose joints are numbered from a first
/// one on.
pub(super) fn add(
    out: &mut Parts,
    figure: &Figure,
    (rest, first_joint): (&RestBody, usize),
    cuts: &Cuts,
    lod: usize,
) -> Option<Hang> {
    let body = Evaluated::new(figure, rest, GroupId::Shell, lod);
    let places = figure.places(GroupId::Shell, body.positions.len() as u32);
    let on = (&body.positions[..], &body.normals[..]);
    let shell = Shell::new(figure, lod, on, places, &rest.heads_m);
    let mut worn = Worn::new(&shell, cuts, (&rest.trunk, first_joint));
    worn.hide_skirt(&shell, cuts);
    let over_seat = over_seat::weights(&shell, body.skin);
    let cutter = Cutter { body: &body, shell: &shell, cuts, lod, over_seat: &over_seat };

    add_bottom(out, &cutter, &worn);
    add_top(out, &cutter, &worn);
    if let Some(outer) = &worn.outer {
        add_outer(out, &cutter, &worn, outer);
    }
    add_feet(out, &cutter, &worn);
    worn.hang
}

fn add_bottom(out: &mut Parts, cutter: &Cutter<'_>, worn: &Worn) {
    if let Some(bottom) = &worn.bottom {
        let range = cutter.cut(&mut out.builder, Piece::Bottom, bottom, cutter.rim()).triangles;
        out.add(PartKind::Bottom, range, true);
    }
    if let Some(skirt) = worn.skirt.as_ref().filter(|_| !cutter.cuts.bottom.is_dress()) {
        let range = skirt.add(&mut out.builder, cutter.rim());
        out.add(PartKind::Bottom, range, true);
    }
}

fn add_top(out: &mut Parts, cutter: &Cutter<'_>, worn: &Worn) {
    let start = out.builder.mesh.triangles.len() as u32;
    let builder = &mut out.builder;
    let normals = cutter.cut(builder, Piece::Top, &worn.top, cutter.rim()).normals;
    let (shell, cuts) = (cutter.shell, cutter.cuts);
    if let Some(skirt) = worn.skirt.as_ref().filter(|_| cuts.bottom.is_dress()) {
        skirt.add(builder, cutter.rim());
    }
    if cutter.lod < 4 {
        let sewn: [(Piece, Rise<'_>); 4] = [
            (Piece::Placket, &|_| [SEWN_M, 0.0]),
            (Piece::Pocket, &|at| {
                [POCKET_M * step(-0.01, 0.02, cuts.field(Piece::Pocket, at)), 0.0]
            }),
            (Piece::Collar, &|at| {
                let [off, up] = collar_rise(cuts.neck(at.p));
                if cuts.wears(Piece::Outer) { [0.3 * off, 0.4 * up] } else { [off, up] }
            }),
            (Piece::Hood, &|at| [hood_rise(cuts, at), 0.0]),
        ];
        for (piece, rise) in sewn {
            if cuts.wears(piece) {
                let layer = raised(&worn.top, &normals, shell.places, rise);
                cutter.cut(builder, piece, &layer, cutter.rim());
            }
        }
    }
    out.add(PartKind::Top, start..out.builder.mesh.triangles.len() as u32, true);
}

/// A collar stands up round the neck before it turns down.
fn collar_rise(n: f32) -> [f32; 2] {
    [COLLAR_M, 0.013 * step(0.020, 0.0, n)]
}

/// A roll that is thickest half way down.
fn hood_rise(cuts: &Cuts, at: Place) -> f32 {
    let n = cuts.neck(at.p).max(0.0);
    let width = garment::hood_width(at.p);
    let along = (n / width).min(1.0);
    let bulge = (4.0 * along * (1.0 - along)).max(0.0).sqrt();
    0.004 + HOOD_M * (0.2 + 6.0 * (width - 0.026)).min(1.0) * bulge
}

fn add_outer(out: &mut Parts, cutter: &Cutter<'_>, worn: &Worn, outer: &[Vec3]) {
    let start = out.builder.mesh.triangles.len() as u32;
    let normals = cutter.cut(&mut out.builder, Piece::Outer, outer, cutter.rim()).normals;
    if let Some(coat) = &worn.coat {
        coat.add(&mut out.builder, cutter.rim());
    }
    if cutter.lod < 4 {
        let layer = raised(outer, &normals, cutter.shell.places, |at| {
            let [off, up] = collar_rise(cutter.cuts.outer_neck(at.p));
            [off + 0.002, up]
        });
        cutter.cut(&mut out.builder, Piece::OuterCollar, &layer, cutter.rim());
    }
    out.add(PartKind::Outer, start..out.builder.mesh.triangles.len() as u32, true);
}

fn add_feet(out: &mut Parts, cutter: &Cutter<'_>, worn: &Worn) {
    let (cuts, shell) = (cutter.cuts, cutter.shell);
    if cuts.wears(Piece::Socks) {
        let rim = cutter.rim().map(|rim| Rim { thickness_m: 0.0018, ..rim });
        let range = cutter.cut(&mut out.builder, Piece::Socks, &worn.feet.socks, rim).triangles;
        out.add(PartKind::Socks, range, true);
    }
    if !cuts.wears(Piece::Shoes) {
        return;
    }
    // Shoes and soles meet a little above the ground; sneakers have thick soles.
    let edge_m = match cuts.shoes {
        ShoeKind::Sneakers => SOLE_M + 0.014,
        _ => SOLE_M + 0.006,
    };
    let parts = [
        (PartKind::Shoes, Piece::Shoes, &worn.feet.shoes, 1.0, cutter.rim()),
        (PartKind::Soles, Piece::Sole, &worn.feet.soles, -1.0, None),
    ];
    for (kind, piece, layer, sign, rim) in parts {
        let Extent { mut field, mut triangles } = cutter.extent(piece);
        for (f, p) in field.iter_mut().zip(&worn.feet.shoes).filter(|(f, _)| **f > NOT_WORN) {
            *f = f.min(sign * (p.y - edge_m));
        }
        let corners = |t: &u32| shell.net.triangles[*t as usize];
        triangles.retain(|t| corners(t).iter().any(|&v| field[usize::from(v)] >= 0.0));
        let normals = normals_within(&worn.feet.shoes, shell.net, &triangles);
        let part = Refined::new(&cutter.body.with(layer, &normals), &field, &triangles);
        let range = out.builder.add_cut(&part.surface(), &part.field, rim);
        out.add(kind, range, true);
    }
}

/// Cuts pieces from layers of the shell.
struct Cutter<'a> {
    body: &'a Evaluated<'a>,
    shell: &'a Shell<'a>,
    cuts: &'a Cuts,
    lod: usize,
    /// Joints and weights of what lies over the seat.
    over_seat: &'a [SkinVertex],
}

/// Where on the shell a piece is.
struct Extent {
    /// Metres inside its edge, by vertex; [`NOT_WORN`] at those of triangles that are all outside.
    field: Vec<f32>,
    /// Triangles with a corner that is inside, ascending.
    triangles: Vec<u32>,
}

/// A piece that was added to a mesh.
struct Added {
    triangles: Range<u32>,
    /// Of the shell's vertices that the piece has; +Y elsewhere.
    normals: Vec<Vec3>,
}

impl Cutter<'_> {
    fn rim(&self) -> Option<Rim> {
        let thin = self.cuts.bottom == BottomKind::Leggings;
        let thickness_m = if thin { 0.002 } else { 0.0035 };
        (self.lod < 3).then_some(Rim { thickness_m, round: self.lod < 1 })
    }

    /// How far a place is inside what of a piece may be seen.
    fn field(&self, piece: Piece, at: Place) -> f32 {
        let inside = self.cuts.field(piece, at);
        if inside < 0.0 { inside } else { inside.min(self.cuts.deepest_m(piece, at)) }
    }

    fn extent(&self, piece: Piece) -> Extent {
        let shell = self.shell;
        let near = |at: &Place| match self.cuts.is_off(piece, *at, 0.0) {
            true => NOT_WORN,
            false => self.field(piece, *at),
        };
        let mut field: Vec<f32> = shell.places.iter().map(near).collect();
        let mut triangles = Vec::with_capacity(shell.net.triangles.len());
        // A cut lies between the values on its two sides.
        for (i, t) in shell.net.triangles.iter().enumerate() {
            let v = t.map(usize::from);
            if v.iter().any(|&v| field[v] >= 0.0) {
                triangles.push(i as u32);
                for v in v {
                    if field[v] == NOT_WORN {
                        field[v] = self.field(piece, shell.places[v]);
                    }
                }
            }
        }
        Extent { field, triangles }
    }

    /// The finest level follows the curve of a hem inside the shell's triangles.
    fn cut(&self, builder: &mut Builder, piece: Piece, layer: &[Vec3], rim: Option<Rim>) -> Added {
        let shell = self.shell;
        let Extent { field, triangles } = self.extent(piece);
        let normals = normals_within(layer, shell.net, &triangles);
        let over_seat = matches!(piece, Piece::Bottom | Piece::Top | Piece::Outer);
        let whole = self.body.with(layer, &normals);
        let skin = if over_seat { self.over_seat } else { whole.skin };
        let mut part = Refined::new(&Surface { skin, ..whole }, &field, &triangles);
        if self.lod == 0 {
            part.refine(|a, b| self.field(piece, Place::between(shell.places[a], shell.places[b])));
        }
        Added { triangles: builder.add_cut(&part.surface(), &part.field, rim), normals }
    }
}
