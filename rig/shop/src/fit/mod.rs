//! Fitting the reference head's skin to a scan (HEADSHOP 6): landmarks, warp, feature-mesh refinement, local fit.
//!
//! Template and scan are plain slices here; who reads files, turns and scales the scan into the head's frame (`align`)
//! and lets skull, muscles and hair follow (`Fit::carrier`) stands elsewhere. Every step is conservative: where the scan
//! has a hole, a border, an inside or nothing at all, the warp's smooth continuation stays.
//!
//! - `align`: the similarity between landmark sets, and whether sides were swapped
//! - `estimate`: landmarks that were not given (6.1)
//! - `feature`, `refine`: more landmarks by the feature mesh (6.2, Table 1)
//! - `local`: the last fit of each vertex, within what smoothness allows
//! - `turned`, `upright`: faces turned over, and what is done about them
//! - `visible`: what of a head a scanner can see
//! - `report`: how good it became
//! - `graph`: neighbours on a mesh

pub mod align;
pub mod estimate;
mod feature;
pub mod graph;
mod local;
mod refine;
pub mod report;
pub mod turned;
mod upright;
mod visible;

use std::time::Instant;

use glam::Vec3;

use crate::closest::{Facing, Hit, Surface, SurfaceError, smooth_normals};
use crate::warp::{Warp, WarpError};
use feature::Place;
use local::Local;
use turned::face_normals;
use upright::Steady;
pub use visible::visible;

/// The mesh to be fitted, at rest in its own frame, mm.
#[derive(Debug, Clone, Copy)]
pub struct Template<'a> {
    /// Vertices.
    pub positions: &'a [Vec3],
    /// Triangles, outward by the right hand.
    pub triangles: &'a [[u32; 3]],
    /// Per vertex, 0 to 1: how far it has a surface to find on a scan. 0 for the insides of mouth, lids and nostrils.
    pub freedom: &'a [f32],
}

/// How to fit. The defaults suit heads in millimetres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Rounds of feature-mesh refinement at most; it stops earlier when nothing moves.
    pub rounds: usize,
    /// How far a landmark (mm on the ridge, see `Warp::smoothed`) may give way, and one found by refinement.
    pub give_mm: (f32, f32),
    /// Rounds of the local fit.
    pub local_rounds: usize,
    /// How far a vertex looks, mm, in the first local round and in the last.
    pub reach_mm: (f32, f32),
    /// Weight of smoothness beside the data's 1, in the first local round and in the last.
    pub stiffness: (f32, f32),
    /// Steps of conjugate gradients in a round.
    pub iterations: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            rounds: 4,
            give_mm: (0.5, 4.0),
            local_rounds: 4,
            reach_mm: (6.0, 2.5),
            stiffness: (20.0, 2.0),
            iterations: 30,
        }
    }
}

/// Why a fit cannot be.
#[derive(Debug, thiserror::Error)]
pub enum FitError {
    /// The template's slices do not belong together.
    #[error("the template has {positions} vertices but {freedom} entries of freedom")]
    Freedom {
        /// Vertices.
        positions: usize,
        /// Entries.
        freedom: usize,
    },
    /// The template is no surface.
    #[error("the template: {0}")]
    Template(#[from] SurfaceError),
    /// The landmarks define no warp.
    #[error("the landmarks: {0}")]
    Landmarks(#[from] WarpError),
    /// The landmarks are a mirror image.
    #[error(
        "the landmarks fit better as a mirror image: swap the points of the left and the right side"
    )]
    Mirrored,
}

/// Seconds of wall clock spent in each stage.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Seconds {
    /// The first warp, by landmarks alone.
    pub warp: f64,
    /// Feature-mesh refinement with its warps.
    pub refine: f64,
    /// The local fit and the relaxing of turned faces.
    pub local: f64,
    /// All of it.
    pub total: f64,
}

