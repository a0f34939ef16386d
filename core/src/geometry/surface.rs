//! What the parts of a person look like: colours, masks and fine structure.
//!
//! A person's look and outfit flow in, one [`Surface`] for each kind of part flows out. Meshes are
//! made in [`super::person`]; textures' pixels are not known here.

use super::beard::whiskers;
use super::person::PartKind;
use crate::library::figure::{ScalpShade, Whiskers};
use crate::scene::{BottomKind, Glasses, HairStyle, HeadwearKind, Look, Person, ShoeKind, TopKind};

/// Which mask texture colours a surface's layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mask {
    /// None: the layers are unused.
    None,
    /// The figure's skin mask with this scalp and beard.
    Skin(ScalpShade, Whiskers),
    /// The figure's eye mask.
    Eye,
}

/// Kind of fine structure, to be looked up as a detail texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Smooth.
    None,
    /// Pores and blotches.
    Skin,
    /// Woven cloth.
    Cloth,
    /// Strands along v.
    Hair,
}

/// What a part looks like. Colours are linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Multiplies the texture.
    pub base_color: [f32; 3],
    /// Perceptual roughness.
    pub roughness: f32,
    /// Light round the terminator, 0..0.5.
    pub wrap: f32,
    /// Mask of the layers.
    pub mask: Mask,
    /// Colour and roughness of the mask's four layers.
    pub layers: [[f32; 4]; 4],
    /// Cloth pattern: texture id in the library.
    pub texture: Option<String>,
    /// Rotation of the hue.
    pub hue_offset_deg: f32,
    /// Repeats of the pattern and the relief, against those of other cloths.
    pub repeat: f32,
    /// Fine structure.
    pub detail: Detail,
    /// Its strength.
    pub detail_strength: f32,
    /// Strength of the cloth's relief: that of its pattern, or else folds; 0 for none.
    pub relief_strength: f32,
}

/// The surface of a part of a person.
#[must_use]
pub fn surface(kind: PartKind, person: &Person) -> Surface {
    let (look, outfit) = (&person.look, &person.outfit);
    let (top, bottom, outer) = (&outfit.top, &outfit.bottom, &outfit.outer);
    let shoe = outfit.shoes.color;
    match kind {
        PartKind::Skin => skin_surface(look),
        PartKind::Eyes => eye_surface(look),
        PartKind::Teeth => plain([0.78, 0.74, 0.64], 0.25),
        // Between the locks it is darker than on them.
        PartKind::Hair => hair_surface(look, 0.72),
        PartKind::Locks => hair_surface(look, 1.0),
        PartKind::LightLocks => hair_surface(look, 1.28),
        PartKind::Headwear => headwear_surface(look),
        PartKind::Frame => match look.glasses {
            Glasses::Thin => plain([0.16, 0.15, 0.14], 0.25),
            _ => plain([0.012, 0.011, 0.011], 0.25),
        },
        PartKind::Lenses => plain([0.006, 0.006, 0.007], 0.06),
        PartKind::Top => Surface {
            relief_strength: top_relief(top.kind),
            ..cloth(top.color, top.texture.as_ref(), top.hue_offset_deg)
        },
        PartKind::Bottom => Surface {
            relief_strength: bottom_relief(bottom.kind),
            ..cloth(bottom.color, bottom.texture.as_ref(), bottom.hue_offset_deg)
        },
        PartKind::Outer => cloth(outer.color, outer.texture.as_ref(), outer.hue_offset_deg),
        PartKind::Socks => {
            Surface { relief_strength: 0.0, ..cloth(outfit.shoes.sock_color, None, 0.0) }
        }
        PartKind::Shoes => plain(narrow(shoe), 0.45),
        PartKind::Soles if outfit.shoes.kind == ShoeKind::Sneakers => {
            plain([0.78, 0.77, 0.74], 0.8)
        }
        PartKind::Soles => plain(sole_color(shoe), 0.8),
    }
}

fn narrow(color: [f64; 3]) -> [f32; 3] {
    color.map(|c| c as f32)
}

fn tinted(color: [f32; 3], by: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| (color[i] * by[i]).clamp(0.0, 1.0))
}

fn layer(color: [f32; 3], roughness: f32) -> [f32; 4] {
    [color[0], color[1], color[2], roughness]
}

