//! The handshake of a WebSocket: which pages may speak, and the token of those that come from afar.
//!
//! A browser sends any page's WebSocket to any host, loopback included, so what a page is called
//! (`Origin`) decides, and `Host` must not be a name that somebody could point at this machine.

use std::net::IpAddr;
use std::time::Duration;

use mouthpiece_protocol::Token;
use tokio::net::TcpStream;
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tokio_tungstenite::tungstenite::http::{HeaderMap, StatusCode, header};
use tokio_tungstenite::tungstenite::protocol::WebSocketConfig;

/// A client that has not finished its handshake by then is let go.
const PATIENCE: Duration = Duration::from_secs(10);

/// Who is let in.
#[derive(Clone, Debug)]
pub struct Guard {
    /// Pages that may speak, as browsers name them.
    pub origins: Vec<String>,
    /// What clients have to know.
    pub token: Option<Token>,
    /// Longest frame, bytes.
    pub frame_bytes: usize,
}

/// A client that was let in, and whether it has brought the token already.
pub type Guest = (Box<WebSocketStream<TcpStream>>, bool);

impl Guard {
    /// Shakes hands.
    #[allow(
        clippy::result_large_err,
        reason = "the library's own type of a refusal, once a connection"
    )]
    pub async fn welcome(&self, stream: TcpStream) -> Result<Guest, String> {
        let config = WebSocketConfig::default()
            .max_message_size(Some(self.frame_bytes))
            .max_frame_size(Some(self.frame_bytes));
        let mut known = false;
        let judge = |request: &Request, response: Response| match self
            .judge(request.headers(), request.uri().query())
        {
            Ok(trusted) => {
                known = trusted;
                Ok(response)
            }
            Err((status, why)) => {
                let mut refusal = ErrorResponse::new(Some(why.to_owned()));
                *refusal.status_mut() = status;
                Err(refusal)
            }
        };
        let shaken = tokio_tungstenite::accept_hdr_async_with_config(stream, judge, Some(config));
        match tokio::time::timeout(PATIENCE, shaken).await {
            Ok(Ok(socket)) => Ok((Box::new(socket), known)),
            Ok(Err(error)) => Err(error.to_string()),
            Err(_) => Err("no handshake came".to_owned()),
        }
    }

    /// Whether a request is let in; if so, whether it brought the token.
    fn judge(
        &self,
        headers: &HeaderMap,
        query: Option<&str>,
    ) -> Result<bool, (StatusCode, &'static str)> {
        if !self.knows_origin(headers) {
            let why = "pages of this origin may not speak; name it in `origins` of [wire]\n";
            return Err((StatusCode::FORBIDDEN, why));
        }
        let Some(token) = &self.token else {
            return Ok(true);
        };
        let bearer = text(headers, header::AUTHORIZATION)
            .and_then(|value| value.strip_prefix("Bearer "))
            .map(str::trim);
        let pairs = query.unwrap_or_default().split('&');
        let asked = pairs.filter_map(|pair| pair.strip_prefix("token=")).next();
        match bearer.or(asked) {
            // It may still come as the first message.
            None => Ok(false),
            Some(guess) if token.is(&decoded(guess)) => Ok(true),
            Some(_) => Err((StatusCode::UNAUTHORIZED, "the token is wrong\n")),
        }
    }

    fn knows_origin(&self, headers: &HeaderMap) -> bool {
        let origins = headers.get_all(header::ORIGIN);
        let mut origins = origins.iter().map(|value| value.to_str().unwrap_or("?"));
        let (Some(origin), None) = (origins.next(), origins.next()) else {
            // Programs that are no browsers send none, and can send any.
            return headers.get(header::ORIGIN).is_none();
        };
        if self
            .origins
            .iter()
            .any(|known| known.trim_end_matches('/') == origin)
        {
            return true;
        }
        let page = origin.split_once("://").map(|(_, rest)| host(rest));
        let own = text(headers, header::HOST).map(host);
        // A name could be pointed at this machine by who owns it.
        page.is_some() && page == own && own.is_some_and(is_certain)
    }
}

