//! Posed bodies keep out of themselves: how deep hands, forearms, shins and feet are in the trunk.

use std::ops::Range;
use std::sync::Arc;

use figurant_core::document::{Document, file, presets};
use figurant_core::draw::{Cast, DrawOptions, Drawn, draw};
use figurant_core::geometry::body::rest_body;
use figurant_core::geometry::phenotype::evaluate;
use figurant_core::geometry::skeleton::joint_by_name;
use figurant_core::job;
use figurant_core::library::Library;
use figurant_core::library::figure::{Figure, GroupId};
use figurant_core::sampling::Sampler;
use figurant_core::scene::{Person, Scene};
use figurant_tests::solid::{distance, winding_number};
use glam::DVec3;

/// A coarse skin will do: it is within 4 mm of the fine one.
const LOD: usize = 3;
/// Deeper is broken.
const DEPTH_M: f64 = 0.02;
const PEOPLE: usize = 500;
const PER_FRAME: usize = 50;

/// A posed skin with the joint that moves each vertex most.
struct Skin {
    positions: Vec<DVec3>,
    joints: Vec<usize>,
    triangles: Vec<[usize; 3]>,
}

impl Skin {
    fn new(figure: &Figure, person: &Person, palette: &[[[f32; 4]; 3]]) -> Self {
        let group = figure.group(GroupId::Skin);
        let level = &group.lods[LOD];
        let range: Range<usize> = figure.vertices(GroupId::Skin, level.vertices);
        let rest = rest_body(figure, &person.body, &[]).expect("no face targets");
        let skin = &figure.skin()[range.clone()];
        let rest = evaluate(figure, &rest.shape, range);
        let moved = |(p, s): (&[f32; 3], &figurant_core::library::mesh::SkinVertex)| {
            let p = DVec3::from_array(p.map(f64::from));
            let by = |joint: u8| {
                let rows = palette[usize::from(joint)].map(|row| row.map(f64::from));
                DVec3::from_array(rows.map(|r| r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]))
            };
            let shares = s.joints.iter().zip(&s.weights);
            shares.map(|(&j, &w)| by(j) * (f64::from(w) / 255.0)).sum()
        };
        let strongest = |s: &figurant_core::library::mesh::SkinVertex| {
            let first = s.joints.iter().zip(&s.weights).max_by_key(|(_, weight)| **weight);
            first.map_or(0, |(&joint, _)| usize::from(joint))
        };
        let vertex = |r: u16| usize::from(group.render[usize::from(r)]);
        Self {
            positions: rest.iter().zip(skin).map(moved).collect(),
            joints: skin.iter().map(strongest).collect(),
            triangles: level
                .triangles
                .chunks_exact(3)
                .map(|t| [0, 1, 2].map(|i| vertex(t[i])))
                .collect(),
        }
    }

    fn corners(&self, t: &[usize; 3]) -> [DVec3; 3] {
        t.map(|v| self.positions[v])
    }

    /// How deep the tip of a limb is in the body, metres, where it is about the trunk; 0 where it is
    /// outside. The limbs' own triangles are left out, which leaves holes where they are attached.
    fn depth(&self, trunk: &[usize], limbs: &[usize], tip: &[usize]) -> f64 {
        let own = |t: &&[usize; 3]| !t.iter().any(|&v| limbs.contains(&self.joints[v]));
        let around: Vec<_> = self.triangles.iter().filter(own).map(|t| self.corners(t)).collect();
        let of_trunk = |v: &&usize| trunk.contains(&self.joints[**v]);
        let all = 0..self.positions.len();
        let box_of = |joints: fn(DVec3, DVec3) -> DVec3, start: DVec3| {
            let inner = all.clone().filter(|v| of_trunk(&v)).map(|v| self.positions[v]);
            inner.fold(start, joints)
        };
        let low = box_of(DVec3::min, DVec3::MAX) + DEPTH_M;
        let high = box_of(DVec3::max, DVec3::MIN) - DEPTH_M;
        let mut deepest = 0.0;
        for (p, joint) in self.positions.iter().zip(&self.joints) {
            let within = p.cmpge(low).all() && p.cmple(high).all();
            if !tip.contains(joint) || !within {
                continue;
            }
            let depth = around.iter().map(|t| distance(*p, *t)).fold(f64::MAX, f64::min);
            if depth > deepest && winding_number(*p, around.iter().copied()) > 0.5 {
                deepest = depth;
            }
        }
        deepest
    }
}

