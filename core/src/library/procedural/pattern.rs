//! Printed and woven patterns: bands, grids, dots, rings and ornament.

use super::Painting;
use super::canvas::{
    Canvas, Rgb, SIDE, cos_turns, floor, fract, lit, luma, mix, palette, ramp, shaded_palette,
    sin_turns, smooth,
};
use super::dice::Dice;
use super::field::Field;

/// A sequence of bands, symmetric as tartans are, over a period of `period` pixels.
fn sett(dice: &mut Dice, period: usize, colors: &[Rgb]) -> Vec<Rgb> {
    let half = period / 2;
    let mut bands = Vec::with_capacity(half);
    while bands.len() < half {
        let wide = dice.chance(0.4);
        let share = if wide { dice.range(0.15, 0.4) } else { dice.range(0.02, 0.1) };
        let color = dice.pick(colors);
        bands.extend(std::iter::repeat_n(color, ((share * half as f32) as usize).max(1)));
    }
    bands.truncate(half);
    let mirrored: Vec<Rgb> = bands.iter().rev().copied().collect();
    bands.extend(mirrored);
    bands
}

/// Tartan: two sets of bands that cross, woven as a twill.
pub(super) fn plaid(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let period = dice.pick(&[64, 128, 128, 256]);
    let warp = sett(dice, period, &colors);
    let weft = if dice.chance(0.7) { warp.clone() } else { sett(dice, period, &colors) };
    let (thread, depth) = (dice.pick(&[2usize, 4]), dice.range(0.15, 0.35));
    let mut canvas = Canvas::from_fn(|x, y| {
        let over = (x + y) / thread % 2 == 0;
        mix(warp[x % period], weft[y % period], if over { 0.5 - depth } else { 0.5 + depth })
    });
    canvas.shade(&Field::noise(dice, 64, 64, 2, 0.7), 0.06);
    canvas.into()
}

/// Bands: straight, slanted or zigzag.
pub(super) fn stripes(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let count = 2 + dice.below(4);
    let period = dice.pick(&[64usize, 128, 128, 256, 512]);
    let bands: Vec<Rgb> = {
        let mut v = Vec::new();
        while v.len() < period {
            let color = colors[dice.below(count)];
            let width = (dice.range(0.04, 0.3) * period as f32) as usize;
            v.extend(std::iter::repeat_n(color, width.max(3)));
        }
        v.truncate(period);
        v
    };
    let zigzag = dice.pick(&[64.0f32, 128.0, 256.0]);
    let kind = dice.below(5);
    let paint = |x: f32, y: f32| {
        let p = match kind {
            0 => x,
            1 => y,
            2 => x + y,
            3 => x - y,
            _ => y + (x % zigzag - zigzag / 2.0).abs(),
        };
        bands[(floor(p) & (period as i32 - 1)) as usize]
    };
    let mut canvas = Canvas::from_fn(|x, y| {
        let (x, y) = (x as f32, y as f32);
        mix(paint(x + 0.25, y + 0.25), paint(x + 0.75, y + 0.75), 0.5)
    });
    canvas.shade(&Field::fbm(dice, 3, 6), 0.08);
    canvas.into()
}

/// Squares, lozenges or triangles in two or more colours.
pub(super) fn checker(dice: &mut Dice) -> Painting {
    let colors = shaded_palette(dice);
    let count = dice.pick(&[4usize, 8, 8, 16]);
    let size = SIDE / count;
    let kind = dice.below(4);
    let several = dice.chance(0.4);
    let tones: Vec<Rgb> = (0..count * count).map(|_| dice.pick(&colors)).collect();
    let mut canvas = Canvas::from_fn(|x, y| {
        let (i, j) = match kind {
            1 => ((x + y) / size % count, (x + SIDE - y) / size % count),
            _ => (x / size, y / size),
        };
        let lower = kind == 2 && x % size + y % size >= size;
        let odd = (i + j + usize::from(lower)) % 2 == 1;
        if several && odd {
            tones[j * count + i]
        } else if odd {
            colors[0]
        } else {
            colors[4]
        }
    });
    canvas.shade(&Field::fbm(dice, 4, 6), 0.1);
    canvas.into()
}

