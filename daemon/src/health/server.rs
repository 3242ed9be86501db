//! Listens, and answers a bounded number of connections at a time on the `net` thread.

use std::fmt;
use std::net::SocketAddr;
use std::str::FromStr;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context as _, Result};
use axum::Router;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;

use super::guard::{self, Guard, Token};
use super::judge::judge;
use super::page;
use super::preview::Preview;
use super::{metrics, status};
use crate::cli::Usage;
use crate::live::shots::Shots;
use crate::live::vitals::Vitals;

/// Connections at a time: a page holds a few, a supervisor and Prometheus one each.
const CONNECTIONS_MAX: usize = 32;
/// A connection that asks for nothing is closed after this long, so that idle ones do not keep others out.
const HEADERS_PATIENCE: Duration = Duration::from_secs(10);
/// And one that takes its answers slower than this.
const CONNECTION_LIFE: Duration = Duration::from_secs(120);
/// Bytes of a request: there is nothing to send but a few headers.
const REQUEST_BYTES_MAX: usize = 16 * 1024;

/// Where to listen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Door {
    /// Nowhere.
    None,
    /// At a port.
    At(SocketAddr),
}

impl Default for Door {
    fn default() -> Self {
        Self::At(SocketAddr::from(([127, 0, 0, 1], 7717)))
    }
}

impl fmt::Display for Door {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::At(address) => address.fmt(f),
        }
    }
}

impl FromStr for Door {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" {
            return Ok(Self::None);
        }
        let numbers = text.replace("localhost:", "127.0.0.1:");
        let address = numbers.parse().map_err(|_| {
            format!("`{text}` is no address for pages of health; write 127.0.0.1:7717, or none")
        })?;
        Ok(Self::At(address))
    }
}

impl Door {
    /// Binds the port; none where that is not wanted, or the port is taken: the face is worth more than its pages, so then
    /// the log says so. Call inside the runtime.
    ///
    /// # Errors
    /// When other machines could reach it and there is no token.
    pub async fn open(self, token: Option<Token>) -> Result<Option<Open>> {
        let Self::At(address) = self else {
            return Ok(None);
        };
        let guard = if address.ip().is_loopback() {
            Guard::Host
        } else {
            let port = address.port();
            Guard::Token(token.ok_or_else(|| {
                Usage(format!(
                    "{address} can be reached from other machines, and there is no token to let only yours in; \
                     listen at 127.0.0.1:{port}, or give the wire a token (--token-file)"
                ))
            })?)
        };
        match TcpListener::bind(address).await {
            Ok(listener) => {
                let address = listener.local_addr().context("the port has no address")?;
                tracing::info!("health is told at http://{address}/");
                Ok(Some(Open { listener, guard }))
            }
            Err(error) => {
                tracing::warn!(
                    "health is not told: {address} cannot be listened at ({error}); give --http another port, or none"
                );
                Ok(None)
            }
        }
    }
}

/// A port that is listened at.
#[derive(Debug)]
pub struct Open {
    listener: TcpListener,
    guard: Guard,
}

/// What is told.
#[derive(Clone)]
pub struct Health {
    vitals: Arc<Vitals>,
    preview: Arc<Preview>,
    stall_ns: i64,
}

impl Health {
    /// Reads `vitals`, has the screen shown through `shots`; a part that says nothing for `stall_ms` is ill.
    pub fn new(vitals: Arc<Vitals>, shots: Shots, stall_ms: i64) -> Self {
        Self {
            vitals,
            preview: Arc::new(Preview::new(shots)),
            stall_ns: stall_ms * 1_000_000,
        }
    }
}

impl Open {
    /// Answers for ever.
    pub async fn serve(self, health: Health) {
        let room = Arc::new(Semaphore::new(CONNECTIONS_MAX));
        let router = routes(health).layer(axum::middleware::from_fn_with_state(
            Arc::new(self.guard),
            guard::check,
        ));
        loop {
            // Who finds no room waits in the system's queue, which is bounded, too.
            let Ok(permit) = Arc::clone(&room).acquire_owned().await else {
                return;
            };
            match self.listener.accept().await {
                Ok((stream, _)) => {
                    let router = router.clone();
                    tokio::spawn(async move {
                        answer(stream, router).await;
                        drop(permit);
                    });
                }
                Err(error) => {
                    tracing::warn!(%error, "a connection for health could not be taken in");
                    tokio::time::sleep(Duration::from_millis(100)).await;
                }
            }
        }
    }
}

async fn answer(stream: TcpStream, router: Router) {
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEADERS_PATIENCE)
        .max_buf_size(REQUEST_BYTES_MAX)
        .serve_connection(TokioIo::new(stream), TowerToHyperService::new(router));
    match tokio::time::timeout(CONNECTION_LIFE, connection).await {
        Ok(Ok(())) => {}
        // Closed in the middle, no HTTP, or too slow: theirs to mend.
        Ok(Err(error)) => tracing::debug!(%error, "a connection for health ended"),
        Err(_) => tracing::debug!("a connection for health was closed for its age"),
    }
}

fn routes(health: Health) -> Router {
    Router::new()
        .route("/", get(|| async { page::HTML.into_response() }))
        .route("/page.css", get(|| async { page::CSS.into_response() }))
        .route("/page.js", get(|| async { page::JS.into_response() }))
        .route("/favicon.ico", get(|| async { StatusCode::NO_CONTENT }))
        .route("/healthz", get(healthz))
        .route("/metrics", get(figures))
        .route("/status.json", get(all))
        .route("/preview.png", get(picture))
        .with_state(health)
}

async fn healthz(State(health): State<Health>) -> Response {
    let now_ns = health.vitals.origin.now_ns();
    let verdict = judge(&health.vitals, now_ns, health.stall_ns);
    let code = if verdict.ok {
        StatusCode::OK
    } else {
        StatusCode::SERVICE_UNAVAILABLE
    };
    (code, axum::Json(verdict)).into_response()
}

async fn figures(State(health): State<Health>) -> Response {
    match metrics::text(&health.vitals, health.stall_ns) {
        Ok(text) => ([(header::CONTENT_TYPE, metrics::CONTENT_TYPE)], text).into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

async fn all(State(health): State<Health>) -> Response {
    axum::Json(status::status(&health.vitals, health.stall_ns)).into_response()
}

async fn picture(State(health): State<Health>) -> Response {
    match health.preview.png().await {
        Ok(png) => ([(header::CONTENT_TYPE, "image/png")], png).into_response(),
        Err(why) => (StatusCode::SERVICE_UNAVAILABLE, why.to_string()).into_response(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_as_the_help_says() {
        assert_eq!("none".parse(), Ok(Door::None));
        for text in ["127.0.0.1:7717", "localhost:7717"] {
            assert_eq!(text.parse(), Ok(Door::default()));
            assert_eq!(Door::default().to_string().parse(), Ok(Door::default()));
        }
        let why = "7717".parse::<Door>().unwrap_err();
        assert!(why.contains("127.0.0.1:7717"), "{why}");
    }
}
