//! Fine structure of skin, hair and cloth: plain numbers round 0.5, for surfaces that have
//! their colour from elsewhere.

use super::Painting;
use super::canvas::{Canvas, SIDE, cos_turns, smooth};
use super::dice::Dice;
use super::field::{Cells, Field};

/// A field as grey, its mean at the middle of the range.
pub(super) fn grey(field: Field) -> Painting {
    Canvas::from_field(&field.with_mean(0.5), |v| [v; 3]).into()
}

/// Blotches, pores and fine lines.
pub(super) fn skin(dice: &mut Dice) -> Painting {
    let blotches = Field::fbm(dice, 4, 4);
    let fine = Field::fbm(dice, 32, 4);
    let pores = Cells::new(dice, 72, 0.95);
    let bend = Field::fbm(dice, 24, 2);
    let mut field = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        let d = 2.5 * bend.0[i];
        let near = pores.near(x as f32 + d, y as f32 - d);
        let pore = smooth(2.6, 0.6, near.first);
        let crease = smooth(1.6, 0.0, near.second - near.first);
        0.16 * blotches.0[i] + 0.16 * fine.0[i] - 0.24 * pore - 0.1 * crease
    });
    // A few freckles.
    for _ in 0..60 {
        let ([cx, cy], r) = (dice.place(), dice.range(2.0, 5.0));
        for y in (cy - r) as i32..=(cy + r) as i32 {
            for x in (cx - r) as i32..=(cx + r) as i32 {
                let (dx, dy) = (x as f32 - cx, y as f32 - cy);
                let d = (dx * dx + dy * dy).sqrt();
                let wrap = |v: i32| (v & (SIDE as i32 - 1)) as usize;
                field.0[wrap(y) * SIDE + wrap(x)] -= 0.22 * smooth(r, 0.0, d);
            }
        }
    }
    grey(field)
}

/// Height of the folds of worn cloth in pixels: soft creases, some across and more aslant.
pub(super) fn fold_height(dice: &mut Dice) -> Field {
    let bend = [Field::fbm(dice, 2, 2), Field::fbm(dice, 2, 2)];
    let broad = Field::noise(dice, 2, 2, 1, 0.5).warped([&bend[0], &bend[1]], 50.0);
    let across = Field::noise(dice, 2, 3, 1, 0.5).warped([&bend[1], &bend[0]], 60.0);
    let places = Field::fbm(dice, 2, 2);
    Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        // A crease is sharper than the cloth between creases, and not everywhere.
        let crease = (1.0 - across.0[i].abs() * 1.8).max(0.0);
        7.0 * broad.0[i] + 7.0 * crease * crease * smooth(-0.15, 0.35, places.0[i])
    })
}

/// Folds alone.
pub(super) fn folds(dice: &mut Dice) -> Painting {
    let height = fold_height(dice);
    let grey = Field(height.0.iter().map(|h| h * 0.03).collect()).with_mean(0.5);
    let color = Canvas::from_field(&grey, |v| [v; 3]);
    Painting { color, height: Some(height) }
}

/// Strands that run along v.
pub(super) fn hair(dice: &mut Dice) -> Painting {
    let wave = Field::noise(dice, 4, 3, 3, 0.5);
    let still = Field::filled(0.0);
    let locks = Field::noise(dice, 24, 2, 2, 0.6).warped([&wave, &still], 9.0);
    let strands = Field::noise(dice, 128, 3, 2, 0.9).warped([&wave, &still], 9.0);
    let tone = Field::noise(dice, 3, 4, 3, 0.5);
    let color = grey(Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        0.24 * locks.0[i] + 0.3 * strands.0[i] + 0.08 * tone.0[i]
    }));
    let height = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        3.2 * locks.0[i] + 0.9 * strands.0[i]
    });
    Painting { height: Some(height), ..color }
}

/// Tight coils, side by side.
pub(super) fn curls(dice: &mut Dice) -> Painting {
    const COUNT: usize = 13;
    let cells = Cells::new(dice, COUNT, 0.95);
    let bend = [Field::fbm(dice, 8, 3), Field::fbm(dice, 8, 3)];
    let fine = Field::fbm(dice, 48, 3);
    let size = SIDE as f32 / COUNT as f32;
    let height = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        let (dx, dy) = (11.0 * bend[0].0[i], 11.0 * bend[1].0[i]);
        let near = cells.near(x as f32 + dx, y as f32 + dy);
        let out = near.first / size;
        // A dome of wound strands, and a gap to the next.
        let gap = smooth(0.0, 0.22 * size, near.second - near.first);
        let wound = 0.5 + 0.5 * cos_turns(3.0 * out);
        gap * (0.75 - 0.6 * out * out + 0.25 * wound) + 0.16 * fine.0[i]
    });
    let color = grey(height.clone().map(|h| 0.55 * h));
    Painting { height: Some(height.map(|h| 0.22 * size * h)), ..color }
}

/// Threads and lint.
pub(super) fn cloth(dice: &mut Dice) -> Painting {
    let threads = [Field::noise(dice, 4, 128, 2, 0.8), Field::noise(dice, 128, 4, 2, 0.8)];
    let lint = Field::fbm(dice, 48, 4);
    grey(Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        let over = (x / 2 + y / 2) % 2 == 0;
        let thread = threads[usize::from(over)].0[i] + if over { 0.3 } else { -0.3 };
        0.2 * thread + 0.18 * lint.0[i]
    }))
}
