//! The finish of cloth: where its hue is turned, and where it shines.
//!
//! A repeat shows about a quarter of a metre, as in [`super::cloth`]. Red is the share of the hue's
//! rotation, green the gloss, both plain numbers; blue is unused.

use super::Painting;
use super::canvas::{Canvas, FULL, SIDE, fract, sin_turns, smooth};
use super::dice::Dice;
use super::field::{Cells, Field};

/// A figure 0..1 on a ground, each with its share of the hue and its gloss.
fn finish(dice: &mut Dice, figure: &Field) -> Painting {
    let (low, high) = (dice.range(0.0, 0.25), dice.range(0.75, 1.0));
    let (dull, bright) = (dice.range(0.0, 0.15), dice.range(0.3, 0.75));
    let (turned, shines) = (dice.chance(0.5), dice.chance(0.6));
    // Yarn is nowhere quite even.
    let yarn = Field::fbm(dice, 48, 3);
    Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let v = figure.0[i].clamp(0.0, 1.0);
        let of = |flip: bool| if flip { v } else { 1.0 - v };
        let uneven = 0.06 * yarn.0[i];
        let hue = low + (high - low) * of(turned);
        let gloss = dull + (bright - dull) * of(shines) + uneven;
        [hue.clamp(0.0, 1.0), gloss.clamp(0.0, 1.0), 0.0]
    })
    .into()
}

/// Where a pixel is, in repeats of so many over the canvas.
fn place(x: usize, y: usize, count: f32) -> [f32; 2] {
    [x, y].map(|v| (v as f32 + 0.5) / FULL * count)
}

/// The angle of a direction.
fn turns(u: f32, v: f32) -> f32 {
    libm::atan2f(v, u) * std::f32::consts::FRAC_1_PI * 0.5
}

/// Washed with stones: pale flecks and clouds.
pub(super) fn acid(dice: &mut Dice) -> Painting {
    let (clouds, flecks) = (Field::fbm(dice, 6, 5), Field::fbm(dice, 40, 3));
    let figure = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        smooth(-0.25, 0.45, clouds.0[i] + 0.35 * flecks.0[i])
    });
    finish(dice, &figure)
}

/// Blocks of two tones.
pub(super) fn blocks(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[2.0f32, 4.0]);
    let share = dice.range(0.3, 0.7);
    let figure = Field::from_fn(|x, y| {
        let [u, v] = place(x, y, count);
        let brick = fract(v * 0.5) < 0.5;
        f32::from(u8::from(fract(u + if brick { 0.5 } else { 0.0 }) < share))
    });
    finish(dice, &figure)
}

/// Rings woven into silk.
pub(super) fn brocade(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[4.0f32, 8.0]);
    let petals = dice.pick(&[4.0f32, 6.0, 8.0]);
    let figure = Field::from_fn(|x, y| {
        let [u, v] = place(x, y, count).map(|t| fract(t) - 0.5);
        let (radius, angle) = ((u * u + v * v).sqrt(), turns(u, v));
        let edge = 0.3 + 0.1 * sin_turns(angle * petals);
        smooth(0.02, 0.0, (radius - edge).abs() - 0.05).max(smooth(0.14, 0.10, radius))
    });
    finish(dice, &figure)
}

/// Worn bright along creases.
pub(super) fn crackle(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[8usize, 14]);
    let cells = Cells::new(dice, count, 0.9);
    let size = FULL / count as f32;
    let figure = Field::from_fn(|x, y| {
        let near = cells.near(x as f32, y as f32);
        smooth(0.16, 0.04, (near.second - near.first) / size)
    });
    finish(dice, &figure)
}

/// Leaves and scrolls of damask, matt on shining ground.
pub(super) fn damask(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[2.0f32, 4.0]);
    let bend = Field::fbm(dice, 8, 3);
    let figure = Field::from_fn(|x, y| {
        let [u, v] = place(x, y, count);
        let wave = 0.2 * sin_turns(v) + 0.05 * bend.0[y * SIDE + x];
        let leaf = (fract(u + wave) - 0.5).abs() - 0.18 - 0.12 * sin_turns(v * 2.0 + 0.25);
        let vein = (fract(u + wave) - 0.5).abs() - 0.02;
        smooth(0.015, -0.015, leaf) * smooth(-0.01, 0.01, vein)
    });
    finish(dice, &figure)
}

