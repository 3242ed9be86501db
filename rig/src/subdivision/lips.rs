//! A head's skin handed to the subdivision, and its lips' columns as they are drawn, for
//! [`measure`](crate::measure): what is measured is what is seen.

use std::sync::{Arc, OnceLock};

use glam::Vec3;

use super::{Detail, Stencils, Subdivision, SubdivisionError, Topology, limit_of, limit_stencils};
use crate::Head;
use crate::mesh::LIP_LEVELS;

/// Weights for the lips' columns, worked out when first asked for.
#[derive(Clone, Debug, Default)]
pub struct LipStencils(OnceLock<Arc<DrawnLips>>);

/// The lips' columns in points of their own.
#[derive(Debug, Default)]
pub(crate) struct DrawnLips {
    stencils: Stencils,
    /// Columns as in [`Lips`](crate::Lips), by numbers of these points.
    pub(crate) upper: Vec<[u32; LIP_LEVELS]>,
    /// See `upper`.
    pub(crate) lower: Vec<[u32; LIP_LEVELS]>,
}

impl LipStencils {
    /// Those of `head`, which is always the same one; empty where its numbers do not fit together.
    pub(crate) fn of(&self, head: &Head) -> &DrawnLips {
        self.0.get_or_init(|| Arc::new(DrawnLips::new(head)))
    }
}

impl DrawnLips {
    fn new(head: &Head) -> Self {
        let corners = head.mouth_corners();
        let mesh = head.topology(&corners);
        let mut vertices: Vec<u32> = Vec::new();
        let mut columns = |of: &[[u32; LIP_LEVELS]]| -> Vec<[u32; LIP_LEVELS]> {
            of.iter()
                .map(|column| {
                    column.map(|v| {
                        vertices.push(v);
                        vertices.len() as u32 - 1
                    })
                })
                .collect()
        };
        let (upper, lower) = (columns(&head.lips.upper), columns(&head.lips.lower));
        let missing = |v: &u32| *v as usize >= mesh.vertex_count;
        if mesh.check().is_err() || vertices.iter().any(missing) {
            return Self::default();
        }
        Self {
            stencils: limit_of(&mesh, vertices.into_iter()),
            upper,
            lower,
        }
    }

    /// The points for the skin's positions.
    pub(crate) fn at(&self, skin: &[Vec3]) -> Vec<Vec3> {
        let mut points = vec![Vec3::ZERO; self.stencils.len()];
        self.stencils.apply(skin, &mut points);
        points
    }
}

impl Head {
    /// The skin's surface as it is drawn.
    ///
    /// # Errors
    /// When the skin's numbers do not fit together.
    pub fn subdivision(&self, detail: &Detail<'_>) -> Result<Subdivision, SubdivisionError> {
        Subdivision::new(&self.topology(&self.mouth_corners()), detail)
    }

    /// Where the skin's vertices are drawn: see [`fit_control`](crate::fit_control).
    ///
    /// # Errors
    /// When the skin's numbers do not fit together.
    pub fn skin_limit(&self) -> Result<Stencils, SubdivisionError> {
        limit_stencils(&self.topology(&self.mouth_corners()))
    }

    /// The skin's vertices where they are drawn at rest; where its numbers do not fit together, as they
    /// are.
    #[must_use]
    pub fn drawn_rest(&self) -> Vec<Vec3> {
        let control = &self.skin.mesh.positions;
        let mut drawn = control.clone();
        if let Ok(limit) = self.skin_limit() {
            limit.apply(control, &mut drawn);
        }
        drawn
    }

    /// The skin as a control mesh.
    fn topology<'a>(&'a self, corners: &'a [u32]) -> Topology<'a> {
        Topology {
            vertex_count: self.skin.mesh.positions.len(),
            triangles: &self.skin.mesh.triangles,
            creases: &self.skin.creases,
            corners,
            wedges: &self.skin.wedges,
        }
    }

    /// Where both contact lines end: the crease vertices of the first and the last column, which both
    /// lips share.
    fn mouth_corners(&self) -> Vec<u32> {
        let columns = &self.lips.upper;
        let mut corners: Vec<u32> = [columns.first(), columns.last()]
            .into_iter()
            .flatten()
            .flatten()
            .copied()
            .filter(|v| self.skin.creases.iter().flatten().any(|c| c == v))
            .collect();
        corners.dedup();
        corners
    }
}
