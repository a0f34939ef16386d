//! What the tests of the engine share.

use figurant_core::draw::DrawList;
use figurant_core::draw::abi::Material;
use figurant_core::engine::cpu::{CpuEngine, CpuOptions};
use figurant_core::engine::{Engine, EngineError};
use figurant_core::plan::{Frame, Output, Outputs, PassPlan, SceneFacts, StageTimes};
use glam::{DAffine3, DVec3};

pub fn plan(outputs: &[Output]) -> PassPlan {
    let wanted: Outputs = outputs.iter().copied().collect();
    PassPlan::new(&wanted, SceneFacts::ANY)
}

pub fn try_render(
    list: &DrawList,
    outputs: &[Output],
    options: CpuOptions,
) -> Result<Frame, EngineError> {
    CpuEngine::new(options).render(list, &plan(outputs), &mut StageTimes::default())
}

pub fn render(list: &DrawList, outputs: &[Output]) -> Frame {
    try_render(list, outputs, CpuOptions::default()).unwrap()
}

pub const LABELS: &[Output] = &[Output::Box2d, Output::Instance, Output::Keypoints];

/// A square of side `size` that faces the camera.
pub fn facing_square(size: f64, position: DVec3) -> DAffine3 {
    DAffine3::from_translation(position) * DAffine3::from_scale(DVec3::splat(size * 0.5))
}

pub fn plain(base_color: [f32; 3]) -> Material {
    Material { base_color, roughness: 1.0, ..Material::default() }
}

pub fn pixel(frame: &Frame, x: usize, y: usize) -> [u8; 3] {
    let at = (y * frame.width as usize + x) * 3;
    frame.picture.as_ref().unwrap()[at..at + 3].try_into().unwrap()
}
