//! What is sewn to clothes, as fields over the template: seams, buttons, pockets, zips.
//!
//! Places are those of the garment shell on the template in metres (+Y up, +Z forward, +X the
//! figure's left). Where garments end is decided elsewhere; what they share is painted here, once
//! for everybody, by [`super::maps`].

use super::complexion::step;
use super::creases::ARM_M;

/// Kinds of garments that are sewn alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sewn {
    /// T-shirts and what else is pulled over the head.
    Knit,
    /// The same with cords at the neck.
    Hoodie,
    /// Buttons down the front, a pocket on the chest.
    Shirt,
    /// Two buttons below the collar.
    Polo,
    /// A zip, lapels, pockets.
    Jacket,
    /// Large buttons, lapels, pockets.
    Coat,
    /// Fly, pockets, side seams.
    Trousers,
}

impl Sewn {
    /// All, in order.
    pub const ALL: [Self; 7] = [
        Self::Knit,
        Self::Hoodie,
        Self::Shirt,
        Self::Polo,
        Self::Jacket,
        Self::Coat,
        Self::Trousers,
    ];
}

/// A place of the shell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub p: [f32; 3],
    /// 0 shoulder .. 1 wrist; negative off the arm.
    pub arm: f32,
    /// 0 hip .. 1 ankle; negative above.
    pub leg: f32,
}

/// Distances of buttons below one another, and where the first sits.
const BUTTON_M: f32 = 0.072;
const FIRST_BUTTON_Y: f32 = 0.508;
/// To where a shirt's button fades, half a texel beyond its edge.
const BUTTON_RADIUS_M: f32 = 0.0049;

/// Masks 0..1 at a place: seams; buttons, thread and zips; parts of a darker tone; hollows in which
/// cloth is shaded.
pub(super) fn masks(kind: Sewn, at: Place) -> [f32; 4] {
    let Place { p: [x, y, z], arm, .. } = at;
    let ax = x.abs();
    let front = step(0.01, 0.04, z);
    let on_arm = arm > 0.0;
    let armpit = spot([ax - 0.158, y - 0.437, z - 0.005], 0.060);
    let body = shoulder_seams(at).max(if on_arm {
        0.0
    } else {
        0.8 * line((z - 0.018).abs(), 0.0035) * step(0.08, 0.11, ax) * step(0.43, 0.41, y)
    });
    match kind {
        Sewn::Knit | Sewn::Hoodie => {
            let hem = if on_arm { 0.0 } else { 0.7 * line((y - 0.034).abs(), 0.0030) };
            let cords = if kind == Sewn::Hoodie {
                let way = ((0.515 - y) / 0.13).clamp(0.0, 1.0);
                let cord = line((ax - 0.022 - 0.012 * way).abs(), 0.0042);
                cord * front * step(0.380, 0.386, y) * step(0.520, 0.510, y)
            } else {
                0.0
            };
            [body.max(hem), cords, 0.0, 0.5 * armpit]
        }
        Sewn::Shirt => {
            let chest = [(x - 0.088).abs() - 0.034, (y - 0.372).abs() - 0.040];
            let pocket = 0.8 * line(chest[0].max(chest[1]).abs(), 0.0028) * front;
            let placket = 0.6 * line((ax - 0.0135).abs(), 0.0025) * front;
            let cuff = 0.7 * line((arm - 0.90).abs() * ARM_M, 0.003);
            let seam = body.max(pocket).max(placket).max(cuff);
            [seam, buttons([x, y], FIRST_BUTTON_Y, 7, 1.0) * front, 0.0, 0.5 * armpit]
        }
        Sewn::Polo => {
            let hem = if on_arm { 0.0 } else { 0.7 * line((y - 0.034).abs(), 0.0030) };
            [body.max(hem), buttons([x, y], FIRST_BUTTON_Y, 2, 1.0) * front, 0.0, 0.5 * armpit]
        }
        Sewn::Jacket | Sewn::Coat => outer(kind, at, body, 0.5 * armpit),
        Sewn::Trousers => trousers(at),
    }
}