/// Discs: in rows, offset rows, or scattered like confetti; or rings.
pub(super) fn dots(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let mut canvas = Canvas::filled(colors[0]);
    if dice.chance(0.4) {
        for _ in 0..110 + dice.below(200) {
            let (place, radius) = (dice.place(), dice.range(3.0, 22.0));
            let color = dice.pick(&colors[1..]);
            canvas.disc(place, radius, color, 1.0);
            if dice.chance(0.3) {
                let inner = dice.pick(&colors);
                canvas.disc(place, radius * 0.6, inner, 1.0);
            }
        }
    } else {
        let count = dice.pick(&[4usize, 8, 8, 16]);
        let size = SIDE as f32 / count as f32;
        let (radius, offset) = (size * dice.range(0.18, 0.42), dice.chance(0.6));
        let (tones, ring) = (1 + dice.below(4), dice.chance(0.3));
        for row in 0..count {
            for column in 0..count {
                let shift = if offset && row % 2 == 1 { 1.0 } else { 0.5 };
                let place = [(column as f32 + shift) * size, (row as f32 + 0.5) * size];
                canvas.disc(place, radius, colors[1 + (row + column) % tones], 1.0);
                if ring {
                    canvas.disc(place, radius * 0.55, colors[0], 1.0);
                }
            }
        }
    }
    canvas.shade(&Field::fbm(dice, 3, 6), 0.07);
    canvas.into()
}

/// Colours that run into each other without an edge, as on blurred paper.
pub(super) fn gradient(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let (columns, rows) = (1 + dice.below(3), 1 + dice.below(3));
    let warp = [Field::fbm(dice, 2, 2), Field::fbm(dice, 2, 2)];
    let main = Field::noise(dice, columns, rows, 2, 0.4).warped([&warp[0], &warp[1]], 70.0);
    let light = Field::noise(dice, 2, 2, 1, 0.5);
    let mut canvas = Canvas::from_field(&main, |v| ramp(&colors, 0.5 + 0.62 * v));
    canvas.shade(&light, 0.22);
    canvas.grain(dice, 0.02);
    canvas.into()
}

/// Rings, ripples and scales of sines: op art, fish scales, moire.
pub(super) fn waves(dice: &mut Dice) -> Painting {
    let colors = shaded_palette(dice);
    let count = dice.pick(&[4usize, 4, 8]);
    let size = SIDE as f32 / count as f32;
    let rings = 2.0 + dice.below(4) as f32;
    let bend = Field::fbm(dice, 2, 3);
    let amount = dice.range(0.5, 3.0);
    let kind = dice.below(4);
    let canvas = Canvas::from_fn(|x, y| {
        let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
        let t = match kind {
            // Half-covered scales in offset rows; the lowest row that reaches here lies on top.
            0 => {
                let mut t = 0.0;
                for k in (0..3).rev() {
                    let row = floor(py / (size * 0.5)) - k + 1;
                    let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
                    let along = px / size - shift;
                    let dx = (along - floor(along) as f32 - 0.5) * size;
                    let dy = py - row as f32 * size * 0.5 - size * 0.5;
                    let d = (dx * dx + dy * dy).sqrt() / (size * 0.5);
                    if d < 1.0 {
                        t = 0.5 - 0.5 * cos_turns(d * rings);
                        break;
                    }
                }
                t
            }
            1 => {
                let (dx, dy) = (px % size - size / 2.0, py % size - size / 2.0);
                0.5 + 0.5 * sin_turns((dx * dx + dy * dy).sqrt() / size * rings * 1.5)
            }
            2 => {
                let i = y * SIDE + x;
                0.5 + 0.5 * sin_turns(py / size * rings * 0.5 + bend.0[i] * amount)
            }
            _ => {
                let a = sin_turns(px / size + 0.25 * sin_turns(py / size));
                let b = sin_turns(py / size + 0.25 * sin_turns(px / size));
                0.5 + 0.5 * sin_turns((a + b) * rings * 0.25)
            }
        };
        ramp(&colors, smooth(0.1, 0.9, t))
    });
    let mut canvas = canvas;
    canvas.shade(&Field::fbm(dice, 4, 6), 0.08);
    canvas.into()
}

