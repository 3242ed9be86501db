//! Where a daemon listens: a Unix socket, a TCP port, a WebSocket's port.

use std::fmt;
use std::net::{SocketAddr, ToSocketAddrs as _};
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};

/// Name of the default socket, in the user's runtime directory.
const SOCKET_NAME: &str = "mouthpiece.sock";

/// An address to listen at or to call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Address {
    /// A socket file.
    Unix(PathBuf),
    /// Lines over TCP.
    Tcp(SocketAddr),
    /// Frames of a WebSocket.
    WebSocket(SocketAddr),
}

impl Address {
    /// Reads `unix:PATH`, `ws://HOST:PORT`, a path with a slash in it, or `HOST:PORT`.
    pub fn parse(text: &str) -> Result<Self> {
        if let Some(path) = text.strip_prefix("unix:") {
            return Self::unix(Path::new(path));
        }
        if let Some(host) = text.strip_prefix("ws://") {
            return Ok(Self::WebSocket(socket(host.trim_end_matches('/'), text)?));
        }
        if text.contains('/') {
            return Self::unix(Path::new(text));
        }
        Ok(Self::Tcp(socket(text, text)?))
    }

    /// The default: a socket in the user's runtime directory.
    pub fn user_default() -> Result<Self> {
        match std::env::var_os("XDG_RUNTIME_DIR").filter(|d| !d.is_empty()) {
            Some(folder) => Self::unix(&Path::new(&folder).join(SOCKET_NAME)),
            None => {
                bail!("XDG_RUNTIME_DIR is not set; say where to listen with --listen unix:PATH")
            }
        }
    }

    /// Those of a configuration, or the default.
    pub fn all(texts: &[String]) -> Result<Vec<Self>> {
        if texts.is_empty() {
            return Ok(vec![Self::user_default()?]);
        }
        texts.iter().map(|text| Self::parse(text)).collect()
    }

    /// Whether other machines reach it.
    pub fn is_beyond(&self) -> bool {
        match self {
            Self::Unix(_) => false,
            Self::Tcp(address) | Self::WebSocket(address) => !address.ip().is_loopback(),
        }
    }

    fn unix(path: &Path) -> Result<Self> {
        // The system's limit is 108 bytes with the closing zero, 104 on some.
        const BYTES_MAX: usize = 100;
        let bytes = path.as_os_str().len();
        if bytes == 0 || bytes > BYTES_MAX {
            bail!(
                "`{}` is no socket path; give one of 1 to {BYTES_MAX} bytes",
                path.display()
            );
        }
        Ok(Self::Unix(path.to_owned()))
    }
}

/// The first address of `host`, which was given as `text`. A name of several machines is not guessed at.
fn socket(host: &str, text: &str) -> Result<SocketAddr> {
    let found = host.to_socket_addrs().with_context(|| {
        format!("`{text}` is no address; give unix:PATH, 127.0.0.1:PORT or ws://127.0.0.1:PORT to --listen")
    })?;
    let all: Vec<SocketAddr> = found.collect();
    let first = all
        .first()
        .with_context(|| format!("`{text}` names no address"))?;
    // A name that means this machine and another must not open a port to the other by chance.
    Ok(*all.iter().find(|a| !a.ip().is_loopback()).unwrap_or(first))
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unix(path) => write!(f, "unix:{}", path.display()),
            Self::Tcp(address) => write!(f, "{address}"),
            Self::WebSocket(address) => write!(f, "ws://{address}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_as_the_help_says() {
        let unix = |p: &str| Address::Unix(PathBuf::from(p));
        assert_eq!(Address::parse("unix:face.sock").unwrap(), unix("face.sock"));
        assert_eq!(
            Address::parse("/run/face.sock").unwrap(),
            unix("/run/face.sock")
        );
        for text in ["127.0.0.1:7716", "ws://127.0.0.1:7718", "[::1]:80"] {
            let address = Address::parse(text).unwrap();
            assert_eq!(address.to_string(), text);
            assert!(!address.is_beyond());
        }
        assert!(Address::parse("nonsense").is_err());
        assert!(Address::parse(&format!("unix:/{}", "x".repeat(120))).is_err());
    }

    #[test]
    fn what_other_machines_reach_is_known() {
        for open in ["0.0.0.0:7716", "[::]:7716", "ws://192.0.2.1:7716"] {
            assert!(Address::parse(open).unwrap().is_beyond(), "{open}");
        }
    }
}
