//! Fewer triangles for the skin of the cheapest tier (HABER 3.1, mesh decimation): drawn in software, half the
//! triangles save about a seventh of a picture's time. A vertex is left out by moving it along an edge to a neighbour, wherever what
//! it knew (place, normal, shares, place in the chart) can be read off the triangles that remain; so can all that was
//! left out before it. What remains keeps its number, and moves as before.
//!
//! Borders, slits and seams of the chart stay, and so does what the caller keeps. It looks at the head at rest, once,
//! whatever head it is; where nothing is tolerated the skin stays fine.

use glam::Vec3;

use super::fans::{Fans, in_rings};

/// What a vertex is drawn with besides its place, each in units of what it may be off.
pub(crate) const TRAITS: usize = 17;
pub(crate) type Traits = [f32; TRAITS];

/// A surface to be drawn with fewer triangles.
#[derive(Debug)]
pub(crate) struct Fine<'a> {
    pub(crate) triangles: &'a [[u32; 3]],
    /// By vertex, mm.
    pub(crate) points: &'a [Vec3],
    /// By vertex, of unit length.
    pub(crate) normals: &'a [Vec3],
    pub(crate) traits: &'a [Traits],
    /// By vertex, how far the surface may be off, mm: 0 keeps the vertex.
    pub(crate) tolerance_mm: &'a [f32],
}

/// Passes over all vertices; later ones would find next to nothing.
const PASSES: usize = 12;
/// Longest side of a triangle that is made, mm: a longer one would not follow what moves beneath it.
const SIDE_MM: f32 = 16.0;
/// Least area of a triangle that is made, against an equilateral one whose sides have the same mean square.
const ROUND: f32 = 0.25;
/// How far a triangle that is made may be turned from its corners' normals: cosine.
const FACING: f32 = 0.6;
/// Most triangles round a vertex: more would be slivers.
const FAN_MAX: usize = 11;

/// The triangles that remain, in an order in which neighbours follow one another.
pub(crate) fn coarse(fine: &Fine<'_>) -> Vec<[u32; 3]> {
    let mut mesh = Mesh {
        fine,
        triangles: fine.triangles.to_vec(),
        read_off: vec![Vec::new(); fine.triangles.len()],
    };
    let kept = mesh.kept();
    let mut changed = vec![true; fine.points.len()];
    for _ in 0..PASSES {
        if mesh.pass(&kept, &mut changed) == 0 {
            break;
        }
    }
    in_rings(&mesh.triangles, fine.points.len())
}

/// The surface between two passes.
struct Mesh<'a> {
    fine: &'a Fine<'a>,
    triangles: Vec<[u32; 3]>,
    /// The vertices left out that are read off each triangle.
    read_off: Vec<Vec<u32>>,
}

/// A vertex that may be left out.
struct Collapse {
    /// 1 is all that is tolerated.
    error: f32,
    from: u32,
    /// The neighbour that takes over its triangles.
    to: u32,
}

