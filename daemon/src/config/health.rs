//! `[health]`: what is told of how the face does.

use super::section::section;

section! {
    /// What is told of how the face does.
    pub struct Health {
        /// Where /healthz, /metrics and the status page are served: HOST:PORT on loopback, or "none".
        http: String = "127.0.0.1:7717".into() => at_start,
    }
}
