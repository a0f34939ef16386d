//! Labels drawn on a picture, from the very values that files are written from.
//!
//! Each instance has its own colour for box and mask. Limbs show which side is which: the person's
//! left is blue, the right orange, the middle white. A keypoint is filled where it is visible and
//! hollow where it is hidden; limbs with a hidden end are thin. Line widths follow the picture's
//! size, so that 640 pixels and 4,000 look alike.

use std::collections::BTreeSet;

use clap::ValueEnum;
use figurant_core::label::annotation::{
    Annotations, KEYPOINT_NAMES, Keypoint, PersonLabel, SKELETON,
};
use figurant_core::plan::Output;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform,
};

/// Something to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Overlay {
    /// Masks as translucent colours with a contour.
    Instance,
    /// Boxes.
    Box2d,
    /// Keypoints and limbs.
    Keypoints,
}

impl Overlay {
    /// The output that it shows.
    #[must_use]
    pub const fn needs(self) -> Output {
        match self {
            Self::Instance => Output::Instance,
            Self::Box2d => Output::Box2d,
            Self::Keypoints => Output::Keypoints,
        }
    }
}

/// A picture that cannot be drawn on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the picture has {bytes} bytes, expected {width} x {height} x 3")]
pub struct WrongSize {
    bytes: usize,
    width: u32,
    height: u32,
}

pub(crate) type Rgb = [u8; 3];

const DARK: Rgb = [16, 16, 20];
const LEFT: Rgb = [64, 160, 255];
const RIGHT: Rgb = [255, 140, 40];
const MIDDLE: Rgb = [245, 245, 245];

/// Draws labels on a picture of 8-bit RGB, row by row.
///
/// # Errors
/// When the picture's length is not that of the labels' size.
pub fn draw(
    rgb: &mut [u8],
    labels: &Annotations,
    what: &BTreeSet<Overlay>,
) -> Result<(), WrongSize> {
    let (width, height) = (labels.width, labels.height);
    let wrong = WrongSize { bytes: rgb.len(), width, height };
    if what.is_empty() {
        return Ok(());
    }
    if rgb.len() as u64 != u64::from(width) * u64::from(height) * 3 {
        return Err(wrong);
    }
    if what.contains(&Overlay::Instance) {
        draw_masks(rgb, labels);
    }
    let pixmap = Pixmap::new(width, height).ok_or(wrong)?;
    // Twice as large a picture gets twice as wide lines.
    let scale = (width.min(height) as f32 / 640.0).max(1.0);
    let mut canvas = Canvas { pixmap, scale };
    canvas.load(rgb);
    if what.contains(&Overlay::Box2d) {
        labels.people.iter().for_each(|p| canvas.person_box(p));
    }
    if what.contains(&Overlay::Keypoints) {
        labels.people.iter().for_each(|p| canvas.skeleton(p));
    }
    canvas.store(rgb);
    Ok(())
}

/// The colour of an instance: neighbours in number are far apart in hue.
pub(crate) fn instance_color(instance: u16) -> Rgb {
    // Multiples of the golden ratio's fraction never come close to each other for long.
    let hue = (f32::from(instance) * 0.618_034).fract() * 6.0;
    let channel = |shift: f32| {
        let distance = ((hue + shift).rem_euclid(6.0) - 3.0).abs();
        let full = (distance - 1.0).clamp(0.0, 1.0);
        (255.0 * (0.25 + 0.75 * full)) as u8
    };
    [channel(0.0), channel(4.0), channel(2.0)]
}

