//! What the parts of a person look like: colours, masks and fine structure.
//!
//! A person's look and outfit flow in, one [`Surface`] for each kind of part flows out. Meshes are
//! made in [`super::person`]; textures' pixels are not known here.

use super::beard::whiskers;
use super::person::PartKind;
use crate::library::figure::{CLOTH_REPEAT, Freckles, ScalpShade, Sewn, Whiskers};
use crate::scene::{
    Bottom, BottomKind, Glasses, HairStyle, HeadwearKind, Look, OuterKind, Person, ShoeKind, Top,
    TopKind,
};

/// Which mask texture colours a surface's layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mask {
    /// None: the layers are unused.
    None,
    /// The figure's mask of the head with this scalp and beard.
    Head(ScalpShade, Whiskers),
    /// The figure's mask of the skin elsewhere.
    Body,
    /// The figure's mask of what is sewn to a garment.
    Sewn(Sewn),
    /// The figure's eye mask.
    Eye,
}

/// Kind of fine structure, to be looked up as a detail texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Smooth.
    None,
    /// Furrows and spots of the figure's head, not repeated.
    Age,
    /// Pores and blotches.
    Skin,
    /// Woven cloth.
    Cloth,
    /// Strands along v.
    Hair,
    /// Tight coils.
    Curls,
}

/// Kind of relief, to be looked up as a normal map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relief {
    /// That of the pattern, or else of the weave, or else folds.
    Cloth,
    /// That of the fine structure.
    Detail,
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
    /// How cloth is woven: id in the library.
    pub weave: Option<String>,
    /// Where the hue of cloth is turned and where it shines: id in the library.
    pub finish: Option<String>,
    /// The figure's map of the head's colour with these freckles.
    pub tint: Option<Freckles>,
    /// Rotation of the hue.
    pub hue_offset_deg: f32,
    /// Repeats of the pattern and the relief, against those of other cloths.
    pub repeat: f32,
    /// Fine structure.
    pub detail: Detail,
    /// Its strength.
    pub detail_strength: f32,
    /// What stands out of the surface.
    pub relief: Relief,
    /// How strongly; 0 for not at all. Cloth with a relief of its own has that one's strength.
    pub relief_strength: f32,
}

/// The surface of a part of a person.
#[must_use]
pub fn surface(kind: PartKind, person: &Person) -> Surface {
    let (look, outfit) = (&person.look, &person.outfit);
    let (top, bottom, outer) = (&outfit.top, &outfit.bottom, &outfit.outer);
    let shoe = outfit.shoes.color;
    match kind {
        PartKind::Head => head_surface(look, person.body.age_years as f32),
        PartKind::Skin => body_surface(look),
        PartKind::Underwear => plain(mix([0.05; 3], narrow(bottom.color), 0.15), 0.85),
        PartKind::Lashes => plain(lash_color(look), 0.6),
        PartKind::Eyes => eye_surface(look),
        PartKind::Teeth => plain([0.78, 0.74, 0.64], 0.25),
        // Between the locks it is darker than on them.
        // What lies under the locks has no strands that would shine.
        PartKind::Hair => Surface { roughness: 0.9, ..hair_surface(look, 0.72) },
        PartKind::Locks => hair_surface(look, 1.0),
        PartKind::LightLocks => hair_surface(look, 1.28),
        PartKind::Headwear => headwear_surface(look),
        PartKind::Frame => match look.glasses {
            // So thin that sharp highlights would be single pixels.
            Glasses::Thin => plain([0.16, 0.15, 0.14], 0.5),
            _ => plain([0.012, 0.011, 0.011], 0.6),
        },
        PartKind::Lenses => plain([0.016, 0.012, 0.009], 0.10),
        PartKind::Top => top_surface(top),
        PartKind::Bottom => bottom_surface(bottom),
        PartKind::Outer => {
            let cloth = Surface {
                weave: outer.relief.clone(),
                finish: outer.finish.clone(),
                ..cloth(outer.color, outer.texture.as_ref(), outer.hue_offset_deg)
            };
            match outer.kind {
                OuterKind::Coat => sewn(cloth, Sewn::Coat, ([0.030, 0.026, 0.022], 0.3)),
                _ => sewn(cloth, Sewn::Jacket, ([0.16, 0.155, 0.15], 0.35)),
            }
        }
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
        weave: None,
        finish: None,
        tint: None,
        hue_offset_deg: 0.0,
        repeat: 1.0,
        detail: Detail::None,
        detail_strength: 0.0,
        relief: Relief::Cloth,
        relief_strength: 0.0,
    }
}

