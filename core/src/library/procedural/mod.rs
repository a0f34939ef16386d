//! Textures that are computed: patterns, surfaces, pictures, cloth and fine detail.
//!
//! In: an id such as `procedural/brick/07`. Out: a texture that tiles, always the same one for the
//! same id, on every machine: the id is the only seed, and all numbers come from plain arithmetic.
//! What a frame shows, and files, are not known here.

mod canvas;
mod cloth;
mod detail;
mod dice;
mod field;
mod finish;
mod goods;
mod letters;
mod pattern;
mod plant;
mod print;
mod relief;
mod scenery;
mod surface;

use canvas::Canvas;
pub(super) use dice::Dice;
pub(super) use field::Field;

use super::texture::{Encoding, Texture};

/// What a generator paints.
struct Painting {
    color: Canvas,
    /// Height over the surface in pixels, where the surface is not flat.
    height: Option<Field>,
}

impl From<Canvas> for Painting {
    fn from(color: Canvas) -> Self {
        Self { color, height: None }
    }
}

/// Kinds of computed textures, each the first part of its ids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// For walls, floors and objects.
    Procedural,
    /// For garments.
    Cloth,
    /// Fine structure, plain numbers.
    Detail,
    /// How cloth is woven, plain numbers with a normal map.
    Relief,
    /// Where the hue of cloth is turned and where it shines, plain numbers.
    Finish,
}

/// A generator with its number of variants.
struct Family {
    kind: Kind,
    name: &'static str,
    variants: u32,
    /// Whether it has a height, and so a normal map.
    relief: bool,
    paint: fn(&mut Dice) -> Painting,
}

const fn wall(name: &'static str, variants: u32, paint: fn(&mut Dice) -> Painting) -> Family {
    Family { kind: Kind::Procedural, name, variants, relief: false, paint }
}

const fn rough(name: &'static str, variants: u32, paint: fn(&mut Dice) -> Painting) -> Family {
    Family { kind: Kind::Procedural, name, variants, relief: true, paint }
}

const fn cloth(name: &'static str, variants: u32, paint: fn(&mut Dice) -> Painting) -> Family {
    Family { kind: Kind::Cloth, name, variants, relief: false, paint }
}

const fn woven(name: &'static str, paint: fn(&mut Dice) -> Painting) -> Family {
    Family { kind: Kind::Relief, name, variants: 2, relief: true, paint }
}

const fn finished(name: &'static str, paint: fn(&mut Dice) -> Painting) -> Family {
    Family { kind: Kind::Finish, name, variants: 2, relief: false, paint }
}

const fn detail(name: &'static str, paint: fn(&mut Dice) -> Painting) -> Family {
    Family { kind: Kind::Detail, name, variants: 1, relief: false, paint }
}

/// All generators, by kind and name. Names and their numbers are for ever: scenes hold them.
const FAMILIES: [Family; 50] = [
    rough("bark", 3, plant::bark),
    wall("bokeh", 3, scenery::bokeh),
    rough("brick", 3, surface::brick),
    wall("camouflage", 3, pattern::camouflage),
    wall("carpet", 3, pattern::carpet),
    wall("checker", 3, pattern::checker),
    wall("clouds", 3, scenery::clouds),
    wall("collage", 3, print::collage),
    wall("dots", 3, pattern::dots),
    wall("facade", 3, scenery::facade),
    wall("floral", 3, plant::floral),
    wall("gradient", 3, pattern::gradient),
    wall("graffiti", 3, print::graffiti),
    wall("grass", 3, plant::grass),
    wall("groceries", 3, goods::groceries),
    rough("ground", 3, surface::ground),
    rough("grunge", 3, surface::grunge),
    wall("heap", 3, scenery::heap),
    wall("lake", 3, scenery::lake),
    wall("leaves", 3, plant::leaves),
    wall("marble", 3, surface::marble),
    rough("metal", 3, surface::metal),
    wall("motif", 3, pattern::motif),
    wall("noise", 3, pattern::noise),
    wall("plaid", 3, pattern::plaid),
    wall("shelf", 3, goods::shelf),
    wall("sign", 3, print::sign),
    wall("stripes", 3, pattern::stripes),
    wall("terrazzo", 3, surface::terrazzo),
    wall("text", 3, print::text),
    rough("tiles", 3, surface::tiles),
    rough("voronoi", 3, surface::voronoi),
    wall("waves", 3, pattern::waves),
    rough("weave", 3, pattern::weave),
    rough("wood", 3, surface::wood),
    cloth("batik", 3, cloth::batik),
    cloth("camouflage", 3, cloth::camouflage),
    cloth("checks", 3, cloth::checks),
    cloth("denim", 3, cloth::denim),
    cloth("dots", 3, cloth::dots),
    cloth("fleece", 3, cloth::fleece),
    cloth("floral", 3, cloth::floral),
    cloth("heather", 3, cloth::heather),
    cloth("herringbone", 3, cloth::herringbone),
    Family { relief: true, ..cloth("knit", 3, cloth::knit) },
    Family { relief: true, ..cloth("leather", 3, cloth::leather) },
    cloth("pinstripe", 3, cloth::pinstripe),
    cloth("plaid", 3, cloth::plaid),
    cloth("plain", 3, cloth::plain),
    cloth("stripes", 3, cloth::stripes),
];

