//! A triangle surface that answers "what is nearest?" and "what does this ray meet?", for fitting (HEADSHOP 6.2).
//!
//! obvhs builds the hierarchy and casts rays; it has no closest-point query, so the walk here goes over its nodes: the
//! nearer child first, pruned by the distance found so far. Queries may look only at triangles that face a direction,
//! which is how a fit stays off a scan's inside. Exact but for rounding. It neither repairs nor changes the mesh,
//! apart from joining vertices of one place where a file gave every triangle its own.

use std::collections::HashMap;
use std::time::Duration;

use glam::{Vec3, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;
use obvhs::{BvhBuildParams, aabb::Aabb};

use crate::fit::graph::shared_edges;

/// A mesh of which more than this share of edges belongs to one triangle only came without shared vertices.
const LOOSE_EDGES: f32 = 0.5;

/// A barycentric share below this counts as lying on the opposite edge.
const ON_EDGE: f32 = 1e-4;

/// Why a mesh is no surface.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// No triangle of any area.
    #[error("the mesh has no triangle with an area: is it a point cloud?")]
    Empty,
    /// A coordinate is not a number.
    #[error("vertex {0} has a coordinate that is not finite: repair the file")]
    NotFinite(usize),
    /// A triangle refers to a vertex that is not there.
    #[error(
        "triangle {0} refers to a vertex that the mesh does not have: the file is cut off or damaged"
    )]
    Index(usize),
}

/// Where a query met a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The place.
    pub point: Vec3,
    /// The triangle, as numbered in the mesh.
    pub triangle: u32,
    /// Shares of the triangle's three vertices; they sum to one.
    pub barycentric: [f32; 3],
    /// From the query point, mm, never negative.
    pub distance: f32,
}

/// Which triangles a query looks at: those whose normal is within an angle of a direction.
#[derive(Debug, Clone, Copy)]
pub struct Facing {
    /// A unit vector.
    pub direction: Vec3,
    /// Cosine of the widest angle allowed.
    pub cosine: f32,
}

impl Facing {
    /// Everything.
    pub const ANY: Self = Self {
        direction: Vec3::ZERO,
        cosine: -1.0,
    };
}

/// A triangle mesh ready for queries.
pub struct Surface {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    bvh: Bvh2,
    /// In the order of the hierarchy's leaves, so that a leaf reads adjacent memory.
    leaves: Vec<Triangle>,
    leaf_normals: Vec<Vec3A>,
    /// Number in `triangles` of each entry of `leaves`.
    ids: Vec<u32>,
    normals: Vec<Vec3>,
    /// Per triangle: bits 0..3 say that the edge opposite that corner, bits 3..6 that the corner, is on a border.
    borders: Vec<u8>,
}

impl Surface {
    /// Builds the hierarchy, smoothed vertex normals and the borders. Triangles without area are left out.
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, SurfaceError> {
        if let Some(bad) = positions.iter().position(|p| !p.is_finite()) {
            return Err(SurfaceError::NotFinite(bad));
        }
        let count = positions.len();
        if let Some(bad) = triangles
            .iter()
            .position(|t| t.iter().any(|&v| v as usize >= count))
        {
            return Err(SurfaceError::Index(bad));
        }
        let corner = |v: u32| Vec3A::from(positions[v as usize]);
        let (mut solid, mut kept) = (
            Vec::with_capacity(triangles.len()),
            Vec::with_capacity(triangles.len()),
        );
        for (id, &[a, b, c]) in triangles.iter().enumerate() {
            let triangle = Triangle {
                v0: corner(a),
                v1: corner(b),
                v2: corner(c),
            };
            if triangle.compute_normal() != Vec3A::ZERO {
                solid.push(triangle);
                kept.push(id as u32);
            }
        }
        if solid.is_empty() {
            return Err(SurfaceError::Empty);
        }
        let bvh = build_bvh2_from_tris(
            &solid,
            BvhBuildParams::fast_build(),
            &mut Duration::default(),
        );
        let order = &bvh.primitive_indices;
        let leaves: Vec<Triangle> = order.iter().map(|&i| solid[i as usize]).collect();
        let ids = order.iter().map(|&i| kept[i as usize]).collect();
        let leaf_normals = leaves.iter().map(Triangle::compute_normal).collect();

        let mut edges = shared_edges(count, triangles);
        let loose = edges.iter().filter(|e| e.uses == 1).count() as f32;
        let welded = (loose > LOOSE_EDGES * edges.len() as f32).then(|| weld(positions, triangles));
        let joined = welded.as_deref().unwrap_or(triangles);
        if welded.is_some() {
            edges = shared_edges(count, joined);
        }
        let mut on_border = vec![false; count];
        let mut border_edges = std::collections::HashSet::new();
        for e in edges.iter().filter(|e| e.uses == 1) {
            on_border[e.vertices[0] as usize] = true;
            on_border[e.vertices[1] as usize] = true;
            border_edges.insert(e.vertices);
        }
        let borders = joined
            .iter()
            .map(|t| border_bits(*t, &on_border, &border_edges))
            .collect();
        let normals = smooth_normals(positions, joined);
        Ok(Self {
            positions: positions.to_vec(),
            triangles: joined.to_vec(),
            bvh,
            leaves,
            leaf_normals,
            ids,
            normals,
            borders,
        })
    }

