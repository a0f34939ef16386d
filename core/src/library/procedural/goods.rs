//! Packages and bottles, alone and on shelves.

use super::Painting;
use super::canvas::{BLACK, Canvas, FULL, WHITE, hex, hsv, lit, luma, mix, palette, smooth};
use super::dice::Dice;
use super::field::Field;
use super::letters::{ADVANCE, Type, number, word, write};

/// The front of a package: name, picture, ribbons and small print.
fn package(dice: &mut Dice, canvas: &mut Canvas, [x, y]: [f32; 2], [w, h]: [f32; 2]) {
    let colors = palette(dice);
    let (base, second) = (colors[0], mix(colors[1], colors[0], dice.range(0.0, 0.6)));
    let split = dice.range(0.3, 0.7);
    let curve = dice.range(-0.25, 0.25);
    canvas.stamp_box([x, y], [x + w, y + h], |px, py| {
        let (u, v) = ((px - x) / w, (py - y) / h);
        let line = split + curve * (u - 0.5) * (u - 0.5) * 4.0;
        let side = 0.78 + 0.9 * (u * (1.0 - u)).min(0.25);
        (lit(if v < line { base } else { second }, side), 1.0)
    });
    // The picture: fruit, biscuits, bubbles.
    let heart = [x + w * dice.range(0.35, 0.65), y + h * dice.range(0.6, 0.75)];
    let fruit = colors[2];
    for _ in 0..3 + dice.below(6) {
        let u = dice.direction();
        let away = dice.range(0.0, 0.22) * w;
        let place = [heart[0] + u[0] * away, heart[1] + u[1] * away];
        let radius = w * dice.range(0.08, 0.17);
        let tone = lit(fruit, dice.range(0.8, 1.15));
        canvas.stamp(place, radius + 1.0, |dx, dy| {
            let d2 = (dx * dx + dy * dy) / (radius * radius);
            let light = 1.15 - 0.55 * d2 - 0.25 * (dx + dy) / radius;
            (lit(tone, light), ((1.0 - d2) * radius * 0.5).clamp(0.0, 1.0))
        });
    }
    let ink = if luma(base) > 0.55 { hex(0x1a1a1a) } else { WHITE };
    let letters = 4 + dice.below(4);
    let height = (w * 0.86 / (letters as f32 * ADVANCE)).min(h * 0.24);
    let name = word(dice, letters);
    let set = Type {
        height,
        weight: dice.range(-0.05, 0.2),
        slant: dice.pick(&[0.0, 0.0, 0.2]),
        color: ink,
    };
    let left = x + (w - letters as f32 * height * ADVANCE) * 0.5;
    let shadow = Type { color: lit(base, 0.4), ..set };
    write(canvas, [left + height * 0.06, y + h * 0.1 + height * 0.08], &name, shadow);
    write(canvas, [left, y + h * 0.1], &name, set);
    canvas.rect(
        [x + w * 0.1, y + h * 0.12 + height * 1.25],
        [w * 0.8, (h * 0.05).max(2.0)],
        colors[3],
        1.0,
    );
    if dice.chance(0.5) {
        let badge = [x + w * 0.8, y + h * 0.42];
        canvas.disc(badge, w * 0.13, colors[4], 1.0);
        let digits = number(dice, 2);
        let size = w * 0.12;
        let color = if luma(colors[4]) > 0.5 { BLACK } else { WHITE };
        let at = [badge[0] - size * 0.85, badge[1] - size * 0.5];
        write(canvas, at, &digits, Type { height: size, weight: 0.1, slant: 0.0, color });
    }
    for k in 0..3 {
        let long = w * dice.range(0.4, 0.8);
        canvas.rect([x + w * 0.1, y + h * (0.9 + 0.025 * k as f32)], [long, 1.5], ink, 0.5);
    }
}

