//! `[window]`: where the face is shown.

use super::section::section;
use super::value::{Rotation, Whole};
use crate::cli::Size;

section! {
    /// Where the face is shown.
    pub struct Window {
        /// Fill the screen.
        fullscreen: bool = false => at_start,
        /// The screen to fill: "primary", its name as `mouthpiece doctor` lists it ("HDMI-1"), or
        /// its number from 1.
        monitor: String = "primary".into() => at_start,
        /// Size of a window that does not fill the screen, pixels.
        size: Size = Size { width: 720, height: 720 } => at_start,
        /// Turns the picture clockwise for a screen that hangs on its side: 0, 90, 180 or 270 degrees.
        rotate: Rotation = Rotation::None,
        /// On a full screen the mouse pointer goes away when it has not moved for so many seconds; 0: it stays.
        hide_cursor_after_s: Whole<0, 3600> = Whole::new(3),
        /// Keep the screen from blanking while it is filled.
        keep_awake: bool = true,
        /// On a full screen the picture wanders this many pixels to each side over minutes, so that
        /// no edge burns in; 0: it stays.
        burn_in_shift_px: Whole<0, 64> = Whole::new(4),
    }
}
