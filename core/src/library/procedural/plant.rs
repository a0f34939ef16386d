//! What grows: foliage, flowers, grass and bark.

use super::Painting;
use super::canvas::{Canvas, Rgb, SIDE, cos_turns, hex, hsv, lit, mix, palette, sin_turns};
use super::dice::Dice;
use super::field::Field;

/// A leaf with a lighter middle rib and one half in the shade.
fn leaf(canvas: &mut Canvas, place: [f32; 2], u: [f32; 2], size: [f32; 2], color: Rgb) {
    canvas.ellipse(place, u, size, |s, t| {
        let rib = if t.abs() < 0.09 { 1.25 } else { 1.0 };
        let half = if t > 0.0 { 0.86 } else { 1.05 };
        lit(color, rib * half * (1.0 - 0.22 * s.abs()))
    });
}

/// Layers of leaves, dark ones below.
pub(super) fn leaves(dice: &mut Dice) -> Painting {
    let hue = dice.pick(&[0.28f32, 0.25, 0.33, 0.22, 0.09, 0.04, 0.4]);
    let (long, wide) = (dice.range(14.0, 26.0), dice.range(0.3, 0.62));
    let mut canvas = Canvas::filled(hsv(hue, 0.7, 0.08));
    canvas.shade(&Field::fbm(dice, 8, 4), 0.6);
    let count = (90_000.0 / (long * long)) as usize + 160;
    for k in 0..count {
        let depth = k as f32 / count as f32;
        let (place, u) = (dice.place(), dice.direction());
        let value = (0.12 + 0.55 * depth) * dice.range(0.8, 1.2);
        let color = hsv(hue + dice.range(-0.035, 0.035), dice.range(0.45, 0.8), value);
        let scale = dice.range(0.7, 1.1);
        // A soft shadow lifts each leaf off those below.
        let shadow = [place[0] + 2.5, place[1] + 3.5];
        canvas.stroke(
            [shadow[0] - u[0] * long * 0.5 * scale, shadow[1] - u[1] * long * 0.5 * scale],
            [shadow[0] + u[0] * long * 0.5 * scale, shadow[1] + u[1] * long * 0.5 * scale],
            long * wide * scale,
            4.0,
            hsv(hue, 0.8, 0.03),
            0.4,
        );
        leaf(&mut canvas, place, u, [long * scale, long * wide * scale], color);
    }
    canvas.grain(dice, 0.02);
    canvas.into()
}

/// A flower of petals round a disc.
fn flower(
    dice: &mut Dice,
    canvas: &mut Canvas,
    place: [f32; 2],
    radius: f32,
    color: Rgb,
    eye: Rgb,
) {
    let petals = 5 + dice.below(4);
    let turn = dice.unit();
    let wide = (2.1 / petals as f32).min(0.36);
    for k in 0..petals {
        let angle = turn + k as f32 / petals as f32;
        let u = [cos_turns(angle), sin_turns(angle)];
        let middle = [place[0] + u[0] * radius * 0.58, place[1] + u[1] * radius * 0.58];
        canvas.ellipse(middle, u, [radius * 0.46, radius * wide], |s, t| {
            lit(mix(color, eye, 0.35 * (0.5 - 0.5 * s)), 1.05 - 0.22 * t.abs() - 0.1 * s.abs())
        });
    }
    canvas.disc(place, radius * 0.22, lit(eye, 0.75), 1.0);
    canvas.disc([place[0] - 1.0, place[1] - 1.0], radius * 0.17, eye, 1.0);
}

/// Flowers and twigs on a plain ground: wallpaper, dresses and meadows.
pub(super) fn floral(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let ground = mix(colors[0], hex(0xf4efe6), dice.pick(&[0.0f32, 0.5, 0.8]));
    let green = hsv(dice.range(0.22, 0.42), dice.range(0.3, 0.65), dice.range(0.3, 0.6));
    let mut canvas = Canvas::filled(ground);
    let count = dice.pick(&[4usize, 5, 6, 8]);
    let size = SIDE as f32 / count as f32;
    for row in 0..count {
        for column in 0..count {
            let shift = if row % 2 == 1 { 0.5 } else { 0.0 };
            let place = [
                (column as f32 + shift + dice.range(0.3, 0.7)) * size,
                (row as f32 + dice.range(0.3, 0.7)) * size,
            ];
            twig(dice, &mut canvas, place, size, green);
            let radius = size * dice.range(0.2, 0.42);
            let (color, eye) = (dice.pick(&colors[1..4]), colors[4]);
            flower(dice, &mut canvas, place, radius, color, eye);
        }
    }
    for _ in 0..count * count {
        let (place, radius) = (dice.place(), size * dice.range(0.05, 0.1));
        let color = dice.pick(&colors[1..]);
        flower(dice, &mut canvas, place, radius, color, mix(color, ground, 0.5));
    }
    canvas.shade(&Field::noise(dice, 64, 64, 2, 0.7), 0.05);
    canvas.into()
}

