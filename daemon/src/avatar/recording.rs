//! ARKit's shapes and angles as a CSV in the layout of Live Link Face's recordings.
//!
//! Names and order of the columns are those of recordings that users have published. Their second
//! column is `BlendshapeCount` in recent ones and `BlendShapeCount` in those of the app's first years;
//! ours is as in recent ones.

use std::fmt::Write as _;
use std::sync::Arc;

use mouthpiece_rig::{Head, KeyFrame};

use super::arkit::{self, ANGLES};
use super::face::Reader;
use super::{Rows, timecode};
use crate::cli::Fps;

/// A recording being written.
pub struct Table {
    reader: Reader,
    rate: Fps,
}

impl Table {
    pub fn new(head: &Arc<Head>, rate: Fps) -> Self {
        Self {
            reader: Reader::new(head),
            rate,
        }
    }
}

impl Rows for Table {
    fn header(&self, _rows: u64) -> String {
        let names: Vec<_> = arkit::names().chain(ANGLES).collect();
        format!("Timecode,BlendshapeCount,{}\n", names.join(","))
    }

    fn row(&mut self, k: u64, frame: &KeyFrame, out: &mut String) {
        let face = self.reader.face(frame);
        let values = arkit::shapes(&face)
            .into_iter()
            .chain(arkit::angles(face.is));
        let count = arkit::COUNT + ANGLES.len();
        let _ = write!(out, "{},{count}", timecode(self.rate, k));
        for value in values {
            let _ = write!(out, ",{value:.6}");
        }
        out.push('\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_those_of_live_link_face() {
        let head = Arc::new(Head::reference().unwrap());
        let mut table = Table::new(&head, Fps { num: 60, den: 1 });
        let mut text = table.header(1);
        table.row(61, &head.rest_frame(), &mut text);
        let (header, row) = text.split_once('\n').unwrap();
        let names: Vec<_> = header.split(',').collect();
        assert_eq!(names.len(), 2 + 52 + 9);
        assert_eq!(row.trim_end().split(',').count(), names.len());
        assert!(row.starts_with("00:00:01:01.000,61,0.000000,"));
        let mut sorted = names.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(sorted.len(), names.len());
        for (at, name) in [
            (2, "EyeBlinkLeft"),
            (9, "EyeBlinkRight"),
            (16, "JawForward"),
            (19, "JawOpen"),
            (20, "MouthClose"),
            (25, "MouthSmileLeft"),
            (43, "BrowDownLeft"),
            (48, "CheekPuff"),
            (53, "TongueOut"),
            (54, "HeadYaw"),
            (62, "RightEyeRoll"),
        ] {
            assert_eq!(names[at], name);
        }
    }
}
