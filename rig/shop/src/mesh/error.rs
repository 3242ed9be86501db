//! What can be wrong with a scan: every message names the file, where known the line or byte, the
//! fault and the mend, in one sentence.

use std::fmt;
use std::io;

use super::limits::{MAX_CORNERS, MAX_FILE_BYTES, MAX_SPREAD, MAX_TRIANGLES, MAX_VERTICES};

/// Why a file is no scan, or a scan no head.
#[derive(Debug, thiserror::Error)]
#[error("{file}{place}: {fault}")]
pub struct ScanError {
    /// The file, as the caller named it.
    pub file: String,
    /// Where in it.
    pub place: Place,
    /// What is wrong, and the mend.
    #[source]
    pub fault: Fault,
}

/// Where in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    #[default]
    Whole,
    /// A line, from 1.
    Line(usize),
    /// A byte, from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Line(line) => write!(f, ", line {line}"),
            Self::Byte(byte) => write!(f, ", byte {byte}"),
        }
    }
}

/// What is wrong with a scan.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum Fault {
    #[error("cannot be read ({0}): check the path and its permissions")]
    Io(io::Error),
    #[error("the file is empty: export the scan again")]
    EmptyFile,
    #[error("{0} bytes, and a scan file may have {max}: decimate the scan to about 200,000 triangles", max = MAX_FILE_BYTES)]
    HugeFile(u64),
    #[error("this is not a mesh that Mouthpiece reads: export the scan as OBJ, PLY, STL or GLB")]
    UnknownFormat,
    #[error("not {format}: {why}; export the scan again or give it its true extension")]
    NotThis { format: &'static str, why: String },
    #[error("the file ends inside {0}: it was cut short; copy or export it again")]
    Truncated(&'static str),
    #[error("{what} should be a number and is `{found}`: {mend}")]
    NotANumber {
        what: &'static str,
        found: String,
        mend: &'static str,
    },
    #[error("{what} of vertex {vertex} is {value}: remove that vertex or export the scan again")]
    NotFinite {
        what: &'static str,
        vertex: usize,
        value: f64,
    },
    #[error("vertex {vertex} lies at {value}, beyond {max}: move the scan to the origin or change its unit", max = MAX_SPREAD)]
    TooFar { vertex: usize, value: f64 },
    #[error("a face refers to {what} {index}, and there are {count}: export the scan again")]
    OutOfRange {
        what: &'static str,
        index: i64,
        count: usize,
    },
    #[error("a face has {0} corners: a face has at least 3; remove it")]
    FewCorners(usize),
    #[error("a face has {0} corners, and {max} are the most: triangulate the scan on export", max = MAX_CORNERS)]
    ManyCorners(usize),
    #[error("no vertices: this is not a mesh; export the scan as OBJ, PLY, STL or GLB")]
    NoVertices,
    #[error(
        "{0} points and no faces: a cloud of points; make a surface of it first (Poisson or ball pivoting in MeshLab)"
    )]
    PointCloud(usize),
    #[error("only {0} triangle(s): a head needs a surface of at least 100; export the whole scan")]
    FewTriangles(usize),
    #[error("more than {max} triangles ({0}): decimate the scan to about 200,000, which is more than the fit can use", max = MAX_TRIANGLES)]
    ManyTriangles(u64),
    #[error("more than {max} vertices ({0}): decimate the scan to about 200,000 triangles", max = MAX_VERTICES)]
    ManyVertices(u64),
    #[error("all triangles have an area of zero: the scan is flat or collapsed; export it again")]
    NoArea,
    #[error("{found} is not supported: {mend}")]
    Unsupported { found: String, mend: &'static str },
    #[error(
        "the picture {name} cannot be read ({why}): save it as an 8-bit PNG or JPEG, or remove it from the scan"
    )]
    Picture { name: String, why: String },
    #[error(
        "two large pieces of similar size ({first} and {second} triangles) stand apart: this looks like two heads; cut out one of them"
    )]
    TwoHeads { first: usize, second: usize },
    #[error(
        "the scan is a mirror image (its landmarks fit a mirrored face, and its triangles face inwards): negate one axis where it was exported"
    )]
    Mirrored,
    #[error(
        "the pieces that are neither specks nor far away have too little surface ({0} triangles): clean the scan, so that its pieces hang together"
    )]
    Fragments(usize),
}

impl Fault {
    /// The error of this fault in `file`.
    pub(crate) fn at(self, file: &str, place: Place) -> ScanError {
        ScanError {
            file: file.to_owned(),
            place,
            fault: self,
        }
    }
}

/// A fault with its place, before the file's name is known to the code that finds it.
#[derive(Debug)]
pub(crate) struct Found {
    pub(crate) place: Place,
    pub(crate) fault: Fault,
}

impl Found {
    pub(crate) fn line(line: usize, fault: Fault) -> Self {
        Self {
            place: Place::Line(line),
            fault,
        }
    }

    pub(crate) fn byte(byte: usize, fault: Fault) -> Self {
        Self {
            place: Place::Byte(byte),
            fault,
        }
    }

    pub(crate) fn in_file(self, file: &str) -> ScanError {
        self.fault.at(file, self.place)
    }
}

impl From<Fault> for Found {
    fn from(fault: Fault) -> Self {
        Self {
            place: Place::Whole,
            fault,
        }
    }
}
