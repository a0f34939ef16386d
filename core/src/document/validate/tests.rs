use serde_json::{Value, json};

use super::*;
use crate::document::file;

/// The default document with one value replaced, as text.
fn with(pointer: &str, value: Value) -> String {
    let mut document = serde_json::to_value(Document::default()).unwrap();
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    let parent = document.pointer_mut(parent).unwrap_or_else(|| panic!("no {pointer}"));
    match parent {
        Value::Array(items) => items[name.parse::<usize>().unwrap()] = value,
        _ => parent[name] = value,
    }
    document.to_string()
}

fn problems_of(text: &str) -> Vec<Problem> {
    file::parse(text).map_or_else(|e| e.0, |_| Vec::new())
}

#[test]
fn the_default_document_makes_sense() {
    assert_eq!(validate(&Document::default()), []);
}

#[test]
fn hostile_values_are_refused_with_their_path() {
    let ground = |count: Value, separation: f64| json!({"mode": "ground", "x_m": [-2, 2], "z_m": [-2, 2], "count": count, "separation_m": separation});
    let disk =
        |separation: f64| json!({"mode": "poisson_disk", "depth_m": 0, "separation_m": separation});
    let deep = (0..20).fold(json!(1), |inner, _| json!({"mix": [[1, inner]]}));
    let table = [
        ("/frames", json!(0), "frames"),
        ("/assets", json!(["a", " "]), "assets[1]"),
        ("/image/width", json!(0), "image.width"),
        ("/image/height", json!(100_000), "image.height"),
        ("/image", json!({"width": 16384, "height": 16384}), "image"),
        ("/camera/fov_vertical_deg", json!(0), "camera.fov_vertical_deg"),
        ("/camera/fov_vertical_deg", json!({"uniform": [5, 180]}), "camera.fov_vertical_deg"),
        ("/camera/near_m", json!(0), "camera.near_m"),
        ("/camera/distortion", json!({"model": "brown", "k6": 0}), "camera.distortion.k6"),
        ("/camera/distortion", json!({"model": "pinhole"}), "camera.distortion.model"),
        ("/camera/distortion", json!({"k1": 0.1}), "camera.distortion.model"),
        (
            "/camera/distortion",
            json!({"model": "fisheye", "k2": {"uniform": [0, 2000]}}),
            "camera.distortion.k2",
        ),
        ("/camera/focal_length_mm", json!(0.1), "camera.focal_length_mm"),
        ("/camera/focal_length_mm", json!({"uniform": [20, 1e5]}), "camera.focal_length_mm"),
        ("/camera/sensor_height_mm", json!(0), "camera.sensor_height_mm"),
        ("/lights/sun/temperature_k", json!(900), "lights.sun.temperature_k"),
        ("/lights/points/2/temperature_k", json!(5e4), "lights.points[2].temperature_k"),
        ("/output/jpeg_quality", json!({"uniform": [0, 100]}), "output.jpeg_quality"),
        (
            "/people/rotation_deg",
            json!({"facing": {"towards": [0, 1e9, 0]}}),
            "people.rotation_deg.facing.towards[1]",
        ),
        (
            "/people/placement",
            json!({"mode": "poisson_disk", "depth_m": 0, "separation_m": 3, "count": 501}),
            "people.placement.count",
        ),
        (
            "/people/placement",
            json!({"mode": "poisson_disk", "depth_m": 0, "separation_m": 3, "in_view": 1.5}),
            "people.placement.in_view",
        ),
        ("/camera/position_m", json!([0, 1e300, 0]), "camera.position_m[1]"),
        (
            "/camera/position_offset_m",
            json!({"sphere": {"radius": -1}}),
            "camera.position_offset_m.sphere.radius",
        ),
        (
            "/camera/position_offset_m",
            json!({"box": {"min": [0, 0, 1], "max": [1, 1, 0]}}),
            "camera.position_offset_m.box.max[2]",
        ),
        ("/lights/sun/illuminance_lux", json!(-1), "lights.sun.illuminance_lux"),
        (
            "/lights/sun/direction",
            json!({"mode": "clock", "hour": 25}),
            "lights.sun.direction.hour",
        ),
        ("/lights/points/3/range_m", json!(0), "lights.points[3].range_m"),
        ("/lights/points/0/radius_m", json!(30), "lights.points[0].radius_m"),
        ("/lights/points/0/on", json!({"bernoulli": 1.5}), "lights.points[0].on.bernoulli"),
        ("/lights/moving/color", json!([0, 2, 0]), "lights.moving.color[1]"),
        (
            "/lights/environment/sky_lux",
            json!({"normal": {"mean": 1, "std": 1}}),
            "lights.environment.sky_lux",
        ),
        ("/background/wall/size_m", json!([1, -1, 1]), "background.wall.size_m[1]"),
        ("/background/wall/texture", json!(""), "background.wall.texture"),
        ("/background/wall/color", json!({"palette": []}), "background.wall.color.palette"),
        ("/occluders/placement", disk(0.01), "occluders.placement.separation_m"),
        ("/occluders/scale", json!({"uniform": [0, 12]}), "occluders.scale"),
        ("/occluders/shape", json!({"choice": []}), "occluders.shape.choice"),
        (
            "/occluders/shape",
            json!({"choice": [["cube", 0], ["cone", 0]]}),
            "occluders.shape.choice",
        ),
        ("/people/placement", disk(-1.0), "people.placement.separation_m"),
        ("/people/placement", disk(0.0), "people.placement.separation_m"),
        ("/people/placement", disk(0.5), "people.placement.separation_m"),
        ("/people/placement", ground(json!(1e9), 0.1), "people.placement.count"),
        ("/people/placement", ground(json!(400), 1.0), "people.placement.count"),
        ("/people/placement", ground(json!({"uniform": [-1, 3]}), 1.0), "people.placement.count"),
        (
            "/people/placement",
            json!({"mode": "row", "count": 1_000_000_000, "spacing_m": 1}),
            "people.placement.count",
        ),
        (
            "/people/placement",
            json!({"mode": "grid", "columns": 100, "rows": 100, "spacing_m": [1, 1]}),
            "people.placement",
        ),
        ("/people/placement/x_m", json!([3, -3]), "people.placement.x_m"),
        ("/people/scale", json!(-2), "people.scale"),
        ("/people/scale", json!({"uniform": [3, 0.5]}), "people.scale.uniform"),
        ("/people/scale", json!({"uniform": [1, 1]}), "people.scale.uniform"),
        (
            "/people/scale",
            json!({"triangular": {"min": 1, "mode": 5, "max": 2}}),
            "people.scale.triangular.mode",
        ),
        ("/people/scale", json!({"choice": [[1, -1], [2, 3]]}), "people.scale.choice[0]"),
        ("/people/scale", json!({"curve": [[1, 0], [2, 0]]}), "people.scale.curve"),
        ("/people/scale", json!({"curve": [[2, 1], [1, 1]]}), "people.scale.curve[1]"),
        (
            "/people/scale",
            json!({"mix": [[1, {"uniform": [2, 1]}]]}),
            "people.scale.mix[0][1].uniform",
        ),
        ("/people/scale", json!({"normal": {"mean": 1, "std": 0}}), "people.scale.normal.std"),
        (
            "/people/scale",
            json!({"normal": {"mean": 1, "std": 0.1, "min": 2, "max": 3}}),
            "people.scale.normal",
        ),
        ("/people/scale", json!({"lognormal": {"median": 1, "sigma": 1}}), "people.scale"),
        ("/people/identities", json!(0), "people.identities"),
        ("/people/identities", json!(2_000_000), "people.identities"),
        ("/people/cast", json!([{}, {"file": " "}]), "people.cast[1].file"),
        ("/people/cast", json!([{"name": ""}]), "people.cast[0].name"),
        ("/people/cast", json!([{"name": "a/b"}]), "people.cast[0].name"),
        ("/people/cast", json!([{"name": "x".repeat(65)}]), "people.cast[0].name"),
        ("/people/cast", json!([{"name": "a"}, {}, {"name": "a"}]), "people.cast[2].name"),
        (
            "/people/cast",
            json!([{}, {}, {"body": {"age_years": 0}}]),
            "people.cast[2].body.age_years",
        ),
        ("/people/cast", json!([{"body": {"age_years": 150}}]), "people.cast[0].body.age_years"),
        ("/people/cast", json!([{"body": {"bmi_kg_m2": 5}}]), "people.cast[0].body.bmi_kg_m2"),
        ("/people/cast", json!([{"body": {"bmi_kg_m2": 90}}]), "people.cast[0].body.bmi_kg_m2"),
        (
            "/people/cast",
            json!([{"body": {"ancestry": [0, 0, 0]}}]),
            "people.cast[0].body.ancestry",
        ),
        (
            "/people/cast",
            json!([{"body": {"ancestry": [1, -1, 0]}}]),
            "people.cast[0].body.ancestry[1]",
        ),
        ("/people/cast", json!([{"look": {"skin": [0, 2, 0]}}]), "people.cast[0].look.skin[1]"),
        (
            "/people/cast",
            json!([{"look": {"iris_color": {"linear": [0, 0, -1]}}}]),
            "people.cast[0].look.iris_color.linear[2]",
        ),
        (
            "/people/cast",
            json!([{"look": {"expression": {"jawOpen": 1.5}}}]),
            "people.cast[0].look.expression.jawOpen",
        ),
        (
            "/people/cast",
            json!([{"wardrobe": {"top": {"looseness_m": 1}}}]),
            "people.cast[0].wardrobe.top.looseness_m",
        ),
        ("/people/cast", json!(vec![json!({}); 51]), "people.identities"),
        ("/people/body/age_years", json!(0), "people.body.age_years"),
        ("/people/body/age_years", json!(150), "people.body.age_years"),
        (
            "/people/body/sex",
            json!({"choice": [["male", 0], ["female", 0]]}),
            "people.body.sex.choice",
        ),
        ("/people/body/age_years", json!(200), "people.body.age_years"),
        ("/people/body/age_years", json!({"poisson": 30}), "people.body.age_years"),
        ("/people/body/stature_m", json!(9), "people.body.stature_m"),
        (
            "/people/body/muscle",
            json!({"beta": {"alpha": 0, "beta": 1}}),
            "people.body.muscle.beta.alpha",
        ),
        ("/people/body/muscle", json!({"binomial": {"n": 3, "p": 0.5}}), "people.body.muscle"),
        ("/people/body/bmi_kg_m2", json!(5), "people.body.bmi_kg_m2"),
        ("/people/body/bmi_kg_m2", json!(90), "people.body.bmi_kg_m2"),
        ("/people/body/bmi_kg_m2", json!({"uniform": [20, 90]}), "people.body.bmi_kg_m2"),
        (
            "/people/body/ancestry",
            json!({"choice": [["african", 0], ["asian", 0]]}),
            "people.body.ancestry.choice",
        ),
        (
            "/people/wardrobe/season",
            json!({"choice": [["summer", 0]]}),
            "people.wardrobe.season.choice",
        ),
        ("/people/body/ancestry", json!({"shares": [0, 0, 0]}), "people.body.ancestry.shares"),
        (
            "/people/body/ancestry",
            json!({"dirichlet": [1, 0, 1]}),
            "people.body.ancestry.dirichlet[1]",
        ),
        ("/people/pose/phase", json!(1.01), "people.pose.phase"),
        ("/people/pose/variation", json!({"uniform": [0, 2]}), "people.pose.variation"),
        ("/people/pose/blend/share", json!(-0.1), "people.pose.blend.share"),
        ("/people/pose/blend/clip", json!(""), "people.pose.blend.clip"),
        ("/people/pose/gaze_deg", json!([0, 200]), "people.pose.gaze_deg[1]"),
        ("/people/seats/shape", json!({"choice": []}), "people.seats.shape.choice"),
        ("/people/seats/color", json!([0, 0, 2]), "people.seats.color[2]"),
        ("/people/pose/hands", json!({"choice": []}), "people.pose.hands.choice"),
        ("/materials/roughness", json!(0), "materials.roughness"),
        ("/post/exposure_ev", json!(1e9), "post.exposure_ev"),
        ("/labels/samples", json!(3), "labels.samples"),
        ("/labels/scheme", json!("all"), "labels.scheme"),
        ("/output/outputs", json!([]), "output.outputs"),
        ("/output/jpeg_quality", json!(0), "output.jpeg_quality"),
        ("/quality/shadow_map_size", json!(100), "quality.shadow_map_size"),
        ("/quality/max_texture_size", json!(1000), "quality.max_texture_size"),
    ];
    for (pointer, value, path) in table {
        let found = problems_of(&with(pointer, value.clone()));
        let paths: Vec<&str> = found.iter().map(|p| p.path.as_str()).collect();
        assert_eq!(paths, [path], "{pointer} = {value}: {found:?}");
    }
    let found = problems_of(&with("/people/scale", deep));
    assert!(found[0].message.contains("nest"), "{found:?}");
}

