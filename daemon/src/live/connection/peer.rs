//! A client's end of the wire, whatever carries it: bytes or frames in, lines out.

use std::io::{Error, ErrorKind, Result};
use std::time::Duration;

use bytes::{Bytes, BytesMut};
use futures_util::{SinkExt as _, StreamExt as _};
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::{Message, Utf8Bytes};

/// Bytes read at once.
const READ_BYTES: usize = 16 * 1024;

/// Both halves of a stream of bytes.
pub type Stream = (
    Box<dyn AsyncRead + Send + Sync + Unpin>,
    Box<dyn AsyncWrite + Send + Sync + Unpin>,
);

/// A connected client.
pub enum Peer {
    /// Lines over a Unix socket or TCP.
    Lines(Stream),
    /// A WebSocket.
    Frames(Box<WebSocketStream<TcpStream>>),
}

/// What a client sent.
#[derive(Debug)]
pub enum Heard {
    /// Bytes of lines, cut anywhere.
    Bytes(Bytes),
    /// Whole lines.
    Text(Utf8Bytes),
    /// Sound of the open utterance.
    Sound(Bytes),
    /// Nothing more comes. Who closed one half of a stream still reads answers; a WebSocket is gone.
    Over { answers: bool },
}

impl Peer {
    /// Waits for what comes next. Nothing is lost when the wait is given up.
    pub async fn hear(&mut self) -> Heard {
        match self {
            Self::Lines((read, _)) => {
                let mut bytes = BytesMut::with_capacity(READ_BYTES);
                match read.read_buf(&mut bytes).await {
                    Ok(0) => Heard::Over { answers: true },
                    Err(_) => Heard::Over { answers: false },
                    Ok(_) => Heard::Bytes(bytes.freeze()),
                }
            }
            Self::Frames(socket) => loop {
                match socket.next().await {
                    Some(Ok(Message::Text(text))) => return Heard::Text(text),
                    Some(Ok(Message::Binary(bytes))) => return Heard::Sound(bytes),
                    // Pings are answered by the library.
                    Some(Ok(Message::Ping(_) | Message::Pong(_) | Message::Frame(_))) => {}
                    Some(Ok(Message::Close(_)) | Err(_)) | None => {
                        return Heard::Over { answers: false };
                    }
                }
            },
        }
    }

    /// Sends a line, its newline included; who takes nothing for `patience` is gone.
    pub async fn send(&mut self, line: String, patience: Duration) -> Result<()> {
        let sent = async {
            match self {
                Self::Lines((_, write)) => write.write_all(line.as_bytes()).await,
                Self::Frames(socket) => {
                    let text = Message::text(line.trim_end().to_owned());
                    socket.send(text).await.map_err(Error::other)
                }
            }
        };
        let sent = tokio::time::timeout(patience, sent).await;
        sent.map_err(|_| Error::from(ErrorKind::TimedOut))?
    }

    /// Says goodbye where the carrier has a word for it.
    pub async fn close(&mut self, patience: Duration) {
        let closed = async {
            match self {
                Self::Lines((_, write)) => drop(write.shutdown().await),
                Self::Frames(socket) => drop(socket.close().await),
            }
        };
        // Who does not take it is gone anyway.
        let _ = tokio::time::timeout(patience, closed).await;
    }
}