fn outer(kind: Sewn, at: Place, body: f32, hollow: f32) -> [f32; 4] {
    let Place { p: [x, y, z], arm, .. } = at;
    let ax = x.abs();
    let front = step(0.01, 0.04, z);
    let lapel = step(0.30, 0.52, y);
    let fold = line((ax - 0.030 - 0.060 * lapel + 0.02 * step(0.50, 0.56, y)).abs(), 0.0032)
        * step(0.27, 0.30, y)
        * step(0.56, 0.53, y);
    let welt = segment([ax, y], [0.070, 0.115], [0.118, 0.075], 0.0045);
    let facing = 0.7 * line((ax - 0.016).abs(), 0.003) * step(0.31, 0.29, y);
    let cuff = 0.8 * line((arm - 0.91).abs() * ARM_M, 0.0035);
    let closes = match kind {
        Sewn::Jacket => line(ax, 0.0036) * step(0.31, 0.30, y),
        _ => buttons([x - 0.006, y], 0.285, 3, 1.5),
    };
    let seam = body.max(0.9 * fold * front).max(welt * front).max(facing * front).max(cuff);
    [seam, closes * front, 0.0, hollow]
}

/// Round the arm, and along the shoulder.
fn shoulder_seams(at: Place) -> f32 {
    let Place { p: [x, y, z], arm, .. } = at;
    let armhole = line((arm - 0.045).abs() * ARM_M, 0.0036);
    let shoulder = if arm > 0.045 { 0.0 } else { line((z + 0.004).abs(), 0.0035) };
    (0.6 * armhole).max(0.6 * shoulder * step(0.49, 0.51, y) * step(0.05, 0.06, x.abs()))
}

fn trousers(at: Place) -> [f32; 4] {
    let Place { p: [x, y, z], leg, .. } = at;
    let ax = x.abs();
    let front = step(0.02, 0.05, z);
    let back = step(-0.01, -0.035, z);
    // The leg's axis: hip, knee, ankle of the template.
    let knee = 0.53;
    let axis_z = if leg < knee {
        0.012 + 0.020 * (leg / knee).max(0.0)
    } else {
        0.032 - 0.032 * (leg - knee) / (1.0 - knee)
    };
    let sides = 0.9 * line((z - axis_z).abs(), 0.0034) * step(-0.2, -0.1, leg);
    let middle = line(ax, 0.0032) * step(-0.045, -0.035, y);
    // The fly's stitches turn in to the middle at their lower end.
    let turn = (0.006 - y).clamp(0.0, 0.040) / 0.040;
    let fly = line((x - 0.024 * (1.0 - turn * turn).max(0.0).sqrt()).abs(), 0.0030)
        * front
        * step(-0.036, -0.030, y)
        * step(0.05, 0.04, y);
    let slant = segment([ax, y], [0.104, 0.052], [0.149, -0.048], 0.0050) * front;
    let seat = [(ax - 0.078).abs() - 0.036, (y + 0.012).abs() - 0.042];
    let pocket = line(seat[0].max(seat[1]).abs(), 0.0032) * back;
    let band = 0.8 * line((y - 0.036).abs(), 0.0030);
    let crotch = spot([x, y + 0.055, z - 0.015], 0.070);
    let seam = sides.max(middle).max(band).max(slant).max(0.7 * fly).max(pocket);
    // A texel is wider than a thread, which covers a part of it.
    let thread = (0.5 * fly).max(0.4 * pocket).max(0.3 * slant);
    [seam, thread, 0.5 * step(0.034, 0.038, y), 0.45 * crotch]
}

/// Round buttons below one another, the first at a height; their size against a shirt's.
fn buttons([x, y]: [f32; 2], first_y: f32, count: usize, size: f32) -> f32 {
    let below = first_y - y;
    let k = (below / BUTTON_M + 0.5).floor().clamp(0.0, count as f32 - 1.0);
    let dy = below - k * BUTTON_M;
    if x.abs().max(dy.abs()) >= BUTTON_RADIUS_M * size {
        return 0.0;
    }
    step(BUTTON_RADIUS_M * size, 0.6 * BUTTON_RADIUS_M * size, (x * x + dy * dy).sqrt())
}

/// 1 on a line, 0 from so far beside it on.
fn line(distance: f32, half: f32) -> f32 {
    // Most places are off most lines.
    if distance >= half { 0.0 } else { step(half, 0.4 * half, distance) }
}

fn segment([x, y]: [f32; 2], a: [f32; 2], b: [f32; 2], half: f32) -> f32 {
    let off = |v: f32, a: f32, b: f32| v < a.min(b) - half || v > a.max(b) + half;
    if off(x, a[0], b[0]) || off(y, a[1], b[1]) {
        return 0.0;
    }
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let t = (((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    let (ex, ey) = (x - a[0] - t * dx, y - a[1] - t * dy);
    line((ex * ex + ey * ey).sqrt(), half)
}

fn spot(d: [f32; 3], radius: f32) -> f32 {
    let far = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if far >= radius * radius { 0.0 } else { step(radius * radius, 0.0, far) }
}