fn head_surface(look: &Look, age_years: f32) -> Surface {
    let (skin, hair) = (narrow(look.skin_color), narrow(look.hair_color));
    let shade = match look.hair {
        HairStyle::Bald => ScalpShade::Shaven,
        HairStyle::Balding => ScalpShade::Wreath,
        _ => ScalpShade::Full,
    };
    let scalp = mix(skin, hair, if look.hair == HairStyle::Cropped { 0.85 } else { 0.95 });
    let old = furrowed(age_years);
    Surface {
        wrap: 0.25,
        mask: Mask::Head(shade, whiskers(look.beard)),
        layers: [
            layer(tinted(skin, [0.78, 0.44, 0.43]), 0.40),
            layer(mix(tinted(hair, [0.66; 3]), tinted(skin, [0.5, 0.45, 0.42]), 0.18), 0.65),
            flushed(look),
            layer(scalp, 0.60),
        ],
        tint: Some(match look.freckles {
            f if f < 0.1 => Freckles::None,
            f if f < 0.6 => Freckles::Some,
            _ => Freckles::Many,
        }),
        detail: Detail::Age,
        detail_strength: 0.45 * old,
        relief: Relief::Detail,
        relief_strength: old,
        ..plain(skin, 0.60)
    }
}

fn body_surface(look: &Look) -> Surface {
    let skin = narrow(look.skin_color);
    Surface {
        wrap: 0.25,
        mask: Mask::Body,
        layers: [
            layer(tinted(skin, [0.78, 0.44, 0.43]), 0.40),
            [0.0; 4],
            flushed(look),
            // Blood shows through nails, whatever the skin's colour; they shine.
            layer(mix(skin, [0.70, 0.42, 0.36], 0.5), 0.25),
        ],
        detail: Detail::Skin,
        detail_strength: 0.12,
        ..plain(skin, 0.60)
    }
}

/// Skin through which blood shows: the more so, the lighter it is.
fn flushed(look: &Look) -> [f32; 4] {
    let skin = narrow(look.skin_color);
    let shows = (luminance(skin) / 0.35).clamp(0.25, 1.0) * look.flush.clamp(0.0, 1.0) as f32;
    layer(mix(skin, tinted(skin, [0.88, 0.48, 0.43]), shows), 0.50)
}

/// How furrowed a face is, as a share of the figure's map: faintly from youth on, fully by 75.
fn furrowed(age_years: f32) -> f32 {
    const BY_AGE: [(f32, f32); 7] = [
        (14.0, 0.0),
        (25.0, 0.06),
        (38.0, 0.18),
        (50.0, 0.48),
        (62.0, 0.78),
        (75.0, 1.05),
        (90.0, 1.30),
    ];
    let mut last = BY_AGE[0];
    for next in BY_AGE {
        if age_years < next.0 {
            let t = (age_years - last.0) / (next.0 - last.0).max(1.0);
            return last.1 + t.max(0.0) * (next.1 - last.1);
        }
        last = next;
    }
    last.1
}

