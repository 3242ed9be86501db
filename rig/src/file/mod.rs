//! A head as a file: glTF 2.0 binary (.glb), so that any viewer opens it.
//!
//! Written and read with a small glTF of our own ([`document`]): of glTF's crates the one that
//! reads slices buffers by indices it does not check, which bytes of a stranger would make panic,
//! and none of them names the element that is wrong; what a head needs of the format is little.
//!
//! # Nodes
//! The root node is `head`; below it one node with a mesh for `skin` and for each part (`skull`,
//! `mandible`, `eye_l`, `eye_r`, `teeth_upper`, `teeth_lower`, `gums_upper`, `gums_lower`, `tongue`,
//! `cavity`, `hair`, `lashes_l`, `lashes_r`, `cloth`). Axes are glTF's: +Y up, +Z out of the face,
//! +X to the subject's left. `POSITION` is in metres, in the frame of the node that holds the extras;
//! where that node stands in a scene does not matter.
//!
//! # Attributes
//! | attribute | type | of | is |
//! |---|---|---|---|
//! | `_SIM` | float | all | the vertex's number before it was split for the sake of its texture coordinates: vertices are put together by it, so their order and further splitting do no harm |
//! | `TEXCOORD_0` | VEC2 | all | of the skin: texture coordinates of the triangles' corners |
//! | `_OCCLUSION` | float | all | share of ambient light that arrives |
//! | `_WEIGHT` | float | all | of the skin: share of the skull against the trunk; of a part: place along its `bodies` |
//! | `_CHART` | VEC2 | skin | the vertex's one place in the chart |
//! | `_REFERENCE` | VEC3 | skin | where it lies on the reference head, mm |
//! | `_VERMILION`, `_WET` | float | skin | red of the lips, wet inner side |
//!
//! The colour map is the base colour texture of the skin's material, a PNG. The order of triangles
//! carries no meaning.
//!
//! # Extras
//! The `head` node's `extras.mouthpiece` is JSON, lengths in mm, vertices by their `_SIM`:
//! `schema` (the version, 1), `skin` (`vertices`, `creases`), `parts` (each with `name`, `material`,
//! `bodies`, `vertices`), `features`, `landmarks`, `lips`, `lids`, `muscles`, `eyes` (left, right),
//! `bite`, `condyle_axis`, `neck_pivot`, `tissue`, `calibration`. Their fields are those of the types of the
//! same names: `Landmark`, `Lips`, `Lid`, `MuscleGrid`, `Eye`, `Placement`, `TissueRecord`,
//! `Calibration`. Muscle
//! fibres are not stored: they are rebuilt from `muscles` and the space over the bones. A change
//! that older programs would misread raises `schema`.
//!
//! Blender, trimesh and pygltflib keep all of this, as long as the export includes custom
//! attributes and custom properties.

mod accessor;
mod check;
mod document;
mod nodes;
mod parts;
mod picture;
mod read;
mod schema;
mod weld;
mod write;

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::{CalibrationError, Head};

/// Largest file that is read: ten times a head with a large colour map.
const BYTES_MAX: usize = 256 << 20;

/// Why a file is no head.
#[derive(Debug, Error)]
pub enum HeadError {
    /// The file itself.
    #[error("{}: {source}", path.display())]
    File {
        /// Its name.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<HeadError>,
    },
    /// It cannot be opened, read or written.
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// Not this container.
    #[error(
        "this is no binary glTF (.glb); a head comes from `mouthpiece head fit`, or from another program saved as glTF binary"
    )]
    NotGlb,
    /// Another version of the container.
    #[error("this is glTF {0}, but a head is glTF 2; save it as glTF 2.0 binary")]
    GltfVersion(u32),
    /// Larger than what is read.
    #[error(
        "the file has {bytes} bytes, more than {} that a head may have; save it without what is no head",
        BYTES_MAX
    )]
    TooLarge {
        /// Its size.
        bytes: usize,
    },
    /// It ends too early.
    #[error("the file ends in the middle ({part}); copy it again")]
    Truncated {
        /// What is not whole.
        part: &'static str,
    },
    /// Its JSON is not as glTF has it.
    #[error("the glTF's JSON cannot be read: {0}; save the file again")]
    Json(serde_json::Error),
    /// A mesh without a head's data.
    #[error("this is a glTF, but no head: fit one from it with `mouthpiece head fit`")]
    NotAHead,
    /// Made by another version of this program.
    #[error(
        "the head has schema {found}, this program reads {}; write it anew with `mouthpiece head fit` of this version",
        schema::VERSION
    )]
    Schema {
        /// What the file says.
        found: u64,
    },
    /// The head's own JSON.
    #[error("extras of node `head`: {0}; write the head anew with `mouthpiece head fit`")]
    Extras(serde_json::Error),
    /// Something in it is not as it must be.
    #[error("{element}: {fault}; {mend}")]
    Element {
        /// Which thing.
        element: String,
        /// What is wrong with it.
        fault: String,
        /// What to do.
        mend: &'static str,
    },
    /// The colour map.
    #[error("the colour map is no PNG that can be read: {0}; save the skin's texture as PNG")]
    Picture(#[from] png::DecodingError),
    /// How its mouth answers.
    #[error("{0}, with `mouthpiece head calibrate`")]
    Calibration(#[from] CalibrationError),
    /// Its fibres cannot be built.
    #[error("the muscles cannot be built: {0}")]
    Muscles(String),
}

/// What helps against damage that no program of ours does.
const ANEW: &str = "write the head anew with `mouthpiece head fit`";
/// What helps where another program left something out.
const KEEP: &str =
    "save the file with custom attributes and custom properties, and with all its nodes";

impl HeadError {
    fn element(element: impl Into<String>, fault: impl Into<String>, mend: &'static str) -> Self {
        Self::Element {
            element: element.into(),
            fault: fault.into(),
            mend,
        }
    }
}

impl Head {
    /// The head in the bytes of a .glb file.
    ///
    /// # Errors
    /// Where the bytes are no head, or one that could not be moved or drawn.
    pub fn read(bytes: &[u8]) -> Result<Self, HeadError> {
        if bytes.len() > BYTES_MAX {
            return Err(HeadError::TooLarge { bytes: bytes.len() });
        }
        let (document, binary) = document::split(bytes)?;
        read::head(&document, binary)
    }

    /// The bytes of a .glb file: the same for the same head.
    #[must_use]
    pub fn write(&self) -> Vec<u8> {
        write::head(self)
    }

    /// Reads a file.
    ///
    /// # Errors
    /// As [`Head::read`], and where it cannot be read at all; the message begins with its name.
    pub fn load(path: &Path) -> Result<Self, HeadError> {
        let named = |source| HeadError::File {
            path: path.into(),
            source: Box::new(source),
        };
        let size = std::fs::metadata(path).map_err(|e| named(e.into()))?.len();
        match usize::try_from(size) {
            Ok(size) if size <= BYTES_MAX => {}
            size => {
                return Err(named(HeadError::TooLarge {
                    bytes: size.unwrap_or(usize::MAX),
                }));
            }
        }
        let bytes = std::fs::read(path).map_err(|e| named(e.into()))?;
        Self::read(&bytes).map_err(named)
    }
}
