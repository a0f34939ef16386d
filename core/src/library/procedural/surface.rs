//! What walls and floors are made of: brick, wood, stone, tiles, plaster and rust.

use super::Painting;
use super::canvas::{
    BLACK, Canvas, Rgb, SIDE, WHITE, hex, hsv, lit, mix, palette, ramp, shaded_palette, sin_turns,
    smooth,
};
use super::dice::Dice;
use super::field::{Cells, Field};

/// Brick walls in running bond.
pub(super) fn brick(dice: &mut Dice) -> Painting {
    const BRICKS: [[u32; 3]; 8] = [
        [0x9c4a32, 0x7c3a2a, 0xb5654a],
        [0x8a5a44, 0x6f4636, 0xa57458],
        [0xc9a27c, 0xb08a64, 0xdcbb98],
        [0xe6e1d8, 0xd7d0c4, 0xf3efe8],
        [0x5c5a58, 0x474543, 0x75726f],
        [0x7a2e2b, 0x5a2422, 0x96413a],
        [0xb86f45, 0x9a5a38, 0xd08a5d],
        [0x4d6a78, 0x3c5360, 0x668795],
    ];
    let colors = dice.pick(&BRICKS).map(hex);
    let mortar = lit(mix(hex(0xb8b2a7), hex(0x6b655d), dice.unit()), dice.range(0.7, 1.05));
    let rows = dice.pick(&[8usize, 12, 16, 16]);
    let columns = (rows / 2).max(4);
    let (w, h) = (SIDE as f32 / columns as f32, SIDE as f32 / rows as f32);
    let gap = h * dice.range(0.06, 0.11);
    let tones: Vec<(Rgb, f32)> = (0..rows * columns)
        .map(|_| (mix(dice.pick(&colors), colors[0], dice.unit()), dice.range(0.82, 1.12)))
        .collect();
    let rough = Field::fbm(dice, 32, 4);
    let worn = Field::fbm(dice, 4, 5);
    let mut color = Canvas::filled(mortar);
    let mut height = Field::filled(0.0);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let i = y * SIDE + x;
            let wobble = 1.2 * rough.0[i];
            let py = y as f32 + 0.5;
            let row = ((py / h) as usize).min(rows - 1);
            let px = x as f32 + 0.5 + if row % 2 == 1 { w * 0.5 } else { 0.0 };
            let column = (px / w) as usize;
            let (dx, dy) = (px - column as f32 * w, py - row as f32 * h);
            let inside = dx.min(w - dx).min(dy).min(h - dy) - gap * 0.5 + wobble;
            let cover = smooth(0.0, 2.5, inside);
            let (tone, light) = tones[row * columns + column % columns];
            let face = lit(tone, light * (1.0 + 0.16 * rough.0[i] + 0.1 * worn.0[i]));
            // The joint lies in the shade of the brick above.
            let joint = lit(mortar, 0.85 + 0.15 * rough.0[i] - if dy < gap { 0.18 } else { 0.0 });
            color.0[i] = mix(joint, face, cover);
            height.0[i] = 2.6 * smooth(-1.0, 4.0, inside) + 0.5 * rough.0[i];
        }
    }
    color.grain(dice, 0.02);
    Painting { color, height: Some(height) }
}

