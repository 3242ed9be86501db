//! The encoder thread: takes pictures from a bounded queue into a [`FrameSink`].

use std::thread::JoinHandle;

use anyhow::{Context as _, anyhow};
use crossbeam::channel::{Receiver, Sender, bounded};

use crate::media::FrameSink;

/// Pictures between drawing and encoding: evens out key frames of the codec, which take longer; at
/// 1080p each is 8 MB.
const QUEUE: usize = 4;

type Sink = Box<dyn FrameSink>;

/// A running encoder.
pub struct Encoder {
    pictures: Option<Sender<Vec<u8>>>,
    used: Receiver<Vec<u8>>,
    thread: Option<JoinHandle<anyhow::Result<Sink>>>,
}

impl Encoder {
    /// Starts the thread.
    pub fn start(mut sink: Sink) -> anyhow::Result<Self> {
        let (pictures, work) = bounded::<Vec<u8>>(QUEUE);
        let (done, used) = bounded(QUEUE + 1);
        let run = move || {
            for picture in work {
                sink.frame(&picture)?;
                // Buffers go back for another turn; when there are enough, this one goes.
                let _ = done.try_send(picture);
            }
            Ok(sink)
        };
        let thread = std::thread::Builder::new()
            .name("encoder".into())
            .spawn(run)
            .context("no thread for the encoder")?;
        Ok(Self {
            pictures: Some(pictures),
            used,
            thread: Some(thread),
        })
    }

    /// Hands a picture over; waits while the encoder is behind.
    pub fn push(&mut self, rgba: &[u8]) -> anyhow::Result<()> {
        let mut buffer = self.used.try_recv().unwrap_or_default();
        buffer.clear();
        buffer.extend_from_slice(rgba);
        match &self.pictures {
            Some(pictures) if pictures.send(buffer).is_ok() => Ok(()),
            // The thread has ended before its time: its error says why.
            _ => self.join().and(Err(anyhow!("the encoder stopped early"))),
        }
    }

    /// Waits until all pictures are encoded and gives the sink back, to be finished.
    pub fn finish(mut self) -> anyhow::Result<Sink> {
        self.join()
    }

    fn join(&mut self) -> anyhow::Result<Sink> {
        self.pictures = None;
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(result)) => result,
            _ => Err(anyhow!("the encoder broke down; the lines above say where")),
        }
    }
}

impl Drop for Encoder {
    fn drop(&mut self) {
        // So that whatever the sink has begun is gone before the process ends.
        let _ = self.join();
    }
}