    /// The vertices as they were given.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// The triangles, with joined vertices if the mesh came without shared ones.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Vertex normals: by area, and averaged once with the neighbours', as scans are noisy.
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// The nearest point of the surface within `max` mm.
    pub fn closest(&self, point: Vec3, max: f32) -> Option<Hit> {
        self.closest_facing(point, max, Facing::ANY)
    }

    /// The nearest point, within `max` mm, on the triangles that `facing` admits.
    pub fn closest_facing(&self, point: Vec3, max: f32, facing: Facing) -> Option<Hit> {
        let (query, direction) = (Vec3A::from(point), Vec3A::from(facing.direction));
        let mut limit = max * max;
        let mut best: Option<(usize, Vec3A)> = None;
        let root = self.bvh.nodes.first()?;
        let mut stack = Vec::with_capacity(self.bvh.max_depth + 2);
        stack.push((box_distance(root.aabb(), query), 0_u32));
        while let Some((bound, index)) = stack.pop() {
            if bound > limit {
                continue;
            }
            let node = &self.bvh.nodes[index as usize];
            if !node.is_leaf() {
                let (l, r) = (node.first_index, node.first_index + 1);
                let dl = box_distance(self.bvh.nodes[l as usize].aabb(), query);
                let dr = box_distance(self.bvh.nodes[r as usize].aabb(), query);
                let (near, far) = if dl <= dr {
                    ((dl, l), (dr, r))
                } else {
                    ((dr, r), (dl, l))
                };
                stack.extend((far.0 <= limit).then_some(far));
                stack.extend((near.0 <= limit).then_some(near));
                continue;
            }
            let first = node.first_index as usize;
            for leaf in first..first + node.prim_count as usize {
                if direction.dot(self.leaf_normals[leaf]) < facing.cosine {
                    continue;
                }
                let shares = nearest_shares(&self.leaves[leaf], query);
                let squared = mix(&self.leaves[leaf], shares).distance_squared(query);
                if squared < limit || (best.is_none() && squared <= limit) {
                    limit = squared;
                    best = Some((leaf, shares));
                }
            }
        }
        best.map(|(leaf, shares)| self.hit(leaf, shares, point))
    }

    /// The first point within `max` mm along a ray (`direction` of length one) on triangles that `facing` admits.
    pub fn ray(&self, origin: Vec3, direction: Vec3, max: f32, facing: Facing) -> Option<Hit> {
        let ray = Ray::new(origin.into(), slanted(direction).into(), 0.0, max);
        let wanted = Vec3A::from(facing.direction);
        let mut hit = RayHit::none();
        let found = self.bvh.ray_traverse(ray, &mut hit, |ray, leaf| {
            if wanted.dot(self.leaf_normals[leaf]) < facing.cosine {
                return f32::INFINITY;
            }
            self.leaves[leaf].intersect(ray)
        });
        if !found {
            return None;
        }
        let leaf = hit.primitive_id as usize;
        let met = Vec3A::from(origin) + Vec3A::from(direction) * hit.t;
        Some(self.hit(leaf, nearest_shares(&self.leaves[leaf], met), origin))
    }

    /// The smoothed normal at a hit.
    pub fn normal(&self, hit: &Hit) -> Vec3 {
        let [a, b, c] = self.triangles[hit.triangle as usize].map(|v| self.normals[v as usize]);
        let [u, v, w] = hit.barycentric;
        (a * u + b * v + c * w).normalize_or_zero()
    }

    /// Whether a hit lies on a border of the mesh, where "nearest" says nothing: the true surface goes on beyond.
    pub fn on_border(&self, hit: &Hit) -> bool {
        let bits = self.borders[hit.triangle as usize];
        let [u, v, w] = hit.barycentric.map(|share| share <= ON_EDGE);
        let zero = [u, v, w];
        (0..3).any(|k| {
            let edge = bits >> k & 1 == 1 && zero[k];
            let corner = bits >> (3 + k) & 1 == 1 && zero[(k + 1) % 3] && zero[(k + 2) % 3];
            edge || corner
        })
    }