impl Mesh<'_> {
    /// Vertices that stay: the caller's, and those of edges that do not lie between two triangles.
    fn kept(&self) -> Vec<bool> {
        let mut kept: Vec<bool> = self.fine.tolerance_mm.iter().map(|t| *t <= 0.0).collect();
        let mut edges: Vec<[u32; 2]> = self
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        edges.sort_unstable();
        for same in edges.chunk_by(|a, b| a == b).filter(|e| e.len() != 2) {
            for &i in &same[0] {
                kept[i as usize] = true;
            }
        }
        kept
    }

    /// Leaves vertices out, those first that are missed least, and no two near each other; says how many. Only where the
    /// pass before `changed` something there is something new to be found; takes over where this one did.
    fn pass(&mut self, kept: &[bool], changed: &mut [bool]) -> usize {
        let vertices = self.fine.points.len();
        let fans = Fans::of(&self.triangles, vertices);
        let mut wanted: Vec<Collapse> = (0..vertices as u32)
            .filter(|&from| changed[from as usize] && !kept[from as usize])
            .filter(|&from| !fans.at(from).is_empty())
            .filter_map(|from| self.best(&fans, from))
            .collect();
        wanted.sort_by(|a, b| a.error.total_cmp(&b.error).then(a.from.cmp(&b.from)));
        let mut touched = vec![false; vertices];
        let mut count = 0;
        for collapse in &wanted {
            let fan = fans.at(collapse.from);
            let corners = || fan.iter().flat_map(|&t| self.triangles[t as usize]);
            if corners().any(|i| touched[i as usize]) {
                continue;
            }
            corners().for_each(|i| touched[i as usize] = true);
            self.leave_out(fan, collapse);
            count += 1;
        }
        // What lies about a vertex is its neighbours' triangles, too.
        changed.fill(false);
        for t in &self.triangles {
            if t.iter().any(|&i| touched[i as usize]) {
                t.iter().for_each(|&i| changed[i as usize] = true);
            }
        }
        let gone = |t: &[u32; 3]| t[0] == t[1];
        let mut triangles = self.triangles.iter();
        self.read_off
            .retain(|_| !triangles.next().is_some_and(gone));
        self.triangles.retain(|t| !gone(t));
        count
    }

    /// The neighbour that replaces a vertex best, if any does.
    fn best(&self, fans: &Fans, from: u32) -> Option<Collapse> {
        let neighbours = self.neighbours(fans, from);
        neighbours
            .iter()
            .filter_map(|&to| {
                let error = self.error(fans, &neighbours, from, to)?;
                Some(Collapse { error, from, to })
            })
            .min_by(|a, b| a.error.total_cmp(&b.error))
    }

    fn neighbours(&self, fans: &Fans, vertex: u32) -> Vec<u32> {
        let corners = fans
            .at(vertex)
            .iter()
            .flat_map(|&t| self.triangles[t as usize]);
        let mut all: Vec<u32> = corners.filter(|&i| i != vertex).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// How far the surface would be off, as a share of what is tolerated; none where it must not be done.
    fn error(&self, fans: &Fans, ring: &[u32], from: u32, to: u32) -> Option<f32> {
        let fan = fans.at(from);
        let common = self
            .neighbours(fans, to)
            .into_iter()
            .filter(|i| ring.binary_search(i).is_ok());
        // The two triangles at the edge between them are gone from either fan.
        let crowded = fan.len() + fans.at(to).len() > FAN_MAX + 4;
        if crowded || common.count() != 2 {
            return None;
        }
        let made: Vec<[u32; 3]> = self.made(fan, from, to).map(|(_, t)| t).collect();
        let before = fan
            .iter()
            .map(|&t| self.roundness(self.triangles[t as usize]));
        let least = before.fold(ROUND, f32::min);
        if made.iter().any(|t| !self.fits(*t, least)) {
            return None;
        }
        let mut error = 0.0_f32;
        for vertex in self.missed(fan, from) {
            let (_, off) = self.read(made.iter().copied(), vertex)?;
            error = error.max(off);
            if error > 1.0 {
                return None;
            }
        }
        Some(error)
    }

    /// The triangles of a vertex's fan as they are when a neighbour takes it over, with their numbers.
    fn made<'m>(
        &'m self,
        fan: &'m [u32],
        from: u32,
        to: u32,
    ) -> impl Iterator<Item = (u32, [u32; 3])> + 'm {
        fan.iter()
            .map(|&number| (number, self.triangles[number as usize]))
            .filter(move |(_, t)| !t.contains(&to))
            .map(move |(number, t)| (number, t.map(|i| if i == from { to } else { i })))
    }

    /// What would have to be read off the triangles that are made.
    fn missed<'m>(&'m self, fan: &'m [u32], from: u32) -> impl Iterator<Item = u32> + 'm {
        let before = fan.iter().flat_map(|&t| &self.read_off[t as usize]);
        std::iter::once(from).chain(before.copied())
    }

    fn roundness(&self, triangle: [u32; 3]) -> f32 {
        let [a, b, c] = triangle.map(|i| self.fine.points[i as usize]);
        let sides = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
        2.0 * 3.0_f32.sqrt() * (b - a).cross(c - a).length() / sides.max(1e-9)
    }

    /// Whether a triangle may be made.
    fn fits(&self, triangle: [u32; 3], roundness: f32) -> bool {
        let [a, b, c] = triangle.map(|i| self.fine.points[i as usize]);
        let longest = a.distance_squared(b).max(b.distance_squared(c));
        let longest = longest.max(c.distance_squared(a));
        let face = (b - a).cross(c - a).normalize_or_zero();
        let turned = |i: u32| face.dot(self.fine.normals[i as usize]) < FACING;
        longest <= SIDE_MM * SIDE_MM
            && self.roundness(triangle) >= roundness
            && !triangle.into_iter().any(turned)
    }

    /// Which of the triangles lies over a vertex that was left out, counted from 0, and how far what it says there is off.
    fn read(&self, triangles: impl Iterator<Item = [u32; 3]>, vertex: u32) -> Option<(usize, f32)> {
        let p = self.fine.points[vertex as usize];
        let (at, triangle, weights) = triangles
            .enumerate()
            .map(|(at, t)| (at, t, weights(t.map(|i| self.fine.points[i as usize]), p)))
            .max_by(|a, b| a.2.min_element().total_cmp(&b.2.min_element()))?;
        let inside = weights.max(Vec3::ZERO);
        let inside = (inside / inside.element_sum()).to_array();
        let mut place = Vec3::ZERO;
        let mut traits = self.fine.traits[vertex as usize];
        for (&corner, share) in triangle.iter().zip(inside) {
            place += self.fine.points[corner as usize] * share;
            let known = &self.fine.traits[corner as usize];
            traits
                .iter_mut()
                .zip(known)
                .for_each(|(sum, v)| *sum -= v * share);
        }
        let off = place.distance(p) / self.fine.tolerance_mm[vertex as usize].max(1e-6);
        Some((at, traits.iter().fold(off, |most, v| most.max(v.abs()))))
    }

    /// Moves a vertex to its neighbour: triangles of both are gone, marked by a corner twice.
    fn leave_out(&mut self, fan: &[u32], collapse: &Collapse) {
        let made: Vec<_> = self.made(fan, collapse.from, collapse.to).collect();
        let missed: Vec<u32> = self.missed(fan, collapse.from).collect();
        let places: Vec<_> = missed
            .iter()
            .map(|&vertex| self.read(made.iter().map(|m| m.1), vertex))
            .collect();
        for &number in fan {
            self.read_off[number as usize].clear();
            self.triangles[number as usize] = [0; 3];
        }
        for &(number, triangle) in &made {
            self.triangles[number as usize] = triangle;
        }
        for (vertex, place) in missed.into_iter().zip(places) {
            if let Some((at, _)) = place {
                self.read_off[made[at].0 as usize].push(vertex);
            }
        }
    }
}

