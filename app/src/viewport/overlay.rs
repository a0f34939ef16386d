//! Labels drawn over the picture in the window, from the annotations of the very frame shown.
//!
//! Colours and forms are those of `figurant frame --overlay`; lines keep their width at any zoom.

use eframe::egui::{Color32, CornerRadius, Painter, Pos2, Rect, Stroke, StrokeKind, vec2};
use figurant_core::label::annotation::{KEYPOINT_NAMES, SKELETON};
use figurant_core::label::{Annotations, Keypoint, PersonLabel, Visibility};
use figurant_core::scene::Sex;

use crate::overlay::{instance_color, limb_color, side_color};

const DARK: Color32 = Color32::from_rgba_premultiplied(8, 8, 10, 190);
/// How near the pointer must be to a keypoint to name it, points.
const NEAR: f32 = 7.0;

/// Where the picture lies on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Map {
    /// Points.
    pub rect: Rect,
    /// Pixels of the picture.
    pub size: [u32; 2],
}

impl Map {
    /// A position in the picture, pixels, on the screen.
    #[must_use]
    pub fn screen(&self, [x, y]: [f64; 2]) -> Pos2 {
        let [w, h] = self.size.map(f64::from);
        self.rect.min + vec2((x / w) as f32, (y / h) as f32) * self.rect.size()
    }

    /// A position on the screen in the picture, pixels.
    #[must_use]
    pub fn picture(&self, at: Pos2) -> [f64; 2] {
        let share = (at - self.rect.min) / self.rect.size();
        let [w, h] = self.size.map(f64::from);
        [f64::from(share.x) * w, f64::from(share.y) * h]
    }
}

fn color([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

/// Boxes of all who are visible.
pub fn boxes(painter: &Painter, map: &Map, labels: &Annotations) {
    for person in &labels.people {
        let Some([x, y, w, h]) = person.bbox else { continue };
        let rect = Rect::from_two_pos(map.screen([x, y]), map.screen([x + w, y + h]));
        let line = |width: f32, color| {
            let stroke = Stroke::new(width, color);
            painter.rect_stroke(rect, CornerRadius::ZERO, stroke, StrokeKind::Middle);
        };
        line(3.0, DARK);
        line(1.4, color(instance_color(person.instance)));
    }
}

/// Keypoints and limbs of all who are visible.
pub fn keypoints(painter: &Painter, map: &Map, labels: &Annotations) {
    for points in labels.people.iter().filter_map(|p| p.keypoints.as_ref()) {
        let size = nominal_size(points, map);
        for [a, b] in SKELETON {
            let (p, q) = (&points[a], &points[b]);
            if p.coco_visibility() == 0 || q.coco_visibility() == 0 {
                continue;
            }
            let seen = p.coco_visibility() == 2 && q.coco_visibility() == 2;
            let width = if seen { 1.8 } else { 0.8 } * size;
            let ends = [map.screen(p.image_px), map.screen(q.image_px)];
            painter.line_segment(ends, Stroke::new(width + 1.4, DARK));
            painter.line_segment(ends, Stroke::new(width, color(limb_color(a, b))));
        }
        for (k, point) in points.iter().enumerate().filter(|(_, p)| p.coco_visibility() > 0) {
            let (at, radius) = (map.screen(point.image_px), 2.4 * size);
            let side = color(side_color(k));
            if point.coco_visibility() == 2 {
                painter.circle(at, radius, side, Stroke::new(1.0, DARK));
            } else {
                painter.circle_stroke(at, radius, Stroke::new(2.2, DARK));
                painter.circle_stroke(at, radius, Stroke::new(1.1, side));
            }
        }
    }
}

/// 1 for somebody who fills a good part of the screen, less for who is small.
fn nominal_size(points: &[Keypoint], map: &Map) -> f32 {
    let ys = points.iter().filter(|p| p.coco_visibility() > 0).map(|p| map.screen(p.image_px).y);
    let (low, high) = ys.fold((f32::MAX, f32::MIN), |(low, high), y| (low.min(y), high.max(y)));
    ((high - low) / 160.0).clamp(0.5, 1.6)
}

/// What lies under the pointer: a keypoint if one is near, else the person in the smallest box.
#[must_use]
pub fn under(map: &Map, labels: &Annotations, at: Pos2, with_points: bool) -> Option<String> {
    let point = labels.people.iter().flat_map(|person| {
        let points = person.keypoints.iter().flatten().zip(KEYPOINT_NAMES);
        points.map(move |(point, name)| {
            (map.screen(point.image_px).distance(at), point, name, person)
        })
    });
    let point = point.filter(|(far, point, ..)| *far < NEAR && point.coco_visibility() > 0);
    let point = point.filter(|_| with_points).min_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((_, point, name, person)) = point {
        let reason = why(point.reason);
        return Some(format!("{name} of person {}: {reason}", person.instance));
    }
    let area = |p: &&PersonLabel| p.bbox.map_or(0.0, |[_, _, w, h]| w * h);
    let [x, y] = map.picture(at);
    let holds = |p: &&PersonLabel| {
        p.bbox.is_some_and(|[l, t, w, h]| x >= l && y >= t && x < l + w && y < t + h)
    };
    let person = labels.people.iter().filter(holds);
    person.min_by(|a, b| area(a).total_cmp(&area(b))).map(who)
}

fn who(person: &PersonLabel) -> String {
    let meta = &person.meta;
    let sex = match meta.sex {
        Sex::Female => "woman",
        Sex::Male => "man",
    };
    let name = meta.name.as_deref().map_or_else(String::new, |name| format!(" ({name})"));
    let pixels = person.mask_area.unwrap_or(0);
    format!(
        "person {}{name}: {sex} of {:.0}, {:.2} m; {pixels} pixels",
        person.instance, meta.age_years, meta.stature_m
    )
}

/// Why a keypoint can or cannot be seen, in words.
fn why(reason: Visibility) -> String {
    match reason {
        Visibility::Visible => "visible".to_owned(),
        Visibility::SelfOccluded => "hidden by the own body or clothes".to_owned(),
        Visibility::HiddenByPerson(id) => format!("hidden by person {id}"),
        Visibility::HiddenByObject => "hidden by an object".to_owned(),
        Visibility::OutOfFrame => "outside the picture".to_owned(),
        Visibility::BehindCamera => "behind the camera".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    #[test]
    fn the_map_goes_both_ways() {
        let map = Map {
            rect: Rect::from_min_size(pos2(10.0, 20.0), vec2(300.0, 100.0)),
            size: [600, 200],
        };
        assert_eq!(map.screen([0.0, 0.0]), pos2(10.0, 20.0));
        assert_eq!(map.screen([600.0, 200.0]), pos2(310.0, 120.0));
        assert_eq!(map.picture(pos2(160.0, 70.0)), [300.0, 100.0]);
    }
}
