//! `figurant gallery`: a page of pictures from a list of configs.
//!
//! The list says which frames of which configs, whole or cut out round one person, under which
//! heading and with which words. Out come a Markdown page and its PNG pictures, so that what the
//! page shows is what the program makes today.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use figurant_core::base::color::{linear_from_srgb, srgb_from_linear};
use figurant_core::export::atomic;
use figurant_core::export::picture::{self, PictureFormat};
use figurant_core::job::{FrameMaker, RenderedFrame};
use figurant_core::plan::Output;
use serde::Deserialize;

use crate::args::GalleryArgs;
use crate::commands::{not_loaded, processors};
use crate::road::{Road, Wishes};
use crate::{Console, Exit, Failure};

/// JPEG quality of thumbnails.
const THUMBNAIL_QUALITY: u8 = 85;
/// Free space round a person who is cut out, as a share of the person's longer side.
const MARGIN: f64 = 0.08;

/// The page as the list's file has it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Page {
    title: String,
    #[serde(default)]
    text: String,
    /// Name of the page's file.
    #[serde(default = "default_file")]
    file: String,
    /// Folder of the pictures, from the page's.
    #[serde(default)]
    pictures_in: PathBuf,
    /// Pictures become JPEG, divided by a whole number to a height of at least this many pixels;
    /// PNG of full size if absent.
    #[serde(default)]
    thumbnail_px: Option<u32>,
    sections: Vec<Section>,
}

fn default_file() -> String {
    "index.md".to_owned()
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    title: String,
    #[serde(default)]
    text: String,
    pictures: Vec<Picture>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Picture {
    /// Path of a config, from the list's folder.
    config: PathBuf,
    #[serde(default)]
    frame: u32,
    /// The instance to cut out; the whole frame if absent.
    #[serde(default)]
    person: Option<u16>,
    /// What to cut out instead: left, top, width and height in pixels.
    #[serde(default, rename = "crop_px")]
    crop: Option<[u32; 4]>,
    #[serde(default)]
    caption: String,
}

/// Renders all pictures and writes the page.
pub fn run<R: Road>(
    road: &R,
    args: &GalleryArgs,
    console: &mut Console<'_>,
) -> Result<Exit, Failure> {
    let page = read(&args.list)?;
    let pictures_in = args.out.join(&page.pictures_in);
    std::fs::create_dir_all(&pictures_in)
        .map_err(|e| Failure::input(format!("--out {}: {e}", pictures_in.display())))?;
    let folder = args.list.parent().unwrap_or(Path::new(""));
    let mut makers = BTreeMap::new();
    let mut text = format!("# {}\n\n{}", page.title, paragraph(&page.text));
    for section in &page.sections {
        text += &format!("## {}\n\n{}", section.title, paragraph(&section.text));
        for entry in &section.pictures {
            let config = folder.join(&entry.config);
            if !makers.contains_key(&entry.config) {
                makers.insert(entry.config.clone(), maker(road, &config, args)?);
            }
            let Some(maker) = makers.get_mut(&entry.config) else { continue };
            let name = write_picture(maker, &config, entry, &page, &pictures_in)?;
            let name = page.pictures_in.join(name);
            let name = name.to_string_lossy();
            text += &format!("![{}]({name})", entry.caption);
            // Pictures without words stand side by side.
            text += if entry.caption.is_empty() { "\n" } else { "\n\n" };
            text += &paragraph(&entry.caption);
            console.note(&format!("{} frame {} -> {name}", config.display(), entry.frame));
        }
        text = format!("{}\n\n", text.trim_end());
    }
    let out = args.out.join(&page.file);
    atomic::write(&out, format!("{}\n", text.trim_end()).as_bytes()).map_err(Failure::input)?;
    console.note(&format!("gallery -> {}", out.display()));
    Ok(Exit::Done)
}

fn read(list: &Path) -> Result<Page, Failure> {
    let failed = |e: &dyn std::fmt::Display| Failure::input(format!("{}: {e}", list.display()));
    let bytes = std::fs::read(list).map_err(|e| failed(&e))?;
    serde_json::from_slice(&bytes).map_err(|e| failed(&e))
}

fn paragraph(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("{text}\n\n") }
}

fn maker<R: Road>(road: &R, config: &Path, args: &GalleryArgs) -> Result<R::Maker, Failure> {
    let wishes = Wishes::from(&args.changes).only([Output::Rgb, Output::Box2d]);
    let job = road.load(config, &wishes).map_err(|e| not_loaded(config, e))?;
    road.maker(&job, processors()).map_err(|e| Failure::new(Exit::NoEngine, e))
}

/// Renders one picture into the folder and gives its file name.
fn write_picture<M: FrameMaker>(
    maker: &mut M,
    config: &Path,
    entry: &Picture,
    page: &Page,
    out: &Path,
) -> Result<String, Failure> {
    let frame = entry.frame;
    let failed = |reason: &dyn std::fmt::Display| {
        Failure::new(Exit::SomeFailed, format!("{} frame {frame}: {reason}", config.display()))
    };
    let made = maker.make(frame).map_err(|e| failed(&e))?;
    let stem = config.file_stem().map_or_else(|| "picture".into(), |s| s.to_string_lossy());
    let ending = if page.thumbnail_px.is_some() { "jpg" } else { "png" };
    let (name, view) = match (entry.crop, entry.person) {
        (Some(crop), _) => {
            let [x, y, w, h] = crop;
            let view = within(whole(&made), crop).ok_or_else(|| failed(&outside(&made, crop)))?;
            (format!("{stem}-{frame}-at-{x}-{y}-{w}-{h}.{ending}"), view)
        }
        (None, None) => (format!("{stem}-{frame}.{ending}"), whole(&made)),
        (None, Some(id)) => {
            let view = person(&made, id).ok_or_else(|| failed(&no_person(&made, id)))?;
            (format!("{stem}-{frame}-{id}.{ending}"), view)
        }
    };
    let pixels = made.picture.as_deref().ok_or_else(|| failed(&"no picture was made"))?;
    let (pixels, [width, height]) = cut(pixels, made.annotations.width, view);
    let bytes = match page.thumbnail_px {
        Some(least) => {
            let (pixels, [width, height]) = reduced(&pixels, [width, height], least);
            PictureFormat::Jpeg(THUMBNAIL_QUALITY).encode(&pixels, width, height)
        }
        None => picture::png_rgb(&pixels, width, height),
    };
    let bytes = bytes.map_err(|e| failed(&e))?;
    atomic::write(&out.join(&name), &bytes).map_err(Failure::input)?;
    Ok(name)
}

