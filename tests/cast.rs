//! People who are listed in a config: who they are, and that they are the same wherever they are.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::sync::Arc;

use figurant_core::document::cast::{self, Member};
use figurant_core::document::settle::read_all;
use figurant_core::document::{Document, file, presets};
use figurant_core::geometry::person::MeshKey;
use figurant_core::job::catalogue;
use figurant_core::library::Library;
use figurant_core::sampling::{Catalogue, SampleError, Sampler};
use figurant_core::scene::{Person, Sex};
use serde_json::{Value, json};

fn names() -> Catalogue {
    catalogue(&Library::new(&[], 1024).unwrap())
}

/// The seed's preset with other values of `people`, as a file.
fn text(people: &Value) -> String {
    let mut value: Value =
        serde_json::from_str(presets::find("peoplesanspeople").unwrap().text).unwrap();
    for (name, field) in people.as_object().unwrap() {
        value["people"][name] = field.clone();
    }
    value.to_string()
}

/// The seed's preset with other values of `people`.
fn document(people: &Value) -> Document {
    file::parse(&text(people)).unwrap()
}

fn sampler(document: Document) -> Sampler {
    Sampler::new(Arc::new(document), names()).unwrap()
}

fn members(document: Document) -> Vec<Member> {
    sampler(document).members().collect()
}

/// Everybody of some frames.
fn people(document: Document, frames: u32) -> Vec<Person> {
    let sampler = sampler(document);
    (0..frames).flat_map(|frame| sampler.scene(frame).people).collect()
}

/// Meshes by identity; whoever comes again has the same.
fn meshes(people: &[Person]) -> BTreeMap<u32, MeshKey> {
    let mut meshes = BTreeMap::new();
    for p in people {
        let key = MeshKey::new(p);
        assert_eq!(*meshes.entry(p.identity.unwrap()).or_insert(key), key, "{:?}", p.identity);
    }
    meshes
}

#[test]
fn listed_people_are_the_same_under_other_laws_and_seeds() {
    let drawn = document(&json!({"identities": 40}));
    let all = members(drawn.clone());
    assert_eq!(all.len(), 40);
    let cast = serde_json::to_value(&all).unwrap();
    let mut other = document(&json!({
        "identities": null,
        "cast": cast,
        "body": {"enabled": false, "age_years": 5, "sex": "male"},
        "look": {"hair": "bald", "skin": [0, 1, 0], "face_targets": 0},
        "wardrobe": {"enabled": false, "season": "winter", "top": {"kind": "hoodie"}},
    }));
    assert_eq!(members(other.clone()), all);
    let (here, there) = (people(drawn, 30), people(other.clone(), 30));
    assert_eq!(meshes(&here).len(), 40);
    assert_eq!(meshes(&here), meshes(&there));
    for (a, b) in here.iter().zip(&there) {
        assert_eq!((a.identity, &a.body, &a.look), (b.identity, &b.body, &b.look));
    }
    other.seed += 1;
    assert_eq!(members(other.clone()), all);
    assert_eq!(meshes(&people(other, 30)), meshes(&here));
}

#[test]
fn what_a_listed_person_leaves_out_is_drawn_and_nobody_else_changes() {
    let drawn = members(document(&json!({"identities": 6})));
    let cast = json!([{}, {"name": "maria", "body": {"sex": "female", "age_years": 34}}]);
    let listed = members(document(&json!({"identities": 6, "cast": cast})));
    let maria = &listed[1];
    assert_eq!(maria.name.as_deref(), Some("maria"));
    assert_eq!((maria.body.sex, maria.body.age_years), (Some(Sex::Female), Some(34.0)));
    // What does not follow from sex and age is what it was.
    let drawn_body = &drawn[1].body;
    assert_eq!(maria.body.muscle, drawn_body.muscle);
    assert_eq!(maria.body.ancestry, drawn_body.ancestry);
    assert_eq!(maria.look.face, drawn[1].look.face);
    assert_eq!(maria.look.expression, drawn[1].look.expression);
    for (id, member) in listed.iter().enumerate().filter(|(id, _)| *id != 1) {
        assert_eq!(*member, drawn[id]);
    }
}

#[test]
fn the_cast_comes_first_and_the_rest_is_drawn() {
    let cast = json!([{"name": "a"}, {"name": "b"}, {}]);
    for (identities, expected) in [(json!(null), 3), (json!(3), 3), (json!(7), 7)] {
        let crowd = people(document(&json!({"identities": identities, "cast": cast})), 20);
        let ids: BTreeSet<u32> = crowd.iter().map(|p| p.identity.unwrap()).collect();
        assert!(ids.into_iter().eq(0..expected), "{identities}");
        for p in &crowd {
            let name = match p.identity {
                Some(0) => Some("a"),
                Some(1) => Some("b"),
                _ => None,
            };
            assert_eq!(p.name.as_deref(), name);
        }
    }
    let nobody = people(document(&json!({"identities": null})), 3);
    assert!(nobody.iter().all(|p| p.identity.is_none() && p.name.is_none()));
}

