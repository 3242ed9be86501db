//! Where a daemon listens: a Unix socket or a port on loopback.

use std::fmt;
use std::net::{IpAddr, SocketAddr, ToSocketAddrs as _};
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};

/// Name of the default socket, in the user's runtime directory.
const SOCKET_NAME: &str = "mouthpiece.sock";

/// An address to listen at or to call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Address {
    /// A socket file.
    Unix(PathBuf),
    /// A port that only this machine reaches.
    Loopback(SocketAddr),
}

impl Address {
    /// Reads `unix:PATH`, a path with a slash in it, or `HOST:PORT`; never an address that other
    /// machines reach, since there is no authentication yet.
    pub fn parse(text: &str) -> Result<Self> {
        if let Some(path) = text.strip_prefix("unix:") {
            return Self::unix(Path::new(path));
        }
        if text.contains('/') {
            return Self::unix(Path::new(text));
        }
        let addresses = text.to_socket_addrs().with_context(|| {
            format!("`{text}` is no address; give unix:PATH or 127.0.0.1:PORT to --listen")
        })?;
        let all: Vec<SocketAddr> = addresses.collect();
        if let Some(beyond) = all.iter().find(|a| !a.ip().is_loopback()) {
            bail!(
                "{beyond} can be reached from other machines, which is not allowed yet; listen at {}:{}",
                IpAddr::from([127, 0, 0, 1]),
                beyond.port()
            );
        }
        let first = all
            .first()
            .with_context(|| format!("`{text}` names no address"))?;
        Ok(Self::Loopback(*first))
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

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unix(path) => write!(f, "unix:{}", path.display()),
            Self::Loopback(address) => write!(f, "{address}"),
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
        let port = Address::parse("127.0.0.1:7716").unwrap();
        assert_eq!(port.to_string(), "127.0.0.1:7716");
        assert!(matches!(
            Address::parse("[::1]:80"),
            Ok(Address::Loopback(_))
        ));
    }

    #[test]
    fn nobody_beyond_this_machine_gets_in() {
        for open in ["0.0.0.0:7716", "[::]:7716", "192.0.2.1:7716"] {
            let why = Address::parse(open).unwrap_err().to_string();
            assert!(why.contains("127.0.0.1:7716"), "{why}");
        }
        assert!(Address::parse("nonsense").is_err());
        assert!(Address::parse(&format!("unix:/{}", "x".repeat(120))).is_err());
    }
}
