//! The harness of the end-to-end tests: runs the real binary and reads what it leaves behind.
//!
//! The tests are in `end_to_end/`, one file a subject; `fixtures/` holds speech, `golden/` pictures.
//! Everything is judged from outside: files, exit statuses and what is printed. Nothing here uses the
//! product's own crates, so that a fault in a reader cannot hide a fault in its writer.
//!
//! | module | does |
//! |---|---|
//! | [`binary`] | finds and runs `mouthpiece`, with a deadline |
//! | [`daemon`] | a running daemon: its socket, its health, its log |
//! | [`screen`] | an X server of a test's own |
//! | [`display`] | what is on it |
//! | [`fixtures`] | the utterances in `fixtures/` |
//! | [`curves`] | reads the table that `mouthpiece curves` writes |
//! | [`mp4`] | walks the boxes of an MP4 |
//! | [`wav`] | writes sound files of any kind, sane or not |
//! | [`picture`] | reads PNGs and compares them by FLIP |

#![forbid(unsafe_code)]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::missing_panics_doc,
    reason = "for tests only: a test that cannot go on has failed, and says where"
)]

pub mod binary;
pub mod curves;
pub mod daemon;
pub mod display;
pub mod fixtures;
pub mod mp4;
pub mod picture;
pub mod screen;
pub mod wav;

/// What a test needs of this machine; where it is not there, says why the test is skipped.
pub fn or_skipped<T>(found: Result<T, impl std::fmt::Display>) -> Option<T> {
    found.map_err(|why| println!("skipped: {why}")).ok()
}