/// Ornament mirrored in both axes and the diagonals, in few tones: carpets and old wall tiles.
pub(super) fn carpet(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let count = dice.pick(&[1usize, 2, 4]);
    let size = SIDE / count;
    let detail = if count == 4 { 3 } else { 4 };
    let shapes = Field::fbm(dice, detail, 3);
    let lines = Field::fbm(dice, detail * 2, 2);
    let scale = (SIDE / 2) as f32 / (size / 2) as f32 * 0.8;
    let border = dice.range(0.05, 0.16);
    let mut canvas = Canvas::from_fn(|x, y| {
        let fold = |v: usize| {
            let v = v % size;
            (if v * 2 < size { v } else { size - 1 - v }) as f32
        };
        let (a, b) = (fold(x), fold(y));
        let (low, high) = (a.min(b), a.max(b));
        let edge = low / size as f32;
        let v = shapes.sample(low * scale, high * scale);
        let w = lines.sample(high * scale, low * scale);
        let tone = ((v + 1.0) * 4.5) as usize % 5;
        let base = if w.abs() < 0.06 { colors[(tone + 2) % 5] } else { colors[tone] };
        if edge < border {
            let band = (edge / border * 5.0) as usize;
            if band == 2 && (high as usize / 8).is_multiple_of(2) { base } else { colors[band % 5] }
        } else {
            base
        }
    });
    canvas.shade(&Field::noise(dice, 128, 128, 2, 0.8), 0.09);
    canvas.shade(&Field::fbm(dice, 3, 3), 0.1);
    canvas.into()
}

/// Patches of four colours by thresholds of noise, soft-edged or in squares.
pub(super) fn camouflage(dice: &mut Dice) -> Painting {
    const SCHEMES: [[u32; 4]; 8] = [
        [0x4b5320, 0x2f3a1c, 0x7d7247, 0x1c1b16],
        [0xc2a878, 0x9b7f53, 0x6b5636, 0xe0cda6],
        [0xd8dde0, 0x9aa4ad, 0x5b656e, 0xf6f8f9],
        [0x223a5e, 0x16233a, 0x5f7fa8, 0x0c121d],
        [0x6b6f5b, 0x8d8f77, 0x45483a, 0x2a2b25],
        [0x6e3b2a, 0xa0522d, 0x3b2219, 0xd2a679],
        [0x5a2a5e, 0xb0468c, 0x2b1838, 0xe79bc2],
        [0x1e5945, 0x8ab17d, 0x123528, 0xe9d8a6],
    ];
    let colors = dice.pick(&SCHEMES).map(super::canvas::hex);
    let cells = 4 + dice.below(4);
    let warp = [Field::fbm(dice, 6, 3), Field::fbm(dice, 6, 3)];
    let layers: [Field; 3] =
        std::array::from_fn(|_| Field::fbm(dice, cells, 2).warped([&warp[0], &warp[1]], 18.0));
    let square = if dice.chance(0.35) { 8 } else { 1 };
    let mut canvas = Canvas::from_fn(|x, y| {
        let i = y / square * square * SIDE + x / square * square;
        if layers[0].0[i] > 0.28 {
            colors[3]
        } else if layers[1].0[i] > 0.1 {
            colors[1]
        } else if layers[2].0[i] > 0.0 {
            colors[2]
        } else {
            colors[0]
        }
    });
    canvas.shade(&Field::noise(dice, 128, 128, 2, 0.8), 0.08);
    canvas.into()
}

