//! The daemon's ear: binds its addresses and takes clients in, a bounded number at a time.
//!
//! | address | who comes in | sound files |
//! |---|---|---|
//! | Unix socket | its user; a group where one is named | any; with a group those below `files` |
//! | TCP | whoever is on this machine, or has the token where one is set | below `files` |
//! | WebSocket | the same, from pages of this host and those that are listed | below `files` |
//!
//! Nothing listens beyond this machine without a token.

mod tcp;
mod unix;
mod websocket;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use anyhow::{Context as _, Result, bail};
use mouthpiece_protocol::{ErrorCode, Token};
use tokio::net::{TcpListener, TcpStream, UnixListener};
use tokio::task::JoinSet;
use tokio_util::task::TaskTracker;

use super::address::Address;
use super::connection::files::Files;
use super::connection::peer::Peer;
use super::connection::{self, Terms, refusal};
use super::player::Handle;
use super::reload::Current;
use crate::config::Wire;
use unix::SocketFile;
use websocket::Guard;

/// Bound sockets.
pub struct Server {
    ears: Vec<Ear>,
    /// Held until the daemon ends.
    files: Vec<SocketFile>,
}

/// One of them, and what holds for who comes in there as long as the daemon lives.
struct Ear {
    listener: Listener,
    token: Option<Token>,
    files: Files,
}

enum Listener {
    Unix(UnixListener),
    Tcp(TcpListener),
    WebSocket(TcpListener),
}

/// What all of them share while they serve.
struct Room {
    handle: Handle,
    served: TaskTracker,
    /// What else holds, for each client as it is when it comes.
    current: Current,
    next: AtomicU64,
}

impl Server {
    /// Binds what `wire` says; a socket that another daemon answers at is refused. Call inside the runtime.
    pub async fn bind(wire: &Wire) -> Result<Self> {
        let token = wire.token_file.as_deref().map(read_token).transpose()?;
        let below = match &wire.files {
            Some(folder) => Some(Files::below(folder)?),
            None => None,
        };
        let (mut ears, mut files) = (Vec::new(), Vec::new());
        for address in Address::all(&wire.listen)? {
            if address.is_beyond() && token.is_none() {
                bail!(
                    "{address} can be reached from other machines; set a token with --token-file, or listen on 127.0.0.1"
                );
            }
            let far = below.clone().unwrap_or(Files::None);
            let ear = match &address {
                Address::Unix(path) => {
                    let (listener, file) = unix::bind(path, wire.group.as_deref()).await?;
                    files.push(file);
                    let near = match (&below, &wire.group) {
                        (None, None) => Files::below(Path::new("/"))?,
                        _ => far,
                    };
                    Ear {
                        listener: Listener::Unix(listener),
                        token: None,
                        files: near,
                    }
                }
                Address::Tcp(socket) => Ear {
                    listener: Listener::Tcp(tcp::bind(*socket).await?),
                    token: token.clone(),
                    files: far,
                },
                Address::WebSocket(socket) => Ear {
                    listener: Listener::WebSocket(tcp::bind(*socket).await?),
                    token: token.clone(),
                    files: far,
                },
            };
            tracing::info!(%address, "listening");
            ears.push(ear);
        }
        Ok(Self { ears, files })
    }

    /// The file of its Unix socket.
    pub fn socket(&self) -> Option<PathBuf> {
        self.files.first().map(|file| file.path().to_owned())
    }

    /// Serves clients until the process ends and they have heard of it. Who comes in finds the bounds of `current`
    /// as they are then, and keeps them.
    pub async fn serve(self, handle: Handle, current: Current) {
        let served = TaskTracker::new();
        let room = Arc::new(Room {
            handle,
            served: served.clone(),
            current,
            next: AtomicU64::new(0),
        });
        let mut ears = JoinSet::new();
        for ear in self.ears {
            ears.spawn(ear.serve(Arc::clone(&room)));
        }
        while ears.join_next().await.is_some() {}
        // Nobody is to find a socket that is not listened at.
        drop(self.files);
        served.close();
        served.wait().await;
    }
}

/// A stream that was accepted and is not yet a client.
enum Caller {
    Peer(Peer),
    WebSocket(TcpStream),
}