/// Lashes keep their colour longer than the hair and are darker than it.
fn lash_color(look: &Look) -> [f32; 3] {
    mix(tinted(narrow(look.hair_color), [0.25; 3]), [0.012, 0.010, 0.009], 0.7)
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
    let tied = matches!(look.hair, HairStyle::Ponytail | HairStyle::Bun | HairStyle::Braids);
    // Strands side by side under tension hardly differ.
    let tone = if tied { 1.0 + 0.4 * (tone - 1.0) } else { tone };
    let coiled = matches!(look.hair, HairStyle::Afro | HairStyle::Cropped | HairStyle::CrewCut);
    // Tight curls scatter what long strands reflect.
    let roughness = match look.hair {
        HairStyle::Afro | HairStyle::Cropped | HairStyle::Bald | HairStyle::Balding => 0.90,
        HairStyle::Curly | HairStyle::CrewCut => 0.75,
        HairStyle::Short | HairStyle::SideParting | HairStyle::Pixie => 0.62,
        _ => 0.52,
    };
    Surface {
        detail: if coiled { Detail::Curls } else { Detail::Hair },
        detail_strength: if coiled { 0.9 } else { 0.7 },
        wrap: 0.10,
        relief: Relief::Detail,
        relief_strength: if coiled { 1.0 } else { 0.8 },
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
        // Scarves crease, felt does not.
        relief_strength: if look.headwear.kind == HeadwearKind::Headscarf { 0.8 } else { 0.0 },
        ..plain(narrow(look.headwear.color), roughness)
    }
}

fn cloth(color: [f64; 3], texture: Option<&String>, hue_offset_deg: f64) -> Surface {
    Surface {
        // The stitches of knitwear are painted large.
        repeat: if texture.is_some_and(|id| id.contains("/knit/")) { 2.0 } else { 1.0 }
            * CLOTH_REPEAT,
        texture: texture.cloned(),
        hue_offset_deg: hue_offset_deg as f32,
        detail: Detail::Cloth,
        detail_strength: 0.10,
        relief_strength: 0.5,
        ..plain(narrow(color), 0.85)
    }
}

fn top_surface(top: &Top) -> Surface {
    let cloth = Surface {
        weave: top.relief.clone(),
        finish: top.finish.clone(),
        relief_strength: top_relief(top.kind),
        ..cloth(top.color, top.texture.as_ref(), top.hue_offset_deg)
    };
    let light = luminance(cloth.base_color);
    // Buttons and cords stand out from their cloth.
    let pale = if light > 0.45 { [0.40, 0.36, 0.30] } else { [0.58, 0.56, 0.52] };
    match top.kind {
        TopKind::Shirt => sewn(cloth, Sewn::Shirt, (pale, 0.3)),
        TopKind::Polo => sewn(cloth, Sewn::Polo, (pale, 0.3)),
        TopKind::Hoodie => sewn(cloth, Sewn::Hoodie, (pale, 0.9)),
        _ => sewn(cloth, Sewn::Knit, (pale, 0.9)),
    }
}

fn bottom_surface(bottom: &Bottom) -> Surface {
    let cloth = Surface {
        weave: bottom.relief.clone(),
        finish: bottom.finish.clone(),
        relief_strength: bottom_relief(bottom.kind),
        ..cloth(bottom.color, bottom.texture.as_ref(), bottom.hue_offset_deg)
    };
    match bottom.kind {
        BottomKind::Jeans => sewn(cloth, Sewn::Trousers, ([0.34, 0.17, 0.06], 0.8)),
        BottomKind::Trousers | BottomKind::Shorts => {
            let thread = tinted(cloth.base_color, [0.5; 3]);
            sewn(cloth, Sewn::Trousers, (thread, 0.9))
        }
        _ => cloth,
    }
}

/// Cloth with its seams, and what is sewn on in a colour and roughness of its own.
fn sewn(cloth: Surface, kind: Sewn, (on, roughness): ([f32; 3], f32)) -> Surface {
    // Layers do not take part in the rotation of the hue: a turned one has grey seams.
    let color = match cloth.hue_offset_deg {
        0.0 => cloth.base_color,
        _ => [luminance(cloth.base_color); 3],
    };
    let tone = |by: f32| layer(tinted(color, [by; 3]), cloth.roughness);
    Surface {
        mask: Mask::Sewn(kind),
        layers: [tone(0.64), layer(on, roughness), tone(0.8), tone(0.6)],
        ..cloth
    }
}

fn luminance(color: [f32; 3]) -> f32 {
    0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]
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
    if luminance(shoe) > 0.25 {
        tinted(shoe, [0.35, 0.33, 0.32])
    } else {
        mix(shoe, [0.55, 0.53, 0.5], 0.35)
    }
}