/// Over and under: wicker, basket work or coarse cloth.
pub(super) fn weave(dice: &mut Dice) -> Painting {
    let colors = shaded_palette(dice);
    let (a, b) = (dice.pick(&colors[1..]), dice.pick(&colors[1..]));
    let count = dice.pick(&[8usize, 16, 16, 32]);
    let size = (SIDE / count) as f32;
    let twill = dice.pick(&[2usize, 2, 4]);
    let tones: Vec<f32> = (0..2 * count).map(|_| dice.range(0.82, 1.08)).collect();
    let fibres = [Field::noise(dice, 4, 128, 2, 0.8), Field::noise(dice, 128, 4, 2, 0.8)];
    let height = Field::from_fn(|x, y| {
        let (i, j) = (x / size as usize, y / size as usize);
        let (u, v) = (fract((x as f32 + 0.5) / size) - 0.5, fract((y as f32 + 0.5) / size) - 0.5);
        let across = if (i + j) % twill < twill / 2 { [u, v] } else { [v, u] };
        (1.0 - across[0] * across[0] * 2.2) * (1.0 - 3.6 * across[1] * across[1]).max(0.0)
    });
    let canvas = Canvas::from_fn(|x, y| {
        let (i, j) = (x / size as usize, y / size as usize);
        let k = y * SIDE + x;
        let flat = (i + j) % twill < twill / 2;
        let (color, tone, fibre) = if flat {
            (a, tones[j], fibres[0].0[k])
        } else {
            (b, tones[count + i], fibres[1].0[k])
        };
        lit(color, tone * (0.3 + 0.75 * height.0[k]) * (1.0 + 0.12 * fibre))
    });
    Painting { color: canvas, height: Some(height.map(|h| h * size * 0.25)) }
}

/// Noise itself, in the colours of a palette: smoke, ink and oil.
pub(super) fn noise(dice: &mut Dice) -> Painting {
    let colors = if dice.chance(0.5) { palette(dice) } else { shaded_palette(dice) };
    let cells = 2 + dice.below(4);
    let warp = [Field::fbm(dice, cells, 4), Field::fbm(dice, cells, 4)];
    let reach = dice.range(20.0, 110.0);
    let main = Field::fbm(dice, cells, 6).warped([&warp[0], &warp[1]], reach);
    let bands = dice.chance(0.4);
    let count = dice.range(1.0, 3.0);
    let mut canvas = Canvas::from_field(&main, |v| {
        let t = 0.5 + 0.55 * v;
        ramp(&colors, if bands { 0.5 + 0.5 * sin_turns(t * count) } else { t })
    });
    canvas.shade(&warp[0], 0.15);
    canvas.grain(dice, 0.03);
    canvas.into()
}

/// Many copies of one motif in two tones, as on gift paper and hoardings.
pub(super) fn motif(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let mut canvas = Canvas::filled(colors[0]);
    let count = dice.pick(&[4usize, 8, 8]);
    let size = SIDE as f32 / count as f32;
    let (kind, points) = (dice.below(4), 3 + dice.below(6));
    let light = if luma(colors[0]) > 0.5 { 0.35 } else { 0.65 };
    for row in 0..count {
        for column in 0..count {
            let shift = if row % 2 == 1 { 1.0 } else { 0.5 };
            let place = [(column as f32 + shift) * size, (row as f32 + 0.5) * size];
            let color = mix(colors[1 + (row * 3 + column) % 4], [light; 3], 0.1);
            let turn = dice.unit();
            for k in 0..points {
                let angle = turn + k as f32 / points as f32;
                let u = [cos_turns(angle), sin_turns(angle)];
                let r = size * 0.36;
                let tip = [place[0] + u[0] * r, place[1] + u[1] * r];
                match kind {
                    0 => canvas.stroke(place, tip, size * 0.09, 0.0, color, 1.0),
                    1 => {
                        let middle = [place[0] + u[0] * r * 0.6, place[1] + u[1] * r * 0.6];
                        canvas.ellipse(middle, u, [r * 0.5, r * 0.22], |_, _| color);
                    }
                    2 => canvas.disc(tip, size * 0.08, color, 1.0),
                    _ => {
                        let next = angle + 1.0 / points as f32;
                        let end = [place[0] + cos_turns(next) * r, place[1] + sin_turns(next) * r];
                        canvas.stroke(tip, end, size * 0.06, 0.0, color, 1.0);
                    }
                }
            }
            canvas.disc(place, size * 0.09, colors[(row + column) % 4 + 1], 1.0);
        }
    }
    canvas.shade(&Field::fbm(dice, 3, 6), 0.08);
    canvas.into()
}