/// Planks with grain and knots.
pub(super) fn wood(dice: &mut Dice) -> Painting {
    const WOODS: [[u32; 2]; 9] = [
        [0xd9b382, 0xa87443],
        [0xb07a4a, 0x6e4424],
        [0x7a4b2b, 0x3c2314],
        [0xe8cfa5, 0xc29a63],
        [0x9b958c, 0x5f5a54],
        [0x8c3b26, 0x4d1c12],
        [0xc9d1cf, 0x93a09e],
        [0x4f7c82, 0x2f5258],
        [0xf0ece2, 0xc9c1b1],
    ];
    let [light, dark] = dice.pick(&WOODS).map(hex);
    let planks = dice.pick(&[2usize, 4, 4, 8]);
    let size = SIDE / planks;
    let upright = dice.chance(0.5);
    let bend = Field::noise(dice, 2, 8, 3, 0.5);
    let fibre = Field::noise(dice, 4, 128, 2, 0.8);
    let blotch = Field::noise(dice, 3, 12, 3, 0.5);
    let rings = dice.range(3.0, 7.0);
    let joints: Vec<(f32, f32, f32, usize)> = (0..planks)
        .map(|_| (dice.range(0.82, 1.1), dice.unit(), dice.range(0.0, 512.0), dice.below(SIDE)))
        .collect();
    let knots: Vec<(f32, f32, f32)> = (0..planks)
        .map(|_| {
            let across = dice.range(0.25, 0.75) * size as f32;
            (dice.range(0.0, SIDE as f32), across, if dice.chance(0.6) { 1.0 } else { 0.0 })
        })
        .collect();
    // Painted lying; upright planks are the same picture turned.
    let paint = |along: usize, across: usize| -> (Rgb, f32) {
        let plank = across / size;
        let (tone, phase, shift, end) = joints[plank];
        let v = (across % size) as f32 + 0.5;
        let i = across * SIDE + (along + shift as usize) % SIDE;
        let (kx, ky, is) = knots[plank];
        let mut dx = (along as f32 - kx).rem_euclid(SIDE as f32);
        if dx > SIDE as f32 * 0.5 {
            dx -= SIDE as f32;
        }
        let (dx, dy) = (dx * 0.35, v - ky);
        let r2 = (dx * dx + dy * dy) / (size as f32 * 3.5);
        let knot = is / (1.0 + r2 * 3.0);
        let t = phase + v / size as f32 * rings + bend.0[i] * 1.3 + knot * 2.6;
        let ring = 0.5 + 0.5 * sin_turns(t);
        let grain = 0.62 * ring * ring + 0.28 * knot + 0.2 * fibre.0[i] + 0.12 * blotch.0[i];
        let edge = v.min(size as f32 - v);
        let along_gap = (along as i32 - end as i32).abs() as f32;
        let gap = smooth(0.0, 2.2, edge.min(along_gap + 0.3));
        (lit(mix(light, dark, grain.clamp(0.0, 1.1)), tone * (0.35 + 0.65 * gap)), gap)
    };
    let mut height = Field::filled(0.0);
    let mut color = Canvas::from_fn(|x, y| {
        let (along, across) = if upright { (y, x) } else { (x, y) };
        let (color, gap) = paint(along, across);
        height.0[y * SIDE + x] = 1.6 * gap + 0.35 * fibre.0[across * SIDE + along];
        color
    });
    color.grain(dice, 0.015);
    Painting { color, height: Some(height) }
}

/// Veined stone.
pub(super) fn marble(dice: &mut Dice) -> Painting {
    const STONES: [[u32; 3]; 8] = [
        [0xf2f0ec, 0xd9d6d0, 0x7d7b78],
        [0x1d1f21, 0x2d2f33, 0xd8d4c8],
        [0x2f4a3e, 0x3f6152, 0xc9d8c9],
        [0xd9b8a0, 0xc79f86, 0x7a4a3a],
        [0xe8dcc3, 0xd2c19d, 0x94753f],
        [0x5b2b2e, 0x743a3d, 0xe6c9c2],
        [0x3a4a63, 0x4d6080, 0xe7ddc6],
        [0xbfc6c9, 0xa3acb1, 0x4c545a],
    ];
    let [base, cloud, vein] = dice.pick(&STONES).map(hex);
    let cells = 2 + dice.below(3);
    let warp = [Field::fbm(dice, cells, 5), Field::fbm(dice, cells, 5)];
    let reach = dice.range(40.0, 90.0);
    let coarse = Field::fbm(dice, cells, 4).warped([&warp[0], &warp[1]], reach);
    let fine = Field::fbm(dice, cells * 2, 4).warped([&warp[1], &warp[0]], reach * 0.6);
    let width = dice.range(0.03, 0.07);
    let mut canvas = Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let ground = mix(base, cloud, smooth(-0.5, 0.7, warp[0].0[i]));
        let thick = width * (1.2 + warp[1].0[i]).max(0.15);
        let main = 1.0 - smooth(0.0, thick * 2.2, coarse.0[i].abs());
        let thin = 1.0 - smooth(0.0, thick * 0.8, fine.0[i].abs());
        mix(ground, vein, (0.75 * main + 0.35 * thin).min(0.95))
    });
    canvas.grain(dice, 0.012);
    canvas.into()
}