fn text(headers: &HeaderMap, name: header::HeaderName) -> Option<&str> {
    headers.get(name).and_then(|value| value.to_str().ok())
}

/// The host of `HOST:PORT`, brackets of IPv6 addresses included.
fn host(authority: &str) -> &str {
    match authority.rsplit_once(':') {
        Some((host, port)) if port.bytes().all(|b| b.is_ascii_digit()) => host,
        _ => authority,
    }
}

/// Whether nobody but this machine decides what a host's name means.
fn is_certain(host: &str) -> bool {
    let bare = host.trim_start_matches('[').trim_end_matches(']');
    host == "localhost" || bare.parse::<IpAddr>().is_ok()
}

/// `%2B` and its like as the characters that they stand for.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let hex = after.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        let coded = hex.and_then(|hex| u8::from_str_radix(hex, 16).ok());
        match coded.filter(|_| first == b'%') {
            Some(byte) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            None => {
                bytes.push(first);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guard(token: Option<&str>) -> Guard {
        Guard {
            origins: vec!["https://kiosk.example".to_owned(), "null".to_owned()],
            token: token.map(|t| Token::new(t).unwrap()),
            frame_bytes: 1000,
        }
    }

    fn headers(pairs: &[(header::HeaderName, &str)]) -> HeaderMap {
        let pairs = pairs.iter().map(|(k, v)| (k.clone(), v.parse().unwrap()));
        pairs.collect()
    }

    #[test]
    fn pages_of_the_own_host_and_of_the_list_may_speak_and_no_others() {
        let guard = guard(None);
        let may = |origin: &str, host: &str| {
            let asked = headers(&[(header::ORIGIN, origin), (header::HOST, host)]);
            guard.judge(&asked, None).is_ok()
        };
        assert!(guard.judge(&HeaderMap::new(), None).is_ok(), "no browser");
        assert!(may("http://127.0.0.1:8000", "127.0.0.1:7718"));
        assert!(may("http://localhost:3000", "localhost:7718"));
        assert!(may("http://[::1]", "[::1]:7718"));
        assert!(may("https://kiosk.example", "127.0.0.1:7718"));
        assert!(may("null", "127.0.0.1:7718"));
        assert!(!may("https://evil.example", "127.0.0.1:7718"));
        assert!(!may("https://kiosk.example.evil.example", "127.0.0.1:7718"));
        assert!(!may("http://127.0.0.1.evil.example", "127.0.0.1:7718"));
        // Somebody else's name that means this machine today.
        assert!(!may("http://evil.example:7718", "evil.example:7718"));
        let two = [
            (header::ORIGIN, "null"),
            (header::ORIGIN, "https://evil.example"),
        ];
        let mut asked = HeaderMap::new();
        for (name, value) in two {
            asked.append(name, value.parse().unwrap());
        }
        assert!(guard.judge(&asked, None).is_err());
    }

    #[test]
    fn the_token_comes_with_the_request_or_later_and_a_wrong_one_not_at_all() {
        let guard = guard(Some("0123456789ab+/=="));
        let none = HeaderMap::new();
        let with = |value: &str| headers(&[(header::AUTHORIZATION, value)]);
        assert_eq!(guard.judge(&none, None), Ok(false));
        assert_eq!(
            guard.judge(&with("Bearer 0123456789ab+/=="), None),
            Ok(true)
        );
        assert_eq!(
            guard.judge(&none, Some("a=b&token=0123456789ab%2B%2F%3d=")),
            Ok(true)
        );
        for (headers, query) in [
            (with("Bearer 0123456789ab+/=X"), None),
            (none, Some("token=")),
        ] {
            let refused = guard.judge(&headers, query).unwrap_err();
            assert_eq!(refused.0, StatusCode::UNAUTHORIZED);
        }
    }
}