    fn hit(&self, leaf: usize, shares: Vec3A, from: Vec3) -> Hit {
        let point = Vec3::from(mix(&self.leaves[leaf], shares));
        Hit {
            point,
            triangle: self.ids[leaf],
            barycentric: shares.to_array(),
            distance: point.distance(from),
        }
    }
}

/// Vertex normals weighted by area, then averaged once along the triangles.
pub(crate) fn smooth_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut raw = vec![Vec3A::ZERO; positions.len()];
    for &[a, b, c] in triangles {
        let [p, q, r] = [a, b, c].map(|v| Vec3A::from(positions[v as usize]));
        let n = (q - p).cross(r - p);
        for v in [a, b, c] {
            raw[v as usize] += n;
        }
    }
    let unit: Vec<Vec3A> = raw.into_iter().map(Vec3A::normalize_or_zero).collect();
    let mut mean = vec![Vec3A::ZERO; positions.len()];
    for &[a, b, c] in triangles {
        let sum = unit[a as usize] + unit[b as usize] + unit[c as usize];
        for v in [a, b, c] {
            mean[v as usize] += sum;
        }
    }
    mean.into_iter()
        .map(|n| n.normalize_or_zero().into())
        .collect()
}

fn border_bits(t: [u32; 3], on_border: &[bool], edges: &std::collections::HashSet<[u32; 2]>) -> u8 {
    if !t.iter().any(|&v| on_border[v as usize]) {
        return 0;
    }
    (0..3).fold(0, |bits, k| {
        let (a, b) = (t[(k + 1) % 3], t[(k + 2) % 3]);
        let edge = u8::from(edges.contains(&[a.min(b), a.max(b)])) << k;
        bits | edge | u8::from(on_border[t[k] as usize]) << (3 + k)
    })
}

/// Triangles that refer to the first vertex of each place.
fn weld(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut first = HashMap::with_capacity(positions.len() / 4);
    // Adding zero makes one of the two zeros.
    let key = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
    let joined: Vec<u32> = positions
        .iter()
        .enumerate()
        .map(|(i, &p)| *first.entry(key(p)).or_insert(i as u32))
        .collect();
    triangles
        .iter()
        .map(|t| t.map(|v| joined[v as usize]))
        .collect()
}

/// A direction without zeros. A ray that runs exactly along the side of a box meets it at 0 times infinity, which is no
/// number, and is lost: scans of symmetric things have such sides, and views from the front such rays.
fn slanted(direction: Vec3) -> Vec3 {
    /// Off by 20 micrometres on a metre: beyond what rounding leaves open between two triangles that share an edge.
    const LEAST: f32 = 2e-5;
    let away = |d: f32| if d.abs() < LEAST { LEAST } else { d };
    Vec3::from(direction.to_array().map(away))
}

fn box_distance(aabb: &Aabb, p: Vec3A) -> f32 {
    p.clamp(aabb.min, aabb.max).distance_squared(p)
}

fn mix(t: &Triangle, shares: Vec3A) -> Vec3A {
    t.v0 * shares.x + t.v1 * shares.y + t.v2 * shares.z
}

/// Barycentric shares of the point of a triangle nearest to `p`: inside if the projection falls there, else the best
/// of the edges it falls outside of.
fn nearest_shares(t: &Triangle, p: Vec3A) -> Vec3A {
    let (ab, ac, ap) = (t.v1 - t.v0, t.v2 - t.v0, p - t.v0);
    let (bb, bc, cc) = (ab.dot(ab), ab.dot(ac), ac.dot(ac));
    let (pb, pc) = (ap.dot(ab), ap.dot(ac));
    let area = bb * cc - bc * bc;
    if area > 0.0 {
        let v = (cc * pb - bc * pc) / area;
        let w = (bb * pc - bc * pb) / area;
        if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
            return Vec3A::new(1.0 - v - w, v, w);
        }
    }
    let along = |a: Vec3A, b: Vec3A| {
        let e = b - a;
        let s = ((p - a).dot(e) / e.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        (s, (a + e * s).distance_squared(p))
    };
    let (s0, d0) = along(t.v0, t.v1);
    let (s1, d1) = along(t.v1, t.v2);
    let (s2, d2) = along(t.v2, t.v0);
    if d0 <= d1 && d0 <= d2 {
        Vec3A::new(1.0 - s0, s0, 0.0)
    } else if d1 <= d2 {
        Vec3A::new(0.0, 1.0 - s1, s1)
    } else {
        Vec3A::new(s2, 0.0, 1.0 - s2)
    }
}
