//! How large a scan may be. Everything here bounds memory before it is allocated.

/// Triangles of one scan. The fit of HEADSHOP 6 gains nothing beyond some 200,000; four million
/// hold what scanners export undecimated, in some 200 MB of memory.
pub const MAX_TRIANGLES: usize = 4_000_000;

/// Vertices of one scan: three per triangle where a file repeats them (STL), as in triangles.
pub(crate) const MAX_VERTICES: usize = 3 * MAX_TRIANGLES;

/// Bytes of one scan file: an OBJ of [`MAX_TRIANGLES`] with normals and texture has about this.
pub const MAX_FILE_BYTES: u64 = 512 << 20;

/// Bytes of one picture or material file beside a scan.
pub(crate) const MAX_SIDE_FILE_BYTES: u64 = 256 << 20;

/// Pixels of all textures of a scan together: 8192 x 8192, 200 MB in memory.
pub const MAX_PIXELS: u64 = 1 << 26;

/// Largest coordinate, in whatever unit: beyond it single precision cannot tell a nose from a cheek.
pub(crate) const MAX_SPREAD: f32 = 1e7;

/// Corners of one face: ear clipping takes up to its cube.
pub(crate) const MAX_CORNERS: usize = 64;

/// Fewest triangles that can be a head: an octahedron twice subdivided has more.
pub const MIN_TRIANGLES: usize = 100;
