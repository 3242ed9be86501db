//! The sound device through cpal, the one place that knows it.
//!
//! A stream's own instants count from an origin of its own, so they are turned at once into this
//! process's nanoseconds: the callback runs now, and its first frame is heard `playback - callback`
//! from now. Where the device cannot do 48 kHz it runs at its own rate.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use cpal::traits::{DeviceTrait as _, HostTrait as _, StreamTrait as _};
use cpal::{
    BufferSize, ErrorKind, FromSample, OutputCallbackInfo, SampleFormat, SizedSample, StreamConfig,
    SupportedBufferSize, SupportedStreamConfigRange,
};
use mouthpiece_rig::TICK_RATE;

use super::callback::{Callback, Link};
use crate::live::clock::ClockCell;
use crate::live::time::Origin;

/// Frames asked for in a buffer: 50 ms at 48 kHz. Smaller ones keep falling dry on PipeWire's ALSA
/// plugin and under load; barge-in and start wait for one at most.
const BUFFER_FRAMES: u32 = 2_400;
/// Seconds that the ring between mixer and device can hold: several times what is kept in it.
const RING_S: u32 = 1;

/// An open device that plays what is put into its ring.
pub(super) struct Device {
    pub(super) stream: cpal::Stream,
    pub(super) ring: rtrb::Producer<f32>,
    pub(super) link: Arc<Link>,
    pub(super) rate: u32,
    /// Frames between two callbacks.
    pub(super) period: u32,
    pub(super) name: String,
}

/// Opens the device with that id, or the default one, and starts it. It plays silence until it is put
/// on the air. May take long.
pub(super) fn open(
    wanted: Option<&str>,
    cell: &Arc<ClockCell>,
    origin: Origin,
) -> Result<Device, String> {
    let device = find(wanted)?;
    let name = device
        .id()
        .map_or_else(|e| e.to_string(), |id| id.to_string());
    let told = |e: cpal::Error| format!("{name}: {e}");
    let (format, config) = choose(&device).map_err(told)?;
    let rate = config.sample_rate;
    let link = Arc::new(Link::default());
    // A wish for a buffer is refused by some devices; their own choice then serves.
    let mut opened = Err(String::new());
    for buffer_size in [config.buffer_size, BufferSize::Default] {
        let config = StreamConfig {
            buffer_size,
            ..config
        };
        let (ring, out) = rtrb::RingBuffer::new(usize::try_from(rate * RING_S).unwrap_or(48_000));
        let callback = Callback::new(
            out,
            Arc::clone(&link),
            Arc::clone(cell),
            rate,
            usize::from(config.channels),
        );
        let stream = match format {
            SampleFormat::F32 => build::<f32>(&device, config, callback, origin),
            SampleFormat::I16 => build::<i16>(&device, config, callback, origin),
            SampleFormat::I32 => build::<i32>(&device, config, callback, origin),
            other => return Err(format!("{name} takes only {other} samples")),
        };
        opened = stream.map_err(told).map(|stream| (stream, ring));
        if opened.is_ok() {
            break;
        }
    }
    let (stream, ring) = opened?;
    let period = stream.buffer_size().map_err(told)?;
    stream.play().map_err(told)?;
    tracing::info!(
        device = %name, rate, channels = config.channels, format = %format, period, "sound device"
    );
    Ok(Device {
        stream,
        ring,
        link,
        rate,
        period,
        name,
    })
}

fn find(wanted: Option<&str>) -> Result<cpal::Device, String> {
    let Some(wanted) = wanted else {
        return cpal::default_host()
            .default_output_device()
            .ok_or_else(|| "there is no sound device".to_owned());
    };
    let id: cpal::DeviceId = wanted
        .parse()
        .map_err(|e| format!("`{wanted}` is no sound device: {e}"))?;
    cpal::host_from_id(id.host())
        .map_err(|e| format!("{wanted}: {e}"))?
        .device_by_id(&id)
        .ok_or_else(|| format!("there is no sound device `{wanted}`"))
}

/// The form to play in: 48 kHz if at all possible, floats, two channels.
fn choose(device: &cpal::Device) -> Result<(SampleFormat, StreamConfig), cpal::Error> {
    let ticks = u32::try_from(TICK_RATE).unwrap_or(48_000);
    let rank = |range: &SupportedStreamConfigRange| {
        let format = match range.sample_format() {
            SampleFormat::F32 => 0,
            SampleFormat::I32 => 1,
            SampleFormat::I16 => 2,
            _ => 100,
        };
        let rate = range.min_sample_rate() <= ticks && ticks <= range.max_sample_rate();
        (format == 100, !rate, range.channels().abs_diff(2), format)
    };
    let best = device.supported_output_configs()?.min_by_key(rank);
    let Some(best) = best else {
        let config = device.default_output_config()?;
        return Ok((config.sample_format(), config.config()));
    };
    let rate = ticks.clamp(best.min_sample_rate(), best.max_sample_rate());
    let buffer_size = match best.buffer_size() {
        SupportedBufferSize::Range { min, max } => {
            BufferSize::Fixed(BUFFER_FRAMES.clamp(*min, (*max).max(*min)))
        }
        SupportedBufferSize::Unknown => BufferSize::Fixed(BUFFER_FRAMES),
    };
    Ok((
        best.sample_format(),
        StreamConfig {
            channels: best.channels(),
            sample_rate: rate,
            buffer_size,
        },
    ))
}

fn build<T: SizedSample + FromSample<f32>>(
    device: &cpal::Device,
    config: StreamConfig,
    mut callback: Callback,
    origin: Origin,
) -> Result<cpal::Stream, cpal::Error> {
    let link = Arc::clone(&callback.link);
    device.build_output_stream(
        config,
        move |out: &mut [T], info: &OutputCallbackInfo| {
            no_alloc(|| {
                let stamp = info.timestamp();
                let ahead = stamp.playback.duration_since(stamp.callback);
                let ahead_ns = i64::try_from(ahead.as_nanos()).unwrap_or(0);
                callback.link.latency_ns.store(ahead_ns, Ordering::Relaxed);
                callback.fill(out, origin.now_ns() + ahead_ns, T::from_sample);
            });
        },
        move |error| {
            // An underrun has been mended already by the time it is told; logging is not for this
            // thread, and a device that is silent without a word is the watchdog's.
            match error.kind() {
                ErrorKind::Xrun => {}
                ErrorKind::DeviceNotAvailable | ErrorKind::StreamInvalidated => {
                    link.lost.store(true, Ordering::Release);
                }
                _ => link.failed(origin.now_ns()),
            }
        },
        None,
    )
}

#[cfg(feature = "alloc-check")]
fn no_alloc(work: impl FnOnce()) {
    assert_no_alloc::assert_no_alloc(work);
}

#[cfg(not(feature = "alloc-check"))]
fn no_alloc(work: impl FnOnce()) {
    work();
}