#[test]
fn messages_say_the_rule_and_the_value() {
    let placement = json!({"mode": "poisson_disk", "depth_m": 0, "separation_m": -1});
    let found = problems_of(&with("/people/placement", placement));
    assert_eq!(found[0].to_string(), "people.placement.separation_m: must be > 0, got -1");
}

#[test]
fn a_misspelt_member_is_named_with_what_was_meant() {
    for (cast, path, suggestion) in [
        (json!([{"flie": "a.json"}]), "people.cast[0].flie", "file"),
        (json!([{}, {"body": {"age_year": 3}}]), "people.cast[1].body.age_year", "age_years"),
        (json!([{"look": {"hair": "bunn"}}]), "people.cast[0].look.hair", "bun"),
        (
            json!([{"look": {"skin": {"liner": [0, 0, 0]}}}]),
            "people.cast[0].look.skin.liner",
            "linear",
        ),
        (
            json!([{"wardrobe": {"shoes": {"kind": "boot"}}}]),
            "people.cast[0].wardrobe.shoes.kind",
            "boots",
        ),
    ] {
        let found = problems_of(&with("/people/cast", cast));
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(
            (found[0].path.as_str(), found[0].suggestion.as_deref()),
            (path, Some(suggestion))
        );
    }
    for cast in [json!({}), json!("maria"), json!([3]), json!([{"look": {"face": {"a": "x"}}}])] {
        assert_eq!(problems_of(&with("/people/cast", cast.clone())).len(), 1, "{cast}");
    }
}

#[test]
fn numbers_that_json_cannot_carry_are_refused_too() {
    let mut document = Document::default();
    document.people.scale = Param::Constant(f64::NAN);
    document.camera.near_m = f64::INFINITY;
    let paths: Vec<String> = validate(&document).into_iter().map(|p| p.path).collect();
    assert_eq!(paths, ["camera.near_m", "people.scale"]);
}

#[test]
fn reasonable_unbounded_laws_are_accepted() {
    for (pointer, value) in [
        ("/lights/sun/illuminance_lux", json!({"normal": {"mean": 10_000, "std": 500}})),
        ("/lights/sun/illuminance_lux", json!({"lognormal": {"median": 10_000, "sigma": 0.5}})),
        (
            "/people/placement",
            json!({"mode": "ground", "x_m": [-9, 9], "z_m": [-9, 9], "count": {"poisson": 6}, "separation_m": 1}),
        ),
        ("/camera/rotation_deg", json!({"rotation": "uniform"})),
        ("/people/body/sex", json!("female")),
    ] {
        assert_eq!(problems_of(&with(pointer, value.clone())), [], "{pointer} = {value}");
    }
}
