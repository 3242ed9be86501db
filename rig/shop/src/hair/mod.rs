//! Hair and lashes as meshes, grown on a head at rest: cards (ribbons that each show a few dozen painted
//! strands) in layers over a dark cap, in the manner of games. HEADSHOP 5.2 has hair follow the skin: what is
//! grown here on the reference head is warped vertex by vertex with the rest of it.
//!
//! The style is data in `style`: a short cut, parted on the subject's left and brushed across. What this does
//! not do: beards, long hair, hair that moves.
//!
//! # What a vertex says
//! `uv`: v runs from root (0) to tip (1) of the strands, so that `dP/dv` is their direction; u picks a column of
//! the painted strands: [`COLUMNS`] of equal width, the first [`DENSE`] dense, then [`LOOSE`] loose
//! locks of which only the first is thick, the rest single hairs. The last dense one
//! is [`EVEN`]. The cap
//! shows that, too; its v is -1 at the crown, -1.8 a cm before its edge, -2 at its edge. `occlusion`: how much light reaches so deep.

mod cap;
mod cards;
mod lashes;
mod scalp;
mod style;

use mouthpiece_rig::{Body, Head, Material, Mesh, Part};

pub use lashes::lashes;
use scalp::Scalp;

/// Columns of the strands' map. Keep in step with the renderer's `maps/hair.rs`.
pub const COLUMNS: usize = 8;
/// How many of them are dense.
pub const DENSE: usize = 4;
/// Which of those has strands that gather in no locks: for short hair.
pub const EVEN: usize = DENSE - 1;
/// How many are loose locks.
pub const LOOSE: usize = 2;

/// Grows short hair inside the head's hairline (its features `hairline_l` and `hairline_r`); none without one.
#[must_use]
pub fn grow(head: &Head) -> Option<Part> {
    let scalp = Scalp::of(head)?;
    let mut mesh = Mesh::default();
    // Outermost first: what is hidden behind it need not be shaded.
    cards::grow(&mut mesh, &scalp);
    cap::grow(&mut mesh, &scalp);
    Some(Part {
        name: "hair".into(),
        material: Material::Hair,
        weight: vec![0.0; mesh.positions.len()],
        mesh,
        bodies: vec![Body::Skull],
    })
}
