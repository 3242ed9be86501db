//! How the live face is, told over HTTP: to a supervisor, to Prometheus, to a person with a browser.
//!
//! | address | says | module |
//! |---|---|---|
//! | `/healthz` | 200 while a face is on the screen and moving, else 503; JSON that names the part that is ill | [`judge`] |
//! | `/metrics` | figures in the OpenMetrics text format, which Prometheus reads | [`metrics`] |
//! | `/` | a page that shows both and a picture of the screen | [`page`] |
//! | `/status.json`, `/preview.png` | what the page asks for | [`status`], [`preview`] |
//!
//! It only reads: nothing that comes over this door changes anything. [`server`] listens and [`guard`] decides who is let in. All
//! of it runs on the `net` thread; figures are [`vitals`](crate::live::vitals), atomics that the live threads write.

mod guard;
mod judge;
mod metrics;
mod page;
mod preview;
mod server;
mod status;

pub use guard::Token;
pub use server::{Door, Health};