/// Sunk into dye, again and again.
pub(super) fn dip(dice: &mut Dice) -> Painting {
    let edge = Field::noise(dice, 12, 2, 3, 0.6);
    let turns = dice.pick(&[1.0f32, 2.0]);
    let figure = Field::from_fn(|x, y| {
        let [_, v] = place(x, y, turns);
        0.5 + 0.5 * sin_turns(v + 0.06 * edge.0[y * SIDE + x])
    });
    finish(dice, &figure)
}

/// Printed foil dots.
pub(super) fn foil(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[8.0f32, 16.0]);
    let radius = dice.range(0.18, 0.34);
    let figure = Field::from_fn(|x, y| {
        let [u, v] = place(x, y, count);
        let odd = !(v as u32).is_multiple_of(2);
        let [du, dv] = [u + if odd { 0.5 } else { 0.0 }, v].map(|t| fract(t) - 0.5);
        smooth(radius + 0.03, radius - 0.03, (du * du + dv * dv).sqrt())
    });
    finish(dice, &figure)
}

/// Watered silk.
pub(super) fn moire(dice: &mut Dice) -> Painting {
    let bend = [Field::fbm(dice, 5, 3), Field::fbm(dice, 9, 3)];
    let count = dice.pick(&[8.0f32, 12.0]);
    let figure = Field::from_fn(|x, y| {
        let [u, v] = place(x, y, 1.0);
        let i = y * SIDE + x;
        let rings = v * count + 1.6 * bend[0].0[i] + 0.5 * bend[1].0[i] + sin_turns(u) * 0.4;
        0.5 + 0.5 * sin_turns(rings)
    });
    finish(dice, &figure)
}

/// A wide panel down the cloth, with edges.
pub(super) fn panels(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[1.0f32, 2.0]);
    let share = dice.range(0.25, 0.6);
    let figure = Field::from_fn(|x, y| {
        let [u, _] = place(x, y, count);
        let edge = (fract(u) - 0.5).abs() - 0.5 * share;
        smooth(0.006, -0.006, edge).max(0.6 * smooth(0.03, 0.02, (edge - 0.05).abs()))
    });
    finish(dice, &figure)
}

/// Stripes of satin and of matt cloth.
pub(super) fn satin(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[8.0f32, 16.0, 32.0]);
    let share = dice.range(0.3, 0.7);
    let across = dice.chance(0.4);
    let figure = Field::from_fn(|x, y| {
        let t = place(x, y, count)[usize::from(across)];
        smooth(0.03, -0.03, (fract(t) - 0.5).abs() - 0.5 * share)
    });
    finish(dice, &figure)
}

/// Splashes of dye.
pub(super) fn splash(dice: &mut Dice) -> Painting {
    let mut canvas = Canvas::filled([0.0; 3]);
    for _ in 0..dice.pick(&[70usize, 130]) {
        let (at, size) = (dice.place(), dice.range(0.02, 0.3));
        canvas.disc(at, 4.0 + 60.0 * size * size, [1.0; 3], dice.range(0.6, 1.0));
    }
    let figure = Field(canvas.0.iter().map(|c| c[0]).collect());
    finish(dice, &figure)
}

/// Tied and dyed in rings.
pub(super) fn tie(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[2usize, 3]);
    let cells = Cells::new(dice, count, 0.6);
    let bend = Field::fbm(dice, 10, 4);
    let size = FULL / count as f32;
    let rings = dice.pick(&[2.0f32, 3.0]);
    let figure = Field::from_fn(|x, y| {
        let near = cells.near(x as f32, y as f32);
        0.5 + 0.5 * sin_turns(near.first / size * rings + 0.22 * bend.0[y * SIDE + x])
    });
    finish(dice, &figure)
}

/// Waxed, rubbed off in places.
pub(super) fn waxed(dice: &mut Dice) -> Painting {
    let (worn, fine) = (Field::fbm(dice, 4, 5), Field::fbm(dice, 64, 2));
    let figure = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        smooth(-0.1, 0.5, worn.0[i] + 0.2 * fine.0[i])
    });
    finish(dice, &figure)
}

/// Zigzags.
pub(super) fn zigzag(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[4.0f32, 8.0]);
    let height = dice.range(0.3, 0.9);
    let figure = Field::from_fn(|x, y| {
        let [u, v] = place(x, y, count);
        let fold = height * (2.0 * (fract(u) - 0.5).abs());
        smooth(0.02, -0.02, (fract(v + fold) - 0.5).abs() - 0.25)
    });
    finish(dice, &figure)
}
