//! Linked parameters: what they see is what is drawn, and they move nothing else.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use figurant_core::document::{Document, Param, Problem, Scope, file, params, presets};
use figurant_core::sampling::{Activity, Catalogue, Sampler};
use figurant_core::scene::{Role, Scene};
use serde_json::{Value, json};

fn catalogue() -> Catalogue {
    let activity = |id: &str| Activity {
        id: id.to_owned(),
        activity: "moving".to_owned(),
        seated: true,
        unsuited: Vec::new(),
    };
    Catalogue {
        face_targets: (0..60).map(|i| format!("nose-scale-{i}")).collect(),
        clips: ["walk", "run"].map(activity).to_vec(),
        textures: vec!["plain".to_owned()],
        cloth_patterns: vec!["stripes".to_owned()],
        cloth_reliefs: vec!["twill".to_owned()],
        cloth_finishes: vec!["satin".to_owned()],
        ..Catalogue::default()
    }
}

/// The seed's preset with nothing left to be worked out, and everything in some use.
fn base() -> Value {
    let preset = presets::find("peoplesanspeople").unwrap();
    let mut value = serde_json::to_value(file::parse(preset.text).unwrap()).unwrap();
    let unit = json!([{"uniform": [0, 1]}, {"uniform": [0, 1]}, {"uniform": [0, 1]}]);
    let share = json!({"uniform": [0.1, 0.9]});
    let gap = json!({"uniform": [0.005, 0.01]});
    let hsv = json!({"hsv": unit});
    let shutter = json!({
        "enabled": true,
        "shutter_s": 0.02,
        "velocity_m_s": [0, 0, 0],
        "angular_velocity_deg_s": [0, 0, 0],
    });
    for (path, law) in [
        ("people.identities", Value::Null),
        ("lights.environment.image.source", json!("sky")),
        ("people.body.stature_m", json!({"uniform": [1.5, 1.9]})),
        ("people.body.bmi_kg_m2", json!({"uniform": [20, 30]})),
        ("people.look.skin", unit.clone()),
        ("people.look.hair_color", hsv.clone()),
        ("people.look.headwear_color", json!({"linear": unit})),
        ("people.look.iris_color", unit.clone()),
        ("people.wardrobe.top.sleeve", share.clone()),
        ("people.wardrobe.top.neckline", share.clone()),
        ("people.wardrobe.top.looseness_m", gap.clone()),
        ("people.wardrobe.top.color", hsv.clone()),
        ("people.wardrobe.bottom.skirt_length", share.clone()),
        ("people.wardrobe.bottom.looseness_m", gap.clone()),
        ("people.wardrobe.bottom.color", hsv.clone()),
        ("people.wardrobe.outer.looseness_m", gap),
        ("people.wardrobe.outer.color", hsv),
        ("people.wardrobe.shoes.color", unit.clone()),
        ("camera.motion_blur", shutter),
        ("people.wardrobe.shoes.sock_color", unit),
        ("people.pose.blend.share", share.clone()),
        ("people.pose.variation", share),
        ("people.seats.hue_offset_deg", json!({"uniform": [0, 90]})),
        ("background.floor.enabled", json!(true)),
        ("lights.sun.temperature_k", json!({"uniform": [2500, 9000]})),
        ("lights.moving.temperature_k", json!({"uniform": [2500, 9000]})),
        ("output.jpeg_quality", json!({"uniform": [60, 95]})),
    ] {
        set(&mut value, path, law);
    }
    value
}

/// Puts a value at a path such as `lights.points[2].color.hsv[1]`.
fn set(value: &mut Value, path: &str, new: Value) {
    let pointer = path.replace('[', ".").replace(']', "").replace('.', "/");
    let (parent, name) =
        format!("/{pointer}").rsplit_once('/').map(|(p, n)| (p.to_owned(), n.to_owned())).unwrap();
    match value.pointer_mut(&parent).unwrap_or_else(|| panic!("no {path}")) {
        Value::Array(items) => items[name.parse::<usize>().unwrap()] = new,
        // Fields that may be absent are.
        parent => parent[name] = new,
    }
}

fn with(changes: &[(&str, Value)]) -> Document {
    let mut value = base();
    changes.iter().for_each(|(path, new)| set(&mut value, path, new.clone()));
    parse(&value).unwrap()
}

