//! What holds for every dressed person.

use super::*;
use crate::geometry::body::rest_body;
use crate::geometry::clothes::Worn;
use crate::geometry::garment::Piece;
use crate::geometry::phenotype::tests::average;
use crate::geometry::pose::PosedSkeleton;
use crate::geometry::shell::Shell;
use crate::geometry::skeleton::trunk;
use crate::geometry::stance::Stance;
use crate::geometry::sway;
use crate::library::pose::Poses;
use crate::scene::{
    Bottom, BottomKind, Headwear, Outer, OuterKind, Placement, Pose, Sex, ShoeKind, Shoes, Top,
    TopKind,
};
use glam::{DQuat, DVec3};

fn outfit(i: usize, x: f64) -> Outfit {
    use BottomKind as B;
    use TopKind as T;
    let tops = [T::TShirt, T::Shirt, T::TankTop, T::Hoodie, T::LongSleeve, T::Polo, T::Sweater];
    let bottoms = [
        B::Shorts,
        B::Trousers,
        B::Jeans,
        B::SkirtShort,
        B::Leggings,
        B::DressLong,
        B::SkirtLong,
        B::DressShort,
    ];
    let bottom = bottoms[i % 8];
    let (color, texture, hue_offset_deg) = ([0.2, 0.3, 0.6], None, 0.0);
    Outfit {
        top: Top {
            kind: tops[i % 7],
            sleeve: 0.15 + 0.8 * x,
            neckline: 1.0 - x,
            looseness_m: 0.004 + 0.02 * x,
            color,
            texture: None,
            relief: None,
            finish: None,
            hue_offset_deg,
        },
        bottom: Bottom {
            kind: bottom,
            length: if bottom == B::Shorts { 0.4 } else { 1.0 - 0.2 * x },
            flare: x,
            looseness_m: 0.02 * (1.0 - x),
            color,
            texture: None,
            relief: None,
            finish: None,
            hue_offset_deg,
        },
        outer: Outer {
            kind: [OuterKind::None, OuterKind::Jacket, OuterKind::Coat][i % 3],
            open: i.is_multiple_of(2),
            looseness_m: 0.01,
            color,
            texture,
            relief: None,
            finish: None,
            hue_offset_deg,
        },
        shoes: Shoes {
            kind: [ShoeKind::Shoes, ShoeKind::Boots, ShoeKind::Sneakers, ShoeKind::Sandals][i % 4],
            color,
            socks: 0.4 * x,
            sock_color: color,
        },
    }
}

fn person(i: usize) -> Person {
    let x = (i % 4) as f64 / 3.0;
    let sex = if i.is_multiple_of(2) { Sex::Male } else { Sex::Female };
    let face = vec![("jawOpen".to_owned(), x), ("nose-hump-incr".to_owned(), 0.4)];
    Person {
        slot: 0,
        identity: None,
        name: None,
        placement: Placement {
            position_m: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            scale: DVec3::ONE,
        },
        body: Body {
            age_years: [2.0, 9.0, 35.0, 80.0, 25.0][i % 5],
            stature_m: [0.88, 1.32, 1.9, 1.6, 1.7][i % 5],
            muscle: x,
            bmi_kg_m2: [18.0, 30.0, 23.0][i % 3],
            ancestry: [x, 1.0 - x, 0.3],
            cup: x,
            ..average(sex)
        },
        look: Look {
            skin_color: [0.5, 0.3, 0.2],
            hair: HairStyle::ALL[i % HairStyle::ALL.len()],
            hair_color: [0.05; 3],
            beard: BeardStyle::ALL[i % BeardStyle::ALL.len()],
            headwear: Headwear {
                kind: HeadwearKind::ALL[i / 3 % HeadwearKind::ALL.len()],
                color: [0.3; 3],
            },
            glasses: Glasses::ALL[i / 2 % Glasses::ALL.len()],
            iris_color: [0.1, 0.05, 0.02],
            freckles: 0.0,
            flush: 0.5,
            face,
        },
        outfit: outfit(i, x),
        pose: Pose::default(),
        seat: None,
    }
}

