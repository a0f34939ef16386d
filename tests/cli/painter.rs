//! A road whose frames are painted.

use std::collections::BTreeSet;
use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;

use figurant::road::{Adapter, Import, Job, LoadError, ParityWish, Road, Simd, Wishes};
use figurant_core::document::cast::Member;
use figurant_core::export::{DatasetInfo, PictureFormat};
use figurant_core::job::parity::Difference;
use figurant_core::job::{FrameMaker, RenderedFrame};
use figurant_core::label::annotation::{
    Annotations, CameraLabel, Keypoint, PersonLabel, PersonMeta, Visibility,
};
use figurant_core::plan::{Output, Outputs, PassPlan, SceneFacts, StageTimes};
use figurant_core::scene::{Camera, Environment, Lights, Post, Scene, Sex};
use glam::{DQuat, DVec3};
use serde_json::{Value, json};

/// Paints frames of one person each, whose mask is a rectangle.
pub struct Painter {
    width: u32,
    height: u32,
    seed: u64,
    fails: Vec<u32>,
}

#[derive(Debug, thiserror::Error)]
pub enum PaintError {
    #[error("frame {0} is out of paint")]
    Paint(u32),
    #[error("there is no brush on this machine")]
    Brush,
}

impl FrameMaker for Painter {
    type Error = PaintError;

    fn make(&mut self, frame: u32) -> Result<RenderedFrame, PaintError> {
        if self.fails.contains(&frame) {
            return Err(PaintError::Paint(frame));
        }
        let (width, height) = (self.width, self.height);
        let camera = Camera {
            width,
            height,
            fov_vertical_deg: 40.0,
            position_m: DVec3::new(0.0, 0.0, 5.0),
            rotation: DQuat::IDENTITY,
            near_m: 0.1,
            motion_blur: None,
            depth_of_field: None,
            distortion: None,
        };
        let inside =
            |i: u32| (i % width) >= width / 4 && (i % width) < width / 2 && i / width >= height / 4;
        let ids: Vec<u16> = (0..width * height).map(|i| if inside(i) { 2 } else { 0 }).collect();
        let color = |i: u32| {
            let v = (u64::from(i % width * 3 + frame * 5) + self.seed) as u8;
            if inside(i) { [220, v, 40] } else { [v, v, 90] }
        };
        let at = [f64::from(width) / 3.0, f64::from(height) / 2.0];
        let reason = Visibility::Visible;
        let (f, c) = (camera.focal_px(), camera.center_px());
        let camera_m = [(at[0] - c.x) / f * 5.0, (at[1] - c.y) / f * 5.0, 5.0];
        let point = Keypoint { image_px: at, camera_m, reason, visible_fraction: None };
        let h = f64::from(height);
        let (x0, x1, y0) = (f64::from(width / 4), f64::from(width / 2), f64::from(height / 4));
        let person = PersonLabel {
            instance: 2,
            bbox: Some([x0, y0, x1 - x0, h - y0]),
            mask_area: Some(ids.iter().filter(|id| **id != 0).count() as u64),
            keypoints: Some([point; 17]),
            meta: PersonMeta {
                age_years: 30.0,
                sex: Sex::Male,
                stature_m: 1.8,
                bmi_kg_m2: 24.0,
                mass_kg: None,
                garments: vec![],
                identity: None,
                name: None,
                activity: "standing".to_owned(),
                clip: "stand".to_owned(),
                pose: String::new(),
                phase: 0.5,
                mirrored: false,
            },
        };
        Ok(RenderedFrame {
            scene: Scene {
                frame,
                seed: self.seed,
                camera,
                lights: Lights {
                    sun: None,
                    points: vec![],
                    environment: Environment {
                        sky_lux: [1.0; 3],
                        ground_lux: [1.0; 3],
                        background_nits: [0.0; 3],
                        ambient_occlusion: false,
                        image: None,
                    },
                },
                exposure_ev100: 3.0,
                post: Post::default(),
                objects: vec![],
                people: vec![],
                jpeg_quality: None,
            },
            picture: Some((0..width * height).flat_map(color).collect()),
            skipped: vec![],
            annotations: Annotations {
                frame,
                width,
                height,
                camera: CameraLabel::from(&camera),
                people: vec![person],
                semantic: Some(ids.iter().map(|id| u8::from(*id != 0)).collect()),
                instance_ids: Some(ids),
            },
            plan: PassPlan::new(&Outputs::new(), SceneFacts::default()),
            times: StageTimes::default(),
        })
    }
}

/// A config is a JSON object: `frames`, `fails` (frames that fail), `brush` (whether there is one).
pub struct Atelier;

