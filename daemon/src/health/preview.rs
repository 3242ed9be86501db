//! `/preview.png`: what is on the screen, small, for as long as somebody looks at it.
//!
//! The main thread has the card copy a picture when asked, and is asked twice a second at most; shrinking and encoding happen on a
//! thread for such work.

use std::time::{Duration, Instant};

use axum::body::Bytes;
use mouthpiece_render::{Shot, SmallPicture};
use tokio::sync::Mutex;

use crate::live::shots::Shots;

/// A picture is shown again to whoever asks within this.
const FRESH: Duration = Duration::from_millis(500);
/// Longer than the screen takes for a picture or two where it takes any.
const PATIENCE: Duration = Duration::from_secs(3);
/// No side is longer, pixels.
const SIDE_MAX: u32 = 480;

/// The last picture that was asked for.
pub struct Preview {
    shots: Shots,
    last: Mutex<Option<(Instant, Bytes)>>,
}

/// Why there is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PreviewError {
    #[error("no picture is being shown\n")]
    Nothing,
    #[error("what is on this screen cannot be read back\n")]
    Unreadable,
}

impl Preview {
    pub fn new(shots: Shots) -> Self {
        Self {
            shots,
            last: Mutex::new(None),
        }
    }

    /// What is on the screen, as PNG.
    pub async fn png(&self) -> Result<Bytes, PreviewError> {
        // Held while the picture comes: whoever else asks gets the same one.
        let mut last = self.last.lock().await;
        if let Some((taken, png)) = &*last
            && taken.elapsed() < FRESH
        {
            return Ok(png.clone());
        }
        let shot = tokio::time::timeout(PATIENCE, self.shots.ask()).await;
        let shot = shot
            .map_err(|_| PreviewError::Nothing)?
            .map_err(|_| PreviewError::Unreadable)?;
        let png = tokio::task::spawn_blocking(move || encode(shot)).await;
        let png = png.ok().flatten().ok_or(PreviewError::Unreadable)?;
        *last = Some((Instant::now(), png.clone()));
        Ok(png)
    }
}

fn encode(shot: Shot) -> Option<Bytes> {
    let SmallPicture { width, height, rgb } = shot.read(SIDE_MAX).ok()?;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header().ok()?;
    writer.write_image_data(&rgb).ok()?;
    writer.finish().ok()?;
    Some(bytes.into())
}
