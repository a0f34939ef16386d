//! Shaders of a folder: taken when they change, kept out when they are wrong.

use std::fs;
use std::path::Path;
use std::sync::mpsc::{Receiver, channel};

use figurant_core::engine::gpu::{GpuEngine, GpuOptions, ShaderFolder, ShaderProblem};
use figurant_core::plan::Output;
use figurant_tests::drawlists::mixed;
use tempfile::TempDir;

use super::common::*;

/// A copy of the program's shaders, and what is told of it.
struct Copy {
    dir: TempDir,
    told: Receiver<ShaderProblem>,
    folder: ShaderFolder,
}

impl Copy {
    fn new() -> Self {
        let dir = tempfile::tempdir().unwrap();
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shaders");
        fs::create_dir(dir.path().join("shared")).unwrap();
        for part in ["", "shared"] {
            for entry in fs::read_dir(from.join(part)).unwrap() {
                let path = entry.unwrap().path();
                if path.is_file() {
                    let to = dir.path().join(part).join(path.file_name().unwrap());
                    fs::copy(&path, to).unwrap();
                }
            }
        }
        let (sender, told) = channel();
        let folder = ShaderFolder::new(dir.path().to_owned(), move |problem| {
            sender.send(problem.clone()).unwrap();
        });
        Self { dir, told, folder }
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.dir.path().join(name)).unwrap()
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.dir.path().join(name), text).unwrap();
    }

    fn problems(&self) -> Vec<ShaderProblem> {
        self.told.try_iter().collect()
    }
}

/// The shader of pictures, which turns into a negative where this is replaced.
const SHADE: &str = "shade.wgsl";
const STORED: &str = "picture[pixel] = ";

#[test]
fn shaders_of_a_folder_are_taken_while_they_are_good() {
    let Some(options) = options() else { return };
    let copy = Copy::new();
    let shaders = Some(copy.folder.clone());
    let mut engine = GpuEngine::new(GpuOptions { shaders, ..options.clone() }).unwrap();
    let list = mixed(430, 4);
    let outputs = &[Output::Rgb, Output::Instance];
    let own = by_gpu(&mut engine, &list, outputs);
    assert_eq!(copy.problems(), [], "the program's own shaders are good");

    // One that does not parse: the picture stays, and it is told where and once.
    let shade = copy.read(SHADE);
    copy.write(SHADE, &format!("{shade}fn wrong( {{\n"));
    for _ in 0..2 {
        assert!(by_gpu(&mut engine, &list, outputs) == own, "a broken shader was taken");
    }
    let problems = copy.problems();
    assert_eq!(problems.len(), 1, "{problems:?}");
    assert_eq!(problems[0].file, copy.dir.path().join(SHADE));
    assert_eq!(problems[0].line, Some(shade.lines().count() as u32 + 1), "{}", problems[0]);

    // One that is valid, but that no device can give its buffers to.
    let greedy = "@group(0) @binding(30) var<storage, read> more: array<u32>;\n";
    let reads = shade.replace(STORED, "picture[pixel] = more[pixel] + ");
    copy.write(SHADE, &format!("{reads}{greedy}"));
    for _ in 0..2 {
        assert!(by_gpu(&mut engine, &list, outputs) == own, "a shader that is refused was taken");
    }
    // Not even by engines that share the folder and take what is valid from the start.
    let shaders = Some(copy.folder.clone());
    let mut second = GpuEngine::new(GpuOptions { shaders, ..options }).unwrap();
    assert!(by_gpu(&mut second, &list, outputs) == own, "a shader that is refused was taken");
    let problems = copy.problems();
    assert_eq!(problems.len(), 1, "{problems:?}");
    assert_eq!(problems[0].file, copy.dir.path().join(SHADE));

    // A visible change: a negative, and what the shader says nothing of is as it was.
    assert!(shade.contains(STORED));
    copy.write(SHADE, &shade.replace(STORED, "picture[pixel] = ~"));
    let negative = by_gpu(&mut engine, &list, outputs);
    assert!(negative.object_ids == own.object_ids && negative.depth_m == own.depth_m);
    let pairs = negative.picture.as_ref().unwrap().iter().zip(own.picture.as_ref().unwrap());
    assert!(pairs.clone().all(|(a, b)| *a == !*b), "not the negative of the picture");

    // It outlives the device.
    engine.lose_device();
    assert!(by_gpu(&mut engine, &list, outputs) == negative);
    copy.write(SHADE, &shade);
    assert!(by_gpu(&mut engine, &list, outputs) == own);
    assert_eq!(copy.problems(), []);
}

#[test]
fn a_folder_that_is_wrong_from_the_start_does_not_stop_the_program() {
    let Some(options) = options() else { return };
    let mut plain = GpuEngine::new(options.clone()).unwrap();
    let list = mixed(431, 1);
    let own = by_gpu(&mut plain, &list, &Output::ALL);
    let copy = Copy::new();
    let edge = copy.read("shared/edge.wgsl");
    copy.write("shared/edge.wgsl", &format!("{edge}\nlet wrong = 1;\n"));
    let shaders = Some(copy.folder.clone());
    let mut engine = GpuEngine::new(GpuOptions { shaders, ..options }).unwrap();
    assert!(by_gpu(&mut engine, &list, &Output::ALL) == own);
    let problems = copy.problems();
    assert_eq!(problems.len(), 1, "{problems:?}");
    assert_eq!(problems[0].file, copy.dir.path().join("shared/edge.wgsl"));
}
