//! `/metrics`: the figures in the OpenMetrics text format, written when somebody asks.

use std::fmt;
use std::sync::Arc;

use prometheus_client::collector::Collector;
use prometheus_client::encoding::{DescriptorEncoder, MetricEncoder, NoLabelSet, text};
use prometheus_client::metrics::MetricType;
use prometheus_client::registry::{Registry, Unit};

use super::judge::judge;
use crate::live::time::seconds;
use crate::live::vitals::{DeviceState, Spread, Vitals};
use crate::memory;

/// What the text is, as Prometheus wants to be told.
pub const CONTENT_TYPE: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// All figures as text.
pub fn text(vitals: &Arc<Vitals>, stall_ns: i64) -> Result<String, fmt::Error> {
    let mut registry = Registry::with_prefix("mouthpiece");
    registry.register_collector(Box::new(Figures {
        vitals: Arc::clone(vitals),
        stall_ns,
    }));
    let mut text = String::new();
    text::encode(&mut text, &registry)?;
    Ok(text)
}

#[derive(Debug)]
struct Figures {
    vitals: Arc<Vitals>,
    stall_ns: i64,
}

impl Collector for Figures {
    fn encode(&self, encoder: DescriptorEncoder) -> fmt::Result {
        let mut out = Lines(encoder);
        let now_ns = self.vitals.origin.now_ns();
        let verdict = judge(&self.vitals, now_ns, self.stall_ns);
        let well = f64::from(u8::from(verdict.ok));
        out.gauge(
            "well",
            "1 while a face is on the screen and moving",
            None,
            well,
        )?;
        out.gauge(
            "uptime",
            "Since the process started",
            Some(&Unit::Seconds),
            verdict.uptime_s,
        )?;
        if let Some(kb) = memory::status_kb("VmRSS:") {
            let help = "Memory that the process holds (RSS)";
            out.gauge("resident_memory", help, Some(&Unit::Bytes), kb * 1024.0)?;
        }
        self.window(&mut out, now_ns)?;
        self.simulation(&mut out)?;
        self.sound(&mut out)?;
        let net = &self.vitals.net;
        out.gauge(
            "clients",
            "Clients connected",
            None,
            net.clients.get() as f64,
        )?;
        out.counter(
            "connections",
            "Clients that there were",
            net.connected.get(),
        )?;
        out.counter(
            "turned_away",
            "Clients for whom there was no room",
            net.turned_away.get(),
        )
    }
}

impl Figures {
    fn window(&self, out: &mut Lines<'_>, now_ns: i64) -> fmt::Result {
        let window = &self.vitals.window;
        out.counter(
            "pictures",
            "Pictures that the screen took",
            window.presented.get(),
        )?;
        let rate = window.per_second(now_ns);
        out.gauge(
            "pictures_per_second",
            "Pictures a second of late",
            None,
            rate,
        )?;
        out.spread(
            "picture_interval",
            "Time between two pictures: a long one is a picture lost",
            &window.intervals_ns,
        )?;
        out.spread(
            "draw",
            "From taking the time to handing the picture over",
            &window.draw_ns,
        )?;
        let skew_s = window.skew_ns.get() as f64 * 1e-9;
        let help = "By how much the picture is later than its sound of late, by our own clocks";
        out.gauge("av_skew", help, Some(&Unit::Seconds), skew_s)?;
        let help = "The same of each picture, without its sign";
        out.spread("av_skew_absolute", help, &window.skews_ns)?;
        let tier = window
            .tier()
            .map_or(0.0, |tier| f64::from(tier as u8) + 1.0);
        out.gauge(
            "tier",
            "What pictures are drawn in: 1 low, 2 medium, 3 high",
            None,
            tier,
        )?;
        out.counter(
            "window_failures",
            "Times that the window had to be set up again",
            window.failures.get(),
        )
    }

    fn simulation(&self, out: &mut Lines<'_>) -> fmt::Result {
        let simulation = &self.vitals.simulation;
        let lead_s = seconds(simulation.lead.get());
        out.gauge(
            "simulation_lead",
            "How far ahead of the sound the head is",
            Some(&Unit::Seconds),
            lead_s,
        )?;
        out.counter(
            "key_frames",
            "Key frames simulated",
            simulation.key_frames.get(),
        )?;
        out.counter(
            "rewinds",
            "Times that the head went back for a stop or a late label",
            simulation.rewinds.get(),
        )?;
        out.counter(
            "skips",
            "Times that the head was left behind and skipped what nobody saw",
            simulation.skips.get(),
        )
    }

