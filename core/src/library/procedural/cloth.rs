//! Cloth for garments: light, so that it can be multiplied by any colour.
//!
//! A repeat shows about a quarter of a metre of cloth. The ground is near white; what is printed or
//! woven in is darker or, in prints, coloured.

use super::Painting;
use super::canvas::{
    Canvas, FULL, Rgb, SIDE, WHITE, cos_turns, fract, hex, hsv, lit, mix, palette, sin_turns,
    smooth,
};
use super::dice::Dice;
use super::field::{Cells, Field};

const GROUND: Rgb = [0.95, 0.95, 0.95];

/// Threads of a plain weave, and the unevenness of real yarn, over any print.
fn woven(dice: &mut Dice, mut canvas: Canvas, strength: f32) -> Canvas {
    let yarn = [Field::noise(dice, 4, 128, 2, 0.7), Field::noise(dice, 128, 4, 2, 0.7)];
    canvas.repaint(|x, y, color| {
        let i = y * SIDE + x;
        let over = (x / 2 + y / 2) % 2 == 0;
        let thread = if over { yarn[0].0[i] } else { yarn[1].0[i] };
        lit(color, 1.0 + strength * (thread + if over { 0.35 } else { -0.35 }))
    });
    canvas
}

/// Plain cloth.
pub(super) fn plain(dice: &mut Dice) -> Painting {
    let strength = dice.range(0.03, 0.08);
    woven(dice, Canvas::filled([0.93; 3]), strength).into()
}

/// Denim: a steep twill with worn places.
pub(super) fn denim(dice: &mut Dice) -> Painting {
    let worn = Field::fbm(dice, 2, 5);
    let yarn = Field::noise(dice, 128, 6, 2, 0.8);
    let slub = Field::noise(dice, 6, 96, 2, 0.8);
    let wash = dice.range(0.05, 0.25);
    Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let twill = 0.5 + 0.5 * sin_turns((x as f32 * 2.0 + y as f32 * 2.0) / 16.0);
        let v = 0.76 + 0.1 * twill + 0.1 * yarn.0[i] + 0.04 * slub.0[i] + wash * worn.0[i];
        [v, v * 1.005, v * 1.015]
    })
    .into()
}

/// Stripes across or down, of one or two widths.
pub(super) fn stripes(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[4usize, 8, 8, 16]);
    let period = SIDE / count;
    let share = dice.range(0.25, 0.55);
    let dark = lit(palette(dice)[0], dice.range(0.5, 1.0));
    let (across, double) = (dice.chance(0.7), dice.chance(0.4));
    let canvas = Canvas::from_fn(|x, y| {
        let p = (if across { y } else { x } % period) as f32 / period as f32;
        let second = double && p > 0.7 && p < 0.78;
        if p < share || second { dark } else { GROUND }
    });
    woven(dice, canvas, 0.05).into()
}

/// Suiting with thin lines.
pub(super) fn pinstripe(dice: &mut Dice) -> Painting {
    let period = dice.pick(&[32usize, 64, 64]);
    let ground = dice.range(0.55, 0.68);
    let soft = Field::noise(dice, 4, 64, 2, 0.8);
    let canvas = Canvas::from_fn(|x, y| {
        let line = x % period < 2 && (y / 2) % 3 != 0;
        let v = if line { 0.98 } else { ground };
        [v + 0.03 * soft.0[y * SIDE + x]; 3]
    });
    woven(dice, canvas, 0.06).into()
}

/// Tartan on a light ground.
pub(super) fn plaid(dice: &mut Dice) -> Painting {
    let period = dice.pick(&[128usize, 256]) as f32;
    let colors = palette(dice);
    let bands: Vec<(f32, f32, Rgb)> = (0..4)
        .map(|k| (dice.range(0.0, 0.85), dice.range(0.03, 0.24), mix(colors[k], WHITE, 0.15)))
        .collect();
    let canvas = Canvas::from_fn(|x, y| {
        let twill = (x + y) / 2 % 2 == 0;
        let p = (if twill { x } else { y } as f32 % period) / period;
        let band = bands.iter().find(|(at, width, _)| p >= *at && p < at + width);
        band.map_or(GROUND, |b| b.2)
    });
    // Both directions show at every place, as the eye blends the twill from afar.
    let mut soft = canvas.clone();
    soft.repaint(|x, y, color| mix(color, canvas.0[y * SIDE + (x + 2) % SIDE], 0.35));
    woven(dice, soft, 0.04).into()
}

