//! How much a label file or stream may ask for. Every bound is finite and has its reason.

/// Longest line. A TIMIT label takes 20 bytes, the longest English word 45 letters.
pub const LINE_BYTES_MAX: usize = 1024;

/// Largest file: a day of speech at 12 labels a second and 20 bytes each is 20 MiB.
pub const FILE_BYTES_MAX: u64 = 64 << 20;

/// Most labels of one kind: a day of speech, twice.
pub const LABELS_MAX: usize = 2_000_000;