/// Glazed tiles: plain, two-toned, with a printed ornament, or a mosaic of hexagons.
pub(super) fn tiles(dice: &mut Dice) -> Painting {
    let colors = palette(dice);
    let grout = mix(hex(0xd5d0c8), hex(0x4a4642), dice.unit());
    let count = dice.pick(&[4usize, 8, 8, 16]);
    let size = SIDE as f32 / count as f32;
    let kind = dice.below(4);
    let tones: Vec<(usize, f32)> =
        (0..4 * count * count).map(|_| (dice.below(5), dice.range(0.9, 1.06))).collect();
    let ornament = Field::fbm(dice, 3, 3);
    let glaze = Field::fbm(dice, 6, 5);
    let gap = (size * 0.035).max(1.2);
    let mut height = Field::filled(0.0);
    let mut color = Canvas::from_fn(|x, y| {
        let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
        let i = y * SIDE + x;
        let (id, edge, u, v) = if kind == 3 {
            hexagon(px, py, size, count)
        } else {
            let (c, r) = ((px / size) as usize, (py / size) as usize);
            let (dx, dy) = (px - c as f32 * size, py - r as f32 * size);
            let edge = dx.min(size - dx).min(dy).min(size - dy);
            (r * count + c, edge, dx / size, dy / size)
        };
        let (pick, light) = tones[id];
        let base = match kind {
            0 => colors[0],
            1 => colors[(id + id / count) % 2],
            2 => {
                let (a, b) = ((u - 0.5).abs(), (v - 0.5).abs());
                let w = ornament.sample(a.max(b) * 330.0, a.min(b) * 330.0);
                colors[((w + 1.0) * 4.0) as usize % 3]
            }
            _ => colors[pick],
        };
        let cover = smooth(gap * 0.5, gap * 0.5 + 1.5, edge);
        let bevel = smooth(gap * 0.5, gap * 0.5 + size * 0.06, edge);
        height.0[i] = 2.0 * bevel + 0.15 * glaze.0[i];
        let shine = 0.9 + 0.1 * bevel + 0.05 * glaze.0[i] + 0.06 * (0.5 - v);
        mix(lit(grout, 0.92 + 0.1 * glaze.0[i]), lit(base, light * shine), cover)
    });
    color.grain(dice, 0.012);
    Painting { color, height: Some(height) }
}

/// Which hexagon of a honeycomb, pixels to its edge, and the place in it.
fn hexagon(px: f32, py: f32, size: f32, count: usize) -> (usize, f32, f32, f32) {
    // Two interleaved grids of centres; rows are squeezed a little so that a whole number fits.
    let (w, h) = (size, size * 2.0);
    let near = |ox: f32, oy: f32| {
        let (c, r) = (((px - ox) / w).round(), ((py - oy) / h).round());
        (c, r, px - ox - c * w, (py - oy - r * h) * (w * 1.732_050_8 / h))
    };
    let (a, b) = (near(0.0, 0.0), near(w * 0.5, h * 0.5));
    let d2 = |p: (f32, f32, f32, f32)| p.2 * p.2 + p.3 * p.3;
    let (p, second) = if d2(a) < d2(b) { (a, 0) } else { (b, 1) };
    let edge =
        (w * 0.5 - p.2.abs()).min(w * 0.5 - 0.5 * p.2.abs() - 0.866_025_4 * p.3.abs()).max(0.0);
    let column = (p.0 as i32).rem_euclid(count as i32) as usize;
    let row = (p.1 as i32).rem_euclid((count / 2) as i32) as usize * 2 + second;
    (row * count + column, edge, 0.5 + p.2 / w, 0.5 + p.3 / w)
}

/// Cells: dry earth, leaded glass, cobbles or a giraffe.
pub(super) fn voronoi(dice: &mut Dice) -> Painting {
    let kind = dice.below(4);
    let count = dice.pick(&[6usize, 8, 12, 16]);
    let cells = Cells::new(dice, count, 0.85);
    let colors = match kind {
        0 => [0x8a6f52, 0x7a5f45, 0x9c8164, 0x6b5039, 0xa98f72].map(hex),
        2 => [0x7d7f80, 0x66696b, 0x94928c, 0x55585a, 0xa19a8e].map(hex),
        3 => [0xb06a2c, 0x9c5a22, 0xc17c3c, 0x8a4d1c, 0xb87434].map(hex),
        _ => palette(dice),
    };
    let line = match kind {
        0 => hex(0x2e2118),
        1 => hex(0x15151a),
        2 => hex(0x35332f),
        _ => hex(0xf0dcb0),
    };
    let tones: Vec<(Rgb, f32)> =
        (0..cells.len()).map(|_| (dice.pick(&colors), dice.range(0.85, 1.15))).collect();
    let rough = Field::fbm(dice, 12, 5);
    let size = SIDE as f32 / count as f32;
    let gap = size * [0.08, 0.07, 0.1, 0.14][kind];
    let mut height = Field::filled(0.0);
    let mut color = Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let bend = if kind == 1 { 0.0 } else { 5.0 * rough.0[i] };
        let near = cells.near(x as f32 + bend, y as f32 - bend);
        let inside = near.second - near.first;
        let (tone, light) = tones[near.id];
        let round = smooth(0.0, size * 0.7, inside);
        height.0[i] = size * 0.12 * round + 0.4 * rough.0[i];
        let shade = match kind {
            1 => 0.75 + 0.5 * round * round,
            2 => 0.6 + 0.45 * round - 0.004 * (near.offset[0] + near.offset[1]),
            _ => 0.93 + 0.1 * round,
        };
        let face = lit(tone, light * shade * (1.0 + 0.16 * rough.0[i]));
        mix(line, face, smooth(gap * 0.4, gap * 1.1, inside))
    });
    color.grain(dice, 0.02);
    Painting { color, height: Some(height) }
}

