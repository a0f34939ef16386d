//! Whether anything moves while the shutter is open, how far, and where to.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::abi::Shutter;
use super::{DrawError, view_from_world};
use crate::library::Library;
use crate::library::pose::PREFIX;
use crate::scene::{Camera, Pose, PoseBlend};

/// Farthest that anything blurs to either side, share of the picture's height.
const FARTHEST: f64 = 0.05;
/// What moves in a picture's corner goes farther, and fingertips farther than the joints before them.
const MARGIN: f64 = 1.5;

/// What is known of the way from the frame's time to the time when the shutter closes.
pub struct Motion {
    /// Half of the time that it is open, seconds.
    pub half_s: f64,
    /// View space, when it closes, from world.
    pub view_from_world: DAffine3,
    /// Whether the camera moves.
    pub camera_moves: bool,
    end_from_view: DMat3,
    limit_px: f64,
    longest_px: f64,
}

impl Motion {
    /// Of a camera whose shutter is open for some time.
    pub fn new(camera: &Camera) -> Option<Self> {
        let half_s = 0.5 * camera.motion_blur.filter(|m| m.shutter_s > 0.0)?.shutter_s;
        let end = camera.after(half_s);
        let end_from_view = DMat3::from_quat(end.rotation.inverse() * camera.rotation);
        // What is infinitely far goes as far as it does in the middle, and farther in the corners.
        let half_px = DVec2::new(camera.width.into(), camera.height.into()) * 0.5;
        let corner = half_px / camera.focal_px();
        let turn = (end_from_view - DMat3::IDENTITY).to_cols_array();
        let most = turn.into_iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let sky_px = camera.focal_px() * most * (1.0 + corner.length_squared());
        Some(Self {
            half_s,
            view_from_world: view_from_world(&end),
            camera_moves: end.position_m != camera.position_m || end.rotation != camera.rotation,
            end_from_view,
            limit_px: FARTHEST * f64::from(camera.height),
            longest_px: sky_px,
        })
    }

    /// Takes note of how far points go, in view space, before a camera to which a metre there is
    /// so many pixels.
    pub fn note(&mut self, ways: impl Iterator<Item = (DVec3, DVec3)>, px_per_m: f64) {
        let longest_m = ways.fold(0.0_f64, |most, (from, to)| most.max(from.distance(to)));
        self.longest_px = self.longest_px.max(longest_m * px_per_m * MARGIN);
    }

    /// What engines need of it; nothing where all stands still.
    pub fn shutter(&self) -> Option<Shutter> {
        let rows = self.end_from_view.transpose().to_cols_array_2d();
        (self.longest_px > Shutter::STILL_PX).then(|| Shutter {
            end_from_view: rows.map(|row| row.map(|v| v as f32)),
            longest_px: self.longest_px.min(self.limit_px).max(Shutter::STILL_PX) as f32,
        })
    }

    /// The pose that follows when the shutter closes; nothing where it is held.
    pub fn pose_at_end(&self, pose: &Pose, library: &Library) -> Result<Option<Pose>, DrawError> {
        let mut end = pose.clone();
        end.phase = self.phase_at_end(&pose.clip, pose.phase, library)?;
        if let Some(PoseBlend { clip, phase, .. }) = &mut end.blend {
            *phase = self.phase_at_end(clip, *phase, library)?;
        }
        Ok((end != *pose).then_some(end))
    }

    /// Where in a clip one is when the shutter closes: beyond its end at its start, if it starts over.
    fn phase_at_end(&self, id: &str, phase: f64, library: &Library) -> Result<f64, DrawError> {
        if id.starts_with(PREFIX) {
            return Ok(phase);
        }
        let clip = library.clips.get(id)?;
        let end = phase + self.half_s / clip.duration_s();
        Ok(if clip.loops && end > 1.0 { end - libm::floor(end) } else { end.min(1.0) })
    }
}
