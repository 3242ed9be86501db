//! Writes pictures and sound into one file as they come, and the table of contents in front of them.
//!
//! The sizes of the tables are known beforehand, so that room for them is left at the beginning and
//! filled at the end: a browser can play the file while it loads, and nothing but the tables is
//! ever held in memory. Each frame and each packet is a chunk of its own, in order of time.

use std::io::{self, Seek, SeekFrom, Write};

use super::boxes;
use super::h264::Config;
use super::opus::PACKET;

/// What the file will hold.
#[derive(Clone, Debug)]
pub struct Plan {
    pub width: u32,
    pub height: u32,
    pub fps: (u32, u32),
    pub frames: u64,
    pub audio: Option<AudioPlan>,
}

/// The sound's part of it.
#[derive(Clone, Debug)]
pub struct AudioPlan {
    /// Samples that are heard.
    pub length: u64,
    /// Samples dropped before them.
    pub pre_skip: u16,
    pub packets: u64,
}

impl AudioPlan {
    /// Samples of the last packet that belong to the sound.
    pub fn last_packet(&self) -> u32 {
        let coded = self.length + u64::from(self.pre_skip);
        let before = self.packets.saturating_sub(1) * PACKET;
        u32::try_from(coded.saturating_sub(before)).unwrap_or(PACKET as u32)
    }
}

/// Where the samples of one track lie.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    pub sizes: Vec<u32>,
    pub offsets: Vec<u64>,
    /// Numbers, from 1, of those that a player can start at.
    pub keys: Vec<u32>,
}

/// Room for everything in the table of contents that does not grow with the number of samples.
const FIXED_BYTES: u64 = 4096;

/// A file being written.
pub struct Muxer<W> {
    out: W,
    at: u64,
    plan: Plan,
    video: Samples,
    audio: Samples,
    /// Start of the room left for the table of contents, and its size.
    room: (u64, u64),
    data_at: u64,
}

impl<W: Write + Seek> Muxer<W> {
    pub fn new(mut out: W, plan: Plan) -> io::Result<Self> {
        let mut head = boxes::file_type();
        let packets = plan.audio.as_ref().map_or(0, |audio| audio.packets);
        // Size, offset and perhaps a key's number per frame; size and offset per packet.
        let room = FIXED_BYTES + plan.frames * 16 + packets * 12;
        let room_at = head.len() as u64;
        head.extend(boxes::free(room));
        let data_at = head.len() as u64;
        head.extend(boxes::long_data_header(0));
        out.write_all(&head)?;
        let at = head.len() as u64;
        Ok(Self {
            out,
            at,
            plan,
            video: Samples::default(),
            audio: Samples::default(),
            room: (room_at, room),
            data_at,
        })
    }

    /// Appends a frame.
    pub fn video(&mut self, sample: &[u8], key: bool) -> io::Result<()> {
        if key {
            self.video.keys.push(self.video.sizes.len() as u32 + 1);
        }
        let at = self.append(sample)?;
        self.video.offsets.push(at);
        self.video.sizes.push(sample.len() as u32);
        Ok(())
    }

    /// Appends a packet of sound.
    pub fn audio(&mut self, packet: &[u8]) -> io::Result<()> {
        let at = self.append(packet)?;
        self.audio.offsets.push(at);
        self.audio.sizes.push(packet.len() as u32);
        Ok(())
    }

    fn append(&mut self, bytes: &[u8]) -> io::Result<u64> {
        let at = self.at;
        self.out.write_all(bytes)?;
        self.at += bytes.len() as u64;
        Ok(at)
    }

    /// Writes the table of contents.
    pub fn finish(mut self, config: &Config) -> io::Result<()> {
        self.out.seek(SeekFrom::Start(self.data_at))?;
        self.out
            .write_all(&boxes::long_data_header(self.at - self.data_at))?;
        let mut movie = boxes::movie(&self.plan, config, &self.video, &self.audio);
        let size = movie.len() as u64;
        // Either exactly, or with 8 bytes or more over for the header of what stays free.
        let (at, fits) = match self.room.1.checked_sub(size) {
            Some(rest) if rest == 0 || rest >= 8 => {
                movie.extend(boxes::free(rest));
                (self.room.0, true)
            }
            _ => (self.at, false),
        };
        debug_assert!(fits, "the plan named fewer frames than came");
        self.out.seek(SeekFrom::Start(at))?;
        self.out.write_all(&movie)?;
        self.out.flush()
    }
}