/// Exact pixels: each one of a mask is tinted, those at its edge are painted.
fn draw_masks(rgb: &mut [u8], labels: &Annotations) {
    let Some(ids) = &labels.instance_ids else { return };
    let (width, height) = (labels.width as usize, labels.height as usize);
    for (i, (pixel, &id)) in rgb.chunks_exact_mut(3).zip(ids).enumerate() {
        if id == 0 {
            continue;
        }
        let (x, y) = (i % width, i / width);
        let inside = x > 0
            && y > 0
            && x + 1 < width
            && y + 1 < height
            && [i - 1, i + 1, i - width, i + width].iter().all(|&n| ids[n] == id);
        let share = if inside { 100 } else { 230 };
        for (channel, color) in pixel.iter_mut().zip(instance_color(id)) {
            let mixed = u32::from(*channel) * (256 - share) + u32::from(color) * share;
            *channel = (mixed / 256) as u8;
        }
    }
}

struct Canvas {
    pixmap: Pixmap,
    /// Width of a line of nominal width 1, pixels.
    scale: f32,
}

impl Canvas {
    fn load(&mut self, rgb: &[u8]) {
        for (to, from) in self.pixmap.data_mut().chunks_exact_mut(4).zip(rgb.chunks_exact(3)) {
            to.copy_from_slice(&[from[0], from[1], from[2], 255]);
        }
    }

    fn store(&self, rgb: &mut [u8]) {
        for (to, from) in rgb.chunks_exact_mut(3).zip(self.pixmap.data().chunks_exact(4)) {
            to.copy_from_slice(&from[..3]);
        }
    }

