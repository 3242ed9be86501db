//! Frames to H.264 by openh264, in the form MP4 wants: lengths before units, parameter sets apart.

use anyhow::{Context as _, bail};
use openh264::encoder::{
    BitRate, Complexity, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, QpRange,
    RateControlMode, UsageType, VuiConfig,
};
use openh264::formats::YUVSource;
use openh264::{OpenH264API, Timestamp};

use crate::media::Clip;
use crate::media::yuv::Yuv;

/// The quantiser's step when the user names no rate: where a face still looks like its source. One
/// step throughout is one quality throughout; the file grows with what moves.
const QUALITY: u8 = 20;

/// The steps a named rate may choose from: finer is waste, coarser is blocks.
const STEPS: (u8, u8) = (12, 44);

/// The encoder checks this number even where it does not use it.
const BITS_UNUSED: u32 = 5_000_000;

/// How often a frame that the encoder leaves out is offered again: each time it counts a frame's worth of bits as saved.
const OFFERS_MAX: u32 = 300;

/// Seconds between pictures that a player can jump to.
const KEY_SECONDS: u32 = 2;

/// What an MP4 says once about all its H.264.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Config {
    pub sps: Vec<u8>,
    pub pps: Vec<u8>,
}

/// The encoder and its buffers.
pub struct Video {
    encoder: Encoder,
    yuv: Yuv,
    sample: Vec<u8>,
    config: Option<Config>,
}

impl Video {
    pub fn new(clip: &Clip) -> anyhow::Result<Self> {
        let (width, height) = (clip.width as usize, clip.height as usize);
        let hz = f64::from(clip.fps.0) / f64::from(clip.fps.1);
        let (mode, (least, most)) = match clip.bitrate {
            Some(_) => (RateControlMode::Bitrate, STEPS),
            None => (RateControlMode::Bufferbased, (QUALITY, QUALITY)),
        };
        let bits = clip.bitrate.unwrap_or(BITS_UNUSED);
        let config = EncoderConfig::new()
            .bitrate(BitRate::from_bps(bits))
            .max_frame_rate(FrameRate::from_hz(hz as f32))
            .rate_control_mode(mode)
            .usage_type(UsageType::CameraVideoRealTime)
            .complexity(Complexity::High)
            .qp(QpRange::new(least, most))
            // To keep a rate the encoder must be allowed to leave frames out, or it complains on
            // stderr; `encode` then offers them again.
            .skip_frames(clip.bitrate.is_some())
            .background_detection(false)
            .scene_change_detect(false) // one shot, and key frames stay where they are due
            .intra_frame_period(IntraFramePeriod::from_num_frames(
                (hz * f64::from(KEY_SECONDS)).round().max(1.0) as u32,
            ))
            .num_threads(1) // more would cut the picture differently on each machine
            .vui(VuiConfig::bt709());
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), config)
            .context("the H.264 encoder does not start")?;
        Ok(Self {
            encoder,
            yuv: Yuv::new(width, height),
            sample: Vec::new(),
            config: None,
        })
    }

    /// Encodes one frame; true says that a player can start here.
    pub fn encode(&mut self, rgba: &[u8], millis: u64) -> anyhow::Result<(&[u8], bool)> {
        self.yuv.set(rgba);
        let planes = Planes(&self.yuv);
        let mut offers = 0;
        let stream = loop {
            let time = Timestamp::from_millis(millis);
            let stream = self
                .encoder
                .encode_at(&planes, time)
                .context("the H.264 encoder gave up")?;
            if !matches!(stream.frame_type(), FrameType::Skip) {
                break stream;
            }
            offers += 1;
            if offers > OFFERS_MAX {
                bail!("the H.264 encoder finds no room for frame at {millis} ms; raise --bitrate");
            }
        };
        self.sample.clear();
        let mut config = Config::default();
        let layers = (0..stream.num_layers()).filter_map(|i| stream.layer(i));
        for layer in layers {
            for unit in (0..layer.nal_count()).filter_map(|i| layer.nal_unit(i)) {
                let unit = without_start_code(unit);
                match unit.first().map(|byte| byte & 31) {
                    Some(7) => config.sps = unit.to_vec(),
                    Some(8) => config.pps = unit.to_vec(),
                    Some(_) => {
                        self.sample.extend((unit.len() as u32).to_be_bytes());
                        self.sample.extend_from_slice(unit);
                    }
                    None => {}
                }
            }
        }
        let key = matches!(stream.frame_type(), FrameType::IDR);
        if self.sample.is_empty() {
            bail!("the H.264 encoder left a frame out");
        }
        if !config.sps.is_empty() {
            match &self.config {
                Some(first) if *first != config => bail!("the H.264 encoder changed its mind"),
                _ => self.config = Some(config),
            }
        }
        Ok((&self.sample, key))
    }

    /// The parameter sets, once there was a frame.
    pub fn config(&self) -> Option<&Config> {
        self.config.as_ref()
    }
}

/// A unit as the encoder gives it begins with 00 00 01 or 00 00 00 01.
fn without_start_code(unit: &[u8]) -> &[u8] {
    unit.strip_prefix(&[0, 0, 0, 1])
        .or_else(|| unit.strip_prefix(&[0, 0, 1]))
        .unwrap_or(unit)
}

/// A picture as the encoder reads it.
struct Planes<'a>(&'a Yuv);

impl YUVSource for Planes<'_> {
    fn dimensions(&self) -> (usize, usize) {
        (self.0.width, self.0.height)
    }
    fn strides(&self) -> (usize, usize, usize) {
        (self.0.width, self.0.width / 2, self.0.width / 2)
    }
    fn y(&self) -> &[u8] {
        &self.0.y
    }
    fn u(&self) -> &[u8] {
        &self.0.u
    }
    fn v(&self) -> &[u8] {
        &self.0.v
    }
}
