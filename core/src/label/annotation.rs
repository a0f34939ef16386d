//! The values that labels are: what writers, overlays and tests read.
//!
//! Made from a rendered frame by the rest of this layer, complete for one frame or not at all.
//! Image positions are continuous pixels and camera positions OpenCV axes, as
//! [`crate::base::space`] fixes them. Nothing is computed here that looks at pixels.

use serde::Serialize;

use crate::library::pose::PREFIX;
use crate::scene::{BottomKind, Camera, OuterKind, Outfit, Person, Role, Sex, ShoeKind, TopKind};

/// Number of keypoints of a person: the COCO-17 set.
pub const KEYPOINT_COUNT: usize = 17;

/// Names of the keypoints in COCO's order; left and right are the person's own.
pub const KEYPOINT_NAMES: [&str; KEYPOINT_COUNT] = [
    "nose",
    "left_eye",
    "right_eye",
    "left_ear",
    "right_ear",
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
    "left_hip",
    "right_hip",
    "left_knee",
    "right_knee",
    "left_ankle",
    "right_ankle",
];

/// The 19 edges of COCO's skeleton as indices into [`KEYPOINT_NAMES`], in COCO's order (whose
/// files count from one).
pub const SKELETON: [[usize; 2]; 19] = [
    [15, 13],
    [13, 11],
    [16, 14],
    [14, 12],
    [11, 12],
    [5, 11],
    [6, 12],
    [5, 6],
    [5, 7],
    [6, 8],
    [7, 9],
    [8, 10],
    [1, 2],
    [0, 1],
    [0, 2],
    [1, 3],
    [2, 4],
    [3, 5],
    [4, 6],
];

/// Everything that is known about one frame. What was not asked for is absent.
#[derive(Clone, Debug, PartialEq)]
pub struct Annotations {
    /// Frame number.
    pub frame: u32,
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// The camera.
    pub camera: CameraLabel,
    /// People in ascending order of their instance id. People without a visible sample may be
    /// listed; writers leave them out ([`PersonLabel::is_visible`]).
    pub people: Vec<PersonLabel>,
    /// Row by row, `width * height` long: the instance id of the person with most samples in the
    /// pixel, 0 where that is none.
    pub instance_ids: Option<Vec<u16>>,
    /// Row by row, `width * height` long: [`SemanticClass::id`] of the class in the pixel.
    pub semantic: Option<Vec<u8>>,
}

/// The camera in the terms of computer vision: `x = K distort(R X + t)`.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraLabel {
    /// Intrinsic matrix, rows.
    pub k: [[f64; 3]; 3],
    /// Rotation of `X_camera = R X_world + t`, rows; OpenCV axes.
    pub r: [[f64; 3]; 3],
    /// Translation of the same, metres.
    pub t: [f64; 3],
    /// Model of the distortion, as the config names it; none for a pinhole.
    pub distortion_model: Option<&'static str>,
    /// Coefficients in OpenCV's order: k1, k2, p1, p2, k3 of `cv2.projectPoints`, or k1 to k4 of
    /// `cv2.fisheye`; empty for a pinhole.
    pub distortion: Vec<f64>,
}

impl From<&Camera> for CameraLabel {
    fn from(camera: &Camera) -> Self {
        Self {
            k: camera.intrinsics(),
            r: camera.cv_from_world_rotation().transpose().to_cols_array_2d(),
            // Adding zero turns -0 into 0.
            t: camera.cv_from_world_translation().to_array().map(|v| v + 0.0),
            distortion_model: camera.distortion.map(|lens| lens.model()),
            distortion: camera.distortion.map_or_else(Vec::new, |lens| lens.coefficients()),
        }
    }
}

/// The labels of one person.
#[derive(Clone, Debug, PartialEq)]
pub struct PersonLabel {
    /// Id in the instance picture: the person's slot plus one, so never 0.
    pub instance: u16,
    /// Tight around the visible samples: x, y, width, height in pixels. None if no sample is
    /// visible or boxes were not asked for.
    pub bbox: Option<[f64; 4]>,
    /// Pixels of the mask. Known whenever it is known which person a pixel shows, even if no
    /// instance picture was asked for.
    pub mask_area: Option<u64>,
    /// In the order of [`KEYPOINT_NAMES`].
    pub keypoints: Option<[Keypoint; KEYPOINT_COUNT]>,
    /// Who it is.
    pub meta: PersonMeta,
}

impl PersonLabel {
    /// Whether the person shows in the picture: has a pixel or, where pixels are not known, a
    /// visible sample or keypoint.
    #[must_use]
    pub fn is_visible(&self) -> bool {
        let seen = |k: &Keypoint| k.reason == Visibility::Visible;
        match self.mask_area {
            Some(pixels) => pixels > 0,
            None => {
                self.bbox.is_some()
                    || self.keypoints.as_ref().is_some_and(|points| points.iter().any(seen))
            }
        }
    }
}

