//! The last, local fit: each vertex of the warped template looks for the scan, and the mesh decides together.
//!
//! What is solved for is the displacement of every vertex from where the warp put it. It should bring vertices that
//! found the scan onto its tangent planes, and change as evenly as it can along the mesh (the square of its umbrella
//! Laplacian, relaxed from round to round); landmarks pull softly. So parts with nothing to find (insides of lips, lids
//! and nostrils, holes, the back of the head) continue smoothly what happens around them. Vertices that lie near each
//! other in space without being neighbours, as the two lips do where they meet, are tied and move alike. The system is
//! solved by conjugate gradients with 3 x 3 blocks on the diagonal as the preconditioner.
//!
//! A vertex takes a place on the scan only if the normals agree, it is no farther than the round allows, lies off the
//! mesh's borders, and is straight in front or behind rather than aside: better no place than a wrong one.

use glam::{Mat3A, Vec3, Vec3A};

use super::feature::Place;
use super::graph::{Rings, shared_edges};
use super::{Options, Target, Template};
use crate::closest::{Facing, smooth_normals};

/// Ties join vertices no farther apart than this on the template, mm.
const TIE_MM: f32 = 2.5;

/// How hard a tangent plane's own point pulls, beside the plane: little, so that vertices may slide.
const POINT_SHARE: f32 = 0.02;

/// How hard a vertex with nothing to find holds to the warp. Just enough for the system to be definite.
const HOLD: f32 = 1e-3;

/// Cosine between normals of vertex and scan from which a place is taken.
const AGREE: f32 = 0.6;

/// Cosine between the way to a place and the normal there; asked for beyond `ASIDE_FROM_MM`.
const ASIDE: f32 = 0.75;

/// Nearer than this, noise decides the direction, mm.
const ASIDE_FROM_MM: f32 = 0.4;

/// Stop when the residual has shrunk by this factor: the next round asks anew anyway.
const TOLERANCE: f32 = 1e-3;

/// How hard landmarks pull, beside 1 for a vertex that found its place.
const LANDMARK: f32 = 0.3;

/// The mesh as a system to be solved.
pub(crate) struct Local<'a> {
    template: &'a Template<'a>,
    rings: Rings,
    /// Weight of each entry of `rings`; those of one vertex sum to one.
    shares: Vec<f32>,
    /// Place, where it should be, how hard it pulls.
    landmarks: Vec<(Place, Vec3A, f32)>,
    /// Per vertex: how much more than elsewhere its surroundings resist bending.
    stiff: Vec<f32>,
}

/// What a vertex found: a plane to lie on.
#[derive(Clone, Copy)]
struct Plane {
    point: Vec3A,
    normal: Vec3A,
    weight: f32,
}

impl<'a> Local<'a> {
    pub(crate) fn new(template: &'a Template<'a>, landmarks: Vec<(Place, Vec3, f32)>) -> Self {
        let count = template.positions.len();
        let mesh: Vec<[u32; 2]> = shared_edges(count, template.triangles)
            .into_iter()
            .map(|e| e.vertices)
            .collect();
        let near = Rings::new(count, mesh.iter().copied());
        let tied = ties(template, &near);
        let rings = Rings::new(count, mesh.iter().chain(&tied).copied());
        let mut shares = Vec::new();
        for v in 0..count {
            let at = template.positions[v];
            let weights = rings
                .of(v)
                .iter()
                .map(|&n| 1.0 / at.distance(template.positions[n as usize]).max(0.3));
            let sum: f32 = weights.clone().sum();
            shares.extend(weights.map(|w| w / sum));
        }
        let landmarks = landmarks
            .into_iter()
            .map(|(place, to, share)| (place, to.into(), LANDMARK * share))
            .collect();
        Self {
            template,
            rings,
            shares,
            landmarks,
            stiff: vec![1.0; count],
        }
    }

    /// Moves `positions` (the warped template) onto the target, round by round.
    pub(crate) fn run(
        &mut self,
        positions: &[Vec3],
        target: &Target,
        options: &Options,
    ) -> Vec<Vec3A> {
        let start: Vec<Vec3A> = positions.iter().map(|p| Vec3A::from(*p)).collect();
        let mut moved = vec![Vec3A::ZERO; start.len()];
        for round in 0..options.local_rounds {
            let share = round as f32 / (options.local_rounds.max(2) - 1) as f32;
            let reach = options.reach_mm.0 * (options.reach_mm.1 / options.reach_mm.0).powf(share);
            let stiffness =
                options.stiffness.0 * (options.stiffness.1 / options.stiffness.0).powf(share);
            let planes = self.look(&start, &moved, target, reach);
            self.solve(&start, &mut moved, &planes, stiffness, options.iterations);
        }
        moved
    }