/// A fitted template.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The vertices, in the scan's frame.
    pub positions: Vec<Vec3>,
    /// Where the landmarks' sources came to lie.
    pub landmarks: Vec<Vec3>,
    /// The vertices as the landmarks alone warp them: what `positions` is judged against.
    pub by_landmarks: Vec<Vec3>,
    /// The last warp, before the local fit. What follows the skin should use `carrier`.
    pub warp: Warp,
    /// How many correspondences the refinement found beside the landmarks.
    pub found: usize,
    /// How many faces had to be relaxed because they were turning over.
    pub relaxed: usize,
    /// Whether the scan's triangles face inwards.
    pub inside_out: bool,
    /// Time spent.
    pub seconds: Seconds,
}

impl Fit {
    /// The warp that carries all else of a head to its new skin (HEADSHOP 5.2): through skin vertices everywhere, as
    /// finally fitted, so that it follows the local fit too, and the back of the head where no scan was.
    pub fn carrier(&self, template: &Template) -> Result<Warp, WarpError> {
        /// One vertex in each cube of this edge, mm, where a face has its features, and elsewhere: several hundred
        /// on a head.
        const CELL_MM: f32 = 11.0;
        const BEHIND_MM: f32 = 22.0;
        /// The face begins here, mm before the head's middle.
        const FACE_MM: f32 = 40.0;
        /// Neighbouring vertices with their noise may be missed by a little.
        const GIVE_MM: f32 = 2.0;
        let mut taken = std::collections::HashSet::new();
        let (from, to): (Vec<Vec3>, Vec<Vec3>) = template
            .positions
            .iter()
            .zip(&self.positions)
            .zip(template.freedom)
            .filter(|((p, _), freedom)| {
                let face = p.z > FACE_MM;
                let cell = **p / if face { CELL_MM } else { BEHIND_MM };
                **freedom >= 1.0 && taken.insert((face, cell.floor().as_ivec3()))
            })
            .map(|(pair, _)| pair)
            .unzip();
        Warp::smoothed(&from, &to, &vec![GIVE_MM; from.len()])
    }
}

/// The scan, seen so that its normals point outwards.
pub(crate) struct Target<'a> {
    surface: &'a Surface,
    sense: f32,
}

impl Target<'_> {
    /// Nearest place with the normal there; none on a border.
    pub(crate) fn closest(&self, point: Vec3, max: f32, facing: Facing) -> Option<(Hit, Vec3)> {
        let hit = self.surface.closest_facing(point, max, self.turn(facing))?;
        self.inner(hit)
    }

    /// First place along a ray, with the normal there; none on a border.
    pub(crate) fn ray(
        &self,
        origin: Vec3,
        way: Vec3,
        max: f32,
        facing: Facing,
    ) -> Option<(Hit, Vec3)> {
        let hit = self.surface.ray(origin, way, max, self.turn(facing))?;
        self.inner(hit)
    }

    fn inner(&self, hit: Hit) -> Option<(Hit, Vec3)> {
        (!self.surface.on_border(&hit)).then(|| (hit, self.surface.normal(&hit) * self.sense))
    }

    fn turn(&self, facing: Facing) -> Facing {
        Facing {
            direction: facing.direction * self.sense,
            ..facing
        }
    }
}

