//! The figure that ships with the program, measured without the code that made it.

use std::collections::BTreeMap;

use figurant_core::library::figure::{Figure, GroupId, LOD_COUNT};
use figurant_tests::solid::distance;
use glam::DVec3;

/// Nothing is looked for farther away than this.
const FAR_M: f64 = 0.03;

/// Triangles by the cells of a grid that they come near to.
struct Surface {
    triangles: Vec<[DVec3; 3]>,
    near: BTreeMap<[i32; 3], Vec<usize>>,
}

fn cell(p: DVec3) -> [i32; 3] {
    (p / FAR_M).to_array().map(|v| v.floor() as i32)
}

impl Surface {
    fn new(triangles: Vec<[DVec3; 3]>) -> Self {
        let mut near = BTreeMap::<_, Vec<usize>>::new();
        for (i, [a, b, c]) in triangles.iter().enumerate() {
            let low = cell(a.min(*b).min(*c) - FAR_M);
            let high = cell(a.max(*b).max(*c) + FAR_M);
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        near.entry([x, y, z]).or_default().push(i);
                    }
                }
            }
        }
        Self { triangles, near }
    }

    fn distance(&self, p: DVec3) -> f64 {
        let near = self.near.get(&cell(p)).map_or(&[][..], Vec::as_slice);
        near.iter().map(|&i| distance(p, self.triangles[i])).fold(FAR_M, f64::min)
    }
}

/// The mouth's inside and the sockets behind the eyes do not count: they are hardly ever seen.
fn is_hidden(p: DVec3) -> bool {
    let mouth = (0.64..0.71).contains(&p.y) && (0.05..0.145).contains(&p.z) && p.x.abs() < 0.035;
    mouth || p.distance(DVec3::new(p.x.signum() * 0.0308, 0.7284, 0.1235)) < 0.0155
}

#[test]
fn no_level_of_detail_strays_farther_than_it_says() {
    let figure = Figure::built_in().expect("it ships with the program");
    let template = figure.template();
    for id in [GroupId::Skin, GroupId::Shell, GroupId::HairCap] {
        let group = figure.group(id);
        let at = |vertex: usize| {
            let v = group.first as usize + vertex;
            DVec3::new(template.x[v].into(), template.y[v].into(), template.z[v].into())
        };
        for lod in 1..LOD_COUNT {
            let level = &group.lods[lod];
            let corner = |r: &u16| at(group.render[usize::from(*r)].into());
            let corners = |t: &[u16]| [0, 1, 2].map(|i| corner(&t[i]));
            let surface = Surface::new(level.triangles.chunks_exact(3).map(corners).collect());
            let (mut at_vertices_m, mut between_m) = (0.0_f64, 0.0_f64);
            for t in group.lods[0].triangles.chunks_exact(3) {
                let [a, b, c] = corners(t);
                if [a, b, c].into_iter().any(is_hidden) {
                    continue;
                }
                at_vertices_m = at_vertices_m.max(surface.distance(a));
                for p in [(a + b) * 0.5, (a + b + c) / 3.0] {
                    between_m = between_m.max(surface.distance(p));
                }
            }
            let stated_m = f64::from(level.error_m);
            let what = format!("{id:?} {lod}: {at_vertices_m} and {between_m} of {stated_m}");
            println!("{what}");
            assert!(at_vertices_m <= stated_m + 1e-5, "{what}");
            // Where the finest surface folds, the middle of an edge may lie farther away than both
            // of its ends.
            assert!(between_m <= 2.0 * stated_m, "{what}");
        }
        let bound_m = 0.0005 * f64::from(1 << (LOD_COUNT - 1));
        assert!(f64::from(figure.lod_error_m(LOD_COUNT - 1)) <= bound_m * 1.01);
    }
}
