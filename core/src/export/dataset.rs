//! A data set that is being written.

use std::fs;
use std::path::{Path, PathBuf};

use super::atomic::{self, Pending};
use super::layout::FrameFile;
use super::{
    DatasetInfo, Existing, ExportError, FrameSet, Layout, Report, SkippedAsset, coco, folder,
    manifest, picture,
};
use crate::label::annotation::{Annotations, SemanticClass};
use crate::plan::Output;
use crate::scene::Scene;

/// The folder of a data set, and what is the same for all of its frames.
#[derive(Clone, Debug)]
pub struct Dataset {
    layout: Layout,
    info: DatasetInfo,
}

/// The files of one frame as bytes, the frame's part of the index last.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EncodedFrame {
    files: Vec<(PathBuf, Vec<u8>)>,
}

/// The files of one frame under temporary names. Dropped, they are removed.
#[derive(Debug)]
pub struct StagedFrame {
    files: Vec<Pending>,
}

impl Dataset {
    /// Makes the folder with its manifest and config.
    ///
    /// # Errors
    /// When the folder is not empty and may not be overwritten, holds files under our names that may
    /// not be ours, or cannot be written to.
    pub fn create(root: &Path, info: DatasetInfo, existing: Existing) -> Result<Self, ExportError> {
        let dataset = Self { layout: Layout::new(root), info };
        let layout = &dataset.layout;
        folder::prepare(layout, existing)?;
        // First, so that the folder says whose it is even if the program is killed right now.
        let nothing = manifest::to_json(&dataset.info, &FrameSet::default(), &[]);
        atomic::write(&layout.manifest(), &nothing)?;
        folder::clear(layout)?;
        for folder in dataset.folders() {
            let path = layout.root().join(folder);
            fs::create_dir_all(&path).map_err(ExportError::io(&path, "create the folder"))?;
        }
        atomic::write(&layout.config(), dataset.info.config_json.as_bytes())?;
        folder::sync(layout)?;
        Ok(dataset)
    }

    /// Where its files are.
    #[must_use]
    pub const fn layout(&self) -> &Layout {
        &self.layout
    }

    /// What is the same for all of its frames.
    #[must_use]
    pub const fn info(&self) -> &DatasetInfo {
        &self.info
    }

    fn wants(&self, output: Output) -> bool {
        self.info.outputs.contains(&output)
    }

    fn folders(&self) -> Vec<&'static str> {
        let mut folders = vec!["coco", FrameFile::Scene.folder(), FrameFile::Fragment.folder()];
        let optional = [
            (Output::Rgb, FrameFile::picture(self.info.picture)),
            (Output::Instance, FrameFile::Instance),
            (Output::Semantic, FrameFile::Semantic),
        ];
        folders
            .extend(optional.iter().filter(|(o, _)| self.wants(*o)).map(|(_, file)| file.folder()));
        folders
    }

    /// The files of a frame, as bytes. Touches no disk.
    ///
    /// `picture` is 8-bit sRGB, `width * height * 3` long; `skipped` are pictures of the assets in whose
    /// place it shows others.
    ///
    /// # Errors
    /// When something that is wanted is missing, labels contradict each other, or an encoder refuses.
    pub fn encode(
        &self,
        scene: &Scene,
        picture: Option<&[u8]>,
        labels: &Annotations,
        skipped: &[SkippedAsset],
    ) -> Result<EncodedFrame, ExportError> {
        let (width, height) = (labels.width, labels.height);
        let missing = |what: &str| ExportError::Unsound {
            frame: labels.frame,
            what: format!("{what} is wanted but was not made"),
        };
        let mut files = Vec::new();
        let mut add = |file: FrameFile, bytes| {
            files.push((self.layout.frame_file(file, labels.frame), bytes))
        };
        if self.wants(Output::Rgb) {
            let pixels = picture.ok_or_else(|| missing("the picture"))?;
            let format = self.info.picture.or_quality(scene.jpeg_quality);
            add(FrameFile::picture(format), format.encode(pixels, width, height)?);
        }
        if self.wants(Output::Instance) {
            let ids =
                labels.instance_ids.as_deref().ok_or_else(|| missing("the instance picture"))?;
            add(FrameFile::Instance, picture::png_ids(ids, width, height)?);
        }
        if self.wants(Output::Semantic) {
            let ids = labels.semantic.as_deref().ok_or_else(|| missing("the class picture"))?;
            let palette = SemanticClass::ALL.map(SemanticClass::color);
            add(FrameFile::Semantic, picture::png_palette(ids, width, height, &palette)?);
        }
        add(FrameFile::Scene, scene_json(scene)?);
        add(FrameFile::Fragment, coco::fragment(&self.info, labels, skipped)?);
        Ok(EncodedFrame { files })
    }

    /// Writes the index, the report and, last, the manifest. The parts of the index stay as long as
    /// frames are missing, so that the run can be taken up again.
    ///
    /// # Errors
    /// When a part of the index cannot be read or a file cannot be written.
    pub fn finish(&self, report: &Report) -> Result<(), ExportError> {
        let layout = &self.layout;
        let coco::Occurring { identities, skipped } = coco::assemble(layout, &report.done)?;
        atomic::write(&layout.report(), &report.to_json(&skipped))?;
        folder::sync(layout)?;
        let manifest = manifest::to_json(&self.info, &report.done, &identities);
        atomic::write(&layout.manifest(), &manifest)?;
        atomic::sync_folder(layout.root())?;
        if report.is_complete() {
            let parts = layout.root().join(".figurant");
            fs::remove_dir_all(&parts)
                .map_err(ExportError::io(&parts, "remove the parts of the index"))?;
        }
        Ok(())
    }
}

