//! What people print, paint and stick on walls: posters, papers, signs and sprayed letters.

use super::Painting;
use super::canvas::{
    BLACK, Canvas, FULL, Rgb, WHITE, cos_turns, hex, lit, luma, palette, ramp, shaded_palette,
    sin_turns, smooth,
};
use super::dice::Dice;
use super::field::Field;
use super::letters::{ADVANCE, Type, number, word, write};

/// Posters, photographs and papers over each other.
pub(super) fn collage(dice: &mut Dice) -> Painting {
    let mut canvas = Canvas::filled(palette(dice)[0]);
    canvas.shade(&Field::fbm(dice, 6, 5), 0.2);
    let clouds = Field::fbm(dice, 4, 5);
    for _ in 0..34 {
        let colors = palette(dice);
        let (place, turn) = (dice.place(), dice.range(-0.06, 0.06));
        let [hw, hh] = [dice.range(32.0, 78.0), dice.range(32.0, 78.0)];
        let (ux, uy) = (cos_turns(turn), sin_turns(turn));
        let kind = dice.below(6);
        let (period, shift) = (dice.range(8.0, 30.0), dice.range(0.0, 400.0));
        let frame = if dice.chance(0.5) { 4.0 } else { 0.0 };
        // A card leans by a fifteenth of a turn at most.
        let reach = 1.1 * hw.max(hh) + 0.4 * hw.min(hh);
        let inside = |dx: f32, dy: f32| {
            let (s, t) = (dx * ux + dy * uy, dy * ux - dx * uy);
            (s, t, (hw - s.abs()).min(hh - t.abs()))
        };
        canvas.stamp([place[0] + 4.0, place[1] + 6.0], reach, |dx, dy| {
            (BLACK, 0.45 * ((inside(dx, dy).2 + 4.0) / 8.0).clamp(0.0, 1.0))
        });
        canvas.stamp(place, reach, |dx, dy| {
            let (s, t, edge) = inside(dx, dy);
            if edge < -0.5 {
                return (WHITE, 0.0);
            }
            let color = match kind {
                _ if edge < frame => hex(0xf6f4ee),
                0 => ramp(&colors, 0.5 + t / hh * 0.5),
                1 => colors[(((s + t + 400.0) / period) as usize) % 3],
                2 => ramp(&colors, 0.5 + 0.7 * clouds.sample(s * 1.6 + shift, t * 1.6)),
                3 => {
                    let d = (s * s + t * t).sqrt() / period;
                    colors[(d as usize) % 4]
                }
                4 => {
                    let (a, b) = ((s / period).floor(), (t / period).floor());
                    colors[((a + b) as i32).rem_euclid(2) as usize]
                }
                _ => {
                    // A head and shoulders before a plain ground.
                    let (px, py) = (s / hw, t / hh);
                    let head = px * px * 7.0 + (py + 0.15) * (py + 0.15) * 5.0 < 1.0;
                    let body = px * px * 1.6 + (py - 1.15) * (py - 1.15) * 1.7 < 1.0;
                    if head {
                        colors[1]
                    } else if body {
                        colors[2]
                    } else {
                        lit(colors[0], 1.1 - 0.3 * py)
                    }
                }
            };
            (lit(color, 1.0 - 0.1 * t / hh), (edge + 0.5).clamp(0.0, 1.0))
        });
        if dice.chance(0.5) {
            let letters = 3 + dice.below(4);
            let height = (hw * 1.7 / (letters as f32 * ADVANCE)).min(hh * 0.4);
            let color = if dice.chance(0.5) { WHITE } else { hex(0x14141c) };
            let name = word(dice, letters);
            let set = Type { height, weight: 0.12, slant: 0.0, color };
            let left = place[0] - letters as f32 * height * ADVANCE * 0.5;
            write(&mut canvas, [left, place[1] + hh * 0.35], &name, set);
        }
    }
    canvas.grain(dice, 0.02);
    canvas.into()
}

/// Sprayed letters, blots and drips on a wall.
pub(super) fn graffiti(dice: &mut Dice) -> Painting {
    let mut canvas = if dice.chance(0.5) {
        super::surface::brick(dice).color
    } else {
        super::surface::grunge(dice).color
    };
    let colors = palette(dice);
    for _ in 0..9 {
        let (place, radius) = (dice.place(), dice.range(30.0, 85.0));
        let color = dice.pick(&colors);
        canvas.stamp(place, radius, |dx, dy| {
            (color, 0.8 * smooth(1.0, 0.1, (dx * dx + dy * dy).sqrt() / radius))
        });
    }
    for _ in 0..5 {
        let letters = 3 + dice.below(4);
        let height = dice.range(60.0, 130.0);
        let place = dice.place();
        let (fill, line) = (dice.pick(&colors), dice.pick(&[BLACK, WHITE, hex(0x1b1b3a)]));
        let name = word(dice, letters);
        let slant = dice.range(-0.15, 0.3);
        for (weight, dx, color) in [(0.36, 4.0, BLACK), (0.33, 0.0, line), (0.08, 0.0, fill)] {
            write(
                &mut canvas,
                [place[0] + dx, place[1] + dx],
                &name,
                Type { height, weight, slant, color },
            );
        }
        for _ in 0..6 {
            let from = [
                place[0] + dice.range(0.0, letters as f32 * height * ADVANCE),
                place[1] + height * dice.range(0.7, 1.0),
            ];
            let to = [from[0], from[1] + dice.range(10.0, 60.0)];
            let width = dice.range(1.5, 3.5);
            canvas.stroke(from, to, width, 0.5, fill, 0.85);
        }
    }
    for _ in 0..7 {
        let mut p = dice.place();
        let mut turn = dice.unit();
        let (width, color) = (dice.range(3.0, 9.0), dice.pick(&colors));
        let bend = dice.range(-0.06, 0.06);
        for _ in 0..12 {
            turn += bend + dice.range(-0.05, 0.05);
            let q = [p[0] + cos_turns(turn) * 16.0, p[1] + sin_turns(turn) * 16.0];
            canvas.stroke(p, q, width, 4.0, color, 0.8);
            p = q;
        }
    }
    canvas.into()
}

