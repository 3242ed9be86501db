//! The daemon's ear: binds the address, takes clients in, a bounded number at a time.

use std::io::ErrorKind;
use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context as _, Result, bail};
use mouthpiece_protocol::{DaemonMessage, ErrorCode, Limits};
use tokio::io::AsyncWriteExt as _;
use tokio::net::{TcpListener, UnixListener};
use tokio::sync::Semaphore;
use tokio_util::task::TaskTracker;

use super::address::Address;
use super::connection::{self, Stream};
use super::player::Handle;

/// Clients at a time: each may hold a line of a megabyte and its answers.
const CLIENTS_MAX: usize = 32;

/// A bound socket.
pub struct Server {
    listener: Listener,
    limits: Limits,
    /// Held until the daemon ends.
    _file: Option<SocketFile>,
}

enum Listener {
    Unix(UnixListener),
    Tcp(TcpListener),
}

/// Removes the socket file when the daemon ends.
struct SocketFile(PathBuf);

impl Drop for SocketFile {
    fn drop(&mut self) {
        if let Err(error) = std::fs::remove_file(&self.0) {
            tracing::debug!(path = %self.0.display(), %error, "the socket file stays");
        }
    }
}

impl Server {
    /// Binds `address`; a socket that another daemon answers at is refused. Call inside the runtime.
    pub async fn bind(address: &Address) -> Result<Self> {
        let (listener, file) = match address {
            Address::Unix(path) => {
                let listener = Listener::Unix(bind_unix(path).await?);
                (listener, Some(SocketFile(path.clone())))
            }
            Address::Loopback(socket) => {
                let bound = TcpListener::bind(socket).await;
                let bound = bound.with_context(|| {
                    format!("cannot listen at {socket}; give --listen another port")
                })?;
                (Listener::Tcp(bound), None)
            }
        };
        let limits = Limits {
            // Any user of this machine can connect to a port, but not read this user's files.
            files: matches!(address, Address::Unix(_)),
            ..Limits::default()
        };
        tracing::info!(%address, "listening");
        Ok(Self {
            listener,
            limits,
            _file: file,
        })
    }

    /// Serves clients until the process ends and they have heard of it.
    pub async fn serve(self, handle: Handle) {
        let room = Arc::new(Semaphore::new(CLIENTS_MAX));
        let served = TaskTracker::new();
        let closing = handle.closing().clone();
        while let Some(accepted) = closing.run_until_cancelled(self.accept()).await {
            let stream: Stream = match accepted {
                Ok(stream) => stream,
                Err(error) => {
                    // Out of file handles, mostly: others must close first.
                    tracing::warn!(%error, "a client could not be taken in");
                    tokio::time::sleep(std::time::Duration::from_millis(100)).await;
                    continue;
                }
            };
            match Arc::clone(&room).try_acquire_owned() {
                Ok(permit) => {
                    let (handle, limits) = (handle.clone(), self.limits.clone());
                    served.spawn(async move {
                        let net = &Arc::clone(handle.vitals()).net;
                        net.connected.add(1);
                        net.clients.add(1);
                        connection::serve(stream, handle, limits).await;
                        net.clients.add(-1);
                        drop(permit);
                    });
                }
                Err(_) => {
                    handle.vitals().net.turned_away.add(1);
                    turn_away(stream).await;
                }
            }
        }
        // Nobody is to find a socket that is not listened at.
        drop(self);
        served.close();
        served.wait().await;
    }

    async fn accept(&self) -> std::io::Result<Stream> {
        match &self.listener {
            Listener::Unix(listener) => listener.accept().await.map(|(s, _)| {
                let (r, w) = s.into_split();
                (Box::new(r) as _, Box::new(w) as _)
            }),
            Listener::Tcp(listener) => listener.accept().await.map(|(s, _)| {
                let (r, w) = s.into_split();
                (Box::new(r) as _, Box::new(w) as _)
            }),
        }
    }
}

/// Says why and closes: the one case without a connection to go on with.
async fn turn_away((_, mut write): Stream) {
    let message = DaemonMessage::Error {
        id: None,
        code: ErrorCode::Busy,
        message: format!("{CLIENTS_MAX} clients are connected already; try again later"),
        fatal: false,
    };
    tracing::warn!("{CLIENTS_MAX} clients are connected; another was turned away");
    // The answer fits the socket's buffer, so this does not wait.
    let _ = write.write_all(message.line().as_bytes()).await;
}

/// Binds a socket file that only its user can open. The file appears under its name when it is
/// ready, in place of one that nobody answers at any more.
async fn bind_unix(path: &Path) -> Result<UnixListener> {
    let name = path.display();
    match tokio::net::UnixStream::connect(path).await {
        Ok(_) => {
            bail!("another mouthpiece listens at {name}; end it, or give --listen another place")
        }
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => match std::fs::symlink_metadata(path) {
            Ok(there) if there.file_type().is_socket() => {
                tracing::info!(path = %name, "replacing the socket of a daemon that is gone");
            }
            Ok(_) => bail!("{name} is there and is no socket; give --listen another place"),
            Err(_) => return Err(error).with_context(|| format!("cannot look at {name}")),
        },
    }
    let mut fresh = path.as_os_str().to_owned();
    fresh.push(format!(".{}", std::process::id()));
    let fresh = PathBuf::from(fresh);
    // Left by a process of the same number that died in between.
    let _ = std::fs::remove_file(&fresh);
    let bound = UnixListener::bind(&fresh)
        .and_then(|listener| {
            std::fs::set_permissions(&fresh, std::fs::Permissions::from_mode(0o600))?;
            std::fs::rename(&fresh, path)?;
            Ok(listener)
        })
        .with_context(|| {
            format!("cannot listen at {name}; does its folder exist, and is it yours?")
        });
    if bound.is_err() {
        let _ = std::fs::remove_file(&fresh);
    }
    bound
}
