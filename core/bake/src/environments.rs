//! Pictures of all directions into one file.

use std::path::Path;

use figurant_core::library::environment::equirect::Equirect;
use figurant_core::library::environment::pack;
use glam::Vec3;

use crate::BakeError;

/// Width that pictures are packed in.
const WIDTH: usize = 512;
/// Side of the squares that the sources' compression works on.
const BLOCK: usize = 8;
/// Brighter than this many times the mean, a square's colours are noise of that compression.
const GLARE: f32 = 60.0;

/// Packs all .exr files of a folder, in the order of their names, and hands back the size.
pub fn bake_environments(dir: &Path, out: &Path) -> Result<usize, BakeError> {
    let io = |path: &Path| {
        let path = path.to_owned();
        move |source| BakeError::Io { path, source }
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(dir).map_err(io(dir))? {
        let path = entry.map_err(io(dir))?.path();
        if path.extension().is_some_and(|e| e == "exr") {
            paths.push(path);
        }
    }
    paths.sort();
    let mut pictures = Vec::new();
    for path in &paths {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let picture = without_glare_noise(read(path)?).resized(WIDTH);
        let packed = zstd::encode_all(pack::planes(&picture).as_slice(), 19).map_err(io(out))?;
        pictures.push((name, WIDTH, packed));
    }
    let file = pack::file(&pictures);
    std::fs::write(out, &file).map_err(io(out))?;
    Ok(file.len())
}

fn read(path: &Path) -> Result<Equirect, BakeError> {
    let picture = image::open(path).map_err(|e| BakeError::content(path, e.to_string()))?;
    if picture.width() != picture.height() * 2 {
        return Err(BakeError::content(path, "is not twice as wide as high"));
    }
    let width = picture.width() as usize;
    let rgb = picture.into_rgb32f().into_raw();
    Ok(Equirect { width, pixels: rgb.as_chunks().0.iter().map(|p| Vec3::from_array(*p)).collect() })
}

/// The sources' compression rings round the sun, within its square: below zero and in all colours.
/// There light is made grey, and not darker than the square's rim.
fn without_glare_noise(mut picture: Equirect) -> Equirect {
    let luminance = |p: Vec3| p.dot(Vec3::new(0.2126, 0.7152, 0.0722));
    let (width, height) = (picture.width, picture.height());
    let mean = picture.pixels.iter().map(|p| luminance(*p)).sum::<f32>() / (width * height) as f32;
    for top in (0..height).step_by(BLOCK) {
        for left in (0..width).step_by(BLOCK) {
            let inside = |i: usize| (top + i / BLOCK) * width + left + i % BLOCK;
            let all = 0..BLOCK * BLOCK;
            if !all.clone().any(|i| luminance(picture.pixels[inside(i)]) > GLARE * mean) {
                continue;
            }
            let mut rim = Vec::new();
            for k in 0..BLOCK {
                let (x, y) = (left + k, top + k);
                let column = |x: usize| x % width;
                rim.push(top.saturating_sub(1) * width + x);
                rim.push((top + BLOCK).min(height - 1) * width + x);
                rim.push(y * width + column(left + width - 1));
                rim.push(y * width + column(left + BLOCK));
            }
            let around = rim.iter().map(|at| picture.pixels[*at].max(Vec3::ZERO));
            let around = around.sum::<Vec3>() / rim.len() as f32;
            for i in all {
                let pixel = &mut picture.pixels[inside(i)];
                let light = luminance(*pixel);
                *pixel = if light > luminance(around) {
                    around * (light / luminance(around).max(1e-6))
                } else {
                    around
                };
            }
        }
    }
    picture.pixels.iter_mut().for_each(|p| *p = p.max(Vec3::ZERO));
    picture
}