fn parse(value: &Value) -> Result<Document, Vec<Problem>> {
    file::parse(&value.to_string()).map_err(|e| e.0)
}

fn sampler(document: &Document) -> Sampler {
    Sampler::new(document.clone().into(), catalogue()).unwrap()
}

/// What a scene says of each thing that a scope draws for, without what the holder of a link sets.
fn things(scene: &Scene, scope: Scope, holder: &str) -> Vec<Value> {
    match scope {
        Scope::Frame => {
            let mut scene = scene.clone();
            scene.post.saturation = 0.0;
            vec![serde_json::to_value(&scene).unwrap()]
        }
        Scope::Surface | Scope::Occluder => {
            let occluders = scene.objects.iter().filter(|o| o.role == Role::Occluder).cloned();
            let blind = occluders.map(|mut o| {
                o.material.hue_offset_deg = 0.0;
                o
            });
            blind.map(|o| serde_json::to_value(&o).unwrap()).collect()
        }
        Scope::Person | Scope::Lasting => {
            let blind = scene.people.iter().cloned().map(|mut p| {
                if holder == "people.pose.phase" {
                    p.pose.phase = 0.0;
                } else {
                    p.body.cup = 0.0;
                }
                p
            });
            blind.map(|p| serde_json::to_value(&p).unwrap()).collect()
        }
    }
}

/// What the holder of a link has taken, for each such thing.
fn taken(scene: &Scene, scope: Scope, holder: &str) -> Vec<f64> {
    match scope {
        Scope::Frame => vec![scene.post.saturation],
        Scope::Surface | Scope::Occluder => {
            let occluders = scene.objects.iter().filter(|o| o.role == Role::Occluder);
            occluders.map(|o| o.material.hue_offset_deg).collect()
        }
        Scope::Person | Scope::Lasting if holder == "people.pose.phase" => {
            scene.people.iter().map(|p| p.pose.phase).collect()
        }
        Scope::Person | Scope::Lasting => scene.people.iter().map(|p| p.body.cup).collect(),
    }
}

/// Two values that a parameter may have.
fn two_values(param: &Param) -> (f64, f64) {
    match param.bounds() {
        (a, b) if a < b => (a, b.next_down()),
        (0.0, _) => (0.0, 0.01),
        (a, _) if a < 0.0 => (a, 0.9 * a),
        (a, _) => (0.9 * a, a),
    }
}

/// Every parameter once takes one of two values at random, and another one looks at it. Wherever the
/// scene is as if it had the first value, the other one must have seen the first, and likewise for
/// the second; and no other number may differ.
#[test]
fn what_is_seen_is_what_is_drawn() {
    let all = params(&parse(&base()).unwrap());
    let mut unseen = Vec::new();
    for (path, param) in all.iter().filter(|(path, _)| !path.contains(".mix[")) {
        let scope = Scope::of(path);
        let holder = match scope {
            Scope::Frame if path == "post.saturation" => continue,
            Scope::Frame => "post.saturation",
            Scope::Surface | Scope::Occluder if path == "occluders.hue_offset_deg" => continue,
            Scope::Surface | Scope::Occluder => "occluders.hue_offset_deg",
            Scope::Person | Scope::Lasting if path == "people.body.cup" => "people.pose.phase",
            Scope::Person | Scope::Lasting => "people.body.cup",
        };
        let (low, high) = two_values(param);
        let middle = 0.5 * (low + high);
        let drawn = json!({"choice": [[low, 1], [high, 1]]});
        let table = json!([[low, middle, 0.25], [middle, high, 0.75]]);
        let link = json!({"given": {"of": path, "table": table}});
        let [a, b, linked] = [
            with(&[(path, json!({"choice": [[low, 1]]}))]),
            with(&[(path, json!({"choice": [[high, 1]]}))]),
            with(&[(path, drawn), (holder, link)]),
        ]
        .map(|document| sampler(&document));
        let mut seen = [0, 0];
        for frame in 0..6 {
            let scene = linked.scene(frame);
            let [a, b, c] = [&a.scene(frame), &b.scene(frame), &scene]
                .map(|scene| things(scene, scope, holder));
            // Where the number of things is drawn itself, the first ones are compared.
            for (((a, b), c), value) in a.iter().zip(&b).zip(&c).zip(taken(&scene, scope, holder)) {
                assert!(c == a || c == b, "{path}, frame {frame}: something else has changed");
                if a != b {
                    assert_eq!(value, if c == a { 0.25 } else { 0.75 }, "{path}, frame {frame}");
                    seen[usize::from(c == b)] += 1;
                }
            }
        }
        if seen == [0, 0] {
            unseen.push(path.as_str());
        }
    }
    assert_eq!(unseen, Vec::<&str>::new(), "these change nothing");
}