/// Packages that fill the picture, one to sixteen of them.
pub(super) fn groceries(dice: &mut Dice) -> Painting {
    let (columns, rows) = dice.pick(&[(1usize, 1usize), (2, 1), (2, 2), (3, 2), (4, 3)]);
    let (w, h) = (FULL / columns as f32, FULL / rows as f32);
    let mut canvas = Canvas::filled(hex(0x777777));
    for row in 0..rows {
        for column in 0..columns {
            package(dice, &mut canvas, [column as f32 * w, row as f32 * h], [w, h]);
        }
    }
    canvas.shade(&Field::fbm(dice, 2, 3), 0.1);
    canvas.grain(dice, 0.015);
    canvas.into()
}

/// Shop shelves with rows of goods.
pub(super) fn shelf(dice: &mut Dice) -> Painting {
    let rows = dice.pick(&[2usize, 3, 4]);
    let h = FULL / rows as f32;
    let board = lit(mix(hex(0xd8d4cc), hex(0x5a4632), dice.unit()), 0.9);
    let mut canvas = Canvas::filled(hex(0x1e1c1a));
    for row in 0..rows {
        let floor = (row as f32 + 1.0) * h - h * 0.1;
        let mut x = 0.0;
        while x < FULL - h * 0.15 {
            let width = h * dice.range(0.24, 0.5);
            let tall = h * dice.range(0.55, 0.84);
            let copies = 1 + dice.below(3);
            let look = dice.clone();
            for _ in 0..copies {
                if x >= FULL {
                    break;
                }
                // Copies of one product are alike: they are painted with the same numbers.
                let mut same = look.clone();
                let shown = width.min(FULL - x) - 1.5;
                if same.chance(0.3) {
                    bottle(&mut same, &mut canvas, [x, floor - tall], [shown, tall]);
                } else {
                    package(&mut same, &mut canvas, [x, floor - tall], [shown, tall]);
                }
                x += width;
            }
            dice.bits();
        }
        canvas.stamp_box([0.0, row as f32 * h], [FULL, row as f32 * h + h * 0.3], |_, y| {
            (BLACK, 0.6 * (1.0 - (y - row as f32 * h) / (h * 0.3)))
        });
        canvas.rect([0.0, floor], [FULL, h * 0.1], board, 1.0);
        canvas.rect([0.0, floor + h * 0.08], [FULL, h * 0.02], lit(board, 0.5), 1.0);
        for k in 0..6 {
            let tag = [(k as f32 + dice.range(0.2, 0.8)) * FULL / 6.0, floor + h * 0.015];
            canvas.rect(tag, [h * 0.16, h * 0.06], hex(0xfdf6c8), 1.0);
            let digits = number(dice, 3);
            let set = Type { height: h * 0.045, weight: 0.1, slant: 0.0, color: hex(0xb01020) };
            write(&mut canvas, [tag[0] + 2.0, tag[1] + 1.5], &digits, set);
        }
    }
    canvas.grain(dice, 0.015);
    canvas.into()
}

fn bottle(dice: &mut Dice, canvas: &mut Canvas, [x, y]: [f32; 2], [w, h]: [f32; 2]) {
    let glass = hsv(dice.unit(), dice.range(0.3, 0.8), dice.range(0.25, 0.7));
    let (cap, label) = (hsv(dice.unit(), 0.7, 0.8), mix(hsv(dice.unit(), 0.6, 0.8), WHITE, 0.5));
    let neck = dice.range(0.22, 0.36);
    canvas.stamp_box([x, y], [x + w, y + h], |px, py| {
        let v = (py - y) / h;
        let half = if v < neck { 0.16 } else { 0.16 + 0.3 * smooth(neck, neck + 0.14, v) };
        let u = ((px - x) / w - 0.5) / half;
        let edge = ((1.0 - u.abs()) * half * w).clamp(0.0, 1.0);
        let round = 0.55 + 0.5 * (1.0 - u * u).max(0.0) + 0.5 * smooth(0.16, 0.0, (u + 0.45).abs());
        let color = if v < 0.07 {
            cap
        } else if v > 0.5 && v < 0.82 {
            if v > 0.56 && v < 0.66 { lit(glass, 0.7) } else { label }
        } else {
            glass
        };
        (lit(color, round), edge)
    });
}
