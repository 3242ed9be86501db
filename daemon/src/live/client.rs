//! `say` through a running daemon: the wire's client, one utterance long.

use std::time::Duration;

use anyhow::{Context as _, Result, bail};
use base64::Engine as _;
use mouthpiece_phonemes::{Segment, Stress};
use mouthpiece_protocol::message::{Audio, Begin, Caption, Label};
use mouthpiece_protocol::{ClientMessage, DaemonMessage, SampleFormat, limits};
use tokio::io::{AsyncBufReadExt as _, AsyncWriteExt as _, BufReader};
use tokio::net::{TcpStream, UnixStream};

use super::address::Address;
use super::connection::peer::Stream;
use super::source::{Piece, Source};
use super::stop::Stop;
use crate::interrupt::Interrupted;

/// Labels and sound travel in ticks, so that nothing is rounded on the way.
const RATE_HZ: u32 = 48_000;
/// How long a stopped daemon may take to say so.
const STOP_PATIENCE: Duration = Duration::from_secs(2);

/// Calls the daemon; an error when nobody answers there.
pub async fn connect(address: &Address) -> std::io::Result<Stream> {
    Ok(match address {
        Address::Unix(path) => {
            let (r, w) = UnixStream::connect(path).await?.into_split();
            (Box::new(r), Box::new(w))
        }
        Address::Tcp(socket) => {
            let (r, w) = TcpStream::connect(socket).await?.into_split();
            (Box::new(r), Box::new(w))
        }
        Address::WebSocket(_) => return Err(std::io::ErrorKind::Unsupported.into()),
    })
}

/// Speaks `source` and waits until it was heard; when the process is asked to end, stops it.
pub async fn speak(
    (read, mut write): Stream,
    mut source: Source,
    token: Option<String>,
    stop: &Stop,
) -> Result<()> {
    let gone = "the daemon closed the connection";
    if let Some(token) = token {
        let line = ClientMessage::Auth { token }.line()?;
        write.write_all(line.as_bytes()).await.context(gone)?;
    }
    let id = format!("say-{}", std::process::id());
    let audio = source.has_sound.then_some(Audio {
        file: None,
        rate: Some(RATE_HZ),
        channels: Some(1),
        format: Some(SampleFormat::F32),
    });
    let begin = ClientMessage::Begin(Begin {
        id: id.clone(),
        audio,
        alphabet: None,
        label_rate: Some(RATE_HZ),
    });
    write
        .write_all(begin.line()?.as_bytes())
        .await
        .context(gone)?;
    let mut lines = BufReader::new(read).lines();
    let mut coming = true;
    loop {
        tokio::select! {
            piece = source.pieces.recv(), if coming => {
                for message in messages(piece.as_ref()) {
                    write.write_all(message.line()?.as_bytes()).await.context(gone)?;
                }
                coming = piece.is_some();
            }
            line = lines.next_line() => {
                let line = line.context(gone)?.context(gone)?;
                if heard(&line)? {
                    return Ok(());
                }
            }
            () = stop.wait() => {
                let message = ClientMessage::Stop { id: Some(id) };
                write.write_all(message.line()?.as_bytes()).await.context(gone)?;
                let last = async {
                    while let Ok(Some(line)) = lines.next_line().await {
                        if matches!(serde_json::from_str(&line), Ok(DaemonMessage::Stopped { .. })) {
                            return;
                        }
                    }
                };
                if tokio::time::timeout(STOP_PATIENCE, last).await.is_err() {
                    tracing::warn!("the daemon did not say that it stopped");
                }
                return Err(Interrupted::default().into());
            }
        }
    }
}

/// Whether the daemon's line says that all was heard.
fn heard(line: &str) -> Result<bool> {
    let message = serde_json::from_str(line)
        .with_context(|| format!("the daemon speaks another protocol: {line}"))?;
    match message {
        DaemonMessage::Finished { dropped_s, .. } => {
            if dropped_s > 0.0 {
                tracing::warn!("{dropped_s:.2} s came too late and were left out");
            }
            Ok(true)
        }
        DaemonMessage::Stopped { position_s, .. } => {
            bail!("stopped by another client after {position_s:.2} s")
        }
        DaemonMessage::Error {
            message,
            fatal: true,
            ..
        } => bail!("the daemon says: {message}"),
        DaemonMessage::Error {
            id: None, message, ..
        } => bail!("the daemon says: {message}"),
        DaemonMessage::Error { message, .. } | DaemonMessage::Warning { message, .. } => {
            tracing::warn!("the daemon says: {message}");
            Ok(false)
        }
        _ => Ok(false),
    }
}

/// The messages that carry a piece; none is the end.
fn messages(piece: Option<&Piece>) -> Vec<ClientMessage> {
    match piece {
        Some(Piece::Caption(at, text)) => vec![ClientMessage::Caption(Caption {
            text: text.clone(),
            start: Some(*at as f64 / f64::from(RATE_HZ)),
        })],
        Some(Piece::Segments(segments)) => segments
            .chunks(limits::PHONES_PER_MESSAGE_MAX)
            .map(|part| ClientMessage::Phones {
                phones: part.iter().map(label).collect(),
            })
            .collect(),
        Some(Piece::Sound(mono)) => {
            let bytes: Vec<u8> = mono.iter().flat_map(|x| x.to_le_bytes()).collect();
            let data = base64::engine::general_purpose::STANDARD.encode(bytes);
            vec![ClientMessage::Audio { data }]
        }
        None => vec![ClientMessage::End {}],
    }
}

fn label(segment: &Segment) -> Label {
    Label {
        // Ticks of a day are far below 2^53.
        start: segment.start as f64,
        end: segment.end as f64,
        phone: segment.phone.code().to_owned(),
        stress: segment.stress.map(|stress| match stress {
            Stress::Unstressed => 0,
            Stress::Primary => 1,
            Stress::Secondary => 2,
        }),
    }
}
