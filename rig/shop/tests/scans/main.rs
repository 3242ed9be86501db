//! Reading scans from outside: every format's round trip, hostile bytes, and what a user does wrong.

#![allow(
    clippy::unwrap_used,
    reason = "helpers of tests: a failure is the test's"
)]

mod bad_files;
mod colours;
mod formats;
mod hostile;
mod landmark_files;
mod preparing;
mod shapes;
mod writers;