    fn stroke(&mut self, path: &Path, width: f32, color: Rgb) {
        let stroke = Stroke {
            width: width * self.scale,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        self.pixmap.stroke_path(path, &paint(color), &stroke, Transform::identity(), None);
    }

    /// A line with a dark one under it, to be seen on any ground.
    fn outlined(&mut self, path: &Path, width: f32, color: Rgb) {
        self.stroke(path, width + 1.6, DARK);
        self.stroke(path, width, color);
    }

    fn person_box(&mut self, person: &PersonLabel) {
        let Some([x, y, w, h]) = person.bbox else { return };
        let rect = Rect::from_xywh(x as f32, y as f32, w as f32, h as f32);
        if let Some(rect) = rect {
            self.outlined(&PathBuilder::from_rect(rect), 1.4, instance_color(person.instance));
        }
    }

    fn skeleton(&mut self, person: &PersonLabel) {
        let Some(points) = &person.keypoints else { return };
        let size = nominal_size(points) / self.scale;
        for [a, b] in SKELETON {
            let (p, q) = (&points[a], &points[b]);
            if p.coco_visibility() == 0 || q.coco_visibility() == 0 {
                continue;
            }
            let seen = p.coco_visibility() == 2 && q.coco_visibility() == 2;
            let mut line = PathBuilder::new();
            let ([px, py], [qx, qy]) = (at(p), at(q));
            line.move_to(px, py);
            line.line_to(qx, qy);
            if let Some(path) = line.finish() {
                self.outlined(&path, if seen { 2.0 } else { 0.8 } * size, limb_color(a, b));
            }
        }
        for (k, point) in points.iter().enumerate().filter(|(_, p)| p.coco_visibility() > 0) {
            self.dot(point, 2.6 * size, side_color(k));
        }
    }

    fn dot(&mut self, point: &Keypoint, radius: f32, color: Rgb) {
        let [x, y] = at(point);
        let Some(circle) = PathBuilder::from_circle(x, y, radius * self.scale) else { return };
        if point.coco_visibility() == 2 {
            self.stroke(&circle, 1.6, DARK);
            let transform = Transform::identity();
            self.pixmap.fill_path(&circle, &paint(color), FillRule::Winding, transform, None);
        } else {
            self.stroke(&circle, 2.2, DARK);
            self.stroke(&circle, 1.1, color);
        }
    }
}

fn paint(color: Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    let [r, g, b] = color;
    paint.set_color(Color::from_rgba8(r, g, b, 255));
    paint.anti_alias = true;
    paint
}

fn at(point: &Keypoint) -> [f32; 2] {
    point.image_px.map(|v| v as f32)
}

/// 1 for somebody who fills a good part of a picture of 640 pixels, less for who is small.
fn nominal_size(points: &[Keypoint]) -> f32 {
    let ys = points.iter().filter(|p| p.coco_visibility() > 0).map(|p| at(p)[1]);
    let (low, high) = ys.fold((f32::MAX, f32::MIN), |(low, high), y| (low.min(y), high.max(y)));
    ((high - low) / 160.0).clamp(0.45, 1.5)
}

pub(crate) fn side_color(keypoint: usize) -> Rgb {
    match KEYPOINT_NAMES[keypoint].split_once('_') {
        Some(("left", _)) => LEFT,
        Some(("right", _)) => RIGHT,
        _ => MIDDLE,
    }
}

/// The side of a limb; from the nose to an eye it is the eye's.
pub(crate) fn limb_color(a: usize, b: usize) -> Rgb {
    match (side_color(a), side_color(b)) {
        (MIDDLE, side) | (side, MIDDLE) => side,
        (one, other) if one == other => one,
        _ => MIDDLE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use figurant_core::label::annotation::{CameraLabel, KEYPOINT_COUNT, PersonMeta, Visibility};
    use figurant_core::scene::Sex;

    const SIDE: u32 = 200;
    const GREY: Rgb = [90; 3];

    fn keypoint(x: f64, y: f64, reason: Visibility) -> Keypoint {
        Keypoint { image_px: [x, y], camera_m: [0.0; 3], reason, visible_fraction: None }
    }

    /// Nobody but the nose at 50, 50 and the left eye at 150, 150; a box; a mask of 20 x 20 pixels.
    fn labels(nose: Visibility, eye: Visibility) -> Annotations {
        let mut keypoints = [keypoint(100.0, 10.0, OutOfFrame); KEYPOINT_COUNT];
        keypoints[0] = keypoint(50.5, 50.5, nose);
        keypoints[1] = keypoint(150.5, 150.5, eye);
        let mut ids = vec![0; (SIDE * SIDE) as usize];
        for y in 120..140 {
            for x in 20..40 {
                ids[y * SIDE as usize + x] = 3;
            }
        }
        Annotations {
            frame: 0,
            width: SIDE,
            height: SIDE,
            camera: CameraLabel {
                k: [[0.0; 3]; 3],
                r: [[0.0; 3]; 3],
                t: [0.0; 3],
                distortion_model: None,
                distortion: vec![],
            },
            people: vec![PersonLabel {
                instance: 3,
                bbox: Some([10.0, 20.0, 150.0, 160.0]),
                mask_area: Some(400),
                keypoints: Some(keypoints),
                meta: PersonMeta {
                    age_years: 30.0,
                    sex: Sex::Male,
                    stature_m: 1.8,
                    bmi_kg_m2: 24.0,
                    mass_kg: None,
                    garments: vec![],
                    identity: None,
                    name: None,
                    activity: String::new(),
                    clip: String::new(),
                    pose: String::new(),
                    phase: 0.0,
                    mirrored: false,
                },
            }],
            instance_ids: Some(ids),
            semantic: None,
        }
    }

    fn drawn(labels: &Annotations, what: &[Overlay]) -> impl Fn(u32, u32) -> Rgb + use<> {
        let mut rgb = vec![90; (SIDE * SIDE * 3) as usize];
        draw(&mut rgb, labels, &what.iter().copied().collect()).unwrap();
        move |x, y| {
            let i = ((y * SIDE + x) * 3) as usize;
            [rgb[i], rgb[i + 1], rgb[i + 2]]
        }
    }

    use Visibility::{OutOfFrame, SelfOccluded, Visible};

    #[test]
    fn nothing_asked_for_is_nothing_drawn() {
        let pixel = drawn(&labels(Visible, Visible), &[]);
        assert!((0..SIDE * SIDE).all(|i| pixel(i % SIDE, i / SIDE) == GREY));
    }

    #[test]
    fn visible_points_are_filled_and_hidden_ones_hollow() {
        let pixel = drawn(&labels(Visible, OutOfFrame), &[Overlay::Keypoints]);
        assert_eq!(pixel(50, 50), MIDDLE);
        assert_eq!(pixel(150, 150), GREY, "what is out of frame is not drawn");
        assert_eq!(pixel(100, 10), GREY);
        let pixel = drawn(&labels(OutOfFrame, SelfOccluded), &[Overlay::Keypoints]);
        let ring: Vec<Rgb> = (148..=153)
            .flat_map(|y| (148..=153).map(move |x| (x, y)))
            .map(|(x, y)| pixel(x, y))
            .collect();
        let is_blue = |c: &&Rgb| c[2] > c[0] + 60;
        assert!(ring.iter().filter(is_blue).count() >= 3, "{ring:?}");
        let middle = pixel(150, 150);
        assert!(middle[2] < LEFT[2] && pixel(50, 50) == GREY, "{middle:?} is not hollow");
    }

    #[test]
    fn limbs_have_the_colour_of_their_side_and_need_both_ends() {
        let pixel = drawn(&labels(Visible, Visible), &[Overlay::Keypoints]);
        assert_eq!(pixel(100, 100), LEFT, "from the nose to the left eye");
        let pixel = drawn(&labels(Visible, OutOfFrame), &[Overlay::Keypoints]);
        assert_eq!(pixel(100, 100), GREY);
        assert_eq!(limb_color(5, 7), LEFT);
        assert_eq!(limb_color(6, 8), RIGHT);
        assert_eq!(limb_color(5, 6), MIDDLE);
    }

    #[test]
    fn boxes_are_lines_with_a_dark_rim() {
        let pixel = drawn(&labels(Visible, Visible), &[Overlay::Box2d]);
        let color = instance_color(3);
        let near = |a: Rgb, b: Rgb| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) < 80);
        for (x, y) in [(10, 100), (160, 100), (80, 20), (80, 180)] {
            let line = [pixel(x, y), pixel(x - 1, y), pixel(x, y - 1)];
            assert!(line.iter().any(|p| near(*p, color)), "{x}, {y}: {line:?}");
        }
        assert_eq!(pixel(80, 100), GREY);
        assert_eq!(pixel(5, 100), GREY);
        let across: Vec<Rgb> = (5..16).map(|x| pixel(x, 100)).collect();
        assert!(across.iter().any(|p| p.iter().all(|c| *c < 70)), "no rim in {across:?}");
    }

