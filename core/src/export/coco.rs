//! COCO's `annotations.json`: the part of one frame, and the whole put together from the parts.
//!
//! The part of a frame is a text of one line for the image and one for each annotation, ready to be
//! copied into the index, which is thereby written with little memory for any number of frames.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::atomic::Pending;
use super::layout::FrameFile;
use super::manifest::{DatasetInfo, Identity};
use super::rle::{self, Rle};
use super::{ExportError, FrameSet, Layout, SERIALISES, SkippedAsset};
use crate::label::annotation::{
    Annotations, KEYPOINT_NAMES, Keypoint, PersonLabel, PersonMeta, SKELETON,
};
use crate::plan::Output;
use crate::scene::Sex;

/// The id of the category "person", as in COCO itself.
const PERSON: u32 = 1;

/// The id of an annotation: unique over a data set and the same whenever the frame is made again.
/// Below 2^48, so that it fits the 53 bits that JavaScript and JSON readers keep.
#[must_use]
pub const fn annotation_id(frame: u32, instance: u16) -> u64 {
    (frame as u64) << 16 | instance as u64
}

#[derive(Serialize)]
struct Image<'a> {
    id: u32,
    width: u32,
    height: u32,
    file_name: String,
    figurant: ImageExtras<'a>,
}

/// What COCO has no place for. Paths are relative to the data set's folder.
#[derive(Serialize)]
struct ImageExtras<'a> {
    frame: u32,
    #[serde(rename = "K")]
    k: [[f64; 3]; 3],
    #[serde(rename = "R")]
    r: [[f64; 3]; 3],
    t: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    distortion_model: Option<&'static str>,
    distortion: &'a [f64],
    scene: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    instance: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    semantic: Option<String>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    skipped_assets: &'a [SkippedAsset],
}

#[derive(Serialize)]
struct Annotation<'a> {
    id: u64,
    image_id: u32,
    category_id: u32,
    iscrowd: u8,
    #[serde(skip_serializing_if = "Option::is_none")]
    bbox: Option<[f64; 4]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    area: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    segmentation: Option<Segmentation>,
    #[serde(skip_serializing_if = "Option::is_none")]
    keypoints: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    num_keypoints: Option<usize>,
    figurant: AnnotationExtras<'a>,
}

#[derive(Serialize)]
struct Segmentation {
    /// Height, width.
    size: [u32; 2],
    counts: String,
}

/// What COCO has no place for.
#[derive(Serialize)]
struct AnnotationExtras<'a> {
    instance: u16,
    #[serde(skip_serializing_if = "Option::is_none")]
    keypoints_3d: Option<Vec<[f64; 3]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    visibility: Option<Vec<PointVisibility>>,
    person: &'a PersonMeta,
}

#[derive(Serialize)]
struct PointVisibility {
    reason: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    fraction: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    by: Option<u16>,
}

/// The part of one frame.
///
/// # Errors
/// When the labels contradict each other or hold a number that is not finite.
pub(super) fn fragment(
    info: &DatasetInfo,
    labels: &Annotations,
    skipped_assets: &[SkippedAsset],
) -> Result<Vec<u8>, ExportError> {
    let unsound = |what| ExportError::Unsound { frame: labels.frame, what };
    check(labels).map_err(unsound)?;
    let wants = |output| info.outputs.contains(&output);
    let file = |kind: FrameFile| kind.relative(labels.frame);
    let image = Image {
        id: labels.frame,
        width: labels.width,
        height: labels.height,
        file_name: file(FrameFile::picture(info.picture)),
        figurant: ImageExtras {
            frame: labels.frame,
            k: labels.camera.k,
            r: labels.camera.r,
            t: labels.camera.t,
            distortion_model: labels.camera.distortion_model,
            distortion: &labels.camera.distortion,
            scene: file(FrameFile::Scene),
            instance: wants(Output::Instance).then(|| file(FrameFile::Instance)),
            semantic: wants(Output::Semantic).then(|| file(FrameFile::Semantic)),
            skipped_assets,
        },
    };
    let mut bytes = line(&image);
    let wants_masks = wants(Output::Instance);
    let ids = labels.instance_ids.as_deref().filter(|_| wants_masks);
    let mut masks: BTreeMap<u16, Rle> = match ids {
        Some(ids) => rle::masks(ids, labels.width, labels.height).into_iter().collect(),
        None => BTreeMap::new(),
    };
    for person in &labels.people {
        let mask = masks.remove(&person.instance);
        // Where masks are asked for, whoever has no pixel has no annotation: readers choke on
        // empty masks.
        if if wants_masks { mask.is_some() } else { person.is_visible() } {
            bytes.extend(line(&annotation(info, labels, person, mask)));
        }
    }
    match masks.keys().next() {
        Some(id) => {
            Err(unsound(format!("the instance picture shows id {id}, which no person has")))
        }
        None => Ok(bytes),
    }
}

