//! How good a triangle mesh is: shapes of triangles, valences, seams, and whether it is a manifold.

use std::collections::{BTreeMap, HashMap, HashSet};

use glam::Vec3;

use crate::Mesh;

/// Figures of one mesh. Angles in degrees.
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    /// Its vertices.
    pub vertices: usize,
    /// Its triangles.
    pub triangles: usize,
    /// Smallest angle of all triangles.
    pub angle_min_deg: f32,
    /// Median of the triangles' smallest angles.
    pub angle_median_deg: f32,
    /// Longest edge over twice the inradius times the square root of 3, worst of all: 1 when equilateral.
    pub aspect_max: f32,
    /// How many vertices have so many edges, of those inside the surface.
    pub valences: BTreeMap<usize, usize>,
    /// Share of the vertices inside the surface that have 5 to 7 edges.
    pub valence_5_to_7: f32,
    /// Closed lines that bound the surface.
    pub boundary_loops: usize,
    /// Whether every edge has two triangles at most, turned alike, and every vertex one fan of them.
    pub manifold: bool,
}

/// Lengths of edges, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeLengths {
    /// How many edges.
    pub count: usize,
    /// The shortest.
    pub min_mm: f32,
    /// The one in the middle.
    pub median_mm: f32,
    /// The longest.
    pub max_mm: f32,
}

impl Quality {
    /// Looks at the whole mesh.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Self {
        let (mut angles, mut aspect_max) = (Vec::with_capacity(mesh.triangles.len()), 0.0_f32);
        for t in &mesh.triangles {
            let (angle, aspect) = shape(t.map(|v| mesh.positions[v as usize]));
            angles.push(angle.to_degrees());
            aspect_max = aspect_max.max(aspect);
        }
        angles.sort_by(f32::total_cmp);
        let directed = directed(&mesh.triangles);
        let open: Vec<[u32; 2]> = directed
            .keys()
            .filter(|[a, b]| !directed.contains_key(&[*b, *a]))
            .copied()
            .collect();
        let once = directed.values().all(|count| *count == 1);
        let valences = valences(mesh, &open);
        let inside: usize = valences.values().sum();
        let good: usize = valences.range(5..=7).map(|(_, count)| count).sum();
        Self {
            vertices: mesh.positions.len(),
            triangles: mesh.triangles.len(),
            angle_min_deg: angles.first().copied().unwrap_or(0.0),
            angle_median_deg: angles.get(angles.len() / 2).copied().unwrap_or(0.0),
            aspect_max,
            valence_5_to_7: good as f32 / inside.max(1) as f32,
            valences,
            boundary_loops: loops(&open),
            manifold: once && fans_are_single(&mesh.triangles),
        }
    }
}

/// Lengths of the edges whose both ends are among `vertices`; nothing where there are none.
#[must_use]
pub fn edge_lengths(mesh: &Mesh, vertices: &HashSet<u32>) -> Option<EdgeLengths> {
    let mut lengths: Vec<f32> = undirected(&mesh.triangles)
        .into_iter()
        .filter(|edge| edge.iter().all(|v| vertices.contains(v)))
        .map(|[a, b]| mesh.positions[a as usize].distance(mesh.positions[b as usize]))
        .collect();
    lengths.sort_by(f32::total_cmp);
    Some(EdgeLengths {
        count: lengths.len(),
        min_mm: *lengths.first()?,
        median_mm: lengths[lengths.len() / 2],
        max_mm: *lengths.last()?,
    })
}

/// Smallest angle and aspect of a triangle.
fn shape([a, b, c]: [Vec3; 3]) -> (f32, f32) {
    let angle = |p: Vec3, q: Vec3, r: Vec3| {
        let (u, v) = (q - p, r - p);
        u.cross(v).length().atan2(u.dot(v))
    };
    let smallest = angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b));
    let edges = [a.distance(b), b.distance(c), c.distance(a)];
    let longest = edges.into_iter().fold(0.0, f32::max);
    let doubled = (b - a).cross(c - a).length();
    let inradius = doubled / edges.iter().sum::<f32>().max(f32::MIN_POSITIVE);
    let aspect = longest / (2.0 * 3.0_f32.sqrt() * inradius).max(f32::MIN_POSITIVE);
    (smallest, aspect)
}

fn sides(t: &[u32; 3]) -> [[u32; 2]; 3] {
    let [a, b, c] = *t;
    [[a, b], [b, c], [c, a]]
}