/// Chips of stone in a polished ground.
pub(super) fn terrazzo(dice: &mut Dice) -> Painting {
    let ground = mix(hex(0xe9e4da), hex(0x3b3d40), dice.unit() * dice.unit());
    let colors = palette(dice);
    let mut color = Canvas::filled(ground);
    color.shade(&Field::fbm(dice, 48, 3), 0.1);
    for (count, share) in [(16usize, 0.5f32), (36, 0.55)] {
        let cells = Cells::new(dice, count, 0.9);
        let chips: Vec<(Rgb, bool, f32)> = (0..cells.len())
            .map(|_| {
                (
                    lit(dice.pick(&colors), dice.range(0.8, 1.1)),
                    dice.chance(share),
                    dice.range(0.15, 0.5),
                )
            })
            .collect();
        let size = SIDE as f32 / count as f32;
        color.repaint(|x, y, old| {
            let near = cells.near(x as f32, y as f32);
            let (tone, is, inset) = chips[near.id];
            let inside = near.second - near.first - inset * size;
            if is { mix(old, tone, smooth(0.0, 1.6, inside)) } else { old }
        });
    }
    color.grain(dice, 0.02);
    color.into()
}

/// Plaster, concrete and rusty or flaking metal.
pub(super) fn grunge(dice: &mut Dice) -> Painting {
    const LOOKS: [[u32; 3]; 9] = [
        [0x8f8d88, 0x6d6b67, 0xb2afa8],
        [0x6f7a80, 0x8a3f1d, 0xb8622b],
        [0x3f5f5a, 0x7b3a1e, 0xc27a3f],
        [0xd8cdb8, 0xa38d6d, 0xefe7d8],
        [0xb9c4c9, 0x7d5a45, 0xe2e8ea],
        [0x4a4c4f, 0x2e2f31, 0x6a6d70],
        [0xc8a24a, 0x6b5a3a, 0xe0c37a],
        [0x9b4f44, 0x5a2f2a, 0xd8b5a0],
        [0x5d7f9e, 0x8a8378, 0xd9dbd6],
    ];
    let [paint, under, pale] = dice.pick(&LOOKS).map(hex);
    let warp = [Field::fbm(dice, 4, 5), Field::fbm(dice, 4, 5)];
    let patches = Field::fbm(dice, 3, 7).warped([&warp[0], &warp[1]], 30.0);
    let fine = Field::fbm(dice, 24, 4);
    let drips = Field::noise(dice, 24, 2, 3, 0.6);
    let level = dice.range(0.05, 0.35);
    let mut height = Field::filled(0.0);
    let mut color = Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let p = patches.0[i] + 0.18 * fine.0[i];
        let flaked = smooth(level, level + 0.06, p);
        height.0[i] = 1.6 * (1.0 - flaked) + 0.5 * fine.0[i];
        let top = lit(mix(paint, pale, smooth(-0.2, 0.9, warp[0].0[i])), 1.0 + 0.08 * fine.0[i]);
        let below =
            lit(mix(under, pale, 0.25 * smooth(0.0, 1.0, fine.0[i])), 1.0 + 0.3 * fine.0[i]);
        let rim = 1.0 - 0.35 * smooth(level - 0.07, level, p) * (1.0 - flaked);
        lit(mix(top, below, flaked), rim * (1.0 + 0.14 * drips.0[i]))
    });
    for _ in 0..6 + dice.below(10) {
        crack(dice, &mut color);
    }
    color.grain(dice, 0.03);
    Painting { color, height: Some(height) }
}