/// A place over a triangle as shares of its corners; below 0 beyond a side.
fn weights([a, b, c]: [Vec3; 3], p: Vec3) -> Vec3 {
    let (e, f, d) = (b - a, c - a, p - a);
    let n = e.cross(f);
    let scale = 1.0 / n.length_squared().max(1e-12);
    let (of_b, of_c) = (d.cross(f).dot(n) * scale, e.cross(d).dot(n) * scale);
    Vec3::new(1.0 - of_b - of_c, of_b, of_c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    /// A square of `n` x `n` cells of 1 mm, as high at each place as is said.
    fn square(n: u32, height: impl Fn(f32, f32) -> f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let across = n + 1;
        let points = (0..across * across).map(|i| {
            let (x, y) = ((i % across) as f32, (i / across) as f32);
            vec3(x, y, height(x, y))
        });
        let cells = (0..n * n).map(|i| (i / n) * across + i % n);
        let triangles =
            cells.flat_map(|a| [[a, a + 1, a + across + 1], [a, a + across + 1, a + across]]);
        (points.collect(), triangles.collect())
    }

    fn left(points: &[Vec3], triangles: &[[u32; 3]], tolerance_mm: &[f32]) -> Vec<[u32; 3]> {
        coarse(&Fine {
            triangles,
            points,
            normals: &vec![Vec3::Z; points.len()],
            traits: &vec![[0.0; TRAITS]; points.len()],
            tolerance_mm,
        })
    }

    fn area(points: &[Vec3], triangles: &[[u32; 3]]) -> f32 {
        let twice = triangles.iter().map(|t| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            (b - a).cross(c - a).z
        });
        0.5 * twice.sum::<f32>()
    }

    #[test]
    fn a_plane_needs_few_triangles_and_keeps_its_border_and_what_is_to_be_kept() {
        let (points, triangles) = square(12, |_, _| 0.0);
        let mut tolerance = vec![0.2; points.len()];
        let middle = 6 * 13 + 6;
        tolerance[middle] = 0.0;
        let out = left(&points, &triangles, &tolerance);
        assert!(out.len() < triangles.len() / 2, "{}", out.len());
        assert!((area(&points, &out) - 144.0).abs() < 1e-3);
        let used = |i: usize| out.as_flattened().contains(&(i as u32));
        assert!(used(middle));
        let on_border = |p: &Vec3| [p.x, p.y].iter().any(|v| *v == 0.0 || *v == 12.0);
        assert!((0..points.len()).all(|i| !on_border(&points[i]) || used(i)));
        let edges = |list: &[[u32; 3]]| {
            let mut all: Vec<_> = list
                .iter()
                .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
                .collect();
            all.sort_unstable();
            all
        };
        let all = edges(&out);
        assert!(
            all.windows(2).all(|e| e[0] != e[1]),
            "an edge runs twice one way"
        );
    }

    #[test]
    fn no_place_is_farther_off_than_is_tolerated() {
        let bump = |x: f32, y: f32| 3.0 * (-((x - 6.0).powi(2) + (y - 6.0).powi(2)) / 40.0).exp();
        let (points, triangles) = square(12, bump);
        let out = left(&points, &triangles, &vec![0.1; points.len()]);
        assert!(out.len() < triangles.len() * 3 / 4, "{}", out.len());
        assert!((area(&points, &out) - 144.0).abs() < 1e-3);
        for p in &points {
            let off = out.iter().filter_map(|t| {
                let corners = t.map(|i| points[i as usize]);
                let flat = corners.map(|c| c.with_z(0.0));
                let w = weights(flat, p.with_z(0.0));
                let z = w.dot(Vec3::from(corners.map(|c| c.z)));
                (w.min_element() > -1e-4).then_some((z - p.z).abs())
            });
            let off = off.fold(f32::INFINITY, f32::min);
            // The tolerance is from surface to place, this is along z.
            assert!(off < 0.15, "{off} mm at {p}");
        }
    }

    #[test]
    fn what_is_drawn_on_a_vertex_keeps_it() {
        let (points, triangles) = square(12, |_, _| 0.0);
        let mut traits = vec![[0.0; TRAITS]; points.len()];
        let spot = 5 * 13 + 7;
        traits[spot][4] = 1.5;
        let out = coarse(&Fine {
            triangles: &triangles,
            points: &points,
            normals: &vec![Vec3::Z; points.len()],
            traits: &traits,
            tolerance_mm: &vec![0.2; points.len()],
        });
        assert!(out.as_flattened().contains(&(spot as u32)));
        assert!(out.len() < triangles.len() * 2 / 3);
    }
}