#[test]
fn a_link_gives_each_row_its_law_and_leaves_the_rest_alone() {
    let table = json!([[4, 30, {"uniform": [0.5, 1]}], [30, 90, {"uniform": [2, 3]}]]);
    let age = json!({"uniform": [10, 60]});
    let link = json!({"given": {"of": "people.body.age_years", "table": table}});
    let linked = sampler(&with(&[("people.body.age_years", age.clone()), ("people.scale", link)]));
    let plain = sampler(&with(&[("people.body.age_years", age)]));
    let (mut young, mut old) = (Vec::new(), Vec::new());
    for frame in 0..400 {
        let (mut a, mut b) = (linked.scene(frame), plain.scene(frame));
        for p in &a.people {
            let scale = p.placement.scale.x;
            if p.body.age_years < 30.0 {
                young.push((scale - 0.5) / 0.5);
            } else {
                old.push(scale - 2.0);
            }
        }
        for person in a.people.iter_mut().chain(&mut b.people) {
            person.placement.scale = glam::DVec3::ONE;
        }
        assert_eq!(a, b, "frame {frame}");
    }
    // Two fifths are younger than 30; within each row the law is even. Kolmogorov-Smirnov, 0.001.
    let n = (young.len() + old.len()) as f64;
    let share = young.len() as f64 / n;
    assert!((share - 0.4).abs() < 3.3 * (0.24 / n).sqrt(), "{share}");
    for mut values in [young, old] {
        values.sort_by(f64::total_cmp);
        let n = values.len() as f64;
        let gap =
            |(i, x): (usize, &f64)| (x - i as f64 / n).abs().max((x - (i as f64 + 1.0) / n).abs());
        let distance = values.iter().enumerate().map(gap).fold(0.0, f64::max);
        assert!(distance < 1.95 / n.sqrt(), "{distance} of {n}");
    }
}

#[test]
fn who_recurs_keeps_what_is_linked_and_listed_people_are_seen_as_they_are() {
    let table = json!([[1, 50, 0.2], [50, 90, 0.8]]);
    let link = json!({"given": {"of": "people.body.age_years", "table": table}});
    let cast = json!([{"body": {"age_years": 85}}, {"body": {"age_years": 3}}]);
    let mut value = base();
    for (path, new) in
        [("people.body.cup", link), ("people.identities", json!(12)), ("people.cast", cast)]
    {
        set(&mut value, path, new);
    }
    let sampler = sampler(&parse(&value).unwrap());
    let members: Vec<_> = sampler.members().collect();
    assert_eq!((members[0].body.cup, members[1].body.cup), (Some(0.8), Some(0.2)));
    for frame in 0..20 {
        for person in sampler.scene(frame).people {
            let member = &members[person.identity.unwrap() as usize];
            assert_eq!(Some(person.body.cup), member.body.cup);
            let expected = if person.body.age_years < 50.0 { 0.2 } else { 0.8 };
            assert_eq!(person.body.cup, expected);
        }
    }
}

