//! The boxes of an MP4 file (ISO/IEC 14496-12, -15 for H.264; "Encapsulation of Opus in ISO Base
//! Media File Format" 0.6.8 for Opus), no more of them than players need.

use super::h264::Config;
use super::mux::{AudioPlan, Plan, Samples};
use super::opus::PACKET;

/// Units a second of the movie as a whole and of the sound: our own tick.
const MOVIE_RATE: u32 = 48_000;

/// Players are known to stumble over coarse time scales; the picture's has at least this many units a second.
const VIDEO_RATE_MIN: u32 = 12_000;

/// Opus needs 80 ms of packets before one that it jumps to.
const OPUS_ROLL_PACKETS: i16 = 4;

/// Bytes under construction.
#[derive(Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn boxed(&mut self, kind: &[u8; 4], body: impl FnOnce(&mut Self)) {
        let at = self.0.len();
        self.u32(0).raw(kind);
        body(self);
        let size = (self.0.len() - at) as u32;
        self.0[at..at + 4].copy_from_slice(&size.to_be_bytes());
    }

    /// A box that begins with a version and flags.
    fn full(&mut self, kind: &[u8; 4], version: u8, flags: u32, body: impl FnOnce(&mut Self)) {
        self.boxed(kind, |b| {
            b.u32((u32::from(version) << 24) | flags);
            body(b);
        });
    }

    fn raw(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.extend_from_slice(bytes);
        self
    }
    fn u8(&mut self, value: u8) -> &mut Self {
        self.raw(&[value])
    }
    fn u16(&mut self, value: u16) -> &mut Self {
        self.raw(&value.to_be_bytes())
    }
    fn u32(&mut self, value: u32) -> &mut Self {
        self.raw(&value.to_be_bytes())
    }
    fn u64(&mut self, value: u64) -> &mut Self {
        self.raw(&value.to_be_bytes())
    }
    fn zeros(&mut self, count: usize) -> &mut Self {
        self.0.resize(self.0.len() + count, 0);
        self
    }
    /// The unit matrix that `mvhd` and `tkhd` carry.
    fn matrix(&mut self) -> &mut Self {
        for value in [0x1_0000, 0, 0, 0, 0x1_0000, 0, 0, 0, 0x4000_0000] {
            self.u32(value);
        }
        self
    }
}

pub fn file_type() -> Vec<u8> {
    let mut b = Bytes::default();
    b.boxed(b"ftyp", |b| {
        b.raw(b"isom").u32(512).raw(b"isomiso2avc1mp41");
    });
    b.0
}

/// Unused room of `size` bytes, header included; nothing for 0.
pub fn free(size: u64) -> Vec<u8> {
    let mut b = Bytes::default();
    if size >= 8 {
        b.u32(size as u32).raw(b"free").zeros(size as usize - 8);
    }
    b.0
}

/// The header of the media data, with a 64-bit size that counts the header too.
pub fn long_data_header(size: u64) -> Vec<u8> {
    let mut b = Bytes::default();
    b.u32(1).raw(b"mdat").u64(size);
    b.0
}

/// One track in the words of its boxes.
struct Track<'a> {
    id: u32,
    handler: &'a [u8; 4],
    name: &'a [u8],
    /// Units a second, units per sample.
    rate: (u32, u32),
    /// Units of the last sample: shorter where the sound ends within its packet.
    last: u32,
    /// In units of [`MOVIE_RATE`].
    shown: u64,
    size: (u32, u32),
    samples: &'a Samples,
}

/// The table of contents.
pub fn movie(plan: &Plan, config: &Config, video: &Samples, audio: &Samples) -> Vec<u8> {
    let (num, den) = plan.fps;
    let scale = VIDEO_RATE_MIN.div_ceil(num);
    let frames = video.sizes.len() as u64;
    let video = Track {
        id: 1,
        handler: b"vide",
        name: b"picture\0",
        rate: (num * scale, den * scale),
        last: den * scale,
        shown: frames * u64::from(MOVIE_RATE) * u64::from(den) / u64::from(num),
        size: (plan.width, plan.height),
        samples: video,
    };
    let sound = plan.audio.as_ref().map(|plan| {
        let track = Track {
            id: 2,
            handler: b"soun",
            name: b"sound\0",
            rate: (MOVIE_RATE, PACKET as u32),
            last: plan.last_packet(),
            shown: plan.length,
            size: (0, 0),
            samples: audio,
        };
        (plan, track)
    });
    let shown = video
        .shown
        .max(sound.as_ref().map_or(0, |(_, track)| track.shown));
    let mut b = Bytes::default();
    b.boxed(b"moov", |b| {
        b.full(b"mvhd", 0, 0, |b| {
            b.zeros(8).u32(MOVIE_RATE).u32(shown as u32);
            b.u32(0x1_0000)
                .u16(0x100)
                .zeros(10)
                .matrix()
                .zeros(24)
                .u32(3);
        });
        track(b, &video, 0, &|b| avc1(b, plan, config));
        if let Some((plan, sound)) = &sound {
            track(b, sound, plan.pre_skip, &|b| opus(b, plan));
        }
    });
    b.0
}