impl Ear {
    async fn serve(self, room: Arc<Room>) {
        let closing = room.handle.closing().clone();
        while let Some(accepted) = closing.run_until_cancelled(self.accept()).await {
            let caller = match accepted {
                Ok(caller) => caller,
                Err(error) => {
                    // Out of file handles, mostly: others must close first.
                    tracing::warn!(%error, "a client could not be taken in");
                    tokio::time::sleep(Duration::from_millis(100)).await;
                    continue;
                }
            };
            let config = room.current.load_full();
            let wire = &config.wire;
            let terms = self.terms(wire);
            let vitals = &room.handle.vitals().net;
            if room.served.len() >= usize::try_from(wire.clients.get()).unwrap_or(1) {
                vitals.turned_away.add(1);
                turn_away(caller, &terms, room.served.len()).await;
                continue;
            }
            vitals.connected.add(1);
            vitals.clients.add(1);
            let origins = wire.origins.clone();
            let tracker = room.served.clone();
            let room = Arc::clone(&room);
            tracker.spawn(async move {
                welcome(caller, &room, origins, terms).await;
                room.handle.vitals().net.clients.add(-1);
            });
        }
    }

    async fn accept(&self) -> std::io::Result<Caller> {
        Ok(match &self.listener {
            Listener::Unix(listener) => {
                let (r, w) = listener.accept().await?.0.into_split();
                Caller::Peer(Peer::Lines((Box::new(r), Box::new(w))))
            }
            Listener::Tcp(listener) => {
                let (r, w) = tcp::accept(listener).await?.into_split();
                Caller::Peer(Peer::Lines((Box::new(r), Box::new(w))))
            }
            Listener::WebSocket(listener) => Caller::WebSocket(tcp::accept(listener).await?),
        })
    }

    /// What holds for a client that comes in now.
    fn terms(&self, wire: &Wire) -> Terms {
        let seconds = u64::try_from(wire.write_seconds.get()).unwrap_or(1);
        Terms {
            limits: wire.limits(self.files != Files::None),
            token: self.token.clone(),
            files: self.files.clone(),
            write_patience: Duration::from_secs(seconds),
        }
    }
}

/// Serves a caller to the end.
async fn welcome(caller: Caller, room: &Room, origins: Vec<String>, mut terms: Terms) {
    let number = room.next.fetch_add(1, Ordering::Relaxed);
    let peer = match caller {
        Caller::Peer(peer) => peer,
        Caller::WebSocket(stream) => {
            let guard = Guard {
                origins,
                token: terms.token.clone(),
                frame_bytes: terms.limits.line_bytes,
            };
            match guard.welcome(stream).await {
                Ok((socket, trusted)) => {
                    if trusted {
                        terms.token = None;
                    }
                    Peer::Frames(socket)
                }
                Err(why) => {
                    tracing::debug!(client = number, why, "a WebSocket was refused");
                    return;
                }
            }
        }
    };
    connection::serve(peer, room.handle.clone(), terms, number).await;
}

/// Says why and closes: the one case without a connection to go on with.
async fn turn_away(caller: Caller, terms: &Terms, clients: usize) {
    tracing::warn!("{clients} clients are connected; another was turned away");
    if let Caller::Peer(mut peer) = caller {
        let why = format!("{clients} clients are connected already; try again later");
        let line = refusal(ErrorCode::Busy, why).line();
        // The answer fits the socket's buffer, so this does not wait.
        let _ = peer.send(line, terms.write_patience).await;
    }
}

fn read_token(file: &Path) -> Result<Token> {
    Token::new(&read_token_text(file)?)
        .with_context(|| format!("the token file {} holds no token", file.display()))
}

/// What `file` holds, which not everybody may be able to read.
pub fn read_token_text(file: &Path) -> Result<String> {
    use std::os::unix::fs::PermissionsExt as _;
    let name = file.display();
    let text = std::fs::read_to_string(file)
        .with_context(|| format!("the token file {name} cannot be read"))?;
    let mode = std::fs::metadata(file)?.permissions().mode();
    if mode & 0o007 != 0 {
        bail!("everybody on this machine can read the token in {name}; chmod 600 {name}");
    }
    Ok(text.trim().to_owned())
}
