//! Scans in: readers of OBJ, PLY, STL and GLB, and what makes a file's mesh fit to be fitted to
//! (HEADSHOP 6).

mod builder;
mod check;
mod error;
mod glb;
mod gltf;
mod limits;
mod mtl;
mod nearest;
mod obj;
mod picture;
mod ply;
mod ply_header;
mod polygon;
mod prepare;
mod read;
mod scan;
pub(crate) mod similarity;
mod stl;
mod text;
mod tidy;
mod units;

pub use error::{Fault, Place, ScanError};
pub use limits::{MAX_FILE_BYTES, MAX_PIXELS, MAX_TRIANGLES, MIN_TRIANGLES};
pub use prepare::{Options, Preparation, PrepareError, Prepared, ReferencePoint, prepare};
pub use read::{Format, Reading, Side, read, read_bytes};
pub use scan::{Image, Scan, ScanColour};
pub use tidy::{Dropped, tidy};
