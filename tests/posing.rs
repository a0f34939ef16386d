//! Document to scene: what people do, in what clothes and on what.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use figurant_core::document::{Distribution, Document, Param, Problem, file};
use figurant_core::job;
use figurant_core::library::Library;
use figurant_core::sampling::{Catalogue, Sampler, check_assets};
use figurant_core::scene::{HandShape, OuterKind, Person, Scene};

fn catalogue() -> &'static Catalogue {
    static CATALOGUE: LazyLock<Catalogue> = LazyLock::new(|| {
        let library = Library::new(&[], 1024).expect("built-in assets");
        job::catalogue(&library)
    });
    &CATALOGUE
}

fn scene(document: &Document, frame: u32) -> Scene {
    Sampler::new(document.clone().into(), catalogue().clone())
        .expect("a valid document")
        .scene(frame)
}

fn people(document: &Document, frames: u32) -> Vec<Person> {
    let sampler = Sampler::new(document.clone().into(), catalogue().clone()).expect("valid");
    (0..frames).flat_map(|frame| sampler.scene(frame).people).collect()
}

fn posed(text: &str) -> Document {
    let text = format!("{{\"version\": 1, \"people\": {{\"pose\": {text}}}}}");
    file::parse(&text).expect("a valid document")
}

#[test]
fn poses_and_clips_share_one_set_of_ids() {
    let ids = |clip: &str| -> Vec<String> {
        let document = posed(&format!("{{\"clip\": \"{clip}\", \"suits_clothes\": false}}"));
        people(&document, 300).into_iter().map(|p| p.pose.clip).collect()
    };
    let is_pose = |id: &String| id.starts_with("pose/");
    assert!(ids("any_pose").iter().all(is_pose));
    assert!(!ids("any_clip").iter().any(is_pose));
    let share = ids("any").iter().filter(|id| is_pose(id)).count() as f64;
    let share = share / ids("any").len() as f64;
    let (clips, poses) = (catalogue().clips.len() as f64, catalogue().poses.len() as f64);
    assert!((share - poses / (clips + poses)).abs() < 0.03, "{share}");
    assert!(ids("pose/sitting_chair").iter().all(|id| id == "pose/sitting_chair"));
    let lost = posed(r#"{"clip": "pose/siting_chair", "blend": {"clip": "wlk", "share": 0.2}}"#);
    let found: Vec<String> =
        check_assets(&lost, catalogue()).iter().map(Problem::to_string).collect();
    assert_eq!(
        found,
        [
            "people.pose.clip: there is no clip or pose \"pose/siting_chair\"; did you mean `pose/sitting_chair`?",
            "people.pose.blend.clip: there is no clip or pose \"wlk\"; did you mean `walk`?",
        ]
    );
}

#[test]
fn a_pose_s_variation_blend_and_gaze_move_nothing_else() {
    let plain = posed(r#"{"clip": "any"}"#);
    let rich = posed(
        r#"{"clip": "any", "variation": 0.5, "blend": {"clip": "any_pose", "share": {"uniform": [0, 1]}},
        "gaze_deg": [{"uniform": [-30, 30]}, 5], "hands": "fist"}"#,
    );
    let mut angles = Vec::new();
    for frame in 0..100 {
        let (a, mut b) = (scene(&plain, frame), scene(&rich, frame));
        for (p, q) in a.people.iter().zip(&mut b.people) {
            assert!(p.pose.variation_deg.is_empty() && p.pose.blend.is_none());
            assert_eq!(p.pose.gaze_deg, [0.0; 2]);
            assert_eq!(q.pose.gaze_deg[1], 5.0);
            let blend = q.pose.blend.take().unwrap();
            assert!(blend.clip.starts_with("pose/") && (0.0..1.0).contains(&blend.share));
            angles.extend(q.pose.variation_deg.iter().map(|a| a.1));
            q.pose = p.pose.clone();
        }
        assert_eq!(a, b);
    }
    let mean = angles.iter().sum::<f64>() / angles.len() as f64;
    let variance = angles.iter().map(|a| (a - mean).powi(2)).sum::<f64>() / angles.len() as f64;
    let spread = variance.sqrt();
    assert!(mean.abs() < 0.1 && (2.0..6.0).contains(&spread), "{mean} {spread}");
}

#[test]
fn hands_of_clips_are_mostly_relaxed_and_poses_keep_theirs() {
    let document = posed(r#"{"clip": "any"}"#);
    let people = people(&document, 300);
    for p in &people {
        assert_eq!(p.pose.hands.is_none(), p.pose.clip.starts_with("pose/"), "{}", p.pose.clip);
    }
    // Who fights, runs or tumbles has other things to do with them.
    let walks = people.iter().filter(|p| p.pose.activity == "walking");
    let hands: Vec<HandShape> = walks.filter_map(|p| p.pose.hands).flatten().collect();
    let relaxed = hands.iter().filter(|h| **h == HandShape::Relaxed).count();
    assert!(relaxed * 10 > hands.len() * 7 && relaxed < hands.len(), "{relaxed} {}", hands.len());
}

#[test]
fn nobody_tumbles_in_a_coat_and_clips_of_others_stay_alike_often() {
    let turns = |p: &Person| ["tumbling", "crawling", "getting_up"].contains(&&*p.pose.activity);
    let suited = people(&coated(r#"{"clip": "any_clip", "suits_clothes": true}"#), 200);
    assert!(!suited.iter().any(turns));
    let any = people(&coated(r#"{"clip": "any_clip", "suits_clothes": false}"#), 200);
    assert!(any.iter().filter(|p| turns(p)).count() > 60);
    let clips: BTreeSet<&str> = suited.iter().map(|p| &*p.pose.clip).collect();
    for clip in &clips {
        let n = suited.iter().filter(|p| p.pose.clip == *clip).count();
        let share = (n * clips.len()) as f64 / suited.len() as f64;
        assert!((0.8..1.2).contains(&share), "{clip}: {share} of what is even");
    }
}

/// Everybody wears a coat.
fn coated(pose: &str) -> Document {
    let mut document = posed(pose);
    let coat = serde_json::json!({"outer": {"kind": "coat"}});
    document.people.wardrobe = serde_json::from_value(coat).expect("a wardrobe");
    document
}

#[test]
fn nobody_swims_in_a_coat_unless_told_to() {
    let swims = |p: &&Person| p.pose.activity == "swimming";
    let suited = people(&coated(r#"{"clip": "any_pose", "suits_clothes": true}"#), 300);
    assert!(suited.iter().all(|p| p.outfit.outer.kind == OuterKind::Coat));
    assert_eq!(suited.iter().filter(swims).count(), 0);
    let unsuited = coated(r#"{"clip": "any_pose", "suits_clothes": false}"#);
    assert!(people(&unsuited, 300).iter().filter(swims).count() > 20);
    let told = people(&coated(r#"{"clip": "pose/swimming_crawl", "suits_clothes": true}"#), 20);
    assert!(told.iter().all(|p| swims(&p)));
    // Whoever wears what suits the pose keeps it, and everybody keeps all else.
    let any = coated(r#"{"clip": "any_pose", "suits_clothes": false}"#);
    let mut kept = 0;
    for (a, mut b) in suited.into_iter().zip(people(&any, 300)) {
        if a.pose.clip == b.pose.clip {
            kept += 1;
        } else {
            (b.pose.clip, b.pose.activity, b.seat) =
                (a.pose.clip.clone(), a.pose.activity.clone(), a.seat.clone());
        }
        assert_eq!(a, b);
    }
    assert!(kept > 1000, "{kept}");
}

#[test]
fn whoever_sits_has_a_seat_and_nobody_else() {
    let seated = |id: &str| catalogue().poses.iter().any(|p| p.id == id && p.seated);
    let document = posed(r#"{"clip": "any"}"#);
    let mut seats = 0;
    for p in people(&document, 200) {
        assert_eq!(p.seat.is_some(), seated(&p.pose.clip), "{}", p.pose.clip);
        seats += usize::from(p.seat.is_some());
    }
    assert!(seats > 50, "{seats}");
    let mut off = document;
    off.people.seats.enabled = false;
    assert!(people(&off, 50).iter().all(|p| p.seat.is_none()));
}

/// Seats are surfaces like others: each has numbers of its own.
#[test]
fn seats_are_of_the_materials_that_the_document_names() {
    let mut document = posed(r#"{"clip": "pose/sitting_chair"}"#);
    document.materials.roughness = Param::Random(Distribution::Uniform([0.2, 0.8]));
    document.materials.metallic = Param::from(0.25);
    let roughness = |document: &Document| -> Vec<f64> {
        let seats = people(document, 40).into_iter().filter_map(|p| p.seat);
        let materials = seats.map(|s| s.material).inspect(|m| assert_eq!(m.metallic, 0.25));
        materials.map(|m| m.roughness).collect()
    };
    let drawn = roughness(&document);
    let (low, high) = drawn.iter().fold((1.0f64, 0.0f64), |(a, b), v| (a.min(*v), b.max(*v)));
    assert!(
        drawn.len() > 50 && (0.2..0.3).contains(&low) && (0.7..0.8).contains(&high),
        "{drawn:?}"
    );
    document.materials.enabled = false;
    assert!(roughness(&document).iter().all(|v| (v - 0.5).abs() < 1e-9));
}
