//! Pictures with things in them, in the place of photographs: landscapes, streets, shop shelves,
//! packages, posters, painted walls and lights out of focus.

use super::Painting;
use super::canvas::{
    BLACK, Canvas, Rgb, SIDE, WHITE, cos_turns, hex, hsv, lit, luma, mix, palette, ramp,
    shaded_palette, sin_turns, smooth,
};
use super::dice::Dice;
use super::field::Field;
use super::letters::{ADVANCE, Type, number, word, write};

const FULL: f32 = SIDE as f32;

/// Mountains and sky over water that mirrors them.
pub(super) fn lake(dice: &mut Dice) -> Painting {
    const SKIES: [[u32; 3]; 7] = [
        [0x2b6cb0, 0x8fc1e8, 0xe8f1f6],
        [0x2c1e4a, 0xb2456e, 0xffb45e],
        [0x6d8296, 0xaebac4, 0xd9dee1],
        [0x0d1b2a, 0x1b3a5c, 0x5a7fa6],
        [0x4a90c2, 0xf2c6a0, 0xffe6c4],
        [0x3a2e5c, 0x7a5a8c, 0xf0a9a0],
        [0x1f4e5f, 0x79b4b7, 0xfefbf3],
    ];
    let sky = dice.pick(&SKIES).map(hex);
    let clouds = Field::noise(dice, 3, 8, 6, 0.55);
    let ridges = Field::noise(dice, 4, 8, 6, 0.55);
    let texture = Field::fbm(dice, 16, 5);
    let ripples = Field::noise(dice, 8, 64, 3, 0.6);
    let land = [hsv(dice.range(0.2, 0.6), dice.range(0.1, 0.45), dice.range(0.15, 0.4)), sky[1]];
    let sun = [dice.range(60.0, 452.0), dice.range(90.0, 200.0)];
    let snow = dice.chance(0.4);
    let horizon = FULL / 2.0;
    let scene = |x: usize, height: f32| -> Rgb {
        let y = (horizon - height).clamp(0.0, horizon);
        let t = y / horizon;
        let i = (y as usize).min(SIDE - 1) * SIDE + x;
        let cloud = smooth(0.05, 0.75, clouds.0[i]);
        let (dx, dy) = (x as f32 - sun[0], y - sun[1]);
        let glow = 1.0 / (1.0 + (dx * dx + dy * dy) / 900.0);
        let mut color = mix(ramp(&sky, t), mix(sky[2], WHITE, 0.6), 0.75 * cloud);
        color = mix(color, mix(sky[2], WHITE, 0.7), glow);
        for layer in 0..4usize {
            let near = (layer as f32 + 1.0) / 4.0;
            let line = ridges.at(x as i32, layer as i32 * 128 + 17);
            let jag = texture.at(x as i32, layer as i32 * 120) * 6.0 * near;
            let top = 120.0 * (1.05 - near) + line * (60.0 - 25.0 * near) + jag;
            if height < top {
                let shade =
                    1.0 + 0.35 * texture.at(x as i32 + (height * 0.6) as i32, height as i32);
                let ground = lit(mix(land[1], land[0], 0.25 + 0.7 * near), shade);
                let line = 78.0 - 22.0 * layer as f32 + jag * 3.0;
                let white = if snow && layer < 2 { smooth(line, line + 5.0, height) } else { 0.0 };
                color = mix(ground, WHITE, 0.75 * white);
            }
        }
        color
    };
    let mut canvas = Canvas::from_fn(|x, y| {
        let below = y as f32 + 0.5 - horizon;
        if below < 0.0 {
            return scene(x, -below);
        }
        let wave = ripples.0[y * SIDE + x] * (1.0 - 0.6 * (1.0 - below / horizon));
        // The last rows run into the sky above, so that the picture tiles.
        let calm = smooth(0.0, 12.0, horizon - below);
        let seen = scene(x, (below + wave * 9.0 * calm).clamp(0.5, horizon));
        mix(seen, lit(mix(seen, land[0], 0.3), 0.85 + 0.2 * wave), calm)
    });
    canvas.grain(dice, 0.015);
    canvas.into()
}