fn twig(dice: &mut Dice, canvas: &mut Canvas, from: [f32; 2], size: f32, green: Rgb) {
    let (mut p, mut turn) = (from, dice.unit());
    let bend = dice.range(-0.06, 0.06);
    for k in 0..7 {
        turn += bend;
        let u = [cos_turns(turn), sin_turns(turn)];
        let q = [p[0] + u[0] * size * 0.13, p[1] + u[1] * size * 0.13];
        canvas.stroke(p, q, size * 0.03, 0.5, lit(green, 0.8), 1.0);
        if k > 2 {
            let side = if k % 2 == 0 { 0.15 } else { -0.15 };
            let v = [cos_turns(turn + side), sin_turns(turn + side)];
            let place = [q[0] + v[0] * size * 0.1, q[1] + v[1] * size * 0.1];
            leaf(canvas, place, v, [size * 0.13, size * 0.05], lit(green, dice.range(0.8, 1.2)));
        }
        p = q;
    }
}

/// Blades of grass or straw, seen from above.
pub(super) fn grass(dice: &mut Dice) -> Painting {
    let hue = dice.pick(&[0.27f32, 0.24, 0.3, 0.14, 0.12]);
    let patches = Field::fbm(dice, 3, 4);
    let mut canvas = Canvas::from_field(&patches, |v| hsv(hue, 0.6, 0.14 + 0.05 * v));
    let lean = dice.unit();
    let spread = dice.range(0.08, 0.5);
    for k in 0..2600 {
        let depth = k as f32 / 2600.0;
        let p = dice.place();
        let angle = lean + dice.range(-spread, spread);
        let length = dice.range(10.0, 26.0);
        let q = [p[0] + cos_turns(angle) * length, p[1] + sin_turns(angle) * length];
        let local = patches.sample(p[0], p[1]);
        let value = (0.2 + 0.4 * depth) * dice.range(0.75, 1.25) * (1.0 + 0.3 * local);
        let color = hsv(hue + dice.range(-0.03, 0.03) - 0.03 * local, dice.range(0.4, 0.75), value);
        canvas.stroke(p, q, dice.range(0.8, 2.0), 0.3, color, 1.0);
    }
    if dice.chance(0.5) {
        let colors = palette(dice);
        for _ in 0..50 + dice.below(80) {
            let (place, radius) = (dice.place(), dice.range(3.0, 8.0));
            let color = dice.pick(&colors);
            flower(dice, &mut canvas, place, radius, color, hex(0xf2c230));
        }
    }
    canvas.into()
}

/// Bark: upright plates with deep furrows.
pub(super) fn bark(dice: &mut Dice) -> Painting {
    let base = dice.pick(&[0x6b5442, 0x8a7a68, 0x4d3b30, 0xcfc8bc, 0x7a4a33]);
    let base = hex(base);
    let warp = [Field::noise(dice, 8, 3, 4, 0.5), Field::noise(dice, 4, 4, 4, 0.5)];
    let plates = Field::noise(dice, 12, 3, 4, 0.55).warped([&warp[0], &warp[1]], 26.0);
    let fine = Field::noise(dice, 64, 12, 3, 0.6);
    let moss = Field::fbm(dice, 3, 5);
    let green = hsv(0.25, 0.5, 0.4);
    let mossy = dice.range(-0.2, 0.6);
    let height = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        let ridge = (plates.0[i].abs() * 2.2).min(1.0);
        6.0 * ridge + 1.2 * fine.0[i]
    });
    let mut color = Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let deep = height.0[i] / 6.0;
        let slope = height.at(x as i32 + 1, y as i32) - height.at(x as i32 - 1, y as i32);
        let cover = if moss.0[i] > mossy { 0.35 } else { 0.0 };
        lit(mix(base, green, cover), (0.3 + 0.8 * deep) * (1.0 + 0.09 * slope))
    });
    color.grain(dice, 0.02);
    Painting { color, height: Some(height) }
}
