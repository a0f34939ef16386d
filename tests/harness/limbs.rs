//! How deep hands, forearms, shins and feet of a posed person are in the trunk.

use std::ops::Range;

use figurant_core::draw::DrawList;
use figurant_core::draw::abi::DrawObject;
use figurant_core::geometry::body::rest_body;
use figurant_core::geometry::phenotype::evaluate;
use figurant_core::geometry::skeleton::joint_by_name;
use figurant_core::library::figure::{Figure, GroupId};
use figurant_core::library::mesh::SkinVertex;
use figurant_core::scene::{Person, ShoeKind};
use glam::{DAffine3, DVec3};

use crate::solid::{distance, winding_number};

/// A coarse skin will do: it is within 4 mm of the fine one.
const LOD: usize = 3;
/// Deeper is broken.
pub const DEPTH_M: f64 = 0.02;

/// A posed skin with the joint that moves each vertex most.
pub struct Skin {
    positions: Vec<DVec3>,
    joints: Vec<usize>,
    triangles: Vec<[usize; 3]>,
}

impl Skin {
    /// The skin of a person in model space, from an object of a draw list.
    #[must_use]
    pub fn new(figure: &Figure, person: &Person, list: &DrawList, object: &DrawObject) -> Self {
        let group = figure.group(GroupId::Skin);
        let level = &group.lods[LOD];
        let range: Range<usize> = figure.vertices(GroupId::Skin, level.vertices);
        let rest = rest_body(figure, &person.body, &[]).expect("no face targets");
        let bare = person.outfit.shoes.kind == ShoeKind::Barefoot;
        let rest = if bare { rest.barefoot() } else { rest };
        let model_from_view = affine(&object.view_from_model).inverse();
        let joints: Vec<DAffine3> = list.palette
            [object.palette.start as usize..object.palette.end as usize]
            .iter()
            .map(|rows| model_from_view * affine(rows))
            .collect();
        let skin = &figure.skin()[range.clone()];
        let rest = evaluate(figure, &rest.shape, range);
        let moved = |(p, s): (&[f32; 3], &SkinVertex)| {
            let p = DVec3::from_array(p.map(f64::from));
            let shares = s.joints.iter().zip(&s.weights);
            let by = |joint: u8| joints[usize::from(joint)].transform_point3(p);
            shares.map(|(&j, &w)| by(j) * (f64::from(w) / 255.0)).sum()
        };
        let strongest = |s: &SkinVertex| {
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

    /// The deepest of a person's four limbs, metres, and which it is. Arms are not looked for in
    /// arms, nor legs in legs.
    #[must_use]
    pub fn deepest(&self) -> (f64, String) {
        let trunk = joints(&["Hips", "Spine", "Spine1", "Spine2"]);
        let of = |names: &[&str]| -> Vec<Vec<usize>> {
            ["Left", "Right"]
                .map(|side| {
                    names.iter().flat_map(|name| joints(&[&format!("{side}{name}")])).collect()
                })
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
        for (name, limbs, tips) in [("arm", &arms, of(&hand)), ("leg", &legs, of(&["Leg", "Foot"]))]
        {
            for (side, tip) in ["left", "right"].into_iter().zip(tips) {
                let depth = self.depth(&trunk, limbs, &tip);
                if depth > worst.0 {
                    worst = (depth, format!("{side} {name}"));
                }
            }
        }
        worst
    }
}

fn affine(rows: &[[f32; 4]; 3]) -> DAffine3 {
    let column = |c: usize| DVec3::from_array(rows.map(|row| f64::from(row[c])));
    DAffine3::from_cols(column(0), column(1), column(2), column(3))
}

fn joints(names: &[&str]) -> Vec<usize> {
    names.iter().map(|name| joint_by_name(name).expect("a joint of the skeleton")).collect()
}
