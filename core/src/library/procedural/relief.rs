//! The relief of cloth: how it is woven, knitted and sewn.
//!
//! A repeat shows about a quarter of a metre, as in [`super::cloth`], so that a pixel is half a
//! millimetre. Each is a height for the normal map, with the folds of worn cloth under it (the same
//! ones as of cloth without a relief), and plain numbers round 0.5 for the light that hollows lack.

use std::sync::LazyLock;

use super::Painting;
use super::canvas::{FULL, SIDE, cos_turns, fract, sin_turns, smooth};
use super::detail;
use super::dice::Dice;
use super::field::{Cells, Field};

/// Share of the folds of cloth that has no relief of its own.
const FOLDS: f32 = 0.7;
static HEIGHT_OF_FOLDS: LazyLock<Field> =
    LazyLock::new(|| detail::fold_height(&mut Dice::new("detail/folds")));
/// Unevenness of real yarn, as a share of the depth.
const YARN: f32 = 0.12;

/// Cloth of a shape, 0 its hollows .. 1 its ridges, so many pixels deep.
fn cloth(dice: &mut Dice, shape: Field, depth_px: f32) -> Painting {
    let yarn = Field::fbm(dice, 64, 3);
    let height = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        FOLDS * HEIGHT_OF_FOLDS.0[i] + depth_px * (shape.0[i] + YARN * yarn.0[i])
    });
    let hollows = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        0.42 * shape.0[i] + 0.05 * yarn.0[i]
    });
    Painting { height: Some(height), ..detail::grey(hollows) }
}

/// The profile of round yarn over its width 0..1, repeated.
fn yarn(t: f32) -> f32 {
    let d = 2.0 * fract(t) - 1.0;
    (1.0 - d * d).max(0.0).sqrt()
}

/// Yarn of a period over and under that of the other direction.
fn plain_weave(x: f32, y: f32, period: f32) -> f32 {
    let (u, v) = (x / period, y / period);
    let over = (u as u32 + v as u32).is_multiple_of(2);
    let (across, along) = if over { (u, v) } else { (v, u) };
    yarn(across) * (0.45 + 0.55 * yarn(along))
}

/// Threads in bundles, over and under.
pub(super) fn basket(dice: &mut Dice) -> Painting {
    let bundle = dice.pick(&[16.0f32, 32.0]);
    let threads = dice.pick(&[2.0f32, 4.0]);
    let shape = Field::from_fn(|x, y| {
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        let (u, v) = (x / bundle, y / bundle);
        let over = (u as u32 + v as u32).is_multiple_of(2);
        let (across, along) = if over { (u, v) } else { (v, u) };
        yarn(across * threads) * (0.5 + 0.5 * yarn(along))
    });
    cloth(dice, shape, 1.6)
}

/// Loops of curled yarn.
pub(super) fn boucle(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[40usize, 56]);
    let cells = Cells::new(dice, count, 0.95);
    let bend = [Field::fbm(dice, 24, 3), Field::fbm(dice, 24, 3)];
    let size = FULL / count as f32;
    let shape = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        let near = cells.near(x as f32 + 6.0 * bend[0].0[i], y as f32 + 6.0 * bend[1].0[i]);
        let ring = near.first / size - 0.38;
        (1.0 - 9.0 * ring * ring).max(0.0)
    });
    cloth(dice, shape, 1.3)
}

/// Knitted cables between bars of purl.
pub(super) fn cable(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[4.0f32, 8.0]);
    let turns = count * dice.pick(&[1.0f32, 2.0]);
    let size = FULL / count;
    let shape = Field::from_fn(|x, y| {
        let (u, v) = ((x as f32 + 0.5) / size, (y as f32 + 0.5) / FULL);
        let across = fract(u) - 0.5;
        let strand = |phase: f32| {
            let angle = v * turns + phase;
            let off = (across - 0.16 * sin_turns(angle)) / 0.13;
            (1.0 - off * off).max(0.0).sqrt() * (0.75 + 0.25 * cos_turns(angle))
        };
        let cables = strand(0.0).max(strand(0.5));
        let purl = 0.35 * yarn(v * count * 8.0) * smooth(0.30, 0.36, across.abs());
        cables.max(purl)
    });
    cloth(dice, shape, size * 0.05)
}

/// Coarse plain weave, its threads uneven.
pub(super) fn canvas(dice: &mut Dice) -> Painting {
    let period = dice.pick(&[4.0f32, 8.0]);
    let slub = [Field::noise(dice, 4, 64, 2, 0.8), Field::noise(dice, 64, 4, 2, 0.8)];
    let shape = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        let thick = 0.85 + 0.15 * (slub[0].0[i] + slub[1].0[i]);
        thick * plain_weave(x as f32 + 0.5, y as f32 + 0.5, period)
    });
    cloth(dice, shape, 0.2 * period)
}

/// Wales of cut pile.
pub(super) fn corduroy(dice: &mut Dice) -> Painting {
    let period = dice.pick(&[8.0f32, 16.0, 32.0]);
    let pile = Field::noise(dice, 64, 16, 3, 0.7);
    let shape =
        Field::from_fn(|x, y| yarn((x as f32 + 0.5) / period) + 0.10 * pile.0[y * SIDE + x]);
    cloth(dice, shape, 0.22 * period)
}

/// Twisted yarn that draws together all over.
pub(super) fn crepe(dice: &mut Dice) -> Painting {
    let cells = dice.pick(&[40usize, 64]);
    let fine = Field::fbm(dice, cells, 3);
    let shape = fine.map(|v| 0.5 + 0.5 * v);
    cloth(dice, shape, 2.0)
}