fn dressed(figure: &Figure, i: usize, lod: usize) -> Dressed {
    let p = person(i);
    let rest = rest_body(figure, &p.body, &p.look.face).unwrap();
    dress(figure, &p, &rest, lod)
}

#[test]
fn nobody_takes_more_than_two_megabytes() {
    let figure = Figure::built_in().unwrap();
    let largest = (0..30).map(|i| (dressed(&figure, i, 0).mesh.size_bytes(), i)).max();
    let (bytes, i) = largest.unwrap();
    assert!(bytes <= 2_000_000, "{bytes} bytes: {:?}", person(i).look.hair);
}

#[test]
fn every_mesh_is_sound() {
    let figure = Figure::built_in().unwrap();
    for i in 0..15 {
        for lod in 0..LOD_COUNT {
            let Dressed { mesh, parts, .. } = dressed(&figure, i, lod);
            let n = mesh.positions.len();
            assert!([mesh.normals.len(), mesh.uvs.len(), mesh.skin.len()] == [n; 3]);
            assert!(mesh.triangles.iter().flat_map(|t| t.get()).all(|v| (v as usize) < n));
            assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()));
            assert!(mesh.uvs.iter().flatten().all(|x| x.is_finite()));
            for (p, normal) in mesh.positions.iter().zip(&mesh.normals) {
                assert!((Vec3::from_array(normal.unit()).length() - 1.0).abs() < 1e-4);
                let far = (Vec3::from_array(*p) - Vec3::from_array(mesh.center)).length();
                assert!(far <= mesh.radius_m * 1.000_001);
            }
            for s in &mesh.skin {
                assert_eq!(s.weights.iter().map(|&w| u32::from(w)).sum::<u32>(), 255);
            }
            let mut next = 0;
            for p in &parts {
                assert_eq!(p.triangles.start, next);
                next = p.triangles.end;
            }
            assert_eq!(next as usize, mesh.triangles.len());
            let low = mesh.positions.iter().map(|p| p[1]).fold(f32::MAX, f32::min);
            assert!(low.abs() < 1e-4, "soles at {low}");
        }
    }
}

#[test]
fn coarser_levels_are_smaller_and_of_the_same_parts() {
    let figure = Figure::built_in().unwrap();
    let all: Vec<Dressed> = (0..LOD_COUNT).map(|k| dressed(&figure, 2, k)).collect();
    for pair in all.windows(2) {
        let size = |d: &Dressed| d.mesh.triangles.len();
        assert!(size(&pair[1]) * 10 < size(&pair[0]) * 7, "{} {}", size(&pair[0]), size(&pair[1]));
    }
    for d in &all[..4] {
        for kind in
            [PartKind::Head, PartKind::Skin, PartKind::Eyes, PartKind::Top, PartKind::Bottom]
        {
            assert!(d.parts.iter().any(|p| p.kind == kind), "{kind:?}");
        }
    }
}

/// Triangles of a layer of the shell, by corners.
fn triangles_of(body: &Evaluated<'_>, layer: &[Vec3]) -> Vec<[Vec3; 3]> {
    let corner = |r: u16| layer[usize::from(body.render[usize::from(r)])];
    body.triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(corner)).collect()
}

/// Whether a ray meets triangles within 20 cm.
fn meets(o: Vec3, d: Vec3, triangles: &[[Vec3; 3]]) -> bool {
    meets_within(0.2, o, d, triangles)
}

fn meets_within(reach_m: f32, o: Vec3, d: Vec3, triangles: &[[Vec3; 3]]) -> bool {
    triangles.iter().any(|&[a, b, c]| {
        if (a - o).length_squared() > (reach_m + 0.1) * (reach_m + 0.1) {
            return false;
        }
        let (e1, e2) = (b - a, c - a);
        let h = d.cross(e2);
        let det = e1.dot(h);
        let s = (o - a) / det;
        let (u, q) = (s.dot(h), s.cross(e1));
        let (v, far) = (d.dot(q), e2.dot(q));
        det.abs() > 1e-12 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..reach_m).contains(&far)
    })
}