    /// After faces were found turned: the vertices of `marked` stop looking and bend less; solved again.
    pub(crate) fn relax(
        &mut self,
        positions: &[Vec3],
        moved: &mut [Vec3A],
        marked: &[bool],
        target: &Target,
        options: &Options,
    ) {
        for (stiff, _) in self
            .stiff
            .iter_mut()
            .zip(marked)
            .filter(|(_, marked)| **marked)
        {
            *stiff = (*stiff * 10.0).min(1e3);
        }
        for (place, _, pull) in &mut self.landmarks {
            let ids = self.template.triangles[place.triangle as usize];
            if ids.iter().any(|&v| marked[v as usize]) {
                *pull *= 0.1;
            }
        }
        let start: Vec<Vec3A> = positions.iter().map(|p| Vec3A::from(*p)).collect();
        let mut planes = self.look(&start, moved, target, options.reach_mm.1);
        for (plane, stiff) in planes.iter_mut().zip(&self.stiff) {
            *plane = plane.filter(|_| *stiff <= 1.0);
        }
        self.solve(
            &start,
            moved,
            &planes,
            options.stiffness.1,
            2 * options.iterations,
        );
    }

    /// Replaces displacements of `marked` by the mean of their neighbours', a few times: the last resort.
    pub(crate) fn even_out(&self, moved: &mut [Vec3A], marked: &[bool], times: usize) {
        for _ in 0..times {
            for v in (0..moved.len()).filter(|&v| marked[v] && !self.rings.of(v).is_empty()) {
                moved[v] = self.mean(moved, v);
            }
        }
    }

    pub(crate) fn grow(&self, marked: &mut [bool]) {
        self.rings.grow(marked);
    }

    fn look(
        &self,
        start: &[Vec3A],
        moved: &[Vec3A],
        target: &Target,
        reach: f32,
    ) -> Vec<Option<Plane>> {
        let now: Vec<Vec3> = start
            .iter()
            .zip(moved)
            .map(|(s, d)| Vec3::from(*s + *d))
            .collect();
        let normals = smooth_normals(&now, self.template.triangles);
        (0..now.len())
            .map(|v| {
                let freedom = self.template.freedom[v];
                if freedom <= 0.0 {
                    return None;
                }
                let facing = Facing {
                    direction: normals[v],
                    cosine: AGREE,
                };
                let (hit, normal) = target.closest(now[v], reach, facing)?;
                let way = hit.point - now[v];
                let aside =
                    hit.distance > ASIDE_FROM_MM && way.dot(normal).abs() < ASIDE * hit.distance;
                if aside || normal.dot(normals[v]) < AGREE {
                    return None;
                }
                // Far places count less: a smooth way to say that they may be wrong.
                let trust = 1.0 - (hit.distance / reach).powi(2);
                Some(Plane {
                    point: hit.point.into(),
                    normal: normal.into(),
                    weight: freedom * trust * trust,
                })
            })
            .collect()
    }

    fn solve(
        &self,
        start: &[Vec3A],
        moved: &mut [Vec3A],
        planes: &[Option<Plane>],
        stiffness: f32,
        iterations: usize,
    ) {
        let n = start.len();
        let mut data = vec![Mat3A::ZERO; n];
        let mut wanted = vec![Vec3A::ZERO; n];
        for (v, plane) in planes.iter().enumerate() {
            let mut block = Mat3A::from_diagonal(Vec3::splat(HOLD));
            if let Some(Plane {
                point,
                normal,
                weight,
            }) = *plane
            {
                let pull =
                    Mat3A::from_cols(normal * normal.x, normal * normal.y, normal * normal.z)
                        + Mat3A::from_diagonal(Vec3::splat(POINT_SHARE));
                block += pull * weight;
                wanted[v] = pull * (point - start[v]) * weight;
            }
            data[v] = block;
        }
        for (place, to, pull) in &self.landmarks {
            let ids = self.template.triangles[place.triangle as usize];
            let at: Vec3A = (0..3)
                .map(|k| start[ids[k] as usize] * place.shares[k])
                .sum();
            for k in 0..3 {
                wanted[ids[k] as usize] += (*to - at) * (pull * place.shares[k]);
            }
        }
        let inverse = self.preconditioner(&data, stiffness);
        let mut scratch = vec![Vec3A::ZERO; n];
        let mut image = vec![Vec3A::ZERO; n];
        self.apply(&data, stiffness, moved, &mut scratch, &mut image);
        let mut residual: Vec<Vec3A> = wanted.iter().zip(&image).map(|(w, i)| *w - *i).collect();
        let mut better: Vec<Vec3A> = inverse
            .iter()
            .zip(&residual)
            .map(|(m, r)| *m * *r)
            .collect();
        let mut direction = better.clone();
        let mut size = dot(&residual, &better);
        let enough = size * f64::from(TOLERANCE).powi(2);
        for _ in 0..iterations {
            if size <= enough || size <= f64::MIN_POSITIVE {
                break;
            }
            self.apply(&data, stiffness, &direction, &mut scratch, &mut image);
            let step = (size / dot(&direction, &image)) as f32;
            for v in 0..n {
                moved[v] += direction[v] * step;
                residual[v] -= image[v] * step;
                better[v] = inverse[v] * residual[v];
            }
            let next = dot(&residual, &better);
            let keep = (next / size) as f32;
            for v in 0..n {
                direction[v] = better[v] + direction[v] * keep;
            }
            size = next;
        }
    }

