//! Scans in: readers of OBJ, PLY, STL and GLB, and what makes a file's mesh fit to be fitted to
//! (HEADSHOP 6).

mod scan;

pub use scan::{Image, Scan, ScanColour};