/// The scene's file, which must be enough to render the frame again.
fn scene_json(scene: &Scene) -> Result<Vec<u8>, ExportError> {
    let unsound = |what| ExportError::Unsound { frame: scene.frame, what };
    let mut bytes = serde_json::to_vec(scene)
        .map_err(|e| unsound(format!("the scene has no JSON form: {e}")))?;
    // Numbers that are not finite become null, which no scene can be read from.
    match serde_json::from_slice::<Scene>(&bytes) {
        Ok(back) if back == *scene => {}
        Ok(_) => return Err(unsound("the scene changes when it is written and read".to_owned())),
        Err(e) => {
            return Err(unsound(format!("the scene holds a number that is not finite ({e})")));
        }
    }
    bytes.push(b'\n');
    Ok(bytes)
}

impl EncodedFrame {
    /// The files with their bytes.
    #[must_use]
    pub fn files(&self) -> &[(PathBuf, Vec<u8>)] {
        &self.files
    }

    /// Writes all files under temporary names.
    ///
    /// # Errors
    /// When a file cannot be written; nothing is left behind.
    pub fn stage(&self) -> Result<StagedFrame, ExportError> {
        let write = |(path, bytes): &(PathBuf, Vec<u8>)| Pending::write(path, bytes);
        Ok(StagedFrame { files: self.files.iter().map(write).collect::<Result<_, _>>()? })
    }
}

