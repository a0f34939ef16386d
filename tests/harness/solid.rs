//! Distance to a surface, and what is inside of it: brute force in double precision.

use glam::DVec3;

/// The distance of a point from a triangle: to its projection, if that lies inside, or to the
/// nearest point of an edge.
#[must_use]
pub fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let inside = [(a, b), (b, c), (c, a)]
        .into_iter()
        .all(|(from, to)| (to - from).cross(p - from).dot(normal) >= 0.0);
    if inside && normal.length() > 0.0 {
        return (p - a).dot(normal.normalize()).abs();
    }
    let to_edge = |from: DVec3, to: DVec3| {
        let along = to - from;
        let t = (p - from).dot(along) / along.length_squared().max(1e-30);
        p.distance(from + along * t.clamp(0.0, 1.0))
    };
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}

/// How often a surface goes round a point: 1 inside a closed one whose triangles turn
/// counter-clockwise seen from outside, 0 outside, between them near a hole (Jacobson, Kavan and
/// Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding numbers", 2013;
/// solid angles by Van Oosterom and Strackee, 1983).
pub fn winding_number(p: DVec3, triangles: impl Iterator<Item = [DVec3; 3]>) -> f64 {
    let angle = |[a, b, c]: [DVec3; 3]| {
        let (a, b, c) = (a - p, b - p, c - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let volume = a.dot(b.cross(c));
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * volume.atan2(below)
    };
    triangles.map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}
