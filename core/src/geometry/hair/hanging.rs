//! Which hair moves by its own weight, and along which lines.
//!
//! The chains of [`crate::geometry::tress`] lie along locks without waves, spread over the head as
//! the style's locks are.

use glam::Vec3;

use super::Grower;
use super::gathered::{braid_line, ponytail};
use super::scalp::{COLUMNS, Root};
use super::strand::Path;
use super::style::{self, Flow, Length, Locks, Tail};
use crate::geometry::body::RestBody;
use crate::geometry::garment::step;
use crate::geometry::tress::{CHAINS, LINKS, Tresses};
use crate::library::mesh::SkinVertex;
use crate::scene::HairStyle;

/// Columns of the scalp's grid between which hair hangs from temple round the back to temple.
pub(super) const FIRST: usize = 11;
/// Local height below which hair hangs: behind the ears, and beside the face; and that of a tail.
const HANGS_Y: [f32; 2] = [0.735, 0.69];
const TAIL_HANGS_Y: f32 = 0.765;
/// How far hair that hangs from an adult's head reaches from where neck and head meet, at most,
/// metres: half a head, and the length of the longest of locks with its way over the shoulders.
const REACH_M: f64 = 0.22;

impl Grower<'_> {
    /// What moves the style's hanging hair, if it has some.
    pub(super) fn hang(&self, body: &RestBody) -> Option<Tresses> {
        let lines: Vec<Path> = match (self.form.tail, &self.form.locks) {
            (Tail::Ponytail, _) => vec![ponytail(self)],
            (Tail::Braids, _) => [1.0, -1.0].map(|side| braid_line(self, side)).into(),
            (_, Some(locks)) if self.form.sheet_y.is_some() => self.fall(locks),
            _ => return None,
        };
        let chains: Vec<_> = lines.iter().filter_map(|line| self.chain(line)).collect();
        let frame = &self.head.scalp.frame;
        let head = |p: Vec3| frame.world(p);
        // Curls hold their shape.
        let yields = if self.style == HairStyle::Curly { 0.3 } else { 1.0 };
        (!chains.is_empty()).then(|| Tresses::new(&chains, body, (&head, frame.scale), yields))
    }

    /// What moves a lock that has such points.
    pub(super) fn moves(&self, lock: &[Vec3]) -> impl Fn(Vec3) -> SkinVertex {
        let hung = self.tresses.as_ref().map(|tresses| (tresses, tresses.column(lock)));
        move |p| match hung {
            Some((tresses, column)) => tresses.weights(column, p),
            None => self.head.on_head(),
        }
    }

    /// Lines of locks that fall from temple round the back to temple.
    fn fall(&self, locks: &Locks) -> Vec<Path> {
        let Length::Down(end_y, spread) = locks.length else { return Vec::new() };
        let straight = Locks { curl: None, clings: 0.5, ..*locks };
        let worn = self.worn();
        let flow = |l: Vec3, root: &Root| style::direction(Flow::Fall, l, root, &worn, self.tie());
        let comb = self.comb(&straight, &flow);
        let s = self.scale();
        let line = |k: usize| {
            let wide = (COLUMNS - 2 * FIRST) as f32;
            let column = FIRST as f32 + wide * k as f32 / (CHAINS - 1) as f32;
            let root = self.head.scalp.at(10.5, column);
            let start = (self.cap_m(&root), 0.014 * s);
            comb.line(&root, start, |_, l| l.y < end_y - spread, |_| locks.clear_m.1 * s)
        };
        (0..CHAINS).map(line).collect()
    }

    /// Points along what of a line hangs; nothing if none does.
    fn chain(&self, line: &Path) -> Option<[Vec3; LINKS + 1]> {
        let frame = &self.head.scalp.frame;
        let local = |p: &Vec3| frame.local(*p);
        let ahead = step(0.02, 0.06, local(line.points.first()?).z);
        let high = match self.form.tail {
            Tail::Ponytail => TAIL_HANGS_Y,
            _ => HANGS_Y[0] + (HANGS_Y[1] - HANGS_Y[0]) * ahead,
        };
        let hung = &line.points[line.points.iter().position(|p| local(p).y < high)?..];
        // Each lower than the one before, for heights tell where on it a place is.
        let lengths: Vec<f32> = hung.windows(2).map(|w| (w[1] - w[0]).length()).collect();
        let total: f32 = lengths.iter().sum();
        if total < 0.02 * frame.scale {
            return None;
        }
        let at = |link: usize| {
            let mut left = total * link as f32 / LINKS as f32;
            for (w, length) in hung.windows(2).zip(&lengths) {
                if left <= *length {
                    return w[0].lerp(w[1], left / length.max(1e-6));
                }
                left -= length;
            }
            hung[hung.len() - 1]
        };
        Some(std::array::from_fn(at))
    }
}

/// How far hair of a style may hang from where neck and head meet on an adult, wherever down is,
/// metres; nothing if it keeps to the head.
pub(in crate::geometry) fn reach_m(style: HairStyle) -> Option<f64> {
    let form = style::form(style)?;
    let low_y = match (form.tail, form.locks?.length) {
        (Tail::Ponytail | Tail::Braids, _) => 0.40,
        (Tail::None, Length::Down(y, spread)) => y - spread,
        _ => return None,
    };
    Some(REACH_M + 1.3 * f64::from(HANGS_Y[0] - low_y))
}