/// Fine detail, one texture each.
const DETAILS: [Family; 5] = [
    detail("cloth", detail::cloth),
    Family { relief: true, ..detail("curls", detail::curls) },
    Family { relief: true, ..detail("folds", detail::folds) },
    Family { relief: true, ..detail("hair", detail::hair) },
    detail("skin", detail::skin),
];

/// How cloth is woven.
const RELIEFS: [Family; 16] = [
    woven("basket", relief::basket),
    woven("boucle", relief::boucle),
    woven("cable", relief::cable),
    woven("canvas", relief::canvas),
    woven("corduroy", relief::corduroy),
    woven("crepe", relief::crepe),
    woven("crinkle", relief::crinkle),
    woven("herringbone", relief::herringbone),
    woven("pique", relief::pique),
    woven("pleats", relief::pleats),
    woven("quilt", relief::quilt),
    woven("rib", relief::rib),
    woven("seersucker", relief::seersucker),
    woven("terry", relief::terry),
    woven("twill", relief::twill),
    woven("waffle", relief::waffle),
];

/// Where the hue of cloth is turned and where it shines.
const FINISHES: [Family; 14] = [
    finished("acid", finish::acid),
    finished("blocks", finish::blocks),
    finished("brocade", finish::brocade),
    finished("crackle", finish::crackle),
    finished("damask", finish::damask),
    finished("dip", finish::dip),
    finished("foil", finish::foil),
    finished("moire", finish::moire),
    finished("panels", finish::panels),
    finished("satin", finish::satin),
    finished("splash", finish::splash),
    finished("tie", finish::tie),
    finished("waxed", finish::waxed),
    finished("zigzag", finish::zigzag),
];

impl Kind {
    const fn prefix(self) -> &'static str {
        match self {
            Self::Procedural => "procedural",
            Self::Cloth => "cloth",
            Self::Detail => "detail",
            Self::Relief => "relief",
            Self::Finish => "finish",
        }
    }

    const fn encoding(self) -> Encoding {
        match self {
            Self::Procedural | Self::Cloth => Encoding::Color,
            Self::Detail | Self::Relief | Self::Finish => Encoding::Linear,
        }
    }
}

impl Family {
    fn id(&self, variant: u32) -> String {
        match self.kind {
            Kind::Detail => format!("{}/{}", self.kind.prefix(), self.name),
            _ => format!("{}/{}/{variant:02}", self.kind.prefix(), self.name),
        }
    }

    fn ids(&self) -> impl Iterator<Item = String> + '_ {
        (0..self.variants).map(|v| self.id(v))
    }
}

fn families() -> impl Iterator<Item = &'static Family> {
    FAMILIES.iter().chain(&DETAILS).chain(&RELIEFS).chain(&FINISHES)
}

/// All ids of a kind, in order.
pub(super) fn ids(kind: Kind) -> Vec<String> {
    families().filter(|f| f.kind == kind).flat_map(Family::ids).collect()
}

/// The normal map of a computed texture, where it has one: `normal/` before its id, `procedural/`
/// left out.
pub(super) fn normal_id(id: &str) -> Option<String> {
    let family = family_of(id)?;
    family.relief.then(|| format!("normal/{}", id.strip_prefix("procedural/").unwrap_or(id)))
}

/// All ids of normal maps, in order.
pub(super) fn normal_ids() -> Vec<String> {
    let mut ids: Vec<String> =
        families().flat_map(Family::ids).filter_map(|id| normal_id(&id)).collect();
    ids.sort();
    ids
}

fn family_of(id: &str) -> Option<&'static Family> {
    families().find(|f| {
        let name = id.strip_prefix(f.kind.prefix()).and_then(|rest| rest.strip_prefix('/'));
        name.and_then(|rest| rest.strip_prefix(f.name)).is_some_and(|variant| {
            (variant.is_empty() || variant.starts_with('/')) && f.ids().any(|known| known == id)
        })
    })
}