/// Creases lengthways, close together.
pub(super) fn crinkle(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[12usize, 20]);
    let bend = [Field::fbm(dice, 4, 3), Field::filled(0.0)];
    let creases = Field::noise(dice, count, 2, 2, 0.6).warped([&bend[0], &bend[1]], 14.0);
    let shape = creases.map(|v| 1.0 - v.abs().min(1.0));
    cloth(dice, shape, 5.0)
}

/// Twill that turns back.
pub(super) fn herringbone(dice: &mut Dice) -> Painting {
    let size = dice.pick(&[16usize, 32, 64]);
    let shape = Field::from_fn(|x, y| {
        let turns = (x / size).is_multiple_of(2);
        let along = if turns { x % size + y } else { size - 1 - x % size + y };
        0.5 + 0.5 * sin_turns(along as f32 / 8.0)
    });
    cloth(dice, shape, 1.0)
}

/// Dimples in rows, each row between those of the next.
pub(super) fn pique(dice: &mut Dice) -> Painting {
    let period = dice.pick(&[8.0f32, 16.0]);
    let shape = Field::from_fn(|x, y| {
        let v = (y as f32 + 0.5) / period;
        let shift = if (v as u32).is_multiple_of(2) { 0.0 } else { 0.5 };
        let (a, b) = (fract((x as f32 + 0.5) / period + shift) - 0.5, fract(v) - 0.5);
        smooth(0.12, 0.42, (a * a + b * b).sqrt())
    });
    cloth(dice, shape, 0.14 * period)
}

/// Knife pleats.
pub(super) fn pleats(dice: &mut Dice) -> Painting {
    let period = dice.pick(&[32.0f32, 64.0]);
    let bend = Field::fbm(dice, 3, 2);
    let shape = Field::from_fn(|x, y| {
        let t = fract((x as f32 + 0.5 + 2.0 * bend.0[y * SIDE + x]) / period);
        // A long slope, and a short one under the fold.
        if t < 0.86 { t / 0.86 } else { (1.0 - t) / 0.14 }
    });
    cloth(dice, shape, 0.10 * period)
}

/// Padding sewn in diamonds or squares.
pub(super) fn quilt(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[2.0f32, 4.0]);
    let aslant = dice.chance(0.6);
    let stitches = FULL / 8.0;
    let shape = Field::from_fn(|x, y| {
        let (u, v) = ((x as f32 + 0.5) / FULL, (y as f32 + 0.5) / FULL);
        let (a, b) = if aslant { (u + v, u - v + 1.0) } else { (u, v) };
        let puff = |t: f32| yarn(t * count).sqrt();
        let seam = 0.1 * yarn((u + 2.0 * v) * stitches);
        (puff(a) * puff(b)).max(seam)
    });
    cloth(dice, shape, FULL / count * 0.035)
}

/// Knitted ribs: columns of stitches that stand out.
pub(super) fn rib(dice: &mut Dice) -> Painting {
    let period = dice.pick(&[16.0f32, 32.0]);
    let shape = Field::from_fn(|x, y| {
        let (u, v) = ((x as f32 + 0.5) / period, (y as f32 + 0.5) / period);
        let off = (fract(u) - 0.5).abs();
        let stitch = yarn(2.0 * v + 1.6 * off);
        yarn(u) * (0.78 + 0.22 * stitch)
    });
    cloth(dice, shape, 0.16 * period)
}

/// Stripes of loose threads between tight ones, which pucker.
pub(super) fn seersucker(dice: &mut Dice) -> Painting {
    let period = dice.pick(&[32usize, 64]);
    let pucker = Field::noise(dice, 24, 32, 2, 0.6);
    let shape = Field::from_fn(|x, y| {
        let t = (x % period) as f32 / period as f32;
        let loose = smooth(0.46, 0.54, t) * smooth(1.0, 0.92, t);
        0.5 + loose * 0.6 * pucker.0[y * SIDE + x]
    });
    cloth(dice, shape, 4.0)
}

/// Towelling: loops that stand up.
pub(super) fn terry(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[64usize, 80]);
    let cells = Cells::new(dice, count, 0.8);
    let size = FULL / count as f32;
    let shape = Field::from_fn(|x, y| {
        let out = cells.near(x as f32, y as f32).first / size;
        (1.0 - 1.6 * out * out).max(0.0)
    });
    cloth(dice, shape, 2.0)
}

/// Ridges aslant, to the one side or the other.
pub(super) fn twill(dice: &mut Dice) -> Painting {
    let period = dice.pick(&[8.0f32, 8.0, 16.0]);
    let (steep, left) = (dice.pick(&[1usize, 2]), dice.chance(0.5));
    let shape = Field::from_fn(|x, y| {
        let x = if left { SIDE - 1 - x } else { x };
        0.5 + 0.5 * sin_turns((x * steep + y) as f32 / period)
    });
    cloth(dice, shape, 0.12 * period)
}

/// Honeycomb of squares.
pub(super) fn waffle(dice: &mut Dice) -> Painting {
    let period = dice.pick(&[16.0f32, 32.0]);
    let shape = Field::from_fn(|x, y| {
        let side = |t: usize| (2.0 * fract((t as f32 + 0.5) / period) - 1.0).abs();
        let ridge = side(x).max(side(y));
        ridge * ridge
    });
    cloth(dice, shape, 0.14 * period)
}
