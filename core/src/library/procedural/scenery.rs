//! What stands or lies about, in the place of photographs: landscapes, streets, heaps and
//! lights out of focus.

use super::Painting;
use super::canvas::{
    BLACK, Canvas, FULL, Rgb, SIDE, WHITE, hex, hsv, lit, mix, palette, ramp, shaded_palette,
    smooth,
};
use super::dice::Dice;
use super::field::Field;

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