/// One keypoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keypoint {
    /// Exact projection in pixels, inside the picture or not. Meaningless behind the camera.
    pub image_px: [f64; 2],
    /// Metres, camera space with OpenCV's axes.
    pub camera_m: [f64; 3],
    /// Whether it can be seen, and if not, why.
    pub reason: Visibility,
    /// Visible share (0..1) of a small patch of surface around it, where that was measured.
    pub visible_fraction: Option<f64>,
}

impl Keypoint {
    /// COCO's flag: 2 visible, 1 inside the picture but hidden, 0 not labelled.
    #[must_use]
    pub const fn coco_visibility(&self) -> u8 {
        self.reason.coco()
    }
}

/// Why a keypoint can or cannot be seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// It shows in the picture.
    Visible,
    /// The person's own body, hair or clothes are in front of it.
    SelfOccluded,
    /// The person with this instance id is in front of it.
    HiddenByPerson(u16),
    /// Something that is not a person is in front of it.
    HiddenByObject,
    /// Its projection lies outside the picture.
    OutOfFrame,
    /// It does not lie in front of the camera.
    BehindCamera,
}

impl Visibility {
    /// COCO's flag: 2 visible, 1 inside the picture but hidden, 0 not labelled.
    #[must_use]
    pub const fn coco(self) -> u8 {
        match self {
            Self::Visible => 2,
            Self::SelfOccluded | Self::HiddenByPerson(_) | Self::HiddenByObject => 1,
            Self::OutOfFrame | Self::BehindCamera => 0,
        }
    }

    /// The name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Visible => "visible",
            Self::SelfOccluded => "self_occluded",
            Self::HiddenByPerson(_) => "hidden_by_person",
            Self::HiddenByObject => "hidden_by_object",
            Self::OutOfFrame => "out_of_frame",
            Self::BehindCamera => "behind_camera",
        }
    }

    /// The instance id of the person in front, if that is what hides it.
    #[must_use]
    pub const fn hidden_by(self) -> Option<u16> {
        match self {
            Self::HiddenByPerson(instance) => Some(instance),
            _ => None,
        }
    }
}

/// Who a person is; written as `person` beside the labels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PersonMeta {
    /// Years.
    pub age_years: f64,
    /// Of the body model.
    pub sex: Sex,
    /// Standing height without shoes, metres.
    pub stature_m: f64,
    /// Body mass index that was drawn, kg/m2; what the body model does not reach becomes the nearest
    /// that it does.
    pub bmi_kg_m2: f64,
    /// From the body's volume, where that was measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Names of the garments from top to bottom.
    pub garments: Vec<String>,
    /// Who of the people that recur over frames it is, if anybody does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub identity: Option<u32>,
    /// What the config calls this person, if it does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// What the person does, such as `walking`.
    pub activity: String,
    /// Motion clip id; empty where the person takes a pose.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub clip: String,
    /// Pose id, such as `pose/sitting_chair`; empty where the person follows a clip.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub pose: String,
    /// Position in the clip, 0..1.
    pub phase: f64,
    /// Left and right exchanged.
    pub mirrored: bool,
}

impl PersonMeta {
    /// What a scene says about a person.
    #[must_use]
    pub fn new(person: &Person, mass_kg: Option<f64>) -> Self {
        let id = &person.pose.clip;
        let (clip, pose) = if id.starts_with(PREFIX) {
            (String::new(), id.clone())
        } else {
            (id.clone(), String::new())
        };
        Self {
            age_years: person.body.age_years,
            sex: person.body.sex,
            stature_m: person.body.stature_m,
            bmi_kg_m2: person.body.bmi_kg_m2,
            mass_kg,
            garments: garments(&person.outfit),
            identity: person.identity,
            name: person.name.clone(),
            activity: person.pose.activity.clone(),
            clip,
            pose,
            phase: person.pose.phase,
            mirrored: person.pose.mirrored,
        }
    }
}

/// Names of the garments that show, from top to bottom, as the config calls them.
fn garments(outfit: &Outfit) -> Vec<String> {
    let outer = match outfit.outer.kind {
        OuterKind::None => None,
        OuterKind::Jacket => Some("jacket"),
        OuterKind::Coat => Some("coat"),
    };
    let top = match outfit.top.kind {
        TopKind::TShirt => "t_shirt",
        TopKind::LongSleeve => "long_sleeve",
        TopKind::Shirt => "shirt",
        TopKind::Polo => "polo",
        TopKind::TankTop => "tank_top",
        TopKind::Hoodie => "hoodie",
        TopKind::Sweater => "sweater",
    };
    let bottom = match outfit.bottom.kind {
        BottomKind::Trousers => "trousers",
        BottomKind::Jeans => "jeans",
        BottomKind::Leggings => "leggings",
        BottomKind::Shorts => "shorts",
        BottomKind::SkirtShort => "skirt_short",
        BottomKind::SkirtLong => "skirt_long",
        BottomKind::DressShort => "dress_short",
        BottomKind::DressLong => "dress_long",
    };
    let shoes = match outfit.shoes.kind {
        ShoeKind::Shoes => Some("shoes"),
        ShoeKind::Sneakers => Some("sneakers"),
        ShoeKind::Boots => Some("boots"),
        ShoeKind::Sandals => Some("sandals"),
        ShoeKind::Barefoot => None,
    };
    // A dress is one piece.
    let top = (!outfit.bottom.kind.is_dress()).then_some(top);
    [outer, top, Some(bottom), shoes].into_iter().flatten().map(str::to_owned).collect()
}