    #[test]
    fn masks_are_exact_and_their_edge_stands_out() {
        let pixel = drawn(&labels(Visible, Visible), &[Overlay::Instance]);
        let color = instance_color(3);
        let distance =
            |c: Rgb| c.iter().zip(color).map(|(a, b)| u32::from(a.abs_diff(b))).sum::<u32>();
        for y in 0..SIDE {
            for x in 0..SIDE {
                let inside = (20..40).contains(&x) && (120..140).contains(&y);
                assert_eq!(pixel(x, y) != GREY, inside, "{x}, {y}");
            }
        }
        assert!(distance(pixel(20, 130)) < distance(pixel(30, 130)));
        assert!(distance(pixel(30, 130)) < distance(GREY));
    }

    #[test]
    fn neighbours_have_colours_that_differ() {
        let apart =
            |a: Rgb, b: Rgb| a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(b))).sum::<u32>();
        for i in 1..60 {
            for j in i + 1..i + 4 {
                let (a, b) = (instance_color(i), instance_color(j));
                assert!(apart(a, b) > 90, "{i} {a:?} and {j} {b:?}");
            }
        }
    }

    #[test]
    fn a_picture_of_another_size_is_refused() {
        let mut rgb = vec![0; 10];
        let what = BTreeSet::from([Overlay::Box2d]);
        assert!(draw(&mut rgb, &labels(Visible, Visible), &what).is_err());
    }
}