/// Squares of two threads' colours: gingham.
pub(super) fn checks(dice: &mut Dice) -> Painting {
    let size = dice.pick(&[16usize, 32, 32, 64]);
    let dark = palette(dice)[0];
    let canvas = Canvas::from_fn(|x, y| {
        let both =
            usize::from((x / size).is_multiple_of(2)) + usize::from((y / size).is_multiple_of(2));
        mix(GROUND, dark, both as f32 * 0.42)
    });
    woven(dice, canvas, 0.06).into()
}

/// Printed dots.
pub(super) fn dots(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[8usize, 16, 16, 32]);
    let size = FULL / count as f32;
    let color = lit(palette(dice)[0], 0.9);
    let radius = size * dice.range(0.16, 0.34);
    let mut canvas = Canvas::filled(GROUND);
    for row in 0..count {
        for column in 0..count {
            let shift = if row % 2 == 1 { 1.0 } else { 0.5 };
            canvas.disc(
                [(column as f32 + shift) * size, (row as f32 + 0.5) * size],
                radius,
                color,
                1.0,
            );
        }
    }
    woven(dice, canvas, 0.05).into()
}

/// Knitwear: columns of V-shaped stitches, in bands of several tones or one.
pub(super) fn knit(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[16usize, 32, 32]);
    let size = FULL / count as f32;
    let colors = palette(dice).map(|c| mix(c, WHITE, 0.25));
    let pattern = dice.below(3);
    let rows: Vec<Rgb> = (0..count)
        .map(|_| if pattern == 0 || dice.chance(0.6) { GROUND } else { dice.pick(&colors) })
        .collect();
    let fuzz = Field::fbm(dice, 64, 3);
    let stitch = |x: f32, y: f32| {
        let u = fract(x / size) - 0.5;
        // Each leg of the V leans towards the middle.
        let v = fract(y / size + u.abs() * 1.3) - 0.5;
        (1.0 - 14.0 * (u.abs() - 0.25) * (u.abs() - 0.25)).max(0.0) * (1.0 - 2.6 * v * v).max(0.0)
    };
    let height = Field::from_fn(|x, y| stitch(x as f32 + 0.5, y as f32 + 0.5));
    let color = Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let (c, r) = ((x as f32 / size) as usize, (y as f32 / size) as usize);
        let star = pattern == 2 && (c + r) % 4 == 0 && r % 8 < 4;
        let base = if star { colors[0] } else { rows[r] };
        lit(base, 0.6 + 0.42 * height.0[i] + 0.07 * fuzz.0[i])
    });
    Painting { color, height: Some(height.map(|h| h * size * 0.22)) }
}

/// Patches in tones of the garment's own colour.
pub(super) fn camouflage(dice: &mut Dice) -> Painting {
    let cells = 4 + dice.below(4);
    let warp = [Field::fbm(dice, 6, 3), Field::fbm(dice, 6, 3)];
    let layers: [Field; 3] =
        std::array::from_fn(|_| Field::fbm(dice, cells, 2).warped([&warp[0], &warp[1]], 18.0));
    let hues: [Rgb; 4] = std::array::from_fn(|k| {
        let v = [0.95, 0.74, 0.55, 0.38][k];
        mix([v; 3], hsv(dice.range(0.08, 0.4), 0.4, v), 0.45)
    });
    let canvas = Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let k = if layers[0].0[i] > 0.3 {
            3
        } else if layers[1].0[i] > 0.12 {
            2
        } else {
            usize::from(layers[2].0[i] > 0.0)
        };
        hues[k]
    });
    woven(dice, canvas, 0.05).into()
}

/// Small flowers on a light ground.
pub(super) fn floral(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let green = hsv(dice.range(0.24, 0.4), 0.4, 0.55);
    let mut canvas = Canvas::filled(GROUND);
    for _ in 0..90 {
        let (place, radius, turn) = (dice.place(), dice.range(8.0, 22.0), dice.unit());
        let color = dice.pick(&colors[1..]);
        for k in 0..2 {
            let angle = turn + 0.13 + 0.5 * k as f32;
            let u = [cos_turns(angle), sin_turns(angle)];
            let at = [place[0] + u[0] * radius * 1.2, place[1] + u[1] * radius * 1.2];
            canvas.ellipse(at, u, [radius * 0.5, radius * 0.22], |_, _| green);
        }
        for k in 0..5 {
            let angle = turn + k as f32 * 0.2;
            let u = [cos_turns(angle), sin_turns(angle)];
            let at = [place[0] + u[0] * radius * 0.55, place[1] + u[1] * radius * 0.55];
            canvas.ellipse(at, u, [radius * 0.45, radius * 0.34], |s, t| {
                lit(color, 1.05 - 0.15 * s.abs() - 0.15 * t.abs())
            });
        }
        canvas.disc(place, radius * 0.22, hex(0xf4d35e), 1.0);
    }
    woven(dice, canvas, 0.05).into()
}

