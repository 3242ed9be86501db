//! The skin as it is drawn: the limit of Loop's subdivision of the control mesh that the simulation
//! moves, so that neither silhouette nor lips show triangles (HEADSHOP 4 draws its mesh as it is; this
//! is our addition).
//!
//! | module | holds |
//! |---|---|
//! | `level` | one level's edges and fans, and the weights of the next level's points and of the limit |
//! | `chains` | creases put in order, corner to corner |
//! | `stencils` | drawn points as weighted sums of control points, in flat arrays |
//! | `drawn` | which edges are split, and triangles that meet the texture's islands |
//! | `fit` | control points whose limit are given points |
//! | `lips` | the lips' columns as drawn, for measuring |
//!
//! Every drawn point lies on the limit surface, whatever the level, so all tiers draw one surface and
//! what is measured does not depend on the tier. Rules: Loop's weights inside; a uniform cubic
//! B-spline along creases and borders, which so depends on the crease's own points alone (two creases
//! with the same points coincide to the bit); a corner stays where it is. Corners are the given ones,
//! where three or more sharp edges meet, and where a crease ends. Next to a crease that has more or
//! fewer than three triangles on a side, the edge weights of Biermann, Levin and Zorin (2000, "Piecewise
//! smooth subdivision surfaces with normal control") keep the surface smooth.
//!
//! It does not follow the mesh as it moves: splits are decided once, at rest.

mod chains;
mod drawn;
mod fit;
mod level;
mod lips;
mod stencils;

use glam::{Vec2, Vec3};
use thiserror::Error;

pub use fit::fit_control;
pub use lips::LipStencils;
pub use stencils::Stencils;

use level::Level;

/// A control mesh without its positions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Topology<'a> {
    /// How many vertices there are.
    pub vertex_count: usize,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// Edges that stay sharp; the mesh's border always does.
    pub creases: &'a [[u32; 2]],
    /// Vertices that the surface goes through: the corners of the mouth.
    pub corners: &'a [u32],
    /// Texture coordinates of each triangle's corners; empty for none.
    pub wedges: &'a [[Vec2; 3]],
}

/// How finely to draw.
#[derive(Clone, Copy, Debug, Default)]
pub struct Detail<'a> {
    /// How often an edge may be halved.
    pub levels: usize,
    /// Edges are halved where the surface bows from them by more than this at rest, mm; 0: all.
    pub bow_mm: f32,
    /// Positions at rest; not needed to halve all edges.
    pub rest: &'a [Vec3],
    /// Control vertices that are never seen: triangles of three of them are left out. May be empty.
    pub hidden: &'a [bool],
}

/// What is wrong with a control mesh.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum SubdivisionError {
    /// A triangle, crease or corner names a vertex that is not there.
    #[error("the mesh refers to vertex {vertex} but has {count}: write it again from its source")]
    Vertex {
        /// The name.
        vertex: u32,
        /// How many vertices there are.
        count: usize,
    },
    /// Per-triangle or per-vertex data of the wrong length.
    #[error("the mesh has {got} {what} where {wanted} belong: write it again from its source")]
    Count {
        /// Of what.
        what: &'static str,
        /// How many there are.
        got: usize,
        /// How many there should be.
        wanted: usize,
    },
}

impl Topology<'_> {
    fn check(&self) -> Result<(), SubdivisionError> {
        let count = self.vertex_count;
        let all = self.triangles.iter().flatten();
        let all = all.chain(self.creases.iter().flatten()).chain(self.corners);
        if let Some(&vertex) = all.into_iter().find(|v| **v as usize >= count) {
            return Err(SubdivisionError::Vertex { vertex, count });
        }
        same("wedges", self.wedges.len(), self.triangles.len())
    }
}

/// Optional data are either not there or complete.
fn same(what: &'static str, got: usize, wanted: usize) -> Result<(), SubdivisionError> {
    if got == 0 || got == wanted {
        Ok(())
    } else {
        Err(SubdivisionError::Count { what, got, wanted })
    }
}

/// A mesh to draw, whose points follow the control mesh.
///
/// Points come first, the control mesh's own in their order; then copies of points where the texture's
/// islands meet. A drawn vertex is a point or a copy.
#[derive(Clone, Debug, Default)]
pub struct Subdivision {
    stencils: Stencils,
    /// Triangles of points.
    welded: Vec<[u32; 3]>,
    triangles: Vec<[u32; 3]>,
    copies: Vec<u32>,
    /// The points that each further point than the control mesh's lies between.
    parents: Vec<[u32; 2]>,
    uvs: Vec<Vec2>,
}

impl Subdivision {
    /// Works out the stencils: once per head and tier.
    ///
    /// # Errors
    /// When the mesh's numbers do not fit together.
    pub fn new(mesh: &Topology<'_>, detail: &Detail<'_>) -> Result<Self, SubdivisionError> {
        mesh.check()?;
        same("positions at rest", detail.rest.len(), mesh.vertex_count)?;
        same("hidden flags", detail.hidden.len(), mesh.vertex_count)?;
        Ok(drawn::build(mesh, detail))
    }

    /// Points without copies.
    #[must_use]
    pub fn point_count(&self) -> usize {
        self.stencils.len()
    }

    /// Points and copies.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.stencils.len() + self.copies.len()
    }

    /// Which point each copy repeats.
    #[must_use]
    pub fn copies(&self) -> &[u32] {
        &self.copies
    }

    /// Triangles of drawn vertices.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Texture coordinates of the drawn vertices; a point that no triangle uses has (0, 0).
    #[must_use]
    pub fn uvs(&self) -> &[Vec2] {
        &self.uvs
    }

    /// The points' weights.
    #[must_use]
    pub fn stencils(&self) -> &Stencils {
        &self.stencils
    }

    /// Points for the control mesh's positions. `out` has [`Self::point_count`] places. Allocates
    /// nothing.
    pub fn apply(&self, control: &[Vec3], out: &mut [Vec3]) {
        self.stencils.apply(control, out);
    }

    /// What each point has of a value of the control vertices: in between, and no more blurred than on
    /// the control mesh (the dark of a nostril stays inside it).
    #[must_use]
    pub fn spread(&self, values: &[f32]) -> Vec<f32> {
        let mut all = values.to_vec();
        for [a, b] in &self.parents {
            all.push(0.5 * (all[*a as usize] + all[*b as usize]));
        }
        all
    }

    /// Normals of the points, not yet of unit length, weighted by triangle area; the same on both sides
    /// of a texture's seam. Allocates nothing.
    pub fn normals(&self, points: &[Vec3], out: &mut [Vec3]) {
        out.fill(Vec3::ZERO);
        for t in &self.welded {
            let [a, b, c] = t.map(|i| points[i as usize]);
            let area = (b - a).cross(c - a);
            for &i in t {
                out[i as usize] += area;
            }
        }
    }
}

/// Where the control mesh's vertices go in the limit.
///
/// # Errors
/// When the mesh's numbers do not fit together.
pub fn limit_stencils(mesh: &Topology<'_>) -> Result<Stencils, SubdivisionError> {
    mesh.check()?;
    Ok(limit_of(mesh, 0..mesh.vertex_count as u32))
}

/// The limit of some control vertices of a mesh that has been checked.
fn limit_of(mesh: &Topology<'_>, vertices: impl Iterator<Item = u32>) -> Stencils {
    let level = Level::control(mesh);
    let mut terms = Vec::new();
    let mut limit = Stencils::default();
    for vertex in vertices {
        terms.clear();
        level.limit_terms(vertex, &mut terms);
        limit.push(terms.iter().map(|&(v, w)| (v, w as f32)));
    }
    limit
}