fn annotation<'a>(
    info: &DatasetInfo,
    labels: &Annotations,
    person: &'a PersonLabel,
    mask: Option<Rle>,
) -> Annotation<'a> {
    let wants = |output| info.outputs.contains(&output);
    let keypoints = person.keypoints.as_ref().filter(|_| wants(Output::Keypoints));
    let bbox = person.bbox.filter(|_| wants(Output::Box2d));
    // COCO's evaluation needs an area: that of the mask, or else the best that is known.
    let pixels = mask.as_ref().map(Rle::area).or(person.mask_area);
    Annotation {
        id: annotation_id(labels.frame, person.instance),
        image_id: labels.frame,
        category_id: PERSON,
        iscrowd: 0,
        bbox,
        area: pixels.map(|n| n as f64).or(bbox.map(|[_, _, w, h]| w * h)),
        segmentation: mask
            .map(|m| Segmentation { size: [labels.height, labels.width], counts: m.compressed() }),
        keypoints: keypoints.map(|points| points.iter().flat_map(coco_triple).collect()),
        num_keypoints: keypoints
            .map(|points| points.iter().filter(|k| k.coco_visibility() > 0).count()),
        figurant: AnnotationExtras {
            instance: person.instance,
            keypoints_3d: keypoints.map(|points| points.iter().map(|k| k.camera_m).collect()),
            visibility: keypoints.map(|points| points.iter().map(point_visibility).collect()),
            person: &person.meta,
        },
    }
}

/// x, y, v; what is not labelled is at 0, 0.
fn coco_triple(point: &Keypoint) -> [f64; 3] {
    match point.coco_visibility() {
        0 => [0.0; 3],
        v => [point.image_px[0], point.image_px[1], f64::from(v)],
    }
}

fn point_visibility(point: &Keypoint) -> PointVisibility {
    PointVisibility {
        reason: point.reason.name(),
        fraction: point.visible_fraction,
        by: point.reason.hidden_by(),
    }
}

/// What would give an index that readers choke on.
fn check(labels: &Annotations) -> Result<(), String> {
    let pixels = labels.width as usize * labels.height as usize;
    for (what, len) in [
        ("instance picture", labels.instance_ids.as_ref().map(Vec::len)),
        ("class picture", labels.semantic.as_ref().map(Vec::len)),
    ] {
        if len.is_some_and(|len| len != pixels) {
            return Err(format!(
                "the {what} does not have {} x {} pixels",
                labels.width, labels.height
            ));
        }
    }
    let camera = &labels.camera;
    let numbers =
        camera.k.iter().chain(&camera.r).flatten().chain(&camera.t).chain(&camera.distortion);
    finite(numbers, || "the camera".to_owned())?;
    if labels.people.iter().any(|p| p.instance == 0) {
        return Err("a person has the instance id 0, which stands for nobody".to_owned());
    }
    if let Some(pair) = labels.people.windows(2).find(|w| w[0].instance >= w[1].instance) {
        return Err(format!(
            "instance ids must ascend, but {} follows {}",
            pair[1].instance, pair[0].instance
        ));
    }
    labels.people.iter().try_for_each(check_person)
}

fn check_person(person: &PersonLabel) -> Result<(), String> {
    let of = |what: &str| format!("{what} of instance {}", person.instance);
    finite(person.bbox.iter().flatten(), || of("the box"))?;
    let meta = &person.meta;
    let mass_kg = meta.mass_kg.unwrap_or(0.0);
    let numbers = [meta.age_years, meta.stature_m, meta.bmi_kg_m2, mass_kg, meta.phase];
    finite(&numbers, || of("the description"))?;
    for (point, name) in person.keypoints.iter().flatten().zip(KEYPOINT_NAMES) {
        let labelled = point.image_px.iter().filter(|_| point.coco_visibility() > 0);
        let numbers = labelled.chain(&point.camera_m).chain(&point.visible_fraction);
        finite(numbers, || of(&format!("the {name}")))?;
    }
    Ok(())
}

fn finite<'a>(
    numbers: impl IntoIterator<Item = &'a f64>,
    what: impl FnOnce() -> String,
) -> Result<(), String> {
    match numbers.into_iter().find(|n| !n.is_finite()) {
        Some(number) => Err(format!("{} has the number {number}", what())),
        None => Ok(()),
    }
}

/// A value as one line.
fn line(value: &impl Serialize) -> Vec<u8> {
    let mut bytes = serde_json::to_vec(value).expect(SERIALISES);
    bytes.push(b'\n');
    bytes
}