/// One person's clothes, to be looked through.
fn with_clothes(
    figure: &Figure,
    i: usize,
    lod: usize,
    look: impl FnOnce(&Evaluated<'_>, &Shell<'_>, &Worn, &Cuts, &RestBody),
) {
    let p = person(i);
    let rest = rest_body(figure, &p.body, &p.look.face).unwrap();
    let cuts = Cuts::new(&p.outfit);
    let body = Evaluated::new(figure, &rest, GroupId::Shell, lod);
    let places = figure.places(GroupId::Shell, body.positions.len() as u32);
    let on = (&body.positions[..], &body.normals[..]);
    let shell = Shell::new(figure, lod, on, places, &rest.heads_m);
    look(&body, &shell, &Worn::new(&shell, &cuts, (&rest.trunk, 56)), &cuts, &rest);
}

/// Skin that is drawn although it is under a garment lies below the cloth: going out along
/// its normal one meets the garment's layer.
#[test]
fn no_skin_shows_through_the_clothes() {
    const TOLERANCE_M: f32 = 0.001;
    let figure = Figure::built_in().unwrap();
    for (i, lod) in (0..14).flat_map(|i| (0..LOD_COUNT).map(move |lod| (i, lod))) {
        with_clothes(&figure, i, lod, |body, _, worn, cuts, rest| {
            let mut skin = Evaluated::new(&figure, rest, GroupId::Skin, lod);
            let on_skin = figure.places(GroupId::Skin, skin.positions.len() as u32);
            let hidden = garment::hidden(&figure, cuts, on_skin, lod);
            let on = (&mut skin.positions[..], &skin.normals[..]);
            garment::tuck(&figure, cuts, on_skin, lod, on, &vec![true; on_skin.len()]);
            let mut layers = vec![(Piece::Top, triangles_of(body, &worn.top))];
            if cuts.wears(Piece::Socks) {
                layers.push((Piece::Socks, triangles_of(body, &worn.feet.socks)));
            }
            if cuts.shoes != ShoeKind::Sandals {
                layers.push((Piece::Shoes, triangles_of(body, &worn.feet.shoes)));
            }
            if let Some(bottom) = &worn.bottom {
                layers.push((Piece::Bottom, triangles_of(body, bottom)));
            }
            let covered = &figure.data().covered;
            let (mut seen, mut outside) = (0, Vec::new());
            // In the fold of the armpit skin meets skin, and the normal leads into the arm.
            let in_fold = |v: usize| {
                let t = figure.template();
                (0.155..0.175).contains(&t.x[v].abs()) && (0.44..0.475).contains(&t.y[v])
            };
            // Some vertices are there for keypoints only.
            let mut used = vec![false; skin.positions.len()];
            for r in skin.triangles {
                used[usize::from(skin.render[usize::from(*r)])] = true;
            }
            let drawn = |v: &usize| used[*v] && !hidden[*v] && covered[*v] != 0 && !in_fold(*v);
            for v in (0..skin.positions.len()).filter(drawn) {
                for (piece, layer) in &layers {
                    if cuts.field(*piece, on_skin[v]) > 0.004 {
                        let (q, n) = (skin.positions[v], skin.normals[v]);
                        seen += 1;
                        if !meets(q - n * TOLERANCE_M, n, layer) {
                            outside.push((*piece, on_skin[v]));
                        }
                    }
                }
            }
            let least = [100, 60, 20, 8, 3][lod];
            assert!(seen >= least, "person {i} level {lod}: only {seen} vertices were tested");
            assert!(outside.is_empty(), "person {i} level {lod}: {outside:?} of {seen}");
        });
    }
}

