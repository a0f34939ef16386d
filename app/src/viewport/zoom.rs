//! Where the picture lies on the screen: pan and zoom.

use eframe::egui::{Pos2, Rect, Vec2, pos2, vec2};

/// Smallest and largest zoom, screen pixels to one of the picture.
const RANGE: std::ops::RangeInclusive<f32> = 0.05..=64.0;
/// How much of the picture always stays in view, points.
const KEPT: f32 = 48.0;

/// How the picture is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Zoom {
    /// Whole, as large as it fits.
    #[default]
    Fit,
    /// By a factor.
    Free {
        /// Screen pixels to one of the picture.
        factor: f32,
        /// Point of the picture in the middle of the view, as shares of its width and height.
        center: Vec2,
    },
}

/// A view of the screen that a picture is shown in.
#[derive(Clone, Copy, Debug)]
pub struct Pane {
    /// In points.
    pub rect: Rect,
    /// Of the picture in its own pixels.
    pub size: Vec2,
    /// Screen pixels to a point.
    pub pixels_per_point: f32,
}

impl Zoom {
    /// Screen pixels to one of the picture.
    #[must_use]
    pub fn factor(self, pane: &Pane) -> f32 {
        match self {
            Self::Fit => {
                let fit = pane.rect.size() * pane.pixels_per_point / pane.size;
                fit.min_elem().max(*RANGE.start())
            }
            Self::Free { factor, .. } => factor,
        }
    }

    /// Where the picture lies, points.
    #[must_use]
    pub fn rect(self, pane: &Pane) -> Rect {
        let size = pane.size * self.factor(pane) / pane.pixels_per_point;
        let center = match self {
            Self::Fit => vec2(0.5, 0.5),
            Self::Free { center, .. } => center,
        };
        let min = pane.rect.center() - center * size;
        // On whole screen pixels, so that pixels of the picture have equal sizes.
        let snap = |v: f32| (v * pane.pixels_per_point).round() / pane.pixels_per_point;
        Rect::from_min_size(pos2(snap(min.x), snap(min.y)), size)
    }

    /// By a factor, with the middle of the view where it is.
    pub fn set(&mut self, pane: &Pane, factor: f32) {
        self.zoom_at(pane, pane.rect.center(), factor / self.factor(pane));
    }

    /// Nearer or farther, such that what lies under a point of the screen stays there.
    pub fn zoom_at(&mut self, pane: &Pane, at: Pos2, by: f32) {
        let before = self.rect(pane);
        let factor = (self.factor(pane) * by).clamp(*RANGE.start(), *RANGE.end());
        let under = (at - before.min) / before.size();
        let size = pane.size * factor / pane.pixels_per_point;
        let center = under + (pane.rect.center() - at) / size;
        *self = Self::Free { factor, center };
        self.keep_in_view(pane);
    }

    /// Moves the picture over the screen, points.
    pub fn pan(&mut self, pane: &Pane, by: Vec2) {
        let center = (pane.rect.center() - by - self.rect(pane).min) / self.rect(pane).size();
        *self = Self::Free { factor: self.factor(pane), center };
        self.keep_in_view(pane);
    }

    fn keep_in_view(&mut self, pane: &Pane) {
        if let Self::Free { factor, center } = self {
            let size = pane.size * *factor / pane.pixels_per_point;
            let slack = ((pane.rect.size() * 0.5 - Vec2::splat(KEPT)) / size).max(Vec2::ZERO);
            *center = center.clamp(-slack, Vec2::splat(1.0) + slack);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pane() -> Pane {
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(800.0, 600.0));
        Pane { rect, size: vec2(640.0, 480.0), pixels_per_point: 2.0 }
    }

    #[test]
    fn a_fitted_picture_touches_two_sides() {
        let rect = Zoom::Fit.rect(&pane());
        assert_eq!(rect, pane().rect);
        let wide = Pane { size: vec2(1600.0, 480.0), ..pane() };
        let rect = Zoom::Fit.rect(&wide);
        assert_eq!((rect.left(), rect.width(), rect.height()), (100.0, 800.0, 240.0));
        assert_eq!(rect.center(), wide.rect.center());
    }

    #[test]
    fn at_100_percent_a_pixel_is_a_pixel() {
        let mut zoom = Zoom::Fit;
        zoom.set(&pane(), 1.0);
        assert_eq!(zoom.rect(&pane()).size(), vec2(320.0, 240.0));
        assert_eq!(zoom.rect(&pane()).center(), pane().rect.center());
    }

    #[test]
    fn what_lies_under_the_pointer_stays_there() {
        let at = pos2(321.0, 432.0);
        let mut zoom = Zoom::Fit;
        let under = |zoom: Zoom| (at - zoom.rect(&pane()).min) / zoom.rect(&pane()).size();
        let before = under(zoom);
        for by in [1.5, 3.0, 0.4, 2.0] {
            zoom.zoom_at(&pane(), at, by);
            assert!((under(zoom) - before).length() < 2e-3, "{:?} {before:?}", under(zoom));
        }
    }

    #[test]
    fn a_picture_cannot_be_lost() {
        let mut zoom = Zoom::Fit;
        zoom.pan(&pane(), vec2(1e6, -1e6));
        let seen = zoom.rect(&pane()).intersect(pane().rect);
        assert!(seen.width() >= KEPT - 1.0 && seen.height() >= KEPT - 1.0, "{seen:?}");
    }
}