/// The texture of an id, with its normal map where it has one; nothing if there is none of that
/// name.
pub(super) fn generate(id: &str) -> Option<(Texture, Option<Texture>)> {
    let paint = |id: &str| family_of(id).map(|f| (f, (f.paint)(&mut Dice::new(id))));
    let relief = |height: Field| normals(&height).into_texture(Encoding::Linear);
    let Some(of) = id.strip_prefix("normal/") else {
        let (family, painting) = paint(id)?;
        let normals = painting.height.filter(|_| family.relief).map(relief);
        let color = painting.color.into_texture(family.kind.encoding());
        // Figures of a finish are wide, and a frame may show some fifty of them.
        let color = if family.kind == Kind::Finish { color.halved() } else { color };
        return Some((color, normals));
    };
    let (_, painting) = paint(of).or_else(|| paint(&format!("procedural/{of}")))?;
    painting.height.map(|height| (relief(height), None))
}

/// Tangent-space normals of a height: x along +u, y along -v (up in the picture), z outwards,
/// each as (n + 1) / 2.
fn normals(height: &Field) -> Canvas {
    Canvas::from_fn(|x, y| {
        let (x, y) = (x as i32, y as i32);
        let along_u = (height.at(x + 1, y) - height.at(x - 1, y)) * 0.5;
        let along_v = (height.at(x, y + 1) - height.at(x, y - 1)) * 0.5;
        let n = [-along_u, along_v, 1.0];
        let length = (n[0] * n[0] + n[1] * n[1] + 1.0).sqrt();
        n.map(|v| 0.5 + 0.5 * v / length)
    })
}

#[cfg(test)]
mod tests {
    use super::canvas::{LOG2_SIDE, SIDE};
    use super::*;
    use crate::base::color::srgb_from_linear;
    use crate::library::texture::linear_from_color;

    fn picture(id: &str) -> Texture {
        generate(id).unwrap().0
    }

    #[test]
    fn a_picture_brings_the_normal_map_of_its_name() {
        for id in ["procedural/brick/01", "cloth/knit/00"] {
            let normals = generate(id).unwrap().1.unwrap();
            assert_eq!(normals, picture(&normal_id(id).unwrap()));
        }
        assert!(generate("procedural/plaid/00").unwrap().1.is_none());
    }

    /// One texture of each family, and one of each normal map.
    fn samples() -> Vec<(String, Texture)> {
        let mut ids: Vec<String> = families().map(|f| f.id(f.variants / 2)).collect();
        ids.extend(ids.clone().iter().filter_map(|id| normal_id(id)));
        ids.into_iter().map(|id| (id.clone(), picture(&id))).collect()
    }

    /// The finest level as bytes, colours in sRGB.
    fn bytes(texture: &Texture) -> Vec<[u8; 4]> {
        let roots: [u8; 1024] = std::array::from_fn(|i| {
            let [light, ..] = linear_from_color(i as u32);
            (srgb_from_linear(light) * 255.0 + 0.5) as u8
        });
        let plain = |t: u32| match texture.encoding {
            Encoding::Color => {
                let [r, g, b] = [0, 10, 20].map(|shift| roots[(t >> shift & 1023) as usize]);
                [r, g, b, 255]
            }
            Encoding::Linear => t.to_le_bytes(),
        };
        texture.texels[..1 << (2 * texture.log2_size)].iter().map(|t| plain(*t)).collect()
    }

    fn difference(a: [u8; 4], b: [u8; 4]) -> f64 {
        a.iter().zip(b).map(|(&a, b)| f64::from(a.abs_diff(b))).sum()
    }

    #[test]
    fn names_are_in_order_and_there_are_enough_of_them() {
        let sorted = |ids: Vec<String>| {
            assert!(ids.is_sorted(), "{ids:?}");
            assert!(ids.windows(2).all(|w| w[0] != w[1]));
            ids.len()
        };
        assert!(sorted(ids(Kind::Procedural)) > 100);
        assert!(sorted(ids(Kind::Cloth)) > 40);
        assert!(sorted(ids(Kind::Relief)) >= 28);
        assert!(sorted(ids(Kind::Finish)) >= 28);
        assert!(sorted(normal_ids()) > 25);
        assert_eq!(
            ids(Kind::Detail),
            ["detail/cloth", "detail/curls", "detail/folds", "detail/hair", "detail/skin"]
        );
        for family in families().filter(|f| f.kind == Kind::Procedural) {
            assert!(family.variants >= 3, "{}", family.name);
        }
    }

    #[test]
    fn only_known_ids_are_generated() {
        for id in [
            "",
            "procedural",
            "procedural/brick",
            "procedural/brick/99",
            "procedural/brick/7",
            "procedural/brick/01/",
            "cloth/plain/00x",
            "normal/plaid/00",
            "normal/",
            "detail/skin/00",
            "brick/01",
        ] {
            assert!(generate(id).is_none(), "{id}");
        }
        assert_eq!(normal_id("procedural/brick/01").as_deref(), Some("normal/brick/01"));
        assert_eq!(normal_id("cloth/knit/01").as_deref(), Some("normal/cloth/knit/01"));
        assert_eq!(normal_id("procedural/plaid/00"), None);
    }