/// What is left out for being hidden changes nothing of what is drawn, hair that lies on it
/// included.
#[test]
fn skin_that_is_not_evaluated_is_not_missed() {
    let figure = Figure::built_in().unwrap();
    for (i, lod) in (0..6).flat_map(|i| (0..LOD_COUNT).map(move |lod| (i, lod))) {
        let p = Person { look: groomed(HairStyle::LongWavy, 0, 0, 0).look, ..person(i) };
        let rest = rest_body(&figure, &p.body, &p.look.face).unwrap();
        let all = Evaluated::new(&figure, &rest, GroupId::Skin, lod);
        let places = figure.places(GroupId::Skin, all.positions.len() as u32);
        let hidden = garment::hidden(&figure, &Cuts::new(&p.outfit), places, lod);
        let shown = Shown::new(&figure, lod, &hidden, hair::above_y(&p));
        let some = shown.evaluate(&figure, &rest);
        let wanted: Vec<usize> = (0..hidden.len()).filter(|v| shown.wanted[*v]).collect();
        assert!(wanted.len() < hidden.len(), "person {i} level {lod}");
        for v in wanted {
            assert_eq!(some.positions[v], all.positions[v], "person {i} level {lod}");
            assert_eq!(some.normals[v], all.normals[v], "person {i} level {lod}");
        }
        let head = |skin: &[Vec3]| hair::Head::new(&figure, &p, &rest, lod, skin);
        let (one, other) = (head(&all.positions), head(&some.positions));
        for k in 0..400 {
            let at = |n: usize, size: f32| (k * n % 97) as f32 / 97.0 * size;
            let local = Vec3::new(at(31, 0.3) - 0.15, 0.40 + at(53, 0.5), at(71, 0.3) - 0.12);
            let q = one.scalp.frame.world(local);
            assert_eq!(one.near.surface(q), other.near.surface(q), "person {i} level {lod}");
        }
    }
}

/// Average people with every style: hair, beard, headwear and glasses by number.
fn groomed(hair: HairStyle, beard: usize, headwear: usize, glasses: usize) -> Person {
    let sex = if beard > 0 { Sex::Male } else { Sex::Female };
    let mut p = person(1);
    p.body = average(sex);
    p.look.face = Vec::new();
    p.look.hair = hair;
    p.look.beard = BeardStyle::ALL[beard];
    p.look.headwear.kind = HeadwearKind::ALL[headwear];
    p.look.glasses = Glasses::ALL[glasses];
    p
}

fn drawn_triangles(d: &Dressed, kinds: &[PartKind]) -> Vec<[[f32; 3]; 3]> {
    let parts = d.parts.iter().filter(|p| kinds.contains(&p.kind));
    let range = parts.flat_map(|p| p.triangles.clone());
    range
        .map(|t| d.mesh.triangles[t as usize].get().map(|v| d.mesh.positions[v as usize]))
        .collect()
}

fn head_of(figure: &Figure, p: &Person, rest: &RestBody, lod: usize) -> hair::Head {
    let skin = Evaluated::new(figure, rest, GroupId::Skin, lod);
    hair::Head::new(figure, p, rest, lod, &skin.positions)
}

const HAIR: [PartKind; 3] = [PartKind::Hair, PartKind::Locks, PartKind::LightLocks];

#[test]
fn every_style_is_its_own_and_gets_simpler_with_distance() {
    let figure = Figure::built_in().unwrap();
    let mut seen: Vec<Vec<[[f32; 3]; 3]>> = Vec::new();
    for style in HairStyle::ALL {
        let p = groomed(style, 0, 0, 0);
        let rest = rest_body(&figure, &p.body, &p.look.face).unwrap();
        let levels: Vec<_> = (0..LOD_COUNT)
            .map(|lod| drawn_triangles(&dress(&figure, &p, &rest, lod), &HAIR))
            .collect();
        let count: Vec<usize> = levels.iter().map(Vec::len).collect();
        println!("{style:?}: {count:?} triangles");
        assert!(count.iter().all(|n| (*n == 0) == (style == HairStyle::Bald)));
        assert!(style == HairStyle::Bald || count.windows(2).all(|n| n[1] < n[0]), "{style:?}");
        assert!(!seen.contains(&levels[0]), "{style:?}");
        seen.extend(levels.into_iter().take(1));
    }
}