impl Atelier {
    fn job(config: &Value, wishes: &Wishes) -> Job<Value> {
        let [width, height] = wishes.size.unwrap_or([32, 24]);
        let info = DatasetInfo {
            config_json: format!("{config:#}\n"),
            program_version: "0.0.0".to_owned(),
            engine: "brush".to_owned(),
            adapter: None,
            seed: wishes.seed.unwrap_or(1),
            width,
            height,
            outputs: wishes.outputs.clone().unwrap_or_else(|| Output::ALL.into()),
            picture: PictureFormat::Jpeg(92),
            assets: BTreeSet::new(),
        };
        let frames = config["frames"].as_u64().unwrap_or(3) as u32;
        Job {
            document: config.clone(),
            frames,
            info,
            engine: wishes.engine.clone(),
            simd: wishes.simd,
        }
    }
}

impl Road for Atelier {
    type Document = Value;
    type Config = Value;
    type Maker = Painter;

    fn schema(&self) -> Value {
        json!({"type": "object"})
    }

    fn load(&self, config: &Path, wishes: &Wishes) -> Result<Job<Value>, LoadError> {
        let unreadable =
            |e| LoadError::Unreadable(format!("cannot read {}: {e}", config.display()));
        let text = fs::read_to_string(config).map_err(unreadable)?;
        let value: Value = serde_json::from_str(&text)
            .map_err(|e| LoadError::Invalid(vec![format!("config: {e}")]))?;
        let known = |key: &&String| !["frames", "fails", "brush"].contains(&key.as_str());
        let unknown: Vec<_> = value.as_object().unwrap().keys().filter(known).collect();
        if unknown.is_empty() {
            return Ok(Self::job(&value, wishes));
        }
        Err(LoadError::Invalid(unknown.iter().map(|key| format!("{key}: no such field")).collect()))
    }

    /// A scenario is a JSON object as well: it becomes a config but for what begins with `unity`.
    fn import(&self, scenario: &Path) -> Result<Import<Value>, LoadError> {
        let unreadable =
            |e| LoadError::Unreadable(format!("cannot read {}: {e}", scenario.display()));
        let text = fs::read_to_string(scenario).map_err(unreadable)?;
        let mut value: Value = serde_json::from_str(&text)
            .map_err(|e| LoadError::Invalid(vec![format!("scenario: {e}")]))?;
        let map = value.as_object_mut().unwrap();
        let foreign = |key: &&String| key.starts_with("unity");
        let foreign: Vec<String> = map.keys().filter(foreign).cloned().collect();
        foreign.iter().for_each(|key| drop(map.remove(key)));
        let notes = foreign.iter().map(|key| format!("{key}: is left out")).collect();
        Ok(Import { document: value, notes })
    }

    fn text(&self, config: &Value) -> String {
        format!("{config:#}\n")
    }

    fn ready(&self, config: Value, wishes: &Wishes) -> Result<Job<Value>, LoadError> {
        Ok(Self::job(&config, wishes))
    }

    fn people(&self, job: &Job<Value>, frame: Option<u32>) -> Result<Vec<(u32, Member)>, String> {
        let name = |name: &str| Member { name: Some(name.to_owned()), ..Member::default() };
        match frame {
            Some(frame) => Ok(vec![(2, name(&format!("in_{frame}_of_{}", job.info.seed)))]),
            None if job.document["brush"] == false => Err("nobody recurs".to_owned()),
            None => Ok(vec![(0, name("maria")), (1, Member::default()), (2, name("otto"))]),
        }
    }

    fn starter(&self, wishes: &Wishes) -> Result<Job<Value>, LoadError> {
        Ok(Self::job(&json!({}), wishes))
    }

    fn maker(&self, job: &Job<Value>, _: NonZeroUsize) -> Result<Painter, PaintError> {
        if job.document["brush"] == false {
            return Err(PaintError::Brush);
        }
        let fails = job.document["fails"].as_array().into_iter().flatten();
        let fails = fails.map(|f| f.as_u64().unwrap() as u32).collect();
        let info = &job.info;
        Ok(Painter { width: info.width, height: info.height, seed: info.seed, fails })
    }

    fn parity(
        &self,
        wish: &ParityWish<'_>,
        tell: &mut dyn FnMut(&str, &Difference),
    ) -> Result<String, LoadError> {
        if wish.adapter.as_deref() == Some("anvil") {
            return Err(LoadError::NoEngine("there is no anvil".to_owned()));
        }
        let [width, height] = wish.size.map(|side| side as usize);
        let pixels = width * height * wish.frames as usize;
        // An odd number of frames is one in which a colour is far off.
        let color_most = if wish.frames % 2 == 1 { 99 } else { 1 };
        tell("brush", &Difference { pixels, color_most, ..Difference::default() });
        Ok("easel".to_owned())
    }

    fn window(&self, config: Option<&Path>) -> Result<(), String> {
        match config {
            Some(_) => Ok(()),
            None => Err("the wall is bricked up".to_owned()),
        }
    }

    fn engine(&self, simd: Simd) -> String {
        format!("brush ({simd:?})")
    }

    fn adapters(&self) -> Option<Vec<Adapter>> {
        let (name, line) = ("easel".to_owned(), "easel (wood)".to_owned());
        Some(vec![Adapter { name, line, hardware: true }])
    }

    fn built_in_assets(&self) -> Result<Vec<String>, String> {
        Ok(vec!["3 colours".to_owned()])
    }
}
