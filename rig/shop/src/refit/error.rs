//! Why a scan became no head, in one sentence with its mend.

use mouthpiece_rig::SubdivisionError;
use thiserror::Error;

use crate::bones::BonesError;
use crate::closest::SurfaceError;
use crate::fit::FitError;
use crate::mesh::PrepareError;
use crate::warp::WarpError;

/// Why there is no new head.
#[derive(Debug, Error)]
pub enum RefitError {
    /// Scan or landmarks.
    #[error(transparent)]
    Prepare(#[from] PrepareError),
    /// The scan is no surface.
    #[error("the scan: {0}")]
    Scan(SurfaceError),
    /// The landmarks that were not given cannot be guessed.
    #[error("the landmarks: {0}")]
    Landmarks(#[from] WarpError),
    /// The skin does not come to lie on the scan.
    #[error("the skin cannot be fitted: {0}")]
    Fit(#[from] FitError),
    /// It came out, and is no head.
    #[error(
        "the fit went astray ({0}): check that the landmarks lie where their names say and that the scan shows one whole face"
    )]
    Astray(String),
    /// The bones.
    #[error("the bones cannot follow: {0}")]
    Bones(#[from] BonesError),
    /// The reference head.
    #[error(
        "the head to start from is not sound: {0}; take the built-in one or one that `head fit` wrote"
    )]
    Reference(#[from] SubdivisionError),
    /// The reference head has too little on it.
    #[error(
        "the head to start from has {0} landmarks on its skin, too few to fit by: take the built-in one or one that `head fit` wrote"
    )]
    Bare(usize),
}