/// Fits the template to a scan; `landmarks` are pairs of a point on the template and its place on (or above a gap of)
/// the scan. Both in mm; the frames may differ.
pub fn fit(
    template: &Template,
    scan: &Surface,
    landmarks: &[(Vec3, Vec3)],
    options: &Options,
) -> Result<Fit, FitError> {
    let begun = Instant::now();
    let mut seconds = Seconds::default();
    if template.positions.len() != template.freedom.len() {
        return Err(FitError::Freedom {
            positions: template.positions.len(),
            freedom: template.freedom.len(),
        });
    }
    let (from, to): (Vec<Vec3>, Vec<Vec3>) = landmarks.iter().copied().unzip();
    if let Some(bad) = landmarks
        .iter()
        .position(|(a, b)| !(a.is_finite() && b.is_finite()))
    {
        return Err(WarpError::NotFinite(bad).into());
    }
    match align::Similarity::between(&from, &to) {
        Some(similarity) if similarity.mirrored => return Err(FitError::Mirrored),
        None if from.len() >= 4 => return Err(WarpError::OneSpot.into()),
        _ => {}
    }
    let rest = Surface::new(template.positions, template.triangles)?;
    let places: Vec<Place> = from.iter().filter_map(|p| place(&rest, *p)).collect();
    let Steady {
        warp: first,
        positions: by_landmarks,
        give,
    } = upright::by_landmarks(template, (&from, &to), options.give_mm.0)?;
    let inside_out = is_inside_out(template, &by_landmarks, scan);
    let target = Target {
        surface: scan,
        sense: if inside_out { -1.0 } else { 1.0 },
    };
    let to = settled(template, &target, &places, &to, &by_landmarks);
    seconds.warp = begun.elapsed().as_secs_f64();

    let should = face_normals(&by_landmarks, template.triangles);
    let refined = refine::refine(
        template,
        &target,
        &rest,
        &places,
        (&from, &to, &give),
        first,
        &should,
        options,
    )?;
    seconds.refine = begun.elapsed().as_secs_f64() - seconds.warp;

    let mut local = Local::new(
        template,
        (0..places.len())
            .map(|i| (places[i], to[i], options.give_mm.0 / give[i]))
            .collect(),
    );
    let mut moved = local.run(&refined.positions, &target, options);
    let relaxed = upright::relax(
        template,
        &mut local,
        &refined.positions,
        &mut moved,
        &target,
        &should,
        options,
    );
    let positions = upright::displaced(&refined.positions, &moved);
    seconds.total = begun.elapsed().as_secs_f64();
    seconds.local = seconds.total - seconds.refine - seconds.warp;
    Ok(Fit {
        landmarks: places
            .iter()
            .map(|p| p.on(&positions, template.triangles))
            .collect(),
        positions,
        by_landmarks,
        warp: refined.warp,
        found: refined.found,
        relaxed,
        inside_out,
        seconds,
    })
}

/// The landmarks' targets, on the scan where it is near: a hand that missed it by a little must not dent the skin.
fn settled(
    template: &Template,
    target: &Target,
    places: &[Place],
    to: &[Vec3],
    warped: &[Vec3],
) -> Vec<Vec3> {
    /// Farther away, the landmark was put into the air on purpose, mm.
    const NEAR_MM: f32 = 3.0;
    let normals = smooth_normals(warped, template.triangles);
    let found = |(place, to): (&Place, &Vec3)| {
        let direction = place.on(&normals, template.triangles).normalize_or_zero();
        let facing = Facing {
            direction,
            cosine: 0.5,
        };
        target
            .closest(*to, NEAR_MM, facing)
            .map_or(*to, |(hit, _)| hit.point)
    };
    places.iter().zip(to).map(found).collect()
}

/// The place on a surface nearest to a point.
fn place(surface: &Surface, point: Vec3) -> Option<Place> {
    let hit = surface.closest(point, f32::INFINITY)?;
    Some(Place {
        triangle: hit.triangle,
        shares: hit.barycentric,
    })
}

/// Whether most of the scan near the warped template faces the other way.
fn is_inside_out(template: &Template, warped: &[Vec3], scan: &Surface) -> bool {
    /// Vertices asked: enough for a vote.
    const ASKED: usize = 400;
    /// Only the near ones know, mm.
    const NEAR_MM: f32 = 10.0;
    let normals = smooth_normals(warped, template.triangles);
    let free: Vec<usize> = (0..warped.len())
        .filter(|&v| template.freedom[v] >= 1.0)
        .collect();
    let step = (free.len() / ASKED).max(1);
    let votes: f32 = free
        .iter()
        .step_by(step)
        .filter_map(|&v| {
            scan.closest(warped[v], NEAR_MM)
                .map(|hit| scan.normal(&hit).dot(normals[v]).signum())
        })
        .sum();
    votes < 0.0
}