fn plain(base_color: [f32; 3], roughness: f32) -> Surface {
    Surface {
        base_color,
        roughness,
        wrap: 0.0,
        mask: Mask::None,
        layers: [[0.0; 4]; 4],
        texture: None,
        hue_offset_deg: 0.0,
        repeat: 1.0,
        detail: Detail::None,
        detail_strength: 0.0,
        relief_strength: 0.0,
    }
}

fn skin_surface(look: &Look) -> Surface {
    let skin = narrow(look.skin_color);
    let hair = narrow(look.hair_color);
    let shade = match look.hair {
        HairStyle::Bald => ScalpShade::Shaven,
        HairStyle::Balding => ScalpShade::Wreath,
        _ => ScalpShade::Full,
    };
    let scalp = mix(skin, hair, if look.hair == HairStyle::Cropped { 0.85 } else { 0.95 });
    Surface {
        wrap: 0.25,
        mask: Mask::Skin(shade, whiskers(look.beard)),
        layers: [
            layer(tinted(skin, [0.78, 0.44, 0.43]), 0.40),
            layer(mix(hair, tinted(skin, [0.5, 0.45, 0.42]), 0.25), 0.65),
            layer(tinted(skin, [0.86, 0.58, 0.53]), 0.50),
            layer(scalp, 0.60),
        ],
        detail: Detail::Skin,
        detail_strength: 0.12,
        ..plain(skin, 0.55)
    }
}

fn mix(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

fn eye_surface(look: &Look) -> Surface {
    let white = [0.72, 0.70, 0.68];
    Surface {
        mask: Mask::Eye,
        layers: [
            layer(narrow(look.iris_color), 0.12),
            layer([0.008, 0.007, 0.007], 0.10),
            layer(tinted(white, [0.82, 0.66, 0.62]), 0.20),
            layer([0.9, 0.92, 0.95], 0.10),
        ],
        ..plain(white, 0.12)
    }
}

fn hair_surface(look: &Look, tone: f32) -> Surface {
    // Tight curls scatter what long strands reflect.
    let roughness = match look.hair {
        HairStyle::Afro | HairStyle::Cropped | HairStyle::Bald | HairStyle::Balding => 0.90,
        HairStyle::Curly | HairStyle::CrewCut => 0.75,
        HairStyle::Short | HairStyle::SideParting | HairStyle::Pixie => 0.62,
        _ => 0.52,
    };
    Surface {
        detail: Detail::Hair,
        detail_strength: 0.6,
        wrap: 0.10,
        ..plain(tinted(narrow(look.hair_color), [tone; 3]), roughness)
    }
}

fn headwear_surface(look: &Look) -> Surface {
    let roughness = match look.headwear.kind {
        HeadwearKind::Beanie => 0.95,
        _ => 0.82,
    };
    Surface {
        detail: Detail::Cloth,
        detail_strength: if look.headwear.kind == HeadwearKind::Beanie { 0.35 } else { 0.12 },
        ..plain(narrow(look.headwear.color), roughness)
    }
}

fn cloth(color: [f64; 3], texture: Option<&String>, hue_offset_deg: f64) -> Surface {
    Surface {
        // The stitches of knitwear are painted large.
        repeat: if texture.is_some_and(|id| id.contains("/knit/")) { 2.0 } else { 1.0 },
        texture: texture.cloned(),
        hue_offset_deg: hue_offset_deg as f32,
        detail: Detail::Cloth,
        detail_strength: 0.10,
        relief_strength: 0.5,
        ..plain(narrow(color), 0.85)
    }
}

/// How much a top's cloth creases.
const fn top_relief(kind: TopKind) -> f32 {
    match kind {
        TopKind::Shirt => 0.8,
        TopKind::TShirt | TopKind::Hoodie => 0.6,
        TopKind::LongSleeve | TopKind::Sweater => 0.5,
        TopKind::Polo | TopKind::TankTop => 0.4,
    }
}

const fn bottom_relief(kind: BottomKind) -> f32 {
    match kind {
        BottomKind::Leggings => 0.1,
        BottomKind::Trousers | BottomKind::Shorts => 0.6,
        BottomKind::Jeans => 0.7,
        _ => 0.4,
    }
}

/// Rubber in the shoe's colour, darker if that is light and lighter if it is dark.
fn sole_color(shoe: [f64; 3]) -> [f32; 3] {
    let shoe = narrow(shoe);
    let light = 0.2126 * shoe[0] + 0.7152 * shoe[1] + 0.0722 * shoe[2];
    if light > 0.25 { tinted(shoe, [0.35, 0.33, 0.32]) } else { mix(shoe, [0.55, 0.53, 0.5], 0.35) }
}