#[test]
fn links_that_lead_nowhere_are_refused_by_their_field() {
    let given = |of: &str, table: Value| json!({"given": {"of": of, "table": table}});
    let all = || json!([[-1e6, 1e6, 0.5]]);
    let refused = |changes: &[(&str, Value)]| -> String {
        let mut value = base();
        changes.iter().for_each(|(path, new)| set(&mut value, path, new.clone()));
        let problems = parse(&value).unwrap_err();
        assert_eq!(problems.len(), 1, "{problems:?}");
        problems[0].to_string()
    };
    let muscle = "people.body.muscle";
    for (path, law, expected) in [
        (muscle, given("people.body.age_yaers", all()), "people.body.muscle.given.of: there is no"),
        (muscle, given("people.body.age_yaers", all()), "did you mean `people.body.age_years`?"),
        (muscle, given("occluders.scale", all()), "that is drawn for each object"),
        ("post.contrast", given(muscle, all()), "that is drawn for each person"),
        ("materials.roughness", given("occluders.scale", all()), "that is drawn for each object"),
        (muscle, given(muscle, all()), "people.body.muscle: looks at itself"),
        (
            muscle,
            given("people.body.age_years", json!([[18, 60, 0.5]])),
            "given.table: people.body.age_years takes values from 18 to 80, but the table covers",
        ),
        (
            muscle,
            given("people.body.age_years", json!([[18, 40, 0.5], [50, 80, 0.6]])),
            "given.table[1]: begins at 50 and leaves a hole after the row before it, which ends at 40",
        ),
        (
            muscle,
            given("people.body.age_years", json!([[18, 40, 0.5], [30, 80, 0.6]])),
            "given.table[1]: begins at 30 and overlaps the row before it",
        ),
        (
            muscle,
            given("people.body.age_years", json!([[18, 80, 1.5]])),
            "people.body.muscle: must be <= 1, but values from 1.5 to 1.5 can be drawn",
        ),
        (muscle, given("people.body.age_years", json!([])), "given.table: must hold at least one"),
    ] {
        let problem = refused(&[(path, law)]);
        assert!(problem.contains(expected), "{problem}");
    }
    let circle = refused(&[
        (muscle, given("people.body.cup", all())),
        ("people.body.cup", given("people.scale", all())),
        ("people.scale", given(muscle, all())),
    ]);
    assert!(circle.contains("people.body.cup -> people.scale -> people.body.muscle"), "{circle}");
    let lasts =
        refused(&[("people.identities", json!(50)), (muscle, given("post.exposure_ev", all()))]);
    assert!(lasts.contains("set people.identities to null"), "{lasts}");
    let listed = refused(&[
        ("people.identities", json!(50)),
        ("people.cast", json!([{}, {"body": {"age_years": 3}}])),
        (muscle, given("people.body.age_years", json!([[18, 80, 0.5]]))),
    ]);
    assert!(listed.contains("people.cast[1] has 3 for people.body.age_years"), "{listed}");
}

/// Numbers from a table come up as often as they were measured: chi-squared over the ages, and over
/// the bins of a histogram.
#[test]
fn measured_numbers_come_up_as_they_were_measured() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("ages.csv"), "id,age\n1,20\n2,30\n3,30\n4,70\n").unwrap();
    std::fs::write(dir.path().join("scale.csv"), "lo,hi,weight\n1,2,1\n2,4,3\n").unwrap();
    let mut value = base();
    let ages = json!({"empirical": {"file": "ages.csv", "column": "age"}});
    set(&mut value, "people.body.age_years", ages);
    set(&mut value, "people.scale", json!({"empirical": {"file": "scale.csv"}}));
    let config = dir.path().join("config.json");
    std::fs::write(&config, value.to_string()).unwrap();
    let loaded = file::load(&config).unwrap();
    let unread = Sampler::new(loaded.document.clone().into(), catalogue()).unwrap_err();
    assert!(unread.to_string().contains("people.body.age_years.empirical: the file was not read"));
    let settled = figurant_core::document::settle::read_all(loaded).unwrap();
    let sampler = sampler(&settled.document);
    let people: Vec<_> = (0..400).flat_map(|frame| sampler.scene(frame).people).collect();
    let n = people.len() as f64;
    let chi2 = |counts: &[(usize, f64)]| -> f64 {
        let term =
            |(count, share): &(usize, f64)| (*count as f64 - share * n).powi(2) / (share * n);
        counts.iter().map(term).sum()
    };
    let aged = |age: f64| people.iter().filter(|p| p.body.age_years == age).count();
    // 0.001 quantiles for two degrees of freedom and for one.
    assert!(chi2(&[(aged(20.0), 0.25), (aged(30.0), 0.5), (aged(70.0), 0.25)]) < 13.8);
    let scaled = |from: f64, to: f64| {
        people.iter().filter(|p| (from..to).contains(&p.placement.scale.x)).count()
    };
    let bins = [(scaled(1.0, 2.0), 0.25), (scaled(2.0, 3.0), 0.375), (scaled(3.0, 4.0), 0.375)];
    assert!(chi2(&bins) < 13.8, "{bins:?}");
}