fn joints(names: &[&str]) -> Vec<usize> {
    names.iter().map(|name| joint_by_name(name).expect("a joint of the skeleton")).collect()
}

/// The deepest of a person's four limbs. Arms are not looked for in arms, nor legs in legs.
fn deepest(skin: &Skin) -> (f64, String) {
    let trunk = joints(&["Hips", "Spine", "Spine1", "Spine2"]);
    let of = |names: &[&str]| -> Vec<Vec<usize>> {
        ["Left", "Right"]
            .map(|side| names.iter().flat_map(|name| joints(&[&format!("{side}{name}")])).collect())
            .into()
    };
    let mut hand = vec!["ForeArm".to_owned(), "Hand".to_owned()];
    for finger in ["Thumb", "Index", "Middle", "Ring", "Pinky"] {
        hand.extend((1..=3).map(|i| format!("Hand{finger}{i}")));
    }
    let hand: Vec<&str> = hand.iter().map(String::as_str).collect();
    let arms = [of(&hand), of(&["Arm"])].concat().concat();
    let legs = of(&["UpLeg", "Leg", "Foot", "ToeBase"]).concat();
    let mut worst = (0.0, String::new());
    for (name, limbs, tips) in [("arm", &arms, of(&hand)), ("leg", &legs, of(&["Leg", "Foot"]))] {
        for (side, tip) in ["left", "right"].into_iter().zip(tips) {
            let depth = skin.depth(&trunk, limbs, &tip);
            if depth > worst.0 {
                worst = (depth, format!("{side} {name}"));
            }
        }
    }
    worst
}

fn drawn(scene: &Scene, library: &Library) -> Drawn {
    let options = DrawOptions {
        raster: true,
        shading: false,
        samples: 1,
        shadow_map_size: 0,
        lod_error_px: 1e3,
    };
    draw(scene, library, &Cast::default(), &options).expect("a scene of built-in assets")
}

/// People in a row in front of the camera, posed as a preset has them.
fn crowd(preset: &str) -> Document {
    let text = presets::find(preset).expect("it ships with the program").text;
    let mut value: serde_json::Value = serde_json::from_str(text).expect("JSON");
    value["people"]["identities"] = serde_json::Value::Null;
    value["people"]["placement"] =
        serde_json::json!({"mode": "row", "count": PER_FRAME, "spacing_m": 3});
    value["people"]["scale"] = 1.into();
    value["camera"] = serde_json::json!({
        "fov_vertical_deg": 60,
        "position_m": [0, 1, 400],
        "position_offset_m": [0, 0, 0],
        "rotation_deg": [0, 0, 0],
        "rotation_offset_deg": [0, 0, 0],
    });
    file::parse(&value.to_string()).expect("a valid document")
}

#[test]
fn limbs_stay_out_of_the_trunk() {
    let library = Library::new(&[], 64).expect("built-in assets load");
    let mut bad = Vec::new();
    for preset in ["peoplesanspeople", "starter"] {
        let document = Arc::new(crowd(preset));
        let sampler = Sampler::new(document, job::catalogue(&library)).expect("a valid document");
        for frame in 0..PEOPLE / PER_FRAME / 2 {
            let scene = sampler.scene(frame as u32);
            let drawn = drawn(&scene, &library);
            for shown in &drawn.people {
                let object = shown.object.expect("everybody is in the picture") as usize;
                let palette = drawn.list.objects[object].palette.clone();
                let palette = &drawn.list.palette[palette.start as usize..palette.end as usize];
                let person = &scene.people[shown.person];
                let (depth, limb) = deepest(&Skin::new(&library.figure, person, palette));
                if depth > DEPTH_M {
                    let at = format!("{preset} frame {frame} slot {}", person.slot);
                    bad.push(format!("{at}: {limb} {depth:.3} m, {}", person.pose.clip));
                }
            }
        }
    }
    assert!(bad.len() <= PEOPLE / 100, "{} of {PEOPLE}:\n{}", bad.len(), bad.join("\n"));
}
