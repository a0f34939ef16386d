//! Small frames with known labels for the tests of this layer and of `job`.

use std::collections::BTreeSet;

use glam::{DQuat, DVec3};

use super::{AssetLicence, DatasetInfo, PictureFormat};
use crate::label::annotation::{
    Annotations, CameraLabel, Keypoint, PersonLabel, PersonMeta, Visibility,
};
use crate::plan::{Output, Outputs};
use crate::scene::{Camera, Environment, Lights, Post, Scene, Sex};

pub const WIDTH: u32 = 24;
pub const HEIGHT: u32 = 16;

pub fn all_outputs() -> Outputs {
    Output::ALL.into_iter().collect()
}

pub fn info(outputs: Outputs, picture: PictureFormat) -> DatasetInfo {
    DatasetInfo {
        config_json: "{\"version\": 1}\n".to_owned(),
        program_version: "0.0.0".to_owned(),
        engine: "cpu".to_owned(),
        adapter: None,
        seed: 42,
        width: WIDTH,
        height: HEIGHT,
        outputs,
        picture,
        assets: BTreeSet::from([AssetLicence {
            id: "clip/walk".to_owned(),
            content_hash: None,
            licence: "CC0-1.0".to_owned(),
            source: "drawn by hand".to_owned(),
        }]),
    }
}

pub fn scene(frame: u32) -> Scene {
    Scene {
        frame,
        seed: 42,
        camera: Camera {
            width: WIDTH,
            height: HEIGHT,
            fov_vertical_deg: 30.0 + f64::from(frame) / 7.0,
            position_m: DVec3::new(0.1, 0.2, 15.0),
            rotation: DQuat::IDENTITY,
            near_m: 0.3,
            motion_blur: None,
            depth_of_field: None,
            distortion: None,
        },
        lights: Lights {
            sun: None,
            points: Vec::new(),
            environment: Environment {
                sky_lux: [1.0; 3],
                ground_lux: [0.5; 3],
                background_nits: [0.1; 3],
                ambient_occlusion: false,
                image: None,
            },
        },
        exposure_ev100: 5.0,
        post: Post::default(),
        objects: Vec::new(),
        people: Vec::new(),
        jpeg_quality: None,
    }
}

/// The pixels of instance `i` are a rectangle of 3 x 5 at (4 i, frame mod 4).
pub fn labels(frame: u32, people: u16) -> Annotations {
    let top = frame % 4;
    let mut ids = vec![0; (WIDTH * HEIGHT) as usize];
    for instance in 1..=people {
        for y in top..top + 5 {
            for x in u32::from(instance) * 4..u32::from(instance) * 4 + 3 {
                ids[(y * WIDTH + x) as usize] = instance;
            }
        }
    }
    let person = |instance: u16| PersonLabel {
        instance,
        bbox: Some([f64::from(instance) * 4.0, f64::from(top), 3.0, 5.0]),
        mask_area: Some(15),
        keypoints: Some(std::array::from_fn(|i| keypoint(i, instance))),
        meta: PersonMeta {
            age_years: 33.5,
            sex: Sex::Female,
            stature_m: 1.71,
            bmi_kg_m2: 21.9,
            mass_kg: Some(64.0),
            garments: vec!["top".to_owned(), "shorts".to_owned()],
            identity: Some(u32::from(instance) * 7),
            name: (instance == 1).then(|| "maria".to_owned()),
            activity: "walking".to_owned(),
            clip: "walk".to_owned(),
            pose: String::new(),
            phase: 0.25,
            mirrored: false,
        },
    };
    Annotations {
        frame,
        width: WIDTH,
        height: HEIGHT,
        camera: CameraLabel::from(&scene(frame).camera),
        people: (1..=people).map(person).collect(),
        semantic: Some(ids.iter().map(|id| u8::from(*id != 0)).collect()),
        instance_ids: Some(ids),
    }
}

/// One keypoint of each kind, then visible ones.
fn keypoint(i: usize, instance: u16) -> Keypoint {
    let reasons = [
        Visibility::Visible,
        Visibility::SelfOccluded,
        Visibility::HiddenByPerson(9),
        Visibility::HiddenByObject,
        Visibility::OutOfFrame,
        Visibility::BehindCamera,
    ];
    Keypoint {
        image_px: [f64::from(instance) * 4.0 + 0.25, i as f64 / 3.0],
        camera_m: [i as f64 * 0.1, -0.5, 4.0],
        reason: reasons.get(i).copied().unwrap_or(Visibility::Visible),
        visible_fraction: (i == 0).then_some(0.75),
    }
}

pub fn picture(frame: u32) -> Vec<u8> {
    (0..WIDTH * HEIGHT * 3).map(|i| (i * 7 + frame * 31) as u8).collect()
}