/// Melange: fibres of several tones spun together.
pub(super) fn heather(dice: &mut Dice) -> Painting {
    let contrast = dice.range(0.07, 0.16);
    let fine = Field::noise(dice, 96, 24, 2, 0.8);
    let cross = Field::noise(dice, 24, 96, 2, 0.8);
    let flecks = Cells::new(dice, 48, 1.0);
    let tones: Vec<f32> = (0..flecks.len())
        .map(|_| if dice.chance(0.25) { dice.range(-0.25, 0.05) } else { 0.0 })
        .collect();
    let mut canvas = Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let near = flecks.near(x as f32, y as f32 * 1.0);
        let fleck = tones[near.id] * smooth(5.0, 1.0, near.first);
        [0.84 + contrast * (fine.0[i] + cross.0[i]) * 0.7 + fleck; 3]
    });
    canvas.grain(dice, 0.04);
    canvas.into()
}

/// Leather: a net of fine creases.
pub(super) fn leather(dice: &mut Dice) -> Painting {
    let count = dice.pick(&[48usize, 64, 80]);
    let cells = Cells::new(dice, count, 0.9);
    let size = FULL / count as f32;
    let worn = Field::fbm(dice, 3, 5);
    let bend = Field::fbm(dice, 16, 3);
    let height = Field::from_fn(|x, y| {
        let d = 3.0 * bend.0[y * SIDE + x];
        let near = cells.near(x as f32 + d, y as f32 - d);
        smooth(0.0, size * 0.55, near.second - near.first)
    });
    let color = Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        [0.66 + 0.22 * height.0[i] + 0.1 * worn.0[i]; 3]
    });
    Painting { color, height: Some(height.map(|h| h * 1.4)) }
}

/// Herringbone: twill that turns back.
pub(super) fn herringbone(dice: &mut Dice) -> Painting {
    let size = dice.pick(&[16usize, 32, 32, 64]);
    let dark = dice.range(0.52, 0.75);
    let soft = Field::fbm(dice, 64, 3);
    let mut canvas = Canvas::from_fn(|x, y| {
        let column = x / size;
        let along = if column.is_multiple_of(2) { x % size + y } else { size - 1 - x % size + y };
        let t = smooth(-0.3, 0.3, sin_turns(along as f32 / 8.0));
        [dark + (0.95 - dark) * t + 0.05 * soft.0[y * SIDE + x]; 3]
    });
    canvas.grain(dice, 0.03);
    canvas.into()
}

/// Fleece: soft lumps of pile.
pub(super) fn fleece(dice: &mut Dice) -> Painting {
    let cells = dice.pick(&[16usize, 24, 40]);
    let warp = [Field::fbm(dice, cells, 3), Field::fbm(dice, cells, 3)];
    let pile = Field::fbm(dice, cells, 4).warped([&warp[0], &warp[1]], 7.0);
    Canvas::from_field(&pile, |v| [0.84 + 0.17 * v; 3]).into()
}

/// Tie-dye: rings of colour that ran.
pub(super) fn batik(dice: &mut Dice) -> Painting {
    let colors = palette(dice).map(|c| mix(c, WHITE, 0.3));
    let run = [Field::fbm(dice, 3, 5), Field::fbm(dice, 3, 5)];
    let rings = Field::fbm(dice, 2, 2).warped([&run[0], &run[1]], 60.0);
    let count = dice.range(1.2, 2.6);
    let canvas = Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let t = 0.5 + 0.5 * sin_turns(rings.0[i] * count + 0.1 * run[0].0[i]);
        mix(super::canvas::ramp(&colors, t), GROUND, smooth(0.1, 0.6, run[1].0[i]) * 0.6)
    });
    woven(dice, canvas, 0.05).into()
}