/// Left, top, right and bottom in pixels.
type View = [u32; 4];

fn whole(made: &RenderedFrame) -> View {
    [0, 0, made.annotations.width, made.annotations.height]
}

/// A crop as a view, if it is not empty and lies within the picture.
fn within([_, _, width, height]: View, [x, y, w, h]: [u32; 4]) -> Option<View> {
    let (right, bottom) = (x.checked_add(w)?, y.checked_add(h)?);
    (w > 0 && h > 0 && right <= width && bottom <= height).then_some([x, y, right, bottom])
}

fn outside(made: &RenderedFrame, crop: [u32; 4]) -> String {
    let [_, _, width, height] = whole(made);
    format!("crop_px {crop:?} does not lie within the picture, which is {width} by {height}")
}

/// A person's box with a margin, within the picture.
fn person(made: &RenderedFrame, id: u16) -> Option<View> {
    let labels = &made.annotations;
    let [x, y, w, h] = labels.people.iter().find(|p| p.instance == id)?.bbox?;
    let margin = MARGIN * w.max(h);
    let within = |v: f64, end: u32| v.clamp(0.0, f64::from(end)) as u32;
    Some([
        within((x - margin).floor(), labels.width),
        within((y - margin).floor(), labels.height),
        within((x + w + margin).ceil(), labels.width),
        within((y + h + margin).ceil(), labels.height),
    ])
}

fn no_person(made: &RenderedFrame, id: u16) -> String {
    let ids: BTreeSet<String> =
        made.annotations.people.iter().map(|p| p.instance.to_string()).collect();
    let ids: Vec<String> = ids.into_iter().collect();
    format!("no person {id} is in the picture; there are {}", ids.join(", "))
}

/// The pixels of a view, and its width and height.
fn cut(rgb: &[u8], width: u32, [left, top, right, bottom]: View) -> (Vec<u8>, [u32; 2]) {
    let row = width as usize * 3;
    let span = left as usize * 3..right as usize * 3;
    let rows = rgb.chunks_exact(row).take(bottom as usize).skip(top as usize);
    let pixels = rows.flat_map(|line| line[span.clone()].iter().copied()).collect();
    (pixels, [right - left, bottom - top])
}

/// The picture divided by the largest whole number that leaves its height at `least`: means in
/// linear light.
fn reduced(rgb: &[u8], [width, height]: [u32; 2], least: u32) -> (Vec<u8>, [u32; 2]) {
    let step = (height / least.max(1)).clamp(1, width);
    let (w, h) = (width / step, height / step);
    let linear: [f32; 256] = std::array::from_fn(|v| linear_from_srgb(v as f32 / 255.0));
    let mut out = Vec::with_capacity((w * h * 3) as usize);
    for (y, x) in (0..h).flat_map(|y| (0..w).map(move |x| (y, x))) {
        for channel in 0..3 {
            let places =
                (0..step * step).map(|k| (y * step + k / step) * width + x * step + k % step);
            let sum: f32 = places.map(|at| linear[rgb[at as usize * 3 + channel] as usize]).sum();
            let mean = sum / (step * step) as f32;
            out.push((srgb_from_linear(mean) * 255.0).round() as u8);
        }
    }
    (out, [w, h])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thumbnails_are_means_in_linear_light() {
        let rgb = [[0; 3], [255, 128, 0], [255; 3], [0, 128, 255]].concat();
        // Half the light of white is 188 of 255.
        assert_eq!(reduced(&rgb, [2, 2], 1), (vec![188, 161, 188], [1, 1]));
        assert_eq!(reduced(&rgb, [2, 2], 2), (rgb.clone(), [2, 2]));
        assert_eq!(reduced(&rgb, [4, 1], 3), (rgb, [4, 1]));
    }

    #[test]
    fn views_are_cut_out_exactly() {
        let rgb: Vec<u8> = (0..4 * 3 * 3).collect();
        let (pixels, size) = cut(&rgb, 4, [1, 1, 3, 3]);
        assert_eq!(size, [2, 2]);
        assert_eq!(pixels, [15, 16, 17, 18, 19, 20, 27, 28, 29, 30, 31, 32]);
    }

    #[test]
    fn crops_lie_within_the_picture() {
        let whole = [0, 0, 40, 30];
        assert_eq!(within(whole, [10, 5, 30, 25]), Some([10, 5, 40, 30]));
        for wrong in [[10, 5, 31, 25], [10, 6, 30, 25], [0, 0, 0, 9], [u32::MAX, 0, 2, 2]] {
            assert_eq!(within(whole, wrong), None, "{wrong:?}");
        }
    }

    #[test]
    fn lists_with_unknown_keys_are_refused() {
        let text = r#"{"title": "a", "sections": [{"title": "b", "picture": []}]}"#;
        let error = serde_json::from_str::<Page>(text).unwrap_err().to_string();
        assert!(error.contains("unknown field `picture`"), "{error}");
    }
}