/// Sky with clouds.
pub(super) fn clouds(dice: &mut Dice) -> Painting {
    const SKIES: [[u32; 3]; 6] = [
        [0x2f74c0, 0xbfd9ef, 0xffffff],
        [0x5b7fa3, 0xa9b8c6, 0xeef1f4],
        [0x41295a, 0xd9647a, 0xffd194],
        [0x20303f, 0x4a5c6c, 0x9aa9b5],
        [0x0f2a4a, 0x2c5a8c, 0xb9d3ea],
        [0xe08a4f, 0xf4c48c, 0xfff1d6],
    ];
    let [deep, middle, bright] = dice.pick(&SKIES).map(hex);
    let warp = [Field::fbm(dice, 3, 5), Field::fbm(dice, 3, 5)];
    let main = Field::noise(dice, 2, 3, 7, 0.55).warped([&warp[0], &warp[1]], 40.0);
    let cover = dice.range(-0.25, 0.25);
    let mut canvas = Canvas::from_fn(|x, y| {
        let v = main.0[y * SIDE + x];
        // Thicker towards the light, which comes from above: the underside is darker.
        let lit_side = v - main.at(x as i32 - 3, y as i32 - 12);
        let amount = smooth(cover, cover + 0.55, v);
        let cloud = mix(middle, bright, (0.55 + 1.3 * lit_side).clamp(0.0, 1.0));
        mix(mix(deep, middle, 0.25 + 0.25 * warp[0].0[y * SIDE + x]), cloud, amount)
    });
    canvas.grain(dice, 0.01);
    canvas.into()
}

/// A street front: storeys of windows, by day or at night.
pub(super) fn facade(dice: &mut Dice) -> Painting {
    let night = dice.chance(0.35);
    let wall = mix(palette(dice)[0], hex(0xb9ada0), dice.range(0.35, 0.85));
    let wall = if night { lit(wall, 0.3) } else { wall };
    let (columns, rows) = (dice.pick(&[4usize, 8, 8, 16]), dice.pick(&[4usize, 8, 8]));
    let (w, h) = (FULL / columns as f32, FULL / rows as f32);
    let rough = Field::fbm(dice, 24, 4);
    let stain = Field::noise(dice, 6, 2, 5, 0.5);
    let mut canvas = Canvas::filled(wall);
    canvas.shade(&rough, 0.1);
    canvas.shade(&stain, 0.12);
    let (ww, wh) = (w * dice.range(0.42, 0.8), h * dice.range(0.45, 0.75));
    let frame = lit(mix(wall, WHITE, dice.range(0.2, 0.8)), if night { 0.5 } else { 1.0 });
    let bars = dice.below(3);
    let balcony = dice.chance(0.3);
    for row in 0..rows {
        let y = (row as f32 + 0.5) * h - wh * 0.5;
        canvas.rect([0.0, (row as f32 + 1.0) * h - 4.0], [FULL, 3.0], lit(wall, 0.75), 0.9);
        for column in 0..columns {
            let x = (column as f32 + 0.5) * w - ww * 0.5;
            window(dice, &mut canvas, [x, y], [ww, wh], frame, night);
            let bar = (ww * 0.04).max(1.0);
            if bars > 0 {
                canvas.rect([x + ww * 0.5 - bar * 0.5, y], [bar, wh], frame, 1.0);
            }
            if bars > 1 {
                canvas.rect([x, y + wh * 0.38], [ww, bar], frame, 1.0);
            }
            canvas.rect([x - 3.0, y + wh], [ww + 6.0, 4.0], lit(frame, 1.05), 1.0);
            canvas.rect([x - 2.0, y + wh + 4.0], [ww + 4.0, 4.0], BLACK, 0.3);
            if balcony {
                for k in 0..9 {
                    let bx = x - 4.0 + k as f32 * (ww + 8.0) / 8.0;
                    canvas.rect([bx, y + wh * 0.62], [1.6, wh * 0.4], lit(wall, 0.3), 1.0);
                }
                canvas.rect([x - 5.0, y + wh * 0.6], [ww + 10.0, 2.5], lit(wall, 0.25), 1.0);
            }
        }
    }
    canvas.grain(dice, 0.02);
    canvas.into()
}

