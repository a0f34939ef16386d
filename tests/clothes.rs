//! Cloth: what is printed on it and how it is woven, from the config to the draw list.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

use figurant_core::document::{Document, file, presets};
use figurant_core::draw::{Cast, DrawList, DrawOptions, draw};
use figurant_core::job;
use figurant_core::library::Library;
use figurant_core::sampling::{Catalogue, Sampler};
use figurant_core::scene::{BottomKind, Person, Top};
use serde_json::{Value, json};

static LIBRARY: LazyLock<Library> = LazyLock::new(|| Library::new(&[], 1024).unwrap());

static CATALOGUE: LazyLock<Catalogue> = LazyLock::new(|| job::catalogue(&LIBRARY));

/// A preset with other clothes.
fn text(preset: &str, wardrobe: &Value) -> String {
    let mut value: Value = serde_json::from_str(presets::find(preset).unwrap().text).unwrap();
    for (garment, fields) in wardrobe.as_object().unwrap() {
        for (name, field) in fields.as_object().unwrap() {
            value["people"]["wardrobe"][garment][name] = field.clone();
        }
    }
    value.to_string()
}

fn document(preset: &str, wardrobe: &Value) -> Document {
    file::parse(&text(preset, wardrobe)).unwrap()
}

fn people(document: Document, frames: u32) -> Vec<Person> {
    let sampler = Sampler::new(Arc::new(document), CATALOGUE.clone()).unwrap();
    (0..frames).flat_map(|frame| sampler.scene(frame).people).collect()
}

#[test]
fn there_are_at_least_as_many_of_each_as_the_seed_has() {
    assert!(CATALOGUE.cloth_patterns.len() >= 28 && CATALOGUE.cloth_reliefs.len() >= 28);
    assert!(CATALOGUE.cloth_finishes.len() >= 28);
}

/// Checks that two of what a cloth has are independent, and that all of the second come alike often.
fn check_apart(tops: &[[&str; 2]], [first, second]: [&[String]; 2]) {
    // The first half of each list.
    let half = |id: &str, all: &[String]| {
        f64::from(u8::from(all.iter().position(|known| known == id).unwrap() < all.len() / 2))
    };
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut firsts, mut seconds, mut both) = (0.0, 0.0, 0.0);
    for [a, b] in tops {
        *counts.entry(*b).or_default() += 1;
        let (a, b) = (half(a, first), half(b, second));
        (firsts, seconds, both) = (firsts + a, seconds + b, both + a * b);
    }
    let n = tops.len() as f64;
    assert!(n > 4000.0, "{n} people");
    let expected = firsts * seconds / n;
    // Four standard deviations of a count of a quarter.
    assert!((both - expected).abs() < 4.0 * (n * 3.0 / 16.0).sqrt(), "{both} is not {expected}");
    let mean = n / second.len() as f64;
    assert_eq!(counts.len(), second.len());
    for (id, count) in counts {
        assert!((count as f64 - mean).abs() < 5.0 * mean.sqrt(), "{id}: {count} of {n}");
    }
}

#[test]
fn prints_weaves_and_finishes_are_drawn_apart_and_all_alike_often() {
    let any = json!({"top": {"pattern": "any", "relief": "any", "finish": "any"}});
    let people = people(document("peoplesanspeople", &any), 900);
    let Catalogue { cloth_patterns, cloth_reliefs, cloth_finishes, .. } = &*CATALOGUE;
    let pairs = |a: fn(&Top) -> &Option<String>, b: fn(&Top) -> &Option<String>| {
        let of = |p| [a, b].map(|get| get(p).as_deref().unwrap());
        people.iter().map(|p| of(&p.outfit.top)).collect::<Vec<_>>()
    };
    check_apart(&pairs(|t| &t.texture, |t| &t.relief), [cloth_patterns, cloth_reliefs]);
    check_apart(&pairs(|t| &t.texture, |t| &t.finish), [cloth_patterns, cloth_finishes]);
    check_apart(&pairs(|t| &t.relief, |t| &t.finish), [cloth_reliefs, cloth_finishes]);
}

#[test]
fn nothing_else_follows_from_the_finish() {
    let [none, any] = ["none", "any"].map(|finish| {
        let garment = json!({"finish": finish});
        let wardrobe = json!({"top": garment, "bottom": garment, "outer": garment});
        people(document("peoplesanspeople", &wardrobe), 30)
    });
    for (mut a, mut b) in none.into_iter().zip(any) {
        assert!(a.outfit.top.finish.is_none() && b.outfit.bottom.finish.is_some());
        for outfit in [&mut a.outfit, &mut b.outfit] {
            (outfit.top.finish, outfit.bottom.finish, outfit.outer.finish) = (None, None, None);
        }
        assert_eq!(a, b);
    }
}

