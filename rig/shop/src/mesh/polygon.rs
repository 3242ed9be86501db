//! A polygon as triangles: quads by their better diagonal, larger ones by clipping ears, so that
//! dents stay dents. What no ear can be cut from (a polygon that crosses itself) becomes a fan.

use glam::DVec3;

/// Calls `emit` with the corners (as places in `points`) of each triangle.
pub(crate) fn triangulate(points: &[DVec3], mut emit: impl FnMut([usize; 3])) {
    match points.len() {
        0..3 => {}
        3 => emit([0, 1, 2]),
        4 => {
            let [a, b] = split(points);
            emit(a);
            emit(b);
        }
        _ => clip(points, emit),
    }
}

/// The diagonal whose triangles face the same way, and of two such the shorter one.
fn split(p: &[DVec3]) -> [[usize; 3]; 2] {
    let normal = |t: [usize; 3]| (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
    let first = [[0, 1, 2], [0, 2, 3]];
    let second = [[1, 2, 3], [1, 3, 0]];
    let agree = |s: [[usize; 3]; 2]| normal(s[0]).dot(normal(s[1])) > 0.0;
    match (agree(first), agree(second)) {
        (true, false) => first,
        (false, true) => second,
        _ if p[0].distance_squared(p[2]) <= p[1].distance_squared(p[3]) => first,
        _ => second,
    }
}

fn clip(points: &[DVec3], mut emit: impl FnMut([usize; 3])) {
    // Newell's normal: right for dented and slightly bent polygons.
    let mut normal = DVec3::ZERO;
    for (i, &a) in points.iter().enumerate() {
        normal += a.cross(points[(i + 1) % points.len()]);
    }
    let mut ring: Vec<usize> = (0..points.len()).collect();
    while ring.len() > 3 {
        let n = ring.len();
        let corner = |i: usize| [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]];
        let ear = (0..n).find(|&i| is_ear(points, corner(i), &ring, normal));
        let Some(ear) = ear else { break };
        emit(corner(ear));
        ring.remove(ear);
    }
    for i in 1..ring.len() - 1 {
        emit([ring[0], ring[i], ring[i + 1]]);
    }
}

fn is_ear(points: &[DVec3], [a, b, c]: [usize; 3], ring: &[usize], normal: DVec3) -> bool {
    let [pa, pb, pc] = [a, b, c].map(|i| points[i]);
    let left = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).dot(normal);
    if left(pa, pb, pc) <= 0.0 {
        return false;
    }
    ring.iter()
        .filter(|&&i| i != a && i != b && i != c)
        .all(|&i| {
            let p = points[i];
            left(pa, pb, p) < 0.0 || left(pb, pc, p) < 0.0 || left(pc, pa, p) < 0.0
        })
}
