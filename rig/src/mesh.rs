//! What a head is drawn of: meshes, the bodies that they hang on, the skin with its lips and lids.

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// A frame of reference that parts hang on; poses come from [`Head::bodies`](crate::Head::bodies).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(usize)]
pub enum Body {
    /// Shoulders and the base of the neck: does not move.
    Trunk,
    /// Skull with the upper teeth: turns with the head.
    Skull,
    /// Lower jaw with the lower teeth: turns about the condyles, moves with the skull.
    Mandible,
    /// The subject's left eyeball.
    EyeL,
    /// The subject's right eyeball.
    EyeR,
    /// Root of the tongue: moves with the mandible, and a little of its own.
    TongueRoot,
    /// Blade of the tongue.
    TongueBlade,
    /// Tip of the tongue.
    TongueTip,
}

impl Body {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 8] = [
        Self::Trunk,
        Self::Skull,
        Self::Mandible,
        Self::EyeL,
        Self::EyeR,
        Self::TongueRoot,
        Self::TongueBlade,
        Self::TongueTip,
    ];
    /// How many there are.
    pub const COUNT: usize = Self::ALL.len();
}

/// What a part is made of: the renderer picks a shader by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum Material {
    Skin,
    /// Sclera, iris and pupil in one ball; `uv` is the direction from its centre as (yaw, pitch) in
    /// units of the iris radius, so that the iris is the unit disc round (0, 0).
    Eye,
    Teeth,
    Gums,
    Tongue,
    /// Inside of the mouth behind lips and teeth.
    Cavity,
    Hair,
    /// Lashes and brows.
    Lash,
    Cloth,
    /// Skull and mandible: drawn only where asked for; `uv` is how much it is a tooth, and how much it is
    /// to stand back behind what is drawn over it, 0..1 both.
    Bone,
    /// A muscle's surface, drawn only where asked for; `uv` is the place along the fibres, 0 to 1 over the
    /// flesh and beyond it in tendon, and the place across them, mm.
    Muscle,
    /// Springs as thin bars, drawn only where asked for; `uv` is which kind
    /// ([`SpringKind`](crate::SpringKind)) and how far stretched (below 0: pressed).
    Spring,
}

/// A triangle mesh; all per-vertex arrays have the same length.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Rest positions in the head frame, mm.
    pub positions: Vec<Vec3>,
    /// Unit normals at rest.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, 0..1 from the upper left (eyes: see [`Material::Eye`]).
    pub uvs: Vec<Vec2>,
    /// Share of ambient light that reaches the vertex at rest, 0..1.
    pub occlusion: Vec<f32>,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A mesh on a body, or along a chain of them.
#[derive(Clone, Debug)]
pub struct Part {
    /// Node name, as in a head file: `teeth_upper`, `eye_l`, `tongue` …
    pub name: String,
    /// What it is made of.
    pub material: Material,
    /// Its shape.
    pub mesh: Mesh,
    /// The bodies it hangs on, in order: one at least.
    pub bodies: Vec<Body>,
    /// Place of each vertex along that chain: 0 the first body, 1 the second, 0.25 a quarter of the
    /// second and the rest of the first, and so on.
    pub weight: Vec<f32>,
}

impl Part {
    /// The two bodies that a place along the chain lies between, and the share of the second.
    #[must_use]
    pub fn between(&self, weight: f32) -> ([Body; 2], f32) {
        let last = self.bodies.len().saturating_sub(1);
        let weight = weight.clamp(0.0, last as f32);
        let first = (weight as usize).min(last.saturating_sub(1));
        let body = |i: usize| self.bodies.get(i.min(last)).copied().unwrap_or(Body::Skull);
        ([body(first), body(first + 1)], weight - first as f32)
    }
}

/// The skin: the mesh that the simulation moves, control mesh of the drawn surface.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Shape at rest, welded. Of the reference head `uv` is the cylindrical chart: `u = 0.5 +
    /// longitude / 2 pi` (0.5 straight ahead, growing to the subject's left), `v = (150 - y) / 256`
    /// with y in mm; heads fitted from it keep its uv.
    pub mesh: Mesh,
    /// Texture coordinates of each triangle's corners: those of the vertices, but for the ears,
    /// which are islands of their own, and past 1 where a triangle crosses the chart's seam.
    pub wedges: Vec<[Vec2; 3]>,
    /// Edges that stay sharp when the surface is subdivided: contact lines of the lips, margins of
    /// the lids.
    pub creases: Vec<[u32; 2]>,
    /// Where each vertex lies on the reference head, mm: anatomical constants are functions of it.
    pub reference: Vec<Vec3>,
    /// Share of the skull against the trunk, per vertex: 1 on the head, falling to 0 down the neck.
    pub weight: Vec<f32>,
    /// 1 on the red of the lips, 0 off it, per vertex.
    pub vermilion: Vec<f32>,
    /// 1 on the wet inner side of lips and lids, 0 on dry skin, per vertex.
    pub wet: Vec<f32>,
}

/// Levels of a lip's column, from the vermilion border over the red to the contact line and the inner
/// side: see [`Lips`] and [`lip_level`].
pub const LIP_LEVELS: usize = 11;

/// Levels of a lip's column that have a name.
pub mod lip_level {
    /// The vermilion border.
    pub const BORDER: usize = 0;
    /// The most forward part of the red.
    pub const CREST: usize = 1;
    /// Where the lips touch at rest.
    pub const CONTACT: usize = 7;
    /// The first level of the inner side, which ends at the column's last.
    pub const INNER: usize = 8;
}

/// The skin vertices of both lips as columns from the subject's right corner to the left one; column
/// `i` of the upper lip stands over column `i` of the lower, levels as in [`lip_level`]. At the
/// corners both share vertices.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lips {
    /// Columns of the upper lip.
    pub upper: Vec<[u32; LIP_LEVELS]>,
    /// Columns of the lower lip.
    pub lower: Vec<[u32; LIP_LEVELS]>,
}

/// A skin vertex that an eyelid carries.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lid {
    /// Which.
    pub vertex: u32,
    /// Whether it is of the subject's left eye.
    pub left: bool,
    /// Rotation about the eye's transverse axis that closes it, radians.
    pub turn: f32,
    /// How firmly the lid holds it, 0..1.
    pub hold: f32,
}

/// Unit normals of a mesh, weighted by triangle area.
#[must_use]
pub fn normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for t in triangles {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let area = (b - a).cross(c - a);
        for &i in t {
            sums[i as usize] += area;
        }
    }
    sums.into_iter().map(|n| n.normalize_or(Vec3::Z)).collect()
}

/// Smooth step from 0 at `from` to 1 at `to`, either way round.
pub(crate) fn ramp(from: f32, to: f32, value: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}