#[test]
fn somebody_of_a_frame_can_be_kept() {
    let document = document(&json!({"identities": null}));
    let sampler = sampler(document);
    assert_eq!(sampler.members().len(), 0);
    let kept = sampler.members_of_frame(7);
    let scene = sampler.scene(7);
    assert_eq!(kept.len(), scene.people.len());
    let (id, member) = &kept[3];
    let text = cast::text(member);
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("kept.json"), text).unwrap();
    let config =
        json!({"version": 1, "people": {"identities": null, "cast": [{"file": "kept.json"}]}});
    fs::write(dir.path().join("config.json"), config.to_string()).unwrap();
    let settled = read_all(file::load(&dir.path().join("config.json")).unwrap()).unwrap();
    let was = scene.people.iter().find(|p| p.slot + 1 == *id).unwrap();
    for p in people(settled.document, 3) {
        assert_eq!((&p.body, &p.look, &p.outfit), (&was.body, &was.look, &was.outfit));
    }
}

#[test]
fn clothes_keep_the_colours_and_patterns_that_are_given() {
    let cast = json!([{"wardrobe": {
        "top": {"kind": "sweater", "color": {"linear": [0.5, 0.25, 0.125]}, "pattern": "none"},
        "bottom": {"kind": "jeans", "hue_offset_deg": 40},
        "shoes": {"color": [1, 1, 1], "sock_color": [0, 0, 0]},
    }}]);
    let given = document(&json!({"identities": 1, "cast": cast}));
    let all = people(given.clone(), 12);
    for p in &all {
        assert_eq!((p.outfit.top.color, &p.outfit.top.texture), ([0.5, 0.25, 0.125], &None));
        assert_eq!(p.outfit.bottom.hue_offset_deg, 40.0);
        assert_eq!((p.outfit.shoes.color, p.outfit.shoes.sock_color), ([1.0; 3], [0.0; 3]));
    }
    // What is not given is drawn anew each time.
    assert!(all.iter().any(|p| p.outfit.bottom.color != all[0].outfit.bottom.color));
    let listed = &members(given)[0].wardrobe;
    assert_eq!((&listed.top.pattern, listed.bottom.color), (&Some("none".to_owned()), None));
}

#[test]
fn colours_and_patterns_that_make_no_sense_are_refused_with_their_field() {
    let of = |wardrobe: Value| {
        let people = json!({"cast": [{}, {"wardrobe": wardrobe}]});
        match file::parse(&text(&people)) {
            Ok(document) => Sampler::new(Arc::new(document), names()).unwrap_err().to_string(),
            Err(problems) => problems.to_string(),
        }
    };
    let color = of(json!({"top": {"color": [0, 2, 0]}}));
    assert!(color.contains("people.cast[1].wardrobe.top.color[1]: must be <= 1, got 2"), "{color}");
    let pattern = of(json!({"outer": {"pattern": "cloth/stripess"}}));
    assert!(pattern.starts_with("people.cast[1].wardrobe.outer.pattern: there is no"), "{pattern}");
    assert!(pattern.contains("did you mean"), "{pattern}");
}

#[test]
fn faces_that_the_figure_does_not_have_are_refused() {
    let of = |look: Value| {
        let document = document(&json!({"cast": [{}, {"look": look}]}));
        match Sampler::new(Arc::new(document), names()) {
            Err(SampleError::Assets(problems)) => problems.to_string(),
            other => panic!("{other:?}"),
        }
    };
    let shape = of(json!({"face": {"head-ovall": 0.5}}));
    assert!(shape.starts_with("people.cast[1].look.face.head-ovall: there is no such"), "{shape}");
    assert!(shape.contains("did you mean `head"), "{shape}");
    let unit = of(json!({"expression": {"mouthSmile": 0.5}}));
    assert!(unit.contains("did you mean `mouthSmile"), "{unit}");
    let mixed = of(json!({"face": {"jawOpen": 0.5}}));
    assert!(mixed.contains("look.face.jawOpen"), "{mixed}");
    let unread = document(&json!({"cast": [{"file": "maria.json"}]}));
    let error = Sampler::new(Arc::new(unread), names()).unwrap_err().to_string();
    assert!(error.starts_with("people.cast[0].file: the file was not read"), "{error}");
}
