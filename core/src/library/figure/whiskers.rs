//! Where hair grows on face and scalp.
//!
//! Fields over the template (metres; +Y up, +Z forward), so that they fit every face. What grows
//! sparsely, or shows through, is a shade of the skin and no geometry: [`super::maps`] paints it.

/// What of the scalp is shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScalpShade {
    /// All of it.
    Full,
    /// The wreath of a balding head.
    Wreath,
    /// Barely: a shaven head.
    Shaven,
}

/// What grows on the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Whiskers {
    /// Nothing.
    None,
    /// A shade.
    Stubble,
    /// On the upper lip.
    Moustache,
    /// Round the mouth.
    Goatee,
    /// All of it.
    Full,
}

impl Whiskers {
    /// All, in order.
    pub const ALL: [Self; 5] =
        [Self::None, Self::Stubble, Self::Moustache, Self::Goatee, Self::Full];
}

/// 0 below a, 1 above b, smooth between; falling where a > b.
fn step(a: f32, b: f32, x: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// How much hair a balding head has at a place on the template: all at the sides and the back,
/// none on top.
#[must_use]
pub fn wreath([x, y, z]: [f32; 3]) -> f32 {
    // The edge runs higher at the back than at the temples.
    let edge = 0.790 + 0.012 * step(0.02, -0.06, z)
        - 0.06 * step(0.03, 0.09, z)
        - 0.06 * step(0.08, 0.15, z);
    let wavy = 0.003 * libm::sinf(140.0 * x + 60.0 * z);
    step(edge + 0.016 + wavy, edge - 0.016 + wavy, y)
}

/// About the distance inside the border of a beard, metres; negative where none grows.
#[must_use]
pub fn beard(style: Whiskers, [x, y, z]: [f32; 3]) -> f32 {
    let x = x.abs();
    // Only in front of the ears and above the throat.
    if z < 0.02 || !(0.60..0.75).contains(&y) {
        return -1.0;
    }
    let lips = {
        let (a, b) = (x / 0.029, (y - LIPS_Y) / LIPS_HALF_M);
        ((a * a + b * b).sqrt() - 1.0) * LIPS_HALF_M
    };
    let moustache = {
        let middle = LIPS_Y + 0.0155 - 0.22 * (x - 0.012).max(0.0);
        (0.0065 - (y - middle).abs()).min(0.036 - x).min(z - 0.10)
    };
    let chin = {
        let top = LIPS_Y - LIPS_HALF_M - 0.001;
        (0.024 - x).min(top - y).min(y - 0.632).min(z - 0.07)
    };
    let ring = {
        // From the corners of the mouth down to the chin.
        let middle = 0.0345 - 0.22 * (LIPS_Y - y).max(0.0);
        (0.0065 - (x - middle).abs()).min(LIPS_Y + 0.012 - y).min(y - 0.634).min(z - 0.07)
    };
    let jaw = {
        // The cheek's line rises from the corner of the mouth to the sideburn before the ear.
        let cheek = LIPS_Y
            + 0.004
            + 0.016 * step(0.125, 0.092, z)
            + 0.022 * step(0.094, 0.074, z)
            + 0.036 * step(0.074, 0.064, z);
        let throat = 0.622 + 0.25 * (0.11 - z).max(0.0);
        let back = 0.034 + 0.020 * step(0.665, 0.690, y);
        (cheek - y).min(y - throat).min(z - back)
    };
    let grown = match style {
        Whiskers::None => -1.0,
        Whiskers::Moustache => moustache,
        Whiskers::Goatee => moustache.max(chin).max(ring),
        Whiskers::Stubble | Whiskers::Full => jaw.max(moustache).max(chin),
    };
    grown.min(lips)
}

/// Height of the mouth's middle and half the height of the lips on the template.
const LIPS_Y: f32 = 0.6625;
const LIPS_HALF_M: f32 = 0.0085;

/// Share of the hair's colour in the skin under a beard.
const fn density(style: Whiskers) -> f32 {
    match style {
        Whiskers::None => 0.0,
        Whiskers::Stubble => 0.42,
        Whiskers::Moustache | Whiskers::Goatee | Whiskers::Full => 0.85,
    }
}

/// How much hair shades the skin at a place whose scalp the figure's own mask shades by `alpha`.
pub(super) fn shade(alpha: f32, scalp: ScalpShade, style: Whiskers, at: [f32; 3]) -> f32 {
    let scalp = alpha
        * match scalp {
            ScalpShade::Full => 1.0,
            ScalpShade::Wreath => wreath(at).max(0.10),
            ScalpShade::Shaven => 0.10,
        };
    // Stubble thins out towards its border; a beard hides where it begins.
    let (none, full) = if style == Whiskers::Stubble { (-0.005, 0.014) } else { (-0.003, 0.005) };
    scalp.max(density(style) * step(none, full, beard(style, at)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::figure::{Figure, GroupId};

    #[test]
    fn beards_leave_lips_eyes_and_throat_free() {
        let figure = Figure::built_in().unwrap();
        let t = figure.template();
        let at = |v: usize| [t.x[v], t.y[v], t.z[v]];
        let count = figure.group(GroupId::Skin).count;
        let skin: Vec<[f32; 3]> =
            figure.vertices(GroupId::Skin, count).map(at).filter(|p| p[1] > 0.58).collect();
        let grown = |style| skin.iter().filter(|p| beard(style, **p) > 0.0).count();
        assert_eq!(grown(Whiskers::None), 0);
        assert!(grown(Whiskers::Moustache) > 8);
        assert!(grown(Whiskers::Goatee) > grown(Whiskers::Moustache) + 20);
        assert!(grown(Whiskers::Full) > 2 * grown(Whiskers::Goatee));
        for style in Whiskers::ALL {
            for p in &skin {
                let eyes = p[1] > 0.715 && p[0].abs() < 0.05;
                let nose = p[2] > 0.152 && p[1] > 0.690;
                let throat = p[1] < 0.615;
                assert!(!(eyes || nose || throat) || beard(style, *p) <= 0.0, "{style:?} {p:?}");
                assert_eq!(beard(style, *p), beard(style, [-p[0], p[1], p[2]]));
            }
        }
    }

    #[test]
    fn a_wreath_is_bare_on_top_and_full_at_the_back() {
        assert_eq!(wreath([0.0, 0.84, 0.04]), 0.0);
        assert_eq!(wreath([0.0, 0.80, 0.14]), 0.0);
        assert_eq!(wreath([0.0, 0.72, -0.06]), 1.0);
        assert_eq!(wreath([0.075, 0.76, 0.0]), 1.0);
    }

    #[test]
    fn a_painted_mask_changes_the_scalp_alone() {
        let figure = Figure::built_in().unwrap();
        let plain = figure.head_mask(ScalpShade::Full, Whiskers::None);
        let painted = figure.head_mask(ScalpShade::Wreath, Whiskers::Full);
        assert_eq!(painted.texels.len(), plain.texels.len());
        let (mut more, mut less) = (0, 0);
        let side = 1usize << plain.log2_size;
        for (a, b) in plain.texels[..side * side].iter().zip(painted.texels.iter()) {
            assert_eq!(a & 0x00ff_ffff, b & 0x00ff_ffff);
            more += usize::from(b >> 24 > a >> 24);
            less += usize::from(b >> 24 < a >> 24);
        }
        assert!(more > 2000 && less > 2000, "{more} {less}");
    }
}
