//! Scans in: readers of OBJ, PLY, STL and GLB, and what makes a file's mesh fit to be fitted to
//! (HEADSHOP 6).

mod builder;
mod error;
mod glb;
mod gltf;
mod limits;
mod mtl;
mod obj;
mod picture;
mod ply;
mod ply_header;
mod polygon;
mod read;
mod scan;
mod stl;
mod text;

pub use error::{Fault, Place, ScanError};
pub use limits::{MAX_FILE_BYTES, MAX_PIXELS, MAX_TRIANGLES, MIN_TRIANGLES};
pub use read::{Format, Reading, Side, read, read_bytes};
pub use scan::{Image, Scan, ScanColour};