    #[test]
    fn every_family_tiles_and_shows_something() {
        for (id, texture) in samples() {
            let log2_size = LOG2_SIDE - u32::from(id.starts_with("finish/"));
            assert_eq!(texture.log2_size, log2_size, "{id}");
            let side = 1 << log2_size;
            let tones = bytes(&texture);
            let rows: Vec<&[[u8; 4]]> = tones.chunks(side).collect();
            let across = |x: usize| -> f64 {
                (0..side).map(|y| difference(rows[y][x], rows[y][(x + 1) % side])).sum()
            };
            let down = |y: usize| -> f64 {
                (0..side).map(|x| difference(rows[y][x], rows[(y + 1) % side][x])).sum()
            };
            // The seam may be an edge of the pattern, but hardly a worse one than those inside,
            // where cells of random tones meet as well.
            let worst = |step: &dyn Fn(usize) -> f64| (0..side - 1).map(step).fold(0.0, f64::max);
            let (wx, wy) = (worst(&across), worst(&down));
            assert!(across(side - 1) <= wx * 1.25 + 512.0, "{id}: {} {wx}", across(side - 1));
            assert!(down(side - 1) <= wy * 1.25 + 512.0, "{id}: {} {wy}", down(side - 1));
            let mut tones = tones;
            tones.sort_unstable();
            tones.dedup();
            assert!(tones.len() > 15, "{id} has {} tones", tones.len());
        }
    }

    #[test]
    fn the_same_id_is_the_same_texture_and_another_is_another() {
        for family in families() {
            let first = picture(&family.id(0));
            assert_eq!(first, picture(&family.id(0)), "{}", family.name);
            if family.variants > 1 {
                assert_ne!(first, picture(&family.id(1)), "{}", family.name);
            }
        }
    }

    #[test]
    fn cloth_is_light_and_detail_lies_round_the_middle() {
        let plain = 120.0..136.0;
        for (kind, range) in
            [(Kind::Cloth, 120.0..250.0), (Kind::Detail, plain.clone()), (Kind::Relief, plain)]
        {
            for id in ids(kind) {
                let texture = picture(&id);
                let sum: f64 = bytes(&texture).iter().map(|t| f64::from(t[1])).sum();
                let mean = sum / (SIDE * SIDE) as f64;
                assert!(range.contains(&mean), "{id}: {mean}");
            }
        }
    }

    #[test]
    fn normals_follow_the_height_at_every_place_and_over_the_sides() {
        let mut dice = Dice::new("heights");
        let height = Field((0..SIDE * SIDE).map(|_| dice.unit()).collect());
        let at = |x: usize, y: usize| height.0[y % SIDE * SIDE + x % SIDE];
        for (i, n) in normals(&height).0.iter().enumerate() {
            let (x, y) = (i % SIDE, i / SIDE);
            let along_u = at(x + 1, y) - at(x + SIDE - 1, y);
            let along_v = at(x, y + 1) - at(x, y + SIDE - 1);
            let [nx, ny, nz] = n.map(|v| 2.0 * v - 1.0);
            let (wrong_u, wrong_v) = (nx / nz + 0.5 * along_u, ny / nz - 0.5 * along_v);
            assert!(wrong_u.abs() < 1e-5 && wrong_v.abs() < 1e-5, "{x} {y}: {wrong_u} {wrong_v}");
        }
    }

    #[test]
    fn normals_are_unit_point_outwards_and_follow_the_height() {
        // A ridge along v: its left flank faces left, its right one right.
        let ridge = Field::from_fn(|x, _| -((x as f32) - 256.0).abs());
        let canvas = normals(&ridge);
        let at = |x: usize, y: usize| canvas.0[y * SIDE + x].map(|v| 2.0 * v - 1.0);
        assert!(at(100, 50)[0] < -0.7 && at(400, 50)[0] > 0.7);
        let fall = normals(&Field::from_fn(|_, y| -(y as f32)));
        assert!(fall.0[100 * SIDE + 7][1] < 0.2, "falling downwards faces downwards");
        for id in normal_ids().iter().step_by(17) {
            for t in &picture(id).texels[..SIDE * SIDE] {
                let [x, y, z, _] = t.to_le_bytes().map(|v| f64::from(v) / 127.5 - 1.0);
                assert!(z > 0.0 && ((x * x + y * y + z * z).sqrt() - 1.0).abs() < 0.02, "{id}");
            }
        }
    }
}
