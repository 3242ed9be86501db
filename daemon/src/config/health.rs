//! `[health]`: what is told of how the face does.

use super::section::section;
use super::value::Whole;
use crate::health::Door;

section! {
    /// What is told of how the face does.
    pub struct Health {
        /// Where /healthz, /metrics and the status page are served: HOST:PORT on loopback, or "none".
        http: Door = Door::default() => at_start,
        /// A face that shows nothing new for so many milliseconds is ill: /healthz answers 503.
        stall_ms: Whole<500, 60_000> = Whole::new(3000) => at_start,
    }
}
