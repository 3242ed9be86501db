//! `say` without a daemon: one utterance through this process's own player.

use std::sync::Arc;
use std::sync::atomic::AtomicI64;
use std::time::Duration;

use anyhow::{Result, bail};
use mouthpiece_protocol::DaemonMessage;
use tokio::sync::mpsc;

use super::player::Handle;
use super::source::{Piece, Source};
use super::utterance::{ANSWERS_MAX, Begin};

/// The face is seen at rest for this long after its last word.
const REST: Duration = Duration::from_millis(600);

/// Speaks `source` and waits until it was heard. `start` learns its first tick.
pub async fn speak(
    handle: Handle,
    mut source: Source,
    start: Option<Arc<AtomicI64>>,
) -> Result<()> {
    let (answers, mut told) = mpsc::channel(ANSWERS_MAX);
    let key = handle.new_key();
    let begin = Begin {
        key,
        client: 0,
        id: "say".to_owned(),
        has_sound: source.has_sound,
        answers,
        start,
    };
    handle.begin(begin).await;
    let mut coming = true;
    loop {
        tokio::select! {
            piece = source.pieces.recv(), if coming => match piece {
                Some(Piece::Caption(at, text)) => handle.caption(Some(key), at, text).await,
                Some(Piece::Segments(segments)) => handle.segments(key, segments).await,
                Some(Piece::Sound(mono)) => handle.sound(key, mono).await,
                None => {
                    coming = false;
                    handle.end(key).await;
                }
            },
            message = told.recv() => match message {
                Some(DaemonMessage::Finished { position_s, dropped_s, .. }) => {
                    if dropped_s > 0.0 {
                        tracing::warn!("{dropped_s:.2} s came too late and were left out");
                    }
                    if position_s == 0.0 {
                        bail!("there was nothing to say: no labels and no sound came");
                    }
                    tokio::time::sleep(REST).await;
                    return Ok(());
                }
                Some(DaemonMessage::Error { message, .. }) => bail!(message),
                Some(_) => {}
                None => bail!("the sound thread ended before the utterance did"),
            },
        }
    }
}