    /// `out` = (data + landmarks + stiffness L' S L) x.
    fn apply(
        &self,
        data: &[Mat3A],
        stiffness: f32,
        x: &[Vec3A],
        bent: &mut [Vec3A],
        out: &mut [Vec3A],
    ) {
        for (v, (bent, out)) in bent.iter_mut().zip(out.iter_mut()).enumerate() {
            *bent = (x[v] - self.mean(x, v)) * (self.stiff[v] * stiffness);
            *out = data[v] * x[v] + *bent;
        }
        for (v, bent) in bent.iter().enumerate() {
            for k in self.rings.span(v) {
                out[self.rings.entry(k)] -= *bent * self.shares[k];
            }
        }
        for (place, _, pull) in &self.landmarks {
            let ids = self.template.triangles[place.triangle as usize];
            let at: Vec3A = (0..3).map(|k| x[ids[k] as usize] * place.shares[k]).sum();
            for k in 0..3 {
                out[ids[k] as usize] += at * (pull * place.shares[k]);
            }
        }
    }

    fn preconditioner(&self, data: &[Mat3A], stiffness: f32) -> Vec<Mat3A> {
        let mut diagonal: Vec<f32> = self.stiff.iter().map(|s| s * stiffness).collect();
        for v in 0..data.len() {
            for k in self.rings.span(v) {
                diagonal[self.rings.entry(k)] += self.shares[k].powi(2) * self.stiff[v] * stiffness;
            }
        }
        for (place, _, pull) in &self.landmarks {
            let ids = self.template.triangles[place.triangle as usize];
            for k in 0..3 {
                diagonal[ids[k] as usize] += pull * place.shares[k].powi(2);
            }
        }
        data.iter()
            .zip(diagonal)
            .map(|(block, d)| (*block + Mat3A::from_diagonal(Vec3::splat(d))).inverse())
            .collect()
    }

    fn mean(&self, x: &[Vec3A], v: usize) -> Vec3A {
        self.rings
            .span(v)
            .map(|k| x[self.rings.entry(k)] * self.shares[k])
            .sum()
    }
}

/// Pairs of vertices near each other in space that face each other and are no neighbours, at least one of them with
/// no surface of its own to find.
fn ties(template: &Template, near: &Rings) -> Vec<[u32; 2]> {
    let cell = |p: Vec3| (p / TIE_MM).floor().as_ivec3();
    let normals = smooth_normals(template.positions, template.triangles);
    let mut grid: std::collections::HashMap<glam::IVec3, Vec<u32>> =
        std::collections::HashMap::new();
    for (v, p) in template.positions.iter().enumerate() {
        grid.entry(cell(*p)).or_default().push(v as u32);
    }
    let mut found = Vec::new();
    for (v, p) in template
        .positions
        .iter()
        .enumerate()
        .filter(|(v, _)| template.freedom[*v] < 1.0)
    {
        let mut best: Option<(f32, u32)> = None;
        let around = (-1..=1).flat_map(|x| {
            (-1..=1).flat_map(move |y| (-1..=1).map(move |z| glam::IVec3::new(x, y, z)))
        });
        for &other in around
            .filter_map(|step| grid.get(&(cell(*p) + step)))
            .flatten()
        {
            let o = other as usize;
            let apart = p.distance(template.positions[o]);
            let opposite = normals[v].dot(normals[o]) < -0.2;
            if o != v
                && opposite
                && apart < best.map_or(TIE_MM, |b| b.0)
                && !near.of(v).contains(&other)
            {
                best = Some((apart, other));
            }
        }
        if let Some((_, other)) = best {
            found.push([(v as u32).min(other), (v as u32).max(other)]);
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

fn dot(a: &[Vec3A], b: &[Vec3A]) -> f64 {
    // In blocks: single precision inside, double across, as meshes have thousands of vertices.
    a.chunks(64)
        .zip(b.chunks(64))
        .map(|(a, b)| f64::from(a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f32>()))
        .sum()
}
