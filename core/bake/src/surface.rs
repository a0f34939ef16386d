//! Triangle surfaces: corners, normals, rays and distances.

use glam::DVec3;

use crate::source::Corner;

/// Two triangles a quad.
pub fn triangles(quads: &[[Corner; 4]]) -> Vec<[Corner; 3]> {
    quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

/// Smooth unit normals of the vertices of `tris`, weighted by area; zero where none meet.
pub fn normals(positions: &[DVec3], tris: impl Iterator<Item = [usize; 3]>) -> Vec<DVec3> {
    let mut n = vec![DVec3::ZERO; positions.len()];
    for [a, b, c] in tris {
        let f = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
        for v in [a, b, c] {
            n[v] += f;
        }
    }
    n.iter().map(|n| n.normalize_or_zero()).collect()
}

/// Where a ray meets a triangle: distance along it and barycentric coordinates.
pub fn ray_triangle(o: DVec3, d: DVec3, p: [DVec3; 3]) -> Option<(f64, [f64; 3])> {
    let (e1, e2) = (p[1] - p[0], p[2] - p[0]);
    let h = d.cross(e2);
    let det = e1.dot(h);
    if det.abs() < 1e-14 {
        return None;
    }
    let s = (o - p[0]) / det;
    let u = s.dot(h);
    let q = s.cross(e1);
    let v = d.dot(q);
    let t = e2.dot(q);
    (u >= -1e-9 && v >= -1e-9 && u + v <= 1.0 + 1e-9 && t > 1e-6)
        .then_some((t, [1.0 - u - v, u, v]))
}

/// Squared distance of a point from a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
pub fn distance_squared(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ap.length_squared();
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return bp.length_squared();
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (ap - ab * (d1 / (d1 - d3))).length_squared();
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return cp.length_squared();
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (ap - ac * (d2 / (d2 - d6))).length_squared();
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (bp - (c - b) * w).length_squared();
    }
    let denom = va + vb + vc;
    if denom <= 0.0 {
        return ap.length_squared();
    }
    (ap - ab * (vb / denom) - ac * (vc / denom)).length_squared()
}

/// 0 below a, 1 above b, smooth between; falling where a > b.
pub fn smoothstep(a: f64, b: f64, x: f64) -> f64 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Piecewise linear through ascending (x, y), constant outside.
pub fn polyline(points: &[(f64, f64)], x: f64) -> f64 {
    let i = points.partition_point(|p| p.0 <= x);
    match (i.checked_sub(1).and_then(|i| points.get(i)), points.get(i)) {
        (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0),
        (Some(a), None) | (None, Some(a)) => a.1,
        (None, None) => 0.0,
    }
}