/// Most hair lies outside the skin at rest; what is under it are the roots.
#[test]
fn hair_does_not_pierce_head_or_shoulders() {
    let figure = Figure::built_in().unwrap();
    let mut worst = (0.0, String::new());
    for (i, style) in HairStyle::ALL.into_iter().enumerate().skip(1) {
        for lod in 0..LOD_COUNT {
            let mut p = groomed(style, 0, 0, 0);
            p.body = person(i).body;
            let rest = rest_body(&figure, &p.body, &p.look.face).unwrap();
            let head = head_of(&figure, &p, &rest, lod);
            let s = head.scalp.frame.scale;
            let all = drawn_triangles(&dress(&figure, &p, &rest, lod), &HAIR);
            let points: Vec<Vec3> = all.iter().flatten().map(|q| Vec3::from_array(*q)).collect();
            // Roots are sunk a little, and a level's skin is as far off as it says.
            let depth = 0.006 * s + figure.lod_error_m(lod);
            let deep = |q: &&Vec3| head.near.surface(**q).is_some_and(|f| f.0 < -depth);
            let share = points.iter().filter(deep).count() as f32 / points.len() as f32;
            println!("{style:?} {lod}: {:.2} % of {}", 100.0 * share, points.len());
            if share > worst.0 {
                worst = (share, format!("{style:?} level {lod}"));
            }
        }
    }
    assert!(worst.0 < 0.03, "{worst:?}");
}

#[test]
fn glasses_and_hats_are_the_same_on_both_sides() {
    let figure = Figure::built_in().unwrap();
    for (headwear, glasses) in [(1, 1), (3, 2), (0, 3)] {
        let p = groomed(HairStyle::Bald, 0, headwear, glasses);
        let rest = rest_body(&figure, &p.body, &p.look.face).unwrap();
        for lod in 0..LOD_COUNT {
            let kinds = [PartKind::Headwear, PartKind::Frame, PartKind::Lenses];
            let all = drawn_triangles(&dress(&figure, &p, &rest, lod), &kinds);
            assert!(all.len() > 40, "{headwear} {glasses} {lod}");
            let points: Vec<Vec3> = all.iter().flatten().map(|q| Vec3::from_array(*q)).collect();
            for q in points.iter().step_by(7) {
                let other = *q * Vec3::new(-1.0, 1.0, 1.0);
                let gap = points.iter().map(|r| (*r - other).length()).fold(1.0, f32::min);
                // Tubes of few sides are no mirror images of themselves.
                assert!(gap < 0.004, "{headwear} {glasses} {lod}: {q} {gap}");
            }
        }
    }
}

/// Somebody with hair of a style, at rest and dressed.
fn with_hair(figure: &Figure, i: usize, style: HairStyle) -> (RestBody, Dressed) {
    let mut p = person(i);
    p.look.hair = style;
    let rest = rest_body(figure, &p.body, &p.look.face).unwrap();
    let dressed = dress(figure, &p, &rest, 0);
    (rest, dressed)
}

/// Vertices of parts, once for each triangle.
fn vertices(d: &Dressed, kinds: &[PartKind]) -> impl Iterator<Item = usize> {
    let parts = d.parts.iter().filter(|part| kinds.contains(&part.kind));
    let triangles = parts.flat_map(|part| part.triangles.clone());
    triangles.flat_map(|t| d.mesh.triangles[t as usize].get()).map(|v| v as usize)
}

/// Bounds of what a person covers hold whatever grows and sits on the head.
#[test]
fn reach_bounds_hair_and_hats() {
    let figure = Figure::built_in().unwrap();
    for (i, style) in HairStyle::ALL.into_iter().enumerate() {
        let (rest, d) = with_hair(&figure, i, style);
        let kinds = [&HAIR[..], &[PartKind::Headwear, PartKind::Frame, PartKind::Lenses]];
        for v in vertices(&d, &kinds.concat()) {
            let (q, s) = (Vec3::from_array(d.mesh.positions[v]), &d.mesh.skin[v]);
            // Those of hanging hair have a bound of their own.
            let of_body = |w: &(&u8, &u8)| *w.1 > 0 && usize::from(*w.0) < CLOTH_JOINT_COUNT;
            for (&j, _) in s.joints.iter().zip(&s.weights).filter(of_body) {
                let j = usize::from(j);
                let far = f64::from((q - rest.heads_m[j].as_vec3()).length());
                assert!(far <= rest.reach_m[j], "{style:?} {i} joint {j}: {far}");
            }
        }
    }
}