/// Everything in the index before the images, without the closing brace.
fn head() -> Vec<u8> {
    let skeleton = SKELETON.map(|[a, b]| [a + 1, b + 1]);
    let value = json!({
        "info": {
            "description": "People who do not exist, by Figurant",
            "version": super::FORMAT_VERSION.to_string(),
        },
        "licenses": [],
        "categories": [{
            "id": PERSON,
            "name": "person",
            "supercategory": "person",
            "keypoints": KEYPOINT_NAMES,
            "skeleton": skeleton,
        }],
    });
    let mut bytes = serde_json::to_vec(&value).expect(SERIALISES);
    bytes.pop();
    bytes
}

/// Which lines of the parts go into a list of the index.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Lines {
    Images,
    Annotations,
}

/// What the frames of an index have in common.
pub(super) struct Occurring {
    /// Who recurs, by id.
    pub identities: Vec<Identity>,
    /// Pictures that were passed over.
    pub skipped: BTreeSet<SkippedAsset>,
}

/// Puts the index together from the parts of the frames, in ascending order of the frames, and
/// gives what occurs in it.
///
/// # Errors
/// When a part cannot be read or the index cannot be written; an older index is untouched then.
pub(super) fn assemble(layout: &Layout, frames: &FrameSet) -> Result<Occurring, ExportError> {
    let mut index = Pending::open(&layout.annotations())?;
    let mut identities = BTreeMap::new();
    let mut skipped = BTreeSet::new();
    index.append(&head())?;
    index.append(b",\n\"images\":[")?;
    copy(layout, frames, Lines::Images, &mut index, &mut |line| {
        skipped.extend(skipped_assets(line));
    })?;
    index.append(b"],\n\"annotations\":[")?;
    copy(layout, frames, Lines::Annotations, &mut index, &mut |line| {
        if let Some(found) = identity(line) {
            identities.entry(found.id).or_insert(found).annotations += 1;
        }
    })?;
    index.append(b"]}\n")?;
    index.sync()?;
    index.publish()?;
    Ok(Occurring { identities: identities.into_values().collect(), skipped })
}

/// What an image's line says of pictures that were passed over.
fn skipped_assets(line: &str) -> Vec<SkippedAsset> {
    #[derive(Deserialize)]
    struct Line {
        figurant: Extras,
    }
    #[derive(Deserialize)]
    struct Extras {
        skipped_assets: Vec<SkippedAsset>,
    }
    // Few lines of few data sets say anything.
    if !line.contains("\"skipped_assets\":") {
        return Vec::new();
    }
    serde_json::from_str(line)
        .map_or_else(|_| Vec::new(), |line: Line| line.figurant.skipped_assets)
}

/// The parts of an annotation's line that say who it is.
#[derive(Deserialize)]
struct Who {
    figurant: WhoExtras,
}

#[derive(Deserialize)]
struct WhoExtras {
    person: WhoPerson,
}

#[derive(Deserialize)]
struct WhoPerson {
    identity: Option<u32>,
    name: Option<String>,
    sex: Sex,
    age_years: f64,
    stature_m: f64,
    bmi_kg_m2: f64,
}

/// Who an annotation shows, if it is somebody who recurs. Not counted yet.
fn identity(line: &str) -> Option<Identity> {
    // Most lines of most data sets are about somebody new, and reading them takes a while.
    if !line.contains("\"identity\":") {
        return None;
    }
    let WhoPerson { identity, name, sex, age_years, stature_m, bmi_kg_m2 } =
        serde_json::from_str::<Who>(line).ok()?.figurant.person;
    Some(Identity { id: identity?, name, sex, age_years, stature_m, bmi_kg_m2, annotations: 0 })
}

/// Copies lines with commas between them, in pieces of about a megabyte.
fn copy(
    layout: &Layout,
    frames: &FrameSet,
    which: Lines,
    index: &mut Pending,
    seen: &mut dyn FnMut(&str),
) -> Result<(), ExportError> {
    const PIECE: usize = 1 << 20;
    let mut buffer = Vec::with_capacity(PIECE + PIECE / 4);
    let mut separator: &[u8] = b"\n";
    for frame in frames.iter() {
        let path = layout.frame_file(FrameFile::Fragment, frame);
        for text in read_lines(&path, which)? {
            seen(&text);
            buffer.extend_from_slice(separator);
            buffer.extend_from_slice(text.as_bytes());
            separator = b",\n";
        }
        if buffer.len() >= PIECE {
            index.append(&buffer)?;
            buffer.clear();
        }
    }
    index.append(&buffer)
}

fn read_lines(path: &Path, which: Lines) -> Result<Vec<String>, ExportError> {
    let read = || -> std::io::Result<Vec<String>> {
        let lines = BufReader::new(File::open(path)?).lines();
        match which {
            Lines::Images => lines.take(1).collect(),
            Lines::Annotations => lines.skip(1).collect(),
        }
    };
    read().map_err(ExportError::io(path, "read the frame's part of the index"))
}