impl StagedFrame {
    /// Waits until all bytes are on the disk, then gives the files their names, the frame's part of
    /// the index last: a frame counts as done when that is there.
    ///
    /// # Errors
    /// When the disk is full or fails; the frame does not count as done then.
    pub fn commit(mut self) -> Result<(), ExportError> {
        for file in &mut self.files {
            file.sync()?;
        }
        self.files.into_iter().try_for_each(Pending::publish)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::{FailedFrame, PictureFormat, annotation_id, sample};
    use crate::label::annotation::Visibility;
    use crate::plan::Outputs;
    use serde_json::Value;

    fn create(root: &Path, outputs: Outputs) -> Dataset {
        let info = sample::info(outputs, PictureFormat::Png);
        Dataset::create(root, info, Existing::Refuse).unwrap()
    }

    fn commit(dataset: &Dataset, frame: u32, people: u16) {
        let (scene, picture) = (sample::scene(frame), sample::picture(frame));
        let encoded =
            dataset.encode(&scene, Some(&picture), &sample::labels(frame, people), &[]).unwrap();
        encoded.stage().unwrap().commit().unwrap();
    }

    fn report(asked: std::ops::Range<u32>, done: impl IntoIterator<Item = u32>) -> Report {
        Report { asked, done: done.into_iter().collect(), ..Report::default() }
    }

    fn json(path: PathBuf) -> Value {
        serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
    }

    /// All files below a folder with their bytes.
    fn tree(root: &Path) -> std::collections::BTreeMap<String, Vec<u8>> {
        let mut found = std::collections::BTreeMap::new();
        let mut folders = vec![root.to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let name = path.strip_prefix(root).unwrap().to_str().unwrap().to_owned();
                    found.insert(name, fs::read(path).unwrap());
                }
            }
        }
        found
    }

    #[test]
    fn the_index_says_what_the_labels_say() {
        let dir = tempfile::tempdir().unwrap();
        let dataset = create(dir.path(), sample::all_outputs());
        commit(&dataset, 3, 2);
        dataset.finish(&report(3..4, [3])).unwrap();
        let index = json(dataset.layout().annotations());
        let category = &index["categories"][0];
        assert_eq!(category["name"], "person");
        assert_eq!(category["keypoints"].as_array().unwrap().len(), 17);
        assert_eq!(category["skeleton"][0], serde_json::json!([16, 14]));
        let image = &index["images"][0];
        assert_eq!((image["id"].as_u64(), image["width"].as_u64()), (Some(3), Some(24)));
        for path in
            [&image["file_name"], &image["figurant"]["scene"], &image["figurant"]["instance"]]
        {
            assert!(dir.path().join(path.as_str().unwrap()).is_file(), "{path}");
        }
        let annotations = index["annotations"].as_array().unwrap();
        assert_eq!(annotations.len(), 2);
        let second = &annotations[1];
        assert_eq!(second["id"].as_u64(), Some(annotation_id(3, 2)));
        assert_eq!(second["bbox"], serde_json::json!([8.0, 3.0, 3.0, 5.0]));
        assert_eq!(second["area"], 15.0);
        assert_eq!(second["iscrowd"], 0);
        assert_eq!(second["segmentation"]["size"], serde_json::json!([16, 24]));
        assert_eq!(second["num_keypoints"], 15);
        let points = second["keypoints"].as_array().unwrap();
        assert_eq!(points[..3], [8.25, 0.0, 2.0].map(Value::from));
        assert_eq!(points[3 * 3 + 2], 1.0);
        assert!(
            points[4 * 3..6 * 3].iter().all(|n| *n == 0.0),
            "unlabelled points stand at 0, 0, 0"
        );
        let extras = &second["figurant"];
        assert_eq!(extras["visibility"][2]["reason"], Visibility::HiddenByPerson(9).name());
        assert_eq!(extras["visibility"][2]["by"], 9);
        assert_eq!(extras["visibility"][0]["fraction"], 0.75);
        assert_eq!(extras["keypoints_3d"].as_array().unwrap().len(), 17);
        let person = &extras["person"];
        assert_eq!(person["sex"], "female");
        assert_eq!([&person["clip"], &person["activity"]], ["walk", "walking"]);
        assert_eq!((&person["phase"], &person["identity"]), (&Value::from(0.25), &Value::from(14)));
        assert!(person.get("name").is_none());
        assert_eq!(annotations[0]["figurant"]["person"]["name"], "maria");
        assert!(person.get("pose").is_none());
    }

    #[test]
    fn the_manifest_lists_who_recurs() {
        let dir = tempfile::tempdir().unwrap();
        let dataset = create(dir.path(), sample::all_outputs());
        assert!(json(dataset.layout().manifest()).get("identities").is_none());
        for (frame, people) in [(4, 2), (1, 1), (2, 0), (9, 1)] {
            commit(&dataset, frame, people);
        }
        // Frame 9 was not finished by this run.
        dataset.finish(&report(0..5, [4, 1, 2])).unwrap();
        let expected = serde_json::json!([
            {"id": 7, "name": "maria", "sex": "female", "age_years": 33.5, "stature_m": 1.71,
             "bmi_kg_m2": 21.9, "annotations": 2},
            {"id": 14, "sex": "female", "age_years": 33.5, "stature_m": 1.71,
             "bmi_kg_m2": 21.9, "annotations": 1},
        ]);
        assert_eq!(json(dataset.layout().manifest())["identities"], expected);
    }

    #[test]
    fn only_what_was_asked_for_is_written() {
        let dir = tempfile::tempdir().unwrap();
        let dataset = create(dir.path(), Outputs::from([Output::Box2d]));
        commit(&dataset, 0, 1);
        dataset.finish(&report(0..1, [0])).unwrap();
        let names: Vec<_> = tree(dir.path()).into_keys().collect();
        let expected = [
            "coco/annotations.json",
            "config.json",
            "manifest.json",
            "report.json",
            "scenes/000000.json",
        ];
        assert_eq!(names, expected);
        let index = json(dataset.layout().annotations());
        assert_eq!(index["images"][0]["file_name"], "images/000000.png");
        assert!(index["images"][0]["figurant"].get("instance").is_none());
        let annotation = index["annotations"][0].as_object().unwrap();
        assert_eq!(annotation["area"], 15.0);
        for absent in ["segmentation", "keypoints", "num_keypoints"] {
            assert!(!annotation.contains_key(absent), "{absent}");
        }
        assert!(json(dataset.layout().manifest()).get("semantic_classes").is_none());
    }

    #[test]
    fn who_has_no_pixel_is_not_annotated() {
        let dir = tempfile::tempdir().unwrap();
        let dataset = create(dir.path(), sample::all_outputs());
        let mut labels = sample::labels(0, 2);
        for id in labels.instance_ids.as_mut().unwrap() {
            *id = if *id == 1 { 0 } else { *id };
        }
        let encoded =
            dataset.encode(&sample::scene(0), Some(&sample::picture(0)), &labels, &[]).unwrap();
        encoded.stage().unwrap().commit().unwrap();
        dataset.finish(&report(0..1, [0])).unwrap();
        let index = json(dataset.layout().annotations());
        assert_eq!(index["annotations"].as_array().unwrap().len(), 1);
        assert_eq!(index["annotations"][0]["figurant"]["instance"], 2);
    }

    #[test]
    fn the_order_of_completion_leaves_no_trace() {
        let orders: [&[u32]; 3] =
            [&[0, 1, 2, 3, 4, 10, 11], &[11, 3, 1, 4, 10, 0, 2], &[10, 2, 11, 0, 4, 3, 1]];
        let trees: Vec<_> = orders
            .map(|order| {
                let dir = tempfile::tempdir().unwrap();
                let dataset = create(dir.path(), sample::all_outputs());
                for &frame in order {
                    commit(&dataset, frame, (frame % 4) as u16);
                }
                dataset.finish(&report(0..12, order.iter().copied())).unwrap();
                let index = json(dataset.layout().annotations());
                let id = |v: &Value| v["id"].as_u64().unwrap();
                for list in ["images", "annotations"] {
                    assert!(
                        index[list].as_array().unwrap().windows(2).all(|w| id(&w[0]) < id(&w[1])),
                        "{list}"
                    );
                }
                assert_eq!(
                    json(dataset.layout().manifest())["frames_done"],
                    serde_json::json!([[0, 5], [10, 12]])
                );
                tree(dir.path())
            })
            .into();
        assert!(trees.iter().all(|t| *t == trees[0]));
    }

    #[test]
    fn ids_are_unique_and_exact_in_doubles() {
        let mut seen = std::collections::BTreeSet::new();
        for frame in [0, 1, 2, 65_535, 65_536, u32::MAX] {
            for instance in [1, 2, 999, 1000, 1001, u16::MAX] {
                let id = annotation_id(frame, instance);
                assert!(seen.insert(id));
                assert!(id < 1 << 53);
            }
        }
    }

    #[test]
    fn a_killed_run_leaves_only_whole_frames() {
        let dir = tempfile::tempdir().unwrap();
        let dataset = create(dir.path(), sample::all_outputs());
        commit(&dataset, 0, 1);
        let before = tree(dir.path());
        let encoded = dataset
            .encode(&sample::scene(1), Some(&sample::picture(1)), &sample::labels(1, 2), &[])
            .unwrap();
        // Killed while staging: temporary names, which a drop removes and a new run clears.
        let staged = encoded.stage().unwrap();
        let hidden = |name: &str| name.rsplit('/').next().unwrap().starts_with('.');
        let now = tree(dir.path());
        assert!(now.keys().filter(|name| !before.contains_key(*name)).all(|name| hidden(name)));
        assert_eq!(now.len(), before.len() + encoded.files().len());
        drop(staged);
        assert_eq!(tree(dir.path()), before);
        dataset.finish(&report(0..2, [0])).unwrap();
        assert_eq!(json(dataset.layout().annotations())["images"].as_array().unwrap().len(), 1);
        assert!(
            dataset.layout().frame_file(FrameFile::Fragment, 0).is_file(),
            "kept to go on from"
        );
    }

    #[test]
    fn a_folder_that_is_not_empty_is_refused_or_overwritten() {
        let dir = tempfile::tempdir().unwrap();
        let dataset = create(dir.path(), sample::all_outputs());
        for frame in 0..3 {
            commit(&dataset, frame, 1);
        }
        fs::write(dir.path().join("images/.000009.png.tmp"), "half a file").unwrap();
        fs::write(dir.path().join("images/holiday.jpg"), "not ours").unwrap();
        fs::write(dir.path().join("notes.txt"), "not ours").unwrap();
        let info = sample::info(Outputs::from([Output::Box2d]), PictureFormat::DEFAULT);
        let before = tree(dir.path());
        let error = Dataset::create(dir.path(), info.clone(), Existing::Refuse).unwrap_err();
        assert!(matches!(error, ExportError::NotEmpty(_)), "{error}");
        assert!(error.to_string().contains("--overwrite"));
        assert_eq!(tree(dir.path()), before);
        Dataset::create(dir.path(), info, Existing::Overwrite).unwrap();
        let names: Vec<_> = tree(dir.path()).into_keys().collect();
        assert_eq!(names, ["config.json", "images/holiday.jpg", "manifest.json", "notes.txt"]);
    }

    #[test]
    fn files_under_our_names_are_safe_without_our_manifest() {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join("images")).unwrap();
        let path = dir.path().join("images/000001.jpg");
        fs::write(&path, "a holiday").unwrap();
        let info = sample::info(sample::all_outputs(), PictureFormat::DEFAULT);
        let error = Dataset::create(dir.path(), info.clone(), Existing::Overwrite).unwrap_err();
        assert!(matches!(&error, ExportError::NotOurs(p) if *p == path), "{error}");
        assert_eq!(tree(dir.path()).len(), 1);
        fs::rename(&path, dir.path().join("images/me.jpg")).unwrap();
        Dataset::create(dir.path(), info, Existing::Overwrite).unwrap();
    }

    #[test]
    fn places_that_cannot_hold_a_data_set_are_named() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("file");
        fs::write(&file, "x").unwrap();
        let info = sample::info(sample::all_outputs(), PictureFormat::DEFAULT);
        let error = Dataset::create(&file, info.clone(), Existing::Overwrite).unwrap_err();
        assert!(matches!(&error, ExportError::NotAFolder(p) if *p == file), "{error}");
        let below = file.join("out");
        let error = Dataset::create(&below, info, Existing::Refuse).unwrap_err().to_string();
        assert!(error.starts_with(below.to_str().unwrap()), "{error}");
        assert_eq!(fs::read(&file).unwrap(), b"x");
    }

    #[test]
    fn unsound_labels_are_refused_with_their_frame() {
        let dir = tempfile::tempdir().unwrap();
        let dataset = create(dir.path(), sample::all_outputs());
        type Spoil = fn(&mut Annotations);
        let spoils: [(Spoil, &str); 8] = [
            (
                |l| l.people[0].keypoints.as_mut().unwrap()[3].camera_m[1] = f64::NAN,
                "left_ear of instance 1",
            ),
            (|l| l.people[1].bbox = Some([0.0, f64::INFINITY, 1.0, 1.0]), "box of instance 2"),
            (|l| l.camera.t[0] = f64::NAN, "camera"),
            (|l| l.people.swap(0, 1), "ascend"),
            (|l| l.people.truncate(1), "shows id 2"),
            (|l| l.people[0].instance = 0, "id 0"),
            (|l| l.instance_ids = None, "the instance picture is wanted"),
            (|l| l.semantic = Some(vec![0; 3]), "class picture"),
        ];
        for (spoil, expected) in spoils {
            let mut labels = sample::labels(5, 2);
            spoil(&mut labels);
            let result = dataset.encode(&sample::scene(5), Some(&sample::picture(5)), &labels, &[]);
            let error = result.unwrap_err();
            assert!(!error.is_storage());
            let error = error.to_string();
            assert!(error.contains(expected), "{error}, expected {expected}");
        }
        let mut scene = sample::scene(5);
        scene.exposure_ev100 = f64::NAN;
        let error = dataset
            .encode(&scene, Some(&sample::picture(5)), &sample::labels(5, 2), &[])
            .unwrap_err();
        assert!(
            error.to_string().contains("frame 5: the scene holds a number that is not finite"),
            "{error}"
        );
    }

    #[test]
    fn a_point_behind_the_camera_may_lack_an_image_position() {
        let dir = tempfile::tempdir().unwrap();
        let dataset = create(dir.path(), sample::all_outputs());
        let mut labels = sample::labels(0, 1);
        labels.people[0].keypoints.as_mut().unwrap()[5].image_px = [f64::NAN; 2];
        dataset.encode(&sample::scene(0), Some(&sample::picture(0)), &labels, &[]).unwrap();
    }

    #[test]
    fn the_report_lists_what_is_missing() {
        let dir = tempfile::tempdir().unwrap();
        let dataset = create(dir.path(), Outputs::from([Output::Box2d]));
        commit(&dataset, 1, 1);
        let failed = |frame| FailedFrame { frame, reason: "no".to_owned() };
        let report = Report { failed: vec![failed(2), failed(0)], ..report(0..3, [1]) };
        dataset.finish(&report).unwrap();
        let written = json(dataset.layout().report());
        assert_eq!(written["frames_done"], 1);
        assert_eq!(written["failed"][0]["frame"], 0);
        assert_eq!(written["failed"][1]["reason"], "no");
    }
}