#[test]
fn nothing_else_follows_from_how_cloth_is_woven() {
    let [none, any] = ["none", "any"].map(|relief| {
        let garment = json!({"relief": relief});
        let wardrobe = json!({"top": garment, "bottom": garment, "outer": garment});
        people(document("peoplesanspeople", &wardrobe), 30)
    });
    for (mut a, mut b) in none.into_iter().zip(any) {
        assert!(a.outfit.top.relief.is_none() && b.outfit.top.relief.is_some());
        assert_eq!(b.outfit.bottom.relief.is_none(), b.outfit.bottom.kind == BottomKind::Jeans);
        for outfit in [&mut a.outfit, &mut b.outfit] {
            (outfit.top.relief, outfit.bottom.relief, outfit.outer.relief) = (None, None, None);
        }
        assert_eq!(a, b);
    }
}

/// The first frame of the portraits, everybody in a woven or another top.
fn drawn(relief: &str, pattern: &str, fov_vertical_deg: f64) -> DrawList {
    let top = json!({"relief": relief, "pattern": pattern, "kind": "t_shirt"});
    let plain = json!({"relief": "none"});
    let wardrobe = json!({"top": top, "bottom": plain, "outer": {"kind": "none"}});
    let mut value: Value = serde_json::from_str(&text("lineup", &wardrobe)).unwrap();
    value["camera"]["fov_vertical_deg"] = json!(fov_vertical_deg);
    let sampler =
        Sampler::new(Arc::new(file::parse(&value.to_string()).unwrap()), CATALOGUE.clone())
            .unwrap();
    let options = DrawOptions {
        raster: true,
        shading: true,
        samples: 1,
        shadow_map_size: 1024,
        lod_error_px: 0.25,
    };
    draw(&sampler.scene(0), &LIBRARY, &Cast::default(), &options).unwrap().list
}

#[test]
fn weaves_show_from_near_where_the_print_has_none_of_its_own() {
    let shows = |list: &DrawList, id: &str| {
        let [texture, normals] =
            [id, &LIBRARY.textures.normal_map(id).unwrap()].map(|id| LIBRARY.textures.get(id));
        let named = |texture: &Arc<_>| list.textures.iter().position(|t| Arc::ptr_eq(t, texture));
        let pair = [named(&texture.unwrap()), named(&normals.unwrap())];
        let of = |m: &figurant_core::draw::abi::Material| {
            [m.detail_map, m.normal_map].map(|map| map.map(|map| map as usize))
        };
        pair[0].is_some() && list.materials.iter().any(|m| of(m) == pair)
    };
    let (near, far, waffle) = (20.0, 120.0, "relief/waffle/00");
    assert!(shows(&drawn(waffle, "none", near), waffle));
    assert!(shows(&drawn(waffle, "cloth/stripes/00", near), waffle));
    assert!(!shows(&drawn("none", "none", near), waffle));
    assert!(!shows(&drawn(waffle, "none", far), waffle), "too fine to be seen");
    assert!(!shows(&drawn(waffle, "cloth/knit/00", near), waffle), "knitwear has its own");
}

#[test]
fn weaves_that_do_not_exist_are_refused_with_their_field() {
    let refused = |document: Document| {
        Sampler::new(Arc::new(document), CATALOGUE.clone()).unwrap_err().to_string()
    };
    let wrong = json!({"bottom": {"relief": "relief/wafle/00"}});
    let message = refused(document("peoplesanspeople", &wrong));
    assert!(message.starts_with("people.wardrobe.bottom.relief: there is no relief"), "{message}");
    assert!(message.contains("did you mean `relief/waffle/00`"), "{message}");
    let message =
        refused(document("peoplesanspeople", &json!({"top": {"finish": "finish/sattin/00"}})));
    assert!(message.contains("did you mean `finish/satin/00`"), "{message}");
    let mut listed = document("peoplesanspeople", &json!({}));
    let member = json!([{"wardrobe": {"outer": {"relief": "relief/twil/00"}}}]);
    listed.people.cast = serde_json::from_value(member).unwrap();
    let message = refused(listed);
    assert!(message.starts_with("people.cast[0].wardrobe.outer.relief: there is no"), "{message}");
}