fn track(b: &mut Bytes, t: &Track, skip: u16, entry: &dyn Fn(&mut Bytes)) {
    let sound = t.handler == b"soun";
    b.boxed(b"trak", |b| {
        b.full(b"tkhd", 0, 3, |b| {
            b.zeros(8).u32(t.id).zeros(4).u32(t.shown as u32).zeros(8);
            b.u16(0)
                .u16(0)
                .u16(if sound { 0x100 } else { 0 })
                .u16(0)
                .matrix();
            b.u32(t.size.0 << 16).u32(t.size.1 << 16);
        });
        // What is shown, from which sample on: this is what keeps the sound in step.
        b.boxed(b"edts", |b| {
            b.full(b"elst", 0, 0, |b| {
                b.u32(1)
                    .u32(t.shown as u32)
                    .u32(u32::from(skip))
                    .u32(0x1_0000);
            });
        });
        b.boxed(b"mdia", |b| {
            b.full(b"mdhd", 0, 0, |b| {
                let count = t.samples.sizes.len() as u64;
                let duration = count.saturating_sub(1) * u64::from(t.rate.1) + u64::from(t.last);
                b.zeros(8).u32(t.rate.0).u32(duration as u32);
                b.u16(0x55C4).u16(0); // language: undetermined
            });
            b.full(b"hdlr", 0, 0, |b| {
                b.zeros(4).raw(t.handler).zeros(12).raw(t.name);
            });
            b.boxed(b"minf", |b| {
                if sound {
                    b.full(b"smhd", 0, 0, |b| _ = b.zeros(4));
                } else {
                    b.full(b"vmhd", 0, 1, |b| _ = b.zeros(8));
                }
                b.boxed(b"dinf", |b| {
                    b.full(b"dref", 0, 0, |b| {
                        b.u32(1).full(b"url ", 0, 1, |_| {});
                    });
                });
                b.boxed(b"stbl", |b| tables(b, t, sound, entry));
            });
        });
    });
}

fn tables(b: &mut Bytes, t: &Track, sound: bool, entry: &dyn Fn(&mut Bytes)) {
    let count = t.samples.sizes.len() as u32;
    b.full(b"stsd", 0, 0, |b| {
        b.u32(1);
        entry(b);
    });
    b.full(b"stts", 0, 0, |b| {
        if count > 1 && t.last != t.rate.1 {
            b.u32(2).u32(count - 1).u32(t.rate.1).u32(1).u32(t.last);
        } else {
            b.u32(1).u32(count).u32(t.last);
        }
    });
    if !sound {
        b.full(b"stss", 0, 0, |b| {
            b.u32(t.samples.keys.len() as u32);
            t.samples.keys.iter().for_each(|&key| _ = b.u32(key));
        });
    }
    b.full(b"stsc", 0, 0, |b| _ = b.u32(1).u32(1).u32(1).u32(1));
    b.full(b"stsz", 0, 0, |b| {
        b.u32(0).u32(count);
        t.samples.sizes.iter().for_each(|&size| _ = b.u32(size));
    });
    let offsets = &t.samples.offsets;
    if offsets.iter().all(|&at| u32::try_from(at).is_ok()) {
        b.full(b"stco", 0, 0, |b| {
            b.u32(count);
            offsets.iter().for_each(|&at| _ = b.u32(at as u32));
        });
    } else {
        b.full(b"co64", 0, 0, |b| {
            b.u32(count);
            offsets.iter().for_each(|&at| _ = b.u64(at));
        });
    }
    if sound {
        b.full(b"sgpd", 1, 0, |b| {
            b.raw(b"roll")
                .u32(2)
                .u32(1)
                .u16((-OPUS_ROLL_PACKETS).cast_unsigned());
        });
        b.full(b"sbgp", 0, 0, |b| {
            _ = b.raw(b"roll").u32(1).u32(count).u32(1);
        });
    }
}

fn avc1(b: &mut Bytes, plan: &Plan, config: &Config) {
    b.boxed(b"avc1", |b| {
        b.zeros(6)
            .u16(1)
            .zeros(16)
            .u16(plan.width as u16)
            .u16(plan.height as u16);
        b.u32(0x48_0000)
            .u32(0x48_0000)
            .zeros(4)
            .u16(1)
            .zeros(32)
            .u16(0x18)
            .u16(0xFFFF);
        b.boxed(b"avcC", |b| {
            let profile = config.sps.get(1..4).unwrap_or(&[66, 0xC0, 52]);
            b.u8(1).raw(profile).u8(0xFF); // unit lengths of four bytes
            b.u8(0xE1).u16(config.sps.len() as u16).raw(&config.sps);
            b.u8(1).u16(config.pps.len() as u16).raw(&config.pps);
        });
        // BT.709 throughout, limited range: as `yuv` converts and the stream itself says.
        b.boxed(b"colr", |b| _ = b.raw(b"nclx").u16(1).u16(1).u16(1).u8(0));
        b.boxed(b"pasp", |b| _ = b.u32(1).u32(1));
    });
}

fn opus(b: &mut Bytes, plan: &AudioPlan) {
    b.boxed(b"Opus", |b| {
        b.zeros(6)
            .u16(1)
            .zeros(8)
            .u16(1)
            .u16(16)
            .zeros(4)
            .u32(MOVIE_RATE << 16);
        b.boxed(b"dOps", |b| {
            b.u8(0)
                .u8(1)
                .u16(plan.pre_skip)
                .u32(MOVIE_RATE)
                .u16(0)
                .u8(0);
        });
    });
}