/// How often each edge is walked in each direction.
fn directed(triangles: &[[u32; 3]]) -> HashMap<[u32; 2], usize> {
    let mut counts = HashMap::with_capacity(triangles.len() * 3);
    for side in triangles.iter().flat_map(sides) {
        *counts.entry(side).or_insert(0) += 1;
    }
    counts
}

fn undirected(triangles: &[[u32; 3]]) -> HashSet<[u32; 2]> {
    let ordered = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    triangles.iter().flat_map(sides).map(ordered).collect()
}

fn valences(mesh: &Mesh, open: &[[u32; 2]]) -> BTreeMap<usize, usize> {
    let mut edges = vec![0_usize; mesh.positions.len()];
    for v in undirected(&mesh.triangles).into_iter().flatten() {
        edges[v as usize] += 1;
    }
    for v in open.iter().flatten() {
        edges[*v as usize] = 0;
    }
    let mut valences = BTreeMap::new();
    for count in edges.into_iter().filter(|count| *count > 0) {
        *valences.entry(count).or_insert(0) += 1;
    }
    valences
}

/// Closed lines that open edges make.
fn loops(open: &[[u32; 2]]) -> usize {
    let mut next: HashMap<u32, Vec<u32>> = HashMap::new();
    for [a, b] in open {
        next.entry(*a).or_default().push(*b);
    }
    let mut starts: Vec<u32> = next.keys().copied().collect();
    starts.sort_unstable();
    let mut count = 0;
    for start in starts {
        let mut at = start;
        let mut walked = false;
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            (at, walked) = (to, true);
        }
        count += usize::from(walked);
    }
    count
}

/// Whether the triangles of every vertex hang together by edges at it.
fn fans_are_single(triangles: &[[u32; 3]]) -> bool {
    let mut around: HashMap<u32, Vec<[u32; 2]>> = HashMap::new();
    for &[a, b, c] in triangles {
        for (v, side) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
            around.entry(v).or_default().push(side);
        }
    }
    around.values_mut().all(|sides| {
        let Some(mut ends) = sides.pop() else {
            return true;
        };
        // Grows a chain of sides at both ends until nothing more fits.
        while let Some(i) = sides
            .iter()
            .position(|s| s[0] == ends[1] || s[1] == ends[0])
        {
            let side = sides.swap_remove(i);
            if side[0] == ends[1] {
                ends[1] = side[1];
            } else {
                ends[0] = side[0];
            }
        }
        sides.is_empty()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    /// Two equilateral triangles that share an edge.
    fn rhombus() -> Mesh {
        let h = 0.75_f32.sqrt();
        Mesh {
            positions: vec![
                vec3(0.0, 0.0, 0.0),
                vec3(1.0, 0.0, 0.0),
                vec3(0.5, h, 0.0),
                vec3(0.5, -h, 0.0),
            ],
            triangles: vec![[0, 1, 2], [1, 0, 3]],
            ..Mesh::default()
        }
    }

    #[test]
    fn equilateral_triangles_are_as_good_as_can_be() {
        let q = Quality::of(&rhombus());
        assert!((q.angle_min_deg - 60.0).abs() < 1e-3 && (q.aspect_max - 1.0).abs() < 1e-4);
        assert_eq!((q.boundary_loops, q.manifold), (1, true));
        assert!(q.valences.is_empty(), "all vertices are at the border");
    }

    #[test]
    fn a_third_triangle_on_an_edge_and_a_pinched_vertex_are_no_manifold() {
        let mut fin = rhombus();
        fin.positions.push(vec3(0.5, 0.0, 1.0));
        fin.triangles.push([0, 1, 4]);
        assert!(!Quality::of(&fin).manifold);
        let mut pinched = rhombus();
        pinched
            .positions
            .extend([vec3(2.0, 0.0, 0.0), vec3(2.0, 1.0, 0.0)]);
        pinched.triangles.push([1, 4, 5]);
        assert!(!Quality::of(&pinched).manifold);
    }

    #[test]
    fn a_tetrahedron_is_closed() {
        let mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
            triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
            ..Mesh::default()
        };
        let q = Quality::of(&mesh);
        assert_eq!((q.boundary_loops, q.manifold), (0, true));
        assert_eq!(q.valences, BTreeMap::from([(3, 4)]));
        let all = HashSet::from([0, 1, 2, 3]);
        let lengths = edge_lengths(&mesh, &all).unwrap();
        assert_eq!((lengths.count, lengths.min_mm), (6, 1.0));
    }
}