#[test]
fn no_hair_hangs_farther_than_its_bound() {
    let figure = Figure::built_in().unwrap();
    for (i, style) in HairStyle::ALL.into_iter().enumerate() {
        let (rest, d) = with_hair(&figure, i, style);
        assert!(d.tresses.is_none() || hair_reach_m(style).is_some(), "{style:?}");
        let (Some(tresses), Some(reach_m)) = (&d.tresses, hair_reach_m(style)) else { continue };
        let reach_m = reach_m * rest.head_scale * f64::from(rest.shape.scale);
        for pose in ["pose/standing_at_ease", "pose/handstand", "pose/lying_on_back"] {
            let stance = Stance::of_pose(Poses::built_in().get(pose).unwrap());
            let skeleton = PosedSkeleton::of_stance(&rest.heads_m, &stance);
            let mut joints = skeleton.model_from_rest.to_vec();
            joints.extend(sway::joints(&skeleton, &rest.heads_m));
            joints.extend(tresses.joints(&skeleton, &rest, DVec3::NEG_Y));
            let head_m = skeleton.joint_m(trunk::HEAD, rest.heads_m[trunk::HEAD]);
            for v in vertices(&d, &HAIR) {
                let q = Vec3::from_array(d.mesh.positions[v]).as_dvec3();
                let s = &d.mesh.skin[v];
                let by = |(j, w): (&u8, &u8)| {
                    joints[usize::from(*j)].transform_point3(q) * (f64::from(*w) / 255.0)
                };
                let at: DVec3 = s.joints.iter().zip(&s.weights).map(by).sum();
                let far_m = at.distance(head_m);
                assert!(far_m <= reach_m, "{style:?} {i} {pose}: {far_m} {reach_m}");
            }
        }
    }
}

#[test]
fn beards_sit_on_the_face_and_hats_hide_no_eyes() {
    let figure = Figure::built_in().unwrap();
    for beard in 2..BeardStyle::ALL.len() {
        let p = groomed(HairStyle::Bald, beard, 1 + beard % 4, 0);
        let rest = rest_body(&figure, &p.body, &p.look.face).unwrap();
        let head = head_of(&figure, &p, &rest, 0);
        let d = dress(&figure, &p, &rest, 0);
        let local = |kinds: &[PartKind]| -> Vec<Vec3> {
            let points = drawn_triangles(&d, kinds).into_iter().flatten();
            points.map(|q| head.scalp.frame.local(Vec3::from_array(q))).collect()
        };
        let hairs = local(&HAIR);
        assert!(hairs.len() > 300, "{beard}");
        for q in &hairs {
            assert!((0.56..0.76).contains(&q.y) && q.z > 0.0, "{beard} {q}");
        }
        let before_the_eyes =
            |q: &&Vec3| q.x.abs() < 0.05 && q.z > 0.06 && (0.70..0.745).contains(&q.y);
        assert_eq!(local(&[PartKind::Headwear]).iter().filter(before_the_eyes).count(), 0);
    }
}

