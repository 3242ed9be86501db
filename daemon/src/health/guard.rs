//! Who is let in, and what every answer carries.
//!
//! On loopback a page of another site could have a browser ask us in its name (DNS rebinding), so the request must name this
//! machine as its host. Beyond loopback it must bring the token, as a bearer's or as a password with any user's name, which
//! browsers ask for.

use std::fmt;
use std::net::IpAddr;
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Response};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use subtle::ConstantTimeEq as _;

/// What lets other machines in.
#[derive(Clone)]
pub struct Token(Arc<[u8]>);

impl Token {
    pub fn new(secret: &[u8]) -> Self {
        Self(secret.into())
    }

    /// Compared in a time that says nothing of where it differs.
    fn is(&self, given: &[u8]) -> bool {
        self.0.ct_eq(given).into()
    }
}

impl fmt::Debug for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Token(..)")
    }
}

/// What a request must bring.
#[derive(Debug)]
pub enum Guard {
    /// This machine's name.
    Host,
    /// The token.
    Token(Token),
}

/// On every answer: nothing from elsewhere, nothing framed, nothing kept.
const HEADERS: [(header::HeaderName, &str); 5] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::CACHE_CONTROL, "no-store"),
    (
        header::HeaderName::from_static("cross-origin-resource-policy"),
        "same-origin",
    ),
];

/// Lets a request through, or answers it.
pub async fn check(State(guard): State<Arc<Guard>>, request: Request, next: Next) -> Response {
    let mut answer = match guard.refusal(request.headers()) {
        None => next.run(request).await,
        Some(refusal) => refusal,
    };
    for (name, value) in HEADERS {
        answer
            .headers_mut()
            .insert(name, HeaderValue::from_static(value));
    }
    answer
}

impl Guard {
    fn refusal(&self, headers: &HeaderMap) -> Option<Response> {
        match self {
            Self::Host => {
                let host = headers.get(header::HOST).and_then(|h| h.to_str().ok());
                if host.is_some_and(is_this_machine) {
                    return None;
                }
                let why = "this is told only to who asks for 127.0.0.1 or localhost\n";
                Some((StatusCode::FORBIDDEN, why).into_response())
            }
            Self::Token(token) => {
                let given = headers.get(header::AUTHORIZATION).and_then(secret);
                if given.is_some_and(|given| token.is(&given)) {
                    return None;
                }
                let ask = [(header::WWW_AUTHENTICATE, "Basic realm=\"mouthpiece\"")];
                let why = "give the token: as a bearer's, or as a password with any name\n";
                Some((StatusCode::UNAUTHORIZED, ask, why).into_response())
            }
        }
    }
}

/// What a request shows for itself.
fn secret(header: &HeaderValue) -> Option<Vec<u8>> {
    let (scheme, rest) = header.to_str().ok()?.split_once(' ')?;
    if scheme.eq_ignore_ascii_case("bearer") {
        return Some(rest.trim().as_bytes().to_vec());
    }
    if !scheme.eq_ignore_ascii_case("basic") {
        return None;
    }
    let pair = BASE64.decode(rest.trim()).ok()?;
    let colon = pair.iter().position(|b| *b == b':')?;
    Some(pair[colon + 1..].to_vec())
}

fn is_this_machine(host: &str) -> bool {
    // A port, but not a part of an address of version 6.
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|b| b.is_ascii_digit()) => name,
        _ => host,
    };
    let name = name.trim_start_matches('[').trim_end_matches(']');
    name.eq_ignore_ascii_case("localhost")
        || name.parse::<IpAddr>().is_ok_and(|ip| ip.is_loopback())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_this_machine_pass() {
        for host in [
            "localhost",
            "LocalHost:7717",
            "127.0.0.1:7717",
            "[::1]:80",
            "[::1]",
            "127.1.2.3",
        ] {
            assert!(is_this_machine(host), "{host}");
        }
        for host in [
            "",
            "evil.example",
            "evil.example:7717",
            "localhost.evil.example",
            "192.0.2.1",
            "[::2]:80",
        ] {
            assert!(!is_this_machine(host), "{host}");
        }
    }

    #[test]
    fn the_token_is_a_bearers_or_a_password() {
        let guard = Guard::Token(Token::new(b"secret"));
        let passes = |value: &str| {
            let mut headers = HeaderMap::new();
            headers.insert(header::AUTHORIZATION, HeaderValue::from_str(value).unwrap());
            guard.refusal(&headers).is_none()
        };
        assert!(passes("Bearer secret") && passes("bearer secret"));
        assert!(passes(&format!("Basic {}", BASE64.encode("anna:secret"))));
        for wrong in [
            "Bearer secre",
            "Bearer secrets",
            "Basic !!",
            "secret",
            "Basic c2VjcmV0",
        ] {
            assert!(!passes(wrong), "{wrong}");
        }
        assert!(guard.refusal(&HeaderMap::new()).is_some());
    }
}