/// A page or a screen of text, with headings and boxes.
pub(super) fn text(dice: &mut Dice) -> Painting {
    const PAPERS: [[u32; 3]; 6] = [
        [0xf3efe4, 0x22201c, 0x8b1a1a],
        [0xffffff, 0x111111, 0x1450a0],
        [0x10141a, 0x9ff0a0, 0xf0d060],
        [0xe8dcc0, 0x3a2a1a, 0x6a1f1f],
        [0x1d3557, 0xf1faee, 0xe63946],
        [0xffd60a, 0x101010, 0xc1121f],
    ];
    let [paper, ink, accent] = dice.pick(&PAPERS).map(hex);
    let mut canvas = Canvas::filled(paper);
    canvas.shade(&Field::fbm(dice, 4, 6), 0.06);
    let columns = dice.pick(&[1usize, 2, 3]);
    let width = FULL / columns as f32;
    let size = dice.pick(&[7.0f32, 9.0, 12.0, 18.0]);
    for column in 0..columns {
        let (left, right) = (column as f32 * width + 10.0, (column + 1) as f32 * width - 10.0);
        let mut y = 8.0;
        while y < FULL - size * 2.0 {
            let room = FULL - y;
            if dice.chance(0.1) && room > 90.0 {
                let tall = dice.range(50.0, 80.0);
                let tones = shaded_palette(dice);
                let clouds = Field::noise(&mut dice.clone(), 6, 6, 2, 0.5);
                canvas.stamp_box([left, y], [right, y + tall], |px, py| {
                    (ramp(&tones, 0.5 + 0.7 * clouds.sample(px, py)), 1.0)
                });
                y += tall + 8.0;
            } else if dice.chance(0.12) && room > size * 5.0 {
                let height = size * dice.range(1.6, 3.2);
                let letters = ((right - left) / (height * ADVANCE)) as usize;
                let title = word(dice, letters.clamp(1, 9));
                write(
                    &mut canvas,
                    [left, y],
                    &title,
                    Type { height, weight: 0.12, slant: 0.0, color: accent },
                );
                y += height * 1.4;
            } else {
                line_of_text(dice, &mut canvas, [left, y], right, size, ink);
                y += size * 1.6;
            }
        }
    }
    canvas.grain(dice, 0.015);
    canvas.into()
}

fn line_of_text(
    dice: &mut Dice,
    canvas: &mut Canvas,
    [left, y]: [f32; 2],
    right: f32,
    size: f32,
    ink: Rgb,
) {
    let mut x = left;
    loop {
        let letters = 2 + dice.below(8);
        if x + letters as f32 * size * ADVANCE > right {
            return;
        }
        let name =
            if dice.chance(0.08) { number(dice, letters.min(4)) } else { word(dice, letters) };
        write(canvas, [x, y], &name, Type { height: size, weight: 0.02, slant: 0.0, color: ink });
        x += (name.len() as f32 + 0.8) * size * ADVANCE;
        if dice.chance(0.03) {
            return;
        }
    }
}

/// Signs: few big letters, arrows and frames.
pub(super) fn sign(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let rows = dice.pick(&[2usize, 3, 4]);
    let h = FULL / rows as f32;
    let mut canvas = Canvas::filled(colors[0]);
    for row in 0..rows {
        let (back, front) = (colors[row % 5], colors[(row + 2) % 5]);
        let front = if (luma(back) - luma(front)).abs() < 0.25 {
            if luma(back) > 0.5 { hex(0x151515) } else { hex(0xfafafa) }
        } else {
            front
        };
        let y = row as f32 * h;
        canvas.rect([0.0, y], [FULL, h], back, 1.0);
        canvas.rect([8.0, y + 8.0], [FULL - 16.0, h - 16.0], front, 0.9);
        canvas.rect([13.0, y + 13.0], [FULL - 26.0, h - 26.0], back, 1.0);
        let letters = 3 + dice.below(6);
        let height = ((FULL - 60.0) / (letters as f32 * ADVANCE)).min(h * 0.6);
        let name = if dice.chance(0.3) { number(dice, letters) } else { word(dice, letters) };
        let left = (FULL - letters as f32 * height * ADVANCE) * 0.5;
        let set = Type { height, weight: dice.range(-0.05, 0.25), slant: 0.0, color: front };
        write(&mut canvas, [left, y + (h - height) * 0.5], &name, set);
    }
    canvas.shade(&Field::fbm(dice, 3, 6), 0.12);
    canvas.grain(dice, 0.02);
    canvas.into()
}