    fn sound(&self, out: &mut Lines<'_>) -> fmt::Result {
        let sound = &self.vitals.sound;
        let playing = sound.device() == DeviceState::Playing;
        out.gauge(
            "sound_device",
            "1 while a sound device plays",
            None,
            f64::from(u8::from(playing)),
        )?;
        out.counter(
            "sound_device_losses",
            "Times that a sound device was lost",
            sound.losses.get(),
        )?;
        out.counter(
            "underruns",
            "Times that a sound device ran dry",
            sound.underruns.get().unsigned_abs(),
        )?;
        out.gauge(
            "queue",
            "Utterances that were accepted and have not ended",
            None,
            sound.queue.get() as f64,
        )?;
        out.gauge(
            "held_sound",
            "Sound that they hold",
            Some(&Unit::Seconds),
            seconds(sound.held.get()),
        )?;
        out.counter(
            "dropped_labels",
            "Labels that came too late",
            sound.dropped_labels.get(),
        )?;
        let dropped = seconds(i64::try_from(sound.dropped.get()).unwrap_or(i64::MAX));
        out.seconds("dropped", "Labels and sound that came too late", dropped)?;
        out.counter(
            "utterances_accepted",
            "Utterances accepted",
            sound.begun.get(),
        )?;
        out.by_end(
            "utterances_ended",
            "Utterances by how they ended",
            [
                ("finished", sound.finished.get()),
                ("stopped", sound.stopped.get()),
                ("error", sound.failed.get()),
            ],
        )
    }
}

/// One figure at a time.
struct Lines<'a>(DescriptorEncoder<'a>);

impl Lines<'_> {
    fn figure<'s>(
        &'s mut self,
        name: &'s str,
        help: &str,
        unit: Option<&'s Unit>,
        kind: MetricType,
    ) -> Result<MetricEncoder<'s>, fmt::Error> {
        self.0.encode_descriptor(name, help, unit, kind)
    }

    fn gauge(&mut self, name: &str, help: &str, unit: Option<&Unit>, value: f64) -> fmt::Result {
        self.figure(name, help, unit, MetricType::Gauge)?
            .encode_gauge(&value)
    }

    fn counter(&mut self, name: &str, help: &str, value: u64) -> fmt::Result {
        self.figure(name, help, None, MetricType::Counter)?
            .encode_counter::<NoLabelSet, _, u64>(&value, None)
    }

    fn seconds(&mut self, name: &str, help: &str, value: f64) -> fmt::Result {
        self.figure(name, help, Some(&Unit::Seconds), MetricType::Counter)?
            .encode_counter::<NoLabelSet, _, u64>(&value, None)
    }

    fn by_end<const N: usize>(
        &mut self,
        name: &str,
        help: &str,
        ends: [(&'static str, u64); N],
    ) -> fmt::Result {
        let mut encoder = self.figure(name, help, None, MetricType::Counter)?;
        for (end, count) in ends {
            encoder
                .encode_family(&[("end", end)])?
                .encode_counter::<NoLabelSet, _, u64>(&count, None)?;
        }
        Ok(())
    }

    fn spread(&mut self, name: &str, help: &str, spread: &Spread) -> fmt::Result {
        let counts = spread.counts();
        let bounds = Spread::BOUNDS_MS.iter().map(|ms| ms / 1000.0);
        let buckets: Vec<(f64, u64)> = bounds.chain([f64::INFINITY]).zip(counts).collect();
        let count = counts.iter().sum();
        self.figure(name, help, Some(&Unit::Seconds), MetricType::Histogram)?
            .encode_histogram::<NoLabelSet>(spread.sum_s(), count, &buckets, None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::live::time::Origin;

    #[test]
    fn the_text_is_what_prometheus_reads() {
        let vitals = Arc::new(Vitals::new(Origin::new()));
        vitals.window.shown(0, 30_000_000, true, -6_000_000);
        vitals.sound.stopped.add(2);
        let text = text(&vitals, 1).unwrap();
        for line in [
            "# TYPE mouthpiece_draw_seconds histogram",
            "mouthpiece_draw_seconds_bucket{le=\"0.02\"} 0",
            "mouthpiece_draw_seconds_bucket{le=\"0.033\"} 1",
            "mouthpiece_draw_seconds_bucket{le=\"+Inf\"} 1",
            "mouthpiece_draw_seconds_count 1",
            "mouthpiece_av_skew_absolute_seconds_bucket{le=\"0.01\"} 1",
            "mouthpiece_utterances_ended_total{end=\"stopped\"} 2",
            "mouthpiece_pictures_total 1",
            "# EOF",
        ] {
            assert!(text.lines().any(|l| l == line), "{line} is not in\n{text}");
        }
    }
}