/// A garment lies below the one that is worn over it, wherever both are.
#[test]
fn no_garment_shows_through_another() {
    let figure = Figure::built_in().unwrap();
    for (i, lod) in (0..14).flat_map(|i| (0..LOD_COUNT).map(move |lod| (i, lod))) {
        with_clothes(&figure, i, lod, |body, shell, worn, cuts, _| {
            let mut pairs = Vec::new();
            if let (Some(bottom), false) = (&worn.bottom, cuts.tucked()) {
                pairs.push((Piece::Bottom, bottom, Piece::Top, &worn.top));
            }
            if let Some(outer) = &worn.outer {
                pairs.push((Piece::Top, &worn.top, Piece::Outer, outer));
            }
            for (under, low, over, high) in pairs {
                let triangles = triangles_of(body, high);
                let (mut seen, mut outside) = (0, 0);
                for (v, at) in shell.places.iter().enumerate() {
                    let both = cuts.field(under, *at).min(cuts.field(over, *at));
                    if both > 0.01 {
                        seen += 1;
                        // The shell's normals, along which the layers were raised.
                        let n = body.normals[v];
                        let below = (high[v] - low[v]).dot(n) >= 0.002;
                        outside += usize::from(!below && !meets(low[v], n, &triangles));
                    }
                }
                assert!(seen > 0, "person {i} level {lod}: {under:?} is not under {over:?}");
                assert!(outside == 0, "person {i} level {lod}: {outside} of {seen} {under:?}");
            }
        });
    }
}

/// At rest no leg stands outside a skirt: going outwards from any part of it one meets cloth.
#[test]
fn no_leg_stands_outside_a_skirt() {
    let figure = Figure::built_in().unwrap();
    let mut skirts = 0;
    for (i, lod) in (0..16).flat_map(|i| [0, 2, 4].map(|lod| (i, lod))) {
        with_clothes(&figure, i, lod, |body, shell, worn, cuts, _| {
            let Some(skirt) = &worn.skirt else { return };
            skirts += 1;
            let triangles = skirt.triangles();
            let ys = || skirt.positions.iter().map(|p| p.y);
            let (low, high) = (ys().fold(f32::MAX, f32::min), ys().fold(f32::MIN, f32::max));
            let inside = low + 0.06..high - 0.08;
            for (v, p) in body.positions.iter().enumerate() {
                let at = shell.places[v];
                if at.arm > 0.0 || at.leg > cuts.leg_end - 0.1 || !inside.contains(&p.y) {
                    continue;
                }
                let out = Vec3::new(p.x, 0.0, p.z - shell.heads_m[0].z as f32);
                let out = out.normalize_or(Vec3::Z);
                let within = meets_within(0.8, *p, out, &triangles);
                assert!(within, "person {i} level {lod}: {at:?}");
            }
        });
    }
    assert!(skirts > 12);
}

#[test]
fn whoever_shares_a_key_shares_the_mesh() {
    let p = person(4);
    let key = MeshKey::new(&p);
    let mut elsewhere = p.clone();
    elsewhere.pose.phase = 0.5;
    elsewhere.placement.position_m = DVec3::X;
    elsewhere.outfit.top.color = [0.9; 3];
    assert_eq!(MeshKey::new(&elsewhere), key);
    let changes: [fn(&mut Person); 15] = [
        |p| p.body.cup += 1e-9,
        |p| p.body.sex = Sex::Female,
        |p| p.look.face[1].1 += 0.01,
        |p| p.look.hair = HairStyle::Short,
        |p| p.look.beard = BeardStyle::Goatee,
        |p| p.look.headwear.kind = HeadwearKind::Beanie,
        |p| p.look.glasses = Glasses::Sunglasses,
        |p| p.outfit.bottom.kind = BottomKind::SkirtLong,
        |p| p.outfit.top.sleeve += 0.01,
        |p| p.outfit.top.kind = TopKind::Sweater,
        |p| p.outfit.bottom.flare += 0.01,
        |p| p.outfit.outer.kind = OuterKind::None,
        |p| p.outfit.outer.open ^= true,
        |p| p.outfit.shoes.kind = ShoeKind::Barefoot,
        |p| p.outfit.shoes.socks += 0.01,
    ];
    for (i, change) in changes.into_iter().enumerate() {
        let mut other = p.clone();
        change(&mut other);
        assert!(other == p || MeshKey::new(&other) != key, "{i}");
    }
}

#[test]
fn the_same_person_gives_the_same_bits() {
    let figure = Figure::built_in().unwrap();
    assert_eq!(dressed(&figure, 4, 1), dressed(&figure, 4, 1));
}