/// The class that a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum SemanticClass {
    /// Nothing stands there.
    Background = 0,
    /// A person with hair, clothes and shoes.
    Person = 1,
    /// The wall behind everything.
    Wall = 2,
    /// The ground.
    Floor = 3,
    /// Clutter that hides people.
    Occluder = 4,
}

impl SemanticClass {
    /// All classes, in the order of their ids.
    pub const ALL: [Self; 5] =
        [Self::Background, Self::Person, Self::Wall, Self::Floor, Self::Occluder];

    /// The number in [`Annotations::semantic`], and the palette index in the semantic picture.
    #[must_use]
    pub const fn id(self) -> u8 {
        self as u8
    }

    /// The name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Background => "background",
            Self::Person => "person",
            Self::Wall => "wall",
            Self::Floor => "floor",
            Self::Occluder => "occluder",
        }
    }

    /// The colour in the semantic picture, 8-bit RGB, no two alike.
    #[must_use]
    pub const fn color(self) -> [u8; 3] {
        match self {
            Self::Background => [0, 0, 0],
            Self::Person => [220, 20, 60],
            Self::Wall => [102, 102, 156],
            Self::Floor => [128, 64, 128],
            Self::Occluder => [250, 170, 30],
        }
    }
}

impl From<Role> for SemanticClass {
    fn from(role: Role) -> Self {
        match role {
            Role::Wall => Self::Wall,
            Role::Floor => Self::Floor,
            Role::Occluder => Self::Occluder,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::lens::Lens;
    use glam::{DQuat, DVec2, DVec3};

    #[test]
    fn the_camera_label_projects_as_the_camera_does() {
        let lens = Lens::Brown { k1: -0.2, k2: 0.05, p1: 0.001, p2: -0.002, k3: 0.01 };
        let camera = Camera {
            width: 640,
            height: 480,
            fov_vertical_deg: 35.0,
            position_m: DVec3::new(1.5, -2.0, 15.0),
            rotation: DQuat::from_rotation_y(0.2) * DQuat::from_rotation_x(-0.1),
            near_m: 0.3,
            motion_blur: None,
            depth_of_field: None,
            distortion: None,
        };
        let through = Camera { distortion: Some(lens), ..camera };
        let CameraLabel { k, r, t, distortion_model, distortion } = CameraLabel::from(&through);
        assert_eq!(distortion_model, Some("brown"));
        assert_eq!(distortion, [-0.2, 0.05, 0.001, -0.002, 0.01]);
        assert!(CameraLabel::from(&camera).distortion.is_empty());
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        for p in [DVec3::ZERO, DVec3::new(-1.0, 2.0, 3.0), DVec3::new(2.0, 0.5, -8.0)] {
            let x = [0, 1, 2].map(|i| dot(r[i], p.to_array()) + t[i]);
            let q = k.map(|row| dot(row, x));
            let expected = camera.project(camera.view_from_world(p)).unwrap();
            assert!((q[0] / q[2] - expected.x).abs() < 1e-9, "{p}");
            assert!((q[1] / q[2] - expected.y).abs() < 1e-9, "{p}");
            // x = K distort(R X + t).
            let distorted = lens.distort(DVec2::new(x[0], x[1]) / x[2]);
            let q = k.map(|row| dot(row, [distorted.x, distorted.y, 1.0]));
            let expected = through.project(through.view_from_world(p)).unwrap();
            assert!((q[0] - expected.x).abs() < 1e-9 && (q[1] - expected.y).abs() < 1e-9, "{p}");
        }
    }

    #[test]
    fn the_skeleton_joins_every_keypoint_and_mirrors_onto_itself() {
        let mirror = |i: usize| {
            let name = KEYPOINT_NAMES[i];
            let other = match name.split_once('_') {
                Some(("left", part)) => format!("right_{part}"),
                Some(("right", part)) => format!("left_{part}"),
                _ => name.to_owned(),
            };
            KEYPOINT_NAMES.iter().position(|n| *n == other).unwrap()
        };
        let edge = |[a, b]: [usize; 2]| (a.min(b), a.max(b));
        let edges: std::collections::BTreeSet<_> = SKELETON.into_iter().map(edge).collect();
        assert_eq!(edges.len(), 19);
        for &(a, b) in &edges {
            assert!(edges.contains(&edge([mirror(a), mirror(b)])), "{a}-{b} has no mirror image");
        }
        assert!((0..KEYPOINT_COUNT).all(|i| SKELETON.iter().flatten().any(|&j| j == i)));
    }

    #[test]
    fn class_ids_index_the_table() {
        for (i, class) in SemanticClass::ALL.into_iter().enumerate() {
            assert_eq!(usize::from(class.id()), i);
        }
        let colors: std::collections::BTreeSet<_> =
            SemanticClass::ALL.into_iter().map(SemanticClass::color).collect();
        assert_eq!(colors.len(), SemanticClass::ALL.len());
    }
}
