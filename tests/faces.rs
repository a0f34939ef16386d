//! Whether random faces are different people, by the measure that forensic studies of real faces use.
//!
//! Gibelli and colleagues laid scans of faces over each other ("3D-3D facial superimposition between
//! monozygotic twins: a novel morphological approach to the assessment of differences due to
//! environmental factors", Legal Medicine 31, 2018): the root mean square of the distances from
//! the points of one to the other was 1.0 mm (standard deviation 0.3) for two scans of one person,
//! 1.9 mm (0.5) for identical twins and 3.4 mm (0.7) for two unrelated people. So two of our faces
//! are two people if they lie farther apart than two scans of one person, even with their size,
//! which the study leaves in, taken out; and a population is as varied as a real one if its mean is
//! that of unrelated people within a standard deviation. The faces are blank, of one sex and of about
//! one age; the study's were of both sexes and from 25 to 69.

use figurant_core::document::{Document, file};
use figurant_core::geometry::body::rest_body;
use figurant_core::geometry::phenotype::evaluate;
use figurant_core::job;
use figurant_core::library::Library;
use figurant_core::library::figure::{Figure, GroupId};
use figurant_core::sampling::Sampler;
use figurant_core::scene::Person;
use glam::{DMat3, DQuat, DVec3};

/// As many as stand in the line-up.
const FACES: usize = 14;
/// Two scans of one person.
const SAME_MM: f64 = 1.0;
/// Two people, and the standard deviation.
const UNRELATED_MM: (f64, f64) = (3.4, 0.7);

/// People of one sex and of about one age.
fn drawn(sex: &str, seed: u64) -> Vec<Person> {
    let document = serde_json::json!({
        "version": 1,
        "seed": seed,
        "people": {
            "identities": null,
            "placement": {"mode": "row", "count": FACES, "spacing_m": 1},
            "body": {"age_years": {"uniform": [28, 34]}, "sex": sex},
            "look": {"expression": {"enabled": false}},
        },
    });
    let document: Document = file::parse(&document.to_string()).expect("a valid document");
    let library = Library::new(&[], 1024).expect("built-in assets load");
    let catalogue = job::catalogue(&library);
    Sampler::new(document.into(), catalogue).expect("a valid document").scene(0).people
}

/// Points of a face and the normals of its surface there, millimetres.
#[derive(Clone)]
struct Scan {
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
}

/// The vertices that a scanner in front of the face sees, from the chin to the hair and from ear to
/// ear: on the template, those that have no other close in front of them.
fn face_vertices(figure: &Figure) -> Vec<usize> {
    let skin = figure.vertices(GroupId::Skin, figure.group(GroupId::Skin).lods[0].vertices);
    let template = figure.template();
    let at =
        |v: usize| DVec3::from_array([template.x[v], template.y[v], template.z[v]].map(f64::from));
    let front: Vec<(usize, DVec3)> = skin
        .clone()
        .map(|v| (v - skin.start, at(v)))
        .filter(|(_, p)| (0.645..0.80).contains(&p.y) && p.z > 0.07)
        .collect();
    let covers =
        |a: DVec3, b: DVec3| b.z > a.z + 0.008 && (a.truncate() - b.truncate()).length() < 0.0035;
    let seen = |p: DVec3| !front.iter().any(|(_, other)| covers(p, *other));
    front.iter().filter(|(_, p)| seen(*p)).map(|(v, _)| *v).collect()
}

fn scan(figure: &Figure, person: &Person, vertices: &[usize]) -> Scan {
    let rest = rest_body(figure, &person.body, &person.look.face).expect("sampled targets exist");
    let group = figure.group(GroupId::Skin);
    let level = &group.lods[0];
    let skin = evaluate(figure, &rest.shape, figure.vertices(GroupId::Skin, level.vertices));
    let at = |v: usize| 1000.0 * DVec3::from_array(skin[v].map(f64::from));
    let mut normals = vec![DVec3::ZERO; skin.len()];
    for t in level.triangles.chunks_exact(3) {
        let t = [0, 1, 2].map(|i| usize::from(group.render[usize::from(t[i])]));
        let normal = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
        t.iter().for_each(|v| normals[*v] += normal);
    }
    Scan {
        points: vertices.iter().map(|v| at(*v)).collect(),
        normals: vertices.iter().map(|v| normals[*v].normalize()).collect(),
    }
}

