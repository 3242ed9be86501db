//! Rays against triangles: what stands over a place, and how much of the light from around reaches it.

use std::num::NonZero;
use std::sync::Mutex;

use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;

/// Directions that a place's light is sampled in: enough that vertices a millimetre apart show no grain.
const DIRECTIONS: usize = 48;
/// What is farther than this darkens nothing, mm: the depth of an orbit.
const REACH_MM: f32 = 28.0;
/// Places that a thread takes at a time.
const BAND: usize = 256;
/// Rays start so far off their surface, mm.
const OFF_MM: f32 = 0.35;

/// Triangles that stop rays.
pub(crate) struct Rays {
    triangles: Vec<Triangle>,
    bvh: Bvh2,
}

impl std::fmt::Debug for Rays {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Rays against {} triangles", self.triangles.len())
    }
}

impl Rays {
    /// Stopped by these meshes, each places and triangles.
    pub(crate) fn new<'a>(meshes: impl IntoIterator<Item = (&'a [Vec3], &'a [[u32; 3]])>) -> Self {
        let mut triangles = Vec::new();
        for (places, indices) in meshes {
            triangles.extend(indices.iter().map(|t| {
                let [v0, v1, v2] = t.map(|i| Vec3A::from(places[i as usize]));
                Triangle { v0, v1, v2 }
            }));
        }
        let mut spent = std::time::Duration::default();
        let bvh = build_bvh2_from_tris(&triangles, BvhBuildParams::fast_build(), &mut spent);
        Self { triangles, bvh }
    }

    /// How far a ray gets, at most `far`, mm; `direction` is of unit length.
    pub(crate) fn free(&self, from: Vec3, direction: Vec3, far: f32) -> f32 {
        if self.triangles.is_empty() {
            return far;
        }
        let ray = Ray::new(from.into(), direction.into(), 0.0, far);
        let mut hit = RayHit::none();
        self.bvh.ray_traverse(ray, &mut hit, |ray, id| {
            self.triangles[self.bvh.primitive_indices[id] as usize].intersect(ray)
        });
        hit.t.min(far)
    }

    /// [`Self::light`] of many places, on as many threads as there are processors.
    pub(crate) fn light_all(&self, places: &[Vec3], normals: &[Vec3], out: &mut [f32]) {
        let inputs = places.chunks(BAND).zip(normals.chunks(BAND));
        let bands = Mutex::new(out.chunks_mut(BAND).zip(inputs));
        let work = || {
            loop {
                let next = bands.lock().ok().and_then(|mut bands| bands.next());
                let Some((out, (places, normals))) = next else {
                    return;
                };
                for (light, (p, n)) in out.iter_mut().zip(places.iter().zip(normals)) {
                    *light = self.light(*p, *n);
                }
            }
        };
        let processors = std::thread::available_parallelism().map_or(1, NonZero::get);
        std::thread::scope(|scope| {
            for _ in 1..processors {
                // Where no thread is to be had the work is done here.
                let _ = std::thread::Builder::new()
                    .name("light folds".into())
                    .spawn_scoped(scope, work);
            }
            work();
        });
    }

    /// Share of the light from around that reaches a place of a surface with that unit normal; what
    /// stands near takes more than what stands far.
    pub(crate) fn light(&self, place: Vec3, normal: Vec3) -> f32 {
        let (a, b) = normal.any_orthonormal_pair();
        let from = place + normal * OFF_MM;
        let mut sum = 0.0;
        for i in 0..DIRECTIONS {
            // Evenly over the disc under the hemisphere (a sunflower), so weighted by the cosine.
            let r2 = (i as f32 + 0.5) / DIRECTIONS as f32;
            let (s, c) = (i as f32 * 2.399_963).sin_cos();
            let direction = (a * c + b * s) * r2.sqrt() + normal * (1.0 - r2).sqrt();
            sum += self.free(from, direction, REACH_MM) / REACH_MM;
        }
        sum / DIRECTIONS as f32
    }
}