fn window(
    dice: &mut Dice,
    canvas: &mut Canvas,
    [x, y]: [f32; 2],
    [w, h]: [f32; 2],
    frame: Rgb,
    night: bool,
) {
    let lamp = hsv(dice.range(0.08, 0.16), dice.range(0.2, 0.6), dice.range(0.7, 1.0));
    let on = night && dice.chance(0.4);
    let glass =
        if on { lamp } else { hsv(0.58, 0.25, dice.range(0.1, if night { 0.15 } else { 0.4 })) };
    canvas.rect([x - 2.0, y - 2.0], [w + 4.0, h + 4.0], frame, 1.0);
    let slope = dice.range(-0.6, 0.6);
    canvas.stamp_box([x, y], [x + w, y + h], |px, py| {
        // A slanting streak of sky in the pane.
        let t = (px - x) / w + slope * (py - y) / h;
        let gleam = if night { 0.0 } else { 0.35 * smooth(0.1, 0.0, (t - 0.45).abs() - 0.15) };
        (mix(lit(glass, 1.15 - 0.4 * (py - y) / h), hex(0xcfe0ee), gleam), 1.0)
    });
    if dice.chance(0.45) {
        let cloth = lit(mix(palette(dice)[0], WHITE, 0.4), if night { 0.5 } else { 0.85 });
        let part = dice.range(0.15, 0.4);
        canvas.rect([x, y], [w * part, h], cloth, 0.85);
        canvas.rect([x + w * (1.0 - part), y], [w * part, h], cloth, 0.85);
    } else if dice.chance(0.3) {
        let drop = dice.range(0.2, 0.9);
        canvas.rect([x, y], [w, h * drop], lit(frame, 0.85), 0.9);
    }
}

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

/// Lights out of focus.
pub(super) fn bokeh(dice: &mut Dice) -> Painting {
    let back = shaded_palette(dice);
    let haze = Field::noise(dice, 2, 2, 3, 0.5);
    let mut canvas = Canvas::from_field(&haze, |v| lit(ramp(&back[..3], 0.5 + 0.6 * v), 0.6));
    let warm = dice.unit();
    let (small, large) = (dice.range(6.0, 14.0), dice.range(22.0, 46.0));
    for _ in 0..(120_000.0 / (large * large)) as usize + 30 {
        let place = dice.place();
        let radius = dice.range(small, large);
        let color = hsv(warm + dice.range(-0.12, 0.12), dice.range(0.1, 0.8), 1.0);
        let alpha = dice.range(0.08, 0.4);
        canvas.stamp(place, radius + 1.0, |dx, dy| {
            let d = (dx * dx + dy * dy).sqrt();
            let rim = 0.75 + 0.5 * smooth(radius * 0.7, radius, d);
            (color, alpha * rim * (radius + 0.5 - d).clamp(0.0, 1.0))
        });
    }
    canvas.grain(dice, 0.015);
    canvas.into()
}

/// Fruit and stones heaped up: many round things, lit from one side.
pub(super) fn heap(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let mut canvas = Canvas::filled(hex(0x14110e));
    let size = dice.range(16.0, 34.0);
    let skin = Field::fbm(dice, 24, 4);
    let spread = dice.range(0.0, 0.35);
    let one = dice.chance(0.5);
    let count = (230_000.0 / (size * size)) as usize + 60;
    for k in 0..count {
        let depth = k as f32 / count as f32;
        let place = dice.place();
        let radius = size * dice.range(1.0 - spread, 1.0 + spread);
        let tone =
            if one { mix(colors[0], colors[1], 0.3 * dice.unit()) } else { dice.pick(&colors) };
        let tone = lit(tone, (0.35 + 0.65 * depth) * dice.range(0.85, 1.1));
        canvas.stamp(place, radius * 1.15, |dx, dy| {
            let (u, v) = (dx / radius, dy / radius);
            let d2 = u * u + v * v;
            if d2 >= 1.0 {
                return (BLACK, 0.5 * (1.0 - smooth(1.0, 1.3, d2)));
            }
            let z = (1.0 - d2).sqrt();
            let light = (0.62 * z - 0.42 * u - 0.58 * v).max(0.0);
            let gleam = smooth(0.96, 1.0, light) * 0.6;
            let rough = 1.0 + 0.2 * skin.at((place[0] + dx) as i32, (place[1] + dy) as i32);
            (mix(lit(tone, (0.22 + 0.95 * light) * rough), WHITE, gleam), 1.0)
        });
    }
    canvas.grain(dice, 0.015);
    canvas.into()
}