/// The same round its middle.
fn centred(scan: &Scan) -> Vec<DVec3> {
    let middle = scan.points.iter().sum::<DVec3>() / scan.points.len() as f64;
    scan.points.iter().map(|p| *p - middle).collect()
}

/// The rotation nearest to a matrix, by Higham's iteration for the polar decomposition ("Computing
/// the polar decomposition, with applications", 1986).
fn nearest_rotation(matrix: DMat3) -> DMat3 {
    (0..60).fold(matrix, |m, _| (m + m.inverse().transpose()) * 0.5)
}

/// What is taken out before faces are compared.
#[derive(Clone, Copy, PartialEq)]
enum TakenOut {
    Pose,
    PoseAndSize,
}

/// Distance between two faces, root mean square over the points of one to the surface of the other,
/// millimetres.
fn distance_mm(a: &Scan, b: &Scan, out: TakenOut) -> f64 {
    let (to, mut from) = (centred(a), centred(b));
    let size = |points: &[DVec3]| points.iter().map(|p| p.length_squared()).sum::<f64>().sqrt();
    let scale = if out == TakenOut::Pose { 1.0 } else { size(&to) / size(&from) };
    let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
    let covariance = to.iter().zip(&from).fold(DMat3::ZERO, |sum, (a, b)| sum + outer(*a, *b));
    let rotation = nearest_rotation(covariance);
    from.iter_mut().for_each(|p| *p = rotation * *p * scale);
    let off = |p: &DVec3| {
        let near = |i: &usize, j: &usize| {
            p.distance_squared(to[*i]).total_cmp(&p.distance_squared(to[*j]))
        };
        let nearest = (0..to.len()).min_by(near).expect("a face has points");
        (*p - to[nearest]).dot(a.normals[nearest]).powi(2)
    };
    (from.iter().map(off).sum::<f64>() / from.len() as f64).sqrt()
}

#[test]
fn fourteen_random_faces_are_fourteen_people() {
    let figure = Figure::built_in().expect("the figure ships with the program");
    // A third of the points says the same in a ninth of the time.
    let vertices: Vec<usize> = face_vertices(&figure).into_iter().step_by(3).collect();
    assert!(vertices.len() > 500, "{}", vertices.len());
    for (sex, seed) in [("female", 1), ("male", 1), ("female", 2), ("male", 2)] {
        let scans: Vec<Scan> =
            drawn(sex, seed).iter().map(|p| scan(&figure, p, &vertices)).collect();
        assert_eq!(scans.len(), FACES);
        let pairs = || (0..FACES).flat_map(|i| (0..i).map(move |j| (i, j)));
        let of = |(i, j): (usize, usize), out| distance_mm(&scans[i], &scans[j], out);
        for pair in pairs() {
            let apart = of(pair, TakenOut::PoseAndSize);
            assert!(apart > SAME_MM, "{sex}, seed {seed}: {pair:?} are {apart:.2} mm apart");
        }
        let mean =
            pairs().map(|pair| of(pair, TakenOut::Pose)).sum::<f64>() / pairs().count() as f64;
        let (unrelated, spread) = UNRELATED_MM;
        assert!((mean - unrelated).abs() < spread, "{sex}, seed {seed}: {mean:.2} mm");
    }
}

/// A face is itself, however it is held and seen.
#[test]
fn the_measure_takes_pose_and_size_out() {
    let figure = Figure::built_in().expect("the figure ships with the program");
    let vertices = face_vertices(&figure);
    let person = &drawn("female", 1)[0];
    let a = scan(&figure, person, &vertices);
    let turn = DQuat::from_rotation_y(0.4) * DQuat::from_rotation_x(-0.2);
    let moved = Scan {
        points: a.points.iter().map(|p| turn * *p * 1.1 + DVec3::new(30.0, -400.0, 8.0)).collect(),
        normals: a.normals.iter().map(|n| turn * *n).collect(),
    };
    assert!(distance_mm(&a, &moved, TakenOut::PoseAndSize) < 1e-6);
    assert!(distance_mm(&moved, &a, TakenOut::PoseAndSize) < 1e-6);
    assert!(distance_mm(&a, &moved, TakenOut::Pose) > 1.0);
}