fn crack(dice: &mut Dice, canvas: &mut Canvas) {
    let mut p = dice.place();
    let mut turn = dice.unit();
    for _ in 0..10 + dice.below(25) {
        turn += dice.range(-0.09, 0.09);
        let step = dice.range(4.0, 11.0);
        let u = [super::canvas::cos_turns(turn), sin_turns(turn)];
        let q = [p[0] + u[0] * step, p[1] + u[1] * step];
        let width = dice.range(0.4, 1.4);
        canvas.stroke(p, q, width, 0.3, lit(hex(0x2a2724), 1.0), 0.6);
        p = q;
    }
}

/// Brushed or hammered metal, corrugated sheet and rivets.
pub(super) fn metal(dice: &mut Dice) -> Painting {
    let tint = mix(hsv(dice.unit(), 0.5, 0.6), hex(0x8d939a), dice.range(0.3, 1.0));
    let brushed = Field::noise(dice, 2, 128, 2, 0.8);
    let stain = Field::fbm(dice, 3, 5);
    let panels = dice.pick(&[2usize, 4]);
    let size = SIDE as f32 / panels as f32;
    let wave = dice.pick(&[0.0f32, 0.0, 16.0, 32.0]);
    let mut height = Field::filled(0.0);
    let mut color = Canvas::from_fn(|x, y| {
        let i = y * SIDE + x;
        let (dx, dy) = ((x as f32 + 0.5) % size, (y as f32 + 0.5) % size);
        let edge = dx.min(size - dx).min(dy).min(size - dy);
        let fold = if wave > 0.0 { sin_turns(x as f32 / SIDE as f32 * wave) } else { 0.0 };
        height.0[i] = 2.5 * fold + 1.5 * smooth(0.0, 4.0, edge);
        let bevel = if edge < 3.0 { 0.6 } else { 1.0 };
        let light = 1.0 + 0.2 * brushed.0[i] + 0.22 * stain.0[i] + 0.3 * fold;
        lit(tint, light * bevel)
    });
    let step = size / 8.0;
    for row in 0..panels {
        for column in 0..panels {
            for k in 0..8 {
                let along = (k as f32 + 0.5) * step;
                let corner = [column as f32 * size, row as f32 * size];
                for place in
                    [[along, 10.0], [along, size - 10.0], [10.0, along], [size - 10.0, along]]
                {
                    let p = [corner[0] + place[0], corner[1] + place[1]];
                    color.disc([p[0] + 1.0, p[1] + 1.5], 4.0, BLACK, 0.35);
                    color.disc(p, 3.6, lit(tint, 1.15), 1.0);
                    color.disc([p[0] - 1.0, p[1] - 1.2], 1.3, WHITE, 0.6);
                }
            }
        }
    }
    color.grain(dice, 0.02);
    Painting { color, height: Some(height) }
}

/// Sand, snow, earth and gravel, lit from one side.
pub(super) fn ground(dice: &mut Dice) -> Painting {
    let colors = match dice.below(4) {
        0 => [0x8a6b45, 0xb8925f, 0xd9bc8a, 0xeddcb4].map(hex),
        1 => [0x9fb0bd, 0xc9d6df, 0xe9f0f4, 0xffffff].map(hex),
        2 => [0x2e2219, 0x4a3727, 0x6a5038, 0x8a6d4e].map(hex),
        _ => {
            let c = shaded_palette(dice);
            [lit(c[0], 0.8), c[1], c[2], c[3]]
        }
    };
    let dunes = Field::noise(dice, 3, 6, 3, 0.5);
    let lumps = Field::fbm(dice, 6, 7);
    let ripple = dice.pick(&[0.0f32, 0.25, 0.5]);
    let height = Field::from_fn(|x, y| {
        let i = y * SIDE + x;
        let t = y as f32 / SIDE as f32 * 24.0 + 2.5 * dunes.0[i];
        ripple * 2.2 * sin_turns(t) + 7.0 * lumps.0[i]
    });
    let mut color = Canvas::from_fn(|x, y| {
        let (ix, iy) = (x as i32, y as i32);
        let slope = height.at(ix + 1, iy) - height.at(ix - 1, iy) + height.at(ix, iy + 1)
            - height.at(ix, iy - 1);
        ramp(&colors, 0.5 + 0.3 * dunes.0[y * SIDE + x] + 0.14 * slope)
    });
    color.grain(dice, 0.04);
    Painting { color, height: Some(height) }
}
